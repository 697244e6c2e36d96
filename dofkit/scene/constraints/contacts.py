"""Contacts: a sphere or disc that rolls without slip, a pair of gears, a point on the profile of a cam."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import ClassVar, Literal, NamedTuple

from pydantic import Field

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.sparse import combined
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.enclosures import approximate, differs_from_zero, has_call
from dofkit.expressions.tree import MINUS_ONE, TIME, ZERO, Expr, add, coordinate, mul, velocity
from dofkit.expressions.vectors import Vec, apply, difference, minus, square, transposed
from dofkit.scene.constraints.base import ConstraintBase, figures, root, with_values
from dofkit.scene.constraints.joints import Joint
from dofkit.scene.constraints.places import across_a_line
from dofkit.scene.fields import Text, Value, as_written
from dofkit.scene.frames import Frame, Placed, turn
from dofkit.scene.ledger import FINITE, symbols_of
from dofkit.scene.names import within_member
from dofkit.scene.parts import Point, show_point
from dofkit.scene.symbols import POINT, Symbol
from dofkit.scene.world import World
from dofkit.system import GROUND, Kinematics, Relation, TypeFacts, VelocityRow

OWN = ("x", "y")
X, Y = (coordinate(letter) for letter in OWN)


class Cam(ConstraintBase):
    """g(x, y) = 0 for the follower's point P in the cam's frame, (x, y) = R(theta)^T (P - p): 1 relation.

    The profile g = 0 moves with the body's frame (origin p, angle theta). The contact is a higher pair of the plane, of
    freedom 2: the point slides along the profile and turns on it. If the reference configuration has contact, the
    infinitesimal motions are those of a slot along the tangent there.
    """

    type: Literal["cam"] = Field(description="a point on the profile of a body, in the plane")
    point: Point = Field(description="the follower's point, or a particle")
    body: str = Field(description="the cam, or ground")
    curve: Text = Field(description="the profile: an equation in x and y, the body's own coordinates; may contain t")

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    facts: ClassVar[TypeFacts] = TypeFacts(
        across_a_line, directions=1, written=True, lettered=True, contact=True, joint=True
    )
    symbol: ClassVar[Symbol] = Symbol(plane=(POINT,), run="profile")

    def relations(self, world: World) -> Iterator[Relation]:
        point = world.point(self.point, "point")
        frame = world.frame(self.body, "body")
        if not world.is_apart(point, frame, "point"):
            return
        profile = self._profile(world)
        if profile is None:
            return
        at_reference = None if point.reference is None else _contact_at(profile.expr, frame, point.reference)
        world.mentioned.directions.append(None if at_reference is None else at_reference.tangent(bool(world.tolerance)))
        if at_reference is not None:
            self._check(world, frame, point, at_reference)
        yield with_values(profile, _body_coordinates(frame, point), part="contact")

    def _profile(self, world: World) -> Relation | None:
        """Return the relation g(x, y) = 0 of the profile; None after a fault, which is recorded in ``world``."""
        before = len(world.faults)
        names = within_member(world.names, OWN)
        used = {s.args[1] for s in symbols_of(self.curve, names) if s.args[0] == "coordinate"}
        if used - {*OWN}:
            hint = "only x and y of the body, parameters and time may be used"
            world.fault(f"the coordinate {min(used - {*OWN})} cannot stand here", "curve", hint=hint)
            return None
        relations = world.relations(self.curve, "curve", names=replace(names, coordinates=frozenset(OWN)), allow=FINITE)
        if len(world.faults) > before:
            return None
        if [relation.sense for relation in relations] != ["="] or not used:
            hint = "write one such as x^2 + y^2 = 4; an inequality or a chain is not a profile"
            world.fault("a profile is one equation in x and y", "curve", hint=hint)
            return None
        return relations[0]

    def _check(self, world: World, frame: Frame, point: Placed, contact: ReferenceContact) -> None:
        """Record a fault, with the distance, if the point is off the profile in the reference configuration."""
        body = None if frame.fixed else frame.name
        place = point.label if point.frame else f"{point.label} at {figures(point.reference)}"
        hint = "move the point or the body, or set `tolerance` if they are measured"
        if contact.gap is None:
            message = f"the reference configuration has {place}, where `{self.curve}` has no value"
            world.misfit(None, message, "point", hint=hint, body=body)
        elif world.differs(contact.gap, body):
            gap, steepness = approximate(contact.gap), root(square(contact.slope))
            message = (
                f"the reference configuration has {place}, off the profile of {frame.name}: there `{self.curve}` fails"
            )
            message = message if gap is None else f"{message} by {abs(gap):.6g}"
            world.misfit(
                None if gap is None or not steepness else gap / steepness, message, "point", hint=hint, body=body
            )

    @property
    def in_words(self) -> str:
        return f"cam {show_point(self.point)} on {self.body}: {self.curve}"


def _body_coordinates(frame: Frame, point: Placed) -> dict[Expr, Expr]:
    """Return {x: ..., y: ...} with the point's coordinates in the body's frame."""
    arm = minus(point.over, frame.position)
    if not frame.fixed:
        arm = apply(transposed(turn(coordinate(frame.angles[0]))), arm)
    return dict(zip((X, Y), arm, strict=True))


class ReferenceContact(NamedTuple):
    """The value g (``gap``, None if undefined) and gradient (``slope``, 0 at a corner) of a profile at the point."""

    gap: Expr | None
    slope: Vec

    def tangent(self, measured: bool) -> Vec | None:
        """Return the profile's tangent; None at a corner, if undecided, or off the profile (unless ``measured``)."""
        if self.gap is None or any(map(has_call, (self.gap, *self.slope))):
            return None
        if not any(map(differs_from_zero, self.slope)) or (not measured and differs_from_zero(self.gap)):
            return None
        return mul(MINUS_ONE, self.slope[1]), self.slope[0]


