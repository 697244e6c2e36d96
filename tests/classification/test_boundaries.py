"""Where an expression is 0 that is asked to be >= 0, or that stands in abs(): does the set go on from there?"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import dofkit


def _report(names: str, constraints: list[str], **at: Any) -> dofkit.Report:
    scene: dict[str, Any] = {"coordinates": names.split(), "constraints": constraints}
    return dofkit.classify({**scene, "configuration": at} if at else scene)


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        ("x y z", ["abs(x) = z", "z = -y^2"]),  # 0 <= abs(x) = -y^2
        ("x y", ["abs(x) + 2 x^2 + 2 x y + y^2 = 0"]),  # abs(x) + x^2 + (x + y)^2
        ("x y z", ["abs(x) = z", "abs(y) = -z", "x^2 = y^3"]),
    ],
)
def test_a_set_that_ends_where_it_is_drawn_is_not_told_to_go_on(names: str, constraints: list[str]) -> None:
    """The set is the origin alone: 0, or open."""
    assert _report(names, constraints, **dict.fromkeys(names.split(), 0)).dof in (0, None)


@pytest.mark.parametrize(
    ("names", "constraints", "dof"),
    [
        ("x y z", ["abs(x) = z"], 2),
        ("x y z", ["abs(x) = z", "x = 0"], 1),
        ("x y z", ["abs(x) + abs(y) = z"], 2),
        ("x y z", ["abs(x) + abs(y) = z", "x = 2 y"], 1),
        ("x y z", ["abs(x) = y", "abs(y) = z", "z = -x"], 1),
    ],
)
def test_a_set_that_goes_on_inside_is_no_point(names: str, constraints: list[str], dof: int) -> None:
    assert _report(names, constraints, **dict.fromkeys(names.split(), 0)).dof in (dof, None)


@pytest.mark.parametrize("at", [0, 1])
def test_a_reference_where_the_root_has_no_gradient(at: int) -> None:
    """y = 0 and x >= 0 have two freedoms with z; the root has no gradient at the origin, so it may stay undecided."""
    report = _report("x y z", ["sqrt(x^2 + y^2) = x"], x=at, y=0, z=0)
    assert report.dof == 2 if at else report.dof in (2, None)


def test_a_sign_that_changes_at_a_point_is_not_followed_through_it() -> None:
    """abs(x) = x holds on all of the curve x = sin(y)^2: it has 1, and its point x = 0 is no point apart."""
    report = _report("x y", ["x = sin(y)^2", "4/3 x - sqrt(x^2) = 1/3 sin(y)^2"])
    assert report.dof in (1, None)


@pytest.mark.parametrize(
    ("constraints", "holds"),
    [
        (["abs(x - 1) = x - 1"], lambda x, y: x >= 1),
        (["abs(x) = -x", "y = 2 x"], lambda x, y: x <= 0 and y == 2 * x),
        (["abs(x) = -x", "xdot = ydot"], lambda x, y: x <= 0),
    ],
)
def test_a_witness_lies_where_the_relations_hold(constraints: list[str], holds: Any) -> None:
    witness = _report("x y", constraints).witness
    assert witness is not None
    assert holds(Fraction(witness["x"]), Fraction(witness["y"]))


def test_what_vanishes_with_its_radial_derivative_is_not_told_to_hold_dt() -> None:
    """tanh(u) = 0 for a form u without dt is u = 0: scleronomic, or open."""
    report = _report("x y z w", ["tanh(z xdot + w z ydot) = 0"])
    assert report.scleronomic is not False


@pytest.mark.parametrize(
    "others",
    [
        ["z exp(xdot) = u", "ydot = 0"],  # at rest in x and y: u = z; on another branch u = z = 0
        ["xdot = -1"],  # no motion keeps to its side
    ],
)
def test_a_side_that_velocities_keep_to_is_no_finite_relation_whatever_the_others_say(others: list[str]) -> None:
    entry = _report("x y z u", ["sqrt(xdot^2 + (xdot + ydot)^2) = xdot", *others]).constraints[0]
    assert entry.holonomic_alone is not True


def test_what_lies_beyond_a_side_may_be_on_another_branch() -> None:
    """z abs(xdot) = ydot at z = 0 is ydot = 0 for velocities xdot of both signs."""
    entry = _report("x y z", ["z abs(xdot) = ydot", "z = 0"]).constraints[0]
    assert entry.holonomic is not False


def test_a_relation_of_velocities_that_says_nothing_is_read() -> None:
    assert _report("x y", ["abs(xdot - ydot) = abs(ydot - xdot)"]).dof in (2, None)


def test_coordinates_that_no_relation_holds_are_free_beside_dependent_ones() -> None:
    """y = -1, so that zdot = 0: x (or s), w and u are free."""
    constraints = ["x + y = s", "x - y = s + 2", "dz = (atan(y) - atan(0 - 1)) w du"]
    assert _report("x y s z w u", constraints).dof in (3, None)


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("exp(zdot - w xdot) = 1", True),
        ("atan(zdot - w xdot) = 0", True),
        ("(zdot - w xdot) (1 + xdot^2) = 0", True),
        ("(zdot - w xdot)^2 = 0", False),
        ("cosh(zdot - w xdot) = 1", False),
        ("sqrt(1 + (zdot - w xdot)^2) = 1", False),
    ],
)
def test_an_answer_in_velocities_is_irregular_where_its_slopes_vanish(text: str, same: bool) -> None:
    scene = {"coordinates": ["x", "z", "w"], "constraints": ["zdot = w xdot"]}
    assert dofkit.ask(scene, "equivalence", {"constraint": "c1", "text": text}).value is same
