"""The normal form of a relation: branches of pieces that are finite, Pfaffian or nonlinear in the velocities.

Factors that never vanish are removed, powers and sums of squares are replaced by equations with the same real
solutions, products become branches. The ``notes`` of a `Normal` say what was done.

Differentials are written dq = qdot dt: a relation homogeneous of degree k in (dq, dt) is divided by dt^k.
"""

from __future__ import annotations

from collections.abc import Sequence
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
    """Return the branches of ``e = 0`` if ``e`` is quadratic in the velocities and splits into linear factors.

    A branch consists of expressions linear in the velocities, or free of them, that vanish together. None if it is not
    known to split. The numerator of ``e`` is split: the denominator is not 0 where ``e`` has a value.
    """
    canon, [(numerator, _)] = quotients_of([e], positive)
    generators = canon.ring.var_expr
    moving = {i for i, e in enumerate(generators) if any(s.args[0] == "velocity" for s in e.symbols)}
    terms = canon.collected(numerator, moving)
    if any(sum(k for _, k in m) > 2 or any(generators[i] not in velocities for i, _ in m) for m in terms):
        return None
    squares = (_completed(canon, numerator, i, velocities, positive) for m in terms for i, k in m if k == 2)
    square = next((result for result in squares if result is not None), None)
    return None if square is None else _branches(square, positive)


def _completed(
    canon: Canon, form: Any, index: int, velocities: Sequence[Expr], positive: frozenset[Expr]
) -> _Square | None:
    """Complete the square of ``form`` = a v^2 + b v + c, v the velocity with generator ``index``: 4 a form = L^2 - D.

    L = 2 a v + b is ``slope``, 2 a is ``lead``, and D = b^2 - 4 a c (``discriminant``) is root^2 times ``radicand``;
    factors that L and the root have in common are removed. None if the root is not linear in the velocities, the
    radicand contains one, or the remaining factor of a may vanish.
    """
    place = len(canon.ring.vars) - 1 - index
    slope = form.derivative(place)
    lead = slope.derivative(place)
    discriminant = canon.reduce(slope * slope - 2 * lead * form)
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
    if any(not u.symbols.isdisjoint(velocities) for u in (square.radicand, *factors, *slopes)):
        return None
    nowhere = (never_vanishes(u, positive) if _varying(u) else not is_proved_zero(u, positive) for u in factors)
    return square if all(nowhere) else None  # parameters are generic


def _square_content(poly: Any) -> fmpq:
    """Return a rational r such that poly / r^2 has integer coefficients, with r^2 the content if that is a square."""
    coefficients = [Fraction(int(c.p), int(c.q)) for c in poly.to_dict().values()]
    below = lcm(*(c.denominator for c in coefficients))
    content = gcd(*(int(c * below) for c in coefficients)) * below
    is_square = content > 0 and isqrt(content) ** 2 == content
    return fmpq(isqrt(content) if is_square else 1, below)


def _branches(square: _Square, positive: frozenset[Expr]) -> list[Conjunction] | None:
    """Return the branches of linear^2 = radicand root^2; None if the radicand may have either sign."""
    linear, radicand, root, sign = square
    if sign == 1 or (sign == 0 and not _varying(radicand)):
        size = ex.sqrt(radicand) * root
        return [(linear - size,), (linear + size,)]
    if sign == 0:
        return None
    factors = [root, *([radicand] if _varying(radicand) else [])]
    return [(*zeros, linear) for factor in factors for zeros in zero_set(factor, positive, _varying(factor))[0]]


def _varying(e: Expr) -> frozenset[Expr]:
    """Return the symbols that are not parameters."""
    return frozenset(s for s in e.symbols if s.args[0] != "parameter")


def velocities_of(e: Expr) -> list[Expr]:
    """Return the velocity symbols of an expression, sorted by name."""
    return sorted((s for s in e.symbols if s.args[0] == "velocity"), key=lambda s: str(s.args[1]))


