"""Does a relation follow from others near the drawing?

Let S be relations that are independent at the drawing P, and M the manifold that they cut out there
[ImplicitFunctions]. A relation g follows from S near P if and only if it vanishes on M. That its row is a sum of the
rows of S at P says less: of three points on a line two distances give the third to first order only. So g is followed
along a random curve of M: what is not 0 there is a proof that it does not follow, what is 0 to an order above its
degree, and at a distance, vanishes on M with high probability [SchwartzZippel].

Measured geometry is followed for a finite step, within the tolerance.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from dofkit.configuration.drawing.at_reference import ball_point
from dofkit.configuration.drawing.dependent_classes import chart_of
from dofkit.configuration.drawing.fewer_coordinates import smaller
from dofkit.configuration.drawing.measured import measure
from dofkit.configuration.generic_points import on_variety, pose_point
from dofkit.configuration.local.dimension import vanish_near
from dofkit.configuration.reality import BALL_COLUMNS
from dofkit.configuration.rigid_motions import rigid_motions
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart
from dofkit.relations.setting import Setting


@dataclass(frozen=True)
class ImpliedRelations:
    """What the relations of a chart imply of each other near the drawing, at t = 0; asked once each."""

    chart: Chart
    setting: Setting
    drawing: Mapping[Expr, Expr]
    _told: dict[tuple[int, ...], bool | None] = field(default_factory=dict)

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Does relation ``row`` vanish near the drawing where ``others`` do? Those are independent at the drawing.

        None where it was not decided.
        """
        key = (row, *sorted(others))
        if key not in self._told:
            own = chart_of(self.chart, sorted(key))
            look = _on_manifold if self.setting.tolerance is None else _within_tolerance
            self._told[key] = look(own, self.setting, {**self.drawing, ex.TIME: ex.ZERO}, len(others))
        return self._told[key]


def _on_manifold(chart: Chart, setting: Setting, known: Mapping[Expr, Expr], rank: int) -> bool | None:
    """Do the relations cut out a manifold of codimension ``rank``, which is that of all but one of them?"""
    del setting
    if "field" not in chart.engines:
        return None
    small, free = smaller(chart, known)
    gone = len(chart.columns) - len(small.columns) - free
    if not small.nodes:
        return gone == rank
    point = pose_point(small, known, 3)
    if point is None or not on_variety(small, point):
        return None
    rigid = rigid_motions(small, point)
    few = len(chart.columns) - rank - rigid <= BALL_COLUMNS
    ball = ball_point(small, known, point.rng) if few and "balls" in chart.engines else None
    return vanish_near(small, point, ball, rigid, rank - gone)


def _within_tolerance(chart: Chart, setting: Setting, known: Mapping[Expr, Expr], rank: int) -> bool | None:
    """The same of measured relations: does what moves under all but one of them keep that one within the tolerance?"""
    ball = ball_point(chart, known, random.Random("dofkit implied"))
    point = pose_point(chart, known, 3)
    if ball is None or point is None or "balls" not in chart.engines:
        return None
    at = {s: float(v.mid()) for s, v in ball.symbols.items()}
    rigid = rigid_motions(chart, point)
    told = measure(chart, at, setting.roles, float(setting.tolerance or 0), setting.size, rigid)
    return None if told.dimension is None else told.dimension == chart.coordinates - rank
