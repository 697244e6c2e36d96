"""Joints of the plane and of space: revolute, prismatic, weld."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.exact.matrices.sparse import across
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import difference
from dofkit.scene.constraints.joints import (
    ANGLE,
    SHIFT,
    Driven,
    Joint,
    JointGeometry,
    Measure,
    Mentions,
    aligned,
    angle_law,
    apart,
    displacement_law,
    parallel,
    shift,
    slide_rate,
    together,
    turn_rate,
)
from dofkit.scene.drawing import Frame
from dofkit.scene.symbols import RING, Stroke, Symbol, axle, box, cylinder, prism, rail
from dofkit.scene.world import World
from dofkit.system import DRIVE, Kinematics, Relation, TypeFacts, VelocityRow


def _revolute_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from at.shift()
    if at.dimension == 3:
        yield from across(at.directions[0], at.turn())


class Revolute(Driven):
    """X1 = X2 (d relations); in space the axis also keeps its direction (2 more): 2 in the plane, 5 in space.

    A drive adds: the angle of the second body relative to the first, about the axis, is f(t).
    """

    type: Literal["revolute"] = Field(description="a hinge")
    examples: ClassVar[Mapping[int, str]] = {
        2: "{type: revolute, between: [ground, crank], at: [0, 0]}",
        3: "{type: revolute, between: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}",
    }
    synonyms: ClassVar[tuple[str, ...]] = ("hinge", "pin")
    understood: ClassVar[tuple[str, ...]] = ("pivot", "pinned", "rotary", "rotational", "turning", "bearing")
    facts: ClassVar[TypeFacts] = TypeFacts(
        _revolute_rows, turn_rate, axial=True, half_turns=True, joint=True, planar_pair=True, freedoms=("angle",)
    )
    measures: ClassVar[Mapping[str, Measure]] = {"angle": ANGLE}
    mentions: ClassVar[Mentions] = "turn"
    symbol: ClassVar[Symbol] = Symbol(plane=(RING,), space=(axle(1.5), *cylinder(0.5, 0.7)))

    def geometry(self, world: World) -> JointGeometry:
        place = world.place(self.at, "at")
        if world.dimension == 3:
            return JointGeometry(place, (self.directed(world),))
        if self.axis is not None:
            hint = "leave it out: in the plane every hinge turns about the normal of the plane"
            world.fault("a revolute joint has no `axis` in dimension 2", "axis", hint=hint)
        return JointGeometry(place)

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        yield from together(first, second, drawn.at)
        if drawn.axes:
            yield from aligned(first, second, drawn.axis)

    def law(self, first: Frame, second: Frame, drawn: JointGeometry, driven: Expr) -> Relation:
        if drawn.axes:
            return angle_law(first, second, drawn.axis, driven)
        return Relation(difference(difference(second.angle, first.angle), driven), part=DRIVE)


def _prismatic_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from at.turn()
    yield from across(at.directions[0], at.shift())


class Prismatic(Driven):
    """No relative rotation, no displacement across the axis: 2 relations in the plane, 5 in space.

    (R u).(p2 - p1) - u.(p02 - p01) = 0 for the directions u across the axis. A drive adds:
    the displacement of the second body along the axis, relative to the first, is f(t).
    """

    type: Literal["prismatic"] = Field(description="a slider")
    examples: ClassVar[Mapping[int, str]] = {
        2: "{type: prismatic, between: [ground, crank], axis: [1, 0]}",
        3: "{type: prismatic, between: [ground, crank], axis: [1, 0, 0]}",
    }
    synonyms: ClassVar[tuple[str, ...]] = ("slider",)
    understood: ClassVar[tuple[str, ...]] = ("translational", "sliding", "linear", "rail", "piston")
    facts: ClassVar[TypeFacts] = TypeFacts(
        _prismatic_rows,
        slide_rate,
        slides=True,
        half_turns=True,
        joint=True,
        planar_pair=True,
        freedoms=("displacement",),
    )
    measures: ClassVar[Mapping[str, Measure]] = {"displacement": SHIFT}
    mentions: ClassVar[Mentions] = "moving"
    symbol: ClassVar[Symbol] = Symbol(
        plane=(rail(3.2, 0.8), rail(3.2, -0.8), Stroke(box(1.3, 0.7), 1, closed=True, filled=True)),
        space=(*prism(0.35, 2.6, 1), *prism(0.65, 0.9)),
        rails=3.2,
    )

    def geometry(self, world: World) -> JointGeometry:
        if self.at is not None:
            world.place(self.at, "at")
        return JointGeometry(None, (self.directed(world),))

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        yield from parallel(first, second)
        for u in drawn.axis.across:
            yield Relation(shift(first, second, u)[0], part="across", vector=u)

    def law(self, first: Frame, second: Frame, drawn: JointGeometry, driven: Expr) -> Relation:
        return displacement_law(shift(first, second, drawn.axis.vector), drawn.axis, driven)


def _weld_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from at.turn()
    yield from at.shift()


class Weld(Joint):
    """The second body moves with the first: 3 relations in the plane, 6 in space."""

    type: Literal["weld"] = Field(description="two bodies joined into one")
    examples: ClassVar[Mapping[int, str]] = {0: "{type: weld, between: [crank, rod]}"}
    understood: ClassVar[tuple[str, ...]] = ("glue", "glued", "clamp", "fastened", "rigid_joint")
    facts: ClassVar[TypeFacts] = TypeFacts(_weld_rows, welded=True, half_turns=True, joint=True)
    mentions: ClassVar[Mentions] = "apart"
    symbol: ClassVar[Symbol] = Symbol(
        plane=(
            Stroke(box(0.55, 0.55), closed=True, filled=True),
            Stroke(((-0.55, -0.55), (0.55, 0.55))),
            Stroke(((-0.55, 0.55), (0.55, -0.55))),
        ),
        space=(
            *prism(0.5, 0.5),
            Stroke(((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))),
            Stroke(((-0.5, 0.5, -0.5), (0.5, -0.5, 0.5))),
        ),
    )

    def geometry(self, world: World) -> JointGeometry:
        world.welds.append(self.between)
        return JointGeometry()

    def equations(self, first: Frame, second: Frame, drawn: JointGeometry) -> Iterator[Relation]:
        del drawn
        yield from parallel(first, second)
        yield from apart(first, second)
