"""A graph of rigid links in general position: redundant links, rigid clusters and freedom, without a scene.

`linkage` returns all results for a graph, `redundant_links` the redundant links only.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from dofkit.base.deadline import gc_rarely
from dofkit.base.display import Displayed
from dofkit.base.wording import many
from dofkit.mobility.graph.links import Joint, LineGraph, Link, LinkageError, Proof, read
from dofkit.mobility.graph.plane import PlaneGraph
from dofkit.mobility.graph.space import SpaceGraph

if TYPE_CHECKING:
    import networkx as nx

    from dofkit.base.verdicts import Verdict

#: The class that analyses graphs of each dimension.
_GRAPHS: dict[int, type[LineGraph | PlaneGraph | SpaceGraph]] = {1: LineGraph, 2: PlaneGraph, 3: SpaceGraph}


class Group(NamedTuple):
    """Links of which any two lie in some minimal dependent set; ``nullity`` of them are redundant."""

    nullity: int
    members: list[Link]


@dataclass(frozen=True, eq=False)
class Linkage(Displayed):
    """The mobility of joints in general position whose links keep their lengths; made by `dofkit.linkage`.

    Numbers count independent velocities. Links and joints are those that were given, in their order. Circuits, groups
    and clusters are computed when they are first asked for.

    Examples
    --------
    >>> import dofkit
    >>> square = dofkit.linkage([("A", "B"), ("B", "C"), ("C", "D"), ("D", "A")], dimension=2)
    >>> square.rank, square.freedom, square.redundant
    (4, 4, [])
    """

    dimension: int
    joints: tuple[Joint, ...]
    links: tuple[Link, ...]
    _answer: LineGraph | PlaneGraph | SpaceGraph = field(repr=False)

    @property
    def rank(self) -> int:
        """The number of independent links."""
        return len(self.links) - len(self._answer.redundant)

    @property
    def freedom(self) -> int:
        """The number of independent infinitesimal motions, n d - rank, which in general position are finite ones."""
        return len(self.joints) * self.dimension - self.rank

    @property
    def inner_freedom(self) -> int:
        """The freedom without the rigid motions of all joints together, d(d+1)/2 if there are enough joints."""
        n, d = len(self.joints), self.dimension
        return self.freedom - (n * d - n * (n - 1) // 2 if n < d else d * (d + 1) // 2)

    @property
    def rigid(self) -> bool:
        """Whether the joints can only move as one rigid body."""
        return self.inner_freedom == 0

    @cached_property
    def redundant_places(self) -> tuple[int, ...]:
        """The places of the redundant links in ``links``, from 0."""
        return tuple(self._answer.redundant)

    @cached_property
    def redundant(self) -> list[Link]:
        """The links that are implied by those given before them, in the order given."""
        return [self.links[i] for i in self.redundant_places]

    @cached_property
    def circuit_places(self) -> Mapping[int, list[int]]:
        """The places of the `circuit` of every redundant link, by the link's place."""
        circuits = dict(self._answer.circuits(self.redundant_places))
        return {i: circuits[i] for i in self.redundant_places}

    def circuit(self, link: Link) -> list[Link]:
        """Return the earlier links that fix the length of a redundant one; none of them can be left out.

        They are independent; with the link itself they are a minimal dependent set. Of a pair given more than once the
        last is meant. Raises LinkageError if the link is not redundant.

        >>> from dofkit import linkage
        >>> linkage([("A", "B"), ("B", "C"), ("B", "A")]).circuit(("A", "B"))
        [('A', 'B')]
        """
        ends = {*link}
        for i in reversed(self.redundant_places):
            if ends == {*self.links[i]}:
                ((_, places),) = self._answer.circuits([i])
                return [self.links[j] for j in places]
        raise LinkageError(f"{link!r} is not a redundant link")

    @cached_property
    def redundancies(self) -> list[Group]:
        """The groups of dependent links: the connected components of the matroid that are more than one link."""
        redundant = set(self.redundant_places)
        groups = sorted(self._answer.groups())
        return [Group(len(redundant.intersection(g)), [self.links[i] for i in g]) for g in groups]

    @cached_property
    def clusters(self) -> list[list[Joint]]:
        """The maximal sets of joints that keep all their distances. A joint may be in several."""
        return [[self.joints[v] for v in members] for members in self._answer.clusters()]

    @property
    def proof(self) -> Proof:
        """How certain the rank, the freedom and the redundant links are, and why."""
        return self._answer.proof()

    @property
    def verdict(self) -> Verdict:
        """How certain the rank, the freedom and the redundant links are."""
        return self.proof.verdict

    def __str__(self) -> str:
        n, d, k = len(self.joints), self.dimension, len(self.links)
        redundant = f"{len(self.redundant_places)} redundant" if self.redundant_places else "none redundant"
        body = " beyond the motions of one body" if self.inner_freedom else ": one rigid body"
        return (
            f"{many(n, 'joint')} in {many(d, 'dimension')}, {k} link{'s' * (k != 1)}, {redundant}: "
            f"f = N d - rank = {n * d} - {self.rank} = {self.freedom}, {self.inner_freedom}{body} ({self.verdict})"
        )


def linkage(links: Iterable[Link] | nx.Graph[Any], dimension: int = 2, joints: Iterable[Joint] = ()) -> Linkage:
    """Return how joints in general position can move if links keep the distances of some pairs.

    Parameters
    ----------
    links
        Pairs of hashable joints, or a networkx graph. A pair may occur more than once.
    dimension
        1, 2 or 3.
    joints
        Further joints, which need no link.

    Returns
    -------
    Linkage
        Rank, freedom, redundant links and rigid clusters. Of a dependent set the last link is the redundant one.

    Raises
    ------
    LinkageError
        If ``links`` are no links, or the dimension is not 1, 2 or 3.

    References
    ----------
    G. Laman, On graphs and rigidity of plane skeletal structures, 1970.

    Examples
    --------
    >>> braced = linkage(zip("ABCDAB", "BCDACD"))
    >>> braced.rank, braced.freedom, braced.redundant, braced.clusters
    (5, 3, [('B', 'D')], [['A', 'B', 'C', 'D']])
    """
    if not isinstance(dimension, int) or dimension not in (1, 2, 3):
        raise LinkageError(f"links lie in 1, 2 or 3 dimensions, not {dimension!r}")
    graph = read(links, joints)
    return Linkage(dimension, graph.joints, tuple(graph.links), _GRAPHS[dimension](len(graph.joints), graph.ends))


@gc_rarely()
def redundant_links(links: Iterable[Link] | nx.Graph[Any], dimension: int) -> list[Link]:
    """Return the links that are redundant in general position, in the order given.

    A link is redundant if and only if the links before it already fix its length.

    Parameters
    ----------
    links, dimension
        As for `linkage`.

    Returns
    -------
    list of links
        As they were given.

    Raises
    ------
    LinkageError
        As for `linkage`.

    Examples
    --------
    >>> redundant_links([("A", "B"), ("B", "C"), ("C", "D"), ("D", "A"), ("A", "C"), ("B", "D")], 2)
    [('B', 'D')]
    """
    return linkage(links, dimension).redundant
