"""The parts of a relative motion that a joint can hold, and what of it can be prescribed.

A joint is a row of parts. Each part has its relations between the two frames and the rows of the same equations in
velocities, so that no type states either.

Material points at the same place ``a`` of the reference are X_i = p_i + R_i (a - p0_i). Where both
bodies are written in Gibbs vectors g_i, the rotation R1^T R2 is the quaternion (s, v) with
s = 1 + g1.g2 and v = g2 - g1 - g1 x g2, and a shared axis n is v.u = 0 for the u across n: of the
two ways to keep the lines parallel this leaves out the one with the axis turned over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Literal, NamedTuple

from dofkit.exact.matrices import sparse as rows
from dofkit.expressions.calculus import longest_number
from dofkit.expressions.tree import HALF, MINUS_ONE, PI, ZERO, Expr, add, fn, mul
from dofkit.expressions.vectors import Vec, cross, difference, dot, is_zero, length, minus, scaled, unit
from dofkit.scene.constraints.base import component_relations
from dofkit.scene.constraints.places import along
from dofkit.scene.frames import Frame, between, relative
from dofkit.scene.world import Direction
from dofkit.system import Kinematics, Relation, VelocityRow

#: Numbers of so many bits make no long ones.
FEW_BITS = 16


class JointGeometry(NamedTuple):
    """The geometry of a joint: its ``place`` (None where its equations need none), its axes, a screw's pitch.

    In the plane a joint that turns has no axis.
    """

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


# The parts of a relative motion that joints hold


def _point(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """X2 - X1 = 0 for the material points at the place: d relations."""
    yield from component_relations(between(first.point(drawn.at), second.point(drawn.at))[0], "point {}", drawn.at)


def _origin(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """p2 - p1 - R1 (p02 - p01) = 0, cleared: d relations."""
    del drawn
    frame = carrier(first, second)
    start = minus(second.start, first.start)
    moved = minus(second.position, first.position)
    if not is_zero(start):
        moved = minus(scaled(frame.under, moved), frame.carry(start))
    yield from component_relations(moved, "origin {}")


def _orientation(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """No relative rotation: the plane angle, or 3 relations in space.

    theta2 - theta1 - const = 0; g2 - g1 = 0; or the Gibbs vector of B = R1^T R2, of which 1 + tr B times two are
    B32 - B23, B13 - B31, B21 - B12, and which no half turn has.
    """
    del drawn
    if first.dimension == 2:
        yield Relation(difference(second.angle, first.angle), part="angle")
    elif first.gibbs is not None and second.gibbs is not None:
        yield from component_relations(minus(second.gibbs, first.gibbs), "orientation {}")
    else:
        a, b = ([frame.carry(unit(i, 3)) for i in range(3)] for frame in (first, second))
        trace = sum((dot(a[i], b[i]) for i in range(3)), mul(first.under, second.under))
        for i, j, about in ((0, 1, "z"), (1, 2, "x"), (2, 0, "y")):
            yield Relation(difference(dot(a[i], b[j]), dot(a[j], b[i])) / trace, part=f"orientation {about}")


def _axis(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """Yield 2 relations that keep the direction n of the axis the same in both bodies, one for each u across n.

    In general (R1 n).(R2 u) = 0, which keeps them from turning about n x u. Where both rotations are given by Gibbs
    vectors, v.u = 0 with the vector part v of the quaternion of R1^T R2 keeps them from turning about u.
    """
    for axis in drawn.axes:
        turned = relative(first, second)
        carried = first.carry(axis.vector) if turned is None else ()
        for across in axis.across:
            if turned is None:
                yield Relation(dot(carried, second.carry(across)), part="axis", vector=cross(axis.vector, across))
            else:
                yield Relation(dot(turned[1], across), part="axis", vector=across)


def _axes(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """Yield the relation that the first axis, carried by the first body, is perpendicular to the second."""
    a, b = (axis.vector for axis in drawn.axes)
    turned = relative(first, second)
    if turned is None:
        e = dot(first.carry(a), second.carry(b))
    else:
        scalar, vector = turned
        e = add(mul(dot(vector, a), dot(vector, b)), mul(scalar, dot(vector, cross(b, a))))
    yield Relation(e, part="axes")


def _across(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """Yield the relations that the second body does not move across the axis of the first."""
    for u in drawn.axis.across:
        yield Relation(slide(first, second, drawn, u)[0], part="across", vector=u)


def _distance(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """Yield the relation that the second body does not move along the axis of the first."""
    n = drawn.axis.vector
    yield Relation(slide(first, second, drawn, n)[0], part="distance", vector=n)


def _thread(first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
    """displacement - pitch angle / (2 pi) = 0, cleared."""
    n = drawn.axis.vector
    moved, under = slide(first, second, drawn, n)
    advance = mul(drawn.number or ZERO, angle_of(first, second, drawn)) / (2 * PI)
    yield Relation(difference(moved, mul(length(n), under, advance)), part="thread")


def turn_rate(at: Kinematics) -> VelocityRow:
    """Return how fast the second body turns against the first, in space about the axis."""
    turn = at.turn()
    return turn[0] if at.dimension == 2 else rows.along(at.directions[0], turn)


def slide_rate(at: Kinematics) -> VelocityRow:
    """Return how fast the second body moves along the axis against the first."""
    return rows.along(at.directions[0], at.shift())


class HeldPart(NamedTuple):
    """A part of a relative motion that is fixed: its ``relations``, and the rows of its ``velocities``."""

    relations: Callable[[Frame, Frame, JointGeometry], Iterator[Relation]]
    velocities: Callable[[Kinematics], Iterable[VelocityRow]]


Part = Literal["point", "origin", "orientation", "axis", "axes", "across", "distance", "thread"]
#: What a joint can hold of the second body against the first: a common point, its origin, its orientation, the
#: direction of a common axis, two axes at a right angle, the displacement across or along the axis, an advance by turn.
PARTS: Mapping[Part, HeldPart] = {
    "point": HeldPart(_point, lambda at: at.shift()),
    "origin": HeldPart(_origin, lambda at: at.shift()),
    "orientation": HeldPart(_orientation, lambda at: at.turn()),
    "axis": HeldPart(_axis, lambda at: rows.across(at.directions[0], at.turn()) if at.dimension == 3 else ()),
    "axes": HeldPart(_axes, lambda at: [rows.along(rows.cross(*at.directions), at.turn())]),
    "across": HeldPart(_across, lambda at: rows.across(at.directions[0], at.shift())),
    "distance": HeldPart(_distance, lambda at: [slide_rate(at)]),
    "thread": HeldPart(_thread, lambda at: [rows.combined(((1, slide_rate(at)), (-at.number, turn_rate(at))))]),
}


@dataclass(frozen=True)
class Holds:
    """What a joint holds, in the order of its equations; called, it yields the rows of their velocities."""

    motion_parts: tuple[Part, ...]

    def __call__(self, at: Kinematics) -> Iterator[VelocityRow]:
        for part in self.motion_parts:
            yield from PARTS[part].velocities(at)

    def relations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        """Yield the relations between the two frames."""
        for part in self.motion_parts:
            yield from PARTS[part].relations(first, second, drawn)

    @property
    def placed(self) -> bool:
        """Whether the equations need a place: that of the point, or of an axis about which the bodies turn."""
        return "point" in self.motion_parts or ("axis" in self.motion_parts and "across" in self.motion_parts)

    def mentioned(self, first: Frame, second: Frame, drawn: JointGeometry) -> frozenset[str] | None:
        """Return the coordinates that the equations mention, where no part of these stands alone; else None.

        The angles of a body occur in all equations of a place that is not its origin, unless the plane needs no axis.
        What is stated in the directions of the first of two moving bodies mentions all their coordinates.
        """
        positions = [str(x.args[1]) for frame in (first, second) for x in frame.position if x.op == "sym"]
        if "point" not in self.motion_parts:
            one_origin = "origin" in self.motion_parts and first.start == second.start
            whole = not (first.fixed or second.fixed or one_origin)
            return frozenset(positions).union(first.angles, second.angles) if whole else None
        armed = [frame for frame in (first, second) if not frame.fixed and frame.start != drawn.at]
        turning = (first, second) if drawn.axes else armed
        return frozenset(positions).union(*(frame.angles for frame in turning)) if armed else None


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


class Measure(NamedTuple):
    """An angle or displacement of a joint: its ``value``, the ``law`` that it follows, and its ``rate``.

    The value and the law are those of two frames with the joint's geometry; ``turns``: it is an angle.
    """

    value: Callable[[Frame, Frame, JointGeometry], Expr]
    law: Callable[[Frame, Frame, JointGeometry, Expr], Expr]
    rate: Callable[[Kinematics], VelocityRow]
    turns: bool = False


def carrier(first: Frame, second: Frame) -> Frame:
    """Return the frame in which directions common to both are simplest: the ground's, else the first."""
    return second if second.fixed else first


