"""What is independent in a matrix of balls or of measured numbers.

A pivot whose ball excludes 0 is a proof, and what is left holds 0. Ranks in floating point say where a search begins,
and those of measured numbers; nothing else rests on them.
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
from dofkit.exact.matrices.dense import PASSES, Matrix, dot, length, pivoted, plus, unit_rows

#: Relative size below which a singular value of a matrix with scaled rows is taken for 0, and above which it is not.
NOISE, SIGNAL = 1e-9, 1e-6
FAINT = math.sqrt(NOISE * SIGNAL)


def independent_part(j: Matrix) -> tuple[int, float, list[int], list[int]]:
    """Return (rank, gap, rows, columns) of a matrix with its rows scaled; rows are taken greedily in their order.

    Raises NoValueError where an entry is not finite, as at a pole.
    """
    scaled = unit_rows(j)
    sizes = pivoted(scaled).sizes
    rank = sum(size > FAINT for size in sizes)
    gap = sizes[rank - 1] / sizes[rank] if 0 < rank < len(sizes) else math.inf
    rows = greedy_rows(scaled, rank)
    return len(rows), gap, rows, greedy_pivots(list(zip(*(scaled[r] for r in rows), strict=True)), len(rows))


def greedy_rows(matrix: Matrix, rank: int) -> list[int]:
    """Return the first rows, in order, each independent of those before it."""
    kept: list[int] = []
    basis: list[list[float]] = []
    for i, row in enumerate(matrix):
        if len(kept) == rank:
            break
        residual = list(row)
        for _ in range(PASSES):
            for direction in basis:
                residual = plus(residual, -dot(residual, direction), direction)
        size = length(residual)
        if size > FAINT:
            basis.append([v / size for v in residual])
            kept.append(i)
    return kept


def dependency_pattern(j: np.ndarray, rows: Sequence[int]) -> list[list[int]]:
    """Return which rows depend on which of the independent ``rows``, as a matrix over GF(2)."""
    check()
    if not rows:
        return [[0] for _ in j]
    weights = np.abs(np.linalg.lstsq(j[list(rows)].T, j.T, rcond=None)[0].T)
    least = 1e-3 * np.maximum(1e-300, weights.max(axis=1, keepdims=True))
    return [list(map(int, row)) for row in weights > least]


def greedy_pivots(matrix: Matrix, rank: int) -> list[int]:
    """Return rows chosen for the largest remainder, which are well conditioned, by their numbers."""
    return sorted(pivoted(matrix, most=rank).order)


Balls = Sequence[Sequence[arb]]


class PivotedPart(NamedTuple):
    """``rows`` (the first that are independent) and ``columns`` of a regular part.

    ``gap``: the smallest pivot by the largest number that is left, each as a fraction of its row; ``fall``: the
    largest ratio of a pivot to the next smaller one. Where pivots fall from one to the next, only a gap that is wider
    by far tells that no further one was lost.
    """

    rank: int
    gap: float
    rows: list[int]
    columns: list[int]
    fall: float = 1.0


def ball_part(matrix: Balls) -> PivotedPart:
    """Return a part of the matrix that is certified regular, such that the rest holds 0 after elimination."""
    kept: list[tuple[list[arb], int]] = []
    rows: list[int] = []
    sizes: list[float] = []
    largest_residual = 0.0
    for r, row in enumerate(matrix):
        residual = _reduced(row, kept)
        c = _pivot(residual)
        if c < 0:
            largest_residual = max(largest_residual, _share(_largest(residual), row))
        else:
            kept.append((residual, c))
            rows.append(r)
            sizes.append(_share(residual[c].abs_lower(), row))
    return PivotedPart(len(rows), _ratio(sizes, largest_residual), rows, [c for _, c in kept], _fall(sizes))


def _reduced(row: Sequence[arb], kept: Sequence[tuple[list[arb], int]]) -> list[arb]:
    residual = list(row)
    for pivot_row, c in kept:
        if residual[c] != 0:
            factor = residual[c] / pivot_row[c]
            residual = [a - factor * b for a, b in zip(residual, pivot_row, strict=True)]
            residual[c] = arb(0)
    return residual


def _pivot(row: Sequence[arb]) -> int:
    """Return the column of the largest entry that is certainly not 0; -1 where all hold 0."""
    best, size = -1, arb(0)
    for c, v in enumerate(row):
        if not v.contains(0) and (low := v.abs_lower()) > size:
            best, size = c, low
    return best


def _scale(row: Sequence[arb]) -> arb:
    """Return the size of a row's largest entry; 1 for a row of zeros."""
    largest = max((v.abs_lower() for v in row), default=arb(0))
    return arb(1) if largest == 0 else largest


def _largest(row: Sequence[arb]) -> arb:
    return max((v.abs_upper() for v in row), default=arb(0))


def _share(size: arb, row: Sequence[arb]) -> float:
    """Return a number as a fraction of a row's largest entry, which floating point may be too small for."""
    return float(size / _scale(row))


def _ratio(sizes: Sequence[float], largest_residual: float) -> float:
    return min(sizes) / largest_residual if sizes and largest_residual else math.inf


def _fall(sizes: Sequence[float]) -> float:
    """Return the largest ratio of neighbours, in order of size."""
    ordered = sorted(sizes)
    return max((b / a if a else math.inf for a, b in pairwise(ordered)), default=1.0)


def dependencies(matrix: Balls, part: PivotedPart) -> list[list[int]]:
    """Return which rows depend on which of the independent ones, as a matrix over GF(2)."""
    pattern = [[int(r == k) for k in part.rows] or [0] for r in range(len(matrix))]
    others = [r for r, entry in enumerate(pattern) if not any(entry)]
    with suppress(ZeroDivisionError):  # where that part is not certified regular
        square = arb_mat([[matrix[r][c] for r in part.rows] for c in part.columns])
        right = arb_mat(part.rank, len(others), [matrix[r][c] for c in part.columns for r in others])
        for r, weights in zip(others, square.solve(right).transpose().tolist() if others else (), strict=True):
            pattern[r] = [int(not w.contains(0)) for w in weights] or [0]
    return pattern
