"""Contact without slip: a rolling sphere or disc, a pair of gears."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.exact.matrices.sparse import combined
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr, add, mul, velocity
from dofkit.expressions.vectors import difference
from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.constraints.joints import Joint
from dofkit.scene.fields import Value, as_written
from dofkit.scene.frames import Frame
from dofkit.scene.symbols import Symbol
from dofkit.scene.world import World
from dofkit.system import GROUND, Kinematics, Relation, TypeFacts, VelocityRow


class Roll(ConstraintBase):
    """Rolls without slipping on the plane z = 0 (a sphere in space) or the line y = 0 (a disc in the plane).

    Space, with the angular velocity w in world axes: z - r = 0, xdot - r w_y = 0, ydot + r w_x = 0 (3 relations).
    Plane: y - r = 0, xdot + r thetadot = 0 (2 relations); theta counts counter-clockwise.
    """

    type: Literal["roll"] = Field(description="a disc or sphere that rolls without slipping, contact included")
    examples: ClassVar[Mapping[int, str]] = {0: "{type: roll, body: wheel, radius: 1}"}
    understood: ClassVar[tuple[str, ...]] = ("wheel", "rolling", "disc", "no-slip")
    body: str = Field(description="the body; its origin is its centre")
    radius: Value = Field(description="its radius")
    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    facts: ClassVar[TypeFacts] = TypeFacts(joint=True)
    symbol: ClassVar[Symbol] = Symbol(run="wheel", size="radius")

    def relations(self, world: World) -> Iterator[Relation]:
        radius = world.fixed(self.radius, "radius")
        size = approximate(radius)
        if size is not None and size <= 0:
            world.fault(f"a radius is positive, not {as_written(self.radius)}", "radius")
        frame = world.frame(self.body, "body")
        if frame.fixed:
            if self.body == GROUND:
                world.fault("the ground does not roll", "body", hint="name a body")
            return
        if world.is_drawn(frame) and world.differs(difference(frame.start[-1], radius)):
            height = world.table.bodies[frame.name][world.dimension - 1]
            world.warnings.append(
                f"{frame.name} rolls at {height} = {as_written(self.radius)} but its reference configuration has "
                f"{height} = {approximate(frame.start[-1]):g}; `configuration` can place its centre"
            )
        yield Relation(difference(frame.position[-1], radius), part="contact")
        yield from _no_slip(frame, radius)

    @property
    def in_words(self) -> str:
        return f"roll {self.body}, radius {as_written(self.radius)}"


def _no_slip(frame: Frame, radius: Expr) -> Iterator[Relation]:
    rates = [velocity(part.args[1]) for part in frame.position]
    if frame.dimension == 2:
        yield Relation(add(rates[0], mul(radius, velocity(frame.angles[0]))), part="no slip")
        return
    spin, under = frame.spin()
    yield Relation(difference(mul(under, rates[0]), mul(radius, spin[1])), part="no slip x")
    yield Relation(add(mul(under, rates[1]), mul(radius, spin[0])), part="no slip y")


def _gear_rows(at: Kinematics) -> Iterator[VelocityRow]:
    """(w2 - w) - ratio (w1 - w) = 0, with w of the carrier if there is one."""
    turns = [at.spin(k)[0] for k in range(len(at.members))]
    carrier = turns[2] if len(turns) > 2 else {}
    yield combined(((1, turns[1]), (-at.number, turns[0]), (at.number - 1, carrier)))


class Gear(Joint):
    """(theta2 - theta20) - ratio (theta1 - theta10) = 0, angles against ``carrier`` if there is one: 1 relation.

    Two wheels that touch on the outside turn against each other: their ratio is negative, -r1/r2.
    """

    type: Literal["gear"] = Field(description="two wheels geared together, in the plane")
    examples: ClassVar[Mapping[int, str]] = {2: "{type: gear, between: [crank, rod], ratio: -2}"}
    understood: ClassVar[tuple[str, ...]] = ("gears", "meshing")
    ratio: Value = Field(description="angle of the second by angle of the first; negative for wheels that mesh outside")
    carrier: str | None = Field(None, description="the body that carries both axes, as in a planetary gear")
    dimensions: ClassVar[tuple[int, ...]] = (2,)
    facts: ClassVar[TypeFacts] = TypeFacts(_gear_rows, joint=True, geared=True)
    symbol: ClassVar[Symbol] = Symbol(run="teeth")

    def joined(self, world: World, first: Frame, second: Frame) -> Sequence[Relation]:
        ratio = world.mentioned.number = world.fixed(self.ratio, "ratio")
        if ratio.is_zero:
            world.fault("a gear ratio cannot be 0", "ratio")
        first_angle, second_angle = first.angle, second.angle
        if self.carrier is not None:
            if self.carrier in self.between:
                world.fault(f"'{self.carrier}' cannot carry its own wheel", "carrier", hint="name a third body")
            arm = world.frame(self.carrier, "carrier").angle
            first_angle, second_angle = difference(first_angle, arm), difference(second_angle, arm)
        return (Relation(difference(second_angle, mul(ratio, first_angle))),)

    @property
    def in_words(self) -> str:
        words = f"{super().in_words}, ratio {as_written(self.ratio)}"
        return words if self.carrier is None else f"{words}, carried by {self.carrier}"
