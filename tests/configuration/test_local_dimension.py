"""The dimension near a singular point: cases by hand, arrangements whose branches are known, and what is left open."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from flint import ctx
from shared.germs import SYMBOLS, manifolds, on_plane, through

import dofkit
from dofkit.configuration.local.criteria import local_dimension
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension
from dofkit.exact.points.balls import PRECISION
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

P = 2**31 - 1


def near(texts: Sequence[str], at: Sequence[int], rigid: int = 0, time: int | None = None) -> LocalDimension:
    field, ball = through(texts, at)
    return local_dimension(Germ(field, ball, rigid, time))


@pytest.mark.parametrize(
    ("texts", "at", "dimension"),
    [
        (["x^2 + y^2 - 1"], (1, 0, 0), 2),  # regular
        (["z", "z + x^2 + y^2"], (0, 0, 0), 0),  # definite: a point
        (["z", "z + x^2 - y^2"], (0, 0, 0), 1),  # indefinite: two lines cross
        (["z", "2 z", "z (1 + x)"], (0, 0, 0), 2),  # the same plane three times
        (["x", "z", "z + y^3"], (0, 0, 0), 0),  # one motion left, broken at the third order
        (["x", "z", "z + x y^3"], (0, 0, 0), 1),  # one motion left, never broken
        (["x^2 + y^2 + z^2 - 1", "x - 1"], (1, 0, 0), 0),  # a tangent plane
        (["x^2 + y^2 - 1", "(x - 2)^2 + y^2 - 1"], (1, 0, 0), 1),  # tangent circles, times the z axis
    ],
)
def test_dimensions_near_a_point(texts: list[str], at: tuple[int, int, int], dimension: int) -> None:
    rigid = 1 if dimension == 1 and "(x - 2)" in " ".join(texts) else 0
    assert near(texts, at, rigid).dimension == dimension


@pytest.mark.parametrize(
    ("n", "functions", "dimension"),
    [
        (2, ["x^2 + y^2"], 0),
        (2, ["x y"], 1),
        (2, ["x^2 - y^3"], 1),  # a cusp
        (2, ["x^2 - y^4"], 1),  # two parabolas that touch
        (2, ["(x - y^2)^2"], 1),  # a parabola, singular all along
        (2, ["(x - y^2)^2 - y^7"], 1),
        (2, ["x^3 + y^3"], 1),  # a line and a point's worth of complex ones
        (2, ["x^4 - y^4"], 1),
        (2, ["x^2 y"], 1),
        (1, ["x^20"], 0),
        (2, ["x^9 + y^9"], 1),
        (3, ["x^2 + y^2 - z^3"], 2),  # a pointed cap
        (3, ["x^2 + y^2 z"], 2),  # Whitney's umbrella
        (3, ["x^2 + y^2"], 1),  # two complex planes that meet in a real line
        (3, ["x y", "x z"], 2),  # a plane and a line
        (2, ["x^2", "x y"], 1),  # a line with a thick point
        (2, ["x^2 + y^2", "x y"], 0),
        (2, ["x^2 - y^2", "x y"], 0),  # no combination is definite, and yet they have no common zero
        (3, ["x^2 - z^3", "y^2 - z^3"], 1),  # two cusps
        (3, ["x y", "y z", "z x"], 1),  # three lines
        (4, ["x y", "z u"], 2),
        (4, ["x y - z u", "x z - y u"], 2),
        (3, ["x^2", "y^2"], 1),
        (3, ["(x - z^2)^2", "y (x - z^2)"], 2),
        (3, ["x^2 + y^2 - z^2", "x y"], 1),  # a cone cut by two planes
        (3, ["(x^2 + y^2) (1 + z)", "x y"], 1),
        (3, ["x^2 + y^2 + z^2", "x^2 - y^2"], 0),
    ],
)
def test_dimensions_where_the_lowest_order_decides(n: int, functions: list[str], dimension: int) -> None:
    assert local_dimension(Germ(*on_plane(n, *functions), 0)).dimension == dimension


@pytest.mark.parametrize(
    ("n", "functions"),
    [
        (2, ["x^3", "x y^2"]),  # a line
        (2, ["x^2 + y^4"]),  # a point, as the next six
        (2, ["(x - y^2)^2 + y^6"]),
        (3, ["x^2 + y^2 + z^4"]),
        (2, ["x^4 + y^4"]),
        (2, ["x^6 + y^6 + x^5 y"]),
        (2, ["x^3 + y^5", "y^3"]),
        (2, ["x^3 + y^3 + x^4", "x^3 - y^3"]),
        (2, ["x^4 + y^4 - 2 x^2 y^2 + y^6"]),  # (x^2 - y^2)^2 + y^6: a point
        (3, ["x^2 + (y^2 - z^2)^2"]),  # two lines
        (3, ["x^2 + z^4", "y^2 + z^4"]),  # a point
        (2, ["(x - y^2)^2 + y^30"]),  # a point, seen only at a distance
        (2, ["x^40 y^40"]),  # two lines
    ],
)
def test_what_the_lowest_order_does_not_decide_is_undecided(n: int, functions: list[str]) -> None:
    told = local_dimension(Germ(*on_plane(n, *functions), 0))
    assert told.dimension is None
    assert told.verdict == "undecided"


@pytest.mark.parametrize(
    ("texts", "dimension", "confined"),
    [
        (["x - y"], 1, False),  # y as time: x = t
        (["x^2 - y"], 1, False),  # for t >= 0
        (["x", "x - y"], 0, True),  # t = 0 only
        (["x - y", "x - y - y^2"], 0, True),
        (["z - y", "z - y - x^2 - y^2"], 0, True),
        (["z - y", "z - y - x^2 + y^2"], 1, False),  # x = +-t
        (["z - y", "z - y - x y"], 1, False),  # x = 0, or t = 0
        (["z - y", "z - y - x^2"], None, False),  # x = 0: singular all along
    ],
)
def test_time_is_held_against_the_set(texts: list[str], dimension: int | None, confined: bool) -> None:
    at = (0, 0, 0) if "z" in " ".join(texts) else (0, 0)
    told = near(texts, at, time=1)
    assert (told.dimension, told.confined) == (dimension, confined)


def test_balls_alone_say_the_same_and_are_no_surer() -> None:
    for texts, dimension in ((["z", "z + x^2 - y^2"], 1), (["z", "z + x^2 + y^2"], 0), (["x", "z", "z + x y"], 1)):
        _, ball = through(texts, (0, 0, 0))
        with ctx.workprec(PRECISION):
            told = local_dimension(Germ(None, ball, 0))
        assert (told.dimension, told.verdict) == (dimension, "numeric")


# Arrangements: products and sums of squares of linear forms, moved by a change of coordinates


def linear(rng: random.Random, n: int) -> list[int]:
    return next(c for c in iter(lambda: [rng.randint(-2, 2) for _ in range(n)], None) if any(c))


def arrangement(seed: int) -> tuple[int, list[Expr], int]:
    """Relations on n coordinates, and the dimension of the largest of the flats through the origin."""
    rng = random.Random(seed)
    n, k = rng.randint(2, 4), rng.randint(1, 3)
    moved = list(SYMBOLS[:n])
    for i in range(1, n):
        moved[i] = moved[i] + ex.num(rng.randint(-2, 2)) * SYMBOLS[rng.randrange(i)] * SYMBOLS[rng.randrange(i)]
    functions, choices = [], []
    for _ in range(k):
        forms = [linear(rng, n) for _ in range(rng.choice((2, 2, 3)))]
        lines = [ex.add(*(ex.num(c) * x for c, x in zip(form, moved, strict=True))) for form in forms]
        squares = len(forms) == 2 and rng.random() < 0.3
        functions.append(ex.add(*(a * a for a in lines)) if squares else ex.mul(*lines))
        choices.append([forms] if squares else [[form] for form in forms])
    flats = ([row for part in choice for row in part] for choice in itertools.product(*choices))
    return n, functions, max(n - int(np.linalg.matrix_rank(np.array(rows))) for rows in flats)


def test_arrangements_are_never_answered_wrong_and_mostly_answered() -> None:
    open_ones, last = 0, SYMBOLS[-1]
    total = 24
    for seed in range(total):
        n, functions, truth = arrangement(seed)
        field, ball = manifolds([last, *(last + f for f in functions)], dict.fromkeys((*SYMBOLS[:n], last), 0))
        told = local_dimension(Germ(field, ball, 0))
        open_ones += told.dimension is None
        assert told.dimension in (truth, None), (seed, told)
    assert open_ones < total / 2


# Scenes


def four_bar(*more: str, **drive: Any) -> dict[str, Any]:
    """A slider-crank in line with its bore, r = 1 and l = 3."""
    return {
        "dimension": 2,
        "bodies": ["crank", "rod", "piston"],
        "constraints": [
            {"type": "revolute", "between": ["ground", "crank"], "at": [0, 0]},
            {"type": "revolute", "between": ["crank", "rod"], "at": [1, 0]},
            {"type": "revolute", "between": ["rod", "piston"], "at": [4, 0]},
            {"type": "prismatic", "between": ["ground", "piston"], "axis": [1, 0], **drive},
            *more,
        ],
    }


@pytest.mark.parametrize("law", ["-t", "t", "-t^2", "-sin(t)^2"])
def test_a_piston_driven_at_its_dead_centre_is_consistent_where_it_can_move(law: str) -> None:
    """The piston stands furthest out: inward it can be driven, for some time before or after."""
    report = dofkit.classify(dofkit.load(four_bar(drive=law)))
    assert (report.consistent, report.dof, report.instantaneous_dof) == (True, 0, 1)


@pytest.mark.sweep
def test_a_piston_driven_outward_at_all_times_does_not_move() -> None:
    report = dofkit.classify(dofkit.load(four_bar(drive="t^2")))
    assert report.consistent is not True
    assert report.dof is None


@pytest.mark.parametrize(
    ("law", "consistent"),
    [("1 + t", True), ("1 - t", True), ("1 + t^2", True), ("1 - t^2", False), ("1 - t^4", False), ("cos(t)", False)],
)
def test_two_links_in_line_of_which_one_changes_its_length(law: str, consistent: bool) -> None:
    """A point between two others 2 apart: it can move where the lengths' sum grows, forward or backward in time."""
    links = [([0, 0], "1"), ([2, 0], law)]
    scene = {
        "dimension": 2,
        "particles": [{"name": "P", "at": [1, 0]}],
        "constraints": [{"type": "link", "between": [end, "P"], "length": length} for end, length in links],
    }
    report = dofkit.classify(dofkit.load(scene))
    assert (report.consistent, report.dof) == (True, 0) if consistent else report.consistent is not True


