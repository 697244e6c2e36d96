"""What is told of a graph of links."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from dofkit.base.display import Displayed
from dofkit.base.wording import many
from dofkit.mobility.graph.answer import GraphAnswer, Proof, Question
from dofkit.mobility.graph.links import Graph, Joint, Link, LinkageError

if TYPE_CHECKING:
    from dofkit.base.verdicts import Verdict


class Group(NamedTuple):
    """Links of which any two lie in some minimal dependent set; ``nullity`` of them are redundant."""

    nullity: int
    members: list[Link]


class Hinge(NamedTuple):
    """Joints that several rigid clusters share (one joint, in space also two), and the numbers of the clusters."""

    joints: tuple[Joint, ...]
    clusters: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Linkage(Displayed):
    """The mobility of joints in general position whose links keep their lengths; made by `dofkit.linkage`.

    Numbers count independent velocities. Links and joints are those that were given, in their order. Circuits, groups,
    clusters and hinges are computed when they are first asked for.

    Examples
    --------
    >>> import dofkit
    >>> square = dofkit.linkage([("A", "B"), ("B", "C"), ("C", "D"), ("D", "A")], dimension=2)
    >>> square.rank, square.freedom, square.redundant
    (4, 4, [])
    """

    dimension: int
    _graph: Graph = field(repr=False)
    _solved: GraphAnswer = field(repr=False)

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """As they first occur."""
        return self._graph.all_joints()

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """As given."""
        return self._graph.all_links()

    @property
    def rank(self) -> int:
        """Independent links."""
        return len(self._graph.links) - len(self._solved.redundant)

    @property
    def freedom(self) -> int:
        """n d - rank: independent infinitesimal motions, which in general position are finite ones."""
        return len(self._graph.joints) * self.dimension - self.rank

    @property
    def inner_freedom(self) -> int:
        """The freedom without the motions of the whole as one rigid body, d(d+1)/2 where there are joints enough."""
        n, d = len(self._graph.joints), self.dimension
        return self.freedom - (n * d - n * (n - 1) // 2 if n < d else d * (d + 1) // 2)

    @property
    def rigid(self) -> bool:
        """Can it move as one body only?"""
        return self.inner_freedom == 0

    @property
    def maxwell(self) -> int:
        """Maxwell's count n d - links: the freedom if no link were redundant [Maxwell1864]."""
        return len(self._graph.joints) * self.dimension - len(self._graph.links)

    @cached_property
    def redundant_places(self) -> tuple[int, ...]:
        """Where in ``links`` the redundant ones stand, from 0."""
        return tuple(self._solved.redundant)

    @cached_property
    def redundant(self) -> list[Link]:
        """Links that those given before them make superfluous, in the order given."""
        return self._graph.links_at(self.redundant_places)

    @cached_property
    def circuit_places(self) -> Mapping[int, list[int]]:
        """For every redundant link, by place, the places of its `circuit`."""
        found = dict(self._solved.circuits(self.redundant_places))
        return {i: found[i] for i in self.redundant_places}

    def circuit(self, link: Link) -> list[Link]:
        """The links given before a redundant one that fix its length; none of them can be left out.

        They are independent; with the link itself they are a minimal dependent set. Of a pair given more than once the
        last is meant. Raises LinkageError for what is no redundant link.

        >>> from dofkit import linkage
        >>> linkage([("A", "B"), ("B", "C"), ("B", "A")]).circuit(("A", "B"))
        [('A', 'B')]
        """
        ends = {*link}
        for i in reversed(self.redundant_places):
            if ends == {*self.links[i]}:
                ((_, found),) = self._solved.circuits([i])
                return [self.links[j] for j in found]
        raise LinkageError(f"{link!r} is not a redundant link")

    @cached_property
    def redundancies(self) -> list[Group]:
        """The groups of dependent links: the connected components of the matroid that are more than one link."""
        redundant = set(self.redundant_places)
        groups = sorted(self._solved.groups())
        return [Group(len(redundant.intersection(g)), [self.links[i] for i in g]) for g in groups]

    @cached_property
    def _clusters(self) -> list[list[int]]:
        return self._solved.clusters()

    @cached_property
    def clusters(self) -> list[list[Joint]]:
        """Rigid clusters: maximal sets of joints that keep all their distances. A joint may be in several."""
        return [[self.joints[v] for v in members] for members in self._clusters]

    @cached_property
    def hinges(self) -> list[Hinge]:
        """What clusters turn about: the joints that two or more of them share.

        The double banana has one, of two joints that need no link between them.
        """
        of: dict[int, list[int]] = {}
        for k, members in enumerate(self._clusters):
            for v in members:
                of.setdefault(v, []).append(k)
        shared: dict[tuple[int, ...], set[int]] = {}
        if self.dimension == 3:
            sets = [set(members) for members in self._clusters]
            for numbers in of.values():
                for j, k in combinations(numbers, 2):
                    both = tuple(sorted(sets[j] & sets[k]))
                    shared.setdefault(both, set()).update((j, k))
        else:
            shared = {(v,): set(numbers) for v, numbers in of.items() if len(numbers) > 1}
        return [
            Hinge(tuple(self.joints[v] for v in joints), tuple(sorted(shared[joints]))) for joints in sorted(shared)
        ]

    @cached_property
    def _clusters_of(self) -> Mapping[Joint, set[int]]:
        found: dict[Joint, set[int]] = {v: set() for v in self.joints}
        for k, members in enumerate(self.clusters):
            for v in members:
                found[v].add(k)
        return found

    def moves(self, a: Joint, b: Joint) -> bool:
        """Does the distance of two joints change in some motion? Raises LinkageError for what is no joint."""
        for joint in (a, b):
            if joint not in self._clusters_of:
                raise LinkageError(f"{joint!r} is not a joint")
        return a != b and not self._clusters_of[a] & self._clusters_of[b]

    def proof(self, question: Question) -> Proof:
        """How sure the answer to a question is, and why."""
        return self._solved.proof(question)

    @property
    def verdict(self) -> Verdict:
        """How sure rank, freedom and redundant links are."""
        return self.proof("redundant").verdict

    def __str__(self) -> str:
        n, d, k = len(self.joints), self.dimension, len(self.links)
        redundant = f"{len(self.redundant_places)} redundant" if self.redundant_places else "none redundant"
        body = " beyond the motions of one body" if self.inner_freedom else ": one rigid body"
        return (
            f"{many(n, 'joint')} in {many(d, 'dimension')}, {k} link{'s' * (k != 1)}, {redundant}: "
            f"f = N d - rank = {n * d} - {self.rank} = {self.freedom}, {self.inner_freedom}{body} ({self.verdict})"
        )
