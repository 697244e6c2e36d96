"""Links between particles: the truth is known from the construction of the graph, or by the exact rank."""

from __future__ import annotations

import random
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import combinations
from typing import TypeVar

from networkx.utils import UnionFind

from dofkit.benchmark.trials.construction import KnownScene, known_scene
from dofkit.benchmark.trials.frameworks import dependent, graph

Link = tuple[int, int]
T = TypeVar("T", bound=Hashable)


def _linked_scene(
    name: str, shape: tuple[int, int, Sequence[Link]], because: str, size: int, dof: int, over: Sequence[Link] | None
) -> KnownScene:
    """Return the scene of links l0, l1, ...; ``shape``: (joints, dimension, links), ``over``: redundant links."""
    joints, dimension, links = shape
    scene = {
        "dimension": dimension,
        "particles": [f"P{i}" for i in range(joints)],
        "constraints": [
            {"name": f"l{k}", "type": "link", "between": [f"P{a}", f"P{b}"]} for k, (a, b) in enumerate(links)
        ],
    }
    redundant = None if over is None else [f"l{k}" for k, link in enumerate(links) if link in set(over)]
    return known_scene(name, scene, because, size, dof=dof, redundancy=redundant)


def cliques() -> Iterator[KnownScene]:
    """All pairs of joints linked: the first d links of a joint fix it, each further one is redundant."""
    because = "d links fix a joint to a rigid framework; further links are redundant"
    sizes = {1: (4, 8, 16, 32), 2: (4, 8, 16, 32, 64), 3: (4, 5, 8, 16, 32)}
    for d, n in ((d, n) for d, ladder in sizes.items() for n in ladder):
        links = [(i, j) for j in range(n) for i in range(j)]
        needed = [(i, j) for i, j in links if i < d]
        for name, chosen in (("all pairs", links), ("only the links that are needed", needed)):
            over = [(i, j) for i, j in chosen if i >= d]
            rigid = d * (d + 1) // 2
            yield _linked_scene(f"{n} joints in dimension {d}, {name}", (n, d, chosen), because, n, rigid, over)


#: (dimension, m, n, dof, number of redundant links or None if not derived) for m joints linked with n others.
BIPARTITE = (
    (2, 3, 3, 3, 0), (2, 2, 6, 2 * 8 - 12, 0), (2, 3, 4, 3, 1), (2, 4, 4, 3, None), (2, 3, 8, 3, None),
    (2, 6, 6, 3, None), (3, 4, 6, 6, 0), (3, 5, 5, 6, 1), (3, 4, 4, 24 - 16, 0), (3, 3, 8, 33 - 24, 0),
    (3, 5, 6, 6, None), (3, 6, 6, 6, None), (3, 8, 8, 6, None),
)  # fmt: skip


def complete_bipartite() -> Iterator[KnownScene]:
    """Every joint of one kind linked with every joint of another [BolkerRoth1980]."""
    because = "rigid in the plane from 3 and 3 on, in space from 4 and 6 or 5 and 5 on (Bolker and Roth 1980)"
    for d, m, n, dof, over in BIPARTITE:
        links = [(i, m + j) for j in range(n) for i in range(m)]
        redundant = None if over is None else links[len(links) - over :]
        yield _linked_scene(f"{m} and {n} joints in dimension {d}", (m + n, d, links), because, m + n, dof, redundant)


def bananas() -> Iterator[KnownScene]:
    """Rigid spindles of two ends and a triangle: dependent on the same two ends; independent in a ring.

    On the same ends the last link of every spindle but the first is redundant, as all fix the distance of the ends.
    A ring of three or more is a polygon of rigid bars, each free to turn about its axis.
    """
    for n in (2, 3, 4, 8, 16, 32, 64):
        same = [link for k in range(n) for link in _spindle(0, 1, 2 + 3 * k)]
        ring = [link for k in range(n) for link in _spindle(k, (k + 1) % n, n + 3 * k)]
        row = [link for k in range(n) for link in _spindle(k, k + 1, n + 1 + 3 * k)]
        # how they stand, joints, links, dof, redundant, because
        members: list[tuple[str, int, list[Link], int, list[Link], str]] = [
            ("on the same two joints", 2 + 3 * n, same, 6 + n - 1, same[17::9],
             "each holds the distance of its ends: all but the first do so once more; one hinge, each turns about it"),
            ("in a ring", 4 * n, ring, 3 * n, [],
             "a polygon of n bars in space (2 n) whose bars turn about themselves (n): no link too many"),
            ("in a row", 4 * n + 1, row, 3 * n + 3, [],
             "n rigid bodies, each on the last by a ball joint: 6 + 3 (n - 1)"),
        ]  # fmt: skip
        for how, joints, links, dof, over, because in members:
            if how != "in a ring" or n > 2:
                yield _linked_scene(f"{n} bananas {how}", (joints, 3, links), because, n, dof, over)


def _spindle(a: int, b: int, first: int) -> list[Link]:
    """Return the links of a spindle: a triangle, which begins with joint ``first``, linked to the ends a and b."""
    triangle = (first, first + 1, first + 2)
    return [*combinations(triangle, 2), *((end, c) for end in (a, b) for c in triangle)]


