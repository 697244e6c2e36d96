"""The answer for one block: its freedom, its hidden relations, and which of its rows are integrable."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dofkit.base.verdicts import VERDICTS, least, weakest
from dofkit.classification.freedom.bridged_blocks import bridged_answer
from dofkit.classification.freedom.preparation import passes_reference
from dofkit.configuration import distance_geometry
from dofkit.configuration.at_reference import at_reference, near_reference
from dofkit.configuration.components import is_graph, is_irreducible
from dofkit.configuration.finite_blocks import finite_answer
from dofkit.configuration.linear_blocks import eliminated
from dofkit.configuration.search import LEVEL, find, level_angle
from dofkit.configuration.variety import Variety, all_configurations, is_unconstrained, of_real_point
from dofkit.exact.matrices.sparse import echelon
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.ring.program import NoPointError
from dofkit.exact.zero import BALLS, BOTH, independent_generators, odd_constants
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import SampledSpan, on_the_same_part, span_at
from dofkit.integrability.nonlinear_velocities import set_velocity_freedom
from dofkit.integrability.pfaffian_system import (
    Codistribution,
    codistribution,
    confinements,
    first_order_freedom,
    prolong,
)
from dofkit.integrability.row_labels import (
    ball_labels,
    field_labels,
    is_exceptional,
    reference_points,
    set_at_reference,
    span_at_reference,
)
from dofkit.mobility.general_position import framework_answer
from dofkit.relations.answer import Answer, Size
from dofkit.relations.blocks import Block, is_measured
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting

RELATED = "the functions or numbers that occur may satisfy an identity that arithmetic modulo primes does not detect"
#: Bound on the rounds of prolongation, each of which adds hidden geometric equations.
MAX_ROUNDS = 12
#: Bound on the branches of the hidden relations of one round.
MAX_HIDDEN_BRANCHES = 12
MANY_BRANCHES = (
    f"hidden relations have more than {MAX_HIDDEN_BRANCHES} branches, so the branch of largest dimension is not known"
)
HIDDEN_BRANCHES = (
    "the hidden relations are satisfied on several branches; the degrees of freedom and the hidden equations are those "
    "of the largest one (through the reference configuration, if there is one)"
)
IRREGULAR = (
    "the reference configuration is not a regular point of the forms, and other configurations may lie "
    "on another component of the set that the geometric equations define"
)
MEASURED = (
    "measured equations occur together with differential ones; whether these integrate was not decided "
    "within the tolerance"
)
ONE_COMPONENT = "no motion is possible on one component of the set of geometric equations; others were not examined"
APART = "real configurations were found only on components other than those of the points over GF(p)"


def answer(block: Block, setting: Setting) -> Answer:
    """Return the answer for one block, with the size of the model."""
    bridged = bridged_answer(block, setting, answer) if setting.bridges else None
    if bridged is not None:
        return bridged
    result = _engines(block, setting)
    is_generic = result.dof is not None and setting.reference is None
    level = level_angle(block, setting) if setting.tilts and is_generic else None
    if level is not None:
        reasons = [*result.reasons, LEVEL.format(level)]
        result = replace(result, dof=None, velocity_dof=None, growth=None, verdict="undecided", reasons=reasons)
    differential = bool(block.forms or block.nonlinear)
    model_size = Size(len(block.coordinates), len(block.finite), len(block.rows) if differential else 0)
    return replace(result, size=model_size)


def _engines(block: Block, setting: Setting) -> Answer:
    """Return the answer of the cheapest sound method; if functions may be related, balls have to confirm it."""
    if setting.links and setting.engines == BOTH:
        framework = framework_answer(block, setting)
        if framework is not None:
            return framework
    if setting.distances and setting.engines == BOTH:
        unmet = distance_geometry.lengths_unmet(block, setting)
        if unmet is not None:
            return unmet
    balls_only = replace(setting, engines=BALLS, grows=False, flag=False)
    try:
        result = _answer(block, setting)
    except NoPointError:
        if setting.engines != BOTH:
            raise
        balls = _answer(block, balls_only)
        return replace(balls, verdict=weakest(balls.verdict, "numeric"), growth=None, derived=None)
    if result.doubt and setting.engines == BOTH and setting.tolerance is None:
        return _confirmed_by_balls(result, _answer(block, balls_only))
    return result


def _confirmed_by_balls(field: Answer, balls: Answer) -> Answer:
    """Return the answer over GF(p) if the answer by balls is the same; otherwise an undecided one.

    Over GF(p) an expression that is 0 by an unknown identity may not be 0, and a nested root may be its conjugate;
    balls take an expression for 0 only if it is smaller than their precision.
    """
    if (
        field.consistent is not True
        and balls.consistent is not True
        and not (field.consistent is False and field.matrix)
    ):
        return field
    if field.consistent is True and balls.consistent is True and _is_same(field, balls):
        return field
    reasons = [*field.reasons, RELATED]
    return Answer(
        None, verdict="undecided", reasons=reasons, hidden=field.hidden, doubt=field.doubt, method=field.method
    )


def _is_same(a: Answer, b: Answer) -> bool:
    """Return whether two answers agree in freedoms, labels, hidden equations and independent rows."""
    numbers = a.dof is not None and (a.dof, a.velocity_dof, a.instantaneous) == (b.dof, b.velocity_dof, b.instantaneous)
    labels = all(label.holonomic == b.labels[i].holonomic for i, label in a.labels.items() if i in b.labels)
    return (
        numbers
        and labels
        and a.hidden == b.hidden
        and echelon(a.matrix, a.modulus).independent == echelon(b.matrix, b.modulus).independent
    )


def _answer(block: Block, setting: Setting) -> Answer:
    """Return the answer by the engines of the setting, for geometric equations only or with differential ones."""
    if not block.forms and not block.nonlinear:
        of_linear = eliminated(block, setting) if setting.reference is None else None
        finite = finite_answer(block, setting) if of_linear is None else of_linear
        finite.derived = None if finite.dof is None else (len(block.coordinates) - finite.dof,)
        return finite
    return _mixed_answer(block, setting)


def _mixed_answer(block: Block, setting: Setting) -> Answer:
    """Return the answer of a block with differential relations."""
    if block.finite and is_measured(block, setting):
        return Answer(None, verdict="undecided", reasons=[MEASURED])
    result = _prolonged(block, setting, Answer())
    if setting.reference is not None and (not result.hidden or _passes_reference(block, result.hidden, setting)):
        if not block.nonlinear:
            answers = first_order_freedom(block, setting, setting.reference)
            result.instantaneous, result.first_order_sure = answers
        result.verdict = weakest(result.verdict, "numeric" if is_measured(block, setting) else "proved")
    return result


def _prolonged(block: Block, setting: Setting, result: Answer, relations: Sequence[Expr] = ()) -> Answer:
    """Return the answer, of the largest branch, after adding the hidden relations that the rows imply, in rounds."""
    extra = list(relations)
    for _ in range(MAX_ROUNDS):
        forms = codistribution(block, setting, extra)
        result.doubt = result.doubt or not independent_generators(forms.chart.ring)
        points = _points(forms, setting)
        result.reasons = list(points.reasons)
        if not points.consistent or (not points.samples and points.real is None):
            return _without_points(result, points, extra)
        new = confinements(forms, points)
        if new is None:  # no further hidden relation
            answered = _with_spans(block, forms, points, extra, setting)
            return replace(answered, doubt=result.doubt, about=least(result.about, answered.about))
        result.about = least(result.about, points.about)
        outcome = prolong(new, setting)
        if outcome is None or (len(outcome) > MAX_HIDDEN_BRANCHES and len(extra) < MAX_ROUNDS):
            return Answer(None, verdict="undecided", hidden=extra, reasons=[MANY_BRANCHES])
        if not outcome:
            result.reasons.append("the constraints allow no motion through an interval of time")
            return _without_points(result, Variety(False, None, "probable", argument="time fixed"), extra)
        if len(outcome) > 1 and len(extra) < MAX_ROUNDS:
            hidden = [[*extra, *branch] for branch in outcome]
            through = [h for h in hidden if setting.reference and _passes_reference(block, h, setting)]
            for choices in (through, hidden):
                alternatives = [_prolonged(block, setting, Answer(about=result.about), h) for h in choices]
                if any(a.consistent is not False for a in alternatives):
                    break
            return _of_hidden_branches(alternatives)
        fresh = [g for g in outcome[0] if g not in extra]
        if not fresh:
            break
        extra += fresh
    result.verdict, result.consistent = "undecided", None
    result.reasons.append("the motion is confined to a locus for which no equations could be written")
    return result


def _without_points(result: Answer, points: Variety, hidden: list[Expr]) -> Answer:
    """Return the result without points; relations are ``hidden`` by a rank at points, on their component only."""
    if points.consistent is False and result.about != "everywhere":
        return Answer(None, verdict="undecided", hidden=hidden, reasons=[*result.reasons, ONE_COMPONENT])
    if hidden:
        points = replace(points, verdict=weakest(points.verdict, "probable"), argument="time fixed")
    return replace(
        result, consistent=points.consistent, verdict=points.verdict, argument=points.argument, hidden=hidden
    )


def _passes_reference(block: Block, hidden: Sequence[Expr], setting: Setting) -> bool:
    """Return whether the reference configuration satisfies a block's geometric equations and the hidden ones."""
    return passes_reference([*(row.piece for row in block.finite), *map(Finite, hidden)], setting)


