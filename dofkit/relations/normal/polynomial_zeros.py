"""The real zeros of a polynomial in a ring's generators: branches of expressions that vanish together, by factors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import product as cartesian
from typing import Any

from flint import fmpq

from dofkit.exact.ideals import have_complex_points
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import linear_terms, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.semidefinite import Signs, fraction, semidefinite, sum_of_even

EXTREME_NOTE = (
    "a sine or cosine takes its largest or smallest value only: this is written in terms of half the angle, "
    "because its own gradient vanishes there"
)

Factors = list[tuple[Any, int]]


def at_extremes(canon: Canon, factors: Factors, variables: frozenset[Expr]) -> tuple[list[tuple[Expr, ...]], Factors]:
    """Return (branches of the factors that vanish only at extremes of sines and cosines, the other factors).

    Branches have expressions with nonzero gradient (`regular`). ``variables`` are coordinates and time.
    """
    values_of: dict[Expr, set[int]] = {}
    branches: list[tuple[Expr, ...]] = []
    others: Factors = []
    for factor, multiplicity in factors:
        extremes = extremes_of(canon.to_expr(factor), variables)
        if extremes is None:
            others.append((factor, multiplicity))
        elif len(extremes) == 1:
            function, value = extremes[0]
            values_of.setdefault(function, set()).add(value)
        else:
            branches.append(tuple(regular(function, value) for function, value in extremes))
    for function, extreme in values_of.items():
        both = len(extreme) == 2
        other = ex.fn("sin" if function.args[0] == "cos" else "cos", function.args[1])
        branches.append((other if both else regular(function, next(iter(extreme))),))
    return branches, others


def extremes_of(e: Expr, variables: frozenset[Expr]) -> Sequence[tuple[Expr, int]] | None:
    """Return the (f_i, 1 or -1) where e = c + sum a_i f_i is 0, if |c| = sum |a_i|, f_i sines or cosines; or None."""
    if e.functions.isdisjoint(("sin", "cos")):
        return None
    weights = dict(linear_terms(e))
    constant = weights.pop(ex.ONE, Fraction(0))
    if not weights or abs(constant) != sum(map(abs, weights.values())):
        return None
    extremes = [(f, -1 if (weight > 0) == (constant > 0) else 1) for f, weight in weights.items()]
    return extremes if all(_is_known(f, variables) for f in weights) else None


def _is_known(function: Expr, variables: frozenset[Expr]) -> bool:
    """Return whether ``function`` is a sine or cosine of an expression in the variables without unknown functions."""
    if function.op != "fn" or function.args[0] not in ("cos", "sin"):
        return False
    argument = function.args[1]
    moving = argument.symbols & variables
    declared = all(s.args[0] in ("coordinate", "time", "parameter") for s in argument.symbols)
    return bool(moving) and declared and all(node.op != "call" for node in ex.nodes(argument))


def regular(function: Expr, value: int) -> Expr:
    """Return an expression in half the angle that is 0, with nonzero gradient, where ``function`` is 1 or -1."""
    half = ex.HALF * function.args[1]
    sin, cos = ex.fn("sin", half), ex.fn("cos", half)
    if function.args[0] == "cos":
        return sin if value == 1 else cos
    return sin - cos if value == 1 else sin + cos


#: An expression with more branches than this is not split.
MAX_BRANCHES = 16

Conjunction = tuple[Expr, ...]
Zeros = tuple[tuple[Conjunction, ...], tuple[str, ...]]

POWER_NOTE = (
    "a power is zero where its base is zero: the base is used, because the gradient of the power vanishes there"
)
SQUARES_NOTE = "a sum of squares is zero over the real numbers only where every term is zero: each term is one equation"
PRODUCT_NOTE = "a product is zero on several branches"
EMPTY_NOTE = "no real configuration satisfies it: every term has the same sign and one never vanishes"
POLE_NOTE = "it has no value where a denominator vanishes: such zeros of the numerator are left out"
FACTOR_NOTE = "a factor that never vanishes was taken out"
EXPONENT_NOTE = (
    "two exponentials are equal over the real numbers only where their exponents are equal: the exponents are compared"
)


class TooManyBranchesError(Exception):
    """The zero set has more than `MAX_BRANCHES` branches."""


class HiddenZeroError(Exception):
    """It cannot be decided whether a constant factor is 0."""


def branches_of(branches: list[Conjunction], notes: list[str]) -> Zeros:
    """Return (branches, notes), a note added to ``notes`` for several branches; raises TooManyBranchesError."""
    if len(branches) > MAX_BRANCHES:
        raise TooManyBranchesError
    if len(branches) > 1:
        notes.append(PRODUCT_NOTE)
    return tuple(branches), tuple(dict.fromkeys(notes))


def products_of(options: Iterable[Iterable[Conjunction]]) -> list[Conjunction]:
    """Return the unions of one conjunction of each option that contain no other; may raise TooManyBranchesError."""
    combined: list[Conjunction] = [()]
    for option in options:
        every = [tuple(dict.fromkeys((*some, *more))) for some, more in cartesian(combined, option)]
        combined = [b for k, b in enumerate(every) if not any(_replaces(a, b, j < k) for j, a in enumerate(every))]
        if len(combined) > MAX_BRANCHES:
            raise TooManyBranchesError
    return combined


def _replaces(less: Conjunction, more: Conjunction, before: bool) -> bool:
    """Return whether ``more`` contains ``less`` and is longer, or contains it and comes later."""
    return set(less) <= set(more) and (before or len(less) < len(more))


def vanishes(constant: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether a constant is proved to be 0; raises HiddenZeroError if neither this nor the contrary is."""
    if constant.op == "sym":
        return False
    zero, sure = zero_and_verdict(constant, positive)
    if zero is None or (zero and sure != "proved"):
        raise HiddenZeroError
    return bool(zero)


