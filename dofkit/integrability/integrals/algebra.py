"""Exact algebra with a bound on its work: quotients in lowest terms, identities with a proof, linear systems."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

from dofkit.base.errors import NoValueError
from dofkit.exact.errors import TooLargeError, raising_no_value
from dofkit.exact.ring.canonical import Canon, soon_factored
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr

Poly = Any
Quotient = tuple[Poly, Poly]
T = TypeVar("T")

#: Canonical forms asked for in one integration; past it the search ends without a result.
STEPS = 400
#: Seconds that SymPy is given in one integration.
SECONDS = 2.0
#: The largest expression taken up, in nodes, and the largest polynomial factored or divided, in terms.
MAX_NODES = 500
MAX_TERMS = 120
MAX_DEGREE = 24
#: The largest polynomial in a linear system, in terms.
MAX_ENTRY = 24


class GivenUpError(Exception):
    """The work went past its bound, or an expression has no canonical form."""


def size(e: Expr) -> int:
    """Return the number of different nodes."""
    return sum(1 for _ in ex.nodes(e))


class Algebra:
    """Canonical forms under one budget; ``positive`` symbols are their own absolute value."""

    def __init__(self, positive: frozenset[Expr], steps: int = STEPS) -> None:
        self.positive = positive
        self.steps = steps
        self.seconds = SECONDS
        self._tidied: dict[Expr, Expr] = {}
        self._vanishing: dict[Expr, bool] = {}

    def attempt(self, work: Callable[[], T]) -> T | None:
        """Return the result of ``work``, or None where an expression has no canonical form or divides by zero."""
        try:
            return raising_no_value(work)()
        except NoValueError:
            return None

    def spend(self, expressions: Iterable[Expr]) -> None:
        """Count a canonical form. Raises TooLargeError for too large ones, GivenUpError past the bound."""
        sizes = [size(e) for e in expressions]
        if max(sizes) > MAX_NODES:
            raise TooLargeError
        self.tick(sum(1 + nodes // 20 for nodes in sizes))

    def tick(self, steps: int = 1) -> None:
        """Count work that is no canonical form."""
        self.steps -= steps
        if self.steps < 0:
            raise GivenUpError

    def lowered(self, expressions: Sequence[Expr]) -> tuple[Canon, list[Quotient]]:
        """Return the expressions as quotients in lowest terms over one set of generators."""
        self.spend(expressions)
        ring = Ring(expressions, self.positive)
        nodes = [ring.node(e) for e in expressions]
        canon = Canon(ring)
        quotients = [canon.quotient(node) for node in nodes]
        self.tick(sum(len(p) for quotient in quotients for p in quotient) // 50)
        return canon, [rationalised(canon, quotient) for quotient in quotients]

    def tidy(self, e: Expr) -> Expr:
        """Return ``e`` as one factored quotient in lowest terms, or ``e`` itself where that is too large."""
        found = self._tidied.get(e)
        if found is None:
            shown = self.attempt(lambda: self._quotient(e))
            found = self._tidied[e] = e if shown is None else shown
            self._tidied[found] = found
        return found

    def _quotient(self, e: Expr) -> Expr:
        canon, (quotient,) = self.lowered([e])
        top, bottom = quotient
        if len(top) + len(bottom) > MAX_TERMS:
            raise TooLargeError
        return factored(canon, top) / factored(canon, bottom)

    def vanishes(self, e: Expr) -> bool:
        """Return whether ``e`` is proved to be zero identically."""
        if e.op in ("num", "sym"):
            return e.is_zero
        found = self._vanishing.get(e)
        if found is None:
            found = self._vanishing[e] = bool(self.attempt(lambda: self._is_zero(e)))
        return found

    def _is_zero(self, e: Expr) -> bool:
        self.spend([e])
        ring = Ring([e], self.positive)
        node = ring.node(e)
        return Canon(ring).is_zero(node)

    def closed(self, form: dict[Expr, Expr]) -> bool:
        """Return whether d(omega) = 0 is proved."""
        items = list(form.items())
        return all(self.vanishes(diff(b, s) - diff(a, u)) for i, (s, a) in enumerate(items) for u, b in items[i + 1 :])


def bounded(poly: Poly) -> bool:
    """Return whether a polynomial is small enough to be factored or divided quickly."""
    return len(poly) <= MAX_TERMS and sum(int(k) for k in poly.degrees()) <= MAX_DEGREE * 4 and soon_factored(poly)


def in_lowest_terms(top: Poly, bottom: Poly) -> Quotient:
    """Return a quotient divided by the common divisor of numerator and denominator."""
    if top == 0:
        return top, top**0
    if bounded(top) and bounded(bottom):
        common = top.gcd(bottom)
        top, bottom = top / common, bottom / common
    leading = bottom.leading_coefficient()
    return top / leading, bottom / leading


def _length(quotient: Quotient) -> int:
    return sum(len(p) + sum(int(k) for k in p.degrees()) for p in quotient)


def rationalised(canon: Canon, quotient: Quotient) -> Quotient:
    """Return a quotient in lowest terms, also across cos^2 + sin^2 = 1 and root^d = radicand."""
    best = in_lowest_terms(*quotient)
    for var in canon.ring.vars:
        if var.kind not in ("cos", "sin", "root") or not any(p.degrees()[-1 - var.index] for p in best):
            continue
        gen = canon.gens[var.index] ** (var.degree - 1 if var.kind == "root" else 1)
        other = in_lowest_terms(canon.reduce(best[0] * gen), canon.reduce(best[1] * gen))
        if _length(other) < _length(best):
            best = other
    return best


def factored(canon: Canon, poly: Poly) -> Expr:
    """Return a polynomial in the generators as a product."""
    if poly == 0 or not bounded(poly):
        return canon.to_expr(poly)
    constant, factors = poly.factor()
    return ex.mul(canon.to_expr(canon.one * constant), *(canon.to_expr(f) ** int(k) for f, k in factors))


# -- linear systems over quotients of polynomials --------------------------------------------------


def _minus(a: Quotient, b: Quotient) -> Quotient:
    return _small(a[0] * b[1] - b[0] * a[1], a[1] * b[1])


def _times(a: Quotient, b: Quotient) -> Quotient:
    return _small(a[0] * b[0], a[1] * b[1])


def _small(top: Poly, bottom: Poly) -> Quotient:
    if len(top) > MAX_ENTRY or len(bottom) > MAX_ENTRY:
        raise TooLargeError
    return in_lowest_terms(top, bottom)


def solve(rows: list[list[Quotient]], one: Poly) -> list[Quotient] | None:
    """Return x with sum(row[k] x[k]) = row[-1] for every row, free unknowns 0, or None where there is none."""
    if not rows:
        return None
    unknowns = len(rows[0]) - 1
    pivots: dict[int, list[Quotient]] = {}
    for row in rows:
        row = _reduced(row, pivots)
        lead = next((k for k, entry in enumerate(row) if entry[0] != 0), None)
        if lead is None:
            continue
        if lead == unknowns:
            return None
        inverse = (row[lead][1], row[lead][0])
        row = [_times(entry, inverse) for entry in row]
        for k, other in pivots.items():
            pivots[k] = _cleared(other, row, lead)
        pivots[lead] = row
    zero = (one * 0, one)
    return [pivots[k][-1] if k in pivots else zero for k in range(unknowns)]


def _cleared(row: list[Quotient], pivot: list[Quotient], lead: int) -> list[Quotient]:
    factor = row[lead]
    if factor[0] == 0:
        return row
    return [_minus(a, _times(factor, b)) if b[0] != 0 else a for a, b in zip(row, pivot, strict=True)]


def _reduced(row: list[Quotient], pivots: dict[int, list[Quotient]]) -> list[Quotient]:
    for lead, pivot in pivots.items():
        row = _cleared(row, pivot, lead)
    return row
