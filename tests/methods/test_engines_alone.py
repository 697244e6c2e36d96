"""One engine alone: it agrees with both together wherever it answers, and claims no more than it can know."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import SCENES, VARIED, few, report_of, scene_of
from typer.testing import CliRunner

import dofkit
from dofkit.base.verdicts import VERDICTS
from dofkit.benchmark.trials.forms import car
from dofkit.exact.zero import BOTH
from dofkit.interface.cli import app
from dofkit.methods.table import ENGINES, METHODS, MethodName, methods
from dofkit.report import Report

#: dofkit's own engines, together and alone.
BY_ENGINES = tuple(ENGINES)
ALONE = tuple(name for name in BY_ENGINES if name != "auto")
WHOLE = ("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic")
WHOLE += ("redundant_equations", "growth_vector")
ENTRY = ("form", "holonomic", "holonomic_alone", "scleronomic", "catastatic", "bilateral", "exact", "independent")
ENTRY += ("circuit", "equations")

#: Where a method is known to answer something else, and why: (scene, method) -> (fields, reason).
KNOWN: dict[tuple[str, MethodName], tuple[tuple[str, ...], str]] = {
    ("roots-and-their-squares", "balls"): (
        ("redundant", "root3.circuit"),
        "balls look near a point, where a square implies the root",
    ),
}


#: Scenes whose freedom is known and which one engine alone leaves open.
OPEN: dict[MethodName, str] = {
    "field": """
        appell-hamel-in-a-plane appell_hamel constant-speed cube-with-four-space-diagonals double-watt
        double-watt-alike dubins-car-by-its-speed equal-speeds five-particles-on-sphere four-bar-change-point
        four-bar-stretched four-wheels-with-ackermann hoist
        isosceles-slider-crank jansen-leg kite-folded linear-triple-in-3d measured-bennett miura-vertex-flat
        omnidirectional-robot parallel-velocities parallelogram-flattened perpendicular-velocities
        plate-on-four-threads platform-on-parallel-legs pursuit-at-constant-speed rhombus-folded sarrus-folded
        sarrus-stretched speed-by-height spherical-four-bar-stretched three-cranks-in-line three-masses-on-one-rod
        trap_circles_tangent two-particles-on-sphere waterbomb-vertex-flat wren-platform root-of-pi
        doubling-with-time roots-and-their-squares forms-with-roots functions-and-their-inverses one-of-each-kind
        bead-on-a-circle-at-constant-speed
    """,
    "balls": """
        double-watt double-watt-alike holonomic-definition miura-vertex-flat plate-on-four-threads
        platform-on-parallel-legs sarrus-folded sarrus-stretched schatz-linkage sums-of-many three-cranks-in-line
        waterbomb-vertex-flat wren-platform
    """,
}


@cache
def report_by(method: MethodName, path: Path) -> Report:
    return dofkit.classify(scene_of(path), method=method)


def disagreements(told: Report, auto: Report) -> list[str]:
    """Fields that one method answers and answers otherwise."""
    found = [key for key in WHOLE if getattr(told, key) not in (None, getattr(auto, key))]
    if told.redundant_equations is not None and all(e.independent is not None for e in told.constraints if e.bilateral):
        found += [key for key in ("redundant",) if getattr(told, key) != getattr(auto, key)]
    if told.consistent is False:
        found += [key for key in ("conflicting",) if getattr(told, key) != getattr(auto, key)]
    if told.generalized_coordinates is not None and len(told.generalized_coordinates) != told.dof:
        found.append("generalized_coordinates")
    for mine, both in zip(told.constraints, auto.constraints, strict=True):
        found += [f"{mine.name}.{key}" for key in ENTRY if getattr(mine, key) not in (None, getattr(both, key))]
    return found


#: Every method on one scene in twenty, each on others; on all of them where they are swept.
BY_EACH = [pytest.param(method, *case.values, marks=case.marks, id=f"{method}-{case.values[0].stem}")
           for method in ALONE for case in few(method, VARIED, 56)]  # fmt: skip
by_each = pytest.mark.parametrize(("method", "path"), BY_EACH)


@by_each
def test_one_engine_alone_agrees_wherever_it_answers(method: MethodName, path: Path) -> None:
    known, _ = KNOWN.get((path.stem, method), ((), ""))
    assert disagreements(report_by(method, path), report_of(path)) == list(known)


@by_each
def test_one_engine_alone_is_no_surer_than_it_can_be(method: MethodName, path: Path) -> None:
    told = report_by(method, path)
    best = VERDICTS.index(methods()[method].best)
    assert all(VERDICTS.index(v) >= best for v in (told.verdict, *(e.verdict for e in told.constraints)))
    assert told.method.startswith(f"{method} alone")
    assert methods()[method].cannot in told.method


@by_each
def test_one_engine_alone_finds_the_freedom_that_is_known(method: MethodName, path: Path) -> None:
    known = report_of(path).dof is not None
    assert not known or report_by(method, path).dof is not None or path.stem in OPEN[method].split()


def test_most_scenes_are_answered_by_one_engine_alone() -> None:
    """Nine in ten."""
    left = [OPEN[method].split() for method in ALONE]
    assert all(len(names) < len(SCENES) / 10 for names in left)
    assert {name for names in left for name in names} <= {path.stem for path in SCENES}


@pytest.mark.sweep
def test_every_known_difference_is_one() -> None:
    for name, method in KNOWN:
        path = next(p for p in SCENES if p.stem == name)
        assert disagreements(report_by(method, path), report_of(path))


def test_the_table_is_complete() -> None:
    assert tuple(methods()) == METHODS
    assert ENGINES["auto"] == BOTH
    assert all(m.uses and m.cannot and m.best in VERDICTS for m in methods().values())


def told(method: MethodName, *constraints: str, **more: Any) -> Report:
    made = {"coordinates": ["x", "y", "z"], "constraints": list(constraints), **more}
    return dofkit.classify(dofkit.load(made), method=method)


def verdicts(report: Report) -> tuple[str, ...]:
    return tuple(entry.verdict for entry in report.constraints)


def test_non_zero_is_proved_by_balls_and_probable_over_a_field() -> None:
    """d(dz - y dx) = dx dy does not vanish on the kernel: non-holonomic."""
    wanted: dict[MethodName, str] = {"balls": "proved", "field": "probable", "auto": "proved"}
    for method, sure in wanted.items():
        report = told(method, "dz - y dx = 0")
        assert (report.dof, report.velocity_dof, report.constraints[0].holonomic) == (3, 2, False)
        assert report.constraints[0].verdicts["holonomic"].verdict == sure


def test_zero_is_never_proved_by_one_engine() -> None:
    """Closed, because (x + y)^3 multiplied out is what stands before dy; nothing but a proof makes that sure."""
    text = "(x + y)^3 dx + (x^3 + 3 x^2 y + 3 x y^2 + y^3) dy + dz = 0"
    wanted: dict[MethodName, str] = {"balls": "numeric", "field": "probable", "auto": "proved"}
    for method, sure in wanted.items():
        report = told(method, text)
        assert (report.constraints[0].exact, report.constraints[0].holonomic, report.dof) == (True, True, 2)
        assert verdicts(report) == (sure,)


def test_balls_alone_tell_no_freedom_where_brackets_may_be_lost_to_the_precision() -> None:
    """A car with trailers reaches everything [Laumond1993]: f = n + 4; each bracket is smaller than the one before."""
    few, many = (dofkit.classify(car(n), method="balls") for n in (4, 20))
    assert few.dof == 8
    assert (many.dof, many.verdicts["dof"].verdict) == (None, "undecided")
    assert not [c.name for c in many.constraints if c.holonomic is True]


def test_a_field_alone_does_not_tell_whether_anything_real_is_left() -> None:
    assert told("field", "x^2 + y^2 = 1").consistent is None
    assert told("field", "x^2 + y^2 = 1").dof == 2
    assert told("balls", "x^2 + y^2 = 1").consistent is True
    apart = ("x^2 + y^2 = 1", "(x - 5)^2 + y^2 = 1")  # they meet where 10 x = 25, and y^2 = 1 - 25/4 has no real root
    assert {m: told(m, *apart).consistent for m in BY_ENGINES} == {"auto": False, "field": False, "balls": None}


def test_balls_alone_do_not_tell_a_contradiction() -> None:
    nested = ("x^2 + y^2 = 1", "x^2 + y^2 = 2")
    assert [told(m, *nested).consistent for m in BY_ENGINES] == [False, False, None]


def test_a_field_alone_answers_nothing_where_functions_may_be_related() -> None:
    """4 atan(1/5) - atan(1/239) = pi/4 (Machin 1706): no canonical form shows it."""
    hidden = "(4 atan(1/5) - atan(1/239) - pi/4) y dx + dz - dy = 0"
    report = told("field", hidden)
    assert (report.dof, report.constraints[0].holonomic, report.verdict) == (None, None, "undecided")


def test_measured_geometry_has_no_points_over_a_field() -> None:
    particles = [{"name": "A", "at": [0, 0]}, {"name": "B", "at": [1, 0]}]
    made = {
        "dimension": 2,
        "particles": particles,
        "constraints": [{"type": "link", "between": ["A", "B"]}],
        "tolerance": 1e-6,
    }
    scene = dofkit.load(made)
    assert [dofkit.classify(scene, method=m).dof for m in BY_ENGINES] == [3, None, 3]


def test_the_command_line_takes_a_method() -> None:
    ran = CliRunner().invoke(app, ["classify", "--json", "--method", "field", "disc-rolling-on-plane"])
    assert json.loads(ran.stdout)["verdict"] == "probable"
    assert "balls" in CliRunner().invoke(app, ["classify", "--method", "luck", "disc-rolling-on-plane"]).output
