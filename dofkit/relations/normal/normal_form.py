"""From a relation as written to what it says: finite, Pfaffian, nonlinear in velocities, or an inequality.

Factors that never vanish are taken out, powers and sums of squares are replaced by what they force over
the reals, products become branches. What was done is said in ``notes``.

Differentials are read through dq = qdot dt: a relation homogeneous of degree k in (dq, dt) is divided by dt^k.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fractions import Fraction
from itertools import product as cartesian
from math import gcd, isqrt, lcm, prod
from typing import Any, NamedTuple

from flint import fmpq

from dofkit.exact.ring.canonical import Canon, divided, lowest_terms, quotients_of
from dofkit.exact.ring.program import none_without_value
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import cleared, diff, in_velocities, refuse_accelerations, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import (
    DomainCondition,
    arguments_of,
    by_signs,
    conditions_of,
    holds_on_a_region,
    squared,
    up_to_a_number,
    with_absolute_values,
)
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.pieces import (
    NOWHERE_NOTE,
    QUADRATIC_NOTE,
    REGION_NOTE,
    SQUARED_NOTE,
    Finite,
    Nonlinear,
    Normal,
    Pfaffian,
    Piece,
)
from dofkit.relations.normal.polynomial_zeros import Conjunction
from dofkit.relations.normal.semidefinite import Signs, weak_sign
from dofkit.relations.normal.zero_set import never_vanishes, zero_set


class _Square(NamedTuple):
    """``linear``^2 = ``radicand`` ``root``^2; ``sign`` of the radicand: 1 (>= 0), -1 (<= 0) or 0 (not known)."""

    linear: Expr
    radicand: Expr
    root: Expr
    sign: int


@none_without_value
def linear_branches(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> list[Conjunction] | None:
    """Return the branches of ``e = 0``; None where it is not known to consist of branches linear in the velocities.

    A branch consists of expressions linear in the velocities, or free of them, that vanish together. The branches are
    those of the numerator of ``e``: its denominator vanishes nowhere that ``e`` has a value.
    """
    canon, [(whole, _)] = quotients_of([e], positive)
    generators = canon.ring.var_expr
    moving = {i for i, e in enumerate(generators) if any(s.args[0] == "velocity" for s in e.symbols)}
    terms = canon.collected(whole, moving)
    if any(sum(k for _, k in m) > 2 or any(generators[i] not in velocities for i, _ in m) for m in terms):
        return None
    squares = (_completed(canon, whole, i, velocities, positive) for m in terms for i, k in m if k == 2)
    square = next((result for result in squares if result is not None), None)
    return None if square is None else _branches(square, positive)


def _completed(
    canon: Canon, whole: Any, index: int, velocities: Sequence[Expr], positive: frozenset[Expr]
) -> _Square | None:
    """Complete the square: ``whole`` = a v^2 + b v + c in the velocity v of number ``index`` is 4 a whole = L^2 - D.

    L = 2 a v + b is ``slope``, 2 a is ``lead``, and D = b^2 - 4 a c (``discriminant``) is root^2 times ``radicand``;
    factors that L and the root have in common are taken out.
    None where D is no square of an expression linear in the velocities, or what is left of a may vanish.
    """
    place = len(canon.ring.vars) - 1 - index
    slope = whole.derivative(place)
    lead = slope.derivative(place)
    discriminant = canon.reduce(slope * slope - 2 * lead * whole)
    content = canon.unit * _square_content(discriminant)
    root = prod((f ** (k // 2) for f, k in canon.factors(discriminant)), start=content)
    radicand = divided(discriminant, root * root)
    common = slope.gcd(root)
    remaining, under = lowest_terms(lead, common * common)
    linear, single = divided(slope, common), divided(root, common)
    sign = weak_sign(canon, Signs(canon, positive), radicand)
    square = _Square(canon.to_expr(linear), canon.to_expr(radicand), canon.to_expr(single), sign)
    factors = [canon.to_expr(remaining), canon.to_expr(under)]
    slopes = [diff(square.root, v) for v in velocities]
    if any(_has(u, velocities) for u in (square.radicand, *factors, *slopes)):
        return None
    nowhere = (never_vanishes(u, positive) if _varying(u) else not is_proved_zero(u, positive) for u in factors)
    return square if all(nowhere) else None  # parameters are generic


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
    if sign == 1 or (sign == 0 and not _varying(radicand)):
        size = ex.sqrt(radicand) * root
        return [(linear - size,), (linear + size,)]
    if sign == 0:
        return None
    factors = [root, *([radicand] if _varying(radicand) else [])]
    return [(*zeros, linear) for factor in factors for zeros in zero_set(factor, positive, _varying(factor))[0]]


def _has(e: Expr, symbols: Collection[Expr]) -> bool:
    return not e.symbols.isdisjoint(symbols)


def _varying(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] != "parameter")


def velocities_of(e: Expr) -> list[Expr]:
    """The velocity symbols of an expression, by name."""
    return sorted((s for s in e.symbols if s.args[0] == "velocity"), key=lambda s: str(s.args[1]))


def linear_form(e: Expr) -> Pfaffian | None:
    """``e`` as a form linear in the velocities as written, else None."""
    coefficients = {}
    velocities = velocities_of(e)
    for v in velocities:
        coefficient = diff(e, v)
        if any(s.args[0] == "velocity" for s in coefficient.symbols):
            return None
        if not coefficient.is_zero:
            coefficients[str(v.args[1])] = coefficient
    return Pfaffian(coefficients, substitute(e, dict.fromkeys(velocities, ex.ZERO)))


def normalise(e: Expr, positive: frozenset[Expr], written: bool) -> Normal:
    """What ``e = 0`` says; ``written`` equations are reduced over the reals, those of joints are regular as they are.

    Raises TextError for second derivatives and for sums of differentials with finite terms.
    """
    refuse_accelerations(e)
    velocity_form, divided = in_velocities(e)
    if not velocities_of(velocity_form):
        if divided:
            return Normal(((Pfaffian({}, velocity_form),),))
        return _finite(velocity_form, positive, written)
    form = linear_form(cleared(velocity_form))
    if form is not None and not (form.coefficients or divided):
        return _finite(form.dt, positive, written)
    if form is not None and form.coefficients:
        return Normal(((form,),))
    return _defined(velocity_form, _nonlinear(velocity_form, positive), positive)


def _defined(e: Expr, normal: Normal, positive: frozenset[Expr], *more: DomainCondition) -> Normal:
    """What a rewritten relation says where, as it was written, ``e``, it has a value at a configuration."""
    if normal.branches == ((Nonlinear(e),),):
        return normal
    within = (*(c for c in conditions_of(e, positive) if not velocities_of(c.expr)), *more)
    if no_solution((), positive, [c.expr for c in within if c.sense != "!="]):
        return Normal((), (NOWHERE_NOTE,))
    return normal._replace(branches=tuple((*b, *(c for c in within if c not in b)) for b in normal.branches))


def _finite_branches(branches: Sequence[Conjunction], *notes: str) -> Normal:
    return Normal(tuple(tuple(map(Finite, branch)) for branch in branches), notes)


def _finite(e: Expr, positive: frozenset[Expr], written: bool) -> Normal:
    """Return what e = 0 says of positions: branches of its real zero set if ``written``, else e itself."""
    if not written:
        return Normal(((Finite(e),),))
    folded = with_absolute_values(e, positive)
    if holds_on_a_region(folded, positive):
        return _by_signs(folded, positive)
    branches, notes = zero_set(e, positive, _moving(e))
    if branches == ((e,),):
        return _squared(e, positive)
    return _defined(e, _finite_branches(branches, *notes), positive)


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] in ("coordinate", "time"))


def _by_signs(e: Expr, positive: frozenset[Expr]) -> Normal:
    """A relation that holds on a whole region for some signs: every choice of signs is a branch of its own."""
    always = conditions_of(e, positive)
    regions, others = list[tuple[DomainCondition, ...]](), list[tuple[Conjunction, tuple[DomainCondition, ...]]]()
    for signed, conditions in by_signs(e, arguments_of(e), positive):
        if is_proved_zero(signed, positive):
            regions.append(conditions)
        else:
            others += [(g, conditions) for g in zero_set(signed, positive, _moving(signed))[0]]
    edges = [up_to_a_number(c.expr) for region in regions if len(region) == 1 for c in region]
    branches: list[tuple[Piece, ...]] = [(*region, *always) for region in regions]
    for conjunction, conditions in others:
        if not any(up_to_a_number(g) in edges for g in conjunction):
            branches.append((*map(Finite, conjunction), *conditions, *always))
    return Normal(tuple(branches), (REGION_NOTE,))


def _squared(e: Expr, positive: frozenset[Expr]) -> Normal:
    """A relation with one square root, squared where that shows more than a single regular relation."""
    result = squared(e, positive)
    if result is not None:
        norm, condition = result
        branches, notes = zero_set(norm, positive, _moving(norm))
        if notes:
            return _defined(e, _finite_branches(branches, SQUARED_NOTE, *notes), positive, condition)
    return Normal(((Finite(e),),))


def _nonlinear(e: Expr, positive: frozenset[Expr]) -> Normal:
    """The normal form of a relation nonlinear in velocities, by factors; one with velocities in abs() stays whole."""
    if any(velocities_of(u) for u in arguments_of(e)):
        return Normal(((Nonlinear(e),),))
    moving = frozenset(s for s in e.symbols if s.args[0] in ("velocity", "coordinate", "time"))
    branches, notes = zero_set(e, positive, moving)
    result: list[tuple[Piece, ...]] = []
    said = list(notes)
    for branch in branches:
        answer = [_velocity_pieces(g, positive) for g in branch]
        said += [note for _, note in answer if note]
        result += [tuple(p for part in choice for p in part) for choice in cartesian(*(pieces for pieces, _ in answer))]
    return Normal(tuple(result), tuple(dict.fromkeys(said)))


def _velocity_pieces(e: Expr, positive: frozenset[Expr]) -> tuple[list[tuple[Piece, ...]], str]:
    """The branches of one irreducible relation in velocities, and what was done."""
    if linear_form(e) is not None:
        return [(_linear_piece(e),)], ""
    branches = linear_branches(e, velocities_of(e), positive)
    if branches is None:
        return [(Nonlinear(e),)], ""
    roots = [[c for g in b for c in conditions_of(g, positive) if not _varying(c.expr)] for b in branches]
    return [(*map(_linear_piece, b), *c) for b, c in zip(branches, roots, strict=True)], QUADRATIC_NOTE


def _linear_piece(e: Expr) -> Finite | Pfaffian:
    """What an expression linear in the velocities, or free of them, says."""
    form = linear_form(e)
    return Finite(e) if form is None or not form.coefficients else form