def henneberg() -> Iterator[KnownScene]:
    """Built joint by joint [Henneberg1911] [TayWhiteley1985]: rigid without a redundant link.

    Each additional link is redundant; without the last link there is one freedom more.
    """
    because = "each step keeps the links independent, and with d joints more than links the framework rigid"
    ladder = {2: (4, 8, 16, 32, 64, 128, 256, 512), 3: (5, 8, 16, 32, 64, 128)}
    members = [(d, n, 0) for d, sizes in ladder.items() for n in sizes]
    for d, n, seed in (*members, (2, 8, 1), (3, 8, 1)):
        links = henneberg_links(n, d, random.Random(f"{n} {d} {seed}"))
        pairs = {frozenset(link) for link in links}
        others = [link for link in combinations(range(n), 2) if frozenset(link) not in pairs]
        extra = random.Random(f"more {n} {d} {seed}").sample(others, min(len(others), 1 + n // 8))
        rigid = d * (d + 1) // 2
        for name, chosen, dof, over in (
            ("as put together", links, rigid, []),
            ("and links more", [*links, *extra], rigid, extra),
            ("one left out", links[:-1], rigid + 1, []),
        ):
            yield _linked_scene(f"{n} joints in dimension {d}, {seed}, {name}", (n, d, chosen), because, n, dof, over)


def henneberg_links(joints: int, dimension: int, rng: random.Random) -> list[Link]:
    """Return links by Henneberg's steps: a new joint is linked to d joints, or splits a link and gets d - 1 more."""
    links = list(combinations(range(dimension), 2))
    for new in range(dimension, joints):
        if new > dimension + 1 and rng.random() < 0.5:
            a, b = links.pop(rng.randrange(len(links)))
            others = [v for v in range(new) if v not in (a, b)]
            links += [(v, new) for v in (a, b, *rng.sample(others, dimension - 1))]
        else:
            links += [(v, new) for v in rng.sample(range(new), dimension)]
    return links


def trees_on_a_line() -> Iterator[KnownScene]:
    """Links along a line: one that closes a cycle is redundant, and every connected part moves by itself."""
    because = "one freedom for every connected part; the last link of a circle is redundant"
    for n in (4, 8, 16, 32, 64, 128, 256, 512):
        rng = random.Random(n)
        links = sorted({(min(a, b), max(a, b)) for a, b in (rng.sample(range(n), 2) for _ in range(n))})
        rng.shuffle(links)
        components, closing = union(range(n), links)
        tree = [link for link in links if link not in closing]
        for name, chosen, over in (("with circles", links, closing), ("without", tree, [])):
            yield _linked_scene(f"{n} joints on a line, {name}", (n, 1, chosen), because, n, components, over)


def union(vertices: Iterable[T], edges: Iterable[tuple[T, T]]) -> tuple[int, list[tuple[T, T]]]:
    """Return (number of connected components, edges that close a cycle with earlier edges) of a graph."""
    classes: UnionFind = UnionFind(vertices)
    closing = []
    for a, b in edges:
        if classes[a] == classes[b]:
            closing.append((a, b))
        classes.union(a, b)
    return sum(1 for _ in classes.to_sets()), closing


# With positions


def bars() -> Iterator[KnownScene]:
    """Random bars between joints at random places, some pairs twice: truth by the exact rank."""
    because = "the rank of the rigidity matrix over the rationals, at places in general position"
    for d, n in ((d, n) for n in (4, 6, 8, 12, 16) for d in (1, 2, 3)):
        for seed in range(2):
            drawn = graph(random.Random(f"bars {d} {n} {seed}"), d, n, twice=True)
            over = [f"bar{i}" for i in dependent(drawn)]
            about = f"{n} joints in dimension {d}, {seed}", drawn.scene(), because
            yield known_scene(*about, n, dof=drawn.by_rank(), redundancy=over)


def braced_grids() -> Iterator[KnownScene]:
    """A grid of m by m squares, some with a diagonal brace [BolkerCrapo1977].

    In the graph of rows and columns a brace is an edge between those of its square; a brace that closes a cycle is
    redundant, and every component of the graph turns by itself.
    """
    because = "Bolker and Crapo 1977: 3 + (parts of the graph of rows and columns) - 1"
    for m in (2, 3, 4, 6, 8, 12):
        squares = [(i, j) for i in range(m) for j in range(m)]
        cycle = [(i, i) for i in range(m)] + [(i, (i + 1) % m) for i in range(m)]
        pairs = [(f"p{i}_{j}", f"p{i + 1}_{j}") for i in range(m) for j in range(m + 1)]
        pairs += [(f"p{i}_{j}", f"p{i}_{j + 1}") for i in range(m + 1) for j in range(m)]
        for name, braced in (
            ("no", []),
            ("all", squares),
            ("a tree of", [(i, 0) for i in range(m)] + [(0, j) for j in range(1, m)]),
            ("a circle of", cycle),
            ("a diagonal of", cycle[:m]),
            ("a corner of", [(i, j) for i, j in squares if i < m // 2 and j < m // 2]),
        ):
            components, closing = union(range(2 * m), [(i, m + j) for i, j in braced])
            over = [f"brace{i}_{j - m}" for i, j in closing]
            braces = [(f"brace{i}_{j}", f"p{i}_{j}", f"p{i + 1}_{j + 1}") for i, j in braced]
            links = [{"type": "link", "between": list(pair)} for pair in pairs]
            links += [{"name": label, "type": "link", "between": [a, b]} for label, a, b in braces]
            particles = [{"name": f"p{i}_{j}", "at": [i, j]} for i in range(m + 1) for j in range(m + 1)]
            scene = {"dimension": 2, "particles": particles, "constraints": links}
            about = f"{m} by {m} squares, {name} braces", scene, because, m
            yield known_scene(*about, dof=3 + components - 1, redundancy=over)


FAMILIES = {
    "cliques": cliques,
    "complete bipartite": complete_bipartite,
    "double bananas": bananas,
    "Henneberg": henneberg,
    "links on a line": trees_on_a_line,
    "random bars": bars,
    "braced grids": braced_grids,
}