class PolynomialZeros:
    """Zeros of polynomials in a ring's generators; ``zeros_of`` returns those of an expression (for exponents)."""

    def __init__(
        self, canon: Canon, positive: frozenset[Expr], variables: frozenset[Expr], zeros_of: Callable[[Expr], Zeros]
    ) -> None:
        self.canon, self.positive, self.variables, self.zeros_of = canon, positive, variables, zeros_of
        self.signs = Signs(canon, positive)

    def of(self, numerator: Any, bottom: Any, written: Expr) -> Zeros:
        """Return the zeros of the quotient numerator / bottom, whose expression is ``written``."""
        if numerator == 0:
            return ((),), ()
        canon = self.canon
        branches: list[Conjunction] = []
        notes: list[str] = []
        factors = canon.factors(numerator)
        kept = [(f, k) for f, k in factors if self._depends(f)]
        if any(vanishes(canon.to_expr(f), self.positive) for f, _ in factors if not self._depends(f)):
            return ((),), ()
        defined = [(f, k) for f, k in kept if not self._undefined(f, bottom)]
        if len(defined) < len(kept):
            kept, notes = defined, [POLE_NOTE]
        extremes, remainder = at_extremes(canon, kept, self.variables)
        if extremes:
            branches, notes = extremes, [*notes, EXTREME_NOTE]
        for factor, multiplicity in remainder:
            if multiplicity > 1:
                notes.append(POWER_NOTE)
            alone = len(kept) == 1 and multiplicity == 1 and len(factors) == 1
            result, said = self._factor(factor, numerator, written if alone else None)
            notes += said if result or len(kept) == 1 else [FACTOR_NOTE]
            branches += [b for b in result if b not in branches]
        if not kept:
            return (), (EMPTY_NOTE,)
        return branches_of(branches, notes)

    def _undefined(self, factor: Any, bottom: Any) -> bool:
        """Return whether the denominator is proved to be 0 wherever the factor is."""
        if bottom.is_constant():
            return False
        if not factor.gcd(bottom).is_constant():
            return True
        canon = self.canon
        if all(canon.ring.vars[i].kind == "symbol" for i in canon.generators_in(factor)):
            return False
        defined = (canon.to_expr(factor), ex.coordinate("_inverse") * canon.to_expr(bottom) - 1)
        unknowns = {s: ex.coordinate(f"_ {s.args[1]}") for e in defined for s in e.symbols if s.args[0] == "parameter"}
        return have_complex_points([substitute(e, unknowns) for e in defined], frozenset()) is False

    def _depends(self, factor: Any) -> bool:
        generators = (self.canon.ring.var_expr[i] for i in self.canon.generators_in(factor))
        return any(not self.variables.isdisjoint(s.symbols) for s in generators)

    def _factor(self, factor: Any, numerator: Any, written: Expr | None) -> tuple[list[Conjunction], list[str]]:
        """Return (branches, notes) of an irreducible factor of ``numerator``; ``written`` if it is all of it."""
        exponent = difference_of_exponents(self.canon, factor)
        if exponent is not None:
            result, said = self.zeros_of(exponent)
            return list(result), [EXPONENT_NOTE, *said]
        even = sum_of_even(factor, self.signs)
        if even is not None:
            if any(not zeros for zeros in even):
                return [], [EMPTY_NOTE]
            if len(even) > 1 or written is None:
                return self._monomials(even)
        split = semidefinite(self.canon, self.signs, factor)
        if split is not None:
            if not split:
                return [], [EMPTY_NOTE]
            return [tuple(split)], [SQUARES_NOTE]
        return [(written if written is not None else self.canon.regular_expr(factor, numerator),)], []

    def _monomials(self, even: list[list[int]]) -> tuple[list[Conjunction], list[str]]:
        """Return the branches on which every monomial vanishes, given for each the generators that may vanish."""
        options = [[(self._generator_zero(i),) for i in self._varying(zeros)] for zeros in even]
        return products_of(options), [SQUARES_NOTE] if len(even) > 1 else []

    def _varying(self, zeros: list[int]) -> list[int]:
        """Return the generators that depend on the variables, or all if none does; constants are generic."""
        generators = self.canon.ring.var_expr
        return [i for i in zeros if not self.variables.isdisjoint(generators[i].symbols)] or zeros

    def _generator_zero(self, index: int) -> Expr:
        generator = self.canon.ring.var_expr[index]
        return ex.children(generator)[0] if self.canon.ring.vars[index].kind == "root" else generator


def difference_of_exponents(canon: Canon, factor: Any) -> Expr | None:
    """Return u - v - log(c) for a factor exp(u) - c exp(v) with c > 0 and no velocities; None for any other factor."""
    terms = list(factor.to_dict().items())
    present = canon.generators_in(factor)
    if len(terms) != 2 or any(canon.ring.vars[i].kind != "exp" for i in present):
        return None
    (first, a), (second, b) = terms
    generators = {i: canon.ring.var_expr[i] for i in present}
    moving = any(s.args[0] == "velocity" for e in generators.values() for s in e.symbols)
    if a * b > 0 or moving or any(e.op != "fn" for e in generators.values()):
        return None
    last = len(first) - 1  # exponents are in reverse order of the generators
    powers = {i: int(first[last - i]) - int(second[last - i]) for i in present}
    scale = ex.fn("log", ex.num(fraction(fmpq(-a) / fmpq(b))))
    return ex.add(scale, *(ex.mul(ex.num(k), generators[i].args[1]) for i, k in powers.items()))
