"""Ranks over GF(p), and random points of the ambient space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import nmod_mat

from dofkit.deadline import affordable
from dofkit.exact.field import FieldPoint, NoPointError, field_point
from dofkit.exact.program import values
from dofkit.exact.sparse import SparseRow
from dofkit.local_chart import Chart


def rank_of(matrix: list[list[Any]], p: int) -> int:
    """Rank over GF(p)."""
    if not matrix or not matrix[0]:
        return 0
    affordable(len(matrix), len(matrix[0]))
    return int(nmod_mat([[int(v) for v in row] for row in matrix], p).rank())


def without_time(rows: Sequence[SparseRow], n: int) -> list[SparseRow]:
    """The first n columns."""
    return [{c: v for c, v in row.items() if c < n} for row in rows]


def free_point(chart: Chart, seed: int) -> FieldPoint | None:
    """A random point of the ambient space at which the program runs."""
    for attempt in range(60):
        point = field_point([chart.ring], 1000 * seed + attempt)
        try:
            values(chart.ring, point)
        except (ZeroDivisionError, NoPointError):
            continue
        return point
    return None
