"""The scenes worked out a second time, symbolically, and held against their reports."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeVar

import pytest
import sympy
from shared.known_scenes import SCENES, few, report_of, scene_of, stem, swept
from shared.symbolic import Answer, NotHereError, answer, closed, linear_in, parts_of, relations_of, solved

import dofkit

#: Scenes for which SymPy takes more than half a second.
LONG = frozenset(
    [
        "axle_two_wheels_each",
        "ball-between-two-plates",
        "ball-inside-a-cylinder",
        "ball-inside-a-turning-cylinder",
        "ball-on-a-table-of-varying-speed",
        "ball-on-turntable",
        "car-with-trailer",
        "car-with-two-trailers",
        "falling-disk-by-its-centre",
        "fingertip-rolling-on-a-plane",
        "firetruck",
        "four-wheels-with-ackermann",
        "four-wheels-without-ackermann",
        "knife-edge-in-two-frames",
        "planar-space-robot",
        "roller-racer",
        "rolling-ball",
        "rubber-ball",
        "rubber-spheres-of-equal-size",
        "rubber-spheres-three-to-one",
        "snakeboard",
        "sphere-on-a-sphere",
        "sphere-rolling-and-pinned-height",
        "tricycle",
        "unicycle-with-three-trailers",
        "unicycle-with-two-trailers",
    ]
)
SYMBOLIC = few("symbolic", [path for path in SCENES if path.stem not in LONG], 6) + [
    swept(p) for p in SCENES if p.stem in LONG
]
T = TypeVar("T")


# The second way by itself


@pytest.mark.parametrize(
    ("constraints", "expected"),
    [
        (["x dy - y dx = 0"], (2, 2, [1])),
        (["dz - y dx = 0"], (3, 2, [1, 0])),
        (["cos(z) dx + sin(z) dy = 0", "cos(z) dy - sin(z) dx = 0"], (1, 1, [2])),
        (["z = y", "dz = y dx"], (1, 1, [2])),
        (["z = x y", "dz = y dx"], (1, 1, [2])),
        (["cos(t) dx + sin(t) dy = 0", "dz = 0"], (2, 1, [2, 1])),
        (["dx = y dt", "dy = z dt"], (3, 1, [2, 1, 0])),
        (["exp(x) dy + dz = exp(x) y dx"], (3, 2, [1, 0])),
        (["exp(x) dy + dz + exp(x) y dx = 0"], (2, 2, [1])),
        (["dy = h(x) dx", "dz = h'(x) dx"], (1, 1, [2])),
    ],
)
def test_cases_by_hand(constraints: list[str], expected: tuple[int, int, list[int]]) -> None:
    scene = dofkit.load({"coordinates": ["x", "y", "z"], "functions": {"h": ["s"]}, "constraints": constraints})
    relations, names = relations_of(scene)
    found = [answer(part) for part in parts_of(relations, names)]
    loose = len(names) - sum(len(part.names) for part in parts_of(relations, names))
    longest = max(len(a.derived) for a in found)
    derived = [sum(a.derived[min(k, len(a.derived) - 1)] for a in found) for k in range(longest)]
    assert (loose + sum(a.dof for a in found), loose + sum(a.velocity_dof for a in found), derived) == expected


# Held against the reports


Own = dict[int, tuple[bool, bool, bool]]


@cache
def forms_of(path: Path) -> tuple[list[tuple[int, sympy.Expr]], list[str]] | None:
    """The relations and coordinates of a scene with differential constraints, all of them linear in the velocities."""
    relations, names = relations_of(scene_of(path))
    differential = [linear_in(e, names) is not None for _, e in relations]
    return (relations, names) if any(differential) else None


def whole(path: Path) -> tuple[list[Answer], list[str]] | None:
    """The answers of the scene's parts, and the coordinates that nothing touches."""
    known = forms_of(path)
    if known is None:
        return None
    relations, names = known
    parts = parts_of(relations, names)
    touched = {q for part in parts for q in part.names}
    return [answer(part) for part in parts], [q for q in names if q not in touched]


def apart(path: Path) -> Own | None:
    """(holonomic, exact, catastatic) of each differential constraint, the others forgotten."""
    known = forms_of(path)
    if known is None:
        return None
    relations, names = known
    found = {}
    for i in dict(relations):
        own = [(k, e) for k, e in relations if k == i]
        forms = [f for _, e in own if (f := linear_in(e, names)) is not None]
        if forms:
            holonomic = all(all(answer(part).holonomic.values()) for part in parts_of(own, names))
            still = all(sympy.simplify(f["t"]) == 0 for f in forms)
            found[i] = holonomic, all(closed(f, names) for f in forms), still
    return found


def where_it_can(work: Callable[[Path], T], path: Path) -> T | None:
    """What is worked out; None where this route cannot, as `test_many_scenes_are_worked_out` bounds."""
    try:
        return work(path)
    except NotHereError:
        return None


@pytest.mark.parametrize("path", SYMBOLIC, ids=stem)
def test_the_report_is_what_sympy_works_out(path: Path) -> None:
    found = where_it_can(whole, path)
    if found is None:
        return
    answers, untouched = found
    scene, report = scene_of(path), report_of(path)
    if not all(entry.bilateral for entry in report.constraints) and report.consistent is False:
        return
    assert report.consistent in (None, True)
    assert report.dof in (None, len(untouched) + sum(a.dof for a in answers))
    assert report.velocity_dof in (None, len(untouched) + sum(a.velocity_dof for a in answers))
    longest = max(len(a.derived) for a in answers)
    ranks = [sum(a.derived[min(k, len(a.derived) - 1)] for a in answers) for k in range(longest)]
    assert dofkit.derived_flag(scene) in (None, ranks)
    for i, entry in enumerate(report.constraints):
        if entry.bilateral:
            assert entry.holonomic in (None, all(a.holonomic.get(i, True) for a in answers)), entry.name


@pytest.mark.parametrize("path", SYMBOLIC, ids=stem)
def test_a_constraint_alone_is_what_sympy_works_out(path: Path) -> None:
    wanted = where_it_can(apart, path)
    if wanted is None:
        return
    report = report_of(path)
    for i, (holonomic, exact, catastatic) in wanted.items():
        entry = report.constraints[i]
        assert entry.holonomic_alone in (None, holonomic), entry.name
        assert entry.exact in (None, exact), entry.name
        assert entry.catastatic in (None, catastatic), entry.name


@pytest.mark.sweep
def test_many_scenes_are_worked_out() -> None:
    """Scenes with differential constraints whose relations this route can read and solve."""
    assert sum(map(can_be_solved, SCENES)) >= 115


def can_be_solved(path: Path) -> bool:
    try:
        known = forms_of(path)
        for part in parts_of(*known) if known else []:
            solved([e for _, e in part.relations if linear_in(e, part.names) is None], part.names)
    except NotHereError:
        return False
    return known is not None
