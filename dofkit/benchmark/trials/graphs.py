"""Links of any length between particles: the truth is that of the graph, by how it is put together."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from itertools import combinations

from dofkit.benchmark.trials.construction import KnownScene, known_scene

Link = tuple[int, int]


def linked(joints: int, dimension: int, links: Sequence[Link]) -> dict[str, object]:
    """Particles and links of any length; the links are called l0, l1, ... in order."""
    return {
        "dimension": dimension,
        "particles": [f"P{i}" for i in range(joints)],
        "constraints": [
            {"name": f"l{k}", "type": "link", "between": [f"P{a}", f"P{b}"]} for k, (a, b) in enumerate(links)
        ],
    }


def _of(links: Sequence[Link], redundant: Sequence[Link]) -> list[str]:
    chosen = set(redundant)
    return [f"l{k}" for k, link in enumerate(links) if link in chosen]


def cliques(quick: bool) -> Iterator[KnownScene]:
    """All pairs, joint after joint: its first d links put a joint in its place, each further one is redundant."""
    sizes = {1: (4, 8, 16, 32), 2: (4, 8, 16, 32, 64), 3: (4, 5, 8, 16, 32)}
    for d, n in ((d, n) for d, ladder in sizes.items() for n in (ladder[:1] if quick else ladder)):
        links = [(i, j) for j in range(n) for i in range(j)]
        needed = [(i, j) for i, j in links if i < d]
        for name, chosen in (("all pairs", links), ("only the links that are needed", needed)):
            yield known_scene(
                f"{n} joints in dimension {d}, {name}",
                linked(n, d, chosen),
                "d links fix a joint to a rigid framework; further links are redundant",
                ("redundant",) if len(chosen) > len(needed) else ("plain",),
                size=n,
                dof=d * (d + 1) // 2,
                redundancy=_of(chosen, [(i, j) for i, j in chosen if i >= d]),
            )


def complete_bipartite(quick: bool) -> Iterator[KnownScene]:
    """Every joint of one kind with every one of the other [BolkerRoth1980]."""
    # (dimension, m, n, dof, redundant: None where it was not derived)
    known = [
        (2, 3, 3, 3, 0),
        (2, 2, 6, 2 * 8 - 12, 0),
        (2, 3, 4, 3, 1),
        (2, 4, 4, 3, None),
        (2, 3, 8, 3, None),
        (2, 6, 6, 3, None),
        (3, 4, 6, 6, 0),
        (3, 5, 5, 6, 1),
        (3, 4, 4, 24 - 16, 0),
        (3, 3, 8, 33 - 24, 0),
        (3, 5, 6, 6, None),
        (3, 6, 6, 6, None),
        (3, 8, 8, 6, None),
    ]
    for d, m, n, dof, over in known[:: 5 if quick else 1]:
        links = [(i, m + j) for j in range(n) for i in range(m)]
        yield known_scene(
            f"{m} and {n} joints in dimension {d}",
            linked(m + n, d, links),
            "rigid in the plane from 3 and 3 on, in space from 4 and 6 or 5 and 5 on (Bolker and Roth 1980)",
            ("redundant",) if over is None or over else ("plain",),
            size=m + n,
            dof=dof,
            redundancy=None if over is None else _of(links, links[len(links) - over :]),
        )


def bananas(quick: bool) -> Iterator[KnownScene]:
    """Rigid spindles, each of two ends and a triangle: on the same two ends they are dependent; in a ring they are not.

    On the same ends: the last link of every one but the first says again how far these are apart. In a ring of three
    or more: a polygon of rigid bars, each free to turn about itself.
    """
    for n in (2, 3) if quick else (2, 3, 4, 8, 16, 32, 64):
        same = [link for k in range(n) for link in _spindle(0, 1, 2 + 3 * k)]
        ring = [link for k in range(n) for link in _spindle(k, (k + 1) % n, n + 3 * k)]
        row = [link for k in range(n) for link in _spindle(k, k + 1, n + 1 + 3 * k)]
        # how they stand, joints, links, dof, redundant, because, trait
        members: list[tuple[str, int, list[Link], int, list[str], str, str]] = [
            ("on the same two joints", 2 + 3 * n, same, 6 + n - 1, [f"l{9 * k + 8}" for k in range(1, n)],
             "each holds the distance of its ends: all but the first do so once more; one hinge, each turns about it",
             "banana"),
            ("in a ring", 4 * n, ring, 3 * n, [],
             "a polygon of n bars in space (2 n) whose bars turn about themselves (n): no link too many", "plain"),
            ("in a row", 4 * n + 1, row, 3 * n + 3, [],
             "n rigid bodies, each on the last by a ball joint: 6 + 3 (n - 1)", "plain"),
        ]  # fmt: skip
        for how, joints, links, dof, over, because, trait in members:
            if how != "in a ring" or n > 2:
                name = f"{n} bananas {how}"
                yield known_scene(name, linked(joints, 3, links), because, (trait,), n, dof=dof, redundancy=over)


def _spindle(a: int, b: int, first: int) -> list[Link]:
    """Two ends, and a triangle that is linked to both."""
    triangle = (first, first + 1, first + 2)
    return [*combinations(triangle, 2), *((end, c) for end in (a, b) for c in triangle)]


def henneberg(quick: bool) -> Iterator[KnownScene]:
    """Put together joint by joint [Henneberg1911] [TayWhiteley1985]: rigid, and no link too many.

    With links more, each of them is redundant; with the last one left out, there is one freedom more.
    """
    ladder = {2: (4, 8, 16, 32, 64, 128, 256, 512), 3: (5, 8, 16, 32, 64, 128)}
    members = [(d, n, 0) for d, sizes in ladder.items() for n in (sizes[:1] if quick else sizes)]
    for d, n, seed in (*members, *(() if quick else ((2, 8, 1), (3, 8, 1)))):
        links = steps(n, d, random.Random(f"{n} {d} {seed}"))
        known = {frozenset(link) for link in links}
        others = [link for link in combinations(range(n), 2) if frozenset(link) not in known]
        extra = random.Random(f"more {n} {d} {seed}").sample(others, min(len(others), 1 + n // 8))
        rigid = d * (d + 1) // 2
        for name, chosen, dof, over in (
            ("as put together", links, rigid, []),
            ("and links more", [*links, *extra], rigid, extra),
            ("one left out", links[:-1], rigid + 1, []),
        ):
            yield known_scene(
                f"{n} joints in dimension {d}, {seed}, {name}",
                linked(n, d, chosen),
                "each step keeps the links independent, and with d joints more than links the framework rigid",
                ("redundant",) if over else ("plain",),
                size=n,
                dof=dof,
                redundancy=_of(chosen, over),
            )


def steps(joints: int, dimension: int, rng: random.Random) -> list[Link]:
    """Henneberg's steps from a simplex: a joint on d others, or into a link and on d - 1 others."""
    links = list(combinations(range(dimension), 2))
    for new in range(dimension, joints):
        if new > dimension + 1 and rng.random() < 0.5:
            a, b = links.pop(rng.randrange(len(links)))
            others = [v for v in range(new) if v not in (a, b)]
            links += [(v, new) for v in (a, b, *rng.sample(others, dimension - 1))]
        else:
            links += [(v, new) for v in rng.sample(range(new), dimension)]
    return links


