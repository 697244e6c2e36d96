"""Where what a relation between velocities was divided by vanishes, and where it has no value as it was written."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

#: Coordinates, constraints, (dof, velocity_dof), whether each is holonomic beside the others and alone, and why.
DECIDED: list[tuple[str, list[str], tuple[int, int], list[bool], list[bool], str]] = [
    ("x y z", ["z exp(xdot) = y"], (3, 2), [False], [False], "xdot = log(y/z)"),
    ("x y z", ["z exp(xdot) = y", "z = 0"], (1, 1), [True] * 2, [False, True], "y = 0, and x is free"),
    ("x y z", ["exp(z xdot) = y", "z = 0"], (1, 1), [True] * 2, [False, True], "y = 1"),
    (
        "x y z",
        ["z exp(2 xdot) + y exp(xdot) = 1", "z = 0"],
        (2, 1),
        [False, True],
        [False, True],
        "xdot = -log(y), an affine form in x, y and t that does not integrate",
    ),
    (
        "x y z w",
        ["z xdot^4 = (1 + w^2) ydot^4", "z = 0"],
        (2, 2),
        [True] * 2,
        [False, True],
        "y is constant; for z > 0 xdot is a multiple of ydot that depends on z and w",
    ),
    ("x y z w", ["z xdot^3 + (1 + w^2) ydot^3 = 0", "z = 0"], (2, 2), [True] * 2, [False, True], "y is constant"),
    ("x z", ["xdot^2 + z = 0", "z = 0"], (0, 0), [True] * 2, [False, True], "x is constant"),
    (
        "x y z w u s",
        ["xdot^2 = (1 + s^2) (z ydot + w udot)^2", "w = 0"],
        (5, 4),
        [False, True],
        [False, True],
        "xdot = +-sqrt(1 + s^2) z ydot",
    ),
    (
        "x y z w u",
        ["(z xdot + (1 + w^2) ydot)^3 = u", "z = 0"],
        (4, 3),
        [False, True],
        [False, True],
        "(1 + w^2) ydot = u^(1/3)",
    ),
    (
        "x y z w",
        ["z (xdot^2 - w^2 ydot^2) = 0", "z = 0"],
        (3, 3),
        [True] * 2,
        [False, True],
        "alone the branch xdot = w ydot is the largest, whichever the others choose",
    ),
    ("x y z w", ["xdot (ydot - z wdot) = 0", "xdot = 0"], (3, 3), [True] * 2, [False, True], "the same with a form"),
    ("x y z", ["x (1 + exp(1/x)) (ydot^2 + zdot^2) = 0"], (1, 1), [True], [True], "at x = 0 it has no value"),
    (
        "x y z w u",
        ["z = 0", "z xdot + (1 + w^2) ydot = 0", "xdot^2 + ydot^2 = udot^2"],
        (2, 2),
        [True] * 3,
        [True, False, False],
        "y is constant, and u = +-x + C",
    ),
    (
        "x y z w",
        ["z/w = 0", "sqrt(ydot^2 + (w^2 wdot + (2 + w) zdot)^2) = 2 xdot + 2 zdot"],
        (3, 2),
        [True, False],
        [True, False],
        "z = 0, and a cone of velocities",
    ),
    (
        "x y z w",
        ["z = 0", "xdot^2 + ydot^2 = 1", "xdot^2 + ydot^2 + z wdot = 1"],
        (3, 2),
        [True, False, False],
        [True, False, False],
        "the last says what the second does",
    ),
    (
        "x y z",
        ["zdot^2 + (xdot + 3 ydot)^2 = 0", "z (t ydot + sin(z) xdot)^2 = zdot^2"],
        (1, 1),
        [True, True],
        [True, False],
        "z = 0 and x + 3 y constant; elsewhere all is at rest",
    ),
    ("x z", ["xdot^4 + 1 - cos(z) = 0"], (0, 0), [True], [True], "both terms are 0: z = 0 and x constant"),
    (
        "x y z",
        ["xdot^4 + (1 - cos(z)) ydot^4 = 0", "z = 0"],
        (1, 1),
        [True] * 2,
        [True] * 2,
        "x is constant, y is free where 1 - cos(z) is 0",
    ),
    ("x y z", ["xdot^4 = z ydot^4", "z = 0"], (1, 1), [True] * 2, [False, True], "x is constant"),
    (
        "x y u z w",
        ["exp(w z ydot) = 1", "z = 0"],
        (4, 4),
        [True] * 2,
        [True] * 2,
        "w z ydot = 0: alone y is constant, and at z = 0 it says nothing",
    ),
    (
        "x y z w u",
        ["(w ydot + xdot)^2 = (z - 1) (udot + w xdot)^2", "w = 0"],
        (4, 3),
        [False, True],
        [False, True],
        "xdot = +-sqrt(z - 1) udot",
    ),
    (
        "x y z w u",
        ["xdot^2 = (1 - z) (udot - ydot)^2", "w = t", "w exp((1 + x^2) xdot + ydot) = 1 - z"],
        (4, 2),
        [False, True, False],
        [False, True, False],
        "where 1 - z is 0 there is no logarithm",
    ),
    (
        "x y z w u",
        ["abs(ydot) + abs(udot + (w + z) ydot) = 0", "(1 + x^2) wdot + ydot = 0"],
        (2, 2),
        [True] * 2,
        [True, False],
        "y, u and w are constant",
    ),
]


@pytest.mark.parametrize(
    ("names", "constraints", "numbers", "beside", "alone"),
    [case[:5] for case in DECIDED],
    ids=[f"{'; '.join(case[1])}: {case[5]}" for case in DECIDED],
)
def test_decided(
    names: str, constraints: list[str], numbers: tuple[int, int], beside: list[bool], alone: list[bool]
) -> None:
    report = dofkit.classify({"coordinates": names.split(), "constraints": constraints})
    assert (report.dof, report.velocity_dof) == numbers
    assert [c.holonomic for c in report.constraints] == beside
    assert [c.holonomic_alone for c in report.constraints] == alone


@pytest.mark.parametrize(
    "constraints",
    [
        ["(xdot - ydot)^2/x = 0", "x = 0"],
        ["log(x) (xdot - ydot)^2 = 0", "x = -1 - y^2"],
        ["sqrt(x) (xdot^2 - ydot^2) = 0", "x = -1 - y^2"],
        ["xdot^2/y + xdot^2 + ydot^2/y^2 = 0", "y = 0"],
    ],
)
def test_a_relation_between_velocities_needs_a_value_where_it_is_to_hold(constraints: list[str]) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": constraints})
    assert report.consistent is False


@pytest.mark.parametrize(
    ("constraint", "at", "numbers"),
    [
        ("z exp(xdot) = y", {"y": 0, "z": 0}, (3, 2, 3)),
        ("z exp(xdot) = y", {"y": 1, "z": 1}, (3, 2, 2)),
        ("exp(z xdot) = y", {"y": 1, "z": 0}, (3, 2, 3)),
        ("z tanh(xdot) = y", {"y": 0, "z": 0}, (3, 2, 3)),
        ("z xdot^4 = ydot^4", {"y": 0, "z": 0}, (3, 2, 2)),
        ("z xdot^4 = ydot^4", {"y": 0, "z": -1}, (1, 1, 1)),
    ],
)
def test_at_an_edge_a_motion_leaves_it(constraint: str, at: dict[str, Any], numbers: tuple[int, int, int]) -> None:
    """From z = 0 a motion goes on to where z is not 0, with the freedom that is there."""
    scene = {"coordinates": ["x", "y", "z"], "constraints": [constraint], "configuration": {"x": 0, **at}}
    report = dofkit.classify(scene)
    assert (report.dof, report.velocity_dof, report.instantaneous_dof) == numbers


def test_a_branch_beside_others_that_misses_the_reference_is_none_of_it() -> None:
    """At z = 1 both constraints say xdot = 0 and x zdot + y ydot = 0, however the first is written."""
    sliding = "x zdot + t xdot + y ydot"
    for first in ("z^2 xdot^2 = 0", f"z^2 xdot^2 + y ({sliding}) = 0"):
        scene = {"coordinates": ["x", "y", "z"], "constraints": [first, f"{sliding} = 0"]}
        report = dofkit.classify(scene | {"configuration": {"x": 0, "y": 0, "z": 1}})
        assert (report.dof, report.velocity_dof) == (1, 1)


@pytest.mark.parametrize(
    "constraint",
    ["z xddot = 0", "z exp(xdot) = y", "xdot (ydot - z wdot) = 0", "z (xdot^2 - w^2 ydot^2) = 0", "z xdot^2 = ydot^2"],
)
def test_in_a_system_of_its_own_a_constraint_is_what_it_is_alone(constraint: str) -> None:
    report = dofkit.classify({"coordinates": list("xyzw"), "constraints": [constraint]})
    assert report.constraints[0].holonomic_alone == report.constraints[0].holonomic == report.holonomic


def test_the_integral_is_of_the_branch_in_use() -> None:
    """At z = 0 only y is constant; where z < 0 x would be so too."""
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["z xdot^4 = ydot^4", "z = 0"]})
    assert report.constraints[0].integral in (None, "y = C")
