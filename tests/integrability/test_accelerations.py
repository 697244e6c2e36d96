"""Second derivatives in a constraint: integrated once, the answers derived by hand; or refused, with the reason."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.base.errors import TextError
from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import by_time
from dofkit.expressions.text import Names, parse_expression
from dofkit.integrability.accelerations import integrated_once

NAMES = Names(
    coordinates=frozenset("xyz"),
    parameters={"g": ex.parameter("g"), "w": ex.parameter("w")},
    functions={"f": 1, "h": 1},
    allow_accelerations=True,
)


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": list(constraints), **more}


def told(report: Any, expected: dict[str, Any]) -> dict[str, Any]:
    """The report's own fields, and of the first constraint those that are named with a ``c1_`` before."""
    entry = report.constraints[0].model_dump()
    return {k: entry[k[3:]] if k.startswith("c1_") else report.model_dump()[k] for k in expected}


#: (why, scene, answer). F = C takes one velocity away; where F is linear it is dF - C dt, so dt enters.
TABLE: list[tuple[str, dict[str, Any], dict[str, Any]]] = [
    (
        "xdot = C, so x = C t + C1",
        scene("x", "xddot = 0"),
        {"dof": 0, "velocity_dof": 0, "c1_integral": "x - C*t = C1", "c1_scleronomic": False, "verdict": "proved"},
    ),
    (
        "xdot + ydot = C",
        scene("x y", "xddot + yddot = 0"),
        {"dof": 1, "velocity_dof": 1, "holonomic": True, "scleronomic": False, "verdict": "proved"},
    ),
    (
        "x ydot = C: (x dy - C dt) ^ dx ^ dy = -C dt ^ dx ^ dy is not 0",
        scene("x y", "x yddot + xdot ydot = 0"),
        {"dof": 2, "velocity_dof": 1, "holonomic": False, "verdict": "proved"},
    ),
    (
        "x xdot + y ydot = C, so (x^2 + y^2)/2 = C t + C1",
        scene("x y", "x xddot + xdot^2 + y yddot + ydot^2 = 0"),
        {"dof": 1, "velocity_dof": 1, "holonomic": True, "c1_integral": "x^2/2 + y^2/2 - C*t = C1"},
    ),
    (
        "on the circle x xdot + y ydot = 0, so C = 0: it follows",
        scene("x y", "x^2 + y^2 = 1", "x xddot + xdot^2 + y yddot + ydot^2 = 0"),
        {"dof": 1, "velocity_dof": 1, "scleronomic": True, "redundant": ["c2"]},
    ),
    (
        "the circle alone says more than its second derivative",
        scene("x y", "x xddot + xdot^2 + y yddot + ydot^2 = 0", "x^2 + y^2 = 1", configuration={"x": 1, "y": 0}),
        {"dof": 1, "instantaneous_dof": 1, "singular": False, "redundant": ["c1"]},
    ),
    (
        "zdot - y xdot = C: the contact form less C dt",
        scene("x y z", "zddot = ydot xdot + y xddot"),
        {"dof": 3, "velocity_dof": 2, "holonomic": False, "scleronomic": True, "c1_catastatic": False},
    ),
    (
        "the same with C = 0 written too",
        scene("x y z", "zdot = y xdot", "zddot = ydot xdot + y xddot"),
        {"dof": 3, "velocity_dof": 2, "holonomic": False, "scleronomic": True, "redundant": ["c2"]},
    ),
    (
        "areal velocity x ydot - y xdot = C: integrable for C = 0 only",
        scene("x y", "x yddot - y xddot = 0"),
        {"dof": 2, "velocity_dof": 1, "holonomic": False},
    ),
    (
        "on a line through the origin the areal velocity is 0",
        scene("x y", "x yddot - y xddot = 0", "y = 2 x"),
        {"dof": 1, "velocity_dof": 1, "holonomic": True, "redundant": ["c1"]},
    ),
    ("C = 3", scene("x", "xddot = 0", "xdot = 3"), {"consistent": True, "dof": 0, "redundant": ["c1"]}),
    ("C = C1", scene("x", "xddot = 0", "2 xddot = 0"), {"consistent": True, "dof": 0, "redundant": ["c2"]}),
    (
        "C2 = C + C1",
        scene("x y", "xddot = 0", "yddot = 0", "xddot + yddot = 0"),
        {"consistent": True, "dof": 0, "redundant": ["c3"]},
    ),
    ("2 = 0", scene("x", "x = t^2", "xddot = 0"), {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("xdot = 2 t", scene("x", "x = t^2", "xddot = 2"), {"consistent": True, "dof": 0, "redundant": ["c2"]}),
    ("t = C - C1", scene("x", "xddot = 2", "xddot = 3"), {"consistent": False, "conflicting": ["c1", "c2"]}),
    (
        "xdot^2 + ydot^2 = 2 C, a circle of velocities",
        scene("x y", "xdot xddot + ydot yddot = 0"),
        {"dof": 2, "velocity_dof": 1, "holonomic": False, "c1_form": "nonlinear"},
    ),
    ("C^2 + C1^2 = 1", scene("x y", "xdot^2 + ydot^2 = 1", "xddot = 0", "yddot = 0"), {"consistent": True, "dof": 0}),
    ("x = 0 or xdot = C", scene("x y", "x xddot = 0"), {"dof": 1, "velocity_dof": 1}),
    ("d(xdot/x)/dt = 0", scene("x y", "x xddot = xdot^2"), {"dof": 1, "c1_integral": "log(x) - C*t = C1"}),
    ("straight paths, ydot = C xdot", scene("x y", "xdot yddot = ydot xddot"), {"dof": 1, "c1_scleronomic": True}),
    ("xdot - sin t = C", scene("x", "xddot = cos(t)"), {"dof": 0, "c1_integral": "x - C*t + cos(t) = C1"}),
    ("C is taken", scene("C y", "Cddot = 0"), {"dof": 1, "c1_integral": "C - C1*t = C2"}),
    ("xdot + x = C, a form in x and t", scene("x y", "exp(y) (xddot + xdot) = 0"), {"dof": 1, "holonomic": True}),
]


@pytest.mark.parametrize(("made", "expected"), [row[1:] for row in TABLE], ids=[row[0] for row in TABLE])
def test_what_integrates_once(made: dict[str, Any], expected: dict[str, Any]) -> None:
    """Which constraints are redundant may be undecided beside a constant of integration."""
    answers = told(dofkit.classify(dofkit.load(made)), expected)
    undecided = {"redundant"} if answers.get("redundant") is None else set()
    assert {k: v for k, v in answers.items() if k not in undecided} == {
        k: v for k, v in expected.items() if k not in undecided
    }


def test_a_constant_under_a_root_is_not_answered_wrongly() -> None:
    """ydot = +-sqrt(1 - C^2): both coordinates move as t does, so the freedom is 0."""
    report = dofkit.classify(scene("x y", "xdot^2 + ydot^2 = 1", "xddot = 0"))
    assert (report.dof in (0, None), report.holonomic in (True, None)) == (True, True)


def test_what_was_integrated_is_said() -> None:
    report = dofkit.classify(dofkit.load(scene("x y", "x yddot + xdot ydot = 0")))
    said = "ntegrated once: x*ydot = C; the constant is determined by the initial conditions"
    assert said in report.constraints[0].reason
    assert any(said in warning for warning in report.warnings)
    assert any("C = 0 is a special case" in warning for warning in report.warnings)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("xddot = y", "y dt is no differential of positions and velocities"),
        ("xddot + x = 0", "of motion: x dt is no differential"),
        ("xddot = x ydot", "x dy is not closed"),
        ("x xddot = y yddot", "d(mu x) and d(mu y) would need one mu for both"),
    ],
)
def test_what_does_not_integrate_is_refused(text: str, why: str) -> None:
    assert why
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.classify(dofkit.load(scene("x y", text)))
    (fault,) = caught.value.faults
    assert "not the time derivative" in fault.message
    assert "by hand" in (fault.hint or "")


