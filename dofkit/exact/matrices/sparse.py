"""Ranks over GF(p); of sparse matrices also independent rows in order, dependences, and columns to solve for.

Rows are taken one after another and reduced by those before them; a pivot is the entry whose column occurs in the
fewest rows, so a chain or a tree fills in nothing and a grid little more than its width.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import Any

from flint import fmpq

from dofkit.base.deadline import affordable, check
from dofkit.base.errors import PoleError
from dofkit.exact.residues import residue_matrix

Numbers = Sequence[Any]
LinearRow = dict[int, Any]


def combined(terms: Iterable[tuple[Any, Mapping[int, Any]]]) -> LinearRow:
    """Return the sum of numbers times rows."""
    total: LinearRow = {}
    for factor, row in terms:
        for c, v in row.items():
            total[c] = total.get(c, 0) + factor * v
    return total


def along(direction: Numbers, rows: Sequence[LinearRow]) -> LinearRow:
    """Return the component along a direction of a vector of rows."""
    return combined(zip(direction, rows, strict=True))


def across(direction: Numbers, rows: Sequence[LinearRow]) -> Iterator[LinearRow]:
    """Return the d - 1 components across a direction of a vector of rows."""
    return (along(u, rows) for u in perpendicular(direction))


def less(second: Sequence[LinearRow], first: Sequence[LinearRow]) -> list[LinearRow]:
    """second - first."""
    return [combined(((1, b), (-1, a))) for a, b in zip(first, second, strict=True)]


def perpendicular(n: Numbers) -> list[tuple[Any, ...]]:
    """Return d - 1 vectors that span what is perpendicular to a vector n, not 0, of d numbers."""
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
    """a x b in space."""
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))


SparseRow = dict[int, int]
#: For every row that depends on rows before it a minimal set of those; given where it is asked for.
Supports = Callable[[], Mapping[int, Sequence[int]]]

RationalRow = dict[int, fmpq]
#: Primes modulo which dependences of rational rows are found; factors have up to half their bits.
RECONSTRUCTION_PRIMES = (2**127 - 1, 2**521 - 1, 2**2203 - 1)
#: Rows between two looks at the clock.
LOOK = 64


def sparse(rows: Iterable[Sequence[Any]]) -> list[SparseRow]:
    """Dense rows without their zeros."""
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
    """``independent``: the first independent rows in order; ``supports``: for every other row those it is a sum of.

    ``supports`` is empty where it was not asked for.
    """

    independent: tuple[int, ...]
    supports: dict[int, tuple[int, ...]]

    @property
    def rank(self) -> int:
        return len(self.independent)


def echelon(rows: Sequence[Mapping[int, int]], p: int, supports: bool = False) -> Echelon:
    """Return the greedy basis of the rows over GF(p)."""
    reduction = Reduction(rows, p, peelable_rows(rows))
    sums = reduction.dependent
    independent = tuple([i for i in range(len(rows)) if i not in sums])
    return Echelon(independent, {i: tuple(sorted(reduction.support(sums[i]))) for i in sums} if supports else {})


def vanishing(rows: Sequence[Mapping[int, int]], p: int) -> list[SparseRow]:
    """A basis of the sums of rows that are 0, row -> factor each: for every dependent row it and those before it.

    >>> vanishing([{0: 1}, {0: 1, 1: 1}, {1: 2}], 7)
    [{2: 1, 1: 5, 0: 2}]
    """
    reduction = Reduction(rows, p, peelable_rows(rows))
    return [{i: 1} | {k: -v % p for k, v in reduction.support(used).items()} for i, used in reduction.dependent.items()]


def dependences(rows: Sequence[Mapping[int, fmpq]]) -> dict[int, RationalRow] | None:
    """Return for every rational row that is a sum of rows before it their factors, row_i = sum f_k row_k.

    What is independent modulo a prime is so over the rationals; dependences are reconstructed from their residues and
    checked. None where that succeeds for no prime.

    >>> dependences([{0: fmpq(1)}, {0: fmpq(1), 1: fmpq(2)}, {1: fmpq(1)}])
    {2: {0: -1/2, 1: 1/2}}
    """
    for p in RECONSTRUCTION_PRIMES:
        try:
            residues = [{c: int(v.p) * pow(int(v.q), -1, p) % p for c, v in row.items()} for row in rows]
        except ValueError:  # the prime divides a denominator
            continue
        sums = vanishing([{c: v for c, v in row.items() if v} for row in residues], p)
        factors = {max(s): {k: reconstructed(-v, p) for k, v in sorted(s.items()) if k != max(s)} for s in sums}
        if all(_is_sum(rows, i, row) for i, row in factors.items()):
            return factors
    return None


def reconstructed(residue: int, p: int) -> fmpq:
    """Return the fraction a/b with this residue and |a|, |b| below the root of p/2, if there is one [Wang1981]."""
    a, b, x, y = p, residue % p, 0, 1
    while 2 * b * b > p:
        quotient = a // b
        a, b, x, y = b, a - quotient * b, y, x - quotient * y
    return fmpq(b, y)


def _is_sum(rows: Sequence[Mapping[int, fmpq]], i: int, factors: RationalRow) -> bool:
    """Return whether row i is exactly the sum of rows times factors."""
    check()
    total = dict(rows[i])
    for k, factor in factors.items():
        for c, v in rows[k].items():
            total[c] = total.get(c, fmpq(0)) - factor * v
    return all(v == 0 for v in total.values())


def vector_in_kernel(rows: Sequence[Mapping[int, int]], p: int, rng: random.Random) -> SparseRow:
    """Return a random vector on which all rows vanish, with a value for each column that occurs."""
    columns = dict.fromkeys(c for row in rows for c in row)
    return Reduction(rows, p).completed({c: rng.randrange(p) for c in columns})


def rank_of_rows(rows: Sequence[Mapping[int, int]], p: int) -> int:
    """Return the rank over GF(p)."""
    return echelon(rows, p).rank


def last_columns(rows: Sequence[Mapping[int, int]], columns: int, p: int) -> tuple[int, ...]:
    """Columns to solve the rows for: a basis of the column space, the last ones where there is a choice."""
    turned = transposed(rows, columns)[::-1]
    return tuple(sorted(columns - 1 - k for k in echelon(turned, p).independent))


def peelable_rows(rows: Sequence[Mapping[int, int]]) -> set[int]:
    """Rows that can be taken away one after another, each with a column that no row left has: independent of the rest.

    A tree or a chain goes entirely; what stays is the core, where every column occurs twice.
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
    """Pivot rows with a 1 in their pivot column, each free of the pivots before it, of all rows but some.

    ``dependent``: for every row that depends on rows before it, the multiples of pivot rows that it is the sum of.
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
        """Return what is left of a row, and the multiples of pivot rows that were taken from it."""
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
        """A new pivot row: ``residual`` is the row less ``used`` multiples of earlier ones, then scaled."""
        column = min(residual, key=lambda c: (self._weight[c], c))
        inverse = pow(residual[column], -1, self.p)
        self._of[column] = len(self._rows)
        self._rows.append([(column, 1), *((c, v * inverse % self.p) for c, v in residual.items() if c != column)])
        self._sources.append((row, inverse, used))

    def solved(self, right: Sequence[int]) -> list[int]:
        """Return the solution of as many equations as there are columns, all of them pivots, with this right side."""
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
        """Return the vector with the given values in the columns that are no pivots, on which all rows vanish."""
        vector = dict(values)
        for (column, _), *others in reversed(self._rows):
            vector[column] = -sum(v * vector[c] for c, v in others) % self.p
        return vector

    def support(self, used: Mapping[int, int]) -> SparseRow:
        """A sum of pivot rows as one of rows, row -> factor: each is its row less earlier ones, unfolded backwards."""
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
    """Return a square matrix, factored once to be ``solved`` often; rows are equations. Raises PoleError."""
    reduction = Reduction(rows, p)
    if reduction.dependent:
        raise PoleError("the matrix is singular")
    return reduction


def rank_of(matrix: Sequence[Sequence[Any]], p: int) -> int:
    """Rank over GF(p)."""
    if not matrix or not matrix[0]:
        return 0
    affordable(len(matrix), len(matrix[0]))
    return int(residue_matrix([[int(v) for v in row] for row in matrix], p).rank())


def without_time(rows: Sequence[SparseRow], n: int) -> list[SparseRow]:
    """Return the first n columns."""
    return [{c: v for c, v in row.items() if c < n} for row in rows]


@dataclass(frozen=True)
class Pivots:
    """A choice of independent rows and of dependent columns, regular at a point."""

    rows: tuple[int, ...]
    dependent: tuple[int, ...]
    free: tuple[int, ...]


def sparse_frame(rows: Sequence[SparseRow], n: int, p: int) -> Pivots:
    """Return the first independent rows in order, and columns solved for (the last ones where there is a choice)."""
    kept = echelon(rows, p).independent
    dependent = last_columns([rows[i] for i in kept], n, p)
    solved = set(dependent)
    return Pivots(kept, dependent, tuple(c for c in range(n) if c not in solved))


def components(names_of: Iterable[Iterable[Hashable]]) -> list[list[int]]:
    """Return the groups of things that are joined by names in common, by their numbers and in order.

    >>> components([("x", "y"), ("z",), ("y", "u"), ()])
    [[0, 2], [1], [3]]
    """
    leader: list[int] = []
    owner: dict[Hashable, int] = {}

    def led(i: int) -> int:
        while leader[i] != i:
            leader[i] = i = leader[leader[i]]
        return i

    for i, names in enumerate(names_of):
        leader.append(i)
        root = i
        for name in names:
            first_owner = owner.setdefault(name, root)
            if first_owner != root:
                first_owner = led(first_owner)
                root, first_owner = (root, first_owner) if root < first_owner else (first_owner, root)
                leader[first_owner] = root
    groups: dict[int, list[int]] = {}
    for i in range(len(leader)):
        groups.setdefault(led(i), []).append(i)
    return list(groups.values())
