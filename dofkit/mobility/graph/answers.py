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

from dofkit.mobility.graph.answer import GraphAnswer, Proof
from dofkit.mobility.graph.line import LineGraph
from dofkit.mobility.graph.links import Joint, Link, LinkageError, read
from dofkit.mobility.graph.plane import PlaneGraph
from dofkit.mobility.graph.result import Group, Hinge, Linkage
from dofkit.mobility.graph.space import SpaceGraph

if TYPE_CHECKING:
    import networkx as nx

__all__ = ["Group", "Hinge", "Linkage", "LinkageError", "Proof", "linkage", "redundant_links"]


#: The class that answers in each dimension.
_GRAPHS: dict[int, type[GraphAnswer]] = {1: LineGraph, 2: PlaneGraph, 3: SpaceGraph}


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
    return Linkage(dimension, graph, _GRAPHS[dimension](len(graph.joints), graph.ends))


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
