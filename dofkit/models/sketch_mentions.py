"""What a constraint of a sketch in space mentions, how that is measured, and how it is written as an equation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.models.sketch_relations import Written
from dofkit.models.sketch_scene import SOLVED
from dofkit.models.sketch_space import (
    PlaneFrame,
    Projection,
    SpaceCubic,
    SpaceLine,
    SpacePlane,
    SpacePoint,
    SpaceRound,
    SpaceVector,
)


class SpaceMentions(NamedTuple):
    """What a constraint mentions: points, lines and normals, the frames of normals, planes, circles and arcs.

    ``fresh`` makes a coordinate of a drawn value; ``others``: its two choices; ``origin``: of the workplane in which it
    is ``measure``d.
    """

    points: tuple[SpacePoint, ...]
    lines: tuple[SpaceLine, ...]
    frames: tuple[PlaneFrame, ...]
    planes: tuple[SpacePlane, ...]
    curves: tuple[SpaceRound | SpaceCubic, ...]
    fresh: Callable[[float], Expr]
    value: float
    others: tuple[bool, bool]
    measure: Projection = Projection(None, False)
    origin: SpaceVector | None = None

    @property
    def rounds(self) -> tuple[SpaceRound, ...]:
        """Its circles and arcs."""
        return tuple(one for one in self.curves if isinstance(one, SpaceRound))

    @property
    def directions(self) -> tuple[SpaceVector, ...]:
        """Where its curves meet: across arcs, along cubics."""
        found = []
        for one, end in zip(self.curves, self.others, strict=False):
            if isinstance(one, SpaceCubic):
                found.append(one.tangents[end])
            elif one.ends is not None:
                found.append(one.ends[end].place.minus(one.centre.place))
        return tuple(found)

    @property
    def counted(self) -> tuple[int, int, int, int, int]:
        """How many points, lines with ends, normals, planes and curves there are."""
        ends = sum(line.ends is not None for line in self.lines)
        return len(self.points), ends, len(self.frames), len(self.planes), len(self.curves)

    @property
    def common_plane(self) -> int:
        """The workplane in which all of it is drawn; 0 where there is none."""
        on_rounds = [p for one in self.rounds for p in (one.centre, *(one.ends or ()))]
        seen = {p.plane for p in (*self.points, *on_rounds)} | {line.plane for line in self.lines}
        seen |= {one.plane for one in self.curves if isinstance(one, SpaceCubic)}
        return seen.pop() if len(seen) == 1 else 0

    @property
    def ends(self) -> tuple[SpacePoint, SpacePoint]:
        """The ends of its line, or its two points."""
        found = self.lines[0].ends if self.lines else None
        return found or (self.points[0], self.points[1])

    @property
    def joinable(self) -> bool:
        """Can a constraint of a scene name its two points? One is a particle, and the other one is another point."""
        one, other = (p.written for p in self.points)
        return None not in (one, other) and one != other and not (isinstance(one, list) and isinstance(other, list))

    def to(self, line: int, point: int) -> SpaceVector:
        """From the second end of a line to a point."""
        ends = self.lines[line].ends or self.ends
        return self.points[point].place.minus(ends[1].place)


class SpaceKind(NamedTuple):
    """A kind: what it says, and how many points, lines with ends, normals, planes and curves it needs.

    ``flat``: only in a workplane; ``metric``: where lengths are known; ``seen``: in a workplane it says another thing
    than in space; ``curves``: of which types its curves are.
    """

    says: Callable[[SpaceMentions], Iterator[Written]]
    needs: tuple[tuple[int, int, int, int, int], ...]
    flat: bool = False
    metric: bool = False
    seen: bool = True
    curves: tuple[type, ...] = (SpaceRound,)

    def reads(self, m: SpaceMentions) -> bool:
        """Can it be told as its mentions are measured? A plane is seen from a workplane where that holds the rest."""
        if not all(isinstance(one, self.curves) for one in m.curves):
            return False
        if m.measure.frame is None:
            return not self.flat
        if m.planes and not m.measure.within:
            return False
        return m.measure.metric or not self.metric


def zero(e: Expr) -> Written:
    """The equation e = 0."""
    return equal(e, ZERO)


def equal(left: Expr, right: Expr) -> Written:
    """An equation; of numbers alone one that always holds, where SolveSpace takes it to hold."""
    if not left.symbols and not right.symbols:
        one, other = approximate(left), approximate(right)
        if one is not None and other is not None and abs(one - other) < SOLVED * max(1.0, abs(one)):
            left = right = ZERO
    return {"type": "equation", "text": f"{to_text(left)} = {to_text(right)}"}
