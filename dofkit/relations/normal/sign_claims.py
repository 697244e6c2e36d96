"""Contradictions between equations and inequalities, by the signs of their terms.

Every term is replaced by a new unknown. Equations and inequalities are then linear in these, and so are known signs
and bounds of terms; a linear program decides whether they contradict each other [Motzkin1936]. If they do not, products
of two inequalities are added.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Literal, NamedTuple

from flint import fmpq

from dofkit.exact.linear_inequalities import LinearCondition, solution
from dofkit.exact.ring.radicals import sense_of
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import linear_terms
from dofkit.expressions.tree import Expr

#: Products are formed only if there are at most so many inequalities.
MAX_FACTORS = 8
#: Bound on the number of terms (or twice the number of claims, if that is larger).
MAX_TERMS = 80
#: Bounds on the absolute values of functions, and the functions that do not reach their bounds (11/7 > pi/2).
_BOUNDS = {name: Fraction(1) for name in ("sin", "cos", "tanh")} | {
    name: Fraction(11, 7) * turns for name, turns in (("asin", 1), ("atan", 1), ("acos", 2), ("atan2", 2))
}
_UNREACHED = frozenset({"tanh", "atan", "asin", "acos", "atan2"})

ZERO = fmpq(0)
Sense = Literal["=", ">=", ">"]


class SignClaim(NamedTuple):
    """``expr`` is 0, or >= 0, or > 0, by its ``sense``."""

    expr: Expr
    sense: Sense


def are_contradictory(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that no real point satisfies all claims.

    Parameters may have any value (those of ``positive`` a positive one), and so may every value of an unknown function.
    """
    if contradictory(claims, positive):
        return True
    if all(u.op == "sym" or u == ex.ONE for c in claims for u in _terms(c.expr)):
        return False
    more = list(_products(claims, positive))
    return bool(more) and contradictory([*claims, *more], positive)


@lru_cache(maxsize=4096)
def _terms(e: Expr) -> Mapping[Expr, Fraction]:
    """Return an expression as {term: number}."""
    return linear_terms(e)


def contradictory(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether no values of the terms, as independent unknowns, satisfy the claims and the terms' bounds."""
    terms = sorted({u for c in claims for u in _terms(c.expr) if u != ex.ONE}, key=repr)
    facts = [*claims, *(fact for u in terms for fact in _facts(u, positive))]
    order = sorted({u for c in facts for u in _terms(c.expr)} - {ex.ONE}, key=repr)
    if len(order) > max(MAX_TERMS, 2 * len(claims)):
        return False
    return solution([_linear_condition(c, order) for c in facts]) is False


def point_of_linear(claims: Sequence[SignClaim]) -> Mapping[Expr, Expr] | None:
    """Return exact values of the symbols that satisfy all claims; None if there are none or a claim is not linear."""
    order = sorted({u for c in claims for u in _terms(c.expr)} - {ex.ONE}, key=repr)
    if any(u.op != "sym" for u in order):
        return None
    point = solution([_linear_condition(c, order) for c in claims])
    return {u: ex.num(Fraction(int(v.p), int(v.q))) for u, v in zip(order, point, strict=True)} if point else None


def _linear_condition(claim: SignClaim, order: Sequence[Expr]) -> LinearCondition:
    """Return a claim as a linear condition on the terms in ``order``."""
    terms = _terms(claim.expr)
    *row, constant = (fmpq(v.numerator, v.denominator) if (v := terms.get(u)) else ZERO for u in (*order, ex.ONE))
    return LinearCondition(tuple(row), constant, claim.sense)


def _facts(term: Expr, positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """Yield the sign and the bounds of a term, which it has wherever it has a value."""
    sense = sense_of(term, positive)
    if sense is not None:
        yield SignClaim(term, sense)
    if term.op == "fn" and term.args[0] in _BOUNDS:
        most = ex.num(_BOUNDS[term.args[0]])
        within: Sense = ">" if term.args[0] in _UNREACHED else ">="
        yield from (SignClaim(most - term, within), SignClaim(most + term, within))
    if term.op == "fn" and term.args[0] == "cosh":
        yield SignClaim(term - ex.ONE, ">=")
    if term.op == "fn" and term.args[0] == "abs":
        yield from (SignClaim(term - term.args[1], ">="), SignClaim(term + term.args[1], ">="))


def _products(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """Yield the products of all pairs of inequalities, positive symbols, and bounds of functions; none if too many."""
    symbols = frozenset[Expr]().union(*(c.expr.symbols for c in claims))
    factors = [c for c in claims if c.sense != "="]
    factors += [SignClaim(s, ">") for s in sorted(symbols & positive, key=repr)]
    functions = {u for c in claims for e in _terms(c.expr) for u in ex.nodes(e) if u.op == "fn"}
    factors += [fact for u in sorted(functions, key=repr) for fact in _facts(u, positive)]
    for first, other in combinations_with_replacement(factors, 2) if len(factors) <= MAX_FACTORS else ():
        yield SignClaim(ex.mul(first.expr, other.expr), ">" if first.sense == other.sense == ">" else ">=")
