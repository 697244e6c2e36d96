"""What the drawn configuration allows: to first order, and as a motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from flint import arb, ctx

from dofkit import expr as ex
from dofkit.chart import Chart
from dofkit.exact.balls import PRECISION, BallPoint, OutsideDomainError
from dofkit.exact.field import FieldPoint
from dofkit.exact.program import values
from dofkit.exact.ring import Ring
from dofkit.expr import Expr
from dofkit.motion import Local
from dofkit.rank import rank_of
from dofkit.rigid import rigid_motions
from dofkit.variety import BALL_COLUMNS, field_jacobian, local_at, on_variety, pose_point


@dataclass(frozen=True)
class AtReference:
    """``instantaneous``: velocities allowed to first order; ``local``: the dimension of the finite motion.

    ``matrix`` is the Jacobian there over GF(``modulus``). ``confined``: the relations fix the time.
    """

    instantaneous: int
    local: Local
    matrix: list[list[int]]
    modulus: int
    rank: int
    confined: bool
    rigid: int
    ball: BallPoint | None


def at_reference(chart: Chart, reference: Mapping[Expr, Expr], exact: bool = True) -> AtReference | None:
    """The answer at the reference configuration (t = 0); None where that is not on the variety.

    With measured geometry (not ``exact``) the relations need not hold there to the last digit.
    """
    known = {**reference, ex.TIME: ex.ZERO}
    point = pose_point(chart, known, 3)
    if point is None or (exact and not on_variety(chart, point)):
        return None
    matrix = field_jacobian(chart, point)
    n = chart.coordinates
    rank, rank_q = rank_of(matrix, point.p), rank_of([row[:n] for row in matrix], point.p)
    timed = len(chart.columns) - n
    rigid = rigid_motions(chart, point)
    ball = None
    if not exact:
        ball = ball_point(chart, known, point)
        local = Local(None, "undecided", "measured")
        return AtReference(n - rank_q, local, [], point.p, rank, False, rigid, ball)
    if rank < len(matrix) and len(chart.columns) - rank - timed - rigid <= BALL_COLUMNS:
        ball = ball_point(chart, known, point)
    local = local_at(chart, point, ball, rigid + timed)
    if local.dimension is not None:
        local = Local(local.dimension - timed, local.verdict, local.reason)
    shown = [[int(v) for v in row] for row in matrix]
    return AtReference(n - rank_q, local, shown, point.p, rank, rank_q < rank, rigid, ball)


def ball_point(chart: Chart, known: Mapping[Expr, Expr], seen: FieldPoint) -> BallPoint | None:
    """The reference configuration with balls; symbols without a value get random ones."""
    ctx.prec = PRECISION
    symbols: dict[Expr, Any] = {}
    for var in chart.ring.vars:
        if var.kind != "symbol":
            continue
        value = known.get(var.key)
        if value is None:
            symbols[var.key] = arb(seen.rng.randrange(257, 1023)) / 512
            continue
        ring = Ring([value])
        node = ring.node(value)
        constants = {v.key: arb(3) / 4 for v in ring.vars if v.kind == "symbol"}
        try:
            symbols[var.key] = values(ring, BallPoint(constants, 0))[node]
        except (OutsideDomainError, ZeroDivisionError):
            return None
    return BallPoint(symbols, 0)
