"""Measured drawings: what moves, what is rigid, and what the tolerance does not tell; the truth by hand or by rank."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared.known_scenes import spread, swept
from shared.steffen import flexes, polyhedron

import dofkit
from dofkit.report import Report

Places = dict[str, tuple[float, ...]]
OCTAHEDRON = [f"{a}{b}" for a, b in itertools.combinations("ABCDEF", 2) if f"{a}{b}" not in ("AB", "CD", "EF")]
K33 = [f"{a}{b}" for a in "ABC" for b in "DEF"]
PRISM = ["AB", "BC", "CA", "DE", "EF", "FD", "AD", "BE", "CF"]


def measured(
    places: Mapping[str, Sequence[float]], links: Iterable[str], tolerance: float, held: str = "", digits: int = 9
) -> Report:
    """Particles with links between them, some held, with rounded coordinates."""
    dimension = len(next(iter(places.values())))
    particles = [{"name": name, "at": [round(float(x), digits) for x in p]} for name, p in places.items()]
    constraints = [*({"type": "link", "between": [*pair]} for pair in links)]
    constraints += [{"type": "fixed", "point": p} for p in held]
    scene = {"dimension": dimension, "particles": particles, "constraints": constraints, "tolerance": tolerance}
    return dofkit.classify(scene)


def shaken(places: Places, rng: random.Random, noise: float) -> Places:
    return {name: tuple(x + rng.uniform(-noise, noise) for x in p) for name, p in places.items()}


# What moves


@pytest.mark.parametrize("degrees", spread([112, 150, 200, 245]))
def test_steffens_polyhedron_moves(degrees: int) -> None:
    """Nine joints and 21 edges, 6 and one flex (Steffen 1978)."""
    edges, ways = flexes(math.radians(degrees))
    for places in ways[:2]:
        report = measured(places, edges, 1e-7)
        assert (report.dof, report.instantaneous_dof, report.verdicts["dof"].verdict) == (7, 7, "numeric")


def test_steffens_polyhedron_is_rigid_where_an_edge_is_moved() -> None:
    """Beyond the tolerance its edges are independent, as those of almost all polyhedra are (Gluck 1975)."""
    edges, ways = flexes(math.radians(150))
    places = ways[0] | {"Q": tuple(x + 0.02 for x in ways[0]["Q"])}
    assert measured(places, edges, 1e-7).dof == 6


def test_the_construction_of_steffens_polyhedron() -> None:
    """It has 9 corners, 21 edges, 14 triangles, and one set of lengths all along."""
    edges = polyhedron()
    assert len(edges) == 21
    lengths = [{e: math.dist(way[e[0]], way[e[1]]) for e in edges} for d in (120, 200)
               for way in flexes(math.radians(d))[1]]  # fmt: skip
    for other in lengths:
        assert all(abs(other[e] - lengths[0][e]) < 1e-12 for e in edges)
    assert sorted({round(v, 9) for v in lengths[0].values()}) == [5, 10, 11, 12, 17]


def by_a_half_turn(rng: random.Random) -> Places:
    """Opposite corners of an octahedron are images by a half turn about z (Bricard's first kind)."""
    places: Places = {}
    for a, b in ("AB", "CD", "EF"):
        x, y, z = (rng.uniform(-1, 1) for _ in range(3))
        places |= {a: (x, y, z), b: (-x, -y, z)}
    return places


def by_a_mirror(rng: random.Random) -> Places:
    """Two corners lie in the mirror, the others are images (Bricard's second kind)."""
    places: Places = {c: (0.0, rng.uniform(-1, 1), rng.uniform(-1, 1)) for c in "AB"}
    for a, b in ("CD", "EF"):
        x, y, z = (rng.uniform(-1, 1) for _ in range(3))
        places |= {a: (x, y, z), b: (-x, y, z)}
    return places


def on_two_lines(rng: random.Random) -> Places:
    """Each joint to all of the other line, at right angles: (sqrt(a^2 + c), 0), (0, sqrt(b^2 - c)) (Dixon 1899)."""
    one = {name: (rng.choice((-1, 1)) * rng.uniform(0.5, 4), 0.0) for name in "ABC"}
    return one | {name: (0.0, rng.choice((-1, 1)) * rng.uniform(0.5, 4)) for name in "DEF"}


def moved_triangles(rng: random.Random) -> Places:
    """A triangle and a shifted copy: three parallel bars of one length."""
    corners = {name: (rng.uniform(-1, 1), rng.uniform(-1, 1)) for name in "ABC"}
    x, y = rng.uniform(0.3, 1), rng.uniform(0.3, 1)
    return corners | {
        copy: (corners[name][0] + x, corners[name][1] + y) for name, copy in zip("ABC", "DEF", strict=True)
    }


#: Tolerances and what the places are off by.
ROUNDED = [(1e-7, 3e-8), swept(1e-7, 0.0), swept(1e-5, 1e-6), swept(1e-3, 1e-4)]

MOVING = [
    ("octahedron by a half turn", by_a_half_turn, OCTAHEDRON, 7),
    ("octahedron by a mirror", by_a_mirror, OCTAHEDRON, 7),
    ("three and three on two lines", on_two_lines, K33, 4),
    ("parallel bars between triangles", moved_triangles, PRISM, 4),
]


@pytest.mark.parametrize(("tolerance", "noise"), ROUNDED)
@pytest.mark.parametrize(("make", "links", "dof"), [row[1:] for row in MOVING], ids=[row[0] for row in MOVING])
def test_what_moves_is_never_called_rigid(
    make: Any, links: list[str], dof: int, tolerance: float, noise: float
) -> None:
    found = []
    for seed in range(4):
        rng = random.Random(f"measured {seed}")
        found.append(measured(shaken(make(rng), rng, noise), links, tolerance).dof)
    assert set(found) <= {dof, None}
    assert found.count(dof) >= (3 if tolerance < 1e-4 else 1)


# What is rigid


def rigidity(places: Places, links: Iterable[str]) -> Any:
    number = {name: i for i, name in enumerate(places)}
    d = len(next(iter(places.values())))
    rows = []
    for a, b in links:
        arm = np.subtract(places[a], places[b])
        row = np.zeros((len(number), d))
        row[number[a]], row[number[b]] = arm, -arm
        rows.append(row.ravel() / np.linalg.norm(arm))
    return np.array(rows)


def shaky(links: list[str], dimension: int, rng: random.Random) -> Places:
    """Six random joints, the last of them moved along a line to where the links are dependent: by chance, not for good.

    Almost all of these are rigid: a stress and a motion to first order, and the one has work to do along the other.
    """
    gauge = np.random.default_rng(rng.randrange(10**6)).standard_normal(
        (dimension * (dimension + 1) // 2, 6 * dimension)
    )
    while True:
        places: Places = {name: tuple(rng.uniform(-1, 1) for _ in range(dimension)) for name in "ABCDEF"}
        start, way = np.array(places["F"]), np.array([rng.uniform(-1, 1) for _ in range(dimension)])

        def at(t: float, places: Places = places, start: Any = start, way: Any = way) -> Places:
            return places | {"F": tuple(start + t * way)}

        def volume(t: float, at: Any = at) -> float:
            return float(np.linalg.det(np.vstack([rigidity(at(t), links), gauge])))

        steps = np.linspace(-1.5, 1.5, 31)
        for a, b in itertools.pairwise(steps):
            if volume(a) * volume(b) >= 0:
                continue
            for _ in range(80):
                a, b = ((a + b) / 2, b) if volume(a) * volume((a + b) / 2) > 0 else (a, (a + b) / 2)
            singular = np.linalg.svd(rigidity(at(a), links), compute_uv=False)
            if singular[-1] < 1e-12 and singular[-2] > 1e-2:
                return at(a)


@pytest.mark.sweep
@pytest.mark.parametrize(("tolerance", "noise"), ROUNDED)
@pytest.mark.parametrize(("links", "dimension"), [swept(OCTAHEDRON, 3), swept(K33, 2), (PRISM, 2)])
def test_what_only_shakes_is_never_called_movable(
    links: list[str], dimension: int, tolerance: float, noise: float
) -> None:
    whole = dimension * (dimension + 1) // 2
    found = []
    for seed in range(5):
        rng = random.Random(f"shaky {seed}")
        report = measured(shaken(shaky(links, dimension, rng), rng, noise), links, tolerance)
        found.append(report.dof)
    assert set(found) <= {whole, None}
    assert found.count(whole) >= (3 if tolerance < 1e-4 else 1)


@pytest.mark.sweep
def test_a_shaky_octahedron_with_a_coarse_tolerance_is_not_called_movable() -> None:
    """One way the edges hold within 3e-3 for a quarter of the size, the other way they do not."""
    for seed in ("2c", "5z", "9z", "14z"):
        rng = random.Random(f"shaky octahedron{seed}")
        assert measured(shaken(shaky(OCTAHEDRON, 3, rng), rng, 1e-4), OCTAHEDRON, 1e-3, digits=4).dof in (6, None)


@pytest.mark.parametrize("bars", [2, 4])
@pytest.mark.parametrize("tolerance", [1e-7, 1e-4])
def test_bars_stretched_between_pivots_are_rigid(bars: int, tolerance: float) -> None:
    """They leave their line to first order only: its length is the least that they can span."""
    for seed in range(3):
        rng = random.Random(seed)
        turn, along, places = rng.uniform(0, 7), 0.0, Places()
        names = "ABCDE"[: bars + 1]
        for name in names:
            places[name] = (along * math.cos(turn), along * math.sin(turn))
            along += rng.uniform(0.3, 1)
        links = ["".join(pair) for pair in itertools.pairwise(names)]
        report = measured(shaken(places, rng, tolerance / 10), links, tolerance, held=names[0] + names[-1])
        assert report.dof in (0, None)
        assert report.instantaneous_dof == bars - 1


@pytest.mark.parametrize("tolerance", [1e-7, 1e-4])
def test_convex_polyhedra_and_trusses_are_rigid(tolerance: float) -> None:
    """Dehn: a convex polyhedron of triangles is rigid to first order; three and three off a conic are, too."""
    octahedron = {
        "A": (1, 0, 0),
        "B": (-1, 0.1, 0),
        "C": (0, 1, 0.2),
        "D": (0, -1, 0),
        "E": (0, 0, 1),
        "F": (0.1, 0, -1),
    }
    assert measured(octahedron, OCTAHEDRON, tolerance).dof == 6
    apart = {"A": (0, 0), "B": (2, 1), "C": (4, -1), "D": (1, 3), "E": (3, 4), "F": (-1, 2)}
    assert measured(apart, K33, tolerance).dof == 3
    truss = {"A": (0, 0), "B": (1, 0), "C": (0.5, 0.8), "D": (1.5, 0.8)}
    assert measured(truss, ["AC", "BC", "BD", "CD"], tolerance, held="AB").dof == 0


# Singular positions whose exact counterparts are decided

ROOT = Path(__file__).parents[2]
SINGULAR = {
    "four-bar-stretched": 0,
    "spherical-four-bar-stretched": 0,
    "miura-vertex-flat": 1,
    "waterbomb-vertex-flat": 3,
    "four-bar-change-point": 1,
    "three-cranks-in-line": 1,
    "sarrus-stretched": 1,
    "sarrus-folded": 2,
    "double-watt": 1,
    "linear-triple-in-3d": 5,
}


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("name", "dof"), [swept(*row) if k % 4 != 1 else row for k, row in enumerate(SINGULAR.items())]
)
def test_singular_positions_are_decided_as_exact_ones_are(name: str, dof: int) -> None:
    path = next(
        path for folder in ("mechanisms", "examples") for path in (ROOT / "tests/scenes" / folder).glob(f"{name}.yaml")
    )
    exact = dofkit.load(path)
    report = dofkit.classify(exact.model_copy(update={"tolerance": 1e-7}))
    assert (report.dof, report.verdicts["dof"].verdict) == (dof, "numeric")


def test_a_cone_of_infinitesimal_motions_is_not_bounded_by_measured_forms() -> None:
    assert within("wren-platform", 1e-7).dof in (None, 1)


def within(name: str, tolerance: float) -> Report:
    """A scene whose numbers are exact, with a tolerance."""
    folders = ("mechanisms", "examples")
    path = next(p for folder in folders for p in (ROOT / "tests/scenes" / folder).glob(f"{name}.yaml"))
    return dofkit.classify(dofkit.load(path).model_copy(update={"tolerance": tolerance}))


@pytest.mark.parametrize(
    ("name", "dof"),
    [
        ("dixon-first-k44", 4),
        swept("double-watt", 1),
        swept("double-watt-alike", 1),
        swept("plate-on-four-threads", 2),
        swept("platform-on-parallel-legs", 2),
        swept("three-cranks-in-line", 1),
        swept("sarrus-stretched", 1),
        swept("sarrus-folded", 2),
        swept("waterbomb-vertex-flat", 3),
    ],
)
def test_what_moves_as_written_does_so_within_a_coarse_tolerance(name: str, dof: int) -> None:
    """The second order is hidden by 1e-3; the drawing as written is singular exactly, and its motion known."""
    report = within(name, 1e-3)
    assert (report.dof, report.verdicts["dof"].verdict) == (dof, "numeric")


@pytest.mark.sweep
def test_a_platform_with_three_infinitesimal_motions_is_not_called_rigid_within_a_coarse_tolerance() -> None:
    """It has one motion; whether more of the three are finite is hidden by the tolerance."""
    assert within("wren-platform", 1e-3).dof in (1, None)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("chebyshev-straight-line-guided", "not for the geometry as written"),
        ("watt-straight-line-guided", "which ones was not decided"),
    ],
)
def test_what_leaves_its_line_by_less_than_the_tolerance_is_undecided(name: str, why: str) -> None:
    """No linkage of this kind draws a line, and within the tolerance both go on for a quarter of their size."""
    report = within(name, 1e-3)
    assert (report.dof, report.consistent) == (None, True)
    assert any(why in line for line in report.warnings)


