"""Relations nonlinear in the velocities that split into linear ones, and those that are one-sided; all answers by hand.

A relation of second degree splits over the reals where its discriminant is a square. What is one-sided, transcendental
or of higher degree may be undecided, and is never answered wrongly.
"""

from __future__ import annotations

from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit

ALONG = "sqrt(xdot^2 + ydot^2) = xdot"
HEADING = "th = atan2(ydot, xdot)"
BY_ANGLE = "xdot^2 - 2 cos(z) xdot ydot + ydot^2 = 0"
TWO_PLACES = "z xdot^2 + 2 xdot ydot + w ydot^2 = 0"
BY_PLACE = "xdot^2 - 2 z xdot ydot + ydot^2 = 0"

#: Coordinates, constraints, (dof, velocity_dof), whether each is holonomic in the system and on its own, and why.
DECIDED: list[tuple[str, list[str], tuple[int, int], list[bool | None] | None, list[bool] | None, str]] = [
    ("x y z", [BY_ANGLE], (1, 1), [True], None, "x and y are constant; where sin z = 0 so are z and x - y, or x + y"),
    ("x y th", [HEADING, "xdot = cos(th)", "ydot = sin(th)"], (3, 1), [False, False, False], None,
     "forward with speed 1"),
    ("x y z", [BY_PLACE, "z = 1/2"], (0, 0), [True, True], None, "definite: at rest"),
    ("x y z", [BY_PLACE, "z^2 = 1/4"], (0, 0), [True, True], None, "definite at both"),
    ("x y z", [BY_PLACE, "z = 1"], (1, 1), [True, True], None, "(xdot - ydot)^2 = 0"),
    ("x y z", [BY_PLACE, "z = 2"], (1, 1), [True, True], None, "xdot = (2 +- sqrt(3)) ydot"),
    ("x y u w", ["xdot^2 - 2 u xdot ydot + (u^2 + w^2) ydot^2 = 0"], (3, 2), [False], None,
     "w = 0, dx = u dy is larger"),
    ("x y z w", [TWO_PLACES, "z = 0"], (3, 2), [False, True], None,
     "ydot = 0, or 2 xdot + w ydot = 0: a skate in x, y, w"),
    ("x y z w", [TWO_PLACES, "w = 0"], (3, 2), [False, True], None, "xdot = 0, or a skate in x, y, z"),
    ("x y z w", [TWO_PLACES, "z = 0", "w = 0"], (1, 1), [True, True, True], None, "xdot ydot = 0"),
    ("x y z w", [TWO_PLACES, "z = 0", "w = 1"], (1, 1), [True, True, True], None, "ydot = 0 or 2 xdot + ydot = 0"),
    ("x y z w", [TWO_PLACES, "z = 1", "w = 2"], (0, 0), [True, True, True], None, "definite: at rest"),
    ("x y z w", ["z xdot^2 = w ydot^2", "z = 0", "w = 1"], (1, 1), [True, True, True], None, "ydot = 0"),
    ("x y z w", ["z xdot^2 = w ydot^2", "z = 0", "w = 0"], (2, 2), [True, True, True], None, "0 = 0"),
    ("x y z w", ["z xdot^2 + 2 w xdot ydot = ydot^2", "z = 0"], (3, 2), [False, True], None, "ydot = 0 or 2 w xdot"),
    ("x y z", ["z xdot^2 + z ydot^2 = 0", "z = 0"], (2, 2), [True, True], None, "0 = 0"),
    ("x y z", ["z xdot^2 = ydot^2", "z = 0"], (1, 1), [True, True], None, "ydot = 0"),
    ("x y z w u s", ["xdot^2 = (1 + s^2) (z ydot + w udot)^2", "w = 0"], (5, 4), [False, True], [False, True],
     "xdot = +-sqrt(1 + s^2) z ydot"),
    ("x y z w", ["z (xdot^2 - w^2 ydot^2) = 0", "z = 0"], (3, 3), [True, True], [False, True],
     "alone the branch xdot = w ydot is the largest, whichever the others choose"),
    ("x y z w", ["xdot (ydot - z wdot) = 0", "xdot = 0"], (3, 3), [True, True], [False, True],
     "the same with a form"),
    ("x y z", ["x (1 + exp(1/x)) (ydot^2 + zdot^2) = 0"], (1, 1), [True], [True], "at x = 0 it has no value"),
    ("x y z w u", ["z = 0", "z xdot + (1 + w^2) ydot = 0", "xdot^2 + ydot^2 = udot^2"], (2, 2), [True, True, True],
     [True, False, False], "y is constant, and u = +-x + C"),
    ("x y z w", ["z/w = 0", "sqrt(ydot^2 + (w^2 wdot + (2 + w) zdot)^2) = 2 xdot + 2 zdot"], (3, 2), [True, False],
     [True, False], "z = 0, and a cone of velocities"),
    ("x y z w", ["z = 0", "xdot^2 + ydot^2 = 1", "xdot^2 + ydot^2 + z wdot = 1"], (3, 2), [True, False, False],
     [True, False, False], "the last says what the second does"),
    ("x y z", ["exp(xdot*z - z*xdot) = x"], (2, 2), None, None, "x = 1"),
    ("x y z", ["(xdot + ydot)*z - xdot*z - ydot*z = x"], (2, 2), None, None, "x = 0"),
    ("x y z", ["xdot*ydot - ydot*xdot = 0"], (3, 3), None, None, "0 = 0"),
    ("x y z", ["xdot*ydot - ydot*xdot + zdot^2 = 1"], (2, 2), None, None, "zdot = 1 or -1"),
]  # fmt: skip

