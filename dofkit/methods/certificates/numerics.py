"""Floating point: values and gradients of trees, elimination; good for looking, never for deciding."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from dofkit.checker.trees import Tree

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
            dependent.append(place)
            continue
        fit = [name for name in sorted(row) if abs(row[name]) > 1e-3 * largest]
        column = max(fit, key=lambda name: abs(row[name]) * (prefer(place, name) if prefer else 1.0))
        lead = row[column]
        kept.append((column, {name: value / lead for name, value in row.items() if value}))
        pivots.append(Pivot(place, column))
    return FloatEchelon(pivots, dependent)


def solved(rows: Sequence[Row], right: Sequence[float], columns: Sequence[str]) -> dict[str, float] | None:
    """Return the solution of a square system; None where it is singular in floats."""
    if not columns:
        return {}
    matrix = np.array([[row.get(c, 0.0) for c in columns] for row in rows])
    try:
        solution = np.linalg.solve(matrix, np.array(right, dtype=float))
    except np.linalg.LinAlgError:
        return None
    small = np.linalg.norm(matrix) * np.linalg.norm(solution) * 1e-13
    return dict(zip(columns, solution.tolist(), strict=True)) if small < 1 + np.linalg.norm(right) else None


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

Gradient = dict[str, float]
Estimate = tuple[float, Gradient]


class NoEstimateError(Exception):
    """A tree has no value in floats here."""


class Estimates:
    """Values and gradients at one point, by every symbol; values alone, which cost less, without ``slopes``."""

    def __init__(self, values: Mapping[str, float], slopes: bool = True) -> None:
        self.values, self.slopes = values, slopes
        self._done: dict[int, tuple[Tree, Estimate]] = {}

    def value(self, tree: Tree) -> float:
        """The value; `NoEstimateError` where there is none."""
        return self.value_and_gradient(tree)[0]

    def gradient(self, tree: Tree) -> Gradient:
        """The derivatives by the symbols that occur."""
        return self.value_and_gradient(tree)[1]

    def value_and_gradient(self, tree: Tree) -> Estimate:
        """Value and gradient."""
        estimate = self._done.get(id(tree))
        if estimate is None:
            try:
                estimate = self._done[id(tree)] = tree, self._read(tree)
            except (ValueError, OverflowError, ZeroDivisionError, KeyError):
                raise NoEstimateError(tree.head) from None
        return estimate[1]

    def _read(self, tree: Tree) -> Estimate:
        head = tree.head
        if isinstance(tree.value, Fraction):
            return float(tree.value), {}
        if head == "symbol":
            name = str(tree.value)
            return self.values[name], {name: 1.0} if self.slopes else {}
        if head == "pi":
            return math.pi, {}
        below = [self.value_and_gradient(part) for part in tree.below]
        if head == "sum":
            return sum(value for value, _ in below), combined([(1.0, slope) for _, slope in below])
        if head == "product":
            return _product(below)
        if head == "power":
            return _power(below[0], below[1])
        if head == "atan2":
            (y, dy), (x, dx) = below
            size = x * x + y * y
            return math.atan2(y, x), combined([(x / size, dy), (-y / size, dx)])
        value, slope = _elementary(head, below[0][0])
        return value, combined([(slope, below[0][1])])


def combined(terms: list[tuple[float, Gradient]]) -> Gradient:
    """A linear combination of gradients."""
    gradient: Gradient = {}
    for factor, slope in terms:
        for name, part in slope.items():
            gradient[name] = gradient.get(name, 0.0) + factor * part
    return gradient


def _product(below: list[Estimate]) -> Estimate:
    value, slope = below[0]
    for other, change in below[1:]:
        slope = combined([(other, slope), (value, change)]) if change else {n: other * s for n, s in slope.items()}
        value *= other
    return value, slope


def _power(base: Estimate, exponent: Estimate) -> Estimate:
    (b, db), (e, de) = base, exponent
    value = b**e
    if isinstance(value, complex):
        raise NoEstimateError("power")
    terms = [(e * b ** (e - 1) if e else 0.0, db)]
    if de:
        terms.append((value * math.log(b), de))
    return value, combined(terms)


def _elementary(head: str, u: float) -> tuple[float, float]:
    """Return the value and the slope of a function; the checker's trees are written in these four and ``atan2``."""
    if head == "log":
        return math.log(u), 1 / u
    if head == "exp":
        return math.exp(u), math.exp(u)
    if head not in ("sin", "cos"):
        raise NoEstimateError(head)
    sine, cosine = math.sin(u), math.cos(u)
    return (sine, cosine) if head == "sin" else (cosine, -sine)
