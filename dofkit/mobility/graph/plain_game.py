"""The (2,3) pebble game of `pebbles` written for Python itself, where nothing is compiled.

The links are first taken away, last to first, and with each the joints that have two links at most then. Such a joint
makes its links independent of all that is left (0-extension [Henneberg1911]): it pays for them and nothing is searched.
Only a link both of whose joints still have three, when all after it are gone, is played for: in the order of the links.
It is superfluous without a search where one block holds both ends, or a joint that the block does not hold pays for two
links to others of its joints than the other end.

Lists grow while they are read, and a dictionary is the memory of a search. A joint's number is one object in all lists:
of a large graph half the time goes to memory that is touched for the first time.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from dofkit.base.libraries import np
from dofkit.mobility.graph.pebbles import FREE, Board
from dofkit.mobility.graph.rigid_blocks import NONE, RigidBlocks


class Neighbours(NamedTuple):
    """Link i lies between ``tail[i]`` and ``head[i]``; ``across[start[v]]``, ``across[start[v] + 1]``, ...: the joints
    that links of joint v lead to, in the order of the links; ``degree``: how many of them are left."""

    tail: list[int]
    head: list[int]
    across: list[int]
    start: list[int]
    degree: list[int]


def neighbours_of(ends: Any, joints: int) -> Neighbours:
    """The links by joints: link i lies between ``ends[2 i]`` and ``ends[2 i + 1]``."""
    flat, names = np.asarray(ends, dtype=np.int32), np.arange(joints).astype(object)
    bits = len(flat).bit_length()
    places = np.arange(len(flat), dtype=np.int64)
    places |= flat.astype(np.int64) << bits
    places.sort()
    places &= (1 << bits) - 1
    places ^= 1
    across = flat[places]
    degree = np.bincount(flat, minlength=joints)
    start = np.cumsum(degree) - degree
    tail, head, across = (names[part].tolist() for part in (flat[::2], flat[1::2], across))
    return Neighbours(tail, head, across, start.tolist(), degree.tolist())


class PlainGame:
    """The pebbles of joint v lie on links to ``first[v]`` and ``second[v]``; where one is free it is the second.

    What a joint pays for as it is taken off lies there from the beginning: nothing leads to it before the links of its
    neighbours are played. ``redundant``: the links that those before them make superfluous, ascending.
    """

    def __init__(self, joints: int, ends: Any) -> None:
        self.net = neighbours_of(ends, joints)
        self.first, self.second = [FREE] * joints, [FREE] * joints
        self.blocks = RigidBlocks(joints)
        self.redundant: list[int] = []

    def play(self) -> None:
        """Fills ``redundant``; as `pebbles.play`."""
        first, second, redundant = self.first, self.second, self.redundant
        tail, head, *_ = self.net
        for i in reversed(self.played_for()):
            a, b = tail[i], head[i]
            if self._held(a, b):
                redundant.append(i)
                continue
            while second[a] >= 0 or first[a] >= 0:
                self.bring(a, a)
            reached = None
            while reached is None and (second[b] >= 0 or first[b] >= 0):
                reached = self.bring(b, a)
            if reached is None:
                first[a] = b
            else:
                redundant.append(i)
                self._condense(a, b, reached)

    def played_for(self) -> list[int]:
        """The links that go with no joint, last to first, all others paid for."""
        tail, head, _, _, degree = self.net
        self._take_off([v for v, number in enumerate(degree) if number <= 2])
        found, queue = [], list[int]()
        for i, a, b in zip(range(len(tail) - 1, -1, -1), reversed(tail), reversed(head), strict=True):
            d, e = degree[a], degree[b]
            if d and e:
                found.append(i)
                degree[a], degree[b] = d - 1, e - 1
                if d <= 3:
                    queue.append(a)
                if e <= 3:
                    queue.append(b)
                if queue:
                    self._take_off(queue)
                    queue.clear()
        return found

    def _take_off(self, queue: list[int]) -> None:
        """Joints of two links at most, to different joints, pay for these, and then others that have no more left.

        A joint that is off has no links left, and a link that is gone by itself comes after all that are left.
        """
        first, second, (_, _, across, start, degree) = self.first, self.second, self.net
        for v in queue:
            number = degree[v]
            if not number:
                continue
            k = start[v]
            while not degree[w := across[k]]:
                k += 1
            if number == 2:
                k += 1
                while not degree[x := across[k]]:
                    k += 1
                if x == w:
                    continue
                second[v] = x
                degree[x] = left = degree[x] - 1
                if left <= 2:
                    queue.append(x)
            first[v] = w
            degree[v] = 0
            degree[w] = left = degree[w] - 1
            if left <= 2:
                queue.append(w)

    def _held(self, a: int, b: int) -> bool:
        """Does one block fix both joints? Then it holds both from now on.

        A joint that lies in no block pays for links of its own, and none of them makes the block rigid: in their stead
        it pays for links to the poles, so that what is paid for stays independent and spans the same. In every circuit
        of the link between a and b all that such a joint pays for occurs, because three links at least meet at each of
        its joints, and with it links of the block.
        """
        blocks, of = self.blocks, self.blocks.of
        g, h = of[a], of[b]
        if g < 0:
            g = self._fixing(a, b)
        if h < 0:
            h = self._fixing(b, a)
        if not (g == h >= 0 or blocks.alike(g, h)):
            return False
        for v in (a, b):
            if of[v] < 0:
                of[v] = g
                self.first[v], self.second[v] = blocks.poles(g)
        return True

    def _fixing(self, v: int, other: int) -> int:
        """The block of two joints, none of them ``other``, that joint v pays for links to."""
        of, w, x = self.blocks.of, self.first[v], self.second[v]
        if x < 0 or w == other or x == other:
            return NONE
        g, h = of[w], of[x]
        return g if g == h or self.blocks.alike(g, h) else NONE

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
        first, second = self.first, self.second
        in_first = first[w] < 0
        while w != root:
            v = via[w]
            if in_first:
                first[w] = v
            else:
                second[w] = v
            w, in_first = v, first[v] == w
        if in_first:
            first[root] = second[root]
        second[root] = FREE

    def _condense(self, a: int, b: int, reached: list[int]) -> None:
        """The joints that were reached are a rigid block with a, held by the two; as `pebbles.condense`.

        Both pebbles of a are free, and one of b: the other pays for a link between the two, or what stands for it.
        """
        first, second = self.first, self.second
        for v in reached:
            first[v], second[v] = a, b
        second[b] = FREE
        self.blocks.unite([a, *reached], (a, b))

    def groups(self) -> list[int]:
        """For every link the first of its group, itself where it is alone."""
        tail, head, *_ = self.net
        stands: dict[int, int] = {}
        found = []
        for i, (a, b) in enumerate(zip(tail, head, strict=True)):
            block = self.blocks.common(a, b)
            found.append(i if block < 0 else stands.setdefault(block, i))
        return found

    def board(self) -> Board:
        """As `pebbles.play` leaves it: what a pebble lies on is a link, or stands for one of a block."""
        tail, head, *_ = self.net
        group, joints = self.groups(), len(self.first)
        stands = {self.blocks.common(a, b): i for i, a, b in zip(group, tail, head, strict=True)}
        alone = {frozenset(ends): i for i, ends in enumerate(zip(tail, head, strict=True)) if group[i] == i}
        out = [w for pair in zip(self.first, self.second, strict=True) for w in pair]
        link = [FREE] * (2 * joints)
        for place, w in enumerate(out):
            if w >= 0:
                block = self.blocks.common(place >> 1, w)
                link[place] = alone[frozenset((place >> 1, w))] if block < 0 else stands[block]
        return Board(out, link, group, [0] * joints, [0] * joints, [0] * joints, [0])