@pytest.mark.parametrize("size", [1.0005, 1.0])
def test_parallel_bars_whose_lengths_differ_by_the_tolerance(size: float) -> None:
    """Equal ones let the body move; unequal ones do not: which is so is hidden where they differ by so little."""
    places = {"A": (0, 0), "B": (1, 0), "C": (2, 0), "D": (0, 1), "E": (1, size), "F": (2, 1)}
    report = measured(places, ["DE", "EF", "FD", "AD", "BE", "CF"], 1e-3, held="ABC")
    assert report.dof == (1 if size == 1.0 else None)


@pytest.mark.sweep
def test_mechanisms_with_a_tolerance_are_answered_as_without_or_open() -> None:
    """One in five: a coarser reading of numbers that are exact changes no answer."""
    wrong, known, told = [], 0, 0
    for path in sorted((ROOT / "tests/scenes/mechanisms").glob("*.yaml"))[::5]:
        scene = dofkit.load(path)
        exact = scene.expect.get("dof") if scene.expect else None
        if exact is None:
            continue
        report = dofkit.classify(scene.model_copy(update={"tolerance": 1e-7}))
        known, told = known + 1, told + (report.dof is not None)
        wrong += [path.stem] if report.dof not in (exact, None) else []
    assert not wrong
    assert told >= 0.9 * known > 0


