"""Blocks of finite relations only: freedom at the reference, or at generic points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING

from dofkit.base.libraries import LateLibrary
from dofkit.configuration.drawing.at_reference import AtReference, at_reference, ball_matrix
from dofkit.configuration.drawing.measured_blocks import drawing_of_block, is_measured, is_tree
from dofkit.configuration.generic_points import field_jacobian
from dofkit.configuration.search import find
from dofkit.configuration.variety import Variety
from dofkit.configuration.witness import of_real_point, of_reference
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.modular import without_time
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows, sparse
from dofkit.exact.points.exact import rational_values, vanish_exactly
from dofkit.exact.points.frames import sparse_frame
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.degree import error_bits
from dofkit.exact.zero.independence import doubt
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, RealRows
from dofkit.relations.blocks import Block
from dofkit.relations.chart import Chart
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.setting import Setting

if TYPE_CHECKING:
    from dofkit.configuration.drawing import measured as measured_drawing
    from dofkit.configuration.drawing import measured_as_written
else:
    measured_as_written = LateLibrary("dofkit.configuration.drawing.measured_as_written")
    measured_drawing = LateLibrary("dofkit.configuration.drawing.measured")

OFF_REFERENCE = (
    "the reference configuration does not satisfy all finite relations: the answer is for configurations that do, "
    "and nothing is said of the reference itself"
)
#: Measured numbers are not exact: away from where they were measured they prove nothing.
NOT_DRAWN = "with a tolerance geometry is right near its drawing only, and not everything here is drawn"
ONE_MOMENT = "at the reference configuration the relations hold at this moment only: no motion passes through it"


def finite_answer(block: Block, setting: Setting) -> Answer:
    """The answer to a block of finite relations, at the reference where it satisfies them and else generically."""
    chart = make_chart(block, setting)
    measured = is_measured(block, setting)
    result = _within_tolerance(block, chart, setting) if measured else _finite_answer(chart, setting)
    result.doubt = doubt(chart.ring)
    return result


def _within_tolerance(block: Block, chart: Chart, setting: Setting) -> Answer:
    """The answer where geometry is measured; generically where that cannot matter, as in a tree that is not drawn."""
    drawing = drawing_of_block(chart, setting)
    if drawing is None and is_tree(block, setting):
        return _finite_answer(chart, setting)
    found = None if drawing is None else at_reference(chart, drawing, exact=False)
    if drawing is None or found is None:
        return Answer(None, verdict="undecided", reasons=[NOT_DRAWN])
    return _measured_answer(chart, setting, drawing, found)


def _finite_answer(chart: Chart, setting: Setting) -> Answer:
    if setting.reference is not None:
        drawn = _drawn_answer(chart, setting, setting.reference)
        if drawn is not None:
            drawn.about, drawn.witness = "reference", of_reference(chart.symbols, setting.reference)
            return drawn
    found = find(chart, setting.pose)
    result = Answer(
        found.consistent, found.dimension, found.dimension, found.verdict, found.about, found.argument, gap=found.gap
    )
    result.bits = error_bits(chart.ring, chart.nodes, len(chart.columns))
    result.witness = found.witness or of_real_point(chart, found.real)
    if found.argument in ("cases", "regular point"):
        result.real = _real_rows(chart, found.real)
    result.reasons = list(found.reasons)
    if setting.reference is not None:
        result.reasons.append(OFF_REFERENCE)
    result.method = "rank over GF(p)" + (" and balls" if found.real else "")
    if found.samples:
        _finite_matrix(chart, found, result)
    elif found.real is not None:
        result.method = "real points with balls"
        _numeric_matrix(chart, found.real, result)
    return result


def _real_rows(chart: Chart, real: RealPoint | None) -> RealRows | None:
    """The rows at a certified point, where they may tell another part of the set."""
    if real is None or not real.certified or not real.consistent:
        return None
    matrix = ball_matrix(chart, real.point, False)
    return None if matrix is None else RealRows(tuple(str(s.args[1]) for s in chart.symbols), matrix)


def _numeric_matrix(chart: Chart, real: RealPoint, result: Answer) -> None:
    """Which relations depend on which, and which coordinates on which, from a regular real point."""
    if not real.certified or not real.rows or len(real.matrix) != len(chart.nodes):
        return
    result.matrix = sparse(dependencies(real.matrix, real.part))
    shown = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    columns = [i for i, s in enumerate(shown) if s != ex.TIME]
    part = ball_part([[row[c] for c in columns] for row in real.matrix])
    if part.rank < real.rank:
        result.consistent, result.dof, result.velocity_dof, result.argument = False, None, None, "time fixed"
        result.reasons.append("the finite relations fix the time: no motion satisfies them through an interval of time")
        return
    result.dependent = tuple(str(shown[columns[i]].args[1]) for i in part.columns)


def _drawn_answer(chart: Chart, setting: Setting, reference: Mapping[Expr, Expr]) -> Answer | None:
    """At the reference configuration; None where the relations do not hold there."""
    found = at_reference(chart, reference)
    if found is None:
        return None
    result = Answer(True, found.local.dimension, found.local.dimension, found.local.verdict)
    result.argument, result.bits = found.local.argument, error_bits(chart.ring, chart.nodes, len(chart.columns))
    result.method = "rank over GF(p) at the given configuration"
    result.instantaneous, result.looked = found.instantaneous, found.looked
    result.matrix, result.modulus, result.first_order_sure = found.matrix, found.modulus, found.sure
    result.exists = chart.time is None and vanish_exactly(chart.ring, chart.nodes, rational_values(reference))
    if found.dependent is None:
        result.dependent = dependent_names(found.matrix, chart, found.modulus)
    else:
        result.method = "balls at the given configuration"
        result.dependent = tuple(str(chart.symbols[c].args[1]) for c in found.dependent)
    if found.local.confined and found.rank == len(chart.columns):
        result.consistent, result.dof, result.velocity_dof, result.verdict = False, None, None, "probable"
        result.argument = "time fixed"
        result.reasons.append("the finite relations fix the time: no motion satisfies them through an interval of time")
        return result
    if found.local.confined:
        return _confined_answer(chart, setting, result)
    if found.local.dimension is None and chart.time is not None:
        result.consistent = None
    columns = len(chart.columns) - found.rank
    result.degenerate = found.local.dimension != columns - (len(chart.columns) - chart.coordinates)
    if found.rank < len(found.matrix) and result.degenerate:
        result.reasons.append(found.local.reason)
    return result


def _confined_answer(chart: Chart, setting: Setting, result: Answer) -> Answer:
    """No motion passes through the reference; whether one does elsewhere is asked of generic configurations."""
    elsewhere = find(chart, {})
    result.consistent = False if elsewhere.consistent is False else None
    if elsewhere.samples:
        _finite_matrix(chart, elsewhere, result)
    result.dof = result.velocity_dof = result.instantaneous = None
    if result.consistent is not False:
        result.verdict = "undecided"
        result.reasons.append(ONE_MOMENT)
    return result


def _measured_answer(chart: Chart, setting: Setting, drawing: Mapping[Expr, Expr], found: AtReference) -> Answer:
    """Measured geometry: the rank within the tolerance."""
    if "balls" not in setting.engines:
        return Answer(None, verdict="undecided", reasons=["measured geometry has no points over GF(p)"])
    told = measured_drawing.measure(chart, _floats(found), setting, found.rigid)
    told = measured_as_written.held_against_exact(told, chart, drawing)
    result = Answer(True, told.dimension, told.dimension, "numeric" if told.dimension is not None else "undecided")
    result.argument, result.gap, result.about = "singular values", told.gap, "reference"
    result.method = "singular values within the tolerance at the given configuration"
    result.instantaneous = told.instantaneous
    if told.still:
        result.consistent, result.verdict, result.argument = False, "numeric", "time fixed"
    elif told.dimension is None and (chart.time is not None or told.reason == measured_drawing.MISSED):
        result.consistent = None
    exact = "no singular value but 0 itself is taken for 0"
    gap = f"the gap between singular values is {told.gap:.1e}" if isfinite(told.gap) else exact
    result.reasons.append(f"{told.reason}; {gap}")
    result.matrix, result.modulus = sparse(told.dependencies), 2
    result.dependent = tuple(str(chart.symbols[c].args[1]) for c in told.columns)
    result.degenerate = told.dimension != told.instantaneous
    return result


def measured_place(chart: Chart, drawing: Mapping[Expr, Expr]) -> dict[Expr, float] | None:
    """The drawing in floating point; None where it has no values."""
    found = at_reference(chart, drawing, exact=False)
    return None if found is None or found.ball is None else _floats(found)


def _floats(found: AtReference) -> dict[Expr, float]:
    return {s: float(v.mid()) for s, v in found.ball.symbols.items()} if found.ball is not None else {}


def _finite_matrix(chart: Chart, found: Variety, result: Answer) -> None:
    point = found.samples[0]
    matrix = field_jacobian(chart, point)
    n = chart.coordinates
    rank = rank_of_rows(matrix, point.p)
    rank_q = rank_of_rows(without_time(matrix, n), point.p) if len(chart.columns) > n else rank
    result.matrix, result.modulus = matrix, point.p
    result.dependent = dependent_names(matrix, chart, point.p)
    if rank_q < rank:
        result.consistent, result.dof, result.velocity_dof = False, None, None
        result.verdict, result.argument = "probable", "time fixed"
        result.reasons.append("the finite relations fix the time: no motion satisfies them through an interval of time")
        return
    result.degenerate = result.dof is not None and result.dof != n - rank


def dependent_names(rows: Sequence[SparseRow], chart: Chart, p: int) -> tuple[str, ...]:
    """Coordinates that the rows can be solved for, the last ones where there is a choice."""
    frame = sparse_frame(without_time(rows, chart.coordinates), chart.coordinates, p)
    return tuple(str(chart.symbols[c].args[1]) for c in frame.dependent)