#: The same, true answers of which each may be undecided.
NOT_WRONG: list[tuple[str, list[str], tuple[int, int], list[bool | None] | None, list[bool] | None, str]] = [
    ("x y z", [BY_PLACE], (3, 2), [False], None, "where z > 1 a skate: dx = r(z) dy"),
    ("x z", ["xdot^2 + z = 0", "z = 0"], (0, 0), [True, True], [False, True], "x is constant"),
    ("x y z w u", ["(w ydot + xdot)^2 = (z - 1) (udot + w xdot)^2", "w = 0"], (4, 3), [False, True], [False, True],
     "xdot = +-sqrt(z - 1) udot"),
    ("x y", [ALONG], (1, 1), [False], None, "ydot = 0 and xdot >= 0: no finite relation says the second"),
    ("x y", ["xdot = sqrt(xdot^2 + ydot^2)"], (1, 1), [False], None, "the same"),
    ("x y", ["sqrt(dx^2 + dy^2) = dx"], (1, 1), [False], None, "the same"),
    ("x y z", [ALONG, "xdot = z"], (2, 1), [None, False], None, "y = C, and z >= 0: dx = z dt in x, z, t"),
    ("x y", [ALONG, "x = t"], (0, 0), [True, True], None, "xdot = 1 sees to the side: y = C is all that is left"),
    ("x y", [ALONG, "x = 0"], (0, 0), [True, True], None, "at rest"),
    ("x y", [ALONG, "sqrt(xdot^2 + ydot^2) = -xdot"], (0, 0), [True, True], None, "xdot >= 0 and xdot <= 0: at rest"),
    ("x y", ["abs(xdot) = ydot"], (1, 1), [False], None, "ydot = xdot or -xdot, and ydot >= 0"),
    ("x y", ["abs(dx) = dy"], (1, 1), [False], None, "the same"),
    ("x y", ["abs(xdot) = ydot", "ydot = 1"], (0, 0), [True, True], None, "xdot = 1 or -1"),
    ("x y", ["abs(xdot) + abs(ydot) = 0"], (0, 0), [True], None, "at rest"),
    ("x y", ["sqrt(xdot^2 + ydot^2) = 2 xdot"], (1, 1), [False], None, "ydot = +-sqrt(3) xdot, xdot >= 0"),
    ("x y th", [HEADING], (3, 2), [False], None, "rolling: xdot sin th = ydot cos th, and forward"),
    ("x y th", ["th = atan2(dy, dx)"], (3, 2), [False], None, "the same"),
    ("x y th", ["2 th = atan2(ydot, xdot)"], (3, 2), [False], None, "the same with 2 th, for -pi/2 < th <= pi/2"),
    ("x y th", ["cos(th) = xdot/sqrt(xdot^2 + ydot^2)"], (3, 2), [False], None, "in the direction of th or -th"),
    ("x y th", [HEADING, "th = 0"], (1, 1), [False, True], None, "y = C, xdot > 0"),
    ("x y", ["atan2(ydot, xdot) = pi/4"], (1, 1), [False], None, "ydot = xdot > 0"),
    ("x y z w", ["xdot^2 - 2 cos(z) xdot ydot + ydot^2 + wdot^2 = 0"], (1, 1), [True], None,
     "x, y, w constant: three squares"),
    ("x y z w", [TWO_PLACES], (4, 3), [False], None, "where z w < 1 two lines"),
    ("x y z", ["z exp(xdot) = y"], (3, 2), [False], [False], "xdot = log(y/z)"),
    ("x y z", ["z exp(xdot) = y", "z = 0"], (1, 1), [True, True], [False, True], "y = 0, and x is free"),
    ("x y z", ["exp(z xdot) = y", "z = 0"], (1, 1), [True, True], [False, True], "y = 1"),
    ("x y z", ["z exp(2 xdot) + y exp(xdot) = 1", "z = 0"], (2, 1), [False, True], [False, True],
     "xdot = -log(y), an affine form in x, y and t that does not integrate"),
    ("x y z w", ["z xdot^4 = (1 + w^2) ydot^4", "z = 0"], (2, 2), [True, True], [False, True],
     "y is constant; for z > 0 xdot is a multiple of ydot that depends on z and w"),
    ("x y z w", ["z xdot^3 + (1 + w^2) ydot^3 = 0", "z = 0"], (2, 2), [True, True], [False, True], "y is constant"),
    ("x y z w u", ["(z xdot + (1 + w^2) ydot)^3 = u", "z = 0"], (4, 3), [False, True], [False, True],
     "(1 + w^2) ydot = u^(1/3)"),
    ("x y z", ["zdot^2 + (xdot + 3 ydot)^2 = 0", "z (t ydot + sin(z) xdot)^2 = zdot^2"], (1, 1), [True, True],
     [True, False], "z = 0 and x + 3 y constant; elsewhere all is at rest"),
    ("x z", ["xdot^4 + 1 - cos(z) = 0"], (0, 0), [True], [True], "both terms are 0: z = 0 and x constant"),
    ("x y z", ["xdot^4 + (1 - cos(z)) ydot^4 = 0", "z = 0"], (1, 1), [True, True], [True, True],
     "x is constant, y is free where 1 - cos(z) is 0"),
    ("x y z", ["xdot^4 = z ydot^4", "z = 0"], (1, 1), [True, True], [False, True], "x is constant"),
    ("x y u z w", ["exp(w z ydot) = 1", "z = 0"], (4, 4), [True, True], [True, True],
     "w z ydot = 0: alone y is constant, and at z = 0 it says nothing"),
    ("x y z w u", ["xdot^2 = (1 - z) (udot - ydot)^2", "w = t", "w exp((1 + x^2) xdot + ydot) = 1 - z"], (4, 2),
     [False, True, False], [False, True, False], "where 1 - z is 0 there is no logarithm"),
    ("x y z w u", ["abs(ydot) + abs(udot + (w + z) ydot) = 0", "(1 + x^2) wdot + ydot = 0"], (2, 2), [True, True],
     [True, False], "y, u and w are constant"),
    ("x y z", ["abs(xdot) + abs(ydot) = abs(zdot)"], (3, 2), [False], None, "polyhedra of velocities"),
    ("x y", ["abs(xdot) = abs(ydot) + 1"], (2, 1), [False], None, "polyhedra of velocities"),
    ("x y", ["abs(xdot) + abs(ydot) = 1"], (2, 1), [False], None, "polyhedra of velocities"),
    ("x y z", ["abs(xdot) - abs(ydot) = zdot"], (3, 2), [False], None, "polyhedra of velocities"),
    ("x y z", ["abs(abs(xdot) - ydot) = zdot"], (3, 2), [False], None, "polyhedra of velocities"),
    ("x y", ["abs(dx) + abs(dy) = dt"], (2, 1), [False], None, "polyhedra of velocities"),
    ("x y", ["ydot = xdot*abs(xdot)"], (2, 1), [False], None, "polyhedra of velocities"),
    ("x y z", ["abs(xdot)*ydot = zdot^2"], (3, 2), [False], None, "polyhedra of velocities"),
    ("x y z", ["ydot = zdot", "abs(xdot) + abs(zdot) = 1"], (2, 1), [True, False], None, "polyhedra of velocities"),
    ("x y z", ["ydot = x*zdot", "abs(xdot) + abs(zdot) = 1"], (3, 1), [False, False], None,
     "polyhedra of velocities"),
    ("x y z w", ["abs(xdot) + abs(ydot) = 1", "abs(zdot) + abs(wdot) = abs(xdot)"], (4, 2), [False, False], None,
     "polyhedra of velocities"),
    ("x y z", ["exp(xdot*z - z*xdot + ydot) = x"], (3, 2), None, None,
     "ydot = log(x): a form that does not integrate"),
    ("x y z", ["abs((xdot + ydot)*z - xdot*z - ydot*z + zdot) = x"], (3, 2), None, None,
     "zdot = x or -x, where x >= 0"),
]  # fmt: skip


