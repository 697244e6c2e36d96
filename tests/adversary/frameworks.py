"""Drawings that move though a count says that they do not, with exact places; their first-order freedom by
fractions."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

from .linear import eliminated

Place = tuple[Fraction, ...]
Places = Mapping[str, Place]
Link = tuple[str, str]

#: Rational points of the unit circle.
TURNS = tuple(
    (Fraction(a, c), Fraction(b, c)) for a, b, c in ((3, 4, 5), (4, 3, 5), (5, 12, 13), (8, 15, 17), (20, 21, 29))
)


def first_order(places: Places, links: Sequence[Link], fixed: Sequence[str] = ()) -> int:
    """Velocities of the points that keep the links' lengths to first order, with some points at rest."""
    moving = [name for name in places if name not in fixed]
    d = len(next(iter(places.values())))
    rows = []
    for a, b in links:
        row = [Fraction(0)] * (d * len(moving))
        for end, other in ((a, b), (b, a)):
            if end in moving:
                k = d * moving.index(end)
                row[k : k + d] = [x - y for x, y in zip(places[end], places[other], strict=True)]
        rows.append(row)
    return d * len(moving) - eliminated(rows)


def drawn(places: Places, links: Sequence[Link], fixed: Sequence[str] = ()) -> dict[str, Any]:
    """The scene: points, those that are fixed, then the links."""
    written = {name: [str(x) for x in place] for name, place in places.items()}
    return {
        "dimension": len(next(iter(places.values()))),
        "particles": [{"name": name, "at": at} for name, at in written.items()],
        "constraints": [
            *({"type": "fixed", "point": name} for name in fixed),
            *({"type": "link", "between": [a, b]} for a, b in links),
        ],
    }


def _number(rng: random.Random) -> Fraction:
    return Fraction(rng.randint(-12, 12), rng.choice((1, 2, 3)))


def crossed_lines(rng: random.Random, m: int, n: int) -> tuple[Places, list[Link]]:
    """K(m, n) on two perpendicular lines, away from where they cross (Dixon): a -> sqrt(a^2 + c), b -> sqrt(b^2 -
    c) keeps all lengths a^2 + b^2, so it moves."""
    a, b = ([Fraction(rng.choice((-1, 1)) * k) for k in rng.sample(range(1, 9), many)] for many in (m, n))
    places = {f"A{i}": (x, Fraction(0)) for i, x in enumerate(a)} | {f"B{i}": (Fraction(0), y) for i, y in enumerate(b)}
    return places, [(f"A{i}", f"B{j}") for i in range(m) for j in range(n)]


def octahedron(rng: random.Random, mirrored: bool) -> tuple[Places, list[Link]]:
    """Bricard's octahedra, A A', B B', C C' not linked. Symmetric about a line: 9 numbers for A, B, C, 6 lengths,
    and the 2 motions along the line leave 1. Symmetric about a plane that holds C and C': 3 + 3 + 2 + 2 numbers, 6
    lengths, and 3 motions of the plane leave 1. With the 6 motions of space the freedom is 7 at least."""
    a, b, c = ((_number(rng), _number(rng), _number(rng)) for _ in range(3))
    turned = {"A": a, "B": b, "C": c}
    if mirrored:
        places = {"A": a, "X": (-a[0], *a[1:]), "B": b, "Y": (-b[0], *b[1:])}
        places |= {"C": (Fraction(0), *c[1:]), "Z": (Fraction(0), _number(rng), _number(rng))}
    else:
        places = turned | {n: (-p[0], -p[1], p[2]) for n, p in zip("XYZ", turned.values(), strict=True)}
    apart = {("A", "X"), ("B", "Y"), ("C", "Z")}
    return places, [pair for pair in combinations("ABCXYZ", 2) if pair not in apart]


def cranks(rng: random.Random, many: int) -> tuple[Places, list[Link], list[str]]:
    """Equal parallel cranks A_i D_i on fixed pivots, no two in one line, with links from each D_i to the next: places,
    links, pivots. All D_i can be carried round by one vector."""
    r = rng.randint(1, 3)
    c, s = rng.choice(TURNS)
    line = rng.random() < 0.5
    xs = rng.sample(range(-6, 7), many)
    pivots = {f"A{i}": (Fraction(x), Fraction(0 if line else x * x)) for i, x in enumerate(xs)}
    ends = {f"D{i}": (x + r * c, y + r * s) for i, (x, y) in enumerate(pivots.values())}
    links = [(f"A{i}", f"D{i}") for i in range(many)]
    links += [(f"D{i}", f"D{i + 1}") for i in range(many - 1)]
    return {**pivots, **ends}, links, [*pivots]


def apart(places: Places) -> bool:
    """No two points are one."""
    return len(set(places.values())) == len(places)
