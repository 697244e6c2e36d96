"""Conditions of a block: do its relations hold somewhere where, as they were written, they have a value?

At a regular point where the conditions hold strictly the set is what the relations make it; where they hold nowhere
there is nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from flint import arb

from dofkit.classification.freedom.block import answer
from dofkit.configuration.components import is_irreducible
from dofkit.configuration.finite_blocks import OFF_REFERENCE
from dofkit.configuration.search import find
from dofkit.configuration.variety import of_real_point
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.real_search import RealPoint, RealSearch
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row
from dofkit.relations.chart import Chart
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.normal.domain import DomainCondition, holds_at
from dofkit.relations.normal.no_solution import hold_nowhere
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import given_by

#: Searches for a point, each from other starts and, but for the first, at a time later or earlier by such a factor.
SEEDS, LATER = 6, 4.0


def restricted_to_domain(block: Block, result: Answer, setting: Setting) -> Answer:
    """The answer where the block's conditions hold; inconsistent where they hold nowhere, undecided where unknown."""
    if not block.conditions or result.consistent is False:
        return result
    if result.consistent is None:
        return _nowhere(result, block.conditions, "proved") if _empty(block, result, setting) else result
    if result.instantaneous is not None and setting.reference is not None:
        known = {**setting.reference, ex.TIME: ex.ZERO}
        holds = [holds_at(c, known, setting.positive) for c in block.conditions]
        if all(holds):
            return _beside_boundary(block, _beside_edge(block, result, setting), setting)
        if None in holds and False not in holds:
            return _open(result, block.conditions)
        elsewhere = replace(setting, reference=None, pose={})
        result = restricted_to_domain(block, answer(block, elsewhere), elsewhere)
        result.reasons.append(OFF_REFERENCE)
        return result
    if setting.reference is not None:
        known = {**setting.reference, ex.TIME: ex.ZERO}
        if any(holds_at(c, known, setting.positive) is False for c in block.conditions):
            result.reasons.append(OFF_REFERENCE)
    return _somewhere(block, result, setting)


def _beside_edge(block: Block, result: Answer, setting: Setting) -> Answer:
    """The answer at a reference where conditions are 0 and yet hold: is the branch one that goes on from there?

    It is where the differential of each depends on none of those of the finite relations; z != 0 beside z = 0 is none.
    """
    known = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    strictly = [(c, replace(c, adjoining=False)) for c in block.conditions if c.adjoining]
    edges = [c for c, strict in strictly if not holds_at(strict, known, setting.positive)]
    if not edges:
        return result
    finite = replace(block, rows=block.finite, conditions=())
    free = answer(finite, setting).instantaneous if finite.rows else len(block.coordinates)
    for number, c in enumerate(edges):
        row = Row(-1 - number, Finite(c.expr))
        if answer(replace(finite, rows=(*finite.rows, row)), setting).instantaneous != (free or 0) - 1:
            return _nowhere(result, edges, "proved") if _empty(block, result, setting) else _open(result, edges)
    return result


def _beside_boundary(block: Block, result: Answer, setting: Setting) -> Answer:
    """The answer at a regular reference where some expressions are 0 and asked to be >= 0: does the set go on inside?

    It does where their differentials are independent on its tangent space, and where they are 0 all over it: c = 0 then
    leaves all of its dimension. y = -x^2 with y >= 0 is a point.
    """
    known = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    given = given_by(r.piece.expr for r in block.finite if isinstance(r.piece, Finite))
    weak = [c for c in block.conditions if c.sense == ">=" and not c.adjoining]
    there = dict.fromkeys(replace(c, expr=_scaled(substitute(c.expr, given)), sense=">") for c in weak)
    active = [c for c in there if not c.expr.is_zero and not holds_at(c, known, setting.positive)]
    if not active or not result.consistent:
        return result
    if result.instantaneous is None or result.instantaneous != result.velocity_dof:
        return _open(result, active)
    plain = replace(block, conditions=())
    entered: list[Row] = []
    for number, c in enumerate(active):
        row = Row(-1 - number, Finite(c.expr))
        inside = answer(replace(plain, rows=(*plain.rows, *entered, row)), setting).instantaneous
        if inside == result.instantaneous - len(entered) - 1:
            entered.append(row)
        elif answer(replace(plain, rows=(*plain.rows, row)), setting).dof != result.dof:
            return _open(result, active)
    return result


def _scaled(e: Expr) -> Expr:
    """Return ``e`` times a positive number, the same expression for all such multiples of ``e``."""
    terms = linear_terms(e)
    first = abs(terms[min(terms, key=repr)]) if terms else Fraction(1)
    return e if first == 1 else e / ex.num(first)


