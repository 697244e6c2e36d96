"""Dense matrices over GF(p), eliminated by blocks in floating point numbers that hold whole numbers exactly.

Residues lie between -p/2 and p/2 with p < 2^23, so a sum of 256 products and one residue stays below 2^53 and no
product of matrices is ever rounded: the speed is that of the numerical library, the result that of integers.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

from flint import fmpz

from dofkit.base.deadline import check
from dofkit.base.libraries import np

PRIME_BITS = 23
#: Products that are summed before they are reduced: 256 (2^22)^2 + 2^22 < 2^53.
TERMS = 256
#: Columns that are eliminated one by one.
NARROW = 16


def prime_at(seed: str) -> int:
    """A random prime of 23 bits."""
    rng = random.Random(f"dofkit dense prime {seed}")
    while True:
        p = rng.getrandbits(PRIME_BITS - 1) | 1 << (PRIME_BITS - 1) | 1
        if fmpz(p).is_prime():
            return p


def residues(values: Any, p: int) -> Any:
    """Whole numbers below 2^53 modulo p, between -p/2 and p/2."""
    return values - p * np.rint(values * (1.0 / p))


def product(left: Any, right: Any, p: int) -> Any:
    """left right modulo p."""
    found = np.zeros((left.shape[0], right.shape[1]))
    for k in range(0, left.shape[1], TERMS):
        found = residues(found + left[:, k : k + TERMS] @ right[k : k + TERMS], p)
    return found


@dataclass(frozen=True)
class Factored:
    """P A = L U for a matrix A of any shape: ``order`` of the rows, and the first independent columns.

    ``packed`` holds U in its first rows, and in the columns ``independent`` the multipliers of L below the pivots.
    """

    packed: Any
    order: Any
    independent: tuple[int, ...]
    p: int

    @property
    def rank(self) -> int:
        return len(self.independent)

    def dependencies(self) -> tuple[list[int], Any]:
        """(the other columns, each of them as a sum of independent ones: a column of coefficients each)."""
        rank, kept = self.rank, set(self.independent)
        others = [c for c in range(self.packed.shape[1]) if c not in kept]
        upper = self.packed[:rank, list(self.independent)]
        return others, _solve_upper(upper, self.packed[:rank, others], self.p)

    def annihilators(self, number: int, seed: str) -> Any:
        """Random row vectors u with u A = 0, ``number`` of them."""
        rank, rows = self.rank, self.packed.shape[0]
        rng = np.random.default_rng(list(seed.encode()))
        free = residues(rng.integers(0, self.p, (number, rows - rank)).astype(float), self.p)
        lower = self.packed[:, list(self.independent)]
        bound = -product(free, lower[rank:], self.p)
        for i in range(rank - 1, 0, -1):
            bound[:, :i] = residues(bound[:, :i] - bound[:, i : i + 1] * lower[i, :i], self.p)
        found = np.empty((number, rows))
        found[:, self.order] = np.concatenate([bound, free], axis=1)
        return found


def factored(matrix: Any, p: int) -> Factored:
    """The factors of a matrix of residues, which is used up."""
    order = np.arange(matrix.shape[0])
    return Factored(matrix, order, tuple(_eliminate(matrix, order, 0, 0, matrix.shape[1], p)), p)


def _eliminate(a: Any, order: Any, r: int, first: int, last: int, p: int) -> list[int]:
    """The columns from ``first`` to ``last`` with pivots in the rows from r: by halves (Toledo 1997)."""
    if last - first <= NARROW:
        return _eliminate_narrow(a, order, r, first, last, p)
    check()
    middle = (first + last) // 2
    left = _eliminate(a, order, r, first, middle, p)
    k = len(left)
    if k:
        a[r : r + k, middle:last] = _solve_lower(a[r : r + k, left], a[r : r + k, middle:last], p)
        rest = product(a[r + k :, left], a[r : r + k, middle:last], p)
        a[r + k :, middle:last] = residues(a[r + k :, middle:last] - rest, p)
    return left + _eliminate(a, order, r + k, middle, last, p)


def _eliminate_narrow(a: Any, order: Any, r: int, first: int, last: int, p: int) -> list[int]:
    found = []
    for c in range(first, last):
        nonzero = np.flatnonzero(a[r:, c])
        if not len(nonzero):
            continue
        pivot = r + int(nonzero[0])
        if pivot != r:
            a[[r, pivot]] = a[[pivot, r]]
            order[[r, pivot]] = order[[pivot, r]]
        inverse = pow(int(a[r, c]), -1, p)
        a[r + 1 :, c] = residues(a[r + 1 :, c] * inverse, p)
        a[r + 1 :, c + 1 : last] = residues(a[r + 1 :, c + 1 : last] - np.outer(a[r + 1 :, c], a[r, c + 1 : last]), p)
        found.append(c)
        r += 1
    return found


def _solve_lower(lower: Any, right: Any, p: int) -> Any:
    """L^-1 right, for the lower triangle with ones on its diagonal."""
    n = len(lower)
    if n <= NARROW:
        found = right.copy()
        for i in range(n - 1):
            found[i + 1 :] = residues(found[i + 1 :] - np.outer(lower[i + 1 :, i], found[i]), p)
        return found
    k = n // 2
    top = _solve_lower(lower[:k, :k], right[:k], p)
    rest = residues(right[k:] - product(lower[k:, :k], top, p), p)
    return np.concatenate([top, _solve_lower(lower[k:, k:], rest, p)])


def _solve_upper(upper: Any, right: Any, p: int) -> Any:
    """U^-1 right, for the upper triangle."""
    n = len(upper)
    if n <= NARROW:
        found = right.copy()
        for i in range(n - 1, -1, -1):
            found[i] = residues(found[i] * pow(int(upper[i, i]), -1, p), p)
            found[:i] = residues(found[:i] - np.outer(upper[:i, i], found[i]), p)
        return found
    k = n // 2
    bottom = _solve_upper(upper[k:, k:], right[k:], p)
    rest = residues(right[:k] - product(upper[:k, k:], bottom, p), p)
    return np.concatenate([_solve_upper(upper[:k, :k], rest, p), bottom])
