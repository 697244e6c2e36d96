"""What is a number times the equation asked for is seen at once; what only looks so is not."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.classification.dependence.comparison import same_up_to_numbers
from dofkit.classification.freedom.preparation import prepared
from dofkit.homework.key.key import Key
from dofkit.scene.added_equations import read_equations, with_equations
from dofkit.scene.lowering import lower

FINITE = ("x^2 + y^2 = 1", "z = x y")
FORMS = ("dx = R cos(theta) dphi", "dy = R sin(theta) dphi")


def seen(answer: str, *asked: str) -> bool:
    """Is the answer a multiple of the constraints asked for, the first of which is called c1?"""
    made = {"parameters": {"R": "positive"}, "coordinates": ["x", "y", "z", "theta", "phi"], "constraints": [*asked]}
    key = Key(dofkit.load(made))
    reduced, setting = prepared(
        lower(with_equations(key.scene, read_equations(answer, key.names, constants=False), "answer"))
    )
    wanted, given = reduced[: len(asked)], reduced[len(asked) :]
    return same_up_to_numbers(given, wanted, setting.positive)


@pytest.mark.parametrize(
    ("answer", "asked", "truth"),
    [
        ("3 x^2 = 3 - 3 y^2", FINITE[:1], True),
        ("-(x + y)^2/7 + 2 x y/7 + 1/7 = 0", FINITE[:1], True),
        ("x y - z = 0; 2 x^2 + 2 y^2 = 2", FINITE, True),
        ("R xdot = R^2 phidot cos(theta)", FORMS[:1], False),  # R is no number; the long way tells that it is the same
        ("5 dx - 5 R cos(theta) dphi = 0", FORMS[:1], True),
        ("ydot = R phidot sin(theta); 2 xdot = 2 R phidot cos(theta)", FORMS, True),
        ("cos(theta)^2 + x^2 + y^2 + sin(theta)^2 = 2", FINITE[:1], True),
        ("x^2 + y^2 = 2", FINITE[:1], False),
        ("x^2 + 2 y^2 = 1", FINITE[:1], False),
        ("(x^2 + y^2 - 1)^2 = 0", FINITE[:1], False),
        ("x^2 + y^2 = 1", FINITE, False),
        ("x^2 + y^2 = 1; z = x y; x = 0", FINITE, False),
        ("(x^2 + y^2)/x = 1/x", FINITE[:1], False),
        ("sqrt(x) (x^2 + y^2 - 1) = 0", FINITE[:1], False),
        ("(sqrt(x) - 1) (sqrt(x) + 1) + x^2 - x + y^2 = 0", FINITE[:1], False),
        ("sqrt(x^2 + y^2) = 1", FINITE[:1], False),
        ("x dx + y dy = 0", FINITE[:1], False),
        ("dx + R cos(theta) dphi = 0", FORMS[:1], False),
        ("(dx - R cos(theta) dphi)^2 = 0", FORMS[:1], False),
    ],
)
def test_multiples(answer: str, asked: tuple[str, ...], truth: bool) -> None:
    assert seen(answer, *asked) is truth


CIRCLE, LINE, CROSS, HYPERBOLA, WAVE = "x^2 + y^2 = R^2", "3 x + 4 y = 5", "x^2 - y^2 = 0", "x y = 1", "y = sin(x)"


@pytest.mark.parametrize(
    ("asked", "answer", "status", "codes"),
    [
        (CIRCLE, "exp(x^2 + y^2 - R^2) = 1", "right", []),  # over the reals exp(u) = 1 is u = 0
        (CIRCLE, "sinh(x^2 + y^2 - R^2) = 0", "right", []),
        (CIRCLE, "exp(x^2 + y^2) = exp(R^2)", "right", []),
        (CIRCLE, "(x^2 + y^2 - R^2)^3 + x^2 + y^2 - R^2 = 0", "needs_review", []),  # right: u (u^2 + 1)
        (CIRCLE, "cosh(x^2 + y^2 - R^2) = 1", "partly", ["IRREGULAR"]),  # begins with u^2/2
        (LINE, "cosh(3 x + 4 y - 5) = 1", "partly", ["IRREGULAR"]),
        (LINE, "(3 x + 4 y - 5)^3 = 0", "partly", ["IRREGULAR"]),
        (HYPERBOLA, "x^3 y^3 = 1", "needs_review", []),  # right: m^3 - 1 = (m - 1) (m^2 + m + 1)
        (HYPERBOLA, "x^2 y^2 = 1", "wrong", ["WEAKER"]),
        (HYPERBOLA, "log(x) + log(y) = 0", "partly", ["ONE_BRANCH"]),  # x, y > 0 only
        ("y = exp(x)", "y^3 = exp(3 x)", "right", []),
        ("y = exp(x)", "log(y) = x", "right", []),  # y > 0 there
        (WAVE, "y^2 = 1 - cos(x)^2", "wrong", ["WEAKER"]),  # y = -sin(x) too
        (CROSS, "-(x^2 - y^2) = 0", "right", []),
        (CROSS, "x^4 = y^4", "right", []),
        (CROSS, "abs(x) = abs(y)", "right", []),
        (CROSS, "(x - y)^2 (x + y) = 0", "partly", ["IRREGULAR"]),
        (CROSS, "x = y", "partly", ["ONE_BRANCH"]),
    ],
)
def test_what_is_the_same_over_the_reals(asked: str, answer: str, status: str, codes: list[str]) -> None:
    made = {"coordinates": ["x", "y"], "parameters": {"R": "positive"}, "constraints": [asked]}
    problem = {"id": "p", "scene": made, "questions": [{"id": "q", "ask": "equation", "constraint": "c1"}]}
    result = dofkit.grade({"title": "sheet", "problems": [problem]}, {"student": "s", "answers": {"p": {"q": answer}}})
    assert [(i.status, list(i.codes)) for i in result.items] == [(status, codes)]


def test_the_square_of_a_finite_relation_beside_a_form_is_irregular() -> None:
    constraints = ["theta = 1", "dx = R cos(theta) dphi"]
    made = {
        "coordinates": ["x", "theta", "phi"],
        "parameters": {"R": "positive"},
        "constraints": [{"name": "straight", "type": "equation", "text": constraints[0]}, constraints[1]],
    }
    problem = {"id": "p", "scene": made, "questions": [{"id": "q", "ask": "equation", "constraint": "straight"}]}
    for answer, status in (("(theta - 1)^2 = 0", "partly"), ("2 theta = 2", "right")):
        result = dofkit.grade(
            {"title": "sheet", "problems": [problem]}, {"student": "s", "answers": {"p": {"q": answer}}}
        )
        assert [i.status for i in result.items] == [status]
