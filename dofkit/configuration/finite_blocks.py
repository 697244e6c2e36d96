"""Blocks of geometric equations only: the freedom at the reference configuration, or at generic points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite

from dofkit.base.wording import gap_in_words
from dofkit.configuration.at_reference import at_reference, ball_matrix
from dofkit.configuration.measured.dimension import MISSED, MeasuredFreedom, measured_freedom
from dofkit.configuration.measured.equations import is_tree, pose_of_block
from dofkit.configuration.search import find
from dofkit.configuration.variety import Variety, field_jacobian, of_real_point, of_reference
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows, sparse, sparse_frame, without_time
from dofkit.exact.points.balls import RealPoint, rational_values, vanish_exactly
from dofkit.exact.zero import error_bits, independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, RealRows
from dofkit.relations.blocks import Block, Chart, is_measured, make_chart
from dofkit.relations.setting import Setting

#: Reason: numbers with a tolerance prove nothing away from the reference configuration.
UNPLACED = (
    "with a tolerance the geometry is valid only near the reference configuration, and not everything "
    "here has a position there"
)
ONE_MOMENT = "the reference configuration satisfies the equations at this instant only: no motion passes through it"


def finite_answer(block: Block, setting: Setting) -> Answer:
    """Return the answer of a block of geometric equations, at the reference if it satisfies them, else generic."""
    chart = make_chart(block, setting)
    measured = is_measured(block, setting)
    result = _within_tolerance(block, chart) if measured else _finite_answer(chart)
    result.doubt = not independent_generators(chart.ring)
    return result


def _within_tolerance(block: Block, chart: Chart) -> Answer:
    """Return the answer of a block with a tolerance; in a tree without positions the numbers do not matter."""
    pose = pose_of_block(chart)
    if pose is None and is_tree(block, chart.setting):
        return _finite_answer(chart)
    if "balls" not in chart.setting.engines:
        return Answer(None, verdict="undecided", reasons=["measured geometry has no points over GF(p)"])
    freedom = None if pose is None else measured_freedom(chart, pose)
    return (
        Answer(None, verdict="undecided", reasons=[UNPLACED]) if freedom is None else _measured_answer(chart, freedom)
    )


def _finite_answer(chart: Chart) -> Answer:
    """Return the answer at the reference configuration if it satisfies the relations, otherwise by generic points."""
    setting = chart.setting
    if setting.reference is not None:
        local = _local_answer(chart, setting.reference)
        if local is not None and local.consistent is False:
            return local
        if local is not None:
            local.about, local.witness = "reference", of_reference(chart.symbols, setting.reference)
            return local
    variety = find(chart, setting.pose)
    result = _answer_of(variety)
    result.bits = error_bits(chart.ring, chart.nodes, len(chart.columns))
    result.witness = variety.witness or of_real_point(chart.symbols, variety.real)
    result.separating = variety.separating
    if variety.argument in ("cases", "regular point", "one relation"):
        result.real = _real_rows(chart, variety.real)
    result.method = "rank over GF(p)" + (" and balls" if variety.real else "")
    if variety.samples:
        _finite_matrix(chart, variety, result)
    elif variety.real is not None:
        result.method = "real points with balls"
        _numeric_matrix(chart, variety.real, result)
    return result


def _answer_of(variety: Variety) -> Answer:
    """Return the answer of a block with a given variety."""
    freedom = variety.dimension
    answer = Answer(
        variety.consistent, freedom, freedom, variety.verdict, variety.about, variety.argument, gap=variety.gap
    )
    return replace(answer, reasons=list(variety.reasons))


def _real_rows(chart: Chart, real: RealPoint | None) -> RealRows | None:
    """Return the Jacobian in balls at a certified real point; None if the point is not certified."""
    if real is None or not real.certain:
        return None
    matrix = ball_matrix(chart, real.point, False)
    return None if matrix is None else RealRows(tuple(str(s.args[1]) for s in chart.symbols), matrix)


def _numeric_matrix(chart: Chart, real: RealPoint, result: Answer) -> None:
    """Set ``matrix`` (the pattern of dependent rows) and ``dependent`` of the result, from a regular real point."""
    if not real.certified or not real.part.rows or len(real.matrix) != len(chart.nodes):
        return
    result.matrix = sparse(dependencies(real.matrix, real.part))
    ranked = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    columns = [i for i, s in enumerate(ranked) if s != ex.TIME]
    part = ball_part([[row[c] for c in columns] for row in real.matrix])
    result.dependent = tuple(str(ranked[columns[i]].args[1]) for i in part.columns)


def _local_answer(chart: Chart, reference: Mapping[Expr, Expr]) -> Answer | None:
    """Return the answer at the reference configuration; None if it does not satisfy the relations."""
    local_answer = at_reference(chart, reference)
    if local_answer is None:
        return None
    result = Answer(True, local_answer.local.dimension, local_answer.local.dimension, local_answer.local.verdict)
    result.argument, result.bits = local_answer.local.argument, error_bits(chart.ring, chart.nodes, len(chart.columns))
    result.method = "rank over GF(p) at the given configuration"
    result.instantaneous, result.looked = local_answer.instantaneous, local_answer.looked
    result.matrix, result.modulus = local_answer.matrix, local_answer.modulus
    result.first_order_sure = local_answer.sure
    result.exists = chart.time is None and vanish_exactly(chart.ring, chart.nodes, rational_values(reference))
    if local_answer.dependent is None:
        result.dependent = dependent_names(local_answer.matrix, chart, local_answer.modulus)
    else:
        result.method = "balls at the given configuration"
        result.dependent = tuple(str(chart.symbols[c].args[1]) for c in local_answer.dependent)
    if local_answer.local.confined:
        return _confined_answer(chart, result)
    if local_answer.local.dimension is None and chart.time is not None:
        result.consistent = None
    columns = len(chart.columns) - local_answer.rank
    result.degenerate = local_answer.local.dimension != columns - (len(chart.columns) - chart.coordinates)
    if local_answer.rank < len(local_answer.matrix) and result.degenerate:
        result.reasons.append(local_answer.local.reason)
    return result


def _confined_answer(chart: Chart, result: Answer) -> Answer:
    """Return the answer if no motion passes through the reference: undecided, or inconsistent if no point exists."""
    elsewhere = find(chart, {})
    if elsewhere.consistent is False:
        return replace(_answer_of(elsewhere), method=result.method)
    if elsewhere.samples:
        _finite_matrix(chart, elsewhere, result)
    result.consistent = result.dof = result.velocity_dof = result.instantaneous = None
    result.verdict = "undecided"
    result.reasons.append(ONE_MOMENT)
    return result


def _measured_answer(chart: Chart, freedom: MeasuredFreedom) -> Answer:
    """Return the answer of a block whose ``freedom`` was measured, within the tolerance."""
    dimension = freedom.dimension
    result = Answer(True, dimension, dimension, "numeric" if dimension is not None else "undecided")
    result.argument, result.gap, result.about = "singular values", freedom.gap, "reference"
    result.method = "singular values within the tolerance at the given configuration"
    result.instantaneous = freedom.instantaneous
    if dimension is None and (chart.time is not None or freedom.reason == MISSED):
        result.consistent = None
    exact = "only an exact zero counts as a zero singular value"
    gap = gap_in_words(freedom.gap, "singular value") if isfinite(freedom.gap) else exact
    result.reasons.append(f"{freedom.reason}; {gap}")
    result.matrix, result.modulus = sparse(freedom.dependencies), 2  # entries 0 and 1: which rows depend on which
    result.dependent = tuple(str(chart.symbols[c].args[1]) for c in freedom.columns)
    result.degenerate = dimension != freedom.instantaneous
    return result


def _finite_matrix(chart: Chart, variety: Variety, result: Answer) -> None:
    """Set ``matrix``, ``modulus``, ``dependent`` and ``degenerate`` of the result, from a point over GF(p)."""
    point = variety.samples[0]
    result.matrix, result.modulus = field_jacobian(chart, point), point.p
    result.dependent = dependent_names(result.matrix, chart, point.p)
    result.degenerate = result.dof is not None and result.dof != chart.coordinates - rank_of_rows(
        result.matrix, point.p
    )


def dependent_names(rows: Sequence[SparseRow], chart: Chart, p: int) -> tuple[str, ...]:
    """Return the names of coordinates that the rows can be solved for, later ones preferred."""
    frame = sparse_frame(without_time(rows, chart.coordinates), chart.coordinates, p)
    return tuple(str(chart.symbols[c].args[1]) for c in frame.dependent)
