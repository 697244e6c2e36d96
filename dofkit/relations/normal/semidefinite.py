"""Polynomials that do not change sign: sums of terms of one sign, and semidefinite quadratic forms."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.exact.ring.canonical import Canon, quotients_of
from dofkit.exact.ring.program import false_without_value
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr


class Signs:
    """Which generators of a ring are ``positive``, ``nonnegative``, or ``circular`` (sines and cosines), by index."""

    def __init__(self, canon: Canon, positive: frozenset[Expr]) -> None:
        self.positive = {
            var.index
            for var in canon.ring.vars
            if var.kind in ("exp", "pi")
            or (var.kind == "symbol" and var.key in positive)
            or (var.kind == "root" and isinstance(var.key[0], Expr))
        }
        self.nonnegative = {v.index for v in canon.ring.vars if v.kind == "root" and v.degree % 2 == 0}
        self.circular = {v.index for v in canon.ring.vars if v.kind in ("cos", "sin")}
        self.n = len(canon.ring.vars)

    def bounded_away(self, poly: Any) -> bool:
        """Return whether ``poly`` is a polynomial in sines and cosines that is never 0, by its large constant."""
        constant, remainder = self._weights(poly)
        return constant > remainder

    def bounded(self, poly: Any) -> bool:
        """Return whether ``poly`` is a polynomial in sines and cosines with the sign of its constant, or 0."""
        constant, remainder = self._weights(poly)
        return constant >= remainder and constant > 0

    def _weights(self, poly: Any) -> tuple[Fraction, Fraction]:
        """Return (|constant|, bound on the sum of the other terms).

        (0, 1), which proves nothing, if other generators occur.
        """
        constant = remainder = Fraction(0)
        for exponents, coefficient in poly.to_dict().items():
            present = {self.n - 1 - i for i, k in enumerate(exponents) if k}
            if not present <= self.circular:
                return Fraction(0), Fraction(1)
            if present:
                remainder += abs(fraction(coefficient))
            else:
                constant += abs(fraction(coefficient))
        return constant, remainder

    def monomial(self, exponents: tuple[int, ...]) -> tuple[bool, list[int]]:
        """Return (whether a monomial is >= 0 everywhere, the generators one of which is 0 where it is 0)."""
        zeros = []
        for place, exponent in enumerate(exponents):
            index = self.n - 1 - place
            if not exponent or index in self.positive:
                continue
            if exponent % 2 and index not in self.nonnegative:
                return False, []
            zeros.append(index)
        return True, zeros


def sum_of_even(poly: Any, signs: Signs) -> list[list[int]] | None:
    """Return, for each term, the generators one of which is 0 where the term is, if all terms are >= 0 or all <= 0.

    The polynomial is 0 where all terms are; if a list is empty, nowhere. None if a term may have either sign.
    """
    if signs.bounded_away(poly):
        return [[]]
    result, overall = [], 0
    for exponents, coefficient in poly.to_dict().items():
        even, zeros = signs.monomial(tuple(int(k) for k in exponents))
        sign = 1 if coefficient > 0 else -1
        if not even or (overall and sign != overall):
            return None
        overall = sign
        result.append(zeros)
    return result


def weak_sign(canon: Canon, signs: Signs, poly: Any) -> int:
    """Return 1 if a polynomial is proved to be >= 0 everywhere, -1 if <= 0, otherwise 0; by its terms or factors.

    Example: both factors of 1 - cos(z)^2 = (1 - cos z)(1 + cos z) are >= 0. Raises TooLargeError.
    """
    sign_of_all = _sign_of_terms(signs, poly)
    if sign_of_all or poly.is_constant():
        return sign_of_all
    sign = 1 if poly.leading_coefficient() > 0 else -1  # that of every factor is positive
    for factor, multiplicity in canon.factors(poly):
        sign *= _sign_of_terms(signs, factor) ** multiplicity if multiplicity % 2 else 1
    return sign


def _sign_of_terms(signs: Signs, poly: Any) -> int:
    """Return the common sign of all terms, or the sign of a constant that outweighs sines and cosines; else 0."""
    if signs.bounded(poly):
        return 1 if next(c for exponents, c in poly.to_dict().items() if not any(exponents)) > 0 else -1
    if sum_of_even(poly, signs) is None:
        return 0
    return 1 if _some_positive(poly) else -1


@false_without_value
def never_holds(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """Return whether ``e >= 0`` (> 0 if ``strict``) is proved to be false everywhere, by the signs of the terms of e.

    All terms must be <= 0, and one < 0 if not ``strict``. False: not proved.
    """
    canon, [(top, bottom)] = quotients_of([e], positive)
    if top == 0:
        return strict
    if not bottom.is_constant():
        return False
    top = top / bottom.leading_coefficient()
    signs = Signs(canon, positive)
    even = sum_of_even(top, signs)
    if even is None and strict:
        return weak_sign(canon, signs, top) == -1
    if even is None or _some_positive(top):
        return False
    return strict or any(not zeros for zeros in even)


def _some_positive(poly: Any) -> bool:
    """Return whether a polynomial whose terms have one sign is >= 0."""
    return any(c > 0 for c in poly.to_dict().values())


def semidefinite(canon: Canon, signs: Signs, factor: Any) -> list[Expr] | None:
    """Return linear expressions whose common zeros are those of a positive semidefinite quadratic polynomial.

    An empty list if it has no zero. None if it is indefinite, or not quadratic with rational coefficients.
    """
    if factor.total_degree() != 2:
        return None
    present = canon.generators_in(factor)
    if any(canon.ring.vars[i].kind not in ("symbol", "exp") for i in present):
        return None
    place = {index: i for i, index in enumerate(present)}
    form, size = _quadratic_form(canon, factor, place), len(present)
    rows = _semidefinite_rows(form)
    if rows is None:
        return None
    generators = [canon.ring.var_expr[i] for i in present] + [ex.ONE]
    reduced, rank = fmpq_mat(rows).rref() if rows else (fmpq_mat(0, size + 1), 0)
    linear = []
    for r in range(rank):
        entries = [reduced[r, c] for c in range(size + 1)]
        occurring = [i for i, v in zip(present, entries[:size], strict=True) if v != 0]
        if not occurring or (len(occurring) == 1 and occurring[0] in signs.positive and entries[size] == 0):
            return []
        linear.append(ex.add(*(ex.mul(ex.num(fraction(v)), s) for v, s in zip(entries, generators, strict=True))))
    return linear


def _quadratic_form(canon: Canon, factor: Any, place: dict[int, int]) -> list[list[Fraction]]:
    """Return the symmetric matrix of a quadratic polynomial; the last row and column belong to the constant 1."""
    n, total = len(place), len(canon.ring.vars)
    form = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
    for exponents, coefficient in factor.to_dict().items():
        slots = [place[total - 1 - i] for i, k in enumerate(exponents) for _ in range(int(k))]
        a, b = [*slots, n, n][:2]
        value = fraction(coefficient)
        if a == b:
            form[a][a] += value
        else:
            form[a][b] += value / 2
            form[b][a] += value / 2
    return form


def fraction(value: fmpq) -> Fraction:
    """Return a FLINT number as a Fraction."""
    return Fraction(int(value.p), int(value.q))


def _semidefinite_rows(form: list[list[Fraction]]) -> list[list[fmpq]] | None:
    """Return rows that span the range of a positive semidefinite form (Lagrange's reduction [Sylvester1852]), or None.

    Negative semidefinite forms do not occur: the first coefficient of a factor is positive.
    """
    n = len(form)
    work = [row[:] for row in form]
    rows = []
    for i in range(n):
        pivot = work[i][i]
        if pivot == 0:
            if any(work[i]):
                return None
            continue
        if pivot < 0:
            return None
        row = work[i][:]
        rows.append([fmpq(v.numerator, v.denominator) for v in row])
        for j in range(n):
            for k in range(n):
                work[j][k] -= row[j] * row[k] / pivot
    return rows