def loop(places: Sequence[tuple[float, float]], digits: int, turn: float, size: float) -> Report:
    """Links around a loop of hinges in the plane, turned, of any size, moved and rounded to digits of that size."""
    names = ["ground", *"abcdef"[: len(places) - 1]]
    c, s = size * math.cos(turn), size * math.sin(turn)
    joints = []
    for k, (x, y) in enumerate(places):
        at = [round(c * x - s * y + 7 * size, digits), round(s * x + c * y - 3 * size, digits)]
        joints.append({"type": "revolute", "between": [names[k], names[(k + 1) % len(names)]], "at": at})
    return dofkit.classify({"dimension": 2, "bodies": names[1:], "constraints": joints, "tolerance": 10.0**-digits})


@pytest.mark.parametrize("digits", [3, 4, 5, 6])
@pytest.mark.parametrize(
    ("places", "dof"),
    [
        pytest.param([0, 1, 3, 2], 1, id="flat parallelogram"),
        pytest.param([0, 1, 3, 6], 0, id="stretched: 6 = 1 + 2 + 3"),
        pytest.param([0, 1, 4, 2], 1, id="change point: 1 + 3 = 2 + 2"),
    ],
)
def test_loops_in_line_written_with_few_digits(places: list[int], dof: int, digits: int) -> None:
    """Two links more than an open chain turn to first order; the second order is that of the loop in line."""
    for turn, size in ((0.3, 1.0), (2.0, 1.7)):
        report = loop([(x, 0) for x in places], digits, turn, size)
        assert (report.dof, report.instantaneous_dof, report.verdicts["dof"].verdict) == (dof, 2, "numeric")


