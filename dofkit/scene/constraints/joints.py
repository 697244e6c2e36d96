"""What joints share: their ends, their geometry, and the relations that keep axes and points together.

Material points at the same place ``a`` of the drawing are X_i = p_i + R_i (a - p0_i). Where both
bodies are written in Gibbs vectors g_i, the rotation R1^T R2 is the quaternion (s, v) with
s = 1 + g1.g2 and v = g2 - g1 - g1 x g2, and a shared axis n is v.u = 0 for the u across n: of the
two ways to keep the lines parallel this leaves out the one with the axis turned over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import ClassVar, Literal, NamedTuple

from pydantic import Field

from dofkit.exact.matrices import sparse as rows
from dofkit.expressions.renaming import Unwritten
from dofkit.expressions.terms import longest_number
from dofkit.expressions.tree import HALF, MINUS_ONE, ONE, ZERO, Expr, fn, mul
from dofkit.expressions.vectors import Vec, cross, difference, dot, is_zero, length, minus, scaled, unit
from dofkit.scene.constraints.base import ConstraintBase, component_relations
from dofkit.scene.constraints.places import along
from dofkit.scene.drawing import Frame, between, relative
from dofkit.scene.fields import Text, Vector
from dofkit.scene.ledger import LAW
from dofkit.scene.parts import show_vector
from dofkit.scene.world import Direction, World
from dofkit.system import DRIVE, Kinematics, Relation, VelocityRow

_UP = {2: "[1, 0]", 3: "[0, 0, 1]"}
#: Independent motions of a body, d(d+1)/2.
MOTIONS = {2: 3, 3: 6}
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


class Measure(NamedTuple):
    """An angle or displacement of a joint: its ``value`` by the two frames, the place and the axis, and its ``rate``.

    ``turns``: it is an angle; ``placed``: it depends on the joint's place. In the plane an angle needs no axis.
    """

    value: Callable[[Frame, Frame, Vec, Direction | None], Expr]
    rate: Callable[[Kinematics], VelocityRow]
    turns: bool = False
    placed: bool = False


class Joint(ConstraintBase):
    """Two bodies, or a body and the ground, joined together."""

    between: tuple[str, str] = Field(description="the two bodies; one may be ground")

    #: What a coupling may mention of it.
    measures: ClassVar[Mapping[str, Measure]] = {}
    #: What no part of its equations leaves out: of a common place the positions of the bodies (``place``), and how one
    #: turns against the other (``turn``); of two moving bodies all coordinates (``moving``; ``apart``: if their origins
    #: differ). None where parts do.
    mentions: ClassVar[Mentions | None] = None

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)

    def ends(self, world: World) -> tuple[Frame, Frame] | None:
        """Return the frames of the two ends; None after a fault."""
        before = len(world.faults)
        first, second = (world.frame(name, "between", i) for i, name in enumerate(self.between))
        if self.between[0] == self.between[1]:
            world.fault(f"'{self.between[0]}' cannot be joined to itself", "between", 1, hint="name another body")
        return None if len(world.faults) > before else (first, second)

    def geometry(self, world: World) -> JointGeometry:
        """Return what it asks of the world; faults go there."""
        del world
        return JointGeometry()

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        """Yield the relations between the two frames, the drive's apart."""
        raise NotImplementedError

    def laws(self, world: World, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        """Yield the drive's relation, if it is driven."""
        del world, first, second, drawn
        yield from ()

    def joined(self, world: World, first: Frame, second: Frame) -> Sequence[Relation]:
        """Return the relations between the two frames, written out later where the drawing states what they mention."""
        drawn = self.geometry(world)
        laws = tuple(self.laws(world, first, second, drawn))
        equations = partial(self.equations, first, second, drawn)
        longest = None if laws else longest_of(first, second, drawn)
        mentioned = None if longest is None else coordinates_mentioned(self.mentions, first, second, drawn)
        if longest is None or mentioned is None:
            return (*equations(), *laws)
        return Unwritten(MOTIONS[world.dimension] - len(self.facts.freedoms), mentioned, longest, equations)

    def relations(self, world: World) -> Iterable[Relation]:
        ends = self.ends(world)
        if any(getattr(self, key, None) is not None for key in ("at", "axis", "axes")):
            world.drawn.update(self.between)
        return self.joined(world, *(ends or (world.ground, world.ground)))

    def texts(self) -> Iterator[str]:
        drive = getattr(self, "drive", None)
        if drive is not None:
            yield drive

    @property
    def in_words(self) -> str:
        words = f"{self.kind()} {self.between[0]}-{self.between[1]}"
        for key, word in (("at", "at"), ("axis", "along")):
            vector: Vector | None = getattr(self, key, None)
            if vector is not None:
                words += f" {word} {show_vector(vector)}"
        drive = getattr(self, "drive", None)
        return words if drive is None else f"{words}, driven by {drive}"


class LocatedJoint(Joint):
    """A joint with a place."""

    at: Vector | None = Field(None, description="the joint's position in the reference configuration")


class Axial(LocatedJoint):
    """A joint with a place and an axis."""

    axis: Vector | None = Field(None, description="the joint's axis in the reference configuration")

    def directed(self, world: World) -> Direction:
        """Return the axis; one that is left out where the place is given is a fault."""
        if self.axis is None and self.at is not None:
            world.fault(
                f"this {self.kind()} joint has a position (`at`) but no `axis`",
                hint=f"add `axis: {_UP[world.dimension]}`, or leave both out for a joint in general position",
            )
        return world.direction(self.axis, "axis")


class Driven(Axial):
    """A joint whose angle or displacement may be prescribed."""

    drive: Text | None = Field(None, description="the prescribed angle or displacement from the reference, in t")

    def laws(self, world: World, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        if self.drive is not None:
            yield self.law(first, second, drawn, world.expression(self.drive, "drive", allow=LAW))

    def law(self, first: Frame, second: Frame, drawn: JointGeometry, driven: Expr) -> Relation:
        """Return the relation that says what is ``driven``."""
        raise NotImplementedError


def turn_rate(at: Kinematics) -> VelocityRow:
    """Return how fast the second body turns against the first, in space about the axis."""
    turn = at.turn()
    return turn[0] if at.dimension == 2 else rows.along(at.directions[0], turn)


def slide_rate(at: Kinematics) -> VelocityRow:
    """Return how fast the second body moves along the axis against the first."""
    return rows.along(at.directions[0], at.shift())


def _angle(first: Frame, second: Frame, place: Vec, axis: Direction | None) -> Expr:
    del place
    return difference(second.angle, first.angle) if axis is None else angle_of(first, second, axis)


def _shifted(first: Frame, second: Frame, place: Vec, axis: Direction | None) -> Expr:
    del place
    moved, under = shift(first, second, axis.vector) if axis is not None else (ZERO, ONE)
    return moved if axis is None else moved / mul(under, length(axis.vector))


def _slid(first: Frame, second: Frame, place: Vec, axis: Direction | None) -> Expr:
    moved, under = slide(first, second, place, axis.vector) if axis is not None else (ZERO, ONE)
    return moved if axis is None else moved / mul(under, length(axis.vector))


#: An angle about the axis; a displacement along it of bodies that do not turn against each other, and of others.
ANGLE = Measure(_angle, turn_rate, turns=True)
SHIFT = Measure(_shifted, slide_rate)
SLIDE = Measure(_slid, slide_rate, placed=True)


def together(first: Frame, second: Frame, place: Vec) -> Iterator[Relation]:
    """X2 - X1 = 0 for the material points at ``place``: d relations."""
    yield from component_relations(between(first.point(place), second.point(place))[0], "point {}", place)


def aligned(first: Frame, second: Frame, axis: Direction) -> Iterator[Relation]:
    """Yield 2 relations that keep the direction n of the axis the same in both bodies, one for each u across n.

    In general (R1 n).(R2 u) = 0, which keeps them from turning about n x u. Where both rotations are given by Gibbs
    vectors, v.u = 0 with the vector part v of the quaternion of R1^T R2 keeps them from turning about u.
    """
    turned = relative(first, second)
    carried = first.carry(axis.vector) if turned is None else ()
    for across in axis.across:
        if turned is None:
            yield Relation(dot(carried, second.carry(across)), part="axis", vector=cross(axis.vector, across))
        else:
            yield Relation(dot(turned[1], across), part="axis", vector=across)


def parallel(first: Frame, second: Frame) -> Iterator[Relation]:
    """No relative rotation: the plane angle, or 3 relations in space.

    theta2 - theta1 - const = 0; g2 - g1 = 0; or the Gibbs vector of B = R1^T R2, of which 1 + tr B times two are
    B32 - B23, B13 - B31, B21 - B12, and which no half turn has.
    """
    if first.dimension == 2:
        yield Relation(difference(second.angle, first.angle), part="angle")
    elif first.gibbs is not None and second.gibbs is not None:
        yield from component_relations(minus(second.gibbs, first.gibbs), "orientation {}")
    else:
        a, b = ([frame.carry(unit(i, 3)) for i in range(3)] for frame in (first, second))
        trace = sum((dot(a[i], b[i]) for i in range(3)), mul(first.under, second.under))
        for i, j, about in ((0, 1, "z"), (1, 2, "x"), (2, 0, "y")):
            yield Relation(difference(dot(a[i], b[j]), dot(a[j], b[i])) / trace, part=f"orientation {about}")


def carrier(first: Frame, second: Frame) -> Frame:
    """Return the frame in which directions common to both are simplest: the ground's, else the first."""
    return second if second.fixed else first


def shift(first: Frame, second: Frame, direction: Vec) -> tuple[Expr, Expr]:
    """For bodies that do not turn against each other: how far the second has moved along ``direction``.

    (R u).(p2 - p1) - u.(p02 - p01), as numerator and denominator.
    """
    frame = carrier(first, second)
    apart = dot(direction, minus(second.start, first.start))
    moved = dot(frame.carry(direction), minus(second.position, first.position))
    return difference(moved, mul(frame.under, apart)), frame.under


def slide(first: Frame, second: Frame, place: Vec, direction: Vec) -> tuple[Expr, Expr]:
    """Return how far the second body's point at ``place`` has moved from the first's along a direction of both."""
    frame = carrier(first, second)
    if frame is second:
        point = first.point(place)
        return mul(MINUS_ONE, along(second, point, place, direction)), mul(second.under, point.under)
    point = second.point(place)
    return along(first, point, place, direction), mul(first.under, point.under)


def displacement_law(moved: tuple[Expr, Expr], axis: Direction, law: Expr) -> Relation:
    """Displacement along the axis less the law: n.X - |n| f = 0, cleared."""
    return Relation(difference(moved[0], mul(length(axis.vector), moved[1], law)), part=DRIVE)


def crossing(axis: Direction) -> tuple[Vec, Vec]:
    """u across the axis n, and n x u."""
    return axis.across[0], cross(axis.vector, axis.across[0])


def angle_law(first: Frame, second: Frame, axis: Direction, law: Expr) -> Relation:
    """Return the relation that the angle of the second body against the first about the axis is ``law``.

    In the plane theta2 - theta1 - f = 0. In space v.n cos(f/2) - s |n| sin(f/2) = 0, or with
    w = n x u: (R1 w).(R2 u) cos f - |n| (R1 u).(R2 u) sin f = 0.
    """
    size = length(axis.vector)
    turned = relative(first, second)
    if turned is not None:
        half = mul(HALF, law)
        e = difference(mul(dot(turned[1], axis.vector), fn("cos", half)), mul(turned[0], size, fn("sin", half)))
    else:
        u, w = crossing(axis)
        now = second.carry(u)
        sine, cosine = dot(first.carry(w), now), mul(size, dot(first.carry(u), now))
        e = difference(mul(sine, fn("cos", law)), mul(cosine, fn("sin", law)))
    return Relation(e, part=DRIVE)


def angle_of(first: Frame, second: Frame, axis: Direction) -> Expr:
    """Return the second body's angle against the first about a shared axis of space, right-handed."""
    size = length(axis.vector)
    turned = relative(first, second)
    if turned is not None:
        return 2 * fn("atan", dot(turned[1], axis.vector) / (turned[0] * size))
    u, w = crossing(axis)
    now = second.carry(u)
    return fn("atan2", dot(first.carry(w), now), mul(size, dot(first.carry(u), now)))


def apart(first: Frame, second: Frame) -> Iterator[Relation]:
    """p2 - p1 - R1 (p02 - p01) = 0, cleared: d relations."""
    frame = carrier(first, second)
    start = minus(second.start, first.start)
    moved = minus(second.position, first.position)
    if not is_zero(start):
        moved = minus(scaled(frame.under, moved), frame.carry(start))
    yield from component_relations(moved, "origin {}")
