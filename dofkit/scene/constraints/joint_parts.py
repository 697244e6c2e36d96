"""The parts of a relative motion that a joint can fix, and the angle or displacement that can be prescribed.

A joint is a sequence of fixed parts. Each part defines its relations between the two frames and the rows of the same
equations in velocities.

Notation: p_i, R_i are position and rotation of body i, p0_i its reference position. The material points at the place
``a`` of the reference are X_i = p_i + R_i (a - p0_i). If both rotations are given by Gibbs vectors g_i, R1^T R2 is the
quaternion (s, v) with s = 1 + g1.g2 and v = g2 - g1 - g1 x g2, and bodies that share an axis n satisfy v.u = 0 for the
u perpendicular to n, which excludes the half turns that reverse the axis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Literal, NamedTuple

from dofkit.exact.matrices import sparse as rows
from dofkit.expressions.calculus import longest_number
from dofkit.expressions.tree import HALF, MINUS_ONE, PI, ZERO, Expr, add, fn, mul
from dofkit.expressions.vectors import Vec, cross, difference, dot, is_zero, length, minus, scaled, square, unit
from dofkit.scene.constraints.base import component_relations
from dofkit.scene.constraints.places import along
from dofkit.scene.frames import Frame, between, relative
from dofkit.scene.world import Direction
from dofkit.system import Kinematics, Relation, VelocityRow

#: Below this many bits, `longest_of` states the bits of the input, because products stay short.
FEW_BITS = 16


class JointGeometry(NamedTuple):
    """A joint in the reference configuration: its ``place`` (None if not needed), axes, and pitch (``number``).

    In the plane a joint that turns has no axis.
    """

    place: Vec | None = None
    axes: tuple[Direction, ...] = ()
    number: Expr | None = None

    @property
    def axis(self) -> Direction:
        """The first axis."""
        return self.axes[0]

    @property
    def at(self) -> Vec:
        """The place; an empty vector if there is none."""
        return self.place or ()


# The parts of a relative motion that joints fix


def _point(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield X2 - X1 = 0 for the material points at the joint's place: d relations."""
    yield from component_relations(
        between(first.point(geometry.at), second.point(geometry.at))[0], "point {}", geometry.at
    )


