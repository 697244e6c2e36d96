"""The real zero set of one expression: powers, products, sums of squares and factors without zeros.

``zero_set`` returns branches (a union) of lists of expressions that vanish together, each regular where it can
be made so: g^2 = 0 becomes g = 0, a sum of squares becomes all of its terms, a factor that never vanishes
is dropped, a product becomes branches. No branch: no real zero.
"""

from __future__ import annotations

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.ring.radicals import never_negative
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.polynomial_zeros import (
    EMPTY_NOTE,
    EXTREME_NOTE,
    FACTOR_NOTE,
    POWER_NOTE,
    SQUARES_NOTE,
    Conjunction,
    HiddenZeroError,
    PolynomialZeros,
    TooManyBranchesError,
    Zeros,
    branches_of,
    extremes_of,
    products_of,
    regular,
    vanishes,
)


def zero_set(e: Expr, positive: frozenset[Expr], variables: frozenset[Expr]) -> Zeros:
    """The real zeros of ``e`` in ``variables`` (coordinates, velocities, time), and what was done.

    Symbols outside ``variables`` are generic constants; those of ``positive`` are > 0.
    """
    if _is_linear(e, variables):
        return ((e,),), ()
    try:
        return _WrittenZeros(positive, variables).of(e)
    except (NoValueError, TooManyBranchesError, HiddenZeroError):
        return ((e,),), ()


def _is_linear(e: Expr, variables: frozenset[Expr]) -> bool:
    """A sum of numbers times different symbols, one of them a variable: regular as it is."""
    seen = False
    for term in e.args if e.op == "add" else (e,):
        remainder = term.args[-1] if term.op == "mul" and len(term.args) == 2 and term.args[0].op == "num" else term
        if remainder.op not in ("sym", "num"):
            return False
        seen = seen or remainder in variables
    return seen


class _WrittenZeros:
    """The zeros of an expression by the way in which it is written, else by its polynomial."""

    def __init__(self, positive: frozenset[Expr], variables: frozenset[Expr]) -> None:
        self.positive = positive
        self.variables = variables

    def of(self, e: Expr) -> Zeros:
        """The branches of the zeros of ``e``, and what was done."""
        structural = self._structural(e)
        return self._polynomial(e) if structural is None else structural

    def _structural(self, e: Expr) -> Zeros | None:
        if e.op == "num":
            return (((),), ()) if e.is_zero else ((), (EMPTY_NOTE,))
        if e.op == "mul":
            return self._product(e)
        if e.op == "fn" and e.args[0] == "exp":
            return (), (EMPTY_NOTE,)
        if e.op == "fn" and e.args[0] == "abs":
            return self.of(e.args[1])
        if e.op == "pow" and e.args[1].op == "num":
            if e.args[1].args[0] < 0:
                return (), (FACTOR_NOTE,)
            inner = self.of(e.args[0])
            return inner[0], (*inner[1], POWER_NOTE)
        if e.op == "add" and (extremes := extremes_of(e, self.variables)):  # before a sum in an angle is expanded
            return (tuple(regular(function, value) for function, value in extremes),), (EXTREME_NOTE,)
        if e.op == "add":
            return self._even_sum(e)
        return None

    def _product(self, e: Expr) -> Zeros | None:
        branches: list[Conjunction] = []
        notes: list[str] = []
        below = [factor.args[0] for factor in e.args if _below(factor)]
        if any(not self.variables.isdisjoint(g.symbols) and self.of(g)[0] for g in below):
            return None
        for factor in e.args:
            if factor.op == "num" or _below(factor):
                continue
            if self.variables.isdisjoint(factor.symbols):
                if vanishes(factor, self.positive):
                    return ((),), ()
                continue
            result, said = self.of(factor)
            notes += [n for n in said if n not in (EMPTY_NOTE, FACTOR_NOTE)] if result else [FACTOR_NOTE]
            branches += [b for b in result if b not in branches]
        return branches_of(branches, notes)

    def _even_sum(self, e: Expr) -> Zeros | None:
        """A sum of even powers with coefficients of one sign, as written."""
        signs = {sign_as_written(term, self.positive) for term in e.args}
        if len(signs) != 1 or None in signs:
            return None
        return self._together([self.of(term) for term in e.args])

    def _together(self, zeros: list[Zeros]) -> Zeros:
        notes = [SQUARES_NOTE]
        for branches, _ in zeros:
            if not branches:
                return (), (EMPTY_NOTE,)
        return tuple(products_of(branches for branches, _ in zeros)), tuple(notes)

    def _polynomial(self, e: Expr) -> Zeros:
        canon, [quotient] = quotients_of([e], self.positive)
        return PolynomialZeros(canon, self.positive, self.variables, self.of).of(*quotient, e)


def sign_as_written(term: Expr, positive: frozenset[Expr]) -> int | None:
    """Return the sign of a term that its factors show not to change; None where it may, or where that is unknown."""
    sign = 1
    for factor in term.args if term.op == "mul" else (term,):
        if factor.op == "num":
            sign = sign if factor.args[0] > 0 else -sign
        elif not never_negative(factor, positive):
            return None
    return sign


def _below(factor: Expr) -> bool:
    """A factor that stands below the line."""
    return factor.op == "pow" and factor.args[1].op == "num" and bool(factor.args[1].args[0] < 0)


def never_vanishes(e: Expr, positive: frozenset[Expr]) -> bool:
    """True where ``e`` is proved to be zero at no real point; False says nothing."""
    branches, _ = zero_set(e, positive, e.symbols)
    return not branches
