"""Whether t occurs in a constraint or in what it integrates to, and whether it is homogeneous in the velocities."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

#: (coordinates, constraints, scleronomic and catastatic of the first one, why); None is undecided, and of what holds
#: no velocities, or is an inequality, not defined. Functions: c and f of t, h of x and t; v is a positive parameter.
TABLE: list[tuple[str, list[str], bool | None, bool | None, str]] = [
    # Finite: t occurs once removable factors are taken out, or it does not.
    ("x y", ["x = v t"], False, None, "t occurs"),
    ("x y", ["exp(t) (x^2 + y^2 - 1) = 0"], True, None, "exp(t) never vanishes"),
    ("x y", ["(t - 3) (x - y) = 0"], True, None, "t - 3 is analytic in t alone: 0 at one instant"),
    ("x y", ["sin(t) (x - y) = 0"], True, None, "analytic in t alone"),
    ("x y", ["(sqrt(t) + t) (x - y) = 0"], True, None, "analytic in t alone where it has a value, but for its end"),
    ("x y", ["(2 + x^2 + t^2) (x - y) = 0"], True, None, "2 at least"),
    ("x y", ["f(t) (x - y) = 0"], True, None, "a declared function"),
    ("x y", ["h(x, t) (x - y) = 0"], True, None, "a declared function of x and t"),
    ("x y", ["x = c(t)"], False, None, "a prescribed motion"),
    ("x y", ["sin(x + t) cos(t) = cos(x + t) sin(t)"], True, None, "sin(x) = 0"),
    ("x y", ["(t + abs(t)) (x - y) = 0"], None, None, "no condition for t < 0, x = y after: not wrong"),
    ("x y", ["(abs(t)/t + 1) x = 0"], None, None, "no condition for t < 0, x = 0 after: not wrong"),
    ("x y", ["(acos(cos(t)) - t) y = 0"], None, None, "no condition for 0 < t < pi, y = 0 after"),
    ("x y", ["(2 + x^2 + cos(x)) (y^2 + t^2) = 0"], None, None, "y = 0 at t = 0 only"),
    ("x y", ["cos(x - t) cosh(y) = cosh(y)"], None, None, "x = t, where the gradient vanishes: not wrong"),
    # Pfaffian: not integrable.
    ("x y z", ["dz = y dx"], True, True, "neither t nor dt"),
    ("x y z", ["zdot = y xdot + 1"], True, False, "dz - y dx - dt does not integrate: dt dx dy remains of its wedge"),
    ("x y z", ["zdot = y xdot + t"], False, False, "t occurs, and it does not integrate"),
    ("x y z", ["c(t) (dz - y dx) = 0"], True, True, "a declared function"),
    ("x y z", ["t (dz - y dx) = 0"], True, True, "analytic in t alone"),
    ("x y z", ["exp(t) (dx + y dz) = 0"], True, True, "never 0"),
    ("x y", ["cos(t) dx + sin(t) dy = 0"], False, True, "the direction turns with t"),
    ("x y", ["(t + abs(t)) (dx - 2 dy) = 0"], None, True, "it binds after t = 0 only: not wrong"),
    ("x y", ["(t - 4 + abs(t - 4)) (dx - 2 dy) = 0"], None, True, "it binds after t = 4 only: not wrong"),
    ("x y z", ["(x - t) (xdot + y zdot) = 0"], False, True, "x = t is a branch"),
    # Pfaffian: integrable, alone or in the system.
    ("x y", ["dx = y dy"], True, True, "x - y^2/2 = C"),
    ("x", ["xdot = v"], False, False, "x - v t = C"),
    ("x", ["xdot = x"], False, False, "x exp(-t) = C"),
    ("x", ["dx - t dt = 0"], False, False, "x - t^2/2 = C"),
    ("x y", ["xdot = y", "ydot = 0"], False, False, "x - y t = C with y = C1"),
    ("x y", ["xdot = y", "y = 0"], True, False, "x = C"),
    ("x y", ["xdot = y", "ydot = 1"], None, False, "x - y t + t^2/2 = C with y = t + C1, or x - y^2/2 = C"),
    ("x y", ["xdot = y", "ydot = -x"], False, False, "x = C cos(t + C1)"),
    ("x y", ["xdot = y", "y = t"], None, False, "x - t^2/2 = C, which may be written as x - y^2/2 = C"),
    ("x y", ["x = 0", "xdot = y"], True, None, "a wall"),
    ("x y", ["xdot = y", "x = 0"], True, False, "y = 0"),
    ("x y z", ["xdot = y", "y = 0", "z = x + t"], True, False, "x = C"),
    ("x y", ["xdot = y", "(x^2 + y^2 + 1) y = 0"], True, False, "x = C"),
    ("x y", ["h(x, t) = 0"], False, None, "it is the constraint, and no factor"),
    ("x y z", ["xdot = y", "zdot = y"], True, False, "x - z = C integrates, neither of them does"),
    ("x y", ["dx + t dy = 0", "y = 0"], False, True, "x = C, and t occurs as it is written"),
    # Nonlinear in the velocities.
    ("x y", ["xdot^2 + ydot^2 = v^2"], True, False, "a speed that is prescribed"),
    ("x y", ["xdot ydot = v"], True, False, "the same"),
    ("x y z", ["xdot^2 + ydot^2 = zdot^2"], True, True, "a cone"),
    ("x y", ["cos(xdot - 1) cosh(y) = cosh(y)"], None, None, "xdot = 1 is no cone; the gradient vanishes: not wrong"),
    ("x y z", ["xdot^3 + ydot^3 = t zdot^3"], False, True, "a cone that changes"),
    ("x y", ["xdot^2 + ydot^2 = t^2"], False, False, "t occurs"),
    ("x y", ["f(t) (xdot^2 + ydot^2 - v^2) = 0"], True, False, "a declared function"),
    ("x", ["sqrt(xdot) = 1"], None, False, "xdot = 1, so x = t + C: rheonomic, but the root is not undone"),
    # Inequalities.
    ("x y", ["x <= v t"], False, None, "the boundary moves"),
    ("x y", ["exp(t) x >= 0"], True, None, "exp(t) is positive"),
    ("x y", ["t x >= 0"], None, None, "its sign changes at t = 0"),
    ("x y", ["xdot >= 1"], True, None, "t does not occur"),
]


def classified(coordinates: str, constraints: list[str]) -> dofkit.Report:
    scene: dict[str, Any] = {"coordinates": coordinates.split(), "constraints": constraints}
    return dofkit.classify(
        {**scene, "parameters": {"v": "positive"}, "functions": {"c": ["t"], "f": ["t"], "h": ["x", "t"]}}
    )


@pytest.mark.parametrize(("coordinates", "constraints", "scleronomic", "catastatic", "why"), TABLE)
def test_whether_time_occurs(
    coordinates: str, constraints: list[str], scleronomic: bool | None, catastatic: bool | None, why: str
) -> None:
    entry = classified(coordinates, constraints).constraints[0]
    assert (entry.scleronomic, entry.catastatic) == (scleronomic, catastatic), why
    assert (entry.verdicts["scleronomic"].verdict == "undecided") is (scleronomic is None)


def test_a_drive_is_rheonomic() -> None:
    joint = {"type": "revolute", "between": ["ground", "a"], "at": [0, 0]}
    driven = dofkit.classify({"dimension": 2, "bodies": ["a"], "constraints": [{**joint, "drive": "t"}]})
    free = dofkit.classify({"dimension": 2, "bodies": ["a"], "constraints": [joint]})
    assert (driven.scleronomic, free.scleronomic) == (False, True)


def test_acatastatic_is_printed() -> None:
    report = classified("x y", ["xdot^2 + ydot^2 = v^2"])
    assert "acatastatic\n" in str(report)
    assert "acatastatic" in report._repr_html_()


def test_a_growth_vector_counts_time_where_it_enters() -> None:
    """(dz - y dx) times what rests at 0 for t < 0 and cannot be divided out: (3, 4) in (q, t) where it acts."""
    assert classified("x y z", ["(t + abs(t)) (dz - y dx) = 0"]).growth_vector is None
    assert classified("x y z", ["c(t) (dz - y dx) = 0"]).growth_vector == [2, 3]
