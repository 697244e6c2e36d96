"""Equations that are the same over the reals, and those that are not."""

from __future__ import annotations

import pytest
from shared.known_scenes import spread

import dofkit

CIRCLE, LINE, CROSS, HYPERBOLA, WAVE = "x^2 + y^2 = R^2", "3 x + 4 y = 5", "x^2 - y^2 = 0", "x y = 1", "y = sin(x)"


@pytest.mark.parametrize(
    ("asked", "answer", "status", "codes"),
    spread(
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
            ("x^4 = y^4", CROSS, "right", []),  # x^2 + y^2 vanishes where x = y = 0 only, a point of both lines
            ("x^4 = y^4", "x^4 = y^4", "right", []),
            ("(x - y)^2 = 0", "(y - x)^2 = 0", "right", []),  # as irregular as what was asked for
            ("xdot^3 = ydot^3", "2 xdot^3 = 2 ydot^3", "right", []),
            ("xdot^2 + ydot^2 = R^2", "(xdot^2 + ydot^2 - R^2)^2 = 0", "partly", ["IRREGULAR"]),
            ("xdot^2 + ydot^2 = R^2", "(xdot^2 + ydot^2)^2 = R^4", "right", []),
        ],
        2,
        several=True,
    ),
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


@pytest.mark.parametrize(
    ("answer", "status"),
    [
        ("z = x y + C", "right"),
        ("z = y + C", "needs_review"),
        ("z = ± y + C", "needs_review"),
        ("z = 2 y + C", "wrong"),
    ],
)
def test_an_integral_of_one_branch_of_the_others_is_left_to_a_person(answer: str, status: str) -> None:
    """Where x = 1 it is z - y = C, and z + y = C where x = -1."""
    made = {"coordinates": ["x", "y", "z"], "constraints": ["x^2 = 1", "dz = x dy"]}
    problem = {"id": "p", "scene": made, "questions": [{"id": "q", "ask": "integral", "constraint": "c2"}]}
    result = dofkit.grade({"title": "sheet", "problems": [problem]}, {"student": "s", "answers": {"p": {"q": answer}}})
    assert [i.status for i in result.items] == [status]
