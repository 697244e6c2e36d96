"""Whether one configuration at one time satisfies all equations as written; each truth is worked out by hand."""

from __future__ import annotations

from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": [*constraints], **more}


H = {"h": ["s"]}
#: No configuration, or no motion through an interval of time: why, and the scene.
NEVER: list[tuple[str, dict[str, Any]]] = [
    ("t >= 3 and t <= 2", scene("x y", "x^2 = t - 3", "y^2 = 2 - t")),
    ("t >= 1 and t <= -1", scene("x y", "cosh(x) = t", "cosh(y) = -t")),
    ("t > 0 and t < 0", scene("x y", "exp(x) = t", "exp(y) = -t")),
    ("t^2 >= 4 and t^2 <= 1", scene("x y", "x^2 = t^2 - 4", "y^2 = 1 - t^2")),
    ("t <= 1 and t >= 2", scene("x y", "sin(x) = t", "sin(y) = t - 3")),
    ("t = 0 only", scene("x y", "x^2 = t", "y^2 = -t")),
    ("beside a form that does not matter", scene("x y z w", "x^2 = t - 3", "y^2 = 2 - t", "zdot = x*wdot")),
    ("p >= 3 and p <= 2", scene("x y", "x^2 = p - 3", "y^2 = 2 - p", parameters=["p"])),
    ("h >= 0 and h <= -1 at one time", scene("x y", "x^2 = h(t)", "y^2 = -1 - h(t)", functions=H)),
    ("t = 5 only", scene("u", "u = t - 5", "u = 0")),
    ("t = 5 only, beside a factor without zeros", scene("u x y", "u = (t-5)*(x^2+y^2+1)", "u = 0")),
    ("t = 5 only, exp(x) has no zeros", scene("u x", "u = exp(x)*(t-5)", "u = 0")),
]
NEVER += [
    ("t >= 3 and t <= 2 under roots of forms", scene("x y", "dx = sqrt(t-3) dt", "dy = sqrt(2-t) dt")),
    ("t >= 3 and t < 2", scene("x y", "x = sqrt(t - 3)", "y = log(2 - t)")),
    # what is cancelled keeps its domain
    ("(x^2-4)/(x-2) at 2", scene("x y", "x = 2", "y = (x^2-4)/(x-2)")),
    ("0 times a logarithm that has no value", scene("x y", "y = 0*log(-1-x^2)")),
    ("0 times a root that has no value", scene("x y", "y = 0*sqrt(-1-x^2)")),
    ("0 times an arcsine that has no value", scene("x", "x = asin(2 + x^2)*0")),
    ("x/x at 0", scene("x y", "x = 0", "y = x/x")),
    ("sin(s)/s at 0", scene("u s", "u = sin(s)/s", "s = 0")),
    ("sqrt(x)^2 at -1", scene("x", "sqrt(x)^2 = x", "x = -1")),
    ("log(x) - log(x) at -1", scene("x y", "y = log(x) - log(x)", "x = -1")),
    ("exp(log(x)) at -2", scene("x y", "y = exp(log(x))", "x = -2")),
    ("1/x - 1/x at 0", scene("x y", "y = 1/x - 1/x", "x = 0")),
    ("0 times sqrt(x) at -1", scene("x y", "y = sqrt(x)*0 + 1", "x = -1")),
    ("(x^2-1)/(x-1) = 2 at x = 1 only", scene("x y", "y = (x^2-1)/(x-1)", "y = 2")),
    ("(x-1)^2/(x-1) = 0 at x = 1 only", scene("x y", "y = (x-1)^2/(x-1)", "y = 0")),
    ("(x-2)^2/(x-2) = 0 at x = 2 only", scene("x", "(x-2)^2/(x-2) = 0")),
    ("y/y at 0", scene("x y", "x*y/y = 0", "y = 0")),
    ("y/y at 0 in a form", scene("x y", "xdot*(y/y) = 0", "y = 0")),
    ("x/x at 0 in a form", scene("x y", "dy = (x/x) dx", "x = 0")),
    ("sin(x)^2/sin(x) at pi", scene("x y", "y = sin(x)^2/sin(x)", "x = pi")),
    ("tan(x) cos(x) at pi/2", scene("x y", "y = tan(x)*cos(x)", "x = pi/2")),
    ("0/x at 0", scene("x", "0/x = 0", "x = 0")),
    ("dy/dx where x rests", scene("x y", "dy/dx = 2", "x = 3")),
    ("dy/dx where the two directions differ", scene("x y", "dy/dx = 2", "y = 3")),
    ("a branch of a quadratic equation in dy/dx, where x rests", scene("x y", "(ydot/xdot)^2 = 4", "x = 3")),
    ("dx/dx where x rests", scene("x y", "xdot/xdot = 1", "x = 3")),
    ("the root of a negative velocity", scene("x y", "sqrt(xdot) = ydot", "xdot = -1")),
    ("dy/dx = 2 nowhere on a circle", scene("x y", "dy/dx = 2", "x^2 + y^2 = 1")),
    ("three rates of rest", scene("x y z", "dy/dx = 2", "dy/dz = 1", "x = z")),
    ("1/z - 1/z where another equation says z = 0", scene("x z", "x = 1/z - 1/z", "z^2 = 0")),
    (
        "x/x on a curve that meets x = 0 only",
        {
            "dimension": 2,
            "particles": ["A"],
            "constraints": [{"type": "on", "members": ["A"], "surface": "y - x/x"}, "x_A = 0"],
        },
    ),
]
#: Why it is consistent, the scene, its freedom.
SOMETIMES: list[tuple[str, dict[str, Any], int]] = [
    ("cos(x) = 1 where h is 0 at all times", scene("x y", "cos(x) + cos(h(t)) = 2", functions=H), 1),
    ("4 <= t <= 5", scene("x y z", "x^2 = t", "y^2 = 5 - t", "z^2 = t - 4"), 0),
    ("0 <= t <= 4", scene("x y z", "x^2 = t", "y^2 = 5 - t", "z^2 = (t - 4)*(t - 6)"), 0),
    ("3 <= t <= 100: a circle", scene("x y u", "x^2 + y^2 = t - 3", "u^2 = 100 - t"), 1),
    ("the circle at all times but t = 5", scene("u x y", "u = (t-5)*(x^2+y^2-1)", "u = 0"), 1),
    ("x = y at all times but t = 5", scene("u x y", "u = (t-5)*(x-y)", "u = 0"), 1),
    ("x y = 1 at almost all times", scene("u x y", "u = sin(t)*(x*y-1)", "u = 0"), 1),
    ("x = y = 0", scene("u v x y", "u = (t-5)*x", "v = (t-5)*y", "u^2 + v^2 = 0"), 0),
    ("at t <= 4 both say x = 0", scene("x", "x = t - 4 + abs(t - 4)", "x = 0"), 0),
    ("at t <= 0 both say that x rests", scene("x", "xdot = t + abs(t)", "x = 0"), 0),
    ("at t >= 1 both say x = 0", scene("x", "x = sqrt((t-1)^2) - t + 1", "x = 0"), 0),
    ("near t = 0 both say x = 0", scene("x", "x = asin(sin(t)) - t", "x = 0"), 0),
    ("at t <= 0 both say x = 0, and y is free", scene("x y", "x = log(1 + t + abs(t))", "x = 0"), 1),
    ("at 0 <= t <= pi y is free", scene("x y", "(acos(cos(t)) - t) y = 0"), 2),
    ("at t <= 0 y is free", scene("x y", "(t + abs(t)) y = 0"), 2),
    ("at t >= 0 y is free", scene("x y", "(sqrt(t^2) - t) y = 0"), 2),
    ("y = 0, as the factor is 2 + 2 cos(t)", scene("x y", "(1 + cos(t) + abs(1 + cos(t))) y = 0"), 1),
    ("x = sqrt(t), though not x = -sqrt(t)", scene("x", "x*abs(x) = t", "x^2 = t"), 0),
    ("x >= 0 on the curve", scene("x y", "y = x*abs(x) - t", "y = x^2 - t"), 1),
    ("x = t^(1/4)", scene("x", "x^3*abs(x) = t", "x^4 = t"), 0),
    ("x = sqrt(t), y = 0", scene("x y", "abs(x)*x + y = t", "x^2 + y = t", "y = 0"), 0),
    ("x = t/2", scene("x", "x + abs(x) = t", "2*x = t"), 0),
    ("t > 3", scene("x", "dx = sqrt(t-3) dt"), 0),
    ("sqrt(x)^2 where x >= 0", scene("x", "sqrt(x)^2 = x"), 1),
    ("sqrt(x) = 0 at the edge of the domain", scene("x y", "sqrt(x) = 0"), 1),
    ("x/x at 1", scene("x y", "y = x/x", "x = 1"), 0),
    ("log(z) of a coordinate that nothing else mentions", scene("x z", "x = 0*log(z)"), 1),
    ("a line without one point", scene("x y", "y = (x^2-1)/(x-1)"), 1),
    ("x = -2 of x^2 = 4", scene("x y", "x^2 - 4 = 0", "y = (x^2-4)/(x-2)"), 0),
    ("x = -2 where the quotient vanishes", scene("x y", "(x^2-4)/(x-2) = 0"), 1),
    ("x is not 0", scene("x y", "x/x = 1", "y = x"), 1),
    ("a circle, at times after 0", scene("x y", "x^2 + y^2 = exp(log(t))"), 1),
    ("dy/dx along a line", scene("x y", "dy/dx = 2", "y = 2 x + 1"), 1),
    ("dy/dx in a motion that is given", scene("x y", "dy/dx = 2", "x = 3 + t"), 0),
    ("dy/dx of a skate that keeps its heading", scene("x y a", "dy/dx = tan(a)", "a = pi/4"), 1),
    ("three rates of one straight motion", scene("x y z", "dx/dy = 2", "dy/dz = 3", "dz/dx = 1/6"), 1),
    ("x = abs(t)", scene("x", "sqrt(x^2)*x = t^2", "x^2 = t^2"), 0),
    ("1 < t < 2", scene("x y", "exp(x) = t - 1", "exp(y) = 2 - t"), 0),
]


