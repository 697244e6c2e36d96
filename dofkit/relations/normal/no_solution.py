"""Relations without a real solution: a proof by exclusion.

Space is cut into boxes; a box is excluded where interval evaluation of the relations leaves nothing [Moore1966]. If
every box is excluded there is no solution. Two descriptions of the same set are tried: the relations as written, and
polynomials in their generators with resultants of these.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, islice
from typing import Any, NamedTuple

from flint import arb, ctx

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.exact.boxes import NON_NEGATIVE, UNIT, WHOLE, Box, BoxProgram, EmptyError, Interval, bounds, middle
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import Var, values
from dofkit.exact.ring.radicals import known_signs
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes

#: Steps of programs over boxes that one search may take; bits of the balls behind them.
MAX_STEPS, BITS = 60_000, 64
#: So many before polynomials are tried, which tell at once what boxes tell slowly: nested circles of nearly one radius.
SOON = 6_000
#: A box thinner than this, or this far out, is not cut any further.
THINNEST, FARTHEST = 1e-7, 1e7
#: Resultants are taken of polynomials up to this size and degree, and of so many pairs.
MAX_RESULTANT_TERMS, MAX_RESULTANT_DEGREE, MAX_PAIRS = 40, 8, 60
ZERO: Interval = (0.0, 0.0)

#: An expression and where its value must lie.
Wanted = tuple[Expr, Interval]


def no_solution(relations: Sequence[Expr], positive: frozenset[Expr], conditions: Sequence[Expr] = ()) -> bool:
    """True where ``relations`` (= 0) and ``conditions`` (>= 0) are proved to hold together at no real point.

    Parameters may have any value (those of ``positive`` a positive one), unknown functions as well. False says nothing.
    """
    wanted = [(e, ZERO) for e in relations] + [(e, NON_NEGATIVE) for e in conditions]
    if not wanted:
        return False
    ranges = dict.fromkeys(positive, NON_NEGATIVE)
    with ctx.workprec(BITS):
        try:
            soon = _excluded(wanted, ranges, SOON)
            system = None if soon else _system(relations, positive)
            excluded = _excluded(wanted, ranges) if soon is None else soon
            return bool(excluded or (excluded is None and system is not None and _is_excluded(system)))
        except EmptyError:
            return True
        except NoValueError:
            return False


def hold_nowhere(relations: Sequence[Expr], conditions: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that ``conditions`` hold together at no real point at which ``relations`` are 0.

    u > 0 is written u s^2 = 1 for some s, and u != 0 is u s = 1.
    """
    if any(never_holds(c.expr, c.strict, positive) for c in conditions if c.sense != "!="):
        return True
    slacks = [ex.coordinate(f"_slack {k}") for k in range(len(conditions))]
    strict = [
        c.expr * s * (s if c.strict else ex.ONE) - ex.ONE
        for c, s in zip(conditions, slacks, strict=True)
        if c.sense != ">="
    ]
    return no_solution([*relations, *strict], positive, [c.expr for c in conditions if c.sense != "!="])


def _excluded(wanted: Sequence[Wanted], ranges: Mapping[Expr, Interval], steps: int = MAX_STEPS) -> bool | None:
    """Branch and prune: is every box of the whole excluded within the bounds? False: one shrinks to a point."""
    try:
        relations = BoxProgram(wanted)
        boxes: list[Box] = [relations.contract([ranges.get(v, WHOLE) for v in relations.variables])]
    except EmptyError:
        return True
    while relations.work < steps:
        check()
        if not boxes:
            return True
        box = boxes.pop()
        k = _widest(box)
        if k is None:
            return None if any(math.isinf(v) for x in box for v in x) else False
        cut = middle(box[k])
        for part in ((box[k][0], cut), (cut, box[k][1])):
            try:
                boxes.append(relations.contract([*box[:k], part, *box[k + 1 :]]))
            except EmptyError:
                continue
    return None


def _widest(box: Box) -> int | None:
    """The variable to cut; None where that would not lead on."""
    best, width = None, THINNEST
    for k, (low, high) in enumerate(box):
        near = max((abs(v) for v in (low, high) if not math.isinf(v)), default=0.0)
        if high - low > width and not (math.isinf(high - low) and near > FARTHEST):
            best, width = k, high - low
    return best


# -- polynomials in the generators ------------------------------------------------------------------

Poly = Any


class PolynomialSystem(NamedTuple):
    """Polynomials that vanish wherever the relations hold, and the ``ranges`` of the generators."""

    polynomials: tuple[Poly, ...]
    symbols: tuple[Expr, ...]
    ranges: Mapping[Expr, Interval]


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


def _system(relations: Sequence[Expr], positive: frozenset[Expr]) -> PolynomialSystem | None:
    """Polynomials that vanish wherever the relations hold; None where there are none to be had.

    Raises EmptyError where one of them has no real root.
    """
    try:
        return _polynomials(relations, positive) if _faithful(relations, positive) else None
    except NoValueError:
        return None