def report_of(names: str, constraints: list[str], at: dict[str, Any] | None = None) -> dofkit.Report:
    scene: dict[str, Any] = {"coordinates": names.split(), "constraints": constraints}
    return dofkit.classify(scene | ({"configuration": at} if at is not None else {}))


def answers(
    names: str, constraints: list[str], numbers: tuple[int, int], holonomic: Any, alone: Any
) -> list[tuple[Any, Any]]:
    """Return pairs of an answer and the true one; None of the latter is not compared."""
    report = report_of(names, constraints)
    unknown = [None] * len(constraints)
    return [
        (report.consistent, True),
        (report.dof, numbers[0]),
        (report.velocity_dof, numbers[1]),
        *zip([e.holonomic for e in report.constraints], holonomic or unknown, strict=True),
        *zip([e.holonomic_alone for e in report.constraints], alone or unknown, strict=True),
    ]


@pytest.mark.parametrize("row", DECIDED, ids=["; ".join(row[1]) for row in DECIDED])
def test_decided(row: tuple[Any, ...]) -> None:
    assert all(expected in (found, None) for found, expected in answers(*row[:5])), row[5]


@pytest.mark.parametrize("row", spread(NOT_WRONG, 2), ids=["; ".join(row[1]) for row in NOT_WRONG])
def test_not_wrong(row: tuple[Any, ...]) -> None:
    assert all(None in (found, expected) or found == expected for found, expected in answers(*row[:5])), row[5]


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        ("x y", [ALONG, "xdot = -1"]),
        ("x y", [ALONG, "x = -t"]),
        ("x y z", [ALONG, "xdot = -z^2 - 1"]),
        ("x y", ["abs(xdot) = ydot", "ydot = -1"]),
        ("x y", ["sqrt(xdot^2 + ydot^2) = xdot - 1"]),
        ("x y", ["sqrt(xdot^2 + ydot^2) = -1"]),
        ("x y", ["abs(xdot) = -1"]),
        ("x y", ["atan2(ydot, xdot) = 5"]),
        ("x y th", [HEADING, "th = 4"]),
        ("x y th", [HEADING, "th = 0", "xdot = -1"]),
        ("x y", ["(xdot - ydot)^2/x = 0", "x = 0"]),
        ("x y", ["log(x) (xdot - ydot)^2 = 0", "x = -1 - y^2"]),
        ("x y", ["sqrt(x) (xdot^2 - ydot^2) = 0", "x = -1 - y^2"]),
        ("x y", ["xdot^2/y + xdot^2 + ydot^2/y^2 = 0", "y = 0"]),
        ("x y", ["xdot^2 + 2 ydot^2 = -1"]),
    ],
)
def test_no_motion_is_not_called_one(names: str, constraints: list[str]) -> None:
    report = report_of(names, constraints)
    assert (report.consistent is not True, report.dof) == (True, None)