def slide(first: Frame, second: Frame, drawn: JointGeometry, direction: Vec) -> tuple[Expr, Expr]:
    """Return how far the second body has moved from the first along a direction of both, as numerator and denominator.

    It is the body's point at the joint's place, or its origin where that has none: bodies that do not turn against each
    other, or slide on a plane across the direction.
    """
    frame = carrier(first, second)
    other = first if frame is second else second
    place = other.start if drawn.place is None else drawn.place
    point = other.point(place)
    moved, under = along(frame, point, place, direction), mul(frame.under, point.under)
    return (mul(MINUS_ONE, moved) if frame is second else moved), under


def _displacement(first: Frame, second: Frame, drawn: JointGeometry) -> Expr:
    n = drawn.axis.vector
    moved, under = slide(first, second, drawn, n)
    return moved / mul(under, length(n))


def _displacement_law(first: Frame, second: Frame, drawn: JointGeometry, law: Expr) -> Expr:
    """Displacement along the axis less the law, n.X - |n| f = 0 with X the displacement, times its denominator."""
    n = drawn.axis.vector
    moved, under = slide(first, second, drawn, n)
    return difference(moved, mul(length(n), under, law))


def angle_of(first: Frame, second: Frame, drawn: JointGeometry) -> Expr:
    """Return the second body's angle against the first, in space about the shared axis, right-handed."""
    if not drawn.axes:
        return difference(second.angle, first.angle)
    n = drawn.axis.vector
    turned = relative(first, second)
    if turned is not None:
        return 2 * fn("atan", dot(turned[1], n) / (turned[0] * length(n)))
    return fn("atan2", *_sine_and_cosine(first, second, drawn.axis))


