"""Joints: two bodies, or a body and the ground, and which parts of their relative motion are fixed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.expressions.enclosures import approximate
from dofkit.expressions.renaming import Unwritten
from dofkit.expressions.tree import fn
from dofkit.expressions.vectors import Vec, dot, length, plus, scaled
from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.constraints.joint_parts import ANGLE, DISPLACEMENT, Holds, JointGeometry, Measure, longest_of
from dofkit.scene.fields import Text, Value, Vector, as_written
from dofkit.scene.frames import Frame
from dofkit.scene.ledger import LAW
from dofkit.scene.parts import show_vector
from dofkit.scene.symbols import RING, Stroke, Symbol, arc, axle, box, cylinder, helix, plate, prism, rail
from dofkit.scene.world import Direction, World, within
from dofkit.system import DRIVE, Relation, TypeFacts

_UP = {2: "[1, 0]", 3: "[0, 0, 1]"}
#: Independent motions of a body, d(d+1)/2.
MOTIONS = {2: 3, 3: 6}


class Joint(ConstraintBase):
    """Two bodies, or a body and the ground, joined together."""

    between: tuple[str, str] = Field(description="the two bodies; one may be ground")

    #: The parts of the relative motion that the joint fixes.
    holds: ClassVar[Holds]

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)

    def ends(self, world: World) -> tuple[Frame, Frame] | None:
        """Return the frames of the two ends; None after a fault."""
        before = len(world.faults)
        first, second = (world.frame(name, "between", i) for i, name in enumerate(self.between))
        if self.between[0] == self.between[1]:
            world.fault(f"'{self.between[0]}' cannot be joined to itself", "between", 1, hint="name another body")
        return None if len(world.faults) > before else (first, second)

    def geometry(self, world: World) -> JointGeometry:
        """Return the joint's geometry in the reference configuration; faults are recorded in ``world``."""
        del world
        return JointGeometry()

    def laws(self, world: World, first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
        """Yield the relation of the drive, if the joint is driven."""
        del world, first, second, geometry
        yield from ()

    def joined(self, world: World, first: Frame, second: Frame) -> Sequence[Relation]:
        """Return the relations between the two frames: lazily if their coordinates are known without writing them."""
        geometry = self.geometry(world)
        laws = tuple(self.laws(world, first, second, geometry))
        equations = partial(self.holds.relations, first, second, geometry)
        longest = None if laws else longest_of(first, second, geometry)
        mentioned = None if longest is None else self.holds.mentioned(first, second, geometry)
        if longest is None or mentioned is None:
            return (*equations(), *laws)
        return Unwritten(MOTIONS[world.dimension] - len(self.facts.freedoms), mentioned, longest, equations)

    def relations(self, world: World) -> Iterable[Relation]:
        ends = self.ends(world)
        if any(getattr(self, key, None) is not None for key in ("at", "axis", "axes")):
            world.placed.update(self.between)
        return self.joined(world, *(ends or (world.ground, world.ground)))

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

    def located(self, world: World) -> Vec | None:
        """Return the place on which the equations depend; None if they depend on none, even if ``at`` is given."""
        place = world.place(self.at, "at") if self.holds.placed or self.at is not None else None
        return place if self.holds.placed else None


class Axial(LocatedJoint):
    """A joint with a place and an axis."""

    axis: Vector | None = Field(None, description="the joint's axis in the reference configuration")

    def geometry(self, world: World) -> JointGeometry:
        place = self.located(world)
        if self.axis is None and self.at is not None:
            world.fault(
                f"this {self.kind()} joint has a position (`at`) but no `axis`",
                hint=f"add `axis: {_UP[world.dimension]}`, or leave both out for a joint in general position",
            )
        return JointGeometry(place, (world.direction(self.axis, "axis"),))


class Driven(Axial):
    """A joint whose angle or displacement may be prescribed."""

    drive: Text | None = Field(None, description="the prescribed angle or displacement from the reference, in t")

    #: The quantity that a drive prescribes.
    drives: ClassVar[Measure]

    @classmethod
    def measures(cls) -> dict[str, Measure]:
        """Return {name: measure} of what a coupling may mention: the angle about and displacement along the axis."""
        measures = (("axis", "angle", ANGLE), ("across", "displacement", DISPLACEMENT))
        return {name: measure for part, name, measure in measures if part in cls.holds.motion_parts}

    def laws(self, world: World, first: Frame, second: Frame, geometry: JointGeometry) -> Iterator[Relation]:
        if self.drive is not None:
            law = world.expression(self.drive, "drive", allow=LAW)
            yield Relation(self.drives.law(first, second, geometry, law), part=DRIVE)


class Revolute(Driven):
    """X1 = X2 (d relations); in space the axis also keeps its direction (2 more): 2 in the plane, 5 in space.

    A drive adds: the angle of the second body relative to the first, about the axis, is f(t).
    """

    type: Literal["revolute"] = Field(description="a hinge")
    holds: ClassVar[Holds] = Holds(("point", "axis"))
    drives: ClassVar[Measure] = ANGLE
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, drives.rate, axial=True, half_turns=True, joint=True, planar_pair=True, freedoms=("angle",)
    )
    symbol: ClassVar[Symbol] = Symbol(plane=(RING,), space=(axle(1.5), *cylinder(0.5, 0.7)))

    def geometry(self, world: World) -> JointGeometry:
        if world.dimension == 3:
            return super().geometry(world)
        if self.axis is not None:
            hint = "leave it out: in the plane every hinge turns about the normal of the plane"
            world.fault("a revolute joint has no `axis` in dimension 2", "axis", hint=hint)
        return JointGeometry(self.located(world))