@pytest.mark.parametrize(
    ("names", "constraints", "redundant"),
    [
        ("x y", ["ydot = 0", ALONG], ["c1"]),
        ("x y", [ALONG, "ydot = 0"], ["c2"]),
        ("x y", [ALONG, ALONG], ["c2"]),
        ("x y", ["abs(xdot) + abs(ydot) = 1"] * 2, ["c2"]),
        ("x y", ["y = 0", "sqrt(x^2 + y^2) = x"], ["c1"]),
        ("x y", ["sqrt(x^2 + y^2) = x", "y = 0"], ["c2"]),
        ("x y th", [HEADING, "xdot sin(th) = ydot cos(th)"], ["c2"]),
        ("x y", ["xdot = ydot", "ydot = 1", "abs(xdot) = ydot"], ["c3"]),
        ("x y z", ["sin(z) = 0", "z = 0", "xdot = cos(z) ydot"], ["c1"]),
        ("x y", ["exp(xdot - ydot - x) = 1", "xdot - ydot = x"], ["c2"]),
        ("x y", ["(xdot - 2 ydot + 3)^3 = 8", "xdot - 2 ydot = -1"], ["c2"]),
    ],
)
def test_what_says_less_is_redundant(names: str, constraints: list[str], redundant: list[str]) -> None:
    assert report_of(names, constraints).redundant in (redundant, None)