def _of_hidden_branches(alternatives: Sequence[Answer]) -> Answer:
    """Return the answer of the branch of largest dimension, with the claim restricted to a component."""
    best = max(alternatives, key=_largest)
    if best.dof is None:
        return best
    possible = [h for a in alternatives if a.consistent is not False for h in a.hidden_branches or [a.hidden]]
    return replace(best, about="component", reasons=[*best.reasons, HIDDEN_BRANCHES], hidden_branches=possible)


def _points(forms: Codistribution, setting: Setting) -> Variety:
    """Return generic points for the forms; with a reference, undecided if the set is not known to be regular there."""
    reference, by_field = setting.reference, "field" in forms.chart.setting.engines
    points = reference_points(forms, reference) if reference is not None and by_field else None
    if points is None and reference is not None and by_field:
        why = RELATED if odd_constants(forms.chart.ring, named=True) else IRREGULAR
        return Variety(None, None, "undecided", reasons=[why])
    if is_unconstrained(forms.chart):
        return all_configurations(forms.chart)
    alike = is_irreducible(forms.chart) if reference is None else is_graph(forms.chart)
    if reference is None or alike or points == []:
        result = find(forms.chart, setting.pose)
        return result if alike else replace(result, about="component")
    here = at_reference(forms.chart, reference) if points else None
    if here is None or here.local.dimension != forms.n - here.rank:
        return Variety(None, None, "undecided", reasons=[IRREGULAR])
    if here.local.verdict != "numeric" and is_irreducible(forms.chart):
        return find(forms.chart, setting.pose)
    near = next(near_reference(forms.chart, here.rank), None)
    if near is None:
        return Variety(None, None, "undecided", reasons=[IRREGULAR])
    verdict, dimension = here.local.verdict, here.local.dimension
    return Variety(True, dimension, verdict, real=near, about="reference", argument="regular point")