@pytest.mark.parametrize("text", ["sin(xddot) = 0", "xddot^2 = 1", "xddot yddot = 0", "sqrt(xddot) = 1"])
def test_what_is_not_linear_is_refused_at_once(text: str) -> None:
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.load(scene("x y", text))
    assert "linearly" in caught.value.faults[0].message


def test_an_inequality_of_second_derivatives_is_refused() -> None:
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.load(scene("x", "xddot >= 0"))
    assert "inequality" in caught.value.faults[0].message


@pytest.mark.parametrize(
    "text",
    [
        "x xdot + y^2 t",
        "xdot^2/2 + h(x)",
        "f(t) xdot + sin(x) y",
        "cos(x) xdot ydot - g t",
        "sqrt(1 + x^2) zdot + exp(y) xdot",
        "log(1 + x^2) ydot + sin(w t)",
        "xdot/(1 + y^2)",
        "xdot ydot zdot + x y z",
    ],
)
def test_a_rate_is_integrated_back(text: str) -> None:
    """dF/dt for a given F: what is found differs from F by a constant, so their rates agree."""
    rate = by_time(parse_expression(text, NAMES))
    assert rate is not None
    once = integrated_once(rate, frozenset())
    again = by_time(once.integral)
    assert again is not None
    assert zero_and_verdict(again - once.factor * rate, frozenset()) == (True, "proved")


def test_the_reason_of_a_refusal_is_an_error_of_the_text() -> None:
    with pytest.raises(TextError):
        integrated_once(parse_expression("xddot + x", NAMES), frozenset())


def test_a_constant_of_an_earlier_integration_is_no_integral_of_its_own() -> None:
    """theta'' = 3 says thetadot = 3 t + C and then theta = 3 t^2/2 + C t + C1: one relation for one coordinate."""
    part = dofkit.classify(scene("theta", "theta'' = 3")).integrable_part
    assert part is not None
    assert (part.rank, part.basis) == (1, ["theta - 3*t^2/2 - C*t = C1"])
