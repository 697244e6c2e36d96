"""Conditions of a block: do its equations have a solution at which, as they were written, they have a value?

At a regular point where the conditions are satisfied strictly the set is what the equations make it; where they are
satisfied nowhere there is nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from flint import arb

from dofkit.classification.freedom.block import answer
from dofkit.configuration.finite_blocks import OFF_REFERENCE
from dofkit.configuration.witness import of_real_point
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.real_search import RealPoint, RealSearch
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.chart import Chart, make_chart
from dofkit.relations.normal.domain import DomainCondition, holds_at
from dofkit.relations.normal.no_solution import hold_nowhere
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import given_by

#: Searches for a point, each from other starts and, but for the first, at a time later or earlier by such a factor.
SEEDS, LATER = 6, 4.0


def restricted_to_domain(block: Block, result: Answer, setting: Setting) -> Answer:
    """Return the answer where the conditions of a block are satisfied.

    It is inconsistent where they are satisfied nowhere, and undecided where that is not known, or where the reference
    configuration lies on the boundary.
    """
    block = _without_satisfied_conditions(block)
    if not block.conditions or result.consistent is False:
        return result
    if result.consistent is None:
        return _nowhere(block, result) if _is_empty(block, result, setting) else result
    if setting.reference is not None:
        here = {**setting.reference, ex.TIME: ex.ZERO}
        drawn = result.instantaneous is not None
        inside = [holds_at(c, here, setting.positive, strictly=drawn) for c in block.conditions]
        if drawn and all(inside):
            return result
        outside = False in [holds_at(c, here, setting.positive) for c in block.conditions]
        if drawn and not outside:
            return _undecided(block, result)
        if drawn:
            elsewhere = replace(setting, reference=None, pose={})
            result = restricted_to_domain(block, answer(block, elsewhere), elsewhere)
        if outside:
            result.reasons.append(OFF_REFERENCE)
        if drawn:
            return result
    return _at_a_point(block, result, setting)


def _without_satisfied_conditions(block: Block) -> Block:
    """Return the block without conditions u >= 0 where its equations give coordinates such that u is 0."""
    weak = any(c.sense == ">=" for c in block.conditions)
    explicit = given_by(r.piece.expr for r in block.finite if isinstance(r.piece, Finite)) if weak else {}
    conditions = (c for c in block.conditions if c.sense != ">=" or not substitute(c.expr, explicit).is_zero)
    return replace(block, conditions=tuple(conditions)) if explicit else block


def _equations(block: Block, result: Answer) -> list[Expr]:
    return [*(r.piece.expr for r in block.finite if isinstance(r.piece, Finite)), *result.hidden]


def _is_empty(block: Block, result: Answer, setting: Setting) -> bool:
    """Return whether the conditions are proved to be satisfied nowhere where the finite equations are."""
    return hold_nowhere(_equations(block, result), block.conditions, setting.positive)


def _at_a_point(block: Block, result: Answer, setting: Setting) -> Answer:
    """Return the answer with a witness at which all conditions are satisfied strictly."""
    conditions = [c.expr for c in block.conditions]
    chart = make_chart(block, replace(setting, reference=None), result.hidden, conditions)
    dof = result.dof if not block.forms and not block.nonlinear else None
    point = _point_within(chart, block.conditions, dof)
    if point is not None and _is_same_component(block, result):
        within = _is_strict_at_witness(block, result)
        return result if within else replace(result, witness=of_real_point(chart, point))
    return _nowhere(block, result) if _is_empty(block, result, setting) else _undecided(block, result)


def _point_within(chart: Chart, conditions: Sequence[DomainCondition], dof: int | None) -> RealPoint | None:
    """Return a certified regular point, of the largest rank that was seen, at which all conditions hold strictly.

    For finite equations alone the rank there has to agree with ``dof``: other components may be larger or smaller.
    """
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive, chart.symbols)
    points = []
    for seed in range(SEEDS):
        moment = {ex.TIME: (-1.0) ** seed * LATER ** (seed // 2)} if seed else {}
        try:
            point = search.search(seed, moment)
        except (OverflowError, ValueError, NoValueError):
            continue
        if point is not None and point.certified and point.consistent:
            points.append(point)
    wanted = max((p.rank for p in points), default=0) if dof is None else chart.coordinates - dof
    return next((p for p in points if p.rank == wanted and _is_strict_at(chart, p, conditions)), None)


def _is_same_component(block: Block, result: Answer) -> bool:
    """Return whether a point may stand for the answer: one about a component needs the conditions at its witness."""
    if result.about != "component" or not (block.forms or block.nonlinear):
        return True
    return result.witness is not None and _is_strict_at_witness(block, result)


def _is_strict_at_witness(block: Block, result: Answer) -> bool:
    """Return whether the conditions hold strictly at the witness; False where that is written with roots."""
    try:
        configuration = {s: Fraction(text) for s, text in (result.witness or {}).items()}
    except ValueError:
        return False
    balls = [(c, interval_of(c.expr, configuration)) for c in block.conditions] if configuration else []
    return all(v is not None and not v.contains(0) and (c.sense == "!=" or bool(v > 0)) for c, v in balls)


def _is_strict_at(chart: Chart, point: RealPoint, conditions: Sequence[DomainCondition]) -> bool:
    try:
        at = values(chart.ring, point.point)
    except NoValueError:
        return False
    balls = [arb(at[chart.ring.node(c.expr)]) for c in conditions]
    return all(v > 0 if c.sense != "!=" else not v.contains(0) for v, c in zip(balls, conditions, strict=True))


def _text(block: Block) -> str:
    return " and ".join(f"{to_text(c.expr)} {c.sense} 0" for c in block.conditions)


def _nowhere(block: Block, result: Answer) -> Answer:
    why = f"as written, the equations require {_text(block)}, which is satisfied nowhere where they are"
    reasons = [*result.reasons, why]
    return Answer(False, verdict="proved", argument="outside the domain", hidden=result.hidden, reasons=reasons)


def _undecided(block: Block, result: Answer) -> Answer:
    why = f"no configuration was found that satisfies the equations and, as they require, {_text(block)}"
    most = result.dof if result.verdict == "proved" and result.about != "component" else None
    return Answer(None, verdict="undecided", hidden=result.hidden, reasons=[*result.reasons, why], most=most)
