"""Is an expression identically zero?"""

from __future__ import annotations

from fractions import Fraction

from flint import ctx

from dofkit.base.verdicts import Verdict
from dofkit.exact.engines import BOTH, Engines
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.balls import BallPoint, fixed_bits
from dofkit.exact.points.field import field_point
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero.constants import proved_zero
from dofkit.exact.zero.independence import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

#: Bits of the balls that must hold 0 before anything is taken for 0.
PRECISIONS = (256, 1024)
#: Random places at which balls are taken.
STARTS = 8


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Is the expression zero identically, as far as can be told? See `zero_and_verdict` for how sure that is."""
    return bool(zero_and_verdict(e, positive)[0])


def is_proved_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Is the expression proved to be zero identically?"""
    return zero_and_verdict(e, positive) == (True, "proved")


def zero_and_verdict(e: Expr, positive: frozenset[Expr], engines: Engines = BOTH) -> tuple[bool | None, Verdict]:
    """(zero?, how sure); None where one engine alone cannot tell, or it has a value nowhere that was tried.

    Zero in the canonical ring is a proof, and so is zero of every coefficient there (`proved_zero`); so is not zero
    there or at a point over GF(p) where the generators are independent, or where a ball at some real point excludes
    0. What is 0 at random points over GF(p) is probably zero [SchwartzZippel]; what no ball tells from 0 is so
    numerically.
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
    if _coefficients_vanish(canon, node):
        return True, "proved"
    if _zero_at_points(ring, node):
        return True, "probable"
    return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")


def _has_value(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """Was there a real point at which a ball could be taken? What has a value nowhere that was tried is not 0."""
    search = RealSearch(ring, (), (), positive)
    with ctx.workprec(fixed_bits() or PRECISIONS[0]):
        return any(_value_at(ring, node, BallPoint(search.start(seed, {}), seed)) for seed in range(STARTS))


def _value_at(ring: Ring, node: int, point: BallPoint) -> bool:
    try:
        return bool(values(ring, point)[node].is_finite())
    except NoValueError:
        return False


def _coefficients_vanish(canon: Canon, node: int) -> bool:
    """Is every coefficient, a number, proved to be 0, by the monomials of what varies?"""
    shown = list(reversed(canon.ring.var_expr))
    groups: dict[tuple[int, ...], list[Expr]] = {}
    try:
        for exponents, value in canon.quotient(node)[0].to_dict().items():
            moving = tuple(int(k) if shown[i].symbols else 0 for i, k in enumerate(exponents))
            fixed = [ex.power(shown[i], ex.num(int(k))) for i, k in enumerate(exponents) if k and not moving[i]]
            groups.setdefault(moving, []).append(ex.mul(ex.num(Fraction(int(value.p), int(value.q))), *fixed))
    except NoValueError:
        return False
    return all(proved_zero(ex.add(*terms)) for terms in groups.values())


def _by_one_engine(ring: Ring, node: int, positive: frozenset[Expr], engines: Engines) -> tuple[bool | None, Verdict]:
    """Zero over GF(p) is probable, non-zero only for independent generators; a ball proves non-zero only."""
    if "balls" in engines:
        if excludes_zero(ring, node, positive):
            return False, "proved"
        return (True, "numeric") if _has_value(ring, node, positive) else (None, "undecided")
    zero = _zero_at_points(ring, node)
    if zero:
        return True, "probable"
    return (False, "probable") if zero is False and independent_generators(ring) else (None, "undecided")


def certainly_nonzero(e: Expr, positive: frozenset[Expr]) -> bool:
    """A ball at some real point excludes 0 as the value of an expression."""
    ring = Ring([e], positive)
    return excludes_zero(ring, ring.node(e), positive)


def excludes_zero(ring: Ring, node: int, positive: frozenset[Expr]) -> bool:
    """A ball at some real point excludes 0 as the value of a node."""
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
    """Zero at so many random points over GF(p)? None where too few were found."""
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
