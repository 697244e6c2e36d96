"""Functions of one coordinate that vanish at one value only."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.exact_zeros import sole_zero

X = ex.coordinate("x")
SIN, COS, EXP = (ex.fn(name, X) for name in ("sin", "cos", "exp"))


@pytest.mark.parametrize(
    ("e", "value", "why"),
    [
        (X - SIN, ex.ZERO, "the derivative 1 - cos(x) is nowhere negative"),
        (EXP - 1 - X, ex.ZERO, "it lies above its tangent"),
        (COS - 1 + X * X / 2, ex.ZERO, "so does its second derivative"),
        (ex.fn("sinh", X) + X, ex.ZERO, "monotone"),
        (X + COS - ex.PI / 2, ex.PI / 2, "1 - sin(x) >= 0"),
        (X - 2 * SIN, None, "two more zeros"),
        (X - COS, None, "one zero, of no short form"),
        (SIN, None, "many"),
        (X * X - 1 + COS, ex.ZERO, "the second derivative 2 - cos(x) is positive, the first 2 x - sin(x) is 0 at 0"),
        (EXP + 1, None, "none"),
        (EXP - 2 * X, None, "none: the minimum is 2 - 2 log(2)"),
        (ex.fn("log", X) - X + 1, None, "one zero, but not on the whole line"),
        (X * X - 2 * X + 1, None, "a polynomial: its radical is seen otherwise"),
    ],
)
def test_the_only_zero(e: Expr, value: Expr | None, why: str) -> None:
    assert sole_zero(e) == value, why


@pytest.mark.parametrize(
    ("constraints", "expected"),
    [
        (["x = sin(x)", "x = 0"], {"dof": 1, "redundant": ["c2"], "verdict": "proved"}),
        (["x = 0", "x = sin(x)"], {"dof": 1, "redundant": ["c2"], "verdict": "proved"}),
        (["x = 2 sin(x)", "x = 0"], {"dof": 1, "redundant": ["c1"]}),
        (["x = sin(x)", "y = sin(y)", "x = y"], {"dof": 0, "redundant": ["c3"], "verdict": "proved"}),
        (["x = sin(x)", "x = 1"], {"consistent": False, "conflicting": ["c1", "c2"], "verdict": "proved"}),
    ],
    ids="; ".join,
)
def test_beside_others_it_is_that_value(constraints: list[str], expected: dict[str, Any]) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": constraints})
    assert {name: getattr(report, name) for name in expected} == expected
