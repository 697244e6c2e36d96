"""Independent rows and columns of matrices of balls (certified) and of floats (estimated).

A pivot whose ball excludes 0 proves that the rank is at least so large. Ranks in floating point are used only to begin
a search, and in scenes with a tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_mat

from dofkit.base.deadline import check
from dofkit.base.libraries import np
from dofkit.exact.matrices.dense import GRAM_SCHMIDT_PASSES, Matrix, dot, length, pivoted, plus, unit_rows

#: With scaled rows, pivots below `NOISE` are rounding errors, above `SIGNAL` not; up to `FAINT` they count as 0.
NOISE, SIGNAL = 1e-9, 1e-6
FAINT = math.sqrt(NOISE * SIGNAL)


def independent_part(j: Matrix) -> tuple[int, float, list[int], list[int]]:
    """Return (rank, gap, rows, columns): the numerical rank, and independent rows and columns, of a matrix of floats.

    The rows are scaled to length 1. ``gap`` is the ratio of the last pivot that counts to the next one, infinite if
    there is none; ``rows`` are the first independent ones. Raises NoValueError if an entry is not finite (a pole).
    """
    scaled = unit_rows(j)
    sizes = pivoted(scaled).sizes
    rank = sum(size > FAINT for size in sizes)
    gap = sizes[rank - 1] / sizes[rank] if 0 < rank < len(sizes) else math.inf
    rows = greedy_rows(scaled, rank)
    return len(rows), gap, rows, greedy_pivots(list(zip(*(scaled[r] for r in rows), strict=True)), len(rows))


def greedy_rows(matrix: Matrix, rank: int) -> list[int]:
    """Return the numbers of the first ``rank`` rows that are independent of the rows before them."""
    kept: list[int] = []
    basis: list[list[float]] = []
    for i, row in enumerate(matrix):
        if len(kept) == rank:
            break
        residual = list(row)
        for _ in range(GRAM_SCHMIDT_PASSES):
            for direction in basis:
                residual = plus(residual, -dot(residual, direction), direction)
        size = length(residual)
        if size > FAINT:
            basis.append([v / size for v in residual])
            kept.append(i)
    return kept


def dependency_pattern(j: np.ndarray, rows: Sequence[int]) -> list[list[int]]:
    """Return the 0-1 matrix with (i, k) = 1 if row i of ``j``, as a sum of the independent ``rows``, needs the k-th."""
    check()
    if not rows:
        return [[0] for _ in j]
    weights = np.abs(np.linalg.lstsq(j[list(rows)].T, j.T, rcond=None)[0].T)
    least = 1e-3 * np.maximum(1e-300, weights.max(axis=1, keepdims=True))
    return [list(map(int, row)) for row in weights > least]


def greedy_pivots(matrix: Matrix, rank: int) -> list[int]:
    """Return the numbers, in order, of ``rank`` well conditioned rows: each has the largest remainder (pivoting)."""
    return sorted(pivoted(matrix, most=rank).order)


Balls = Sequence[Sequence[arb]]


class PivotedPart(NamedTuple):
    """A nonsingular submatrix: its ``rank``, its ``rows`` (the first that are independent) and its ``columns``.

    ``gap``: ratio of the smallest pivot to the largest residual, each relative to its row; ``fall``: the largest
    ratio of a pivot to the next smaller one. Only a gap much larger than ``fall`` shows that no pivot was missed.
    """

    rank: int
    gap: float
    rows: list[int]
    columns: list[int]
    fall: float = 1.0


def ball_part(matrix: Balls) -> PivotedPart:
    """Return a certified nonsingular submatrix; after elimination the balls of all remaining entries contain 0."""
    kept: list[tuple[list[arb], int]] = []
    rows: list[int] = []
    sizes: list[float] = []
    largest_residual = 0.0
    for r, row in enumerate(matrix):
        residual = _reduced(row, kept)
        c = _pivot(residual)
        if c < 0:
            largest_residual = max(largest_residual, _relative_size(_largest(residual), row))
        else:
            kept.append((residual, c))
            rows.append(r)
            sizes.append(_relative_size(residual[c].abs_lower(), row))
    return PivotedPart(len(rows), _pivot_gap(sizes, largest_residual), rows, [c for _, c in kept], _largest_fall(sizes))


def _reduced(row: Sequence[arb], kept: Sequence[tuple[list[arb], int]]) -> list[arb]:
    residual = list(row)
    for pivot_row, c in kept:
        if residual[c] != 0:
            factor = residual[c] / pivot_row[c]
            residual = [a - factor * b for a, b in zip(residual, pivot_row, strict=True)]
            residual[c] = arb(0)
    return residual


def _pivot(row: Sequence[arb]) -> int:
    """Return the column of the largest entry that is certainly not 0; -1 if all balls contain 0."""
    best, size = -1, arb(0)
    for c, v in enumerate(row):
        if not v.contains(0) and (low := v.abs_lower()) > size:
            best, size = c, low
    return best


def _largest(row: Sequence[arb]) -> arb:
    return max((v.abs_upper() for v in row), default=arb(0))


def _relative_size(size: arb, row: Sequence[arb]) -> float:
    """Return a size divided by the row's largest entry; as balls, because both may be too large for floats."""
    largest = max((v.abs_lower() for v in row), default=arb(0))
    return float(size if largest == 0 else size / largest)


def _pivot_gap(sizes: Sequence[float], largest_residual: float) -> float:
    return min(sizes) / largest_residual if sizes and largest_residual else math.inf


def _largest_fall(sizes: Sequence[float]) -> float:
    """Return the largest ratio of a pivot's size to the next smaller one."""
    ordered = sorted(sizes)
    return max((b / a if a else math.inf for a, b in pairwise(ordered)), default=1.0)


def dependencies(matrix: Balls, part: PivotedPart) -> list[list[int]]:
    """Return a 0-1 matrix: entry (r, k) is 1 if row r, as a sum of ``part.rows``, may need the k-th of them."""
    pattern = [[int(r == k) for k in part.rows] or [0] for r in range(len(matrix))]
    others = [r for r, entry in enumerate(pattern) if not any(entry)]
    with suppress(ZeroDivisionError):  # the balls of the submatrix may be too wide to solve it
        square = arb_mat([[matrix[r][c] for r in part.rows] for c in part.columns])
        right = arb_mat(part.rank, len(others), [matrix[r][c] for c in part.columns for r in others])
        for r, weights in zip(others, square.solve(right).transpose().tolist() if others else (), strict=True):
            pattern[r] = [int(not w.contains(0)) for w in weights] or [0]
    return pattern
