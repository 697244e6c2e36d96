"""Relations between velocities that keep to one side, or whose kind depends on the place; every answer by hand."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

ALONG = "sqrt(xdot^2 + ydot^2) = xdot"
HEADING = "th = atan2(ydot, xdot)"
BY_ANGLE = "xdot^2 - 2 cos(z) xdot ydot + ydot^2 = 0"
TWO_PLACES = "z xdot^2 + 2 xdot ydot + w ydot^2 = 0"
BY_PLACE = "xdot^2 - 2 z xdot ydot + ydot^2 = 0"

#: Coordinates, constraints, (dof, velocity_dof), whether each constraint is holonomic, and why.
DECIDED: list[tuple[str, list[str], tuple[int, int], list[bool | None], str]] = [
    ("x y", [ALONG], (1, 1), [False], "ydot = 0 and xdot >= 0: no finite relation says the second"),
    ("x y", ["xdot = sqrt(xdot^2 + ydot^2)"], (1, 1), [False], "the same"),
    ("x y", ["sqrt(dx^2 + dy^2) = dx"], (1, 1), [False], "the same"),
    ("x y z", [ALONG, "xdot = z"], (2, 1), [None, False], "y = C, and z >= 0: dx = z dt in x, z, t"),
    ("x y", [ALONG, "x = t"], (0, 0), [True, True], "xdot = 1 sees to the side: y = C is all that is left"),
    ("x y", [ALONG, "x = 0"], (0, 0), [True, True], "at rest"),
    ("x y", [ALONG, "sqrt(xdot^2 + ydot^2) = -xdot"], (0, 0), [True, True], "xdot >= 0 and xdot <= 0: at rest"),
    ("x y", ["abs(xdot) = ydot"], (1, 1), [False], "ydot = xdot or -xdot, and ydot >= 0"),
    ("x y", ["abs(dx) = dy"], (1, 1), [False], "the same"),
    ("x y", ["abs(xdot) = ydot", "ydot = 1"], (0, 0), [True, True], "xdot = 1 or -1"),
    ("x y", ["abs(xdot) + abs(ydot) = 0"], (0, 0), [True], "at rest"),
    ("x y", ["sqrt(xdot^2 + ydot^2) = 2 xdot"], (1, 1), [False], "ydot = +-sqrt(3) xdot, xdot >= 0"),
    ("x y th", [HEADING], (3, 2), [False], "rolling: xdot sin th = ydot cos th, and forward"),
    ("x y th", ["th = atan2(dy, dx)"], (3, 2), [False], "the same"),
    ("x y th", ["2 th = atan2(ydot, xdot)"], (3, 2), [False], "the same with 2 th, for -pi/2 < th <= pi/2"),
    ("x y th", ["cos(th) = xdot/sqrt(xdot^2 + ydot^2)"], (3, 2), [False], "in the direction of th or -th"),
    ("x y th", [HEADING, "th = 0"], (1, 1), [False, True], "y = C, xdot > 0"),
    ("x y th", [HEADING, "xdot = cos(th)", "ydot = sin(th)"], (3, 1), [False] * 3, "forward with speed 1"),
    ("x y", ["atan2(ydot, xdot) = pi/4"], (1, 1), [False], "ydot = xdot > 0"),
    ("x y z", [BY_ANGLE], (1, 1), [True], "x and y are constant; where sin z = 0 so are z and x - y, or x + y"),
    ("x y z", [BY_PLACE], (3, 2), [False], "where z > 1 a skate: dx = r(z) dy"),
    ("x y z", [BY_PLACE, "z = 1/2"], (0, 0), [True, True], "definite: at rest"),
    ("x y z", [BY_PLACE, "z^2 = 1/4"], (0, 0), [True, True], "definite at both"),
    ("x y z", [BY_PLACE, "z = 1"], (1, 1), [True, True], "(xdot - ydot)^2 = 0"),
    ("x y z", [BY_PLACE, "z = 2"], (1, 1), [True, True], "xdot = (2 +- sqrt(3)) ydot"),
    ("x y u w", ["xdot^2 - 2 u xdot ydot + (u^2 + w^2) ydot^2 = 0"], (3, 2), [False], "w = 0, dx = u dy is larger"),
    (
        "x y z w",
        ["xdot^2 - 2 cos(z) xdot ydot + ydot^2 + wdot^2 = 0"],
        (1, 1),
        [True],
        "x, y, w constant: three squares",
    ),
    ("x y z w", [TWO_PLACES], (4, 3), [False], "where z w < 1 two lines"),
    ("x y z w", [TWO_PLACES, "z = 0"], (3, 2), [False, True], "ydot = 0, or 2 xdot + w ydot = 0: a skate in x, y, w"),
    ("x y z w", [TWO_PLACES, "w = 0"], (3, 2), [False, True], "xdot = 0, or a skate in x, y, z"),
    ("x y z w", [TWO_PLACES, "z = 0", "w = 0"], (1, 1), [True] * 3, "xdot ydot = 0"),
    ("x y z w", [TWO_PLACES, "z = 0", "w = 1"], (1, 1), [True] * 3, "ydot = 0 or 2 xdot + ydot = 0"),
    ("x y z w", [TWO_PLACES, "z = 1", "w = 2"], (0, 0), [True] * 3, "definite: at rest"),
    ("x y z w", ["z xdot^2 = w ydot^2", "z = 0", "w = 1"], (1, 1), [True] * 3, "ydot = 0"),
    ("x y z w", ["z xdot^2 = w ydot^2", "z = 0", "w = 0"], (2, 2), [True] * 3, "0 = 0"),
    ("x y z w", ["z xdot^2 + 2 w xdot ydot = ydot^2", "z = 0"], (3, 2), [False, True], "ydot = 0 or 2 w xdot"),
    ("x y z", ["z xdot^2 + z ydot^2 = 0", "z = 0"], (2, 2), [True, True], "0 = 0"),
    ("x y z", ["z xdot^2 = ydot^2", "z = 0"], (1, 1), [True, True], "ydot = 0"),
]


def report_of(names: str, constraints: list[str], at: dict[str, Any] | None = None) -> dofkit.Report:
    scene: dict[str, Any] = {"coordinates": names.split(), "constraints": constraints}
    return dofkit.classify(scene | ({"configuration": at} if at is not None else {}))


@pytest.mark.parametrize(
    ("names", "constraints", "freedom", "holonomic", "why"), DECIDED, ids=["; ".join(row[1]) for row in DECIDED]
)
def test_relations_of_one_side(
    names: str, constraints: list[str], freedom: tuple[int, int], holonomic: list[bool | None], why: str
) -> None:
    report = report_of(names, constraints)
    assert (report.consistent, report.dof, report.velocity_dof) == (True, *freedom), why
    assert [e.holonomic for e in report.constraints] == holonomic, why


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        ("x y", [ALONG, "xdot = -1"]),
        ("x y", [ALONG, "x = -t"]),
        ("x y z", [ALONG, "xdot = -z^2 - 1"]),
        ("x y", ["abs(xdot) = ydot", "ydot = -1"]),
        ("x y", ["sqrt(xdot^2 + ydot^2) = xdot - 1"]),
        ("x y", ["atan2(ydot, xdot) = 5"]),
        ("x y th", [HEADING, "th = 4"]),
        ("x y th", [HEADING, "th = 0", "xdot = -1"]),
        pytest.param("x y th", [HEADING, "xdot = 0", "ydot = 0"], marks=pytest.mark.sweep),
    ],
)
def test_the_other_side_contradicts(names: str, constraints: list[str]) -> None:
    report = report_of(names, constraints)
    assert (report.consistent, report.dof) == (False, None)
    assert report.conflicting == [f"c{k + 1}" for k in range(len(constraints))]


@pytest.mark.parametrize(
    ("names", "constraints", "redundant"),
    [
        ("x y", ["ydot = 0", ALONG], ["c1"]),
        ("x y", [ALONG, "ydot = 0"], ["c2"]),
        ("x y", [ALONG, ALONG], ["c2"]),
        ("x y", ["y = 0", "sqrt(x^2 + y^2) = x"], ["c1"]),
        ("x y", ["sqrt(x^2 + y^2) = x", "y = 0"], ["c2"]),
        pytest.param("x y th", ["xdot sin(th) = ydot cos(th)", HEADING], ["c1"], marks=pytest.mark.sweep),
        ("x y th", [HEADING, "xdot sin(th) = ydot cos(th)"], ["c2"]),
        ("x y", ["xdot = ydot", "ydot = 1", "abs(xdot) = ydot"], ["c3"]),
        ("x y z", ["sin(z) = 0", "z = 0", "xdot = cos(z) ydot"], ["c1"]),
    ],
)
def test_what_says_less_can_go(names: str, constraints: list[str], redundant: list[str]) -> None:
    assert report_of(names, constraints).redundant == redundant


@pytest.mark.parametrize(
    ("constraint", "at", "expected"),
    [
        (BY_PLACE, {"x": 0, "y": 0, "z": 0}, (1, 1, 1)),
        (BY_PLACE, {"x": 0, "y": 0, "z": 2}, (3, 2, 2)),
        (BY_ANGLE, {"x": 0, "y": 0, "z": 1}, (1, 1, 1)),
        (BY_ANGLE, {"x": 0, "y": 0, "z": 0}, (1, 1, 2)),
        ("xdot^2 + z^2 ydot^2 = 0", {"x": 0, "y": 0, "z": 0}, (1, 1, 2)),
        ("xdot^2 = 4 ydot^2", {"x": 0, "y": 0, "z": 0}, (2, 2, 2)),
        ("(xdot - y zdot)*(xdot + zdot) = 0", {"x": 0, "y": 0, "z": 0}, (3, 2, 2)),
        ("sqrt(xdot^2 + ydot^2) = z xdot", {"x": 0, "y": 0, "z": 2}, (3, 2, 2)),
        ("sqrt(xdot^2 + ydot^2) = z xdot", {"x": 0, "y": 0, "z": "1/2"}, (1, 1, 1)),
    ],
)
def test_at_a_configuration(constraint: str, at: dict[str, Any], expected: tuple[int, int, int]) -> None:
    """Velocities to first order are those that the relation allows at that place, on one of its branches."""
    report = report_of("x y z", [constraint], at)
    assert (report.dof, report.velocity_dof, report.instantaneous_dof) == expected
    assert report.singular is (expected[1] != expected[2])


@pytest.mark.parametrize(
    ("constraints", "at", "expected"),
    [
        ([TWO_PLACES], (0, 1), (4, 3, 3)),
        ([TWO_PLACES], (0, 0), (4, 3, 3)),
        ([TWO_PLACES], (1, 1), (4, 3, 3)),
        ([TWO_PLACES], (-2, 1), (4, 3, 3)),
        ([TWO_PLACES], (2, 1), (2, 2, 2)),
        ([TWO_PLACES, "z = 0"], (0, 1), (3, 2, 2)),
        ([TWO_PLACES, "w = 0"], (0, 0), (3, 2, 2)),
        ([TWO_PLACES, "z = 0", "w = 1"], (0, 1), (1, 1, 1)),
    ],
)
def test_where_a_coefficient_of_a_square_vanishes(
    constraints: list[str], at: tuple[int, int], expected: tuple[int, int, int]
) -> None:
    """There one of the two lines is 0 = 0: what holds is the product of the other two factors."""
    report = report_of("x y z w", constraints, {"x": 0, "y": 0, "z": at[0], "w": at[1]})
    assert (report.dof, report.velocity_dof, report.instantaneous_dof) == expected


#: Coordinates, an equation that says inequalities, and these.
SIDES = [
    ("x", "xdot + abs(xdot) = 0", "xdot <= 0"),
    ("x y", "abs(xdot) = xdot", "xdot >= 0"),
    ("x y", "abs(xdot) + abs(ydot) = xdot + ydot", "xdot >= 0 and ydot >= 0: else one is less"),
    ("x y", "abs(xdot) + abs(ydot) = xdot - ydot", "xdot >= 0 and ydot <= 0"),
    ("x y z", "abs(xdot - z*ydot) = xdot - z*ydot", "xdot >= z ydot"),
    ("x y", "sqrt(xdot^2) = xdot", "xdot >= 0"),
    ("x", "abs(dx) = dx", "dx >= 0"),
    ("x", "abs(xdot - 1) = xdot - 1", "xdot >= 1"),
]


@pytest.mark.parametrize(("names", "equation", "why"), SIDES, ids=[row[1] for row in SIDES])
def test_an_equation_that_says_inequalities_takes_no_freedom(names: str, equation: str, why: str) -> None:
    report = report_of(names, [equation])
    (entry,) = report.constraints
    n = len(names.split())
    assert (report.consistent, report.dof, report.velocity_dof, report.redundant) == (True, n, n, []), why
    assert (entry.form, entry.bilateral, entry.holonomic, report.feasible) == ("inequality", False, False, True), why


def test_inequalities_in_disguise_beside_others() -> None:
    beside = report_of("x y", ["xdot + abs(xdot) = 0", "ydot = xdot"])
    assert (beside.dof, [e.holonomic for e in beside.constraints]) == (1, [False, True])
    against = report_of("x", ["xdot + abs(xdot) = 0", "xdot = 1"])
    assert (against.dof, against.feasible, against.infeasible) == (0, False, ["c1", "c2"])
    assert against.generalized_coordinates == []


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        pytest.param("x y z", [ALONG, "xdot = -z^2"], id="z = 0 is hidden"),
        pytest.param("x y th", [HEADING, "xdot = 0"], marks=pytest.mark.sweep, id="th = pi/2 is hidden"),
        pytest.param("x y z", ["abs(xdot) = zdot - ydot"], id="|xdot| = wdot of z = w + y, where y moves anyway"),
        pytest.param("x y", ["abs(xdot)*abs(ydot) = xdot*ydot"], id="two quarters"),
    ],
)
def test_what_is_left_open(names: str, constraints: list[str]) -> None:
    report = report_of(names, constraints)
    assert (report.verdict, report.dof, report.consistent is not False) == ("undecided", None, True)
