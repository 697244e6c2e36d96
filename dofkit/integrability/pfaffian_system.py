"""A block's relations as one-forms: I, spanned by the differentials of the finite ones and by the Pfaffian forms."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from flint import arb

from dofkit.base.errors import NoValueError
from dofkit.configuration.at_reference import CLEAR, ball_matrix, ball_point
from dofkit.configuration.generic_points import on_variety, pose_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.frames import FormRows
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, uses_time
from dofkit.relations.chart import Chart, make_chart
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting


@dataclass
class Codistribution:
    """The rows of a block as one-forms over a chart: finite differentials, then Pfaffian forms."""

    chart: Chart
    rows: FormRows
    finite: int

    @property
    def n(self) -> int:
        """The coordinates, time apart."""
        return self.chart.coordinates


def codistribution(block: Block, setting: Setting, extra: Sequence[Expr], more: Sequence[Expr] = ()) -> Codistribution:
    """dg for every finite relation (those ``extra`` included), then the Pfaffian forms; ``more`` is evaluated too."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    timed = uses_time(block) or any(ex.TIME in e.symbols for e in extra)
    symbols = [ex.coordinate(c) for c in block.coordinates] + ([ex.TIME] if timed else [])
    gradients = [{i: diff(g, s) for i, s in enumerate(symbols) if s in g.symbols} for g in finite]
    place = {s: i for i, s in enumerate(symbols)}
    forms = [{place[s]: e for s, e in r.piece.items()} for r in block.forms if isinstance(r.piece, Pfaffian)]
    chart = make_chart(block, setting, extra, [*(e for g in gradients for e in g.values()), *more])
    entries = tuple({c: chart.ring.node(e) for c, e in row.items() if not e.is_zero} for row in (*gradients, *forms))
    return Codistribution(chart, FormRows(chart.ring, entries, chart.columns), len(finite))


def linear_rows(block: Block, forms: Codistribution) -> Iterator[tuple[int, Row, int]]:
    """(number, row, its place among the forms) of the block's rows that are no nonlinear relations of velocities."""
    own = len(block.finite)
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        yield i, row, i if i < own else i + forms.finite - own


def first_order_freedom(block: Block, setting: Setting, reference: Mapping[Expr, Expr]) -> tuple[int | None, bool]:
    """Velocities that the rows allow at the reference configuration, and whether that is proved.

    None where it is not on the variety. A rank over GF(p) is not too large; of as many rows it is not too small.
    """
    forms = codistribution(block, setting, ())
    if "field" not in setting.engines:
        return _first_order_by_balls(forms, reference), False
    point = pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not on_variety(forms.chart, point):
        return None, False
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    except NoValueError:
        return None, False
    rank = rank_of([row[: forms.n] for row in matrix], point.p)
    return forms.n - rank, rank == len(matrix)


def _first_order_by_balls(forms: Codistribution, reference: Mapping[Expr, Expr]) -> int | None:
    ball = ball_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, random.Random("dofkit reference"))
    if ball is None or ball_matrix(forms.chart, ball, True) is None:
        return None
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, ball), arb(0))
    except NoValueError:
        return None
    part = ball_part([row[: forms.n] for row in matrix])
    return forms.n - part.rank if part.gap > CLEAR else None
