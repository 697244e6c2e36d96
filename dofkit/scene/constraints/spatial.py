"""Joints of space only: cylindrical, screw, universal, spherical, planar."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.exact.matrices import sparse as rows
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import PI, ZERO, Expr, add, fn, mul
from dofkit.expressions.vectors import Vec, cross, difference, dot, length, plus, scaled
from dofkit.scene.constraints.joints import (
    ANGLE,
    SLIDE,
    Axial,
    Driven,
    JointGeometry,
    LocatedJoint,
    Measure,
    Mentions,
    aligned,
    angle_law,
    angle_of,
    displacement_law,
    shift,
    slide,
    slide_rate,
    together,
    turn_rate,
)
from dofkit.scene.drawing import Frame, relative
from dofkit.scene.fields import Value, Vector, as_written
from dofkit.scene.parts import show_vector
from dofkit.scene.symbols import RING, Stroke, Symbol, arc, axle, cylinder, helix, plate, prism
from dofkit.scene.world import Direction, World, within
from dofkit.system import Kinematics, Relation, TypeFacts, VelocityRow


def coaxial(first: Frame, second: Frame, place: Vec, axis: Direction) -> Iterator[Relation]:
    """Yield 4 relations that keep the axis one line: 2 for its direction, 2 for its place."""
    yield from aligned(first, second, axis)
    for u in axis.across:
        yield Relation(slide(first, second, place, u)[0], part="across", vector=u)


def _cylindrical_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from rows.across(at.directions[0], at.turn())
    yield from rows.across(at.directions[0], at.shift())


class Cylindrical(Driven):
    """The bodies share an axis, along which and about which they move freely: 4 relations.

    A drive prescribes the displacement of the second body along the axis, relative to the first.
    """

    type: Literal["cylindrical"] = Field(description="a sleeve on a shaft")
    examples: ClassVar[Mapping[int, str]] = {
        3: "{type: cylindrical, between: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}"
    }
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        _cylindrical_rows, slide_rate, axial=True, half_turns=True, joint=True, freedoms=("angle", "displacement")
    )
    measures: ClassVar[Mapping[str, Measure]] = {"angle": ANGLE, "displacement": SLIDE}
    mentions: ClassVar[Mentions] = "moving"
    symbol: ClassVar[Symbol] = Symbol(space=(*cylinder(0.3, 2.4, 1), *cylinder(0.6, 1.0)))

    def geometry(self, world: World) -> JointGeometry:
        place = world.place(self.at, "at")
        return JointGeometry(place, (self.directed(world),))

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        yield from coaxial(first, second, drawn.at, drawn.axis)

    def law(self, first: Frame, second: Frame, drawn: JointGeometry, driven: Expr) -> Relation:
        return displacement_law(slide(first, second, drawn.at, drawn.axis.vector), drawn.axis, driven)


def _screw_rows(at: Kinematics) -> Iterator[VelocityRow]:
    """n.(v2 - v1) - h n.(w2 - w1) = 0 with h the advance by radian."""
    yield from _cylindrical_rows(at)
    yield rows.combined(((1, slide_rate(at)), (-at.number, turn_rate(at))))


class Screw(Driven):
    """The bodies share an axis, and displacement - pitch angle / (2 pi) = 0: 5 relations.

    Right-handed: one turn about the axis advances by ``pitch`` along it. A drive prescribes the angle.
    """

    type: Literal["screw"] = Field(description="a nut on a thread")
    examples: ClassVar[Mapping[int, str]] = {
        3: "{type: screw, between: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1], pitch: 2}"
    }
    understood: ClassVar[tuple[str, ...]] = ("helical", "thread", "nut")
    pitch: Value = Field(description="the advance along the axis for one turn, right-handed")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        _screw_rows, turn_rate, by_turn=True, axial=True, half_turns=True, joint=True, freedoms=("angle",)
    )
    measures: ClassVar[Mapping[str, Measure]] = {"angle": ANGLE, "displacement": SLIDE}
    symbol: ClassVar[Symbol] = Symbol(space=(helix(0.4, 2.4, 6, 1), axle(2.4, 1), *prism(0.65, 0.6)))

    def geometry(self, world: World) -> JointGeometry:
        place, axis = world.place(self.at, "at"), self.directed(world)
        pitch = world.mentioned.number = world.fixed(self.pitch, "pitch")
        return JointGeometry(place, (axis,), pitch)

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        axis = drawn.axis
        yield from coaxial(first, second, drawn.at, axis)
        moved, under = slide(first, second, drawn.at, axis.vector)
        advance = mul(drawn.number or ZERO, angle_of(first, second, axis)) / (2 * PI)
        yield Relation(difference(moved, mul(length(axis.vector), under, advance)), part="thread")

    def law(self, first: Frame, second: Frame, drawn: JointGeometry, driven: Expr) -> Relation:
        return angle_law(first, second, drawn.axis, driven)

    @property
    def in_words(self) -> str:
        return f"{super().in_words}, pitch {as_written(self.pitch)}"


def _universal_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from at.shift()
    yield rows.along(rows.cross(*at.directions), at.turn())


class Universal(LocatedJoint):
    """X1 = X2, and the first axis, carried by the first body, stays perpendicular to the second: 4 relations."""

    type: Literal["universal"] = Field(description="a Cardan joint")
    examples: ClassVar[Mapping[int, str]] = {
        3: "{type: universal, between: [crank, rod], at: [0, 0, 0], axes: [[1, 0, 0], [0, 1, 0]]}"
    }
    understood: ClassVar[tuple[str, ...]] = ("cardan", "hooke", "u-joint", "gimbal")
    axes: tuple[Vector, Vector] | None = Field(
        None, description="two perpendicular axes, the first carried by the first body, the second by the second"
    )
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        _universal_rows, directions=2, axial=True, half_turns=True, joint=True, freedoms=("angle_1", "angle_2")
    )
    mentions: ClassVar[Mentions] = "turn"
    symbol: ClassVar[Symbol] = Symbol(
        space=(
            Stroke(((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))),
            Stroke(((0.0, -1.0, 0.0), (0.0, 1.0, 0.0)), 1),
            Stroke(tuple((c, 0.0, s) for _, c, s in arc(1.0, 0.0, 180.0))),
            Stroke(tuple((0.0, c, s) for _, c, s in arc(1.0, 180.0, 360.0)), 1),
        )
    )

    def geometry(self, world: World) -> JointGeometry:
        place = world.place(self.at, "at")
        return JointGeometry(place, self._pair(world))

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        yield from together(first, second, drawn.at)
        a, b = (axis.vector for axis in drawn.axes)
        turned = relative(first, second)
        if turned is None:
            e = dot(first.carry(a), second.carry(b))
        else:
            scalar, vector = turned
            e = add(mul(dot(vector, a), dot(vector, b)), mul(scalar, dot(vector, cross(b, a))))
        yield Relation(e, part="axes")

    def _pair(self, world: World) -> tuple[Direction, Direction]:
        if self.axes is None:
            if self.at is not None:
                hint = "add `axes: [[1, 0, 0], [0, 1, 0]]`, or leave both out for a joint in general position"
                world.fault("this universal joint has a position (`at`) but no `axes`", hint=hint)
            first = world.direction(None)
            return first, Direction(plus(first.across[0], scaled(world.fresh(), first.across[1])), ())
        first, second = (world.direction(axis, "axes", i) for i, axis in enumerate(self.axes))
        cosine = dot(first.vector, second.vector)
        if world.differs(cosine):
            size = approximate(fn("abs", cosine / (length(first.vector) * length(second.vector))))
            if not (size is not None and within(size, world.tolerance, 1.0)):
                axes = f"{show_vector(self.axes[0])} and {show_vector(self.axes[1])}"
                world.fault(f"the axes {axes} are not perpendicular", "axes", hint="their dot product must be 0")
        return first, second

    @property
    def in_words(self) -> str:
        words = super().in_words
        return words if self.axes is None else f"{words} along {' and '.join(show_vector(axis) for axis in self.axes)}"


def _spherical_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from at.shift()


class Spherical(LocatedJoint):
    """X1 = X2: 3 relations."""

    type: Literal["spherical"] = Field(description="a ball in a socket")
    examples: ClassVar[Mapping[int, str]] = {3: "{type: spherical, between: [crank, rod], at: [0, 0, 0]}"}
    synonyms: ClassVar[tuple[str, ...]] = ("ball",)
    understood: ClassVar[tuple[str, ...]] = ("socket", "ball-socket", "ball_and_socket")
    axis: Vector | None = Field(None, description="not needed: the joint allows every rotation")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        _spherical_rows, half_turns=True, joint=True, freedoms=("rotation_1", "rotation_2", "rotation_3")
    )
    mentions: ClassVar[Mentions] = "place"
    symbol: ClassVar[Symbol] = Symbol(
        space=(
            RING,
            Stroke(arc(0.75, 150.0, 390.0)),
            Stroke(tuple((c, 0.0, s) for _, c, s in arc(0.75, 150.0, 390.0))),
        )
    )

    def geometry(self, world: World) -> JointGeometry:
        if self.axis is not None:
            world.direction(self.axis, "axis")
        return JointGeometry(world.place(self.at, "at"))

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        yield from together(first, second, drawn.at)


def _planar_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from rows.across(at.directions[0], at.turn())
    yield slide_rate(at)


class Planar(Axial):
    """The normal n keeps its direction (2 relations), and (R n).(p2 - p1) - n.(p02 - p01) = 0: 3 relations."""

    type: Literal["planar"] = Field(description="a face that slides on a face")
    examples: ClassVar[Mapping[int, str]] = {
        3: "{type: planar, between: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}"
    }
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        _planar_rows, half_turns=True, joint=True, freedoms=("displacement_1", "displacement_2", "angle")
    )
    mentions: ClassVar[Mentions] = "moving"
    symbol: ClassVar[Symbol] = Symbol(space=(plate(-0.15, 2.2), plate(0.15, 1.2, 1)))

    def geometry(self, world: World) -> JointGeometry:
        if self.at is not None:
            world.place(self.at, "at")
        return JointGeometry(None, (self.directed(world),))

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        axis = drawn.axis
        yield from aligned(first, second, axis)
        yield Relation(shift(first, second, axis.vector)[0], part="distance", vector=axis.vector)
