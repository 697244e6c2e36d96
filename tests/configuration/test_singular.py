"""Finite against instantaneous freedom where they are easily confused; every number is derived by hand."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import accumulate, combinations, pairwise
from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit

Scene = dict[str, Any]
Number = int | Fraction | str
Case = tuple[str, Scene, int, int]


def at(coordinates: str, place: Sequence[int], *constraints: str) -> Scene:
    names = coordinates.split()
    return {
        "coordinates": names,
        "constraints": list(constraints),
        "configuration": dict(zip(names, place, strict=True)),
    }


def bars(points: Mapping[str, Sequence[Number]], links: Iterable[Sequence[str]], fixed: str = "") -> Scene:
    """Particles and links of the drawn lengths; points whose names are in ``fixed`` stand still."""
    told = {n: [str(v) for v in p] for n, p in points.items()}
    still = set(fixed.split())
    return {
        "dimension": len(next(iter(told.values()))),
        "particles": [{"name": n, "at": p} for n, p in told.items() if n not in still],
        "constraints": [
            {"type": "link", "between": [told[n] if n in still else n for n in link]} for link in map(tuple, links)
        ],
    }


def on_line(places: Sequence[int], dimension: int) -> dict[str, list[Number]]:
    return {name: [x, *[0] * (dimension - 1)] for name, x in zip("ABCDE", places, strict=False)}


def squares(n: int) -> Scene:
    """The last of n repeated squares, x^(2^n), is 0."""
    names = ["x", *(f"a{i}" for i in range(n))]
    chain = [f"{b} = {a}^2" for a, b in pairwise(names)]
    return at(" ".join(names), [0] * (n + 1), *chain, f"{names[-1]} = 0")


def cranks(n: int) -> Scene:
    """n parallelograms in a row, stretched: crank tips satisfy (v' - v)(v' + 2 v) = 0 to second order."""
    feet = {f"O{i}": (3 * i, 0) for i in range(n + 1)}
    tips = {f"P{i}": (3 * i + 1, 0) for i in range(n + 1)}
    links = [(f"O{i}", f"P{i}") for i in range(n + 1)] + [(f"P{i}", f"P{i + 1}") for i in range(n)]
    return bars({**feet, **tips}, links, " ".join(feet))


def two_parts(points: Sequence[tuple[Number, Number]]) -> Scene:
    """K_{3,3}: the first three joined to the last three."""
    return bars({f"p{i}": p for i, p in enumerate(points)}, [(f"p{a}", f"p{b}") for a in (0, 1, 2) for b in (3, 4, 5)])


def prism(n: int, bottom: Sequence[Sequence[Number]], top: Sequence[Sequence[Number]]) -> Scene:
    """A tensegrity prism: two polygons, upright members, and struts to the next corner."""
    points = {f"b{i}": p for i, p in enumerate(bottom)} | {f"t{i}": p for i, p in enumerate(top)}
    links = [(f"{k}{i}", f"{k}{(i + 1) % n}") for k in "bt" for i in range(n)]
    links += [(f"b{i}", f"t{(i + k) % n}") for k in (0, 1) for i in range(n)]
    return bars(points, links)


def hinges(dimension: int, *joints: tuple[Sequence[int], Sequence[int]], **first: Any) -> Scene:
    """A closed chain of revolutes (place, axis), the ground between the last and the first."""
    names = ["ground", *(f"l{i}" for i in range(1, len(joints))), "ground"]
    made = [
        {"type": "revolute", "between": [a, b], "at": list(p), **({"axis": list(axis)} if dimension == 3 else {})}
        for (a, b), (p, axis) in zip(pairwise(names), joints, strict=True)
    ]
    made[0].update(first)
    return {"dimension": dimension, "bodies": names[1:-1], "constraints": made}


def vertex(*creases: tuple[int, int]) -> Scene:
    """Folds through one point of a flat sheet."""
    return hinges(3, *(((0, 0, 0), (*crease, 0)) for crease in creases))


def legs(tops: Sequence[tuple[Number, Number]], feet: Sequence[tuple[Number, Number]]) -> Scene:
    """A lamina on three legs."""
    return {
        "dimension": 2,
        "bodies": ["plate"],
        "constraints": [
            {"type": "link", "between": [[str(v) for v in f], {"on": "plate", "at": [str(v) for v in t]}]}
            for t, f in zip(tops, feet, strict=True)
        ],
    }


R3, R2 = "sqrt(3)/2", "sqrt(2)/2"
Z = (0, 0, 1)

TRIANGLES = {"A": (0, 6), "B": (-6, -3), "C": (6, -3), "a": (0, 4), "b": (-4, -2), "c": (4, -2)}
BOTTOM, TOP = [(1, 0, 0), ("-1/2", R3, 0), ("-1/2", f"-{R3}", 0)], [(R3, "1/2", 1), (f"-{R3}", "1/2", 1), (0, -1, 1)]
SQUARE = [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
TURNED = [(R2, R2, 1), (f"-{R2}", R2, 1), (f"-{R2}", f"-{R2}", 1), (R2, f"-{R2}", 1)]

#: (what, scene, dof, instantaneous)
GUIDED: list[Case] = [
    *((f"flat to order {k}", at("x y", [0, 0], "y = 0", f"y = x^{k}"), 0, 1) for k in (2, 3, 5, 8)),
    ("flat to order 32", squares(5), 0, 1),
    (
        "an ellipse and its circle of curvature, order 4",
        at("x y", [2, 0], "x^2/4 + y^2 = 1", "(x - 3/2)^2 + y^2 = 1/4"),
        0,
        1,
    ),
    ("a cosine and its parabola, order 4", at("x y", [0, 1], "y = cos(x)", "y = 1 - x^2/2"), 0, 1),
    ("a sine and its series, order 9", at("x y", [0, 0], "y = sin(x)", "y = x - x^3/6 + x^5/120 - x^7/5040"), 0, 1),
    ("1 - cos x and 2 sin^2(x/2): the same", at("x y", [0, 0], "y = 1 - cos(x)", "y = 2 sin(x/2)^2"), 1, 1),
    ("spheres that touch inside", at("x y z", [0, 0, 0], "x^2 + y^2 + (z-1)^2 = 1", "x^2 + y^2 + (z-2)^2 = 4"), 0, 2),
    (
        "three spheres through a circle",
        at("x y z", [2, 1, 0], "x^2+y^2+z^2 = 5", "(x-2)^2+y^2+z^2 = 1", "(x-4)^2+y^2+z^2 = 5"),
        1,
        1,
    ),
    ("Viviani's curve at its node", at("x y z", [2, 0, 0], "x^2 + y^2 + z^2 = 4", "(x-1)^2 + y^2 = 1"), 1, 2),
    ("equal cylinders that cross", at("x y z", [0, 0, 1], "x^2 + z^2 = 1", "y^2 + z^2 = 1"), 1, 2),
    ("a torus and the plane on its top", at("x y z", [2, 0, 1], "(x^2+y^2+z^2+3)^2 = 16 (x^2+y^2)", "z = 1"), 1, 2),
    ("a torus and a plane at its throat", at("x y z", [1, 0, 0], "(x^2+y^2+z^2+3)^2 = 16 (x^2+y^2)", "x = 1"), 1, 2),
    ("a torus and a plane outside", at("x y z", [3, 0, 0], "(x^2+y^2+z^2+3)^2 = 16 (x^2+y^2)", "x = 3"), 0, 2),
    ("Peano: 9 > 8, two parabolas", at("x y z", [0, 0, 0], "z = (y - x^2) (y - 2 x^2)", "z = 0"), 1, 2),
    ("two umbrellas share their handle", at("x y z", [0, 0, 0], "x^2 = y^2 z", "y^2 = x^2 z"), 1, 3),
]
FRAMEWORKS: list[Case] = [
    (
        "P stretched between two points in space",
        bars({"O": (0, 0, 0), "Q": (2, 0, 0), "P": (1, 0, 0)}, ["OP", "QP"], "O Q"),
        0,
        2,
    ),
    ("three points on a line in space", bars(on_line((0, 1, 3), 3), combinations("ABC", 2)), 5, 7),
    ("four points on a line in space", bars(on_line((0, 1, 3, 7), 3), combinations("ABCD", 2)), 5, 9),
    ("a stretched quadrilateral", bars(on_line((0, 1, 3, 7), 2), ["AB", "BC", "CD", "AD"]), 3, 5),
    ("a stretched quadrilateral in space", bars(on_line((0, 1, 3, 7), 3), ["AB", "BC", "CD", "AD"]), 5, 9),
    ("a folded parallelogram", bars(on_line((0, 1, 3, 2), 2), ["AB", "BC", "CD", "AD"]), 4, 5),
    ("a folded parallelogram in space", bars(on_line((0, 1, 3, 2), 3), ["AB", "BC", "CD", "AD"]), 8, 9),
    *((f"{n} stretched parallelograms", cranks(n), 1, n + 1) for n in (1, 2, 3, 4)),
    ("K33 on a parabola", two_parts([(x, x * x) for x in (-3, -1, 0, 1, 2, 5)]), 3, 4),
    ("K33 on two perpendicular lines (Dixon)", two_parts([(0, 1), (0, 3), (0, -2), (1, 0), (4, 0), (-2, 0)]), 4, 4),
    (
        "nested triangles, bars through one point",
        bars(TRIANGLES, ["AB", "BC", "AC", "ab", "bc", "ac", "Aa", "Bb", "Cc"]),
        3,
        4,
    ),
    ("tensegrity prism on triangles", prism(3, BOTTOM, TOP), 6, 7),
    ("tensegrity prism on squares: three flexes, all stiffened", prism(4, SQUARE, TURNED), 6, 9),
]
MECHANISMS: list[Case] = [
    ("1 + 1 + 1 = 3, in space", hinges(3, *(((x, 0, 0), Z) for x in range(4))), 0, 2),
    ("three parallel hinges in a plane", hinges(3, *(((0, y, 0), (1, 0, 0)) for y in range(3))), 0, 1),
    ("three hinges through a point, in a plane", vertex((1, 0), (1, 1), (0, 1)), 0, 1),
    ("three hinges on a line", hinges(3, *(((x, 0, 0), (1, 0, 0)) for x in range(3))), 2, 2),
    ("a cross of folds", vertex((1, 0), (0, 1), (-1, 0), (0, -1)), 1, 2),
    ("four folds, sectors below 180 degrees", vertex((1, 0), (3, 4), (-4, 3), (3, -4)), 1, 2),
    ("four folds within 90 degrees: stretched", vertex((1, 0), (12, 5), (4, 3), (3, 4)), 0, 2),
    (
        "a driven parallelogram at its change point",
        hinges(2, ((0, 0), Z), ((1, 0), Z), ((4, 0), Z), ((3, 0), Z), drive="t"),
        0,
        1,
    ),
    ("legs 1, 2, 3, parallel", legs([(0, 1), (1, 2), (3, 3)], [(0, 0), (1, 0), (3, 0)]), 0, 1),
    (
        "1/l on a line: rigid at the fourth order only",
        legs([(0, 1), (1, Fraction(4, 3)), (2, 2)], [(0, 0), (1, 0), (2, 0)]),
        0,
        1,
    ),
    ("equal parallel legs", legs([(0, 1), (1, 3), (2, 2)], [(0, 0), (1, 2), (2, 1)]), 1, 1),
    ("legs through a point", legs([(1, 0), (0, 1), (-1, -1)], [(3, 0), (0, 2), (-2, -2)]), 0, 1),
]


def cases(found: Sequence[Case]) -> pytest.MarkDecorator:
    """Half of these; the others are swept."""
    params = [pytest.param(*case[1:], id=case[0]) for case in found]
    return pytest.mark.parametrize(("scene", "dof", "instantaneous"), spread(params, 2))


@pytest.mark.parametrize("surface", ["x^4 + y^4", "(y - x^2) (y - 2 x^2) + x^4"])  # 9 - 12 < 0: no parabola
def test_a_contact_that_is_definite_at_the_fourth_order_is_no_motion(surface: str) -> None:
    report = dofkit.classify(dofkit.load(at("x y z", [0, 0, 0], f"z = {surface}", "z = 0")))
    assert report.dof in (0, None)
    assert report.instantaneous_dof == 2


@cases([*GUIDED, *FRAMEWORKS, *MECHANISMS])
def test_what_moves_and_what_only_seems_to(scene: Scene, dof: int, instantaneous: int) -> None:
    report = dofkit.classify(dofkit.load(scene))
    assert (report.consistent, report.dof, report.velocity_dof) == (True, dof, dof)
    assert report.instantaneous_dof == instantaneous
    assert report.singular is (dof != instantaneous)


@pytest.mark.parametrize("seed", range(12))
def test_chains_of_bars_on_a_line_by_their_signature(seed: int) -> None:
    """Links l_i in directions e_i = 1 or -1 from one fixed point to another, d = sum e_i l_i > 0 apart.

    Across the line, with sum delta_i = 0, the distance is d - sum e_i delta_i^2 / 2 l_i. On that hyperplane the form
    has a positive square less than there are e_i = 1: definite where there is one of these, or nothing else.
    """
    rng = random.Random(seed)
    n, dimension = rng.randint(2, 6), rng.choice((2, 3))
    while True:
        signs, sizes = [rng.choice((1, 1, -1)) for _ in range(n)], [rng.randint(1, 9) for _ in range(n)]
        places = [0, *accumulate(e * size for e, size in zip(signs, sizes, strict=True))]
        if places[-1] > 0:
            break
    points = {f"P{i}": (x, *[0] * (dimension - 1)) for i, x in enumerate(places)}
    report = dofkit.classify(dofkit.load(bars(points, pairwise(points), f"P0 P{n}")))
    free = (n - 1) * (dimension - 1)
    definite = signs.count(1) in (1, n)
    assert report.instantaneous_dof == free
    assert report.dof == (0 if definite else free - 1)


@cases(
    [
        ("flat to order 1024", squares(10), 0, 1),
        ("a point, seen at order 40", at("x y z", [0, 0, 0], "z = (y - x^2)^2 + x^40", "z = 0"), 0, 2),
    ]
)
def test_what_is_too_flat_is_undecided(scene: Scene, dof: int, instantaneous: int) -> None:
    report = dofkit.classify(dofkit.load(scene))
    assert report.instantaneous_dof == instantaneous
    assert report.dof in (dof, None)
    assert report.dof == dof or (report.verdict, report.singular) == ("undecided", None)


@pytest.mark.parametrize("gap", ["1", "1/10^12", "1/10^40", "1/10^60", "1/10^45/10^45"])
def test_surfaces_that_nearly_touch_are_not_taken_to_touch(gap: str) -> None:
    """A plane at the height 1 - gap meets the unit sphere in a circle (dof 1), and misses it above the height 1."""
    sphere = "x^2 + y^2 + z^2 = 1"
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [sphere, f"z = 1 - {gap}"]})
    assert report.dof in (1, None)
    missed = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [sphere, f"z = 1 + {gap}"]})
    assert missed.consistent is not True
