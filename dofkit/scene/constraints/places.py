"""Constraints of place: fixed, coincident, a point in a slot."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.exact.matrices.sparse import across, less
from dofkit.expressions.tree import TWO, ZERO, Expr, coordinate, mul, power
from dofkit.expressions.vectors import Vec, difference, dot, minus, scaled, square
from dofkit.scene.constraints.base import ConstraintBase, component_relations, figures, meet, root
from dofkit.scene.fields import Vector
from dofkit.scene.frames import Frame, Placed, between
from dofkit.scene.parts import BodyPoint, Ends, Point, show_point, show_vector
from dofkit.scene.symbols import POINT, RING, Symbol, axle, prism, rail
from dofkit.scene.world import Direction, World
from dofkit.system import GROUND, Kinematics, Relation, TypeFacts, VelocityRow


def _fixed_rows(at: Kinematics) -> Iterator[VelocityRow]:
    """Yield the rows of the velocity of the fixed point, or of the body's velocity and angular velocity."""
    if at.points:
        yield from at.velocity(0)
    else:
        yield from at.origin(0)
        yield from at.spin(0)


class Fixed(ConstraintBase):
    """A point: X - a = 0, d relations. A body: every coordinate at its reference value, d(d+1)/2 relations."""

    type: Literal["fixed"] = Field(description="a point or a whole body that stays where it is")
    point: Point | None = Field(None, description="a particle or a point of a body")
    body: str | None = Field(None, description="a body")
    facts: ClassVar[TypeFacts] = TypeFacts(_fixed_rows, joint=True, held=True)
    symbol: ClassVar[Symbol] = Symbol(plane=(POINT,), space=(POINT,))

    def relations(self, world: World) -> Iterator[Relation]:
        if (self.point is None) == (self.body is None):
            world.fault("one of `point` and `body` is needed, and not both", hint="`point: A`, or `body: B`")
        elif self.point is not None:
            yield from self._hold_point(world, self.point)
        elif self.body == GROUND:
            world.fault("the ground is fixed already", "body", hint="leave this constraint out")
        elif self.body is not None:
            frame = world.frame(self.body, "body")
            if not frame.fixed:
                world.placed.add(frame.name)
                yield from _hold(frame)

    def _hold_point(self, world: World, point: str | Vector | BodyPoint) -> Iterator[Relation]:
        """Yield the relations that a point stays at its reference position; without one, at new parameters."""
        placed = world.point(point, "point")
        if placed.frame == GROUND:
            world.fault("this point is fixed in the world already", "point", hint="name a particle or a body's point")
            return
        position = placed.reference
        if position is None:
            position = tuple(world.fresh() for _ in range(world.dimension))
        else:
            world.apart(placed, world.ground.point(position, figures(position)), ZERO)
        yield from component_relations(minus(placed.over, scaled(placed.under, position)))

    @property
    def in_words(self) -> str:
        return f"fixed {self.body}" if self.point is None else f"fixed point {show_point(self.point)}"


def _hold(frame: Frame) -> Iterator[Relation]:
    """Yield the relations that a body has its reference position, and no rotation from the reference."""
    yield from component_relations(minus(frame.position, frame.start))
    if frame.chart == "gibbs":
        yield from component_relations(tuple(coordinate(name) for name in frame.angles), "orientation {}")
        return
    for name, start in zip(frame.angles, frame.initial, strict=True):
        yield Relation(difference(coordinate(name), start), part="angle" if frame.chart == "plane" else f"angle {name}")


def _coincident_rows(at: Kinematics) -> Iterator[VelocityRow]:
    yield from less(at.velocity(1), at.velocity(0))


