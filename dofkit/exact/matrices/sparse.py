"""Elimination over GF(p): ranks, and of sparse matrices the first independent rows, dependences and pivot columns.

Rows are reduced in order by those before them; a pivot is the entry whose column occurs in the fewest rows, so that
a chain or a tree causes no fill-in and a grid little more than its width.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import Any

from dofkit.base.deadline import affordable, check
from dofkit.base.errors import PoleError
from dofkit.exact.residues import residue_matrix

Numbers = Sequence[Any]
LinearRow = dict[int, Any]


def combined(terms: Iterable[tuple[Any, Mapping[int, Any]]]) -> LinearRow:
    """Return the sum of factor * row over (factor, row) ``terms``."""
    total: LinearRow = {}
    for factor, row in terms:
        for c, v in row.items():
            total[c] = total.get(c, 0) + factor * v
    return total


def along(direction: Numbers, rows: Sequence[LinearRow]) -> LinearRow:
    """Return the row sum_i direction[i] rows[i]: the component of a vector of rows along a direction."""
    return combined(zip(direction, rows, strict=True))


def across(direction: Numbers, rows: Sequence[LinearRow]) -> Iterator[LinearRow]:
    """Yield the d - 1 components of a vector of d rows perpendicular to a direction."""
    return (along(u, rows) for u in perpendicular(direction))


def less(second: Sequence[LinearRow], first: Sequence[LinearRow]) -> list[LinearRow]:
    """Return second - first, row by row."""
    return [combined(((1, b), (-1, a))) for a, b in zip(first, second, strict=True)]


def perpendicular(n: Numbers) -> list[tuple[Any, ...]]:
    """Return d - 1 vectors that span the space perpendicular to a nonzero vector n of d numbers."""
    if len(n) == 2:
        return [(-n[1], n[0])]
    pivot = next(i for i in reversed(range(len(n))) if n[i] != 0)
    directions = []
    for i in range(len(n)):
        if i != pivot:
            direction = [0] * len(n)
            direction[i], direction[pivot] = n[pivot], -n[i]
            directions.append(tuple(direction))
    return directions


def cross(a: Numbers, b: Numbers) -> tuple[Any, ...]:
    """Return the vector product a x b in space."""
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))


SparseRow = dict[int, int]
#: A function that computes, for every row that depends on rows before it, a minimal set of those.
Supports = Callable[[], Mapping[int, Sequence[int]]]

#: The deadline is checked once in so many rows.
LOOK = 64


def sparse(rows: Iterable[Sequence[Any]]) -> list[SparseRow]:
    """Return dense rows as sparse ones, {column: integer}, without the zeros."""
    return [{c: int(v) for c, v in enumerate(row) if v != 0} for row in rows]


def transposed(rows: Sequence[Mapping[int, int]], columns: int) -> list[SparseRow]:
    """Return the columns as rows."""
    columns_as_rows: list[SparseRow] = [{} for _ in range(columns)]
    for i, row in enumerate(rows):
        for c, v in row.items():
            columns_as_rows[c][i] = v
    return columns_as_rows


@dataclass(frozen=True)
class Echelon:
    """``independent``: the rows that are independent of those before them.

    ``supports``: for every other row the independent rows of which it is a sum; empty if not requested.
    """

    independent: tuple[int, ...]
    supports: dict[int, tuple[int, ...]]

    @property
    def rank(self) -> int:
        return len(self.independent)


def echelon(rows: Sequence[Mapping[int, int]], p: int, supports: bool = False) -> Echelon:
    """Return the independent rows over GF(p), taken greedily in order, and with ``supports`` the dependences."""
    reduction = Reduction(rows, p, peelable_rows(rows))
    sums = reduction.dependent
    independent = tuple([i for i in range(len(rows)) if i not in sums])
    return Echelon(independent, {i: tuple(sorted(reduction.support(sums[i]))) for i in sums} if supports else {})


def vanishing(rows: Sequence[Mapping[int, int]], p: int) -> list[SparseRow]:
    """Return a basis of the linear dependences of the rows, as {row: factor} with sum of factor * row = 0.

    There is one for every row that depends on rows before it, with the factor 1 for this row.

    >>> vanishing([{0: 1}, {0: 1, 1: 1}, {1: 2}], 7)
    [{2: 1, 1: 5, 0: 2}]
    """
    reduction = Reduction(rows, p, peelable_rows(rows))
    return [{i: 1} | {k: -v % p for k, v in reduction.support(used).items()} for i, used in reduction.dependent.items()]


def vector_in_kernel(rows: Sequence[Mapping[int, int]], p: int, rng: random.Random) -> SparseRow:
    """Return a random vector of the kernel of the rows over GF(p), with a value for each column that occurs."""
    columns = dict.fromkeys(c for row in rows for c in row)
    return Reduction(rows, p).completed({c: rng.randrange(p) for c in columns})


def rank_of_rows(rows: Sequence[Mapping[int, int]], p: int) -> int:
    """Return the rank over GF(p)."""
    return echelon(rows, p).rank


def last_columns(rows: Sequence[Mapping[int, int]], columns: int, p: int) -> tuple[int, ...]:
    """Return the columns to solve the rows for: a basis of the column space, later columns preferred."""
    turned = transposed(rows, columns)[::-1]
    return tuple(sorted(columns - 1 - k for k in echelon(turned, p).independent))


def peelable_rows(rows: Sequence[Mapping[int, int]]) -> set[int]:
    """Return the rows that can be removed one after another, each having a column that occurs in no remaining row.

    They are independent of the other rows. In a tree all rows are removed; what remains has every column twice or more.
    """
    having: dict[int, set[int]] = {}
    for i, row in enumerate(rows):
        for c in row:
            having.setdefault(c, set()).add(i)
    single = [c for c, owners in having.items() if len(owners) == 1]
    gone: set[int] = set()
    while single:
        owners_left = having[single.pop()]
        if not owners_left:
            continue
        number = next(iter(owners_left))
        gone.add(number)
        for c in rows[number]:
            having[c].discard(number)
            if len(having[c]) == 1:
                single.append(c)
    return gone


class Reduction:
    """Gaussian elimination over GF(p) of all rows except those in ``without``.

    A pivot row has a 1 in its pivot column and zeros in the pivot columns before it. ``dependent``: for every row that
    depends on rows before it, {pivot row: factor} whose sum it is.
    """

    def __init__(self, rows: Sequence[Mapping[int, int]], p: int, without: Set[int] = frozenset()) -> None:
        self.p, self._weight = p, Counter(c for row in rows for c in row)
        self._rows: list[list[tuple[int, int]]] = []
        self._sources: list[tuple[int, int, SparseRow]] = []
        self._of: dict[int, int] = {}
        self.dependent: dict[int, SparseRow] = {}
        for i, row in enumerate(rows):
            if i % LOOK == 0:
                check()
            if i in without:
                continue
            residual, used = self._reduced(row)
            if residual:
                self._add(i, residual, used)
            else:
                self.dependent[i] = used

    def _reduced(self, row: Mapping[int, int]) -> tuple[SparseRow, SparseRow]:
        """Return the remainder of a row, and {pivot row: factor} of what was subtracted from it."""
        p, of, work, used = self.p, self._of, dict(row), SparseRow()
        pending = [of[c] for c in work if c in of]
        heapify(pending)
        while pending:
            number = heappop(pending)
            pivot = self._rows[number]
            factor = work.get(pivot[0][0])
            if not factor:
                continue
            used[number] = factor
            for c, v in pivot:
                old = work.get(c)
                if old is None:
                    work[c] = -factor * v % p
                    if c in of:
                        heappush(pending, of[c])
                else:
                    new = (old - factor * v) % p
                    if new:
                        work[c] = new
                    else:
                        del work[c]
        return work, used

    def _add(self, row: int, residual: SparseRow, used: SparseRow) -> None:
        """Add a pivot row: ``residual``, which is ``row`` minus the multiples ``used`` of earlier ones, is scaled."""
        column = min(residual, key=lambda c: (self._weight[c], c))
        inverse = pow(residual[column], -1, self.p)
        self._of[column] = len(self._rows)
        self._rows.append([(column, 1), *((c, v * inverse % self.p) for c, v in residual.items() if c != column)])
        self._sources.append((row, inverse, used))

    def solved(self, right: Sequence[int]) -> list[int]:
        """Return the solution of a regular square system with this right side, one number for each row."""
        p, reduced = self.p, list[int]()
        for row, inverse, used in self._sources:
            taken = sum(factor * reduced[k] for k, factor in used.items())
            reduced.append((right[row] - taken) * inverse % p)
        solution = [0] * len(reduced)
        for number in reversed(range(len(reduced))):
            (column, _), *others = self._rows[number]
            solution[column] = (reduced[number] - sum(v * solution[c] for c, v in others)) % p
        return solution

    def completed(self, values: Mapping[int, int]) -> SparseRow:
        """Return the kernel vector with the given ``values`` in the columns that are no pivots."""
        vector = dict(values)
        for (column, _), *others in reversed(self._rows):
            vector[column] = -sum(v * vector[c] for c, v in others) % self.p
        return vector

    def support(self, used: Mapping[int, int]) -> SparseRow:
        """Return {row: factor} of the original rows for a combination {pivot row: factor}."""
        multiples, factors = dict(used), SparseRow()
        pending = [-k for k in multiples]
        heapify(pending)
        while pending:
            number = -heappop(pending)
            row, inverse, earlier = self._sources[number]
            factor = multiples.pop(number) * inverse % self.p
            if not factor:
                continue
            factors[row] = factor
            for k, v in earlier.items():
                if k not in multiples:
                    multiples[k] = 0
                    heappush(pending, -k)
                multiples[k] = (multiples[k] - factor * v) % self.p
        return factors


def factored(rows: Sequence[Mapping[int, int]], p: int) -> Reduction:
    """Return the elimination of a square matrix, for its method ``solved``; raises PoleError if it is singular."""
    reduction = Reduction(rows, p)
    if reduction.dependent:
        raise PoleError("the matrix is singular")
    return reduction


def rank_of(matrix: Sequence[Sequence[Any]], p: int) -> int:
    """Return the rank over GF(p) of a dense matrix."""
    if not matrix or not matrix[0]:
        return 0
    affordable(len(matrix), len(matrix[0]))
    return int(residue_matrix([[int(v) for v in row] for row in matrix], p).rank())


def without_time(rows: Sequence[SparseRow], n: int) -> list[SparseRow]:
    """Return the rows without the column of time, which comes after the n columns of coordinates."""
    return [{c: v for c, v in row.items() if c < n} for row in rows]


@dataclass(frozen=True)
class Pivots:
    """Independent ``rows``, the ``dependent`` columns for which they can be solved, the other columns (``free``)."""

    rows: tuple[int, ...]
    dependent: tuple[int, ...]
    free: tuple[int, ...]


def sparse_frame(rows: Sequence[SparseRow], n: int, p: int) -> Pivots:
    """Return the first independent rows, and the columns to solve them for, later columns preferred."""
    kept = echelon(rows, p).independent
    dependent = last_columns([rows[i] for i in kept], n, p)
    solved = set(dependent)
    return Pivots(kept, dependent, tuple(c for c in range(n) if c not in solved))


def components(names_of: Iterable[Iterable[Hashable]]) -> list[list[int]]:
    """Return the connected components, as lists of indices, of items of which two are joined if they share a name.

    >>> components([("x", "y"), ("z",), ("y", "u"), ()])
    [[0, 2], [1], [3]]
    """
    leader: list[int] = []
    owner: dict[Hashable, int] = {}

    def root_of(i: int) -> int:
        while leader[i] != i:
            leader[i] = i = leader[leader[i]]
        return i

    for i, names in enumerate(names_of):
        leader.append(i)
        root = i
        for name in names:
            first_owner = owner.setdefault(name, root)
            if first_owner != root:
                first_owner = root_of(first_owner)
                root, first_owner = (root, first_owner) if root < first_owner else (first_owner, root)
                leader[first_owner] = root
    groups: dict[int, list[int]] = {}
    for i in range(len(leader)):
        groups.setdefault(root_of(i), []).append(i)
    return list(groups.values())