@pytest.mark.parametrize("made", [made for _, made in NEVER], ids=[why for why, _ in NEVER])
def test_without_a_common_point(made: dict[str, Any]) -> None:
    report = dofkit.classify(made)
    assert report.consistent in (False, None)
    assert (report.dof, report.velocity_dof) == (None, None)
    assert report.consistent is False or report.verdict == "undecided"


@pytest.mark.parametrize(
    ("made", "dof"), spread((row[1:] for row in SOMETIMES), 2, several=True), ids=[row[0] for row in SOMETIMES]
)
def test_with_a_common_point(made: dict[str, Any], dof: int) -> None:
    """Of the witness's component less may be told, where ``about`` says so."""
    report = dofkit.classify(made)
    assert report.consistent in (True, None)
    near = report.dof is not None and report.verdicts["dof"].about == "component"
    assert report.dof in (dof, None) or (near and report.dof <= dof)
    assert report.dof is not None or report.verdict == "undecided"


def test_a_quotient_of_velocities_has_no_value_at_rest() -> None:
    """The constraints x = 3 and dy/dx = 2 allow no motion along which dy/dx has a value; either can be satisfied."""
    report = dofkit.classify(scene("x y", "dy/dx = 2", "x = 3"))
    assert (report.consistent, report.verdicts["consistent"].verdict) == (False, "proved")
    assert report.conflicting == ["c1", "c2"]
    assert "xdot != 0, which no motion satisfies" in " ".join(report.warnings)
