"""Rows of quotients as polynomials, and their determinants, in the canonical ring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.exact.errors import raising_no_value
from dofkit.exact.ring.canonical import Canon, Poly, Quotient


@raising_no_value
def cleared(canon: Canon, row: Sequence[Quotient]) -> tuple[list[Poly], Poly]:
    """(a row's entries times their common denominator, that denominator)."""
    whole = canon.one
    for _, bottom in row:
        if bottom != whole:
            whole = whole * (bottom / bottom.gcd(whole))
    return [canon.reduce(top if bottom == whole else top * (whole / bottom)) for top, bottom in row], whole


def polynomials(canon: Canon, row: Mapping[int, int], n: int) -> list[Poly]:
    """A row's entries, nodes by column, as polynomials, times their common denominator."""
    zero = (canon.one * 0, canon.one)
    return cleared(canon, [canon.quotient(row[c]) if c in row else zero for c in range(n)])[0]


def determinant(canon: Canon, matrix: Sequence[Sequence[Poly]]) -> Poly:
    """Expanded along the first row, in the canonical ring."""
    if len(matrix) == 1:
        return matrix[0][0]
    total = canon.one * 0
    for c, entry in enumerate(matrix[0]):
        if entry != 0:
            below = determinant(canon, [[*row[:c], *row[c + 1 :]] for row in matrix[1:]])
            term = canon.reduce(entry * below)
            total = total + term if c % 2 == 0 else total - term
    return canon.reduce(total)