class Coincident(ConstraintBase):
    """A - B = 0: d relations."""

    type: Literal["coincident"] = Field(description="two points that coincide")
    between: Ends = Field(description="the two points")
    facts: ClassVar[TypeFacts] = TypeFacts(_coincident_rows, joint=True, merged=True)
    symbol: ClassVar[Symbol] = Symbol(plane=(RING, POINT), space=(RING, POINT))

    def relations(self, world: World) -> Iterator[Relation]:
        first, second = (world.point(end, "between", i) for i, end in enumerate(self.between))
        if first.label == second.label or (first.frame is not None and first.frame == second.frame):
            words = first.label if first.label == second.label else f"two points of {first.frame}"
            hint = "name points of two different bodies or particles"
            world.fault(f"{words} cannot be joined to itself", "between", 1, hint=hint)
            return
        meet(world, first, second, "between")
        world.apart(first, second, ZERO)
        yield from component_relations(between(first, second)[0])

    @property
    def in_words(self) -> str:
        return "coincident " + ", ".join(show_point(end) for end in self.between)


def across_a_line(at: Kinematics) -> Iterator[VelocityRow]:
    """Yield the rows that the point has no velocity perpendicular to the line, relative to the body."""
    yield from across(at.directions[0], at.slip())


class Slot(ConstraintBase):
    """The point P stays on the line through ``at`` along ``axis`` that ``body`` carries: d - 1 relations.

    (R u).(P - p) - u.(a - p0) = 0 for each direction u perpendicular to the axis, with the body's position p (p0 in the
    reference), its rotation R and a = ``at``.
    """

    type: Literal["slot"] = Field(description="a point on a straight line carried by a body")
    point: Point = Field(description="the point")
    body: str = Field(description="the body that carries the line, or ground")
    at: Vector | None = Field(None, description="a point of the line in the reference configuration")
    axis: Vector | None = Field(None, description="the line's direction in the reference configuration")

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    facts: ClassVar[TypeFacts] = TypeFacts(across_a_line, joint=True, slides=True, contact=True)
    symbol: ClassVar[Symbol] = Symbol(
        plane=(rail(4.0, 0.7, 1), rail(4.0, -0.7, 1), RING),
        space=(axle(4.0, 1), *prism(0.6, 4.0, 1)[2:], RING),
        rails=4.0,
    )

    def relations(self, world: World) -> Iterator[Relation]:
        point = world.point(self.point, "point")
        frame = world.frame(self.body, "body")
        if not world.is_apart(point, frame, "point"):
            return
        axis = world.direction(self.axis, "axis")
        through_point = self.at is None and point.reference is not None
        place = point.reference if through_point and point.reference else world.place(self.at, "at")
        if self.at is not None or self.axis is not None:
            world.placed.add(frame.name)
        _check_on_line(world, point, place, axis)
        for u in axis.across:
            yield Relation(along(frame, point, place, u), part="across", vector=u)

    @property
    def in_words(self) -> str:
        words = f"slot {show_point(self.point)} on {self.body}"
        if self.at is not None:
            words += f" through {show_vector(self.at)}"
        return words + ("" if self.axis is None else f" along {show_vector(self.axis)}")


def along(frame: Frame, point: Placed, place: Vec, direction: Vec) -> Expr:
    """Return (R u).(P - p) - u.(a - p0) times its denominator: the displacement of P from the place a along u."""
    arm = dot(direction, minus(place, frame.start))
    offset = minus(point.over, scaled(point.under, frame.position))
    return difference(dot(frame.carry(direction), offset), mul(arm, frame.under, point.under))


def _check_on_line(world: World, point: Placed, place: Vec, axis: Direction) -> None:
    """Record a fault, with the distance, if the point is off the line in the reference configuration."""
    stands = point.reference
    if stands is None:
        return
    arm, n = minus(stands, place), axis.vector
    if not world.any_differs([dot(u, arm) for u in axis.across]):
        return
    message = (
        f"in the reference configuration {point.label} is at {figures(stands)}, off the line through {figures(place)}"
    )
    hint = "move the point or the line, or set `tolerance` if it is measured"
    distance = root(difference(square(arm), power(dot(arm, n), TWO) / square(n)))
    world.misfit(distance, message, "point", hint=hint)
