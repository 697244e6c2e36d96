"""The reference configuration as the point at which differential relations are analysed.

Where the set may have several components, the Lie algebra is taken at the reference configuration: its dimension along
a generic admissible curve from there is that of the component of the reference, if the rows have the same rank near it
on that component [HermannNagano]. Elsewhere the answer is that of generic points, unless the reference is exceptional
among them.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence

from flint import arb, ctx

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import Verdict
from dofkit.configuration.at_reference import ball_matrix, ball_point
from dofkit.configuration.variety import SAMPLES, Variety, on_variety, pose_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import precision
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.program import values
from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import AdmissibleCurve, SampledSpan, span_at
from dofkit.integrability.pfaffian_system import Codistribution

#: Coefficients along a curve in which a dependent row has to be dependent.
ORDER = 8


def reference_points(forms: Codistribution, reference: Mapping[Expr, Expr]) -> list[FieldPoint] | None:
    """Return the reference configuration (t = 0) over GF(p), one point per sample; none if an equation is not 0 there.

    None where it has no point over GF(p): numbers there may be related in a way that is not known.
    """
    points = [pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 11 + k) for k in range(SAMPLES)]
    drawn = [point for point in points if point is not None]
    if len(drawn) < SAMPLES:
        return None
    return drawn if all(on_variety(forms.chart, point) for point in drawn) else []


def span_at_reference(forms: Codistribution, reference: Mapping[Expr, Expr]) -> tuple[FieldPoint, SampledSpan] | None:
    """Return the reference configuration over GF(p) and the Lie algebra there; None where it has no such point."""
    if "field" not in forms.chart.setting.engines:
        return None
    for point in reference_points(forms, reference) or []:
        sampled = span_at(forms, point, True)
        return None if sampled is None else (point, sampled)
    return None


def is_exceptional(
    forms: Codistribution, reference: tuple[FieldPoint, SampledSpan], samples: Sequence[SampledSpan]
) -> bool:
    """Return whether the rows or the Lie algebra are smaller at the reference configuration than at one of the samples.

    Several leaves, or one of smaller dimension, can pass through such a configuration [HermannNagano]. Rows count by
    what they say of velocities: where only the dt term remains no motion passes.
    """
    point, here = reference
    rank = rank_of([row[: forms.n] for row in here.matrix], point.p)
    return any(rank < len(there.frame.rows) or here.span.dimension < there.span.dimension for there in samples)


def regular_reference(
    forms: Codistribution, points: list[FieldPoint], reference: Mapping[Expr, Expr]
) -> Variety | None:
    """Return the set near the reference configuration, or None where the rank of the rows may differ near it."""
    try:
        if not all(_is_regular(forms, point) for point in points):
            return None
        point = points[0]
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    except NoValueError:
        return None
    rank = rank_of(matrix[: forms.finite], point.p)
    verdict: Verdict = "proved" if rank == forms.finite else "probable"
    return Variety(True, forms.n - rank, verdict, points, _real_point(forms, reference), about="reference")


def _is_regular(forms: Codistribution, point: FieldPoint) -> bool:
    """Return whether rows that depend on others at the point do so along a generic curve through it: constant rank.

    On the fields X with A_d X_d = -A_f X_f, where A holds the independent rows, every other row has to vanish.
    """
    n = len(forms.chart.symbols)
    matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    frame = field_frame(matrix, n, point.p)
    others = [row for r, row in enumerate(forms.rows.entries) if r not in frame.rows]
    if not others or not frame.free:
        return True
    if not frame.rows:
        return False
    curve = AdmissibleCurve(forms.rows, frame, point)
    curve.follow(ORDER)
    return not any(any(_along(curve, row, k, point.p)) for row in others for k in range(ORDER))


def _along(curve: AdmissibleCurve, row: Mapping[int, int], order: int, p: int) -> list[int]:
    """Return the coefficient of an order, along the curve, of a row on each of the admissible fields."""
    total = [0] * len(curve.frame.free)
    for j in range(order + 1):
        fields = curve.full_frame[order - j]
        for column, node in row.items():
            factor = int(curve.at[node].coefficient(j))
            total = [t + factor * int(fields[column, f]) for f, t in enumerate(total)] if factor else total
    return [t % p for t in total]


def _real_point(forms: Codistribution, reference: Mapping[Expr, Expr]) -> RealPoint | None:
    """Return the reference configuration in balls; certified where every equation is proved to be 0 there."""
    chart, place = forms.chart, {**reference, ex.TIME: ex.ZERO}
    if "balls" not in chart.setting.engines:
        return None
    with ctx.workprec(max(ctx.prec, precision())):
        ball = ball_point(chart, place, random.Random("dofkit reference"))
        matrix = None if ball is None else ball_matrix(chart, ball, True)
    if ball is None or matrix is None:
        return None
    exact = all(
        zero_and_verdict(substitute(g, place), chart.setting.positive) == (True, "proved") for g in chart.relations
    )
    part = ball_part(matrix) if matrix else ball_part([[arb(0)] * len(chart.symbols)])
    return RealPoint(ball, part, exact, True, matrix)
