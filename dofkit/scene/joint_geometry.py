"""What a joint is drawn with, and which coordinates its equations mention, without these being written out."""

from __future__ import annotations

from itertools import chain
from typing import NamedTuple

from dofkit.expressions.terms import longest_number
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import Vec
from dofkit.scene.frames import Frame
from dofkit.scene.world import Direction

#: Numbers of so many bits make no long ones.
FEW_BITS = 16


class JointGeometry(NamedTuple):
    """What a joint is drawn with: its ``place`` (None where its equations need none), its axes, a screw's pitch."""

    place: Vec | None = None
    axes: tuple[Direction, ...] = ()
    number: Expr | None = None

    @property
    def axis(self) -> Direction:
        """The only axis, or the first."""
        return self.axes[0]

    @property
    def at(self) -> Vec:
        """The place, which is there."""
        return self.place or ()


def longest_of(first: Frame, second: Frame, drawn: JointGeometry) -> int | None:
    """The bits of the longest number in equations of two frames drawn in fractions; None for others."""
    moving = [frame for frame in (first, second) if not frame.fixed]
    if not moving or any(frame.chart not in ("plane", "gibbs") for frame in moving) or drawn.number is not None:
        return None
    given = [
        *chain.from_iterable((*frame.start, *(frame.initial if frame.chart == "plane" else ())) for frame in moving),
        *(drawn.place or ()),
        *chain.from_iterable(axis.vector for axis in drawn.axes),
    ]
    if any(part.op != "num" for part in given):
        return None
    bits = longest_number(given)
    return bits if bits < FEW_BITS else 2 * bits + 4


def coordinates_of(frame: Frame) -> frozenset[str]:
    """A body's own; none of the ground."""
    return frozenset(str(part.args[1]) for part in frame.position if part.op == "sym") | {*frame.angles}


def arms(first: Frame, second: Frame, place: Vec) -> list[Frame]:
    """Those of two bodies whose origins stand elsewhere than a place."""
    return [frame for frame in (first, second) if not frame.fixed and frame.start != place]


def mentioned_together(first: Frame, second: Frame, place: Vec, turns: bool) -> frozenset[str] | None:
    """What X1 = X2 mentions, and with ``turns`` something of how one body turns against the other; see `Joint`.

    A body's turns stand in all equations of a place that is not its origin.
    """
    armed = arms(first, second, place)
    if not armed:
        return None
    turned = (first, second) if turns else armed
    places = frozenset(str(part.args[1]) for frame in (first, second) for part in frame.position if part.op == "sym")
    return places.union(*(frame.angles for frame in turned))


def mentioned_by_moving(first: Frame, second: Frame) -> frozenset[str] | None:
    """All coordinates of two bodies that both move: what is said in the first one's directions mentions all of them."""
    return None if first.fixed or second.fixed else coordinates_of(first) | coordinates_of(second)
