"""Equations and inequalities that no real point satisfies: proofs only, never a search that failed.

Three are tried. Taken as linear in their terms, with what is known of the signs of terms, they contradict each other
(exact linear programming); so do their products by pairs; or every box of space is excluded by certified bounds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, combinations_with_replacement
from typing import Literal, NamedTuple

from flint import fmpq

from dofkit.exact.linear_inequalities import LinearCondition, solution
from dofkit.expressions import tree as ex
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.no_solution import no_solution

#: Inequalities of which products are taken; equations times symbols; symbols whose differences are squared.
MAX_FACTORS, MAX_MULTIPLES, MAX_SQUARED = 8, 24, 4
#: Terms of all together, or twice as many as claims where those are more.
MAX_TERMS = 80
#: More claims than this are not put to boxes.
MAX_BOXED = 40
#: Functions that are nowhere negative, and those that are above 0; bounded by 1 in size.
_NOT_NEGATIVE, _POSITIVE, _BOUNDED = frozenset({"abs", "acos"}), frozenset({"exp", "cosh"}), ("sin", "cos", "tanh")

Sense = Literal["=", ">=", ">"]


class SignClaim(NamedTuple):
    """``expr`` is 0, or >= 0, or > 0, by its ``sense``."""

    expr: Expr
    sense: Sense


def refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """True where no real point satisfies all claims: proved. False says nothing.

    Parameters may have any value (those of ``positive`` a positive one), and so may every value of an unknown function.
    """
    if contradictory(claims, positive):
        return True
    if all(u.op == "sym" or u == ex.ONE for c in claims for u in _terms(c.expr)):
        return False
    more = list(_products(claims, positive))
    if more and contradictory([*claims, *more], positive):
        return True
    equations = [c.expr for c in claims if c.sense == "="]
    others = [c.expr for c in claims if c.sense != "="]
    return len(claims) <= MAX_BOXED and no_solution(equations, positive, others)


@lru_cache(maxsize=4096)
def _terms(e: Expr) -> Mapping[Expr, Fraction]:
    """The expression as a combination of its terms."""
    return linear_terms(e)


def contradictory(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """True where no values of the terms, taken for unknowns of their own, satisfy the claims and the terms' signs."""
    known, terms = list(claims), set[Expr]()
    for _ in range(2):
        fresh = {u for c in known for u in _terms(c.expr) if u != ex.ONE} - terms
        terms |= fresh
        known += [fact for u in sorted(fresh, key=repr) for fact in _facts(u, terms, positive)]
    order = sorted({u for c in known for u in _terms(c.expr)} - {ex.ONE}, key=repr)
    if len(order) > max(MAX_TERMS, 2 * len(claims)):
        return False
    place = {u: k for k, u in enumerate(order)}
    return solution([_condition(c, place) for c in known]) is False


def _condition(claim: SignClaim, place: dict[Expr, int]) -> LinearCondition:
    row, constant = [fmpq(0)] * len(place), fmpq(0)
    for u, factor in _terms(claim.expr).items():
        value = fmpq(factor.numerator, factor.denominator)
        if u == ex.ONE:
            constant = value
        else:
            row[place[u]] = value
    return LinearCondition(tuple(row), constant, claim.sense)


def _facts(term: Expr, terms: set[Expr], positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """What holds of a term wherever it has a value."""
    sense = _sign(term, positive)
    if sense is not None:
        yield SignClaim(term, sense)
    if term.op == "fn" and term.args[0] in _BOUNDED:
        yield from (SignClaim(ex.ONE - term, ">="), SignClaim(ex.ONE + term, ">="))
    if term.op == "fn" and term.args[0] == "cosh":
        yield SignClaim(term - ex.ONE, ">=")
    if term.op == "fn" and term.args[0] == "abs":
        yield from (SignClaim(term - term.args[1], ">="), SignClaim(term + term.args[1], ">="))
    if term.op == "pow" and term.args[1] == ex.TWO and term.args[0].op == "fn" and term.args[0].args[0] == "sin":
        other = ex.power(ex.fn("cos", term.args[0].args[1]), ex.TWO)
        if other in terms:
            yield SignClaim(term + other - ex.ONE, "=")


def _sign(term: Expr, positive: frozenset[Expr]) -> Sense | None:
    """>= or > where a product is so wherever it has a value; None where that is not seen."""
    signs = [_sign_of_factor(f, positive) for f in (term.args if term.op == "mul" else (term,))]
    if None in signs:
        return None
    return ">=" if ">=" in signs else ">"


def _sign_of_factor(factor: Expr, positive: frozenset[Expr]) -> Sense | None:
    if factor in positive or factor.op == "const" or (factor.op == "fn" and factor.args[0] in _POSITIVE):
        return ">"
    if factor.op == "fn" and factor.args[0] in _NOT_NEGATIVE:
        return ">="
    if factor.op == "pow" and factor.args[1].op == "num":
        exponent = factor.args[1].args[0]
        if _sign_of_factor(factor.args[0], positive) == ">":
            return ">"
        if exponent.denominator % 2 == 0 or exponent.numerator % 2 == 0:
            return ">" if exponent < 0 else ">="
    return None


def _products(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """Inequalities times each other, positive parameters among them, equations times symbols, and a few squares."""
    symbols = sorted(_symbols(claims), key=repr)
    for a, b in combinations(symbols, 2) if len(symbols) <= MAX_SQUARED else ():
        yield from (SignClaim(ex.power(u, ex.TWO), ">=") for u in (a + b, a - b))
    factors = [c for c in claims if c.sense != "="] + [SignClaim(s, ">") for s in symbols if s in positive]
    functions = {u for c in claims for e in _terms(c.expr) for u in ex.nodes(e) if u.op == "fn"}
    factors += [fact for u in sorted(functions, key=repr) for fact in _facts(u, set(), positive)]
    if len(factors) <= MAX_FACTORS:
        for one, other in combinations_with_replacement(factors, 2):
            yield SignClaim(ex.mul(one.expr, other.expr), ">" if one.sense == other.sense == ">" else ">=")
    equations = [c for c in claims if c.sense == "="]
    if len(equations) * len(symbols) <= MAX_MULTIPLES:
        yield from (SignClaim(ex.mul(c.expr, s), "=") for c in equations for s in symbols)


def _symbols(claims: Iterable[SignClaim]) -> frozenset[Expr]:
    return frozenset[Expr]().union(*(c.expr.symbols for c in claims))
