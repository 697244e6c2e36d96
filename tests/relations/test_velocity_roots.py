"""Relations in one combination of the velocities, solved for it; and where what is left out holds."""

from __future__ import annotations

import pytest

import dofkit


@pytest.mark.parametrize(
    ("nonlinear", "linear", "other"),
    [
        ("exp(xdot - ydot - x) = 1", "xdot - ydot = x", "xdot - ydot = -x"),
        ("(xdot - 2 ydot + 3)^3 = 8", "xdot - 2 ydot = -1", "xdot - 2 ydot = 5"),
        ("sinh(3 xdot + ydot - t) = 0", "3 xdot + ydot = t", "3 xdot + ydot = -t"),
    ],
)
def test_what_stands_beside_the_velocities_keeps_its_sign(nonlinear: str, linear: str, other: str) -> None:
    same = dofkit.classify({"coordinates": ["x", "y"], "constraints": [nonlinear, linear]})
    assert (same.consistent, same.redundant) == (True, ["c2"])
    assert dofkit.classify({"coordinates": ["x", "y"], "constraints": [nonlinear, other]}).redundant != ["c2"]


@pytest.mark.parametrize("more", ["x = 1", "x^2 = 1", "x = y + 1"])
def test_a_denominator_may_have_any_value_but_zero(more: str) -> None:
    """atan x + atan(1/x) = pi/2 sgn(x): y = 0, and x is 1 or -1."""
    identity = "y + atan(x) + atan(1/x) - pi x/(2 abs(x)) = 0"
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [identity, more]})
    assert (report.consistent, report.dof) == (True, 1)


def test_a_root_that_is_real_nowhere_is_left_out() -> None:
    """tanh(xdot) = y says exp(xdot)^2 = (1 + y)/(1 - y): of the two roots for exp(xdot) one is below 0."""
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["tanh(xdot) = y"]})
    assert not any("branches" in warning for warning in report.warnings)
    assert (report.scleronomic, report.constraints[0].catastatic) == (True, False)


#: Relations in x, y, z whose terms cancel, what they say, dof and velocity_dof.
CANCELLED = [
    ("exp(xdot*z - z*xdot + ydot) = x", "ydot = log(x): a form that does not integrate", (3, 2)),
    ("abs((xdot + ydot)*z - xdot*z - ydot*z + zdot) = x", "zdot = x or -x, where x >= 0", (3, 2)),
    ("exp(xdot*z - z*xdot) = x", "x = 1", (2, 2)),
    ("(xdot + ydot)*z - xdot*z - ydot*z = x", "x = 0", (2, 2)),
    ("xdot*ydot - ydot*xdot = 0", "0 = 0", (3, 3)),
    ("xdot*ydot - ydot*xdot + zdot^2 = 1", "zdot = 1 or -1", (2, 2)),
]


@pytest.mark.parametrize(("text", "why", "numbers"), CANCELLED, ids=[row[0] for row in CANCELLED])
def test_velocities_that_cancel_are_not_divided_by(text: str, why: str, numbers: tuple[int, int]) -> None:
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [text]})
    assert (report.consistent, report.dof, report.velocity_dof) == (True, *numbers), why


def test_a_relation_that_is_multiplied_by_dt_integrates_to_no_constant_time() -> None:
    """x dt = 0 says x = 0 in a motion, and not t = C."""
    (entry,) = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x*dt = 0"]}).constraints
    assert entry.integral is None or "t =" not in entry.integral
