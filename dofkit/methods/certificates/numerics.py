"""Floating point: values and gradients of trees, elimination; good for looking, never for deciding."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from dofkit.checker.trees import Tree, derivative

Row = Mapping[str, float]
SMALL = 1e-8


class Pivot(NamedTuple):
    """A row that is independent of those before it, and a column in which it is."""

    row: int
    column: str


def echelon(rows: Sequence[Row], prefer: Callable[[int, str], float] | None = None) -> list[Pivot]:
    """The pivots of rows in their order, each kept where it is not in the span of those kept before.

    ``prefer`` gives a weight to a row's column: of those that are not tiny the one of largest size times weight is
    the pivot.
    """
    kept: list[tuple[str, dict[str, float]]] = []
    pivots: list[Pivot] = []
    for place, entries in enumerate(rows):
        row = {name: value for name, value in entries.items() if value}
        size = max(map(abs, row.values()), default=0.0)
        for column, other in kept:
            factor = row.get(column)
            if factor:
                for name, value in other.items():
                    row[name] = row.get(name, 0.0) - factor * value
                row[column] = 0.0
        largest = max(map(abs, row.values()), default=0.0)
        if largest <= SMALL * max(size, 1e-3):
            continue
        fit = [name for name in sorted(row) if abs(row[name]) > 1e-3 * largest]
        column = max(fit, key=lambda name: abs(row[name]) * (prefer(place, name) if prefer else 1.0))
        lead = row[column]
        kept.append((column, {name: value / lead for name, value in row.items() if value}))
        pivots.append(Pivot(place, column))
    return pivots


def least_step(rows: Sequence[Row], right: Sequence[float]) -> dict[str, float]:
    """Return a short step x with rows x = right, as nearly as that can be: J^T (J J^T + small)^-1 right."""
    names = sorted({name for row in rows for name in row})
    matrix = np.array([[row.get(name, 0.0) for name in names] for row in rows])
    if not names:
        return {}
    normal = matrix @ matrix.T
    normal += 1e-10 * (normal.diagonal().max() or 1.0) * np.eye(len(rows))
    step = matrix.T @ np.linalg.solve(normal, np.array(right, dtype=float))
    return dict(zip(names, step.tolist(), strict=True))


# Values and gradients of trees in floats: good for looking, never for deciding.


class NoEstimateError(Exception):
    """A tree has no value in floats here."""


class Estimates:
    """Values and gradients of trees at one point."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = {"tdot": 1.0, **values}
        self._done: dict[int, tuple[Tree, float]] = {}

    def value(self, tree: Tree) -> float:
        """The value; `NoEstimateError` where there is none."""
        if id(tree) not in self._done:
            try:
                self._done[id(tree)] = tree, self._read(tree)
            except (ValueError, OverflowError, ZeroDivisionError, KeyError, TypeError):
                raise NoEstimateError(tree.head) from None
        return self._done[id(tree)][1]

    def gradient(self, tree: Tree) -> dict[str, float]:
        """The derivatives by the symbols that occur."""
        return {name: self.value(derivative(tree, name)) for name in tree.symbols}

    def _read(self, tree: Tree) -> float:
        if isinstance(tree.value, Fraction):
            return float(tree.value)
        if tree.head == "symbol":
            return self.values[str(tree.value)]
        return float(VALUES[tree.head](*map(self.value, tree.below)))


#: The functions that the checker's trees are written in.
VALUES: dict[str, Callable[..., Any]] = {
    "sum": lambda *terms: sum(terms),
    "product": lambda *factors: math.prod(factors),
    "power": pow,
    "pi": lambda: math.pi,
    **{name: getattr(math, name) for name in ("sin", "cos", "exp", "log", "atan2")},
}