def test_a_linkage_that_draws_nearly_a_line_is_not_called_movable() -> None:
    """Watt's point leaves its line by less than 1e-4 of the size where it has moved by half of that."""
    exact = dofkit.load(ROOT / "tests/scenes/examples/watt-straight-line-guided.yaml")
    report = dofkit.classify(exact.model_copy(update={"tolerance": 1e-6}))
    assert (report.dof in (0, None), report.instantaneous_dof) == (True, 1)


# Far from the origin

BENNETT = [((0, 3, 0), (0.6, 0, 0.8)), ((0, 0, 0), (0, 0, 1)), ((4, 0, 0), (0, -0.8, 0.6)),
           ((16 / 13, -9 / 13, -12 / 13), (-3 / 13, -4 / 13, 12 / 13))]  # fmt: skip
SPHERICAL = [((1, 0, 0), (1, 0, 0)), ((0, 1, 0), (0, 1, 0)), ((0, 0, 1), (0, 0, 1)), ((1, 1, 1), (1, 1, 1))]
STRETCHED = [((0, 0, 0), (0, 0, 1)), ((1, 0, 0), (0, 0, 1)), ((3, 0, 0), (0, 0, 1)), ((6, 0, 0), (0, 0, 1))]


@pytest.mark.sweep
@pytest.mark.parametrize("noise", [swept(0.0), 3e-8])
@pytest.mark.parametrize(("hinges", "dof"), [(BENNETT, 1), (SPHERICAL, 1), (STRETCHED, 0)])
def test_loops_of_hinges_a_thousand_sizes_from_the_origin(hinges: Any, dof: int, noise: float) -> None:
    rng = random.Random(str(dof))
    names = ["ground", "a", "b", "c"]
    joints = []
    for i, (place, axis) in enumerate(hinges):
        size = max(math.dist(p, q) for p, _ in hinges for q, _ in hinges)
        at = [round(x + size * (1000 - 300 * k) + size * rng.uniform(-noise, noise), 8) for k, x in enumerate(place)]
        turned = [round(x / math.hypot(*axis) + rng.uniform(-noise, noise), 9) for x in axis]
        between = [names[i], names[(i + 1) % 4]]
        joints.append({"type": "revolute", "between": between, "at": at, "axis": turned})
    report = dofkit.classify({"bodies": names[1:], "constraints": joints, "tolerance": 1e-7})
    assert (report.dof, report.verdicts["dof"].verdict) == (dof, "numeric")


