"""The branches of a relation between velocities that are linear in them, where it is quadratic in the velocities.

Completing the square in a velocity v with the leading coefficient a gives 4 a e = L^2 - D with L = de/dv and the
discriminant D. Where D = r s^2, r free of velocities and s linear in them, e = 0 says L = sqrt(r) s or L = -sqrt(r) s
if r >= 0 everywhere, and L = 0 and s = 0 or r = 0 if r <= 0 everywhere. What has no such discriminant stays nonlinear, and
states of motion show whether the velocities that it allows are curved (`integrability.nonlinear_velocities`).
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
from dofkit.exact.zero.identity import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.polynomial_zeros import Conjunction
from dofkit.relations.normal.semidefinite import Signs, weak_sign
from dofkit.relations.normal.zero_set import never_vanishes, zero_set

#: A monomial in what depends on velocities: (generator, exponent) pairs.
Monomial = tuple[tuple[int, int], ...]


class _Square(NamedTuple):
    """``linear``^2 = ``radicand`` ``root``^2; ``sign`` of the radicand: 1 (>= 0), -1 (<= 0) or 0 (not known)."""

    linear: Expr
    radicand: Expr
    root: Expr
    sign: int


def linear_branches(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> list[Conjunction] | None:
    """Return the branches of ``e = 0``; None where it is not known to consist of branches linear in the velocities.

    A branch consists of expressions linear in the velocities, or free of them, that vanish together. The branches are
    those of the numerator of ``e``: its denominator vanishes nowhere that ``e`` has a value.
    """
    ring = Ring([e], positive)
    node = ring.node(e)
    try:
        canon = Canon(ring)
        whole = canon.quotient(node)[0]
        terms = _by_velocities(canon, whole)
        if any(sum(k for _, k in m) > 2 or any(ring.var_expr[i] not in velocities for i, _ in m) for m in terms):
            return None
        squares = (_completed(canon, whole, i, velocities, positive) for m in terms for i, k in m if k == 2)
        square = next((found for found in squares if found is not None), None)
    except NoValueError:
        return None
    return None if square is None else _branches(square, positive)


def _by_velocities(canon: Canon, polynomial: Any) -> dict[Monomial, Any]:
    """A polynomial as coefficients of the monomials in what depends on velocities."""
    n = len(canon.ring.vars)
    moves = [any(s.args[0] == "velocity" for s in e.symbols) for e in canon.ring.var_expr]
    coefficients: dict[Monomial, Any] = {}
    for exponents, coefficient in polynomial.to_dict().items():
        moving = tuple((n - 1 - i, int(k)) for i, k in enumerate(exponents) if k and moves[n - 1 - i])
        rest = tuple(0 if moves[n - 1 - i] else k for i, k in enumerate(exponents))
        term = canon.ctx.from_dict({rest: coefficient})
        coefficients[moving] = coefficients[moving] + term if moving in coefficients else term
    return coefficients


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


def _branches(square: _Square, positive: frozenset[Expr]) -> list[Conjunction] | None:
    """Return the branches of L^2 = r s^2; None where the sign of r depends on the configuration."""
    linear, radicand, root, sign = square
    if sign == 1 or (sign == 0 and not _moving(radicand)):
        size = ex.sqrt(radicand) * root
        return [(linear - size,), (linear + size,)]
    if sign == 0:
        return None
    factors = [root, *([radicand] if _moving(radicand) else [])]
    return [(*zeros, linear) for factor in factors for zeros in zero_set(factor, positive, _moving(factor))[0]]


def _has(e: Expr, symbols: Collection[Expr]) -> bool:
    return not e.symbols.isdisjoint(symbols)


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] != "parameter")


def _vanishes_nowhere(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether ``e`` is not 0 anywhere; parameters are generic."""
    return never_vanishes(e, positive) if _moving(e) else not is_proved_zero(e, positive)