def _empty(block: Block, result: Answer, setting: Setting) -> bool:
    """Do the conditions hold nowhere where the finite relations do?"""
    relations = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + result.hidden
    return hold_nowhere(relations, block.conditions, setting.positive)


def _somewhere(block: Block, result: Answer, setting: Setting) -> Answer:
    relations = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + result.hidden
    conditions = [c.expr for c in block.conditions]
    chart = make_chart(block, replace(setting, reference=None), result.hidden, conditions)
    nodes = [chart.ring.node(e) for e in conditions]
    zero = _identically_zero(chart, nodes)
    dead = [c for c, z in zip(block.conditions, zero, strict=True) if z and c.sense != ">="]
    if dead:
        return _where_some_vanish(chart, result, relations, dead, setting)
    left = [(n, c) for n, c, z in zip(nodes, block.conditions, zero, strict=True) if not z]
    dof = result.dof if not block.forms and not block.nonlinear else None
    inside = _point_within(chart, left, dof)
    if inside is not None and _witness_within(block, result):
        strict = [c for _, c in left]
        return result if _is_within(result, strict) else replace(result, witness=of_real_point(chart, inside))
    if hold_nowhere(relations, block.conditions, setting.positive):
        return _nowhere(result, block.conditions, "proved")
    return _open(result, block.conditions)


def _where_some_vanish(
    chart: Chart, result: Answer, relations: Sequence[Expr], dead: Sequence[DomainCondition], setting: Setting
) -> Answer:
    """The answer where conditions are 0 at the points that were drawn: on all of the set, or on a part of it only."""
    if not relations:
        return _nowhere(result, dead, "proved")
    if is_irreducible(chart):
        return _nowhere(result, dead, "probable")
    return _nowhere(result, dead, "proved") if hold_nowhere(relations, dead, setting.positive) else _open(result, dead)


def _identically_zero(chart: Chart, nodes: Sequence[int]) -> list[bool]:
    """Which of the nodes vanish on the whole set, as far as points over GF(p) tell?"""
    samples = find(chart, {}).samples
    found = [bool(samples)] * len(nodes)
    for point in samples:
        try:
            at = values(chart.ring, point)
        except NoValueError:
            return [False] * len(nodes)
        found = [z and at[n] == 0 for z, n in zip(found, nodes, strict=True)]
    return found


def _point_within(chart: Chart, left: Sequence[tuple[int, DomainCondition]], dof: int | None) -> RealPoint | None:
    """A certified regular point, of the largest rank that was seen, at which all conditions hold strictly.

    Of finite relations alone the rank there has to say the ``dof``: other parts of the set may be larger or smaller.
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
    return next((p for p in points if p.rank == wanted and _strictly(chart, p, left)), None)


def _witness_within(block: Block, result: Answer) -> bool:
    """Of what is told of one part of the set only: do the conditions hold at its witness?"""
    if result.about != "component" or not (block.forms or block.nonlinear):
        return True
    return result.witness is not None and _is_within(result, block.conditions)


def _is_within(result: Answer, conditions: Sequence[DomainCondition]) -> bool:
    """Do conditions hold strictly at the witness, where there is one? False where it is written with roots."""
    try:
        known = {s: Fraction(text) for s, text in (result.witness or {}).items()}
    except ValueError:
        return False
    there = [(c, interval_of(c.expr, known)) for c in conditions] if known else []
    return all(v is not None and not v.contains(0) and (c.sense == "!=" or bool(v > 0)) for c, v in there)


def _strictly(chart: Chart, found: RealPoint, left: Sequence[tuple[int, DomainCondition]]) -> bool:
    try:
        at = values(chart.ring, found.point)
    except NoValueError:
        return False
    return all(at[n] > 0 if c.sense != "!=" else not arb(at[n]).contains(0) for n, c in left)


def _conditions_text(conditions: Sequence[DomainCondition]) -> str:
    return " and ".join(f"{to_text(c.expr)} {c.sense} 0" for c in conditions)


def _nowhere(result: Answer, conditions: Sequence[DomainCondition], verdict: Literal["proved", "probable"]) -> Answer:
    why = f"as written, the equations require {_conditions_text(conditions)}, which holds nowhere where they do"
    return Answer(
        False, verdict=verdict, argument="outside the domain", hidden=result.hidden, reasons=[*result.reasons, why]
    )


def _open(result: Answer, conditions: Sequence[DomainCondition]) -> Answer:
    why = (
        f"no configuration was found that satisfies the equations and, as they require, {_conditions_text(conditions)}"
    )
    most = result.dof if result.verdict == "proved" and result.about != "component" else None
    return Answer(None, verdict="undecided", hidden=result.hidden, reasons=[*result.reasons, why], most=most)
