"""Ranks in floating point: where a search begins, and of measured numbers; nothing else rests on them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.base.libraries import np

#: Relative size below which a singular value of a matrix with scaled rows is taken for 0, and above which it is not.
NOISE, SIGNAL = 1e-9, 1e-6


def independent_part(j: np.ndarray) -> tuple[int, float, list[int], list[int]]:
    """Return (rank, gap, rows, columns) of a matrix with its rows scaled; rows are taken greedily in their order.

    Raises NoValueError where an entry is not finite, as at a pole.
    """
    if not j.size:
        return 0, math.inf, [], []
    if not np.isfinite(j).all():
        raise NoValueError("an entry of the matrix is not finite")
    norms = np.linalg.norm(j, axis=1)
    scaled = j / np.where(norms > 0, norms, 1.0)[:, None]
    singular = np.linalg.svd(scaled, compute_uv=False)
    rank = int(np.sum(singular > math.sqrt(NOISE * SIGNAL)))
    below = float(singular[rank]) if rank < len(singular) else 0.0
    gap = math.inf if below == 0 or rank == 0 else float(singular[rank - 1]) / below
    rows = greedy_rows(scaled, rank)
    columns = greedy_pivots(scaled[rows].T, len(rows)) if rows else []
    return len(rows), gap, rows, columns


def greedy_rows(matrix: np.ndarray, rank: int) -> list[int]:
    """The first rows, in order, each independent of those before it."""
    kept: list[int] = []
    basis = np.zeros((0, matrix.shape[1]))
    for i, row in enumerate(matrix):
        rest = row - basis.T @ (basis @ row)
        rest = rest - basis.T @ (basis @ rest)
        size = float(np.linalg.norm(rest))
        if size > math.sqrt(NOISE * SIGNAL):
            basis = np.vstack([basis, rest / size])
            kept.append(i)
        if len(kept) == rank:
            break
    return kept


def dependency_pattern(j: np.ndarray, rows: Sequence[int]) -> list[list[int]]:
    """Which rows depend on which of the independent ``rows``, as a matrix over GF(2)."""
    place = {r: i for i, r in enumerate(rows)}
    pattern = []
    for r in range(len(j)):
        entry = [0] * max(len(rows), 1)
        if r in place:
            entry[place[r]] = 1
        elif rows:
            check()
            weights = np.linalg.lstsq(j[list(rows)].T, j[r], rcond=None)[0]
            entry = [int(abs(w) > 1e-3 * max(1e-300, float(np.max(np.abs(weights))))) for w in weights]
        pattern.append(entry)
    return pattern


def greedy_pivots(matrix: np.ndarray, rank: int) -> list[int]:
    """Rows chosen for the largest remainder: well conditioned, in no order."""
    kept: list[int] = []
    rest = matrix.copy()
    for _ in range(rank):
        sizes = np.linalg.norm(rest, axis=1)
        best = int(np.argmax(sizes))
        kept.append(best)
        direction = rest[best] / sizes[best]
        rest = rest - np.outer(rest @ direction, direction)
    return sorted(kept)
