"""Expressions in floating point over whole grids at once; for pictures only.

An unknown function is drawn as an example: a rising wave for each argument.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from dofkit.expressions.tree import Expr
from dofkit.pictures.shapes import Array

Known = Mapping[Expr, Array | float]

_UNARY = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "exp": np.exp, "log": np.log, "abs": np.abs,
}  # fmt: skip
#: Of symbols that are not given: parameters are 1, all else is 0.
_DEFAULT = {"parameter": 1.0}
#: The step of derivatives, and the singular value (of rows of length 1) that counts as 0.
STEP, SMALL = 1e-6, 1e-5


def evaluated(e: Expr, known: Known, memo: dict[Expr, Array] | None = None) -> Array:
    """The value of an expression; ``nan`` where it has none."""
    memo = {} if memo is None else memo
    if e not in memo:
        with np.errstate(all="ignore"):
            memo[e] = np.asarray(_value(e, known, memo), dtype=float)
    return memo[e]


def _value(e: Expr, known: Known, memo: dict[Expr, Array]) -> Array | float:
    if e.op == "num":
        return float(e.args[0])
    if e.op == "const":
        return math.pi if e.args[0] == "pi" else math.e
    if e.op == "sym":
        return known.get(e, _DEFAULT.get(e.args[0], 0.0))
    if e.op == "call":
        return _example(e, known, memo)
    parts = [evaluated(part, known, memo) for part in e.args if isinstance(part, Expr)]
    if e.op == "add":
        return np.asarray(sum(parts))
    if e.op == "mul":
        return np.asarray(math.prod(parts))
    if e.op == "pow":
        return np.asarray(parts[0] ** parts[1])
    return _function(e.args[0], parts)


def _function(name: str, parts: Sequence[Array]) -> Array:
    if name == "atan2":
        return np.asarray(np.arctan2(*parts))
    if name in ("cot", "sec", "csc"):
        below = {"cot": np.tan, "sec": np.cos, "csc": np.sin}[name](parts[0])
        return np.asarray(1.0 / below)
    return np.asarray(_UNARY[name](parts[0]))


def _example(e: Expr, known: Known, memo: dict[Expr, Array]) -> Array:
    """u/2 + 0.4 sin(w u + p) for each argument u, and the derivatives of that."""
    name, orders, arguments = e.args
    phase = 0.7 * (sum(map(ord, name)) % 9)
    if sum(order > 0 for order in orders) > 1:
        return np.asarray(0.0)
    total = np.asarray(0.0)
    for k, (order, argument) in enumerate(zip(orders, arguments, strict=True)):
        if any(orders) and not order:
            continue
        wave = 1.1 + 0.3 * k
        inner = wave * evaluated(argument, known, memo) + phase + order * math.pi / 2
        total = total + 0.4 * wave**order * np.sin(inner)
        if order < 2:
            total = total + (0.5 if order else 0.5 * evaluated(argument, known, memo))
    return total


def values_at(exprs: Sequence[Expr], known: Known) -> Array:
    """The values of some expressions, a row for each."""
    memo: dict[Expr, Array] = {}
    found = [evaluated(e, known, memo) for e in exprs]
    shape = np.broadcast_shapes(*(f.shape for f in found)) if found else ()
    return np.array([np.broadcast_to(f, shape) for f in found]).reshape(len(exprs), *shape)


def derivatives(exprs: Sequence[Expr], by: Sequence[Expr], known: Known) -> Array:
    """Their derivatives by some symbols: a row for each expression, by differences to both sides."""
    if not exprs or not by:
        return np.zeros((len(exprs), len(by)))
    shifts = STEP * np.hstack([np.eye(len(by)), -np.eye(len(by))])
    moved = {s: float(known.get(s, _DEFAULT.get(s.args[0], 0.0))) + shifts[k] for k, s in enumerate(by)}
    found = values_at(exprs, {**known, **moved})
    if found.ndim == 1:
        return np.zeros((len(exprs), len(by)))
    half = len(by)
    return np.nan_to_num((found[:, :half] - found[:, half:]) / (2 * STEP))


def with_unit_rows(rows: Array) -> Array:
    """Rows of length 1, but for those that are 0."""
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(size > SMALL, size, 1.0))


def kernel(rows: Array, columns: int, dimension: int | None = None) -> Array:
    """A basis of what all rows take to 0, as rows; of a ``dimension`` where that is known better than by size."""
    if not rows.size:
        return np.eye(columns)
    _, singular, right = np.linalg.svd(with_unit_rows(rows))
    found = int(np.sum(singular > SMALL)) if dimension is None else max(0, columns - dimension)
    return np.asarray(right[found:])


def by_pivots(basis: Array, order: Sequence[int]) -> tuple[Array, list[int]]:
    """The basis reduced so that each row alone moves one column, the first that can of an ``order``; and these."""
    rows = basis.copy()
    pivots: list[int] = []
    for column in order:
        k = len(pivots)
        if k == len(rows):
            break
        best = k + int(np.argmax(np.abs(rows[k:, column])))
        if abs(rows[best, column]) < 1e-4:
            continue
        rows[[k, best]] = rows[[best, k]]
        rows[k] /= rows[k, column]
        for other in range(len(rows)):
            if other != k:
                rows[other] -= rows[other, column] * rows[k]
        pivots.append(column)
    return rows, pivots
