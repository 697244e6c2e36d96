"""Linear equations and inequalities over the rationals: a solution, or a proof that there is none.

A simplex method in exact arithmetic decides which of the two; its solution or its multipliers are then checked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from flint import fmpq, fmpq_mat

from dofkit.base.deadline import check

#: Bounds on the entries of the matrix of equations, and of the simplex tableau.
MAX_EQUATIONS, MAX_TABLEAU = 1_000_000, 250_000

Vector = tuple[fmpq, ...]
ZERO, ONE = fmpq(0), fmpq(1)


@dataclass(frozen=True)
class LinearCondition:
    """``coefficients`` . x + ``constant`` is 0, or >= 0, or > 0, by its ``sense``."""

    coefficients: Vector
    constant: fmpq
    sense: Literal["=", ">=", ">"]

    def holds(self, x: Sequence[fmpq]) -> bool:
        """Return whether the condition is satisfied at a point."""
        value = _dot(self.coefficients, x) + self.constant
        return bool(value == 0 if self.sense == "=" else value > 0 if self.sense == ">" else value >= 0)


def _dot(a: Sequence[fmpq], b: Sequence[fmpq]) -> fmpq:
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def solution(conditions: Sequence[LinearCondition]) -> Vector | Literal[False] | None:
    """Return a point that satisfies all conditions; False if there is provably none, None if they are too many."""
    n = len(conditions[0].coefficients) if conditions else 0
    equations = [c for c in conditions if c.sense == "="]
    if max(len(equations), n) * (n + 1) > MAX_EQUATIONS:
        return None
    solutions = _solutions(equations, n)
    if solutions is None:
        return False
    free, inequalities = solutions.ncols() - 1, [c for c in conditions if c.sense != "="]
    if (len(inequalities) + free + 2) * (free + 2) > MAX_TABLEAU:
        return None
    restricted = []
    for c in inequalities:
        row = (fmpq_mat([list(c.coefficients)]) * solutions).entries() if n else [ZERO]
        restricted.append(LinearCondition(tuple(row[:-1]), row[-1] + c.constant, c.sense))
    free_point = _alternative(restricted, free)
    if free_point is None or free_point is False:
        return free_point
    point = tuple((solutions * fmpq_mat([[v] for v in (*free_point, ONE)])).entries())
    return point if all(c.holds(point) for c in conditions) else None


def _solutions(equations: Sequence[LinearCondition], n: int) -> fmpq_mat | None:
    """Return a matrix M such that x = M (z, 1), z free, are all solutions of ``equations``; None if there is none."""
    reduced, rank = fmpq_mat([[*e.coefficients, e.constant] for e in equations] or [[ZERO] * (n + 1)]).rref()
    row_of = {next(c for c in range(n + 1) if reduced[r, c] != 0): r for r in range(rank)}
    if n in row_of:
        return None
    free = [c for c in range(n) if c not in row_of]
    units = [[fmpq(int(c == f)) for f in (*free, n)] for c in range(n)]
    rows = [[-reduced[row_of[c], f] for f in (*free, n)] if c in row_of else units[c] for c in range(n)]
    return fmpq_mat(n, len(free) + 1, [v for row in rows for v in row])


def _alternative(conditions: Sequence[LinearCondition], n: int) -> Vector | Literal[False] | None:
    """Return a solution x of inequalities a_i . x + b_i >= 0 (or > 0); False if there is none [Motzkin1936].

    Either there are l_i >= 0 and s >= 0 with sum l_i a_i = 0, sum l_i b_i + s = 0 and s + (the strict l_i) = 1, which
    no x allows; or a linear function (y, u, v) is at most 0 on all columns (a_i, b_i, [i strict]) and on (0, 1, 1) and
    has v > 0: then u < 0, and x = y / u is a solution.
    """
    columns = [(*c.coefficients, c.constant, ONE if c.sense == ">" else ZERO) for c in conditions]
    weights, function = _phase_one([*columns, (*(ZERO for _ in range(n)), ONE, ONE)], n + 2)
    if function is not None:
        return tuple(y / function[n] for y in function[:n])
    multipliers = weights[:-1]
    cancelled = all(_dot(multipliers, [c[j] for c in columns]) == 0 for j in range(n))
    number, strict = (_dot(multipliers, [c[k] for c in columns]) for k in (n, n + 1))
    refuted = cancelled and all(m >= 0 for m in multipliers) and (number < 0 or (number == 0 and strict > 0))
    return False if refuted else None


def _phase_one(columns: Sequence[Vector], rows: int) -> tuple[list[fmpq], list[fmpq] | None]:
    """Return (non-negative weights w with sum of w_j column_j = (0, ..., 0, 1), None).

    If there are none, return instead of None a linear function that is at most 0 on every column and positive on
    (0, ..., 0, 1). The simplex method with Bland's rule, which terminates [Bland1977].
    """
    number = len(columns)
    artificial_columns = [tuple(ONE if i == k else ZERO for i in range(rows)) for k in range(rows)]
    every, basis = [*columns, *artificial_columns], list(range(number, number + rows))
    while True:
        check()
        inverse = fmpq_mat([[every[j][r] for j in basis] for r in range(rows)]).inv()
        lines = [[inverse[r, k] for k in range(rows)] for r in range(rows)]
        artificial = [r for r in range(rows) if basis[r] >= number]
        prices = [sum((lines[r][k] for r in artificial), ZERO) for k in range(rows)]
        entering = next((j for j, column in enumerate(columns) if _dot(prices, column) > 0), None)
        if entering is None:
            break
        slopes = [_dot(line, columns[entering]) for line in lines]
        basis[min((lines[r][-1] / v, basis[r], r) for r, v in enumerate(slopes) if v > 0)[2]] = entering
    weights = [ZERO] * number
    for r, j in enumerate(basis):
        if j < number:
            weights[j] = lines[r][-1]
    return weights, prices if any(lines[r][-1] != 0 for r in artificial) else None
