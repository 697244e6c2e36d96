"""Graphs of links as users give them, with joints and links numbered; links along a line; and the type `Proof`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from dofkit.base.errors import DofkitError
from dofkit.base.libraries import nx

if TYPE_CHECKING:
    from dofkit.base.verdicts import Verdict

#: Any hashable name.
Joint = Any
Link = tuple[Any, Any]
#: The numbers of a link's two joints.
Ends = tuple[int, int]


class LinkageError(DofkitError):
    """A link joins a joint to itself or is no pair, the dimension is not 1, 2 or 3, or a graph is too large."""


class Proof(NamedTuple):
    """How certain an answer is, and the theorem or computation on which it is based."""

    verdict: Verdict
    reason: str


class Graph(NamedTuple):
    """The joints in the order in which they first occur, the links as given, and the numbers of their two joints."""

    joints: tuple[Joint, ...]
    links: Sequence[Link]
    ends: list[Ends]


def read(links: Iterable[Link] | Any, joints: Iterable[Joint] = ()) -> Graph:
    """Return the graph with its joints numbered; raises LinkageError that names the first invalid link."""
    pairs = _pairs(links)
    names = chain(getattr(links, "nodes", ()), joints, chain.from_iterable(pairs))
    try:
        number = {v: i for i, v in enumerate(dict.fromkeys(names))}
    except TypeError as error:
        raise LinkageError(f"joints need distinct names: {error}") from error
    ends = [(number[a], number[b]) for a, b in pairs]
    for i, (a, b) in enumerate(ends):
        if a == b:
            raise LinkageError(f"link number {i + 1} joins {pairs[i][0]!r} to itself")
    return Graph(tuple(number), pairs, ends)


def _pairs(links: Iterable[Link] | Any) -> Sequence[Link]:
    """Return the links of a graph, an array with two columns, or a list of pairs, as tuples."""
    if hasattr(links, "nodes") and hasattr(links, "edges"):
        return [(a, b) for a, b, *_ in links.edges()]
    try:
        pairs = links.tolist() if hasattr(links, "tolist") else list(links)
    except TypeError as error:
        raise LinkageError(f"links are a list of pairs or a graph, not {links!r}") from error
    kinds = set(map(type, pairs))
    if not kinds <= {tuple, list} or not set(map(len, pairs)) <= {2}:
        for place, link in enumerate(pairs):
            if not isinstance(link, tuple | list) or len(link) != 2:
                raise LinkageError(f"link number {place + 1} is {link!r}; a link is a pair of joints")
    return list(map(tuple, pairs))


# Links along a line

_PROOF = Proof("proved", "spanning forest: in one dimension a link is redundant if and only if it closes a cycle")


class LineGraph:
    """Links along a line: one is redundant if and only if it closes a cycle [Kirchhoff1847].

    Joints and links are numbers from 0; ``ends`` are the joints of each link. ``redundant``: the links that are
    implied by those before them, ascending.
    """

    def __init__(self, joints: int, ends: Sequence[Ends]) -> None:
        self._ends = ends
        self.redundant: list[int] = []
        self._forest: nx.Graph[int] = nx.Graph()
        self._forest.add_nodes_from(range(joints))
        trees: nx.utils.UnionFind[int] = nx.utils.UnionFind(range(joints))
        for i, (a, b) in enumerate(self._ends):
            if trees[a] == trees[b]:
                self.redundant.append(i)
            else:
                trees.union(a, b)
                self._forest.add_edge(a, b, number=i)

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        """Yield (link, the earlier links with which it is a minimal dependent set) for redundant ``links``."""
        for i in links:
            path = nx.shortest_path(self._forest, *self._ends[i])
            yield i, sorted(self._forest.edges[pair]["number"] for pair in pairwise(path))

    def groups(self) -> list[list[int]]:
        """Return the classes of links of which any two are in a minimal dependent set, without single links."""
        links: dict[frozenset[int], list[int]] = {}
        for i, pair in enumerate(self._ends):
            links.setdefault(frozenset(pair), []).append(i)
        blocks = nx.biconnected_component_edges(nx.Graph(self._ends))
        members = (sorted(i for pair in block for i in links[frozenset(pair)]) for block in blocks)
        return sorted(group for group in members if len(group) > 1)

    def clusters(self) -> list[list[int]]:
        """Return the maximal sets of joints that keep all their distances; every joint is in one at least."""
        return sorted(map(sorted, nx.connected_components(self._forest)))

    def proof(self) -> Proof:
        """Return how certain the redundant links are, and why."""
        return _PROOF
