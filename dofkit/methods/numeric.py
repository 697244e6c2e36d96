"""Floating point: ranks by singular values above a tolerance, at the reference or at points of Newton's method."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import islice
from typing import Any

import numpy as np

from dofkit.exact.points.balls import FloatPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import Scalar
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.methods.as_written import (
    Decider,
    Matrix,
    SampledPoints,
    Written,
    WrittenRows,
    as_written,
    drawn_value,
    questions_at_points,
    sampled_points,
)
from dofkit.methods.table import CONTRADICTORY, Reply
from dofkit.scene.scene import Scene
from dofkit.system import System

#: Starts of Newton's method, and the most points that are used.
STARTS, POINTS = 10, 5
#: Singular values and other numbers below this share of the largest count as 0.
TOLERANCE = 1e-9
_tolerance: ContextVar[float] = ContextVar("numeric_tolerance", default=TOLERANCE)
#: Shares of the largest singular value: above `SIGNAL` a value is clearly not 0, below `ROUNDING` it is rounding error.
SIGNAL, ROUNDING = 1e-6, 1e-13
NOWHERE = "Newton's method found no configuration from {} starts"


@contextmanager
def tolerance_of(share: float) -> Iterator[None]:
    """Use ``share`` instead of `TOLERANCE` within the block."""
    token = _tolerance.set(share)
    try:
        yield
    finally:
        _tolerance.reset(token)


class Floats:
    """The arithmetic of this method: floats, with 0 for values below the tolerance, a share of the largest."""

    zero = 0.0

    def rank(self, matrix: Matrix) -> int:
        if not matrix or not matrix[0]:
            return 0
        return self._rank(singular_values(matrix))

    def _rank(self, singular: np.ndarray) -> int:
        return int(np.sum(singular > _tolerance.get() * float(singular.max(initial=0.0))))

    def kernel(self, matrix: Matrix, columns: int) -> Matrix:
        """Return an orthonormal basis of the kernel of a matrix."""
        if not matrix:
            return [list(row) for row in np.eye(columns)]
        _, singular, right = np.linalg.svd(np.array(matrix, dtype=float), full_matrices=True)
        return [list(row) for row in right[self._rank(singular) :]]

    def vanishes(self, value: Scalar, scale: Sequence[Scalar]) -> bool:
        return bool(abs(value) <= _tolerance.get() * max(map(abs, scale), default=1.0))

    def points(self, written: Written, rows: WrittenRows, drawn: bool) -> list[FloatPoint]:
        if drawn:
            return [self._reference_point(written, rows)]
        ends = (self._newton_end(written, rows, k) for k in range(STARTS))
        return [*islice((point for point in ends if point is not None), POINTS)]

    def _reference_point(self, written: Written, rows: WrittenRows) -> FloatPoint:
        """Return the reference configuration at time 0, with fixed pseudo-random values of all other symbols."""
        rng = random.Random("dofkit floats 0")
        symbols: dict[Expr, float] = {v.key: rng.uniform(0.5, 2) for v in rows.ring.vars if v.kind == "symbol"}
        reference = written.system.reference or {}
        parameters = {s for value in reference.values() for s in value.symbols}
        symbols |= {s: rng.uniform(0.5, 2) for s in sorted(parameters, key=repr) if s not in symbols}
        symbols |= {s: float(drawn_value(value, FloatPoint(symbols))) for s, value in reference.items()}
        symbols[ex.TIME] = 0.0
        return FloatPoint(symbols)

    def _newton_end(self, written: Written, rows: WrittenRows, k: int) -> FloatPoint | None:
        """Return the point where Newton's method ends after the random start number ``k``, None if it fails."""
        unknowns = [*written.coordinates, *(ex.parameter(p) for p in written.system.generic)]
        nodes = [node for _, node in rows.finite]
        search = RealSearch(rows.ring, nodes, unknowns, written.positive)
        symbols = search.start(k, {})
        if search.descend(symbols, 0) is None:
            return None
        rng = random.Random(f"dofkit floats 0 {k}")
        symbols |= {s: rng.uniform(-2, 2) for s in rows.columns if s not in symbols}
        return FloatPoint(symbols)


def singular_values(matrix: Matrix) -> Any:
    """Return the singular values of a matrix, from the largest to the smallest."""
    return np.linalg.svd(np.array(matrix, dtype=float), compute_uv=False)


def _points_of(scene: Scene | System) -> tuple[SampledPoints, Decider] | Reply:
    """Return the rows at points with the arithmetic, or the reply of a contradiction if no point is found."""
    numbers = Floats()
    sampled = sampled_points(as_written(scene), numbers)
    return Reply(CONTRADICTORY, reason=NOWHERE.format(STARTS)) if sampled is None else (sampled, numbers)


def _is_clear(sampled: SampledPoints, numbers: Decider) -> bool:
    """Return whether the rank is clear: residuals vanish, and no singular value is between `ROUNDING` and `SIGNAL`.

    It is never clear with a tolerance for the geometry, or with a sign that rounding may change.
    """
    written, sample = sampled.rows.written, sampled.samples[0]
    if written.system.tolerance is not None or any(v.kind == "sign" for v in sampled.rows.ring.vars):
        return False
    if any(not numbers.vanishes(r, [*row, 1.0]) for r, row in zip(sample.residuals, sample.finite, strict=True)):
        return False
    matrix = [row[: sampled.rows.n] for row in sample.rows]
    if not matrix or not matrix[0]:
        return True
    singular = singular_values(matrix)
    largest = float(singular[0]) or 1.0
    return all(v / largest > SIGNAL or v / largest < ROUNDING for v in map(float, singular))


dof, integrability, redundancy = questions_at_points(
    _points_of, lambda sampled, numbers: "numeric" if _is_clear(sampled, numbers) else "undecided"
)
