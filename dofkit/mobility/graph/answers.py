"""The rigid-link graph: what is redundant, what is rigid and what moves, where all joints are in general position.

Plain graphs in, no scene needed. `linkage` answers everything about a graph, `redundant_links` one question.

| dimension | what decides | how sure |
|---|---|---|
| 1 | spanning forest [Kirchhoff1847] | proved |
| 2 | the (2,3) pebble game [PollaczekGeiringer1927] [Laman1970] [JacobsHendrickson1997] | proved |
| 3 | joints of three links taken off, rank at random positions [SchwartzZippel] | proved where counts agree |
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on
from dofkit.mobility.graph.answer import GraphAnswer, Proof
from dofkit.mobility.graph.links import Joint, Link, LinkageError, read
from dofkit.mobility.graph.result import Group, Hinge, Linkage

if TYPE_CHECKING:
    import networkx as nx

__all__ = ["Group", "Hinge", "Linkage", "LinkageError", "Proof", "linkage", "redundant_links"]


#: What answers in each dimension, and where it lives: imported when it is first asked for.
_GRAPHS = {1: ("line", "LineGraph"), 2: ("plane", "PlaneGraph"), 3: ("space", "SpaceGraph")}


def linkage(links: Iterable[Link] | nx.Graph[Any], dimension: int = 2, joints: Iterable[Joint] = ()) -> Linkage:
    """How joints in general position can move that keep the distances of some pairs.

    ``links``: pairs of hashable joints, or a networkx graph; ``joints``: further ones, which need no link. A pair may
    occur more than once. Of a dependent set the last link is the redundant one. The same links in the same order give
    the same answer in every run. Raises LinkageError for what is no list of links, or a dimension beyond 1, 2 and 3.

    >>> braced = linkage(zip("ABCDAB", "BCDACD"))
    >>> braced.rank, braced.freedom, braced.redundant, braced.clusters
    (5, 3, [('B', 'D')], [['A', 'B', 'C', 'D']])
    """
    if not isinstance(dimension, int) or dimension not in (1, 2, 3):
        raise LinkageError(f"links lie in 1, 2 or 3 dimensions, not {dimension!r}")
    graph = read(links, joints)
    return Linkage(dimension, graph, _graph_of(dimension)(len(graph.joints), graph.ends))


def redundant_links(links: Iterable[Link] | nx.Graph[Any], dimension: int) -> list[Link]:
    """The links that others make superfluous in general position, in the order given.

    Of a dependent set the last written is the redundant one: a link is redundant if and only if those
    before it already fix its length to first order. Raises LinkageError for what is no list of links.

    >>> redundant_links([("A", "B"), ("B", "C"), ("C", "D"), ("D", "A"), ("A", "C"), ("B", "D")], 2)
    [('B', 'D')]
    """
    return linkage(links, dimension).redundant


def _graph_of(dimension: int) -> type[GraphAnswer]:
    module, name = _GRAPHS[dimension]
    found: type[GraphAnswer] = handed_on(__name__, {name: f"dofkit.mobility.graph.{module}"}, name)
    return found
