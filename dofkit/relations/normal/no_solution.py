"""Relations without a real solution: proofs by signs and by resultants; inequalities that hold somewhere, by a point.

What relations say is put to linear conditions on their terms (`sign_claims`): as they are written, and once what some
of them give is put into the others. Resultants of two polynomials vanish wherever both do, so that one without a real
zero is a proof.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, islice
from typing import Any

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Canon, quotients_of
from dofkit.exact.ring.program import false_without_value, values
from dofkit.exact.ring.radicals import known_signs
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import explicit_relations
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.sign_claims import SignClaim, are_contradictory
from dofkit.relations.normal.zero_set import never_vanishes, zero_set

#: More claims than this are not put to resultants.
MAX_CLAIMS = 40
#: Resultants are taken of polynomials up to this size and degree, of so many pairs, and then of these.
MAX_RESULTANT_TERMS, MAX_RESULTANT_DEGREE, MAX_PAIRS, ROUNDS = 40, 8, 60, 2


def no_solution(relations: Sequence[Expr], positive: frozenset[Expr], conditions: Sequence[Expr] = ()) -> bool:
    """Return whether ``relations`` (= 0) and ``conditions`` (>= 0) are proved to hold together at no real point.

    Parameters may have any value (those of ``positive`` a positive one), unknown functions as well. False says nothing.
    """
    return refuted([*(SignClaim(e, "=") for e in relations), *(SignClaim(e, ">=") for e in conditions)], positive)


@false_without_value
def refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that no real point satisfies all claims, at which all they hold has a value."""
    within = dict.fromkeys(d for c in claims for d in conditions_of(c.expr, positive))
    sided = [*claims, *(SignClaim(d.expr, d.sense) for d in within if d.sense != "!=")]
    return _is_refuted(sided, positive) or _is_refuted(_with_values(sided, positive), positive)