def _angle_law(first: Frame, second: Frame, drawn: JointGeometry, law: Expr) -> Expr:
    """Return what is 0 where the angle of the second body against the first about the axis is ``law``.

    In the plane theta2 - theta1 - f = 0. In space v.n cos(f/2) - s |n| sin(f/2) = 0, or with
    w = n x u: (R1 w).(R2 u) cos f - |n| (R1 u).(R2 u) sin f = 0.
    """
    if not drawn.axes:
        return difference(angle_of(first, second, drawn), law)
    turned = relative(first, second)
    if turned is None:
        sine, cosine = _sine_and_cosine(first, second, drawn.axis)
    else:
        n, law = drawn.axis.vector, mul(HALF, law)
        sine, cosine = dot(turned[1], n), mul(turned[0], length(n))
    return difference(mul(sine, fn("cos", law)), mul(cosine, fn("sin", law)))


def _sine_and_cosine(first: Frame, second: Frame, axis: Direction) -> tuple[Expr, Expr]:
    """Return sine and cosine of the angle about the axis n, times one positive factor, by u across n and n x u."""
    u = axis.across[0]
    now = second.carry(u)
    return dot(first.carry(cross(axis.vector, u)), now), mul(length(axis.vector), dot(first.carry(u), now))


#: What a drive may prescribe, and a coupling may mention.
ANGLE = Measure(angle_of, _angle_law, turn_rate, turns=True)
DISPLACEMENT = Measure(_displacement, _displacement_law, slide_rate)
