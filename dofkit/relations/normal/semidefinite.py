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
    """What is known of the signs of a ring's generators."""

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
        """True for a polynomial in sines and cosines whose constant outweighs the rest."""
        constant, remainder = self._weights(poly)
        return constant > remainder

    def bounded(self, poly: Any) -> bool:
        """True for one whose constant weighs as much as the rest, or more: it does not change its sign."""
        constant, remainder = self._weights(poly)
        return constant >= remainder and constant > 0

    def _weights(self, poly: Any) -> tuple[Fraction, Fraction]:
        """The sizes of the constant, and of the other terms together; 0 and 1 for what is unbounded."""
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
        """(is it >= 0 everywhere, the generators of which one must vanish where it is 0)."""
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
    """For a polynomial all of whose terms are >= 0 (or all <= 0): per term, the generators that may vanish.

    The zero set is then that of every term. An empty list among them: the polynomial never vanishes.
    None: some term changes sign.
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
    """1 for a polynomial that is proved to be >= 0 everywhere, -1 for <= 0, else 0; by its terms, else its factors.

    1 - cos(z)^2 = (1 - cos z)(1 + cos z) is a product of what is not negative. Raises TooLargeError.
    """
    whole = _sign_of_terms(signs, poly)
    if whole or poly.is_constant():
        return whole
    sign = 1 if poly.factor()[0] > 0 else -1
    for factor, multiplicity in canon.factors(poly):
        sign *= _sign_of_terms(signs, factor) ** multiplicity if multiplicity % 2 else 1
    return sign


def _sign_of_terms(signs: Signs, poly: Any) -> int:
    """The sign of a polynomial whose terms all have it, or whose constant outweighs sines and cosines; else 0."""
    if signs.bounded(poly):
        return 1 if next(c for exponents, c in poly.to_dict().items() if not any(exponents)) > 0 else -1
    if sum_of_even(poly, signs) is None:
        return 0
    return 1 if _some_positive(poly) else -1


@false_without_value
def never_holds(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """True where ``e >= 0`` (or > 0) is proved to hold nowhere: -e is a sum of terms that are >= 0, one of them > 0.

    For > 0 it is enough that no term, or a product with only such factors, is > 0.
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
        return _never_positive(canon, signs, top)
    if even is None or _some_positive(top):
        return False
    return strict or any(not zeros for zeros in even)


@false_without_value
def _never_positive(canon: Canon, signs: Signs, poly: Any) -> bool:
    return weak_sign(canon, signs, poly) == -1


def _some_positive(poly: Any) -> bool:
    """With terms of one sign: is that sign +?"""
    return any(c > 0 for c in poly.to_dict().values())


def semidefinite(canon: Canon, signs: Signs, factor: Any) -> list[Expr] | None:
    """A semidefinite quadratic polynomial with rational coefficients as the linear forms that vanish with it.

    An empty list: it is definite, with no zero. None: indefinite, or no such polynomial.
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
        answer = [i for i, v in zip(present, entries[:size], strict=True) if v != 0]
        if not answer or (len(answer) == 1 and answer[0] in signs.positive and entries[size] == 0):
            return []
        linear.append(ex.add(*(ex.mul(ex.num(fraction(v)), s) for v, s in zip(entries, generators, strict=True))))
    return linear


def _quadratic_form(canon: Canon, factor: Any, place: dict[int, int]) -> list[list[Fraction]]:
    """The symmetric matrix of the homogenised quadratic polynomial; the last row and column are for 1."""
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
    """The same number, as Python's."""
    return Fraction(int(value.p), int(value.q))


def _semidefinite_rows(form: list[list[Fraction]]) -> list[list[fmpq]] | None:
    """Rows that span the range of a form that is nowhere negative (Lagrange's reduction [Sylvester1852]), else None.

    The first coefficient of a factor is positive, so that no form is negative everywhere.
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
