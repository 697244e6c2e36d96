"""Freedom and labels of a block with differential relations from real points alone."""

from __future__ import annotations

from flint import arb

from dofkit.base.verdicts import Verdict
from dofkit.configuration.at_reference import CLEAR
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.sparse import sparse
from dofkit.exact.points.frames import pairing
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.program import values
from dofkit.integrability.lie_algebra import Span
from dofkit.integrability.lie_algebra_at_points import ball_span
from dofkit.integrability.pfaffian_system import Codistribution, linear_rows
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite


def _gap(span: Span) -> float:
    """How far what is left of the Lie algebra lies below its smallest pivot, less what the pivots fall by anyway."""
    part = ball_part(span.vectors)
    return part.gap / part.fall


def ball_labels(block: Block, forms: Codistribution, real: RealPoint, result: Answer) -> None:
    """With real points only: what a tiny ball contains 0 of is taken for 0, and the verdict says numeric."""
    at = values(forms.chart.ring, real.point)
    matrix = forms.rows.matrix(at, arb(0))
    part = ball_part(matrix)
    rank = part.rank
    total, n = len(forms.chart.symbols), forms.n
    found = ball_span(forms, rank, real.point)
    if found is None or part.gap < CLEAR:
        result.verdict, result.consistent = "undecided", None
        result.reasons.append("only singular points were found")
        return
    span, _ = found
    reached = span.dimension == total
    gap = part.gap if reached else min(part.gap, _gap(span))
    result.verdict, result.method = "numeric", "Lie algebra along a curve with balls"
    result.argument, result.gap = "Lie algebra with balls", gap
    result.velocity_dof = n - rank
    if gap >= CLEAR:
        result.dof = n - (total - span.dimension)
        result.reasons.append(f"decided at real points of high precision, with a gap of {gap:.1e} between pivots")
    else:
        result.verdict = "undecided"
        result.reasons.append(
            f"Lie brackets are resolved down to a gap of {gap:.1e} only, so some may have been missed"
        )
    if "field" not in forms.chart.engines:
        result.matrix = sparse(dependencies(matrix, part))
        if real.consistent and len(real.rows) == forms.finite and rank == len(matrix):
            result.verdict = "proved" if reached or total - rank <= 1 else result.verdict
    for i, row, place in linear_rows(block, forms):
        finite = isinstance(row.piece, Finite)
        zero = all(v.contains(0) for v in pairing(matrix[place], span.vectors))
        if zero and gap < CLEAR and not finite:
            result.labels[i] = HolonomyLabel(None, "undecided", "a decisive Lie bracket may have been lost to rounding")
            continue
        sure: Verdict = "proved" if finite or not zero else "numeric"
        result.labels[i] = HolonomyLabel(zero, sure)
