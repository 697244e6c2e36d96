"""Proofs that relations have no real solution, by signs and by resultants, or that an inequality has one, by a point.

Claims are tested by linear conditions on their terms (`sign_claims`), as written and after some equations have been
solved and substituted into the others. The resultant of two polynomials vanishes wherever both do; if it has no real
zero, they have none in common.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, islice
from math import prod
from typing import Any

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.ring.program import false_without_value, values
from dofkit.exact.ring.radicals import known_signs
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import explicit_relations
from dofkit.relations.normal.domain import DomainCondition, conditions_of, is_satisfied_at
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.sign_claims import SignClaim, are_contradictory
from dofkit.relations.normal.zero_set import never_vanishes, zero_set

#: Resultants are computed for at most so many claims.
MAX_CLAIMS = 40
#: Bounds of resultants: terms and degrees of a pair of polynomials, number of pairs; rounds (resultants of resultants).
MAX_RESULTANT_TERMS, MAX_RESULTANT_DEGREE, MAX_PAIRS, ROUNDS = 40, 8, 60, 2
#: Bound on the products of terms in a resultant, or else on the monomials that it may have.
MAX_PRODUCTS = 10**6


def no_solution(relations: Sequence[Expr], positive: frozenset[Expr], conditions: Sequence[Expr] = ()) -> bool:
    """Return whether it is proved that no real point satisfies ``relations`` (= 0) and ``conditions`` (>= 0).

    This holds for all values of parameters (for positive ones of those in ``positive``) and of unknown functions.
    False: not proved.
    """
    return refuted([*(SignClaim(e, "=") for e in relations), *(SignClaim(e, ">=") for e in conditions)], positive)


@false_without_value
def refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that no real point at which all expressions have a value satisfies all claims."""
    within = dict.fromkeys(d for c in claims for d in conditions_of(c.expr, positive))
    sided = [*claims, *(SignClaim(d.expr, d.sense) for d in within if d.sense != "!=")]
    return _is_refuted(sided, positive) or _is_refuted(_with_values(sided, positive), positive)


