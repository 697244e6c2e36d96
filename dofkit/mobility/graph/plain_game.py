"""The (2,3) pebble game of `pebbles` written for Python itself, where nothing is compiled.

The links are first taken away, last to first, and with each the joints that have two links at most then. Such a joint
makes its links independent of all that is left (0-extension [Henneberg1911]): it pays for them and nothing is searched.
Only a link both of whose joints still have three, when all after it are gone, is played for: in the order of the links.

Lists grow while they are read, and a dictionary is the memory of a search.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from dofkit.mobility.graph.pebbles import FREE, Board, leader


class Neighbours(NamedTuple):
    """``at[start[v] : start[v + 1]]``: those of joint v; ``across``: their other ends; ``degree``: how many left."""

    start: list[int]
    at: list[int]
    across: list[int]
    degree: list[int]


def neighbours_of(ends: Any, joints: int) -> Neighbours:
    """The links by joints: link i lies between ``ends[2 i]`` and ``ends[2 i + 1]``."""
    flat = np.asarray(ends, dtype=np.int64)
    places = np.argsort(flat, kind="stable")
    degree = np.bincount(flat, minlength=joints)
    start = np.concatenate(([0], np.cumsum(degree)))
    return Neighbours(start.tolist(), (places >> 1).tolist(), flat[places ^ 1].tolist(), degree.tolist())


class PlainGame:
    """The pebbles of a board while they are moved: those of joint v lie on links to ``first[v]`` and ``second[v]``.

    Where one is free it is the second; ``one`` and ``other`` hold the links. What a joint pays for as it is taken off
    lies there from the beginning: nothing leads to it before the links of its neighbours are played.
    """

    def __init__(self, board: Board, ends: list[int], dependent: list[int]) -> None:
        self.board, self.ends, self.dependent = board, ends, dependent
        self.first, self.second = board.out[::2], board.out[1::2]
        self.one, self.other = board.link[::2], board.link[1::2]

    def play(self) -> None:
        """``dependent[i] = 1`` for every link i that those before it make superfluous; as `pebbles.play`."""
        first, second, one, ends = self.first, self.second, self.one, self.ends
        for i in reversed(list(self.played_for())):
            a, b = ends[2 * i], ends[2 * i + 1]
            while second[a] >= 0 or first[a] >= 0:
                self.bring(a, a)
            reached = None
            while reached is None and (second[b] >= 0 or first[b] >= 0):
                reached = self.bring(b, a)
            if reached is None:
                first[a], one[a] = b, i
            else:
                self.dependent[i] = 1
                self._condense(a, b, reached, i)
        out, link = self.board.out, self.board.link
        out[::2], out[1::2] = first, second
        link[::2], link[1::2] = one, self.other

    def played_for(self) -> Iterator[int]:
        """The links that go with no joint, last to first, all others paid for."""
        ends, net = self.ends, neighbours_of(self.ends, len(self.first))
        degree, gone = net.degree, [False] * len(self.dependent)
        self._take_off([v for v, number in enumerate(degree) if number <= 2], net, gone)
        for i in range(len(gone) - 1, -1, -1):
            if gone[i]:
                continue
            yield i
            gone[i] = True
            a, b = ends[2 * i], ends[2 * i + 1]
            degree[a] -= 1
            degree[b] -= 1
            if degree[a] <= 2 or degree[b] <= 2:
                self._take_off([v for v in (a, b) if degree[v] <= 2], net, gone)

    def _take_off(self, queue: list[int], net: Neighbours, gone: list[bool]) -> None:
        """Joints of two links at most, to different joints, pay for these, and then others that have no more left."""
        start, at, across, degree = net
        for v in queue:
            own = [k for k in range(start[v], start[v + 1]) if not gone[at[k]]]
            if len(own) == 2:
                k = own[1]
                if across[k] == across[own[0]]:
                    continue
                self.second[v], self.other[v] = across[k], at[k]
            if own:
                k = own[0]
                self.first[v], self.one[v] = across[k], at[k]
            for k in own:
                gone[at[k]] = True
                w = across[k]
                degree[w] -= 1
                if degree[w] <= 2:
                    queue.append(w)

    def bring(self, root: int, held: int) -> list[int] | None:
        """One more free pebble at ``root``, those of ``held`` kept; the joints that were reached where none is."""
        first, second = self.first, self.second
        via = {FREE: root, root: root, held: root}
        queue = [root]
        for v in queue:
            w = first[v]
            if w not in via:
                via[w] = v
                if second[w] < 0:
                    break
                queue.append(w)
            w = second[v]
            if w not in via:
                via[w] = v
                if second[w] < 0:
                    break
                queue.append(w)
        else:
            return queue
        self._move(w, root, via)
        return None

    def _move(self, w: int, root: int, via: dict[int, int]) -> None:
        """A free pebble of ``w`` goes to ``root``: every link on the way is paid for from its other end."""
        first, second, one, other = self.first, self.second, self.one, self.other
        in_first = first[w] < 0
        while w != root:
            v = via[w]
            from_first = first[v] == w
            link = one[v] if from_first else other[v]
            if in_first:
                first[w], one[w] = v, link
            else:
                second[w], other[w] = v, link
            w, in_first = v, from_first
        if in_first:
            first[root], one[root] = second[root], other[root]
        second[root] = FREE

    def _condense(self, a: int, b: int, reached: list[int], i: int) -> None:
        """The joints that were reached are a rigid block, held by its ends; as `pebbles.condense`."""
        first, second, one, other = self.first, self.second, self.one, self.other
        for v in reached:
            if v == a:
                continue
            if first[v] >= 0:
                if one[v] != i:
                    i = one[v] = self._joined(i, one[v])
                first[v] = a
            if second[v] >= 0:
                if other[v] != i:
                    i = other[v] = self._joined(i, other[v])
                second[v] = a
            if v != b:
                second[v] = b

    def _joined(self, i: int, j: int) -> int:
        """The groups of two links become one; what stands for a group of several does so as long as can be."""
        group = self.board.group
        j = leader(group, j)
        if self.dependent[j]:
            group[i] = j
            return j
        group[j] = i
        return i
