"""Linear equations and inequalities over the rationals: a solution, or a combination that shows there is none."""

from __future__ import annotations

import random
from typing import Literal

import pytest
from flint import fmpq

from dofkit.exact.linear_inequalities import LinearCondition, solution

Sense = Literal["=", ">=", ">"]
Rows = list[tuple[list[int], int, Sense]]


def conditions(rows: Rows) -> list[LinearCondition]:
    return [LinearCondition(tuple(map(fmpq, a)), fmpq(b), sense) for a, b, sense in rows]


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ([([1], 0, ">"), ([-1], 0, ">=")], "x > 0 and x <= 0"),
        ([([1], -1, ">="), ([-1], 0, ">=")], "x >= 1 and x <= 0"),
        ([([1, 0], 0, ">="), ([0, 1], 0, ">="), ([-1, -1], -1, ">=")], "x, y >= 0 and x + y <= -1"),
        ([([1, -1], 0, ">"), ([-1, 1], 0, ">=")], "x > y and y >= x"),
        ([([1, -1], 0, "="), ([1, 0], -1, ">="), ([0, -1], 0, ">=")], "x = y, x >= 1, y <= 0"),
        ([([0, 0], -1, ">=")], "-1 >= 0"),
        ([([0], 0, ">")], "0 > 0"),
        ([([1], 0, "="), ([1], -1, "=")], "x = 0 and x = 1"),
        ([([2, 3], -1, "="), ([4, 6], -2, ">")], "2x + 3y = 1, and twice that above 2"),
    ],
)
def test_what_has_no_solution(rows: Rows, why: str) -> None:
    assert solution(conditions(rows)) is False, why


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ([([1], 0, ">="), ([-1], 0, ">=")], "x = 0 only"),
        ([([1], 0, ">"), ([-1], 1, ">")], "0 < x < 1"),
        ([([1, 1], -1, "="), ([1, -1], 0, "=")], "a point"),
        ([([1, -1, 0], 0, ">="), ([0, 1, -1], 0, ">="), ([-1, 0, 1], 0, ">=")], "x = y = z only"),
        ([([0, 0], 0, ">="), ([0, 0], 1, ">")], "no unknown takes part"),
        ([([1000003, -7], 11, "="), ([0, 1], -(10**12), ">")], "large numbers"),
    ],
)
def test_what_has_a_solution(rows: Rows, why: str) -> None:
    asked = conditions(rows)
    found = solution(asked)
    assert found, why
    assert all(c.holds(found) for c in asked)


def test_systems_that_are_made_to_have_a_solution_have_one() -> None:
    rng = random.Random(3)
    for _ in range(150):
        n = rng.randrange(1, 5)
        point = [fmpq(rng.randrange(-6, 7), rng.randrange(1, 4)) for _ in range(n)]
        asked = []
        for _ in range(rng.randrange(1, 9)):
            a = tuple(fmpq(rng.randrange(-3, 4)) for _ in range(n))
            above = fmpq(rng.randrange(0, 3))
            sense: Sense = "=" if rng.random() < 0.2 else ">" if above > 0 else ">="
            value = sum((x * y for x, y in zip(a, point, strict=True)), fmpq(0))
            asked.append(LinearCondition(a, (fmpq(0) if sense == "=" else above) - value, sense))
        found = solution(asked)
        assert found
        assert all(c.holds(found) for c in asked)


def test_systems_whose_sum_is_negative_have_no_solution() -> None:
    """The last inequality is minus a positive combination of the others, less 1."""
    rng = random.Random(4)
    for _ in range(150):
        n, m = rng.randrange(1, 5), rng.randrange(1, 6)
        first = [[fmpq(rng.randrange(-3, 4)) for _ in range(n + 1)] for _ in range(m)]
        weights = [fmpq(rng.randrange(0, 4), 2) for _ in range(m)]
        last = [-sum((w * row[j] for w, row in zip(weights, first, strict=True)), fmpq(0)) for j in range(n + 1)]
        last[-1] -= fmpq(1, 7)
        asked = [LinearCondition(tuple(row[:-1]), row[-1], ">=") for row in (*first, last)]
        assert solution(asked) is False


def test_a_long_chain_that_closes() -> None:
    """x1 <= x2 <= ... <= x60 <= x1 leaves equal numbers; with one < nothing."""
    n = 60
    closed = []
    for k in range(n):
        row = [fmpq(0)] * n
        row[k], row[(k + 1) % n] = fmpq(-1), fmpq(1)
        closed.append(LinearCondition(tuple(row), fmpq(0), ">="))
    found = solution(closed)
    assert found
    assert len(set(map(str, found))) == 1
    assert solution([*closed[:-1], LinearCondition(closed[-1].coefficients, fmpq(0), ">")]) is False
