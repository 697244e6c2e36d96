"""From a relation as written to what it says: finite, Pfaffian, nonlinear in velocities, or an inequality.

Factors that never vanish are taken out, powers and sums of squares are replaced by what they force over
the reals, products become branches. What was done is said in ``notes``.

Differentials are read through dq = qdot dt: a relation homogeneous of degree k in (dq, dt) is divided by dt^k.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product as cartesian

from dofkit.base.errors import TextError
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.differentials import SOLVE_FOR_IT, accelerations_of, cleared, in_velocities
from dofkit.expressions.terms import Combined, combined, without_cancelled
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.exact_zeros import SOLE_NOTE, sole_zero
from dofkit.relations.normal.linear_branches import linear_branches, squares_compared, without_arctangent
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.notes import (
    COMPARED_NOTE,
    NOWHERE_NOTE,
    QUADRATIC_NOTE,
    REGION_NOTE,
    SQUARED_NOTE,
    UNDONE_NOTE,
)
from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian, Piece, with_constants
from dofkit.relations.normal.polynomial_zeros import Conjunction
from dofkit.relations.normal.signs import (
    arguments_of,
    by_signs,
    holds_on_a_region,
    squared,
    up_to_a_number,
    with_absolute_values,
)
from dofkit.relations.normal.zero_set import zero_set


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

    Raises TextError for accelerations (they are integrated before) and for sums of differentials with finite terms.
    """
    if accelerations_of(e):
        raise TextError(
            "an equation with a second derivative is not a constraint on positions or velocities", hint=SOLVE_FOR_IT
        )
    fewer = combined(e) if written else Combined(e, {})
    found = _normalised(fewer.expr, positive, written)
    if not fewer.sums:
        return found
    return found._replace(branches=tuple(tuple(with_constants(p, fewer.sums) for p in b) for b in found.branches))


def _normalised(e: Expr, positive: frozenset[Expr], written: bool) -> Normal:
    velocity_form, divided = in_velocities(e)
    if not velocities_of(velocity_form):
        if divided:
            return Normal(((Pfaffian({}, velocity_form),),))
        return _finite(velocity_form, positive, written)
    form = linear_form(cleared(velocity_form))
    if form is not None and not (form.coefficients or divided):
        return _finite(form.dt, positive, written)
    if form is not None and (form.coefficients or not form.dt.is_zero):
        return Normal(((form,),))
    plain = without_cancelled(velocity_form)
    if plain != velocity_form:
        return _normalised(plain, positive, written)
    return _defined(velocity_form, _nonlinear(velocity_form, positive), positive)


def _defined(e: Expr, normal: Normal, positive: frozenset[Expr]) -> Normal:
    """What a relation in velocities says where, as it was written, it has a value at a configuration."""
    if normal.branches == ((Nonlinear(e),),):
        return normal
    within = [c for c in conditions_of(e, positive) if not velocities_of(c.expr)]
    if within and no_solution((), positive, [c.expr for c in within if c.sense != "!="]):
        return Normal((), (NOWHERE_NOTE,))
    return normal._replace(branches=tuple((*b, *(c for c in within if c not in b)) for b in normal.branches))


def _finite(e: Expr, positive: frozenset[Expr], written: bool) -> Normal:
    if not written:
        return Normal(((Finite(e),),))
    folded = with_absolute_values(e, positive)
    if holds_on_a_region(folded, positive):
        return _by_signs(folded, positive)
    value = sole_zero(folded)
    if value is not None:
        (s,) = e.symbols
        return Normal(((Finite(s - value),),), (SOLE_NOTE,))
    branches, notes = zero_set(e, positive, _moving(e))
    if branches == ((e,),):
        return _squared(e, positive)
    return _conditioned(e, branches, notes, positive)


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] in ("coordinate", "time"))


def _conditioned(
    e: Expr, branches: Sequence[Conjunction], notes: Sequence[str], positive: frozenset[Expr], *more: DomainCondition
) -> Normal:
    """The branches of a relation that was rewritten, where it was one as written: ``e`` has a value there."""
    conditions = (*conditions_of(e, positive), *more)
    if any(c.sense != "!=" for c in conditions) and no_solution(
        (), positive, [c.expr for c in conditions if c.sense != "!="]
    ):
        return Normal((), (NOWHERE_NOTE,))
    return Normal(tuple((*map(Finite, branch), *conditions) for branch in branches), tuple(notes))


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
    found = squared(e, positive)
    if found is not None:
        norm, condition = found
        branches, notes = zero_set(norm, positive, _moving(norm))
        if notes:
            return _conditioned(e, branches, (SQUARED_NOTE, *notes), positive, condition)
    return Normal(((Finite(e),),))


def _nonlinear(e: Expr, positive: frozenset[Expr]) -> Normal:
    """What a relation nonlinear in the velocities says, by its factors; one with velocities in abs() stays whole."""
    polynomial = squares_compared(e, velocities_of(e), positive)
    if polynomial is not None and polynomial != e:
        return _with_note(normalise(polynomial, positive, True), COMPARED_NOTE)
    if any(velocities_of(u) for u in arguments_of(e)):
        return Normal(((Nonlinear(e),),))
    moving = frozenset(s for s in e.symbols if s.args[0] in ("velocity", "coordinate", "time"))
    branches, notes = zero_set(e, positive, moving)
    found: list[tuple[Piece, ...]] = []
    said = list(notes)
    for branch in branches:
        told = [_velocity_pieces(g, positive) for g in branch]
        said += [note for _, note in told if note]
        found += [tuple(p for part in choice for p in part) for choice in cartesian(*(pieces for pieces, _ in told))]
    return Normal(tuple(found), tuple(dict.fromkeys(said)))


def _with_note(normal: Normal, note: str) -> Normal:
    return normal._replace(notes=tuple(dict.fromkeys((note, *normal.notes))))


def _velocity_pieces(e: Expr, positive: frozenset[Expr]) -> tuple[list[tuple[Piece, ...]], str]:
    """The branches of one irreducible relation in velocities, and what was done."""
    velocities = velocities_of(e)
    if not velocities:
        return [(Finite(e),)], ""
    form = linear_form(e)
    if form is not None:
        return [(form if form.coefficients else Finite(form.dt),)], ""
    undone = without_arctangent(e, velocities, positive)
    if undone is not None:
        return [(*b, *undone[1]) for b in normalise(undone[0], positive, True).branches], UNDONE_NOTE
    found = linear_branches(e, velocities, positive)
    if found is None:
        return [(Nonlinear(e),)], ""
    return [(*map(_linear_piece, b.relations), *b.conditions) for b in found], QUADRATIC_NOTE


def _linear_piece(e: Expr) -> Finite | Pfaffian:
    """What an expression linear in the velocities, or free of them, says."""
    form = linear_form(e)
    return Finite(e) if form is None or not form.coefficients else form
