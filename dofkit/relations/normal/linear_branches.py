"""The branches of a relation between velocities that are linear in them, where it is quadratic in the velocities.

Completing the square in a velocity v with the leading coefficient a gives 4 a e = L^2 - D with L = de/dv and the
discriminant D. Where D = r s^2, r free of velocities and s linear in them, e = 0 says L = sqrt(r) s or L = -sqrt(r) s
where r >= 0, and L = s = 0 where r < 0. What has no such discriminant stays nonlinear, and states of motion show
whether the velocities that it allows are curved (`integrability.nonlinear_velocities`).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fractions import Fraction
from math import gcd, isqrt, lcm, prod
from typing import Any, NamedTuple

from flint import fmpq

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, divided, lowest_terms
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.elimination import by_velocities
from dofkit.relations.normal.semidefinite import Signs, weak_sign
from dofkit.relations.normal.zero_set import never_vanishes, sign_as_written, zero_set


class LinearBranch(NamedTuple):
    """Expressions linear in the velocities, or free of them, that vanish together where ``conditions`` hold."""

    relations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...] = ()


class _Square(NamedTuple):
    """``linear``^2 = ``radicand`` ``root``^2; ``sign`` of the radicand: 1 (>= 0), -1 (<= 0) or 0 (not known)."""

    linear: Expr
    radicand: Expr
    root: Expr
    sign: int


def linear_branches(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> list[LinearBranch] | None:
    """Return the branches of ``e = 0``; None where it is not known to consist of branches linear in the velocities.

    They are those of the numerator of ``e``: what is below it vanishes nowhere that ``e`` has a value.
    """
    ring = Ring([e], positive)
    node = ring.node(e)
    try:
        canon = Canon(ring)
        whole = canon.quotient(node)[0]
        terms = by_velocities(canon, whole)
        if any(sum(k for _, k in m) > 2 or any(ring.var_expr[i] not in velocities for i, _ in m) for m in terms):
            return None
        squares = (_completed(canon, whole, i, velocities, positive) for m in terms for i, k in m if k == 2)
        square = next((found for found in squares if found is not None), None)
    except NoValueError:
        return None
    return None if square is None else _branches(square, positive)


def _completed(
    canon: Canon, whole: Any, index: int, velocities: Sequence[Expr], positive: frozenset[Expr]
) -> _Square | None:
    """Return 4 a e = L^2 - D less the common factors of L and D, for the velocity of a generator.

    None where D is no square of an expression linear in the velocities, or what is left of a may vanish.
    """
    place = len(canon.ring.vars) - 1 - index
    slope = whole.derivative(place)
    lead = slope.derivative(place)
    discriminant = canon.reduce(slope * slope - 2 * lead * whole)
    content = canon.one * _square_content(discriminant)
    root = prod((f ** (k // 2) for f, k in canon.factors(discriminant)), start=content)
    radicand = divided(discriminant, root * root)
    common = slope.gcd(root)
    left, under = lowest_terms(lead, common * common)
    linear, single = divided(slope, common), divided(root, common)
    sign = weak_sign(canon, Signs(canon, positive), radicand)
    square = _Square(canon.to_expr(linear), canon.to_expr(radicand), canon.to_expr(single), sign)
    factors = [canon.to_expr(left), canon.to_expr(under)]
    slopes = [diff(square.root, v) for v in velocities]
    if any(_has(u, velocities) for u in (square.radicand, *factors, *slopes)):
        return None
    return square if all(_vanishes_nowhere(u, positive) for u in factors) else None


def _square_content(poly: Any) -> fmpq:
    """Return a rational number whose square, divided out of a polynomial, leaves integer coefficients."""
    coefficients = [Fraction(int(c.p), int(c.q)) for c in poly.to_dict().values()]
    below = lcm(*(c.denominator for c in coefficients))
    whole = gcd(*(int(c * below) for c in coefficients)) * below
    is_square = whole > 0 and isqrt(whole) ** 2 == whole
    return fmpq(isqrt(whole) if is_square else 1, below)


def _branches(square: _Square, positive: frozenset[Expr]) -> list[LinearBranch]:
    """Return the branches of L^2 = r s^2."""
    linear, radicand, root, sign = square
    size, moving = ex.sqrt(radicand) * root, _moving(radicand)
    lines = [LinearBranch((linear - size,)), LinearBranch((linear + size,))]
    if sign == 1 or (sign == 0 and not moving):
        return lines
    both = [LinearBranch((*zero, linear)) for zero in zero_set(root, positive, _moving(root))[0]]
    edges = [LinearBranch((*zero, linear)) for zero in zero_set(radicand, positive, moving)[0]] if moving else []
    if sign == -1:
        return [*both, *edges]
    inside = DomainCondition(radicand, ">" if edges else ">=", bool(edges))
    outside = DomainCondition(-radicand, ">")
    within = [b._replace(conditions=(inside,)) for b in lines]
    return [*within, *(b._replace(conditions=(outside,)) for b in both), *edges]


def squares_compared(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> Expr | None:
    """Return f^2 - g^2 for f - g = 0 with roots and absolute values f, g >= 0 as written; None for anything else."""
    terms = e.args if e.op == "add" else ()
    if len(terms) != 2 or {sign_as_written(term, positive) for term in terms} != {1, -1}:
        return None
    moving = [t for t in terms if _has(t, velocities)]
    if not any(_is_rooted(f) and _has(f, velocities) for t in moving for f in _factors(t)):
        return None
    implied = _radicand(moving[0], positive) if len(moving) == 1 else None
    if any(_has(c.expr, velocities) and c.expr != implied for c in conditions_of(e, positive)):
        return None
    difference = terms[0] * terms[0] - terms[1] * terms[1]
    ring = Ring([difference], positive)
    node = ring.node(difference)
    try:
        canon = Canon(ring)
        return canon.to_expr(canon.quotient(node)[0])
    except NoValueError:
        return None


def without_arctangent(
    e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]
) -> tuple[Expr, tuple[DomainCondition, ...]] | None:
    """Return u - tan(w) and that -pi/2 < w < pi/2 for atan(u) = w, w free of velocities; None for anything else."""
    terms = [t for t in (e.args if e.op == "add" else (e,)) if _has(t, velocities)]
    number, inner = terms[0].args if terms[0].op == "mul" and len(terms[0].args) == 2 else (ex.ONE, terms[0])
    if len(terms) > 1 or number.op != "num" or inner.op != "fn" or inner.args[0] != "atan":
        return None
    w = (terms[0] - e) / number
    within = DomainCondition(ex.PI * ex.PI / 4 - w * w, ">")
    return inner.args[1] - ex.fn("tan", w), (within, *conditions_of(w, positive))


def _radicand(term: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return u of k sqrt(u) with a positive constant k: k^2 u = g^2 implies u >= 0."""
    roots = [f for f in _factors(term) if f.op != "num" and f.op != "const" and f not in positive]
    only = roots[0] if len(roots) == 1 else None
    return only.args[0] if only is not None and only.op == "pow" and only.args[1] == ex.HALF else None


def _factors(term: Expr) -> Sequence[Expr]:
    return term.args if term.op == "mul" else (term,)


def _is_rooted(e: Expr) -> bool:
    """Return whether an expression is an absolute value or a power that is no polynomial."""
    if e.op == "pow":
        return e.args[1].op == "num" and bool(e.args[1].args[0].denominator > 1)
    return e.op == "fn" and e.args[0] == "abs"


def _has(e: Expr, symbols: Collection[Expr]) -> bool:
    return not e.symbols.isdisjoint(symbols)


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] != "parameter")


def _vanishes_nowhere(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether ``e`` is not 0 anywhere; parameters are generic."""
    return never_vanishes(e, positive) if _moving(e) else not is_proved_zero(e, positive)
