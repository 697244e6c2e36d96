"""The real zero set of one expression: powers, products, sums of squares and factors without zeros.

``zero_set`` returns branches, whose union is the zero set. A branch is a list of expressions that vanish together,
with nonzero gradients if possible: g^2 becomes g, a sum of squares becomes all of its terms, a product becomes
branches, and a factor that never vanishes is removed. Without branches there is no real zero.
"""

from __future__ import annotations

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.ring.radicals import never_negative
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import linear
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
    """Return (branches of the real zeros of ``e``, notes); the branch (e,) alone if ``e`` cannot be split.

    ``variables`` are coordinates, velocities, time; other symbols are generic constants, those in ``positive`` > 0.
    """
    if _is_linear(e, variables):
        return ((e,),), ()
    try:
        return _WrittenZeros(positive, variables).of(e)
    except (NoValueError, TooManyBranchesError, HiddenZeroError):
        return ((e,),), ()


def _is_linear(e: Expr, variables: frozenset[Expr]) -> bool:
    """Return whether ``e`` is a linear combination of symbols with at least one variable (its gradient is not 0)."""
    terms = linear(e)
    return terms is not None and not variables.isdisjoint(terms)


class _WrittenZeros:
    """Computes the zeros of an expression by its structure as written, or else by its polynomial in generators."""

    def __init__(self, positive: frozenset[Expr], variables: frozenset[Expr]) -> None:
        self.positive = positive
        self.variables = variables

    def of(self, e: Expr) -> Zeros:
        """Return (branches of the zeros of ``e``, notes)."""
        structural = self._structural(e)
        return self._polynomial(e) if structural is None else structural

    def _structural(self, e: Expr) -> Zeros | None:
        """Return (branches, notes) by the form in which ``e`` is written; None if it is no product, power etc."""
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
        """Return (branches, notes) of a product: those of its factors; None if a denominator may be 0."""
        branches: list[Conjunction] = []
        notes: list[str] = []
        below = [factor.args[0] for factor in e.args if _is_denominator(factor)]
        if any(not self.variables.isdisjoint(g.symbols) and self.of(g)[0] for g in below):
            return None
        for factor in e.args:
            if factor.op == "num" or _is_denominator(factor):
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
        """Return the zeros of a sum all of whose terms are written as >= 0, or all as <= 0; None for other sums."""
        terms = [ex.number_and_rest(term) for term in e.args]
        one_sign = len({number > 0 for number, _ in terms}) == 1
        if not (one_sign and all(never_negative(factors, self.positive) for _, factors in terms)):
            return None
        return self._together([self.of(term) for term in e.args])

    def _together(self, zeros: list[Zeros]) -> Zeros:
        """Return the common zeros of several expressions."""
        if not all(branches for branches, _ in zeros):
            return (), (EMPTY_NOTE,)
        return tuple(products_of(branches for branches, _ in zeros)), (SQUARES_NOTE,)

    def _polynomial(self, e: Expr) -> Zeros:
        canon, [quotient] = quotients_of([e], self.positive)
        return PolynomialZeros(canon, self.positive, self.variables, self.of).of(*quotient, e)


def _is_denominator(factor: Expr) -> bool:
    """Return whether a factor is a power with a negative number as exponent."""
    return factor.op == "pow" and factor.args[1].op == "num" and bool(factor.args[1].args[0] < 0)


def never_vanishes(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether ``e`` is proved to be nonzero at every real point; False: not proved."""
    branches, _ = zero_set(e, positive, e.symbols)
    return not branches
