"""Is an expression identically zero, and which of the two one-sided engines may be asked?"""

from __future__ import annotations

from typing import Literal

from flint import ctx

from dofkit.base.verdicts import Verdict
from dofkit.exact.errors import NoValueError
from dofkit.exact.independence import independent_generators
from dofkit.exact.points.balls import BallPoint, fixed_bits
from dofkit.exact.points.field import field_point
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr

#: ``field``: exact arithmetic at random points modulo random primes, where zero can be trusted. ``balls``: interval
#: arithmetic at real points, where non-zero is a proof.
Engine = Literal["field", "balls"]
Engines = frozenset[Engine]

FIELD: Engines = frozenset(("field",))
BALLS: Engines = frozenset(("balls",))
BOTH: Engines = FIELD | BALLS


#: Bits of the balls that must hold 0 before anything is taken for 0.
PRECISIONS = (256, 1024)
#: Random places at which balls are taken.
STARTS = 8


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is taken for zero identically; `zero_and_verdict` says how sure that is."""
    return bool(zero_and_verdict(e, positive)[0])


def is_proved_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the expression is proved to be zero identically."""
    return zero_and_verdict(e, positive) == (True, "proved")


def zero_and_verdict(e: Expr, positive: frozenset[Expr], engines: Engines = BOTH) -> tuple[bool | None, Verdict]:
    """Return whether the expression is zero identically, and how sure that is.

    None where one engine alone cannot decide it, or where the expression has no value at any point that was tried.
    Zero in the canonical ring is a proof; so is a value that is not zero there, or at a point over GF(p) where the
    generators are independent, or a ball at some real point that excludes 0. What is 0 at random points over GF(p) is
    probably zero [SchwartzZippel]; what no ball distinguishes from 0 is zero numerically.
    """
    if e.op == "num":
        return e.is_zero, "proved"
    ring = Ring([e], positive)
    node = ring.node(e)
    if engines != BOTH:
        return _by_one_engine(ring, node, positive, engines)
    canon = Canon(ring)
    try:
        independent = independent_generators(ring)
        if independent and _zero_at_points(ring, node, 1) is False:
            return False, "proved"
        if canon.is_zero(node):
            return True, "proved"
        if independent and _zero_at_points(ring, node) is not True:
            return False, "proved"
    except NoValueError:
        pass
    if excludes_zero(ring, node, positive):
        return False, "proved"
    if _zero_at_points(ring, node):
        return True, "probable"
    return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")


def _has_value(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Return whether the node has a value at one of the real points that are tried."""
    search = RealSearch(ring, (), (), positive)
    with ctx.workprec(fixed_bits() or PRECISIONS[0]):
        return any(_value_at(ring, node, BallPoint(search.start(seed, {}), seed)) for seed in range(STARTS))


def _value_at(ring: Ring, node: int, point: BallPoint) -> bool:
    try:
        return bool(values(ring, point)[node].is_finite())
    except NoValueError:
        return False


def _by_one_engine(ring: Ring, node: int, positive: frozenset[Expr], engines: Engines) -> tuple[bool | None, Verdict]:
    """Return what one engine alone decides: a ball proves only that a value is not zero."""
    if "balls" in engines:
        if excludes_zero(ring, node, positive):
            return False, "proved"
        return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")
    zero = _zero_at_points(ring, node)
    if zero:
        return True, "probable"
    return (False, "probable") if zero is False and independent_generators(ring) else (None, "undecided")


def certainly_nonzero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether a ball at some real point excludes 0 as the value of an expression."""
    ring = Ring([e], positive)
    return excludes_zero(ring, ring.node(e), positive)


def excludes_zero(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Return whether a ball at some real point excludes 0 as the value of a node."""
    search = RealSearch(ring, (), (), positive)
    bits = fixed_bits()
    for precision in PRECISIONS if bits is None else (bits,):
        with ctx.workprec(precision):
            if any(_excluded_at(ring, node, BallPoint(search.start(seed, {}), seed)) for seed in range(STARTS)):
                return True
    return False


def _excluded_at(ring: Ring, node: int, point: BallPoint) -> bool:
    try:
        return not values(ring, point)[node].contains(0)
    except NoValueError:
        return False


def _zero_at_points(ring: Ring, node: int, points: int = 3) -> bool | None:
    """Return whether the node is zero at so many random points over GF(p), or None where too few were found."""
    seen = 0
    for seed in range(60):
        try:
            if values(ring, field_point([ring], seed))[node] != 0:
                return False
        except NoValueError:
            continue
        seen += 1
        if seen == points:
            return True
    return None
