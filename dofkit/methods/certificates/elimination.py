"""Elimination in floats: which rows are independent, in which columns; nothing is decided by it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

Row = Mapping[str, float]
SMALL = 1e-8


class Pivot(NamedTuple):
    """A row that is independent of those before it, and a column in which it is."""

    row: int
    column: str


class FloatEchelon(NamedTuple):
    """The pivots in the order of the rows, and the rows that depend on those before."""

    pivots: list[Pivot]
    dependent: list[int]


def echelon(rows: Sequence[Row], prefer: Callable[[int, str], float] | None = None) -> FloatEchelon:
    """Rows in their order, each kept where it is not in the span of those kept before.

    ``prefer`` gives a weight to a row's column: of those that are not tiny the one of largest size times weight is
    the pivot.
    """
    kept: list[tuple[str, dict[str, float]]] = []
    pivots: list[Pivot] = []
    dependent: list[int] = []
    for place, given in enumerate(rows):
        row = {name: value for name, value in given.items() if value}
        size = max(map(abs, row.values()), default=0.0)
        for column, other in kept:
            factor = row.get(column)
            if factor:
                for name, value in other.items():
                    row[name] = row.get(name, 0.0) - factor * value
                row[column] = 0.0
        largest = max(map(abs, row.values()), default=0.0)
        if largest <= SMALL * max(size, 1e-3):
            dependent.append(place)
            continue
        fit = [name for name in sorted(row) if abs(row[name]) > 1e-3 * largest]
        column = max(fit, key=lambda name: abs(row[name]) * (prefer(place, name) if prefer else 1.0))
        lead = row[column]
        kept.append((column, {name: value / lead for name, value in row.items() if value}))
        pivots.append(Pivot(place, column))
    return FloatEchelon(pivots, dependent)


def solved(rows: Sequence[Row], right: Sequence[float], columns: Sequence[str]) -> dict[str, float] | None:
    """The solution of a square system; None where it is singular in floats."""
    matrix = [[row.get(c, 0.0) for c in columns] + [b] for row, b in zip(rows, right, strict=True)]
    size = len(columns)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(matrix[i][k]))
        if abs(matrix[best][k]) < 1e-13:
            return None
        matrix[k], matrix[best] = matrix[best], matrix[k]
        lead = matrix[k]
        for i in range(k + 1, size):
            factor = matrix[i][k] / lead[k]
            if factor:
                matrix[i] = [a - factor * b for a, b in zip(matrix[i], lead, strict=True)]
    found = [0.0] * size
    for k in reversed(range(size)):
        rest = sum(matrix[k][j] * found[j] for j in range(k + 1, size))
        found[k] = (matrix[k][size] - rest) / matrix[k][k]
    return dict(zip(columns, found, strict=True))


def least_step(rows: Sequence[Row], right: Sequence[float]) -> dict[str, float]:
    """A short step x with rows x = right, as nearly as that can be: J^T (J J^T + small)^-1 right."""
    count = len(rows)
    normal = [
        {str(j): sum(value * rows[j].get(name, 0.0) for name, value in rows[i].items()) for j in range(count)}
        for i in range(count)
    ]
    scale = max((normal[i][str(i)] for i in range(count)), default=1.0) or 1.0
    for i in range(count):
        normal[i][str(i)] += 1e-10 * scale
    weights = solved(normal, right, [str(j) for j in range(count)])
    step: dict[str, float] = {}
    for j, row in enumerate(rows):
        for name, value in row.items():
            step[name] = step.get(name, 0.0) + (weights or {}).get(str(j), 0.0) * value
    return step
