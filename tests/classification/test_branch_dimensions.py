"""Branches of different dimension are named: each row is derived by hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

import dofkit

ROD = {"type": "link", "length": "l"}


def governor(*more: str, dimension: int) -> dict[str, Any]:
    """Return Watt's governor: four equal rods, the slider C on the axis (z in space, y in the plane)."""
    pivot = [0] * dimension
    rods = [{**ROD, "between": ends} for ends in ([pivot, "A"], [pivot, "B"], ["A", "C"], ["B", "C"])]
    slot = {"type": "slot", "point": "C", "body": "ground", "at": pivot, "axis": [*pivot[1:], 1]}
    scene = {"dimension": dimension, "parameters": {"l": "positive"}, "particles": ["A", "B", "C"]}
    return {**scene, "constraints": [*rods, slot, *more]}


def coordinates(names: str, *constraints: str) -> dict[str, Any]:
    return {"coordinates": names.split(), "constraints": list(constraints)}


#: (why, scene, degrees of freedom, (branch, degrees of freedom elsewhere) or None)
CASES: list[tuple[str, dict[str, Any], int, tuple[str, str, int] | None]] = [
    ("|C - A|^2 = |A|^2: z (z - 2 z_A) = 0; else the height; at the pivot A and B each have a circle",
     governor("y_A = s x_A", "y_B = s x_B", dimension=3) | {"parameters": {"l": "positive", "s": "real"}},
     2, ("z_C = 0", "z_C", 1)),
    ("in the plane of the arms the same", governor(dimension=2), 2, ("y_C = 0", "y_C", 1)),
    ("the plane z = 0, or the line x = y = 0", coordinates("x y z", "z (x^2 + y^2) = 0"), 2, ("z = 0", "z", 1)),
    ("the plane x = 0, or the line y = z = 0", coordinates("x y z", "x y = 0", "x z = 0"), 2, ("x = 0", "x", 1)),
    ("(x + y + z) ((x - y)^2 + (y - z)^2 + (z - x)^2) = 0: a plane, or the line x = y = z",
     coordinates("x y z", "x^3 + y^3 + z^3 = 3 x y z"), 2, ("x + y + z = 0", "x + y + z", 1)),
    ("two lines of one dimension", coordinates("x y", "x y = 0"), 1, None),
    ("a slider-crank of equal lengths: x_B (x_B - 2 x_A) = 0, the crank turns on either branch",
     {"dimension": 2, "parameters": {"l": "positive"}, "particles": ["A", "B"],
      "constraints": [{**ROD, "between": [[0, 0], "A"]}, {**ROD, "between": ["A", "B"]}, "y_B = 0"]}, 1, None),
    ("a parallelogram and its crossed form have one freedom each",
     {"dimension": 2, "particles": ["A", "B"], "constraints": [
         {"type": "link", "between": [[0, 0], "A"], "length": 1},
         {"type": "link", "between": [[2, 0], "B"], "length": 1},
         {"type": "link", "between": ["A", "B"], "length": 2}]}, 1, None),
]  # fmt: skip


@pytest.mark.parametrize(("why", "scene", "dof", "branch"), CASES, ids=[why for why, *_ in CASES])
def test_branches_of_different_dimension_are_named(
    why: str, scene: dict[str, Any], dof: int, branch: tuple[str, str, int] | None
) -> None:
    report = dofkit.classify(scene)
    named = [(case.where, case.what) for case in report.special_cases if case.kind == "branch"]
    assert report.dof == dof, why
    assert named == ([] if branch is None else [(branch[0], sentence(dof, *branch[1:]))]), why
    asked = [line for line in report.warnings if "branches of different dimension" in line]
    assert len(asked) == len(named)
    assert all(case.verdict in ("proved", "probable") for case in report.special_cases)
    if branch is not None:
        assert f"configuration space on the branch {branch[0]}" in " ".join(report.text().split())


def sentence(dof: int, nonzero: str, elsewhere: int) -> str:
    verb = "is" if elsewhere == 1 else "are"
    return f"only this branch has {dof} degrees of freedom; where {nonzero} is not 0 there {verb} {elsewhere}"


@pytest.mark.parametrize(("at", "dof"), [([[3, -4], [-3, -4], [0, -8]], 1), ([[3, 4], [5, 0], [0, 0]], 2)])
def test_a_reference_configuration_chooses_the_branch(at: Sequence[Sequence[int]], dof: int) -> None:
    """A at (3, -4), C at (0, -8) is the mechanism; with C at the pivot A and B turn separately."""
    particles = [{"name": name, "at": place} for name, place in zip("ABC", at, strict=True)]
    scene = governor(dimension=2) | {"particles": particles, "parameters": {"l": 5}}
    report = dofkit.classify(scene)
    assert report.dof == dof
    assert not [case for case in report.special_cases if case.kind == "branch"]


def test_what_is_redundant_on_one_branch_says_so() -> None:
    """The rods alone keep C at the pivot, or make it A + B, where the slot is needed."""
    report = dofkit.classify(governor(dimension=2))
    assert report.redundant == ["c5"]
    assert report.verdicts["redundant"].about == "component"
    assert "The claim is about the component of the configuration space" in report.constraints[-1].reason


@pytest.mark.parametrize(
    ("texts", "about", "why"),
    [
        (("x^2 = 1", "dz = x dy"), "component", "z - y = C where x = 1, z + y = C where x = -1"),
        (("x y = 0", "z dx = y dz"), "component", "z = C where x = 0; x = C where y = 0 and z is not 0"),
        (("xdot^2 = ydot^2", "dz = x dy"), "component", "2 z = x^2 + C or 2 z = -x^2 + C"),
        (("x y = 0", "dz = dx"), "everywhere", "z - x = C on its own"),
        (("x^2 = 2", "dz = x dy"), "everywhere", "z - x y = C for both roots"),
    ],
)
def test_what_integrates_on_one_branch_is_reported_of_that_branch(texts: Sequence[str], about: str, why: str) -> None:
    report = dofkit.classify(coordinates("x y z", *texts))
    form = report.constraints[1]
    assert (report.dof, form.holonomic, form.verdicts["integral"].about) == (1, True, about), why
    assert report.verdicts["dof"].about == "everywhere"


def test_a_special_case_of_one_branch_names_the_branch() -> None:
    """On x = 0 the rows are y dx and -y dz; on y = 0 they are x dy and z dx: y = 0 alone is not special."""
    report = dofkit.classify(coordinates("x y z", "x y = 0", "z dx = y dz"))
    assert [case.where for case in report.special_cases] == ["x = 0 and y = 0"]