def hold_nowhere(relations: Sequence[Expr], conditions: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that ``conditions`` hold together at no real point at which ``relations`` are 0.

    u != 0 is written u s = 1 for some s.
    """
    claims = [SignClaim(g, "=") for g in relations]
    for k, c in enumerate(conditions):
        inverse = c.expr * ex.coordinate(f"_slack {k}") - ex.ONE
        claims.append(SignClaim(inverse, "=") if c.sense == "!=" else SignClaim(c.expr, c.sense))
    return refuted(claims, positive)


def _is_refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """Return whether one claim holds nowhere, or all contradict each other by signs, or by a resultant.

    u >= 0 is u = s^2 for some s.
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
    few = len(relations) > 0 and len(claims) <= MAX_CLAIMS
    return are_contradictory(claims, positive) or (few and _some_resultant_never_vanishes(relations, positive))


def _with_values(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> list[SignClaim]:
    """Return the claims with the values put in that equations give; none where they give none. Raises NoValueError.

    A sum of squares gives each of its terms. Where something has no value then, what is claimed is false: -1 > 0.
    """
    relations = list[Expr]()
    for c in claims:
        branches = zero_set(c.expr, positive, c.expr.symbols)[0] if c.sense == "=" else ()
        relations += branches[0] if len(branches) == 1 else [c.expr] if c.sense == "=" else []
    try:
        solved = explicit_relations(relations, _plain_coefficients)
        explicit = solved.by_others
        others = [SignClaim(substitute(c.expr, explicit), c.sense) for c in claims if c.sense != "="]
    except PoleError:
        return [SignClaim(ex.MINUS_ONE, ">")]
    return [*(SignClaim(g, "=") for g in solved.implicit), *others] if explicit else []


def _plain_coefficients(g: Expr) -> dict[Expr, Expr]:
    """Return the coordinates and velocities of which a sum holds a multiple by a number, and nothing else."""
    terms = [ex.number_and_rest(t) for t in (g.args if g.op == "add" else (g,))]
    moving = [(s, number) for number, s in terms if s.op == "sym" and s.args[0] in ("coordinate", "velocity")]
    return {s: ex.num(number) for s, number in moving if sum(s in factor.symbols for _, factor in terms) == 1}


# -- polynomials in the generators ------------------------------------------------------------------

Poly = Any


def _faithful(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether every root has a value in the ring wherever it has one, unlike sqrt(u^2 v) = |u| sqrt(v)."""
    ring = Ring((), positive)
    for node in {n for e in relations for n in ex.nodes(e)}:
        if node.op == "pow" and node.args[1].op == "num" and node.args[1].args[0].denominator % 2 == 0:
            base = node.args[0]
            apart, remainder = known_signs(ring, base) if base.op == "mul" else ([], base)
            if remainder != ex.ONE and any(f.symbols and f not in positive and not _is_exp(f) for f in apart):
                return False
    return True


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] in ("exp", "cosh")


@false_without_value
def _some_resultant_never_vanishes(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether a polynomial that vanishes wherever the relations hold has no real zero: them, or a resultant."""
    if not _faithful(relations, positive):
        return False
    canon, quotients = quotients_of(relations, positive)
    numerators = [p for p, _ in quotients if p != 0]
    present = {i for p in numerators for i in canon.generators_in(p)}
    numerators += [g for g in canon.relations if not present.isdisjoint(canon.generators_in(g))]
    for v in canon.ring.vars:
        if v.kind == "sign":  # where its argument is 0 either sign satisfies them, and abs(u)/u has no value
            canon.ring.var_expr[v.index] = ex.coordinate(f"_sign {v.index}")
    polynomials = numerators
    for _ in range(ROUNDS):
        polynomials = _resultants(polynomials)
    return any(_without_hidden_numbers(canon, p) and never_vanishes(canon.to_expr(p), positive) for p in polynomials)


def _without_hidden_numbers(canon: Canon, p: Poly) -> bool:
    """No generator is a number of its own: such numbers may be related, and their polynomials hidden zeros."""
    return all(canon.ring.var_expr[i].symbols for i in canon.generators_in(p))


def _resultants(polynomials: list[Poly]) -> list[Poly]:
    """The polynomials and the resultants of pairs: they vanish wherever both do."""
    result = list(polynomials)
    for a, b in islice(combinations(polynomials, 2), MAX_PAIRS):
        if len(a) + len(b) > MAX_RESULTANT_TERMS:
            continue
        for i, (j, k) in enumerate(zip(a.degrees(), b.degrees(), strict=True)):
            if j and k and j + k <= MAX_RESULTANT_DEGREE:
                eliminated = a.resultant(b, i)
                if eliminated != 0 and len(eliminated) <= MAX_RESULTANT_TERMS and eliminated not in result:
                    result.append(eliminated)
    return result


#: Values that are tried for every symbol, and for all alike.
_SIMPLE = (ex.ZERO, ex.ONE, ex.MINUS_ONE, ex.TWO, ex.PI, ex.PI * ex.HALF, -ex.PI * ex.HALF)
#: Random points, and how far out they lie.
POINTS, SCALES = 40, (1, 10, 1000, Fraction(1, 1000))
#: Starts of the search along a slack variable.
SEARCHES = 4


@lru_cache(maxsize=512)
def holds_somewhere(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool | None:
    """Return whether ``e >= 0`` (or > 0) at some real point; None if neither a point nor a proof was found.

    Parameters may have any value, those of ``positive`` a positive one; an unknown function may be any.
    """
    try:
        plain = _with_constant_functions(e)
    except PoleError:  # a divisor holds derivatives of unknown functions only
        plain = None
    if plain is not None and any(_is_satisfied(plain, strict, point) for point in _points(plain, positive)):
        return True
    if refuted([SignClaim(e, ">" if strict else ">=")], positive):
        return False
    return True if plain is not None and _holds_along_slack(plain, strict, positive) else None


def _with_constant_functions(e: Expr) -> Expr:
    """``e`` where every unknown function is 1 everywhere: its derivatives are 0."""
    if e.op in ("num", "sym", "const"):
        return e
    if e.op == "call":
        return ex.ZERO if any(e.args[1]) else ex.ONE
    return ex.rebuild(e, tuple(_with_constant_functions(child) for child in ex.children(e)))


def _points(e: Expr, positive: frozenset[Expr]) -> Iterator[dict[Expr, Expr]]:
    """Simple points, then random ones, the same in every run."""
    symbols = sorted(e.symbols, key=repr)
    for value in _SIMPLE:
        yield {s: ex.ONE if s in positive and value != ex.TWO else value for s in symbols}
    rng = random.Random("dofkit inequality")
    for k in range(POINTS):
        scale = SCALES[k % len(SCALES)]
        drawn = {s: Fraction(rng.randrange(-512, 513), 256) * scale for s in symbols}
        yield {s: ex.num(abs(v) or scale if s in positive else v) for s, v in drawn.items()}
        yield {s: ex.ONE if s in positive else rng.choice(_SIMPLE) for s in symbols}


def _is_satisfied(e: Expr, strict: bool, point: dict[Expr, Expr]) -> bool:
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
    """Return whether e - s^2 has a certified zero, for a strict inequality one with s apart from 0."""
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
        return False
    return False
