"""Links in the plane: the (2,3) pebble game, circuits, groups and rigid clusters.

Every joint has two pebbles. A link is independent of those before it if and only if all four pebbles of its joints can
be gathered there, and then one of them is spent on it [JacobsHendrickson1997], which rests on [Laman1970]. Where the
fourth cannot be had, the joints that were reached form a rigid block. Its links are then replaced by another set that
makes the same block rigid, every joint held by the two ends of the link, so that later searches there are short.

The links are first taken away, last to first, and with each the joints that have at most two links then. Such a joint
makes its links independent of all others (0-extension [Henneberg1911]): it pays for them and nothing is searched. Only
a link both of whose joints still have three, when all after it are gone, is played for, in the order of the links. It
is redundant without a search where one block holds both ends, or a joint outside the block pays for two links to
joints of the block other than the other end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import deepcopy
from functools import cached_property
from typing import Any, NamedTuple

from dofkit.base.deadline import check
from dofkit.mobility.graph.links import Ends, Proof
from dofkit.mobility.graph.rigid_blocks import NONE, RigidBlocks

# [JacobsHendrickson1997] [PollaczekGeiringer1927] [Laman1970]
_PROOF = Proof(
    "proved",
    "the (2,3) pebble game (Jacobs and Hendrickson 1997): links in the plane are independent in general position if "
    "and only if every n joints carry at most 2n - 3 of them (Pollaczek-Geiringer 1927, Laman 1970)",
)
#: No joint: the pebble is free.
FREE = -1


class Neighbours(NamedTuple):
    """The joints ``across[v]`` to which links of joint v lead, in the order of the links.

    Link i lies between ``tail[i]`` and ``head[i]``; ``degree`` counts the links of a joint that are not taken off.
    """

    tail: list[int]
    head: list[int]
    across: list[list[int]]
    degree: list[int]


def neighbours_of(ends: Sequence[Ends], joints: int) -> Neighbours:
    """Return the links by joints."""
    across: list[list[int]] = [[] for _ in range(joints)]
    for a, b in ends:
        across[a].append(b)
        across[b].append(a)
    return Neighbours([a for a, _ in ends], [b for _, b in ends], across, list(map(len, across)))


class PebbleGame:
    """The game of some links, played to its end; ``redundant`` are the links that those before them imply, ascending.

    The pebbles of joint v lie on links to ``first[v]`` and ``second[v]``; where one is free it is the second. What a
    joint pays for as it is taken off lies there from the beginning: nothing leads to it before the links of its
    neighbours are played.
    """

    def __init__(self, joints: int, ends: Sequence[Ends]) -> None:
        self.net = neighbours_of(ends, joints)
        self.first, self.second = [FREE] * joints, [FREE] * joints
        self.blocks = RigidBlocks(joints)
        self.redundant: list[int] = []
        first, (tail, head, *_) = self.first, self.net
        for i in reversed(self._played_for()):
            a, b = tail[i], head[i]
            if self._is_rigid_pair(a, b):
                self.redundant.append(i)
                continue
            reached = self.gather(a, b)
            if reached is None:
                first[a] = b
            else:
                self.redundant.append(i)
                self._condense(a, b, reached)

    def _played_for(self) -> list[int]:
        """Return the links that go with no joint, last to first; all others are paid for."""
        tail, head, _, degree = self.net
        self._take_off([v for v, number in enumerate(degree) if number <= 2])
        played, queue = [], list[int]()
        for i, a, b in zip(range(len(tail) - 1, -1, -1), reversed(tail), reversed(head), strict=True):
            d, e = degree[a], degree[b]
            if d and e:
                played.append(i)
                degree[a], degree[b] = d - 1, e - 1
                if d <= 3:
                    queue.append(a)
                if e <= 3:
                    queue.append(b)
                if queue:
                    self._take_off(queue)
                    queue.clear()
        return played

    def _take_off(self, queue: list[int]) -> None:
        """Let joints of at most two links, to different joints, pay for these, and then others that have no more left.

        A joint that is off has no links left, and a link that is gone by itself comes after all that are left.
        """
        first, second, (_, _, across, degree) = self.first, self.second, self.net
        for v in queue:
            number = degree[v]
            if not number:
                continue
            joined = iter(across[v])
            while not degree[w := next(joined)]:
                pass
            if number == 2:
                while not degree[x := next(joined)]:
                    pass
                if x == w:
                    continue
                second[v] = x
                degree[x] = remaining = degree[x] - 1
                if remaining <= 2:
                    queue.append(x)
            first[v] = w
            degree[v] = 0
            degree[w] = remaining = degree[w] - 1
            if remaining <= 2:
                queue.append(w)

    def _is_rigid_pair(self, a: int, b: int) -> bool:
        """Return whether one block contains both joints, and let it contain both from now on.

        A joint that lies in no block pays for links of its own, and none of them makes the block rigid: in their stead
        it pays for links to the poles, so that what is paid for stays independent and spans the same. In every circuit
        of the link between a and b all that such a joint pays for occurs, because at least three links meet at each of
        its joints, and with it links of the block.
        """
        blocks, of = self.blocks, self.blocks.of
        g, h = of[a], of[b]
        if g < 0:
            g = self._fixing(a, b)
        if h < 0:
            h = self._fixing(b, a)
        if not (g == h >= 0 or blocks.is_same(g, h)):
            return False
        for v in (a, b):
            if of[v] < 0:
                of[v] = g
                self.first[v], self.second[v] = blocks.poles(g)
        return True

    def _fixing(self, v: int, other: int) -> int:
        """Return the rigid block to which v's two links fix it, neither leading to ``other``; or NONE."""
        of, w, x = self.blocks.of, self.first[v], self.second[v]
        if x < 0 or w == other or x == other:
            return NONE
        g, h = of[w], of[x]
        return g if g == h or self.blocks.is_same(g, h) else NONE

    def gather(self, a: int, b: int) -> list[int] | None:
        """Free both pebbles of a, and then of b; return the joints that were reached where the fourth cannot be had."""
        first, second = self.first, self.second
        while second[a] >= 0 or first[a] >= 0:
            self.bring(a, a)
        reached = None
        while reached is None and (second[b] >= 0 or first[b] >= 0):
            reached = self.bring(b, a)
        return reached

    def bring(self, root: int, held: int) -> list[int] | None:
        """Free one more pebble at ``root``, keeping those of ``held``; return the joints reached if there is none."""
        first, second = self.first, self.second
        via = {FREE: root, root: root, held: root}
        queue = [root]
        for v in queue:
            for w in (first[v], second[v]):
                if w not in via:
                    via[w] = v
                    if second[w] < 0:
                        self._move(w, root, via)
                        return None
                    queue.append(w)
        return queue

    def _move(self, w: int, root: int, via: dict[int, int]) -> None:
        """Move a free pebble of ``w`` to ``root``: every link on the way is paid for from its other end."""
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
        """Make one rigid block of a and the joints that were reached, all held by a and b.

        Both pebbles of a are free, and one of b. The links of each joint reached become two, to a and to b.
        """
        first, second = self.first, self.second
        for v in reached:
            first[v], second[v] = a, b
        first[a] = second[a] = second[b] = FREE
        self.blocks.unite([a, *(v for v in reached if v != a)], (a, b))

    def labels(self) -> list[int]:
        """Return for every link the first one of its block, itself where it is in none."""
        tail, head, *_ = self.net
        representative: dict[int, int] = {}
        blocks = (self.blocks.common(a, b) for a, b in zip(tail, head, strict=True))
        return [i if block < 0 else representative.setdefault(block, i) for i, block in enumerate(blocks)]

    def complete_blocks(self) -> None:
        """Make every rigid set of joints a block, whether its links depend or not.

        Two links x-y and x-z turn together if and only if the distance of y and z is fixed: with three pebbles held at
        x and y none can be had at z. All links of a cluster are found so, because a rigid graph stays connected
        without a joint.
        """
        for x in range(len(self.first)):
            check()
            apart: list[int] = []
            for z in self.net.across[x]:
                if not any(y == z or self._turn_together(x, y, z) for y in apart):
                    apart.append(z)

    def _turn_together(self, x: int, y: int, z: int) -> bool:
        """Return whether links x-y and x-z turn together; then all joints between them become one block."""
        first, second, block = self.first, self.second, self.blocks.common(x, y)
        if block >= 0 and block == self.blocks.common(x, z):
            return True
        while second[x] >= 0 or first[x] >= 0:
            self.bring(x, x)
        if second[y] >= 0:
            self.bring(y, x)
        first[x] = second[x] = x
        second[y] = y
        reached = None if second[z] < 0 else self.bring(z, z)
        first[x] = second[x] = second[y] = FREE
        if reached is not None:
            self._condense(x, y, reached)
        return reached is not None