def trees_on_a_line(quick: bool) -> Iterator[KnownScene]:
    """Links along a line: one that closes a circle is redundant, and every part moves by itself."""
    for n in (4, 8) if quick else (4, 8, 16, 32, 64, 128, 256, 512):
        rng = random.Random(n)
        links = sorted({(min(a, b), max(a, b)) for a, b in (rng.sample(range(n), 2) for _ in range(n))})
        rng.shuffle(links)
        parts, redundant = union(n, links)
        for name, chosen, over in (
            ("with circles", links, redundant),
            ("without", [link for link in links if link not in redundant], []),
        ):
            yield known_scene(
                f"{n} joints on a line, {name}",
                linked(n, 1, chosen),
                "one freedom for every connected part; the last link of a circle is redundant",
                ("redundant",) if over else ("plain",),
                size=n,
                dof=parts,
                redundancy=_of(chosen, over),
            )


def union(n: int, links: Sequence[Link]) -> tuple[int, list[Link]]:
    """(connected parts, the links that close a circle with those before)."""
    root = list(range(n))

    def find(v: int) -> int:
        while root[v] != v:
            v = root[v]
        return v

    closing = []
    for a, b in links:
        first, second = find(a), find(b)
        if first == second:
            closing.append((a, b))
        root[second] = first
    return sum(find(v) == v for v in range(n)), closing


def clusters(quick: bool) -> Iterator[KnownScene]:
    """Rigid clusters with one link too many each, hinged one to the next; or with a link less."""
    for n in (2, 4) if quick else (2, 4, 8, 16, 32, 64, 128):
        links: list[Link] = []
        for k in range(n):
            links += combinations(range(3 * k, 3 * k + 4), 2)
        members: tuple[tuple[str, str, list[Link], list[Link]], ...] = (
            ("both diagonals", "all pairs of four joints are one link too many", links, links[5::6]),
            ("one diagonal", "two triangles each", [link for k, link in enumerate(links) if k % 6 != 5], []),
        )
        for name, because, chosen, over in members:
            yield known_scene(
                f"{n} quadrilaterals with {name}",
                linked(3 * n + 1, 2, chosen),
                f"{because}; each cluster turns against the last",
                ("redundant",) if over else ("plain",),
                size=n,
                dof=3 + n - 1,
                redundancy=_of(chosen, over),
            )


FAMILIES = {
    "cliques": cliques,
    "complete bipartite": complete_bipartite,
    "double bananas": bananas,
    "Henneberg": henneberg,
    "links on a line": trees_on_a_line,
    "clusters": clusters,
}