def _origin(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield p2 - p1 - R1 (p02 - p01) = 0, times a denominator: d relations."""
    del geometry
    frame = carrier(first, second)
    start = minus(second.start, first.start)
    moved = minus(second.position, first.position)
    if not is_zero(start):
        moved = minus(scaled(frame.under, moved), frame.carry(start))
    yield from component_relations(moved, "origin {}")


def _orientation(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield the relations that there is no relative rotation: 1 in the plane, 3 in space.

    In the plane theta2 - theta1 = 0; in space g2 - g1 = 0, or else that the Gibbs vector of B = R1^T R2 is 0: its
    components are (B32 - B23, B13 - B31, B21 - B12) / (1 + tr B), up to a factor, and undefined for half turns.
    """
    del geometry
    if first.dimension == 2:
        yield Relation(difference(second.angle, first.angle), part="angle")
    elif first.gibbs is not None and second.gibbs is not None:
        yield from component_relations(minus(second.gibbs, first.gibbs), "orientation {}")
    else:
        a, b = ([frame.carry(unit(i, 3)) for i in range(3)] for frame in (first, second))
        trace = sum((dot(a[i], b[i]) for i in range(3)), mul(first.under, second.under))
        for i, j, about in ((0, 1, "z"), (1, 2, "x"), (2, 0, "y")):
            yield Relation(difference(dot(a[i], b[j]), dot(a[j], b[i])) / trace, part=f"orientation {about}")


def _axis(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield 2 relations that the axis n has the same direction in both bodies, one for each u perpendicular to n.

    With Gibbs vectors for both rotations v.u = 0 (no rotation about u), with the vector part v of the quaternion of
    R1^T R2; otherwise (R1 n).(R2 u) / (|n|^2 + (R1 n).(R2 n)) = 0 (no rotation about n x u, undefined if reversed).
    """
    for axis in geometry.axes:
        turned = relative(first, second)
        carried = first.carry(axis.vector) if turned is None else ()
        for across in axis.across:
            if turned is None:
                full = mul(first.under, second.under, square(axis.vector))
                tilt = dot(carried, second.carry(across)) / add(full, dot(carried, second.carry(axis.vector)))
                yield Relation(tilt, part="axis", vector=cross(axis.vector, across))
            else:
                yield Relation(dot(turned[1], across), part="axis", vector=across)


def _axes(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield the relation that the first axis, fixed in the first body, is perpendicular to the second body's axis."""
    a, b = (axis.vector for axis in geometry.axes)
    turned = relative(first, second)
    if turned is None:
        e = dot(first.carry(a), second.carry(b))
    else:
        scalar, vector = turned
        e = add(mul(dot(vector, a), dot(vector, b)), mul(scalar, dot(vector, cross(b, a))))
    yield Relation(e, part="axes")


def _across(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield the relations that the second body has no displacement perpendicular to the axis of the first."""
    for u in geometry.axis.across:
        yield Relation(slide(first, second, geometry, u)[0], part="across", vector=u)


def _distance(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield the relation that the second body has no displacement along the axis of the first."""
    n = geometry.axis.vector
    yield Relation(slide(first, second, geometry, n)[0], part="distance", vector=n)


def _thread(first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
    """Yield displacement - pitch angle / (2 pi) = 0, times a denominator."""
    n = geometry.axis.vector
    moved, under = slide(first, second, geometry, n)
    advance = mul(geometry.number or ZERO, angle_of(first, second, geometry)) / (2 * PI)
    yield Relation(difference(moved, mul(length(n), under, advance)), part="thread")


def turn_rate(at: Kinematics) -> VelocityRow:
    """Return the row of the angular velocity of the second body relative to the first, in space about the axis."""
    turn = at.turn()
    return turn[0] if at.dimension == 2 else rows.along(at.directions[0], turn)


def slide_rate(at: Kinematics) -> VelocityRow:
    """Return the row of the velocity of the second body relative to the first, along the axis."""
    return rows.along(at.directions[0], at.shift())


class HeldPart(NamedTuple):
    """A fixed part of a relative motion: its ``relations`` between two frames, and the rows of its ``velocities``."""

    relations: Callable[[Frame, Frame, JointGeometry], Iterator[Relation]]
    velocities: Callable[[Kinematics], Iterable[VelocityRow]]


Part = Literal["point", "origin", "orientation", "axis", "axes", "across", "distance", "thread"]
#: Parts of the second body's relative motion: a common point, the origin, the orientation, the direction of
#: a common axis, two axes at a right angle, the displacement perpendicular to or along the axis, a screw's advance.
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
    """The fixed parts of a joint in the order of its equations; a call yields the rows of their velocity equations."""

    motion_parts: tuple[Part, ...]

    def __call__(self, at: Kinematics) -> Iterator[VelocityRow]:
        for part in self.motion_parts:
            yield from PARTS[part].velocities(at)

    def relations(self, first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
        """Yield the relations between the two frames."""
        for part in self.motion_parts:
            yield from PARTS[part].relations(first, second, geometry)

    @property
    def placed(self) -> bool:
        """Whether the equations depend on the joint's place, that of its point or of the axis of rotation."""
        return "point" in self.motion_parts or ("axis" in self.motion_parts and "across" in self.motion_parts)

    def mentioned(self, first: Frame, second: Frame, geometry: JointGeometry) -> frozenset[str] | None:
        """Return the coordinates in the equations if these form one block; None if they may share no coordinate.

        A body's angles occur in all equations of a place that is not its origin, and in those of an axis. Equations in
        the directions of the first of two moving bodies mention all coordinates of both.
        """
        positions = [str(x.args[1]) for frame in (first, second) for x in frame.position if x.op == "sym"]
        if "point" not in self.motion_parts:
            one_origin = "origin" in self.motion_parts and first.start == second.start
            whole = not (first.fixed or second.fixed or one_origin)
            return frozenset(positions).union(first.angles, second.angles) if whole else None
        armed = [frame for frame in (first, second) if not frame.fixed and frame.start != geometry.at]
        turning = (first, second) if geometry.axes else armed
        return frozenset(positions).union(*(frame.angles for frame in turning)) if armed else None


def longest_of(first: Frame, second: Frame, geometry: JointGeometry) -> int | None:
    """Return the bits of the longest number in the equations of two frames with rational geometry; None for others."""
    moving = [frame for frame in (first, second) if not frame.fixed]
    if not moving or any(frame.chart not in ("plane", "gibbs") for frame in moving) or geometry.number is not None:
        return None
    numbers = [
        *chain.from_iterable((*frame.start, *(frame.initial if frame.chart == "plane" else ())) for frame in moving),
        *(geometry.place or ()),
        *chain.from_iterable(axis.vector for axis in geometry.axes),
    ]
    if any(part.op != "num" for part in numbers):
        return None
    bits = longest_number(numbers)
    return bits if bits < FEW_BITS else 2 * bits + 4


class Measure(NamedTuple):
    """An angle or displacement of a joint: its ``value``, what is 0 under a prescribed ``law``, and its ``rate``.

    All are functions of the two frames and the joint's geometry; ``turns``: whether it is an angle.
    """

    value: Callable[[Frame, Frame, JointGeometry], Expr]
    law: Callable[[Frame, Frame, JointGeometry, Expr], Expr]
    rate: Callable[[Kinematics], VelocityRow]
    turns: bool = False


def carrier(first: Frame, second: Frame) -> Frame:
    """Return the frame in which directions fixed in both are simplest: the ground's if one is fixed, else the first."""
    return second if second.fixed else first


def slide(first: Frame, second: Frame, geometry: JointGeometry, direction: Vec) -> tuple[Expr, Expr]:
    """Return (numerator, denominator) of the second body's displacement from the first along ``direction``.

    The displacement of the body's point at the joint's place; without a place of its origin, where the choice does not
    matter: the bodies do not rotate relative to each other, or slide on a plane perpendicular to the direction.
    """
    frame = carrier(first, second)
    other = first if frame is second else second
    place = other.start if geometry.place is None else geometry.place
    point = other.point(place)
    moved, under = along(frame, point, place, direction), mul(frame.under, point.under)
    return (mul(MINUS_ONE, moved) if frame is second else moved), under


def _displacement(first: Frame, second: Frame, geometry: JointGeometry) -> Expr:
    n = geometry.axis.vector
    moved, under = slide(first, second, geometry, n)
    return moved / mul(under, length(n))


def _displacement_law(first: Frame, second: Frame, geometry: JointGeometry, law: Expr) -> Expr:
    """Return n.X - |n| f times a denominator, with the displacement X, the axis n and the law f."""
    n = geometry.axis.vector
    moved, under = slide(first, second, geometry, n)
    return difference(moved, mul(length(n), under, law))


def angle_of(first: Frame, second: Frame, geometry: JointGeometry) -> Expr:
    """Return the angle of the second body relative to the first, in space about the shared axis, right-handed."""
    if not geometry.axes:
        return difference(second.angle, first.angle)
    half = half_angle(first, second, geometry)
    if half is not None:
        return 2 * fn("atan", half[1] / half[0])
    return fn("atan2", *_sine_and_cosine(first, second, geometry.axis))


def half_angle(first: Frame, second: Frame, geometry: JointGeometry) -> tuple[Expr, Expr] | None:
    """Return (cosine, sine) of half the angle, times a positive factor; None without two Gibbs vectors."""
    n, turned = geometry.axis.vector, relative(first, second)
    return None if turned is None else (mul(turned[0], length(n)), dot(turned[1], n))


def _angle_law(first: Frame, second: Frame, geometry: JointGeometry, law: Expr) -> Expr:
    """Return an expression that is 0 if the angle of the second body relative to the first is the law f.

    In the plane theta2 - theta1 - f. In space, with the axis n, v.n cos(f/2) - s |n| sin(f/2), or the tangent
    (S cos f - C sin f) / (k + C cos f + S sin f) of half the difference, with k times the angle's sine S and cosine C.
    """
    if not geometry.axes:
        return difference(angle_of(first, second, geometry), law)
    half = half_angle(first, second, geometry)
    if half is not None:
        s, c = fn("sin", mul(HALF, law)), fn("cos", mul(HALF, law))
        return difference(mul(half[1], c), mul(half[0], s))
    sine, cosine = _sine_and_cosine(first, second, geometry.axis)
    s, c = fn("sin", law), fn("cos", law)
    full = mul(first.under, second.under, length(geometry.axis.vector), square(geometry.axis.across[0]))
    return difference(mul(sine, c), mul(cosine, s)) / add(full, mul(cosine, c), mul(sine, s))


def _sine_and_cosine(first: Frame, second: Frame, axis: Direction) -> tuple[Expr, Expr]:
    """Return (sine, cosine) of the angle about the axis, times a positive factor."""
    u = axis.across[0]
    turned = second.carry(u)
    return dot(first.carry(cross(axis.vector, u)), turned), mul(length(axis.vector), dot(first.carry(u), turned))


#: The two quantities that a drive may prescribe and a coupling may mention.
ANGLE = Measure(angle_of, _angle_law, turn_rate, turns=True)
DISPLACEMENT = Measure(_displacement, _displacement_law, slide_rate)