class Prismatic(Driven):
    """No relative rotation, no displacement across the axis: 2 relations in the plane, 5 in space.

    (R u).(p2 - p1) - u.(p02 - p01) = 0 for the directions u across the axis. A drive adds:
    the displacement of the second body along the axis, relative to the first, is f(t).
    """

    type: Literal["prismatic"] = Field(description="a slider")
    holds: ClassVar[Holds] = Holds(("orientation", "across"))
    drives: ClassVar[Measure] = DISPLACEMENT
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds,
        drives.rate,
        slides=True,
        half_turns=True,
        joint=True,
        planar_pair=True,
        freedoms=("displacement",),
    )
    symbol: ClassVar[Symbol] = Symbol(
        plane=(rail(3.2, 0.8), rail(3.2, -0.8), Stroke(box(1.3, 0.7), 1, closed=True, filled=True)),
        space=(*prism(0.35, 2.6, 1), *prism(0.65, 0.9)),
        rails=3.2,
    )


class Weld(Joint):
    """The second body moves with the first: 3 relations in the plane, 6 in space."""

    type: Literal["weld"] = Field(description="two bodies joined into one")
    holds: ClassVar[Holds] = Holds(("orientation", "origin"))
    facts: ClassVar[TypeFacts] = TypeFacts(holds, welded=True, half_turns=True, joint=True)
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


class Cylindrical(Driven):
    """The bodies share an axis, along which and about which they move freely: 4 relations.

    A drive prescribes the displacement of the second body along the axis, relative to the first.
    """

    type: Literal["cylindrical"] = Field(description="a sleeve on a shaft")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    holds: ClassVar[Holds] = Holds(("axis", "across"))
    drives: ClassVar[Measure] = DISPLACEMENT
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, drives.rate, axial=True, half_turns=True, joint=True, freedoms=("angle", "displacement")
    )
    symbol: ClassVar[Symbol] = Symbol(space=(*cylinder(0.3, 2.4, 1), *cylinder(0.6, 1.0)))


class Screw(Driven):
    """The bodies share an axis, and displacement - pitch angle / (2 pi) = 0: 5 relations.

    Right-handed: one turn about the axis advances by ``pitch`` along it. A drive prescribes the angle.
    """

    type: Literal["screw"] = Field(description="a nut on a thread")
    pitch: Value = Field(description="the advance along the axis for one turn, right-handed")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    holds: ClassVar[Holds] = Holds(("axis", "across", "thread"))
    drives: ClassVar[Measure] = ANGLE
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, drives.rate, by_turn=True, axial=True, half_turns=True, joint=True, freedoms=("angle",)
    )
    symbol: ClassVar[Symbol] = Symbol(space=(helix(0.4, 2.4, 6, 1), axle(2.4, 1), *prism(0.65, 0.6)))

    def geometry(self, world: World) -> JointGeometry:
        geometry = super().geometry(world)
        world.mentioned.number = world.fixed(self.pitch, "pitch")
        return geometry._replace(number=world.mentioned.number)

    @property
    def in_words(self) -> str:
        return f"{super().in_words}, pitch {as_written(self.pitch)}"


class Universal(LocatedJoint):
    """X1 = X2, and the first axis, carried by the first body, stays perpendicular to the second: 4 relations."""

    type: Literal["universal"] = Field(description="a Cardan joint")
    axes: tuple[Vector, Vector] | None = Field(
        None, description="two perpendicular axes, the first carried by the first body, the second by the second"
    )
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    holds: ClassVar[Holds] = Holds(("point", "axes"))
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, directions=2, axial=True, half_turns=True, joint=True, freedoms=("angle_1", "angle_2")
    )
    symbol: ClassVar[Symbol] = Symbol(
        space=(
            Stroke(((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))),
            Stroke(((0.0, -1.0, 0.0), (0.0, 1.0, 0.0)), 1),
            Stroke(tuple((c, 0.0, s) for _, c, s in arc(1.0, 0.0, 180.0))),
            Stroke(tuple((0.0, c, s) for _, c, s in arc(1.0, 180.0, 360.0)), 1),
        )
    )

    def geometry(self, world: World) -> JointGeometry:
        return JointGeometry(self.located(world), self._pair(world))

    def _pair(self, world: World) -> tuple[Direction, Direction]:
        """Return the two axes in the reference configuration, general ones if none are given.

        A fault is recorded if they are not perpendicular.
        """
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


class Spherical(LocatedJoint):
    """X1 = X2: 3 relations."""

    type: Literal["spherical"] = Field(description="a ball in a socket")
    axis: Vector | None = Field(None, description="not needed: the joint allows every rotation")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    holds: ClassVar[Holds] = Holds(("point",))
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, half_turns=True, joint=True, freedoms=("rotation_1", "rotation_2", "rotation_3")
    )
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
        return JointGeometry(self.located(world))


class Planar(Axial):
    """The normal n keeps its direction (2 relations), and (R n).(p2 - p1) - n.(p02 - p01) = 0: 3 relations."""

    type: Literal["planar"] = Field(description="a face that slides on a face")
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    holds: ClassVar[Holds] = Holds(("axis", "distance"))
    facts: ClassVar[TypeFacts] = TypeFacts(
        holds, half_turns=True, joint=True, freedoms=("displacement_1", "displacement_2", "angle")
    )
    symbol: ClassVar[Symbol] = Symbol(space=(plate(-0.15, 2.2), plate(0.15, 1.2, 1)))
