"""Linear combinations of relations of lower degree: two circles meet on a line."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import fmpq_mat

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.instructions import ADD, MUL, NUM
from dofkit.exact.ring.ring import Ring

#: Relations are combined while their coefficients fit a matrix of this many entries.
COMBINED_ENTRIES = 20_000


#: The terms of a polynomial: exponents and coefficients.
Terms = dict[tuple[int, ...], Any]


def echelon_by_degree(canon: Canon, relations: Sequence[int]) -> list[Terms] | None:
    """An echelon form of the numerators, the highest terms eliminated first; None where it is too large."""
    try:
        tables = [canon.quotient(node)[0].to_dict() for node in relations]
    except NoValueError:
        return None
    monomials = sorted({m for table in tables for m in table}, key=lambda m: (-sum(m), m))
    if not monomials or len(monomials) * len(tables) > COMBINED_ENTRIES:
        return None
    reduced, rank = fmpq_mat([[table.get(m, 0) for m in monomials] for table in tables]).rref()
    return [{m: reduced[r, c] for c, m in enumerate(monomials) if reduced[r, c] != 0} for r in range(rank)]


def combined(ring: Ring, relations: Sequence[int]) -> list[int] | None:
    """An echelon form of the numerators by degree, as nodes that vanish together where they do; None: too large."""
    rows = echelon_by_degree(Canon(ring), relations)
    return None if rows is None else [_polynomial_node(ring, row) for row in rows]


def _polynomial_node(ring: Ring, table: dict[tuple[int, ...], Any]) -> int:
    n, terms = len(next(iter(table))), []
    for exponents, value in table.items():
        factors = [ring.emit(NUM, Fraction(int(value.p), int(value.q)))]
        factors += [ring.power_node(ring.var_node[n - 1 - i], int(k)) for i, k in enumerate(exponents) if k]
        terms.append(ring.emit(MUL, tuple(factors)))
    return ring.emit(ADD, tuple(terms))