def hold_nowhere(relations: Sequence[Expr], conditions: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Return whether ``relations`` (= 0) and ``conditions`` are proved to have no real solution; u != 0 is u s = 1."""
    claims = [SignClaim(g, "=") for g in relations]
    for k, c in enumerate(conditions):
        inverse = c.expr * ex.coordinate(f"_slack {k}") - ex.ONE
        claims.append(SignClaim(inverse, "=") if c.sense == "!=" else SignClaim(c.expr, c.sense))
    return refuted(claims, positive)


def _is_refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether an inequality never holds, or the claims contradict each other by signs or by a resultant.

    u >= 0 is also written u = s^2 with a new unknown s.
    """
    if not claims:
        return False
    square = ex.coordinate("_slack") ** 2
    for c in claims:
        if c.sense != "=" and (
            never_holds(c.expr, c.sense == ">", positive) or never_vanishes(c.expr - square, positive)
        ):
            return True
    relations = [c.expr for c in claims if c.sense == "="]
    few = len(claims) <= MAX_CLAIMS
    return are_contradictory(claims, positive) or (few and _some_resultant_never_vanishes(relations, positive))


def _with_values(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> list[SignClaim]:
    """Return the claims after solving equations and substituting; an empty list if none can be solved.

    Every term of a sum of squares is an equation. If an expression has no value then, return the false claim -1 > 0.
    """
    relations = list[Expr]()
    for c in claims:
        branches = zero_set(c.expr, positive, c.expr.symbols)[0] if c.sense == "=" else ()
        relations += branches[0] if len(branches) == 1 else [c.expr] if c.sense == "=" else []
    try:
        solved = explicit_relations(relations, _number_coefficients)
        explicit = solved.by_others
        others = [SignClaim(substitute(c.expr, explicit), c.sense) for c in claims if c.sense != "="]
    except PoleError:
        return [SignClaim(ex.MINUS_ONE, ">")]
    return [*(SignClaim(g, "=") for g in solved.implicit), *others] if explicit else []


def _number_coefficients(g: Expr) -> dict[Expr, Expr]:
    """Return {symbol: number} for coordinates and velocities that occur in one term, number * symbol, of a sum."""
    terms = [ex.number_and_rest(t) for t in (g.args if g.op == "add" else (g,))]
    moving = [(s, number) for number, s in terms if s.op == "sym" and s.args[0] in ("coordinate", "velocity")]
    return {s: ex.num(number) for s, number in moving if sum(s in factor.symbols for _, factor in terms) == 1}


# -- polynomials in the generators ------------------------------------------------------------------

Poly = Any


def _faithful(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether every root has a value in the ring where it has one, unlike sqrt(u^2 v) = |u| sqrt(v) at u = 0."""
    ring = Ring((), positive)
    for node in {n for e in relations for n in ex.nodes(e)}:
        if node.op == "pow" and node.args[1].op == "num" and node.args[1].args[0].denominator % 2 == 0:
            base = node.args[0]
            nonnegative, remainder = known_signs(ring, base) if base.op == "mul" else ([], base)
            if remainder != ex.ONE and any(f.symbols and f not in positive and not _is_exp(f) for f in nonnegative):
                return False
    return True


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] in ("exp", "cosh")


@false_without_value
def _some_resultant_never_vanishes(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether a numerator of the relations, or a resultant of them, is proved to have no real zero."""
    if not _faithful(relations, positive):
        return False
    canon, quotients = quotients_of(relations, positive)
    numerators = [p for p, _ in quotients if p != 0]
    present = {i for p in numerators for i in canon.generators_in(p)}
    numerators += [g for g in canon.relations if not present.isdisjoint(canon.generators_in(g))]
    for v in canon.ring.vars:
        if v.kind == "sign":  # abs(u)/u has no value where u is 0, but there either sign would do
            canon.ring.var_expr[v.index] = ex.coordinate(f"_sign {v.index}")
    polynomials = numerators
    for _ in range(ROUNDS):
        polynomials = _resultants(polynomials)
    numbers = {v.index for v in canon.ring.vars if not canon.ring.var_expr[v.index].symbols}  # they may be related
    plain = [p for p in polynomials if numbers.isdisjoint(canon.generators_in(p))]
    return any(never_vanishes(canon.to_expr(p), positive) for p in plain)


def _resultants(polynomials: list[Poly]) -> list[Poly]:
    """Return the polynomials and the resultants of pairs, which vanish at their common zeros."""
    result = list(polynomials)
    for a, b in islice(combinations(polynomials, 2), MAX_PAIRS):
        if len(a) + len(b) > MAX_RESULTANT_TERMS:
            continue
        degrees = [(int(j), int(k)) for j, k in zip(a.degrees(), b.degrees(), strict=True)]
        for i, (j, k) in enumerate(degrees):
            monomials = prod(k * p + j * q + 1 for p, q in (*degrees[:i], *degrees[i + 1 :]))
            short = min(monomials, len(a) ** k * len(b) ** j) <= MAX_PRODUCTS
            if j and k and j + k <= MAX_RESULTANT_DEGREE and short:
                eliminated = a.resultant(b, i)
                if eliminated != 0 and len(eliminated) <= MAX_RESULTANT_TERMS and eliminated not in result:
                    result.append(eliminated)
    return result


#: Values that are tried for all symbols alike, and at random for each.
_SIMPLE = (ex.ZERO, ex.ONE, ex.MINUS_ONE, ex.TWO, ex.PI, ex.PI * ex.HALF, -ex.PI * ex.HALF)
#: The number of random points, and the sizes of their values.
POINTS, SCALES = 40, (1, 10, 1000, Fraction(1, 1000))
#: Starts of the search along a slack variable.
SEARCHES = 4


@lru_cache(maxsize=512)
def holds_somewhere(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool | None:
    """Return whether ``e >= 0`` (> 0 if ``strict``) at some real point; None if neither a point nor a proof was found.

    Parameters may have any value but 0, those of ``positive`` a positive one; an unknown function may be any.
    """
    try:
        plain = _with_constant_functions(e)
    except PoleError:  # a divisor consists of derivatives of unknown functions
        plain = None
    if plain is not None:
        domain, points = conditions_of(plain, positive), _points(plain, positive)
        nonzero = (p for p in points if not any(v.is_zero for s, v in p.items() if s.args[0] == "parameter"))
        satisfied = (point for point in nonzero if _is_satisfied(plain, strict, point))
        if any(all(is_satisfied_at(c, point, frozenset()) for c in domain) for point in satisfied):
            return True
    if refuted([SignClaim(e, ">" if strict else ">=")], positive):
        return False
    return True if plain is not None and _holds_along_slack(plain, strict, positive) else None


def _with_constant_functions(e: Expr) -> Expr:
    """Return ``e`` with every unknown function equal to the constant 1, and its derivatives to 0."""
    if e.op in ("num", "sym", "const"):
        return e
    if e.op == "call":
        return ex.ZERO if any(e.args[1]) else ex.ONE
    return ex.rebuild(e, tuple(_with_constant_functions(child) for child in ex.children(e)))


def _points(e: Expr, positive: frozenset[Expr]) -> Iterator[dict[Expr, Expr]]:
    """Yield points to try, as {symbol: value}: simple ones, then random ones, the same in every run."""
    symbols = sorted(e.symbols, key=repr)
    for value in _SIMPLE:
        yield {s: ex.ONE if s in positive and value != ex.TWO else value for s in symbols}
    rng = random.Random("dofkit inequality")
    for k in range(POINTS):
        scale = SCALES[k % len(SCALES)]
        random_point = {s: Fraction(rng.randrange(-512, 513), 256) * scale for s in symbols}
        yield {s: ex.num(abs(v) or scale if s in positive else v) for s, v in random_point.items()}
        yield {s: ex.ONE if s in positive else rng.choice(_SIMPLE) for s in symbols}


def _is_satisfied(e: Expr, strict: bool, point: dict[Expr, Expr]) -> bool:
    """Return whether e > 0 (or e >= 0, if not ``strict``) is proved at a point."""
    check()
    try:
        there = substitute(e, point)
        value = interval_of(there)
        if value is None:
            return False
        return bool(value > 0) or (not strict and is_proved_zero(there, frozenset()))
    except (NoValueError, ArithmeticError, ValueError):
        return False


def _holds_along_slack(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """Return whether e - s^2 has a certified zero, for a ``strict`` inequality one with s certainly not 0."""
    slack = ex.coordinate("_slack")
    unknowns: Sequence[Expr] = [*sorted(e.symbols, key=repr), slack]
    try:
        ring = Ring([e - slack * slack], positive)
        search = RealSearch(ring, [ring.node(e - slack * slack)], unknowns, positive)
        for seed in range(SEARCHES):
            result = search.search(seed)
            if result is not None and result.certain:
                at = values(ring, result.point)
                signs = [at[ring.node(p)] > 0 for p in positive & e.symbols]
                if all(signs) and not (strict and at[ring.node(slack)].contains(0)):
                    return True
    except OutOfTimeError:
        raise
    except (NoValueError, ArithmeticError, ValueError):
        pass  # no zero is certified
    return False