class PlaneGraph:
    """A graph of links in two dimensions; see `dofkit.mobility.graph.links.LineGraph`."""

    def __init__(self, joints: int, ends: Sequence[Ends]) -> None:
        self._joints, self._ends = joints, ends
        self._game = PebbleGame(joints, ends)

    @property
    def redundant(self) -> list[int]:
        return self._game.redundant

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        """With three pebbles at its ends, what they reach is tight, and lies in every tight set that holds both."""
        redundant = set(self.redundant)
        link = {frozenset(pair): i for i, pair in enumerate(self._ends) if i not in redundant}
        basis = PebbleGame(self._joints, [self._ends[i] for i in link.values()])
        for i in links:
            check()
            reached = basis.gather(*self._ends[i]) or ()
            paid = ((v, w) for v in reached for w in (basis.first[v], basis.second[v]) if w >= 0)
            yield i, sorted(link[frozenset(pair)] for pair in paid)

    @cached_property
    def _groups(self) -> list[list[int]]:
        return [group for group in _by_label(self._game.labels()) if len(group) > 1]

    def groups(self) -> list[list[int]]:
        return self._groups

    def clusters(self) -> list[list[int]]:
        if len(self._game.net.tail) - len(self.redundant) == 2 * self._joints - 3:
            return [list(range(self._joints))]
        game = deepcopy(self._game)
        game.complete_blocks()
        sets = [sorted({v for i in links for v in self._ends[i]}) for links in _by_label(game.labels())]
        alone = set(range(self._joints)).difference(*sets)
        return sorted([*sets, *([v] for v in alone)])

    def proof(self) -> Proof:
        return _PROOF


def _by_label(labels: Sequence[Any]) -> list[list[int]]:
    """Return the places of each label, in the order in which the labels first occur."""
    places: dict[Any, list[int]] = {}
    for place, label in enumerate(labels):
        places.setdefault(label, []).append(place)
    return list(places.values())
