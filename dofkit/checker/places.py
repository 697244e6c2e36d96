"""Constraints of places: fixed, coincident, slot, cam, and a wheel or ball that rolls."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.checker.bodies import (
    CheckedFrame,
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
from dofkit.checker.derivatives import substituted
from dofkit.checker.equations import lettered
from dofkit.checker.errors import CheckError
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import Tree, add, call, negative, number, symbol, times


def fixed(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """X - a for a point; every coordinate at its reference for a body."""
    if (entry.get("point") is None) == (entry.get("body") is None):
        raise CheckError("either a point or a body is fixed")
    if entry.get("body") is None:
        placed = world.point(entry["point"])
        yield from less(placed.over, scaled(placed.under, placed.start or world.place(None)))
        return
    frame = world.frame(entry["body"])
    world.drawn.add(frame.name)
    yield from less((*frame.position, *map(symbol, frame.angles)), (*frame.start, *frame.initial))


def coincident(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """B - A."""
    first, second = map(world.point, entry["between"])
    yield from apart(first, second)[0]


def slot(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The point does not leave the line across its axis."""
    point, frame, at = world.point(entry["point"]), world.frame(entry["body"]), entry.get("at")
    _, across = world.direction(entry.get("axis"))
    place = point.start if at is None and point.start else world.place(at)
    if at is not None or entry.get("axis") is not None:
        world.drawn.add(frame.name)
    for u in across:
        yield along(frame, point, place, u)


def along(frame: CheckedFrame, point: MaterialPoint, place: Vector, direction: Vector) -> Tree:
    """How far a point is from a place of a body, along a direction of that body, times both denominators."""
    offset = less(point.over, scaled(point.under, frame.position))
    arm = dot(direction, less(place, frame.start))
    return difference(dot(frame.carry(direction), offset), times(frame.under, point.under, arm))


def cam(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The profile's equation at the point in the body's own coordinates R(theta)^T (P - p)."""
    point, frame = world.point(entry["point"]), world.frame(entry["body"])
    (profile,) = lettered(world, [entry["curve"]], ("x", "y"), frozenset())
    if profile.sign != "=":
        raise CheckError("a profile is one equation in x and y")
    rows = plane_turn(symbol(frame.angles[0])) if frame.angles else frame.turn
    arm = less(point.place, frame.position)
    own = [dot(row, arm) for row in transposed(rows)]
    yield substituted(profile.tree, dict(zip(("x", "y"), own, strict=True)))


def roll(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """Contact, and no velocity of the lowest point: v + w x (0, 0, -r) = 0, in the plane xdot + r thetadot = 0."""
    frame, radius = world.frame(entry["body"]), world.expression(entry["radius"])
    rates = [symbol(f"{part.value}dot") for part in frame.position]
    turns = tuple(symbol(f"{name}dot") for name in frame.angles)
    yield difference(frame.position[-1], radius)
    if world.dimension == 2:
        yield add(rates[0], times(radius, turns[0]))
        return
    if frame.gibbs is not None:
        spin = [times(number(2), add(p, q)) for p, q in zip(turns, cross(frame.gibbs, turns), strict=True)]
    else:
        phi, theta, _ = map(symbol, frame.angles)
        c, s, tilt = call("cos", phi), call("sin", phi), times(turns[2], call("sin", theta))
        spin = [add(times(turns[1], c), times(s, tilt)), add(times(turns[1], s), negative(times(c, tilt)))]
    yield add(times(frame.under, rates[0]), negative(times(radius, spin[1])))
    yield add(times(frame.under, rates[1]), times(radius, spin[0]))
