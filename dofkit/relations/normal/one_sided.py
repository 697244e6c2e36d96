"""Inequalities by themselves: does one hold anywhere? Yes needs a point where it does, no needs a proof."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.exact.boxes import NON_NEGATIVE, WHOLE, BoxProgram, EmptyError
from dofkit.exact.errors import NoValueError, PoleError
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes

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
    """Is ``e >= 0`` (or > 0) at some real point? None where neither a point nor a proof was found.

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
    """Is an upper bound of ``e`` over all of space below 0, or 0 where it is asked to be above?"""
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
    """Is an operation defined and continuous everywhere?"""
    if node.op == "pow":
        exponent = node.args[1]
        return exponent.op == "num" and bool(exponent.args[0] > 0) and exponent.args[0].denominator == 1
    return node.op in ("num", "const", "sym", "add", "mul") or (node.op == "fn" and node.args[0] in _TOTAL)


def _holds_along_slack(e: Expr, strict: bool, positive: frozenset[Expr]) -> bool:
    """Is there a certified zero of e - s^2, for a strict inequality one with s apart from 0?"""
    slack = ex.coordinate("_slack")
    unknowns: Sequence[Expr] = [*sorted(e.symbols, key=repr), slack]
    try:
        ring = Ring([e - slack * slack], positive)
        search = RealSearch(ring, [ring.node(e - slack * slack)], unknowns, positive)
        for seed in range(SEARCHES):
            found = search.search(seed)
            if found is not None and found.certified and found.consistent:
                at = values(ring, found.point)
                signs = [at[ring.node(p)] > 0 for p in positive & e.symbols]
                if all(signs) and not (strict and at[ring.node(slack)].contains(0)):
                    return True
    except OutOfTimeError:
        raise
    except (NoValueError, ArithmeticError, ValueError):
        return False
    return False