# Many motions


def copied_polygon(n: int) -> dict[str, Any]:
    """A polygon and two copies of it, each corner held to its copies by a triangle: all triangles turn as one."""
    around = [(round(1000 * math.cos(a)), round(1000 * math.sin(a))) for a in np.arange(n) * 2 * math.pi / n]
    aside = {"A": (0, 0), "B": (20, 3), "C": (5, 30)}
    particles = [{"name": f"{k}{i}", "at": [x + dx, y + dy]} for i, (x, y) in enumerate(around)
                 for k, (dx, dy) in aside.items()]  # fmt: skip
    pairs = [(f"{a}{i}", f"{b}{i}") for i in range(n) for a, b in ("AB", "AC", "BC")]
    pairs += [(f"{k}{i}", f"{k}{(i + 1) % n}") for k in aside for i in range(n)]
    return {"dimension": 2, "particles": particles, "constraints": [{"type": "link", "between": [*p]} for p in pairs]}


@pytest.mark.sweep
@pytest.mark.parametrize("n", [12, 24])
def test_a_framework_with_many_motions_is_answered(n: int) -> None:
    """2 n - n for the polygon, and 1 for the triangles."""
    assert dofkit.classify(copied_polygon(n)).dof == n + 1


def test_without_balls_what_is_flat_at_a_given_point_is_open() -> None:
    field, _ = through(["x", "z", "z + x y^3"], (0, 0, 0))
    assert local_dimension(Germ(field, None, 0)).dimension is None
    assert local_dimension(Germ(field, None, 0, distance=False)).dimension == 1
