"""The one-forms of a block at the reference configuration itself, where that is a regular point of theirs.

Labels at a drawn point are those of the part of the set that it was drawn on. Where the set may have several parts the
Lie algebra is taken at the reference: its dimension along a generic admissible curve from there is that of the
reference's own part, if the rows have the same rank near it, all on that part [HermannNagano].
"""

from __future__ import annotations

import random
from collections.abc import Mapping

from flint import arb, ctx, nmod_mat

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import Verdict
from dofkit.configuration.at_reference import ball_matrix, ball_point
from dofkit.configuration.generic_points import SAMPLES, on_variety, pose_point
from dofkit.configuration.variety import Variety
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
from dofkit.integrability.lie_algebra import AdmissibleCurve
from dofkit.integrability.pfaffian_system import Codistribution

#: Coefficients along a curve that a dependent row has to be dependent in.
ORDER = 8


def on_reference(forms: Codistribution, reference: Mapping[Expr, Expr]) -> list[FieldPoint] | None:
    """The reference configuration (t = 0) over GF(p), once for each sample; none where a relation is not 0 there.

    None where it has no point over GF(p): numbers there may be related in a way that is not known.
    """
    place = {**reference, ex.TIME: ex.ZERO}
    points = [pose_point(forms.chart, place, 11 + k) for k in range(SAMPLES)]
    known = [p for p in points if p is not None]
    if len(known) < SAMPLES:
        return None
    found = [p for p in known if on_variety(forms.chart, p)]
    return found if len(found) == SAMPLES else []


def regular_reference(
    forms: Codistribution, samples: list[FieldPoint], reference: Mapping[Expr, Expr]
) -> Variety | None:
    """The set near the reference; None where the rows have another rank near it, or are not known to have the same."""
    try:
        if not all(_is_regular(forms, point) for point in samples):
            return None
        point = samples[0]
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    except NoValueError:
        return None
    rank = rank_of(matrix[: forms.finite], point.p)
    verdict: Verdict = "proved" if rank == forms.finite else "probable"
    return Variety(True, forms.n - rank, verdict, samples, _real(forms, reference), about="reference")


def _is_regular(forms: Codistribution, point: FieldPoint) -> bool:
    """Do the rows that depend on others at the point depend on them along a curve through it?

    On the fields X with A_d X_d = -A_f X_f, A the independent rows, every other row has to vanish.
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
    for row in others:
        along = {c: curve.at[node] for c, node in row.items()}
        for k in range(ORDER):
            total = [0] * len(frame.free)
            for j in range(k + 1):
                field: nmod_mat = curve.full_frame[k - j]
                for c, series in along.items():
                    factor = int(series.coefficient(j))
                    total = [t + factor * int(field[c, f]) for f, t in enumerate(total)] if factor else total
            if any(t % point.p for t in total):
                return False
    return True


def _real(forms: Codistribution, reference: Mapping[Expr, Expr]) -> RealPoint | None:
    """The reference with balls; certified where every relation is proved to be 0 there."""
    chart, known = forms.chart, {**reference, ex.TIME: ex.ZERO}
    if "balls" not in chart.engines:
        return None
    with ctx.workprec(max(ctx.prec, precision())):
        ball = ball_point(chart, known, random.Random("dofkit reference"))
        matrix = None if ball is None else ball_matrix(chart, ball, True)
    if ball is None or matrix is None:
        return None
    exact = all(zero_and_verdict(substitute(g, known), chart.positive) == (True, "proved") for g in chart.relations)
    part = ball_part(matrix) if matrix else ball_part([[arb(0)] * len(chart.symbols)])
    return RealPoint(ball, part, exact, True, matrix)