def linear_form(e: Expr) -> Pfaffian | None:
    """Return ``e`` as a one-form (without velocities: its ``dt`` only); None if it is not linear in velocities."""
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
    """Return the normal form of ``e = 0``; only ``written`` equations are reduced, those of joints are regular.

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
    return _restricted_to_domain(velocity_form, _nonlinear(velocity_form, positive), positive)


def _restricted_to_domain(e: Expr, normal: Normal, positive: frozenset[Expr], *more: DomainCondition) -> Normal:
    """Return a normal form with the conditions for a value of the original ``e``, and ``more``, in every branch."""
    if normal.branches == ((Nonlinear(e),),):  # the relation was not rewritten
        return normal
    within = (*(c for c in conditions_of(e, positive) if not velocities_of(c.expr)), *more)
    if no_solution((), positive, [c.expr for c in within if c.sense != "!="]):
        return Normal((), (NOWHERE_NOTE,))
    return normal._replace(branches=tuple((*b, *(c for c in within if c not in b)) for b in normal.branches))


def _finite_branches(branches: Sequence[Conjunction], *notes: str) -> Normal:
    return Normal(tuple(tuple(map(Finite, branch)) for branch in branches), notes)


def _finite(e: Expr, positive: frozenset[Expr], written: bool) -> Normal:
    """Return the normal form of a geometric equation: branches of its real zeros if ``written``, else e itself."""
    if not written:
        return Normal(((Finite(e),),))
    folded = with_absolute_values(e, positive)
    if holds_on_a_region(folded, positive):
        return _by_signs(folded, positive)
    branches, notes = zero_set(e, positive, _moving(e))
    if branches == ((e,),):
        return _squared(e, positive)
    return _restricted_to_domain(e, _finite_branches(branches, *notes), positive)


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] in ("coordinate", "time"))


def _by_signs(e: Expr, positive: frozenset[Expr]) -> Normal:
    """Return a branch for every choice of signs of absolute values, for a relation satisfied on a whole region."""
    always = conditions_of(e, positive)
    regions, others = list[tuple[DomainCondition, ...]](), list[tuple[Conjunction, tuple[DomainCondition, ...]]]()
    for signed, conditions in by_signs(e, arguments_of(e), positive):
        if is_proved_zero(signed, positive):
            regions.append(conditions)
        else:
            others += [(g, conditions) for g in zero_set(signed, positive, _moving(signed))[0]]
    boundaries = [up_to_a_number(c.expr) for region in regions if len(region) == 1 for c in region]
    branches: list[tuple[Piece, ...]] = [(*region, *always) for region in regions]
    for conjunction, conditions in others:
        if not any(up_to_a_number(g) in boundaries for g in conjunction):
            branches.append((*map(Finite, conjunction), *conditions, *always))
    return Normal(tuple(branches), (REGION_NOTE,))


def _squared(e: Expr, positive: frozenset[Expr]) -> Normal:
    """Return the normal form of a relation: one with one square root is squared if the square then simplifies."""
    result = squared(e, positive)
    if result is not None:
        norm, condition = result
        branches, notes = zero_set(norm, positive, _moving(norm))
        if notes:
            return _restricted_to_domain(e, _finite_branches(branches, SQUARED_NOTE, *notes), positive, condition)
    return Normal(((Finite(e),),))


def _nonlinear(e: Expr, positive: frozenset[Expr]) -> Normal:
    """Return the normal form of a relation nonlinear in velocities; with velocities in abs() it is not changed."""
    if any(velocities_of(u) for u in arguments_of(e)):
        return Normal(((Nonlinear(e),),))
    moving = frozenset(s for s in e.symbols if s.args[0] in ("velocity", "coordinate", "time"))
    branches, notes = zero_set(e, positive, moving)
    result: list[tuple[Piece, ...]] = []
    all_notes = list(notes)
    for branch in branches:
        splits = [_velocity_pieces(g, positive) for g in branch]
        all_notes += [note for _, note in splits if note]
        result += [tuple(p for part in choice for p in part) for choice in cartesian(*(pieces for pieces, _ in splits))]
    return Normal(tuple(result), tuple(dict.fromkeys(all_notes)))


def _velocity_pieces(e: Expr, positive: frozenset[Expr]) -> tuple[list[tuple[Piece, ...]], str]:
    """Return (the branches of one irreducible relation in velocities, a note on what was done or "")."""
    if linear_form(e) is not None:
        return [(_linear_piece(e),)], ""
    branches = linear_branches(e, velocities_of(e), positive)
    if branches is None:
        return [(Nonlinear(e),)], ""
    roots = [[c for g in b for c in conditions_of(g, positive) if not _varying(c.expr)] for b in branches]
    return [(*map(_linear_piece, b), *c) for b, c in zip(branches, roots, strict=True)], QUADRATIC_NOTE


def _linear_piece(e: Expr) -> Finite | Pfaffian:
    """Return the piece ``e`` = 0 for an expression linear in the velocities, or free of them."""
    form = linear_form(e)
    return Finite(e) if form is None or not form.coefficients else form
