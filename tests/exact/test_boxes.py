"""Intervals are rounded outward: held against fractions."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import mpmath
import pytest
from hypothesis import example, given
from hypothesis import strategies as s

from dofkit.exact.boxes import INF, UNIT, WHOLE, BoxProgram, add, function, inverses, mul
from dofkit.expressions.tree import coordinate, fn, num

FINITE = s.floats(min_value=1e-300, max_value=1e300, allow_nan=False)


@given(FINITE, FINITE)
@example(1 / 3, 1 / 3)
@example(1 / 49, 1 / 49)
@example(1e-300, 1e-300)
@example(1e300, 1e300)
def test_results_hold_those_of_the_ends(a: float, b: float) -> None:
    low, high = min(a, b), max(a, b)
    ((below, above),) = inverses((low, high))
    exact = Fraction(low), Fraction(high)
    assert Fraction(below) <= 1 / exact[1]
    assert above == INF or Fraction(above) >= 1 / exact[0]
    for combine, ends in ((add, [2 * v for v in exact]), (mul, [v * v for v in exact])):
        below, above = combine((low, high), (low, high))
        assert Fraction(below) <= ends[0]
        assert above == INF or Fraction(above) >= ends[1]


def test_whole_quotients_stay_points() -> None:
    for n in range(1, 53):
        assert inverses((1 / 2**n, 1 / 2**n)) == [(2.0**n, 2.0**n)]


def test_of_whole_turns_all_values_are_told() -> None:
    for name in ("sin", "cos"):
        assert function(name, WHOLE) == function(name, (0.0, 7.0)) == UNIT


def test_backward_every_solution_stays() -> None:
    """Return the half-line x >= 2 for sqrt(x) >= sqrt(2) and x^2 - 4 >= 0 with x >= 0, up to rounding."""
    x = coordinate("x")
    ((low, high),) = BoxProgram([(x**2 - 4, (0.0, INF)), (x, (0.0, INF))]).contract([WHOLE])
    assert low <= 2 <= high == INF
    (box,) = BoxProgram([(fn("exp", x) + num(3) * x, (1.0, 1.0))]).contract([(-1.0, 1.0)])
    assert box[0] <= 0 <= box[1] <= 1


@pytest.mark.parametrize("name", ["exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"])
def test_true_values_and_their_arguments_stay(name: str) -> None:
    rng, x = random.Random(name), coordinate("x")
    with mpmath.workprec(150):
        for _ in range(200):
            a, b = sorted(rng.uniform(-4, 4) * 10 ** rng.choice([-3, 0, 0, 1]) for _ in range(2))
            at = rng.uniform(a, b)
            if (name == "log" and at <= 0) or (name in ("asin", "acos") and abs(at) > 1):
                continue
            value = getattr(mpmath, name)(mpmath.mpf(at))
            low, high = function(name, (a, b))
            assert low <= value <= high
            near = math.nextafter(float(value), -INF), math.nextafter(float(value), INF)
            ((low, high),) = BoxProgram([(fn(name, x), near)]).contract([(a, b)])
            assert low <= at <= high
