"""The geometry of a joint, and which coordinates its equations mention, without these being written out."""

from __future__ import annotations

from itertools import chain
from typing import Literal, NamedTuple

from dofkit.expressions.terms import longest_number
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import Vec
from dofkit.scene.frames import Frame
from dofkit.scene.world import Direction

#: What no part of a joint's equations leaves out; see `Joint`.
Mentions = Literal["place", "turn", "moving", "apart"]
#: Numbers of so many bits make no long ones.
FEW_BITS = 16


class JointGeometry(NamedTuple):
    """The geometry of a joint: its ``place`` (None where its equations need none), its axes, a screw's pitch."""

    place: Vec | None = None
    axes: tuple[Direction, ...] = ()
    number: Expr | None = None

    @property
    def axis(self) -> Direction:
        """The only axis, or the first."""
        return self.axes[0]

    @property
    def at(self) -> Vec:
        """The place of a joint that has one."""
        return self.place or ()


def longest_of(first: Frame, second: Frame, drawn: JointGeometry) -> int | None:
    """Return the bits of the longest number in equations of two frames drawn in fractions; None for others."""
    moving = [frame for frame in (first, second) if not frame.fixed]
    if not moving or any(frame.chart not in ("plane", "gibbs") for frame in moving) or drawn.number is not None:
        return None
    numbers = [
        *chain.from_iterable((*frame.start, *(frame.initial if frame.chart == "plane" else ())) for frame in moving),
        *(drawn.place or ()),
        *chain.from_iterable(axis.vector for axis in drawn.axes),
    ]
    if any(part.op != "num" for part in numbers):
        return None
    bits = longest_number(numbers)
    return bits if bits < FEW_BITS else 2 * bits + 4


def coordinates_mentioned(
    mentions: Mentions | None, first: Frame, second: Frame, drawn: JointGeometry
) -> frozenset[str] | None:
    """Return the coordinates that equations of two frames mention, where no part of these stands alone; else None.

    The angles of a body occur in all equations of a place that is not its origin, unless the plane needs no axis. What
    is stated in the directions of the first of two moving bodies mentions all their coordinates.
    """
    positions = [str(x.args[1]) for frame in (first, second) for x in frame.position if x.op == "sym"]
    one_origin = mentions == "apart" and first.start == second.start
    if mentions in ("moving", "apart") and not (first.fixed or second.fixed or one_origin):
        return frozenset(positions).union(first.angles, second.angles)
    if mentions not in ("place", "turn"):
        return None
    armed = [frame for frame in (first, second) if not frame.fixed and frame.start != drawn.at]
    turning = (first, second) if mentions == "turn" and drawn.axes else armed
    return frozenset(positions).union(*(frame.angles for frame in turning)) if armed else None
