"""The (2,3) pebble game of `pebbles` written for Python itself, where nothing is compiled.

Lists grow while they are read, and a dictionary is the memory of a search. A link to a joint that has at most one link
so far is independent of all before it (0-extension [Henneberg1911]): that joint pays, and nothing is searched.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from dofkit.mobility.graph.net import Net, removable
from dofkit.mobility.graph.pebbles import FREE, Board, join

#: Of a joint: no link yet, or two at least; else the joint at the other end of its one link.
NONE, SEVERAL = -1, -2


class PlainGame:
    """The pebbles of a board while they are moved: those of joint v lie on links to ``first[v]`` and ``second[v]``.

    Where one is free it is the second; ``one`` and ``other`` hold the links, and ``only`` the joint at the other end.
    """

    def __init__(self, board: Board) -> None:
        self.board = board
        self.first, self.second = board.out[::2], board.out[1::2]
        self.one, self.other = board.link[::2], board.link[1::2]
        self.only = [NONE] * len(self.first)

    def play(self, net: Net, outer: int, dependent: Any) -> None:
        """``dependent[i] = 1`` for every link i that those before it make superfluous; as `pebbles.play`."""
        first, second, one, only, ends = self.first, self.second, self.one, self.only, net.ends
        for i, taken in enumerate(net.gone):
            if taken:
                continue
            a, b = ends[2 * i], ends[2 * i + 1]
            if (only[a] != SEVERAL and only[a] != b) or (only[b] != SEVERAL and only[b] != a):
                self._begin(a, b, i)
                continue
            while second[a] >= 0 or first[a] >= 0:
                self.bring(a, a)
            reached = None
            while reached is None and (second[b] >= 0 or first[b] >= 0):
                reached = self.bring(b, a)
            if reached is None:
                first[a], one[a] = b, i
                only[a] = only[b] = SEVERAL
            else:
                dependent[i] = 1
                self._condense(a, b, reached, i)
        self._extend(net, outer)
        out, link = self.board.out, self.board.link
        out[::2], out[1::2] = first, second
        link[::2], link[1::2] = one, self.other

    def _begin(self, a: int, b: int, i: int) -> None:
        """The first or second link of a joint, which pays for it."""
        only = self.only
        if only[a] == SEVERAL or only[a] == b:
            a, b = b, a
        only[a] = b if only[a] == NONE else SEVERAL
        only[b] = a if only[b] == NONE else SEVERAL
        if self.first[a] < 0:
            self.first[a], self.one[a] = b, i
        else:
            self.second[a], self.other[a] = b, i

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

    def _extend(self, net: Net, outer: int) -> None:
        """The joints that were taken off put back, last first; as `pebbles.extend`."""
        ends, gone, at, start = net.ends, net.gone, net.at, net.start
        for k in range(outer - 1, -1, -1):
            v = net.order[k]
            own = [i for i in at[start[v] : start[v + 1]] if gone[i] == k + 1]
            if own:
                self.first[v], self.one[v] = ends[2 * own[0]] + ends[2 * own[0] + 1] - v, own[0]
            if len(own) > 1:
                self.second[v], self.other[v] = ends[2 * own[1]] + ends[2 * own[1] + 1] - v, own[1]

    def _condense(self, a: int, b: int, reached: list[int], i: int) -> None:
        """The joints that were reached are a rigid block, held by its ends; as `pebbles.condense`."""
        first, second, one, other, group = self.first, self.second, self.one, self.other, self.board.group
        for v in reached:
            if v == a:
                continue
            if first[v] >= 0:
                i = one[v] = join(group, i, one[v])
                first[v] = a
            if second[v] >= 0:
                i = other[v] = join(group, i, other[v])
                second[v] = a
            if v != b:
                second[v] = b


def plain_net(ends: Any, joints: int) -> tuple[Net, int]:
    """The links by joints, and how many joints of few links could be taken off; as `net.incidence` and `net.peel`."""
    flat = np.asarray(ends, dtype=np.int64)
    places = np.argsort(flat, kind="stable")
    number = np.bincount(flat, minlength=joints)
    start = np.concatenate(([0], np.cumsum(number))).tolist()
    at, across, degree = (places >> 1).tolist(), flat[places ^ 1].tolist(), number.tolist()
    a, b = flat[::2], flat[1::2]
    several = len(set((np.minimum(a, b) * joints + np.maximum(a, b)).tolist())) < len(a)
    net = Net(flat.tolist(), start, at, degree, [0] * joints, [0] * len(a))
    gone = net.gone
    queue = [v for v in range(joints) if degree[v] <= 2 and not (several and not removable(net, v))]
    for taken, v in enumerate(queue, 1):
        for k in range(start[v], start[v + 1]):
            i = at[k]
            if not gone[i]:
                gone[i] = taken
                w = across[k]
                degree[w] -= 1
                if degree[w] == 2 and not (several and not removable(net, w)):
                    queue.append(w)
    net.order[: len(queue)] = queue
    return net, len(queue)