def _polynomials(relations: Sequence[Expr], positive: frozenset[Expr]) -> PolynomialSystem:
    """Return numerators in the canonical ring, the generators' relations and resultants of both."""
    ring = Ring(relations, positive)
    nodes = [ring.node(e) for e in relations]
    canon = Canon(ring)
    numerators = [canon.quotient(node)[0] for node in nodes]
    if any(p == 0 for p in numerators):
        numerators = [p for p in numerators if p != 0]
    present = {i for p in numerators for i in canon.generators_in(p)}
    numerators += [g for g in canon.relations if not present.isdisjoint(canon.generators_in(g))]
    everything = _resultants(numerators)
    count = len(ring.vars)
    symbols = tuple(ex.parameter(f"generator {count - 1 - i}") for i in range(count))
    ranges = {symbols[count - 1 - v.index]: _range(v, ring) for v in ring.vars}
    if any(_without_hidden_numbers(canon, p) and never_vanishes(canon.to_expr(p), positive) for p in everything):
        raise EmptyError
    return PolynomialSystem(tuple(everything), symbols, ranges)


def _without_hidden_numbers(canon: Canon, p: Poly) -> bool:
    """No generator is a number of its own: such numbers may be related, and their polynomials hidden zeros."""
    return all(canon.ring.var_expr[i].symbols for i in canon.generators_in(p))


def _range(var: Var, ring: Ring) -> Interval:
    if var.kind in ("cos", "sin", "sign"):
        return UNIT
    if var.kind in ("asin", "atan"):
        return -1.6, 1.6
    if var.kind == "atan2":
        return -3.2, 3.2
    if var.kind == "pi":
        return bounds(arb.pi())
    if var.kind == "exp" or (var.kind == "root" and var.degree % 2 == 0):
        return NON_NEGATIVE
    return NON_NEGATIVE if var.kind == "symbol" and var.key in ring.positive else WHOLE


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


def _is_excluded(system: PolynomialSystem) -> bool:
    """Return whether every box of the space of the generators is excluded."""
    return bool(_excluded([(_expression(p, system.symbols), ZERO) for p in system.polynomials], system.ranges))


def _expression(p: Poly, symbols: Sequence[Expr]) -> Expr:
    return ex.add(*(_term(c, m, symbols) for m, c in p.to_dict().items()))


def _term(coefficient: Any, exponents: Sequence[int], symbols: Sequence[Expr]) -> Expr:
    powers = [ex.power(s, ex.num(int(k))) for s, k in zip(symbols, exponents, strict=True) if k]
    return ex.mul(ex.num(Fraction(int(coefficient.p), int(coefficient.q))), *powers)


#: Values that are tried for every symbol, and for all alike.
_SIMPLE = (ex.ZERO, ex.ONE, ex.MINUS_ONE, ex.TWO, ex.PI, ex.PI * ex.HALF, -ex.PI * ex.HALF)
#: Functions that are defined and continuous everywhere.
_TOTAL = frozenset({"sin", "cos", "exp", "sinh", "cosh", "tanh", "atan", "abs"})
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
    if plain is not None and any(_holds_at(plain, strict, point) for point in _points(plain, positive)):
        return True
    if never_holds(e, strict, positive) or _never_by_bounds(e, strict, positive) or no_solution([], positive, [e]):
        return False
    if _negative_everywhere(e, positive):
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


def _holds_at(e: Expr, strict: bool, point: dict[Expr, Expr]) -> bool:
    check()
    try:
        there = substitute(e, point)
        value = interval_of(there)
        if value is None:
            return False
        return bool(value > 0) or (not strict and is_proved_zero(there, frozenset()))
    except (NoValueError, ArithmeticError, ValueError):
        return False


def _never_by_bounds(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """Return whether an upper bound of ``e`` over all of space is below 0, or 0 where > 0 is asked."""
    try:
        program = BoxProgram([(e, WHOLE)])
        box = [NON_NEGATIVE if v in positive else WHOLE for v in program.variables]
        top = program.forward(box)[e][1]
    except (EmptyError, NoValueError):
        return False
    return top <= 0 if strict else top < 0


def _negative_everywhere(e: Expr, positive: frozenset[Expr]) -> bool:
    """Continuous on all of space, without a zero, and below 0 at one point (the intermediate value theorem)."""
    if not all(map(_continuous, ex.nodes(e))):
        return False
    point = dict.fromkeys(e.symbols, ex.ONE)
    return _holds_at(-e, True, point) and (never_vanishes(e, positive) or no_solution([e], positive))


def _continuous(node: Expr) -> bool:
    """Return whether an operation is defined and continuous everywhere."""
    if node.op == "pow":
        exponent = node.args[1]
        return exponent.op == "num" and bool(exponent.args[0] > 0) and exponent.args[0].denominator == 1
    return node.op in ("num", "const", "sym", "add", "mul") or (node.op == "fn" and node.args[0] in _TOTAL)


def _holds_along_slack(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """Return whether e - s^2 has a certified zero, for a strict inequality one with s apart from 0."""
    slack = ex.coordinate("_slack")
    unknowns: Sequence[Expr] = [*sorted(e.symbols, key=repr), slack]
    try:
        ring = Ring([e - slack * slack], positive)
        search = RealSearch(ring, [ring.node(e - slack * slack)], unknowns, positive)
        for seed in range(SEARCHES):
            result = search.search(seed)
            if result is not None and result.certified and result.consistent:
                at = values(ring, result.point)
                signs = [at[ring.node(p)] > 0 for p in positive & e.symbols]
                if all(signs) and not (strict and at[ring.node(slack)].contains(0)):
                    return True
    except OutOfTimeError:
        raise
    except (NoValueError, ArithmeticError, ValueError):
        return False
    return False
