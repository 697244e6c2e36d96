"""The rigid-link graph: which links are redundant where all joints are in general position.

Plain graphs in, plain lists out; no scene is needed. ``links`` are pairs of hashable joints, or a networkx graph.
In one dimension a link is redundant when it closes a cycle; in two the (2,3) pebble game decides
(Pollaczek-Geiringer 1927, Laman 1970; Jacobs and Hendrickson 1997); in three no count does (the double banana
passes Maxwell's), so joints with three links or fewer are taken off, because their links are independent of
all others, and what is left is the rank of the rigidity matrix at random positions modulo a random prime.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Hashable, Iterable, Sequence
from typing import Any

import networkx as nx

from dofkit.errors import DofkitError

Joint = Hashable
Link = tuple[Any, Any]


class LinkageError(DofkitError):
    """A list of links that is none: a link from a joint to itself, or no pair; or a dimension beyond 1, 2, 3."""


def redundant_links(links: Iterable[Link] | nx.Graph, dimension: int) -> list[Link]:
    """The links that others make superfluous in general position, in the order given.

    Of a dependent set the last written is the redundant one: a link is redundant if and only if those
    before it already fix its length to first order. Raises LinkageError for what is no list of links.

    >>> redundant_links([("A", "B"), ("B", "C"), ("C", "D"), ("D", "A"), ("A", "C"), ("B", "D")], 2)
    [('B', 'D')]
    """
    given = [(link[0], link[1]) for link in _pairs(links)]
    if dimension not in _METHODS:
        raise LinkageError(f"links lie in 1, 2 or 3 dimensions, not {dimension!r}")
    numbers: dict[Joint, int] = {}
    edges = []
    for a, b in given:
        edges.append((numbers.setdefault(a, len(numbers)), numbers.setdefault(b, len(numbers))))
    return [given[i] for i in _METHODS[dimension](len(numbers), edges)]


def _pairs(links: Iterable[Link] | nx.Graph) -> list[Link]:
    found = list(links.edges()) if isinstance(links, nx.Graph) else list(links)
    for place, link in enumerate(found):
        if isinstance(link, str) or len(link) < 2 or (len(link) > 2 and not isinstance(links, nx.Graph)):
            raise LinkageError(f"link number {place + 1} is {link!r}; a link is a pair of joints")
        if link[0] == link[1]:
            raise LinkageError(f"link number {place + 1} joins {link[0]!r} to itself")
    return found


def _line(n: int, edges: Sequence[tuple[int, int]]) -> list[int]:
    """d = 1: a link is redundant when its ends are joined already."""
    forest = nx.utils.UnionFind(range(n))
    redundant = []
    for i, (a, b) in enumerate(edges):
        if forest[a] == forest[b]:
            redundant.append(i)
        else:
            forest.union(a, b)
    return redundant


def _plane(n: int, edges: Sequence[tuple[int, int]]) -> list[int]:
    """d = 2: the (2,3) pebble game; a link is independent if and only if four pebbles gather at its ends."""
    out: list[list[int]] = [[] for _ in range(n)]
    redundant = []
    for i, (a, b) in enumerate(edges):
        if _gather(out, a, b) and _gather(out, b, a) and _gather(out, a, b) and _gather(out, b, a):
            out[a].append(b)
        else:
            redundant.append(i)
    return redundant


def _gather(out: list[list[int]], root: int, other: int) -> bool:
    """Both pebbles of ``root`` free, ``other`` keeping its own; True where they are."""
    while len(out[root]) > 0:
        if not _bring(out, root, other):
            return False
    return True


def _bring(out: list[list[int]], root: int, other: int) -> bool:
    """Move one pebble to ``root`` along directed edges, not through ``other``."""
    came: dict[int, int] = {root: root, other: other}
    stack = [root]
    while stack:
        v = stack.pop()
        for w in out[v]:
            if w in came:
                continue
            came[w] = v
            if len(out[w]) < 2:
                _reverse(out, came, root, w)
                return True
            stack.append(w)
    return False


def _reverse(out: list[list[int]], came: dict[int, int], root: int, end: int) -> None:
    while end != root:
        before = came[end]
        out[before].remove(end)
        out[end].append(before)
        end = before


def _space(n: int, edges: Sequence[tuple[int, int]]) -> list[int]:
    """d = 3: rank over GF(p) at random positions, after joints of three links or fewer are taken off."""
    first: dict[frozenset[int], int] = {}
    for i, edge in enumerate(edges):
        first.setdefault(frozenset(edge), i)
    single = sorted(first.values())
    repeated = sorted(set(range(len(edges))) - set(single))
    core = [single[k] for k in _core(n, [edges[i] for i in single], 3)]
    return sorted(repeated + _dependent(core, edges)) if core else repeated


def _dependent(core: Sequence[int], edges: Sequence[tuple[int, int]]) -> list[int]:
    """The links of a core that depend on those before them, by the rigidity matrix at random positions."""
    from flint import nmod_mat

    from dofkit.exact.field import prime_for
    from dofkit.forms import pivots

    rng = random.Random("dofkit rigidity")
    p = prime_for(1, (), 0)
    joints = {v: k for k, v in enumerate(sorted({v for i in core for v in edges[i]}))}
    at = [[rng.randrange(p) for _ in range(3)] for _ in joints]
    table = [[0] * len(core) for _ in range(3 * len(joints))]
    for column, i in enumerate(core):
        a, b = (joints[v] for v in edges[i])
        for k in range(3):
            difference = (at[a][k] - at[b][k]) % p
            table[3 * a + k][column] = difference
            table[3 * b + k][column] = (p - difference) % p
    independent = set(pivots(nmod_mat(table, p)))
    return [i for column, i in enumerate(core) if column not in independent]


def _core(n: int, edges: Sequence[tuple[int, int]], degree: int) -> list[int]:
    """The links left when joints of at most ``degree`` links are taken off one after another."""
    at: dict[int, set[int]] = defaultdict(set)
    for i, (a, b) in enumerate(edges):
        at[a].add(i)
        at[b].add(i)
    pending = [v for v in range(n) if len(at[v]) <= degree]
    gone: set[int] = set()
    while pending:
        v = pending.pop()
        for i in list(at[v]):
            gone.add(i)
            w = edges[i][0] if edges[i][1] == v else edges[i][1]
            at[v].discard(i)
            at[w].discard(i)
            if len(at[w]) <= degree:
                pending.append(w)
    return [i for i in range(len(edges)) if i not in gone]


_METHODS = {1: _line, 2: _plane, 3: _space}
