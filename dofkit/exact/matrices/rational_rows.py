"""Sparse rows of rational numbers: which are sums of those before them, and of which, exactly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import Any

from flint import fmpq

from dofkit.base.deadline import check
from dofkit.exact.matrices.sparse import LOOK, private

RationalRow = dict[int, Any]

#: Entries that are changed before it is given up: numbers grow where rows fill in.
MAX_WORK = 2_000_000


def dependences(rows: Sequence[Mapping[int, Any]]) -> dict[int, RationalRow] | None:
    """For every row that is a sum of rows before it their factors, row_i = sum f_k row_k; None where it is too much.

    >>> dependences([{0: fmpq(1)}, {0: fmpq(1), 1: fmpq(2)}, {1: fmpq(1)}])
    {2: {1: 1/2, 0: -1/2}}
    """
    alone = private(rows)
    reduction = _RationalReduction(Counter(c for row in rows for c in row))
    found: dict[int, RationalRow] = {}
    for i, row in enumerate(rows):
        if i % LOOK == 0:
            check()
        if i in alone:
            continue
        rest, used = reduction.reduced(row)
        if reduction.work > MAX_WORK:
            return None
        if rest:
            reduction.add(i, rest, used)
        else:
            found[i] = reduction.unfolded(used)
    return found


class _RationalReduction:
    """Pivot rows with a 1 in their pivot column, each free of the pivots before it."""

    def __init__(self, weight: Mapping[int, int]) -> None:
        self._weight = weight
        self._rows: list[tuple[int, RationalRow]] = []
        self._sources: list[tuple[int, fmpq, RationalRow]] = []
        self._of: dict[int, int] = {}
        self.work = 0

    def reduced(self, row: Mapping[int, Any]) -> tuple[RationalRow, RationalRow]:
        """What is left of a row, and the multiples of pivot rows that were taken from it."""
        work, used = dict(row), RationalRow()
        pending = [self._of[c] for c in work if c in self._of]
        heapify(pending)
        while pending and self.work <= MAX_WORK:
            number = heappop(pending)
            column, pivot = self._rows[number]
            factor = work.get(column)
            if factor is None:
                continue
            used[number] = factor
            self.work += len(pivot)
            for c, v in pivot.items():
                old = work.get(c)
                new = -factor * v if old is None else old - factor * v
                if new == 0:
                    del work[c]
                else:
                    work[c] = new
                    if old is None and c in self._of:
                        heappush(pending, self._of[c])
        return work, used

    def add(self, row: int, rest: RationalRow, used: RationalRow) -> None:
        """A new pivot row: ``rest`` is the row less ``used`` multiples of earlier ones, then scaled."""
        column = min(rest, key=lambda c: (self._weight[c], c))
        inverse = 1 / rest[column]
        self._of[column] = len(self._rows)
        self._rows.append((column, {c: v * inverse for c, v in rest.items()}))
        self._sources.append((row, inverse, used))

    def unfolded(self, used: Mapping[int, Any]) -> RationalRow:
        """A sum of pivot rows as one of rows, row -> factor: each is its row less earlier ones, unfolded backwards."""
        left, found = dict(used), RationalRow()
        pending = [-k for k in left]
        heapify(pending)
        while pending:
            number = -heappop(pending)
            row, inverse, earlier = self._sources[number]
            factor = left.pop(number) * inverse
            if factor == 0:
                continue
            found[row] = factor
            self.work += len(earlier)
            for k, v in earlier.items():
                if k not in left:
                    left[k] = fmpq(0)
                    heappush(pending, -k)
                left[k] -= factor * v
        return found