# Time


def driven(links: Mapping[str, str | None], places: Mapping[str, Sequence[float]], held: str) -> Report:
    """Links, of lengths that may change in time, within 1e-6."""
    particles = [{"name": name, "at": [*p]} for name, p in places.items()]
    constraints: list[dict[str, Any]] = [{"type": "fixed", "point": p} for p in held]
    for pair, length in links.items():
        constraints.append({"type": "link", "between": [*pair]} | ({"length": length} if length else {}))
    return dofkit.classify({"dimension": 2, "particles": particles, "constraints": constraints, "tolerance": 1e-6})


def test_a_measured_drawing_whose_lengths_change_in_time() -> None:
    square = {"A": (0, 0), "B": (1, 0), "C": (0, 1), "D": (1, 1)}
    sides = dict.fromkeys(("AB", "AC", "BD", "CD", "AD"))
    # braced twice, one diagonal grows: it holds at this moment only
    report = driven({**sides, "BC": "sqrt(2) + t"}, square, "A")
    assert report.dof is None
    assert report.consistent is not True
    # a parallelogram with a diagonal that grows: it moves in time
    leaning = {"A": (0, 0), "B": (1, 0), "C": (0.3, 1), "D": (1.3, 1)}
    report = driven({"AB": None, "AC": None, "BD": None, "CD": None, "AD": "sqrt(2.69) + t"}, leaning, "AB")
    assert (report.consistent, report.dof, report.verdicts["dof"].verdict) == (True, 0, "numeric")
    # in line: as one bar grows the joint leaves the line, on one of two sides, like the root of t
    line = {"A": (0, 0), "B": (1, 0), "C": (2, 0)}
    assert driven({"AB": "1 + t", "BC": None}, line, "AC").dof in (0, None)