def _largest(a: Answer) -> tuple[int, int, int]:
    """Return a key by which answers are compared: consistency, freedom, velocity freedom, or uncertainty."""
    doubt = VERDICTS.index(a.verdict) if a.consistent is False else 0
    return (int(a.consistent is not False), -1 if a.dof is None else a.dof, a.velocity_dof or doubt)


def _with_spans(block: Block, forms: Codistribution, points: Variety, extra: list[Expr], setting: Setting) -> Answer:
    """Return the answer by the Lie algebra of admissible velocities at generic points; ``extra``: hidden equations."""
    result = Answer(True, hidden=extra, reasons=list(points.reasons), verdict=points.verdict, about=points.about)
    result.argument, result.gap, result.witness = (
        points.argument,
        points.gap,
        of_real_point(forms.chart.symbols, points.real),
    )
    result.separating = points.separating
    here = None if setting.reference is None else span_at_reference(forms, setting.reference)
    irregular = replace(result, consistent=None, verdict="undecided", reasons=[*points.reasons, IRREGULAR])
    if points.samples:
        good = _spans(forms, points)
        if here is not None and any(is_exceptional(forms, here, len(s.frame.rows), s.span) for _, s in good):
            return irregular
        if good:
            if points.about == "component" and points.real is not None and points.real.certified:
                largest = max((sampled for _, sampled in good), key=lambda sampled: sampled.span.dimension)
                real = on_the_same_part(forms, points, largest)
                if real is None:
                    return replace(result, consistent=None, verdict="undecided", reasons=[*points.reasons, APART])
                points.real, result.witness = real, of_real_point(forms.chart.symbols, real)
            field_labels(block, forms, points, good, result, setting)
            if here is not None and result.dof is not None:
                set_at_reference(forms, here, result)
            if block.nonlinear:
                set_velocity_freedom(block, setting, result)
            return result
    if points.real is not None and points.real.certified:
        span = ball_labels(block, forms, points.real, result)
        if here is not None and span is not None:
            if is_exceptional(forms, here, forms.n - (result.velocity_dof or 0), span):
                return irregular
            set_at_reference(forms, here, result)
        if block.nonlinear:
            set_velocity_freedom(block, setting, result)
        return result
    result.verdict, result.consistent = "undecided", None
    result.reasons.append("no regular point was found at which the differential constraints could be analysed")
    return result


def _spans(forms: Codistribution, points: Variety) -> list[tuple[FieldPoint, SampledSpan]]:
    """Return the Lie algebra at every sample; one sample is enough if it spans the tangent space, for certain."""
    good = []
    for point in points.samples:
        sampled = span_at(forms, point)
        if sampled is None:
            continue
        good.append((point, sampled))
        whole = sampled.span.dimension == len(forms.chart.symbols)
        if whole and not forms.finite and independent_generators(forms.chart.ring):
            break
    return good
