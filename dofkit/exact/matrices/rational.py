"""Linear dependences of sparse rational rows, reconstructed from their residues and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flint import fmpq

from dofkit.base.deadline import check
from dofkit.exact.matrices.sparse import vanishing

RationalRow = dict[int, fmpq]
#: Primes modulo which dependences of rational rows are found; a factor's numerator and denominator have half the bits.
RECONSTRUCTION_PRIMES = (2**127 - 1, 2**521 - 1, 2**2203 - 1)


def dependences(rows: Sequence[Mapping[int, fmpq]]) -> dict[int, RationalRow] | None:
    """Return {i: {k: f_k}} with row_i = sum f_k row_k for every row i that depends on rows before it.

    Rows that are independent modulo a prime are so over the rationals; dependences are reconstructed from their
    residues and checked. None if no prime of `RECONSTRUCTION_PRIMES` succeeds.

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
    """Return the fraction a/b with this residue and |a|, |b| < sqrt(p/2) if it exists, else a wrong one [Wang1981]."""
    a, b, x, y = p, residue % p, 0, 1
    while 2 * b * b > p:
        quotient = a // b
        a, b, x, y = b, a - quotient * b, y, x - quotient * y
    return fmpq(b, y)


def _is_sum(rows: Sequence[Mapping[int, fmpq]], i: int, factors: RationalRow) -> bool:
    """Return whether row i is exactly sum_k factors[k] * rows[k]."""
    check()
    total = dict(rows[i])
    for k, factor in factors.items():
        for c, v in rows[k].items():
            total[c] = total.get(c, fmpq(0)) - factor * v
    return all(v == 0 for v in total.values())
