"""Constraints of places: fixed, coincident, slot, cam, and a wheel or ball that rolls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from dofkit.checker.bodies import (
    BodyFrame,
    MaterialPoint,
    Vector,
    apart,
    cross,
    difference,
    dot,
    less,
    plane_turn,
    scaled,
    transposed,
)
from dofkit.checker.derivatives import substituted, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import parse_relations
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, symbol, times


def fixed(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """X - a for a point; every coordinate at its reference for a body."""
    point, body = entry.get("point"), entry.get("body")
    if (point is None) == (body is None) or body == "ground":
        raise CheckError("either a point or a body is fixed")
    if point is not None:
        placed = world.point(point)
        if placed.carrier == "ground":
            raise CheckError("a point of the world is fixed already")
        stands = placed.start or tuple(world.fresh("place") for _ in range(world.dimension))
        yield from less(placed.over, scaled(placed.under, stands))
        return
    frame = world.frame(body)
    world.drawn.add(frame.name)
    yield from less(frame.position, frame.start)
    yield from less(tuple(map(symbol, frame.angles)), frame.initial)


def coincident(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """B - A."""
    first, second = (world.point(end) for end in entry["between"])
    if first == second or (first.carrier is not None and first.carrier == second.carrier):
        raise CheckError("a point cannot be joined to itself")
    yield from apart(first, second)[0]


def slot(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The point does not leave the line across its axis."""
    point, frame = world.point(entry["point"]), world.frame(entry["body"])
    if point.carrier == frame.name or world.dimension == 1:
        raise CheckError("a slot needs a point of something else, in the plane or in space")
    _, across = world.direction(entry.get("axis"))
    at = entry.get("at")
    place = point.start if at is None and point.start is not None else world.place(at)
    if at is not None or entry.get("axis") is not None:
        world.drawn.add(frame.name)
    for u in across:
        yield along(frame, point, place, u)


def along(frame: BodyFrame, point: MaterialPoint, place: Vector, direction: Vector) -> Tree:
    """How far a point is from a place of a body, along a direction of that body, times both denominators."""
    offset = less(point.over, scaled(point.under, frame.position))
    arm = dot(direction, less(place, frame.start))
    return difference(dot(frame.carry(direction), offset), times(frame.under, point.under, arm))


def cam(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The profile's equation at the point in the body's own coordinates R(theta)^T (P - p)."""
    point, frame = world.point(entry["point"]), world.frame(entry["body"])
    if point.carrier == frame.name or world.dimension != 2:
        raise CheckError("a cam needs a point of something else, in the plane")
    own = ("x", "y")
    values = {name: tree for name, tree in world.names.values.items() if name not in own}
    functions = {name: given for name, given in world.names.functions.items() if name not in own}
    found = parse_relations(
        str(entry["curve"]), replace(world.names, coordinates=frozenset(own), values=values, functions=functions)
    )
    mentioned = symbols_in(found[0].tree)
    if len(found) != 1 or found[0].sign != "=" or mentioned.isdisjoint(own):
        raise CheckError("a profile is one equation in x and y")
    if mentioned - {*own, "t", *world.signs}:
        raise CheckError("a profile mentions x, y, parameters and t only")
    arm = less(scaled_down(point), frame.position)
    angle = symbol(frame.angles[0]) if frame.angles else ZERO
    arm = tuple(dot(row, arm) for row in transposed(plane_turn(angle)))
    yield substituted(found[0].tree, dict(zip(own, arm, strict=True)))


def scaled_down(point: MaterialPoint) -> Vector:
    """Where a point stands."""
    return point.over if point.under == ONE else scaled(power(point.under, number(-1)), point.over)


def roll(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """Contact, and no velocity of the lowest point: v + w x (0, 0, -r) = 0, in the plane xdot + r thetadot = 0."""
    frame, radius = world.frame(entry["body"]), world.value(entry["radius"])
    if frame.fixed or world.dimension == 1:
        raise CheckError("a body of the plane or of space rolls")
    rates = [symbol(f"{part.value}dot") for part in frame.position]
    turns = tuple(symbol(f"{name}dot") for name in frame.angles)
    yield difference(frame.position[-1], radius)
    if world.dimension == 2:
        yield add(rates[0], times(radius, turns[0]))
        return
    if frame.gibbs is not None:
        twice = tuple(add(p, q) for p, q in zip(turns, cross(frame.gibbs, turns), strict=True))
        spin, under = scaled(number(2), twice), frame.under
    else:
        (phi, theta), under = (symbol(name) for name in frame.angles[:2]), ONE
        tilt = call("sin", theta)
        spin = (
            add(times(turns[1], call("cos", phi)), times(turns[2], call("sin", phi), tilt)),
            add(times(turns[1], call("sin", phi)), negative(times(turns[2], call("cos", phi), tilt))),
        )
    yield add(times(under, rates[0]), negative(times(radius, spin[1])))
    yield add(times(under, rates[1]), times(radius, spin[0]))
