"""Finite against instantaneous freedom: the dimension of {g = 0} near one of its points, by the table of criteria."""

from __future__ import annotations

from flint import ctx

from dofkit.configuration.generic_points import frame_at
from dofkit.configuration.local.criteria import decision
from dofkit.configuration.local.first_order import of_high_degree
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.points.balls import BallPoint, precision
from dofkit.exact.points.field import FieldPoint
from dofkit.relations.chart import Chart


@raising_no_value
def local_dimension(
    field: Manifold, ball: Manifold | None, rigid: int, time: int | None = None, distance: bool = True
) -> LocalDimension:
    """The local dimension at the point; ``rigid`` is the dimension of the motions that move everything as one body.

    ``field`` is over GF(p), where a coefficient that is not 0 proves that the function is not; ``ball`` at the
    same point decides signs. ``time`` is the number of its column, if it is one; ``distance``: must what is flat
    at the point be looked at from a distance? Raises NoValueError.
    """
    with ctx.workprec(max(ctx.prec, precision())):
        return decision(Germ(field, ball, rigid, time, distance))[1]


@raising_no_value
def numeric_dimension(ball: Manifold, rigid: int, time: int | None = None) -> LocalDimension:
    """The same from an approximate point: where a tiny ball contains 0 it is taken for 0; the verdict is numeric."""
    return decision(Germ(None, ball, rigid, time))[1]


def local_at(
    chart: Chart, point: FieldPoint, ball: BallPoint | None, rigid: int, time: int | None = None, drawn: bool = True
) -> LocalDimension:
    """The local dimension at a point of the variety, time counted where it is a column.

    ``time``: the number of that column, where it matters whether time moves on. A point that was ``drawn`` may be one
    where a relation is flat: what is 0 along a curve is looked at from a distance, if balls may be asked.
    """
    frame = frame_at(chart, point)
    try:
        field_manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, point)
        ball_manifold = None
        if ball is not None:
            ball_manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, ball, chart.scales)
        return local_dimension(field_manifold, ball_manifold, rigid, time, drawn and "balls" in chart.engines)
    except NoValueError:
        return LocalDimension(
            None, "undecided", "the equations could not be evaluated along a curve through this configuration"
        )


def vanish_near(chart: Chart, point: FieldPoint, ball: BallPoint | None, rigid: int, rank: int) -> bool | None:
    """Are the relations of a chart of no higher rank than ``rank`` at the point, and 0 on the manifold of that rank?

    The dependent ones are 0 along a random curve of it [SchwartzZippel], or nothing but motions of the whole is left.
    None where they are too high in degree, or could not be followed to a distance, which is asked of a ``ball``.
    """
    frame = frame_at(chart, point)
    if len(frame.rows) != rank:
        return False
    try:
        on_field = Manifold(chart.ring, chart.nodes, chart.columns, frame, point)
        on_balls = None
        if ball is not None:
            on_balls = Manifold(chart.ring, chart.nodes, chart.columns, frame, ball, chart.scales)
        return _vanish(Germ(on_field, on_balls, rigid, distance=ball is not None))
    except (ArithmeticError, NoValueError):
        return None


def _vanish(germ: Germ) -> bool | None:
    """Are the dependent relations of a germ 0 on its manifold?"""
    with ctx.workprec(max(ctx.prec, precision())):
        if germ.dependent == 0 or germ.m == germ.rigid:
            return True
        if of_high_degree(germ):
            return None
        return germ.vanishes_away if germ.vanishes else False
