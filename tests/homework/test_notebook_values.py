"""Values of notebooks, and texts of which a document ate the backslashes, as answers."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp

from dofkit.homework.answers.submission import FilePlace, of_text, of_value
from dofkit.homework.assignment import load_assignment
from dofkit.homework.grading import Grader

x, y, length, m, g, t = sp.symbols("x y l m g t")
theta = sp.Function("theta")(t)
SCENE: dict[str, Any] = {
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "coordinates": ["x", "y"],
    "constraints": [{"name": "rod", "type": "equation", "text": "x^2 + y^2 = l^2"}],
}
PENDULUM: dict[str, Any] = {
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "coordinates": ["theta"],
    "energies": {"kinetic": "m l^2 thetadot^2/2", "potential": "-m g l cos(theta)"},
}
SHEET = {
    "title": "Notebook",
    "problems": [
        {"id": "p", "scene": SCENE, "questions": [
            {"id": "f", "ask": "dof"}, {"id": "eq", "ask": "equation", "constraint": "rod"},
            {"id": "q", "ask": "coordinates"}]},
        {"id": "m", "scene": PENDULUM, "questions": [
            {"id": "L", "ask": "lagrangian"}, {"id": "eom", "ask": "motion"}]},
    ],
}  # fmt: skip


@cache
def grader() -> Grader:
    return Grader(load_assignment(SHEET))


@pytest.mark.parametrize(
    ("place", "answer", "status"),
    [
        ("p.f", np.int64(1), "right"),
        ("p.f", np.float64(1.0), "right"),
        ("p.f", np.array(1), "right"),
        ("p.f", np.int64(2), "wrong"),
        ("p.f", sp.Integer(1), "right"),
        ("p.f", sp.Rational(1, 2), "wrong"),
        ("p.f", sp.Float(1.0), "right"),
        ("p.f", True, "unreadable"),
        ("p.f", np.bool_(True), "unreadable"),
        ("p.eq", sp.Eq(x**2 + y**2, length**2), "right"),
        ("p.eq", x**2 + y**2 - length**2, "right"),
        ("p.eq", sp.Eq(x**2 + y**2, length), "wrong"),
        ("p.eq", [sp.Eq(x**2 + y**2, length**2)], "right"),
        ("p.q", {"x"}, "right"),
        ("p.q", sp.FiniteSet(x), "right"),
        ("p.q", np.array(["x"]), "right"),
        ("p.q", {x, y}, "wrong"),
        ("m.L", m * length**2 * theta.diff(t) ** 2 / 2 + m * g * length * sp.cos(theta), "right"),
        ("m.L", m * length**2 * theta.diff(t) ** 2 / 2 - m * g * length * sp.cos(theta), "wrong"),
        ("m.eom", sp.Eq(theta.diff(t, 2), -g / length * sp.sin(theta)), "right"),
        ("m.eom", "Eq(Derivative(theta(t), (t, 2)), -g*sin(theta(t))/l)", "right"),
    ],
)
def test_values_of_notebooks(place: str, answer: Any, status: str) -> None:
    problem, question = place.split(".")
    result = grader().grade(of_value({"answers": {problem: {question: answer}}}, "s"))
    assert next(i for i in result.items if (i.problem, i.question) == (problem, question)).status == status


@pytest.mark.parametrize(
    "text",
    [
        'answers:\n  m:\n    eom: "\\ddot{\\theta} = -\\frac{g}{l} \\sin\\theta"\n',
        '{"answers": {"m": {"eom": "\\ddot{\\theta} = -\\frac{g}{l} \\sin\\theta"}}}',
        '{"answers": {"m": {"eom": "l \\\\ddot{\\\\theta} = -g \\\\sin\\\\theta"}}}',
        "answers:\n  m:\n    eom: \"theta'' = -\\frac{g}{l} sin(\\theta)\"\n",
    ],
)
def test_backslashes_in_quotes(text: str) -> None:
    (submission,) = of_text(text, "s", FilePlace())
    assert submission.error is None
    item = next(i for i in grader().grade(submission).items if i.question == "eom")
    assert item.status == "right", item.feedback
