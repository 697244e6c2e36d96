"""Quotients of polynomials in lowest terms, polynomials as products, and linear systems over polynomials.

Only small polynomials are divided and factored, so that the work is bounded.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

from dofkit.exact.ring.canonical import Canon, soon_factored
from dofkit.exact.ring.program import TooLargeError
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

Poly = Any
Quotient = tuple[Poly, Poly]

#: The largest polynomial factored or divided, in terms, and its largest degree.
MAX_TERMS = 120
MAX_DEGREE = 24
#: The largest polynomial in a linear system, in terms.
MAX_ENTRY = 24


def bounded(poly: Poly) -> bool:
    """Return whether a polynomial is small enough to be factored or divided quickly."""
    return len(poly) <= MAX_TERMS and sum(int(k) for k in poly.degrees()) <= MAX_DEGREE * 4 and soon_factored(poly)


def in_lowest_terms(top: Poly, bottom: Poly) -> Quotient:
    """Return (top, bottom) without common factors, if both are `bounded`, and with a monic denominator."""
    if top == 0:
        return top, top**0
    if bounded(top) and bounded(bottom):
        common = top.gcd(bottom)
        top, bottom = top / common, bottom / common
    leading = bottom.leading_coefficient()
    return top / leading, bottom / leading


def _size(quotient: Quotient) -> int:
    return sum(len(p) + sum(int(k) for k in p.degrees()) for p in quotient)


def rationalised(canon: Canon, quotient: Quotient) -> Quotient:
    """Return a quotient in lowest terms; it may be expanded by a power of a root if that makes it shorter."""
    best = in_lowest_terms(*quotient)
    for var in canon.ring.vars:
        if var.kind != "root" or not any(p.degrees()[-1 - var.index] for p in best):
            continue
        gen = canon.gens[var.index] ** (var.degree - 1)
        other = in_lowest_terms(canon.reduce(best[0] * gen), canon.reduce(best[1] * gen))
        best = min(best, other, key=_size)
    return best


def factored(canon: Canon, poly: Poly) -> Expr:
    """Return a polynomial in the generators as an expression, a product if it can be factored."""
    if poly == 0 or not bounded(poly):
        return canon.to_expr(poly)
    constant, factors = poly.factor()
    return ex.mul(canon.to_expr(canon.unit * constant), *(canon.to_expr(f) ** int(k) for f, k in factors))


def solve(rows: list[list[Poly]], unit: Poly) -> list[Quotient] | None:
    """Return a solution x, with free unknowns 0, of sum(row[k] x[k]) = row[-1] for all rows; None if there is none."""
    pivots: dict[int, list[Poly]] = {}
    for row in rows:
        for lead, pivot in pivots.items():
            row = _cleared(row, pivot, lead)
        lead = next((k for k, entry in enumerate(row) if entry != 0), -1)
        if lead == len(row) - 1:
            return None
        if lead >= 0:
            pivots = {k: _cleared(other, row, lead) for k, other in pivots.items()} | {lead: row}
    unknowns = range(len(rows[0]) - 1) if rows else ()
    solution = [in_lowest_terms(pivots[k][-1], pivots[k][k]) if k in pivots else (unit * 0, unit) for k in unknowns]
    return solution or None


def _cleared(row: list[Poly], pivot: list[Poly], lead: int) -> list[Poly]:
    """Return a row with its entry in column ``lead`` eliminated by a pivot row, divided by the entries' gcd."""
    factor = row[lead]
    if factor == 0:
        return row
    entries = [a * pivot[lead] - factor * b for a, b in zip(row, pivot, strict=True)]
    if any(len(entry) > MAX_ENTRY for entry in entries):
        raise TooLargeError
    common = reduce(lambda a, b: a.gcd(b), entries)
    return entries if common == 0 else [entry / common for entry in entries]
