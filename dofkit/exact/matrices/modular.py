"""Ranks over GF(p)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import nmod_mat

from dofkit.base.deadline import affordable
from dofkit.exact.matrices.sparse import SparseRow


def rank_of(matrix: list[list[Any]], p: int) -> int:
    """Rank over GF(p)."""
    if not matrix or not matrix[0]:
        return 0
    affordable(len(matrix), len(matrix[0]))
    return int(nmod_mat([[int(v) for v in row] for row in matrix], p).rank())


def without_time(rows: Sequence[SparseRow], n: int) -> list[SparseRow]:
    """The first n columns."""
    return [{c: v for c, v in row.items() if c < n} for row in rows]
