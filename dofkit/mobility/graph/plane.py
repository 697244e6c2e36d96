"""Links in the plane: the (2,3) pebble game, circuits, groups and rigid clusters.

Every joint has two pebbles. A link is independent of those before it if and only if all four pebbles of its joints can
be gathered there; then one of them is put on the link ("covers" it) [JacobsHendrickson1997], by [Laman1970]. If the
fourth cannot be gathered, the joints that were reached form a rigid block. The covered links of the block are then
replaced by links from every joint to the two ends of the link, which make it rigid too, so that later searches are
short.

First the links are removed, last to first, and with them all joints that then have at most two links. Such a joint
makes its links independent of all others (0-extension [Henneberg1911]): its pebbles cover them without a search. The
game is played only for the other links, whose joints still have three links each when all later ones are removed. It
needs no search if one block contains both ends, or if a joint outside the block covers two links to joints of the block
other than the other end: then the link is redundant.
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
#: In place of a joint: the pebble is free.
FREE = -1


class Neighbours(NamedTuple):
    """The joints ``adjacent[v]`` to which links of joint v lead, in the order of the links.

    Link i joins ``tail[i]`` and ``head[i]``; ``degree[v]``: the number of links of joint v that are not yet removed.
    """

    tail: list[int]
    head: list[int]
    adjacent: list[list[int]]
    degree: list[int]


def neighbours_of(ends: Sequence[Ends], joints: int) -> Neighbours:
    """Return the neighbours of all joints."""
    adjacent: list[list[int]] = [[] for _ in range(joints)]
    for a, b in ends:
        adjacent[a].append(b)
        adjacent[b].append(a)
    return Neighbours([a for a, _ in ends], [b for _, b in ends], adjacent, list(map(len, adjacent)))


class PebbleGame:
    """The pebble game of some links, played to its end; ``redundant``: the links implied by earlier ones, ascending.

    The pebbles of joint v cover links to ``first[v]`` and ``second[v]`` (`FREE` if a pebble is free, the second one
    first). Links of removed joints are covered from the beginning: no search comes to such a joint before the links of
    its neighbours are played.
    """

    def __init__(self, joints: int, ends: Sequence[Ends]) -> None:
        self.net = neighbours_of(ends, joints)
        self.first, self.second = [FREE] * joints, [FREE] * joints
        self.blocks = RigidBlocks(joints)
        self.redundant: list[int] = []
        first, (tail, head, *_) = self.first, self.net
        for i in reversed(self._links_to_play()):
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

    def _links_to_play(self) -> list[int]:
        """Return the links that the pebble game has to decide, last to first; cover those removed with a joint."""
        tail, head, _, degree = self.net
        self._remove_joints([v for v, number in enumerate(degree) if number <= 2])
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
                    self._remove_joints(queue)
                    queue.clear()
        return played

    def _remove_joints(self, queue: list[int]) -> None:
        """Remove the joints in ``queue``, with at most two links, to different joints, then others that become such.

        A removed joint has the degree 0 and covers its links. Links removed without a joint come last in ``adjacent``.
        """
        first, second, (_, _, adjacent, degree) = self.first, self.second, self.net
        for v in queue:
            number = degree[v]
            if not number:
                continue
            joined = iter(adjacent[v])
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
        """Return whether one block fixes the distance of both joints; then let it contain both from now on.

        A joint that is added to the block covers links to its poles, instead of its own two links, so that the covered
        links stay independent with the same span. Its own links and some of the block are in every circuit of the link
        a-b, because at least three links of a circuit meet at each joint.
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
        """Return the block to which v's two covered links fix it, neither leading to ``other``, or NONE."""
        of, w, x = self.blocks.of, self.first[v], self.second[v]
        if x < 0 or w == other or x == other:
            return NONE
        g, h = of[w], of[x]
        return g if g == h or self.blocks.is_same(g, h) else NONE

    def gather(self, a: int, b: int) -> list[int] | None:
        """Gather both pebbles of a, then of b; return None if all four are free, else the joints that were reached."""
        first, second = self.first, self.second
        while second[a] >= 0 or first[a] >= 0:
            self.bring(a, a)
        reached = None
        while reached is None and (second[b] >= 0 or first[b] >= 0):
            reached = self.bring(b, a)
        return reached

    def bring(self, root: int, held: int) -> list[int] | None:
        """Free one more pebble at ``root``, none from ``held``; return None, or the joints reached if there is none."""
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
        """Move a free pebble of ``w`` to ``root``: every link on the path is then covered from its other end."""
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
        """Unite a and the joints that were reached to one block with the poles a and b.

        Each joint then covers links to a and to b; both pebbles of a and one of b are free.
        """
        first, second = self.first, self.second
        for v in reached:
            first[v], second[v] = a, b
        first[a] = second[a] = second[b] = FREE
        self.blocks.unite([a, *(v for v in reached if v != a)], (a, b))

    def labels(self) -> list[int]:
        """Return for every link the number of the first link of its block; its own number if it is in none."""
        tail, head, *_ = self.net
        representative: dict[int, int] = {}
        blocks = (self.blocks.common(a, b) for a, b in zip(tail, head, strict=True))
        return [i if block < 0 else representative.setdefault(block, i) for i, block in enumerate(blocks)]

    def complete_blocks(self) -> None:
        """Make every rigid set of joints a block, even if its links are independent.

        Links x-y and x-z rotate together if and only if the distance of y and z is fixed: with three pebbles kept at x
        and y none can be gathered at z. All links of a cluster are so related: it is connected without any one joint.
        """
        for x in range(len(self.first)):
            check()
            independent: list[int] = []
            for z in self.net.adjacent[x]:
                if not any(y == z or self._rotate_together(x, y, z) for y in independent):
                    independent.append(z)

    def _rotate_together(self, x: int, y: int, z: int) -> bool:
        """Return whether links x-y and x-z rotate together; then unite all joints that were reached to a block."""
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
        """Yield (link, the independent links with which it is a minimal dependent set) for redundant ``links``.

        With three pebbles at its ends, the joints reached are the smallest tight set with both; it covers the circuit.
        """
        redundant = set(self.redundant)
        link = {frozenset(pair): i for i, pair in enumerate(self._ends) if i not in redundant}
        basis = PebbleGame(self._joints, [self._ends[i] for i in link.values()])
        for i in links:
            check()
            reached = basis.gather(*self._ends[i]) or ()
            covered = ((v, w) for v in reached for w in (basis.first[v], basis.second[v]) if w >= 0)
            yield i, sorted(link[frozenset(pair)] for pair in covered)

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
    """Return the positions of each label, in the order in which the labels first occur."""
    places: dict[Any, list[int]] = {}
    for place, label in enumerate(labels):
        places.setdefault(label, []).append(place)
    return list(places.values())