@pytest.mark.parametrize(
    ("names", "constraint", "at", "expected"),
    [
        ("x y z", BY_PLACE, {"z": 0}, (1, 1, 1)),
        ("x y z", BY_PLACE, {"z": 2}, (3, 2, 2)),
        ("x y z", BY_ANGLE, {"z": 1}, (1, 1, 1)),
        ("x y z", BY_ANGLE, {"z": 0}, (1, 1, 2)),
        ("x y z", "xdot^2 + z^2 ydot^2 = 0", {"z": 0}, (1, 1, 2)),
        ("x y z", "xdot^2 = 4 ydot^2", {}, (2, 2, 2)),
        ("x y z", "(xdot - y zdot)*(xdot + zdot) = 0", {}, (3, 2, 2)),
        ("x y z", "sqrt(xdot^2 + ydot^2) = z xdot", {"z": 2}, (3, 2, 2)),
        ("x y z", "sqrt(xdot^2 + ydot^2) = z xdot", {"z": "1/2"}, (1, 1, 1)),
        ("x y z", "abs(xdot) + abs(ydot) = z", {"z": 2}, (3, 2, 2)),
        ("x y z", "xdot^2 + ydot^2 = z*zdot^2", {"z": 1}, (3, 2, 2)),
        ("x y z", "xdot^2 + ydot^2 = zdot^2", {}, (3, 2, 2)),
        ("x y z", "z exp(xdot) = y", {}, (3, 2, 3)),
        ("x y z", "exp(z xdot) = y", {"y": 1}, (3, 2, 3)),
        ("x y z", "z xdot^4 = ydot^4", {"z": -1}, (1, 1, 1)),
        ("x y z w", TWO_PLACES, {"w": 1}, (4, 3, 3)),
        ("x y z w", TWO_PLACES, {}, (4, 3, 3)),
        ("x y z w", TWO_PLACES, {"z": 2, "w": 1}, (2, 2, 2)),
    ],
)
def test_at_a_configuration(names: str, constraint: str, at: dict[str, Any], expected: tuple[int, int, int]) -> None:
    """The instantaneous freedom is that of the relation at that place, on one of its branches."""
    report = report_of(names, [constraint], dict.fromkeys(names.split(), 0) | at)
    found = report.dof, report.velocity_dof, report.instantaneous_dof
    assert all(value in (true, None) for value, true in zip(found, expected, strict=True))
    assert report.singular in (expected[1] != expected[2], None)


@pytest.mark.parametrize(
    ("names", "equation"),
    [
        ("x", "xdot + abs(xdot) = 0"),
        ("x y", "abs(xdot) = xdot"),
        ("x y", "abs(xdot) + abs(ydot) = xdot + ydot"),
        ("x y z", "abs(xdot - z*ydot) = xdot - z*ydot"),
        ("x y", "sqrt(xdot^2) = xdot"),
        ("x", "abs(xdot - 1) = xdot - 1"),
        ("x y", "abs(xdot)*abs(ydot) = xdot*ydot"),
    ],
)
def test_an_equation_that_says_inequalities_reduces_no_freedom(names: str, equation: str) -> None:
    report = report_of(names, [equation])
    assert report.dof in (len(names.split()), None)
    assert (report.constraints[0].holonomic is not True, report.redundant in ([], None)) == (True, True)


def test_a_branch_together_with_others_that_misses_the_reference_is_none_of_it() -> None:
    """At z = 1 both constraints say xdot = 0 and x zdot + y ydot = 0, however the first is written."""
    sliding = "x zdot + t xdot + y ydot"
    for first in ("z^2 xdot^2 = 0", f"z^2 xdot^2 + y ({sliding}) = 0"):
        report = report_of("x y z", [first, f"{sliding} = 0"], {"x": 0, "y": 0, "z": 1})
        assert (report.dof, report.velocity_dof) in ((1, 1), (None, None))


@pytest.mark.parametrize("constraint", ["z exp(xdot) = y", "xdot (ydot - z wdot) = 0"])
def test_in_a_system_of_its_own_a_constraint_is_what_it_is_on_its_own(constraint: str) -> None:
    report = report_of("x y z w", [constraint])
    assert report.constraints[0].holonomic_alone == report.constraints[0].holonomic == report.holonomic


@pytest.mark.parametrize("more", ["x = 1", "x^2 = 1", "x = y + 1"])
def test_a_denominator_may_have_any_value_but_zero(more: str) -> None:
    """atan x + atan(1/x) = pi/2 sgn(x): y = 0, and x is 1 or -1."""
    report = report_of("x y z", ["y + atan(x) + atan(1/x) - pi x/(2 abs(x)) = 0", more])
    assert (report.consistent, report.dof) == (True, 1)


def test_a_relation_that_is_multiplied_by_dt_integrates_to_no_constant_time() -> None:
    """x dt = 0 says x = 0 in a motion, and not t = C."""
    (entry,) = report_of("x y", ["x*dt = 0"]).constraints
    assert entry.integral is None or "t =" not in entry.integral