def _contact_at(profile: Expr, frame: Frame, place: Vec) -> ReferenceContact:
    """Return value and gradient of the profile g at the point ``place`` of the reference configuration."""
    turned = turn(frame.initial[0]) if frame.initial else None
    arm = minus(place, frame.start)
    coordinates = arm if turned is None else apply(transposed(turned), arm)
    at = {**dict(zip((X, Y), coordinates, strict=True)), TIME: ZERO}
    try:
        gap = substitute(profile, at)
    except NoValueError:
        return ReferenceContact(None, (ZERO, ZERO))
    try:
        slope = tuple(substitute(diff(profile, letter), at) for letter in (X, Y))
    except NoValueError:
        slope = (ZERO, ZERO)
    return ReferenceContact(gap, slope if turned is None else apply(turned, slope))


class Roll(ConstraintBase):
    """A sphere rolls without slipping on the plane z = 0, or in the plane a disc on the line y = 0.

    In space, with the angular velocity w in world axes: z - r = 0, xdot - r w_y = 0, ydot + r w_x = 0 (3 relations).
    In the plane: y - r = 0, xdot + r thetadot = 0 (2 relations); theta is positive counter-clockwise.
    """

    type: Literal["roll"] = Field(description="a disc or sphere that rolls without slipping, contact included")
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
        if frame.name in world.placed and world.differs(difference(frame.start[-1], radius)):
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
    """Yield the row of (w2 - w) - ratio (w1 - w) = 0, with the angular velocity w of the carrier, or 0 without one."""
    turns = [at.spin(k)[0] for k in range(len(at.members))]
    carrier = turns[2] if len(turns) > 2 else {}
    yield combined(((1, turns[1]), (-at.number, turns[0]), (at.number - 1, carrier)))


class Gear(Joint):
    """(theta2 - theta20) - ratio (theta1 - theta10) = 0, with angles relative to ``carrier`` if given: 1 relation.

    Two wheels that touch on the outside turn against each other: their ratio is negative, -r1/r2.
    """

    type: Literal["gear"] = Field(description="two wheels geared together, in the plane")
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
