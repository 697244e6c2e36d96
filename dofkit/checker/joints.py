"""Joints of two bodies: what keeps places, axes and angles together, with as many equations as freedoms they take."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.checker.bodies import (
    BodyFrame,
    MaterialPoint,
    Vector,
    apart,
    cross,
    difference,
    dot,
    identity,
    length,
    less,
)
from dofkit.checker.errors import CheckError
from dofkit.checker.places import along
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, times
from dofkit.checker.words import PI

Direction = tuple[Vector, tuple[Vector, ...]]


def ends(world: Surroundings, entry: Entry) -> tuple[BodyFrame, BodyFrame]:
    """The two bodies; given geometry places them."""
    between = entry["between"]
    if not isinstance(between, list) or len(between) != 2 or between[0] == between[1] or world.dimension == 1:
        raise CheckError("a joint has two different bodies, in the plane or in space")
    if any(entry.get(key) is not None for key in ("at", "axis", "axes")):
        world.drawn.update(between)
    return world.frame(between[0]), world.frame(between[1])


def axis_of(world: Surroundings, entry: Entry) -> Direction:
    """The axis of a joint; one that has a place needs it."""
    if entry.get("axis") is None and entry.get("at") is not None:
        raise CheckError("a joint with a place has an axis")
    return world.direction(entry.get("axis"))


def together(first: BodyFrame, second: BodyFrame, place: Vector) -> Iterator[Tree]:
    """The material points at ``place`` stay together."""
    yield from apart(first.point(place), second.point(place))[0]


def aligned(first: BodyFrame, second: BodyFrame, axis: Direction) -> Iterator[Tree]:
    """(A1 u).(A2 n) = 0 for the two u across n: the axis keeps its direction."""
    carried = second.carry(axis[0])
    yield from (dot(first.carry(u), carried) for u in axis[1])


def parallel(first: BodyFrame, second: BodyFrame) -> Iterator[Tree]:
    """No turn of one against the other: the angle; the Cayley parameters; or three entries of A1^T A2."""
    if len(first.position) == 2:
        yield difference(second.angle, first.angle)
    elif first.gibbs is not None and second.gibbs is not None:
        yield from less(second.gibbs, first.gibbs)
    else:
        e = identity(3)
        yield from (dot(first.carry(e[i]), second.carry(e[j])) for i, j in ((0, 1), (1, 2), (2, 0)))


def slid(first: BodyFrame, second: BodyFrame, place: Vector | None, direction: Vector) -> tuple[Tree, Tree]:
    """How far the second body has moved along a direction of the first, at a place or at its origin, and its factor."""
    point = second.point(second.start if place is None else place)
    return along(first, point, point.start or (), direction), times(first.under, point.under)


def driven(world: Surroundings, entry: Entry, slides: tuple[Tree, Tree], axis: Vector) -> Iterator[Tree]:
    """The displacement along the axis is the law."""
    if entry.get("drive") is not None:
        moved, factor = slides
        yield add(moved, negative(times(length(axis), factor, world.law(entry["drive"]))))


def sine_and_cosine(first: BodyFrame, second: BodyFrame, axis: Direction) -> tuple[Tree, Tree]:
    """Of the angle of the second body against the first about the axis n, times one positive factor.

    With u across n and w = n x u they are (A1 w).(A2 u) and |n| (A1 u).(A2 u).
    """
    n, (u, _) = axis
    now = second.carry(u)
    return dot(first.carry(cross(n, u)), now), times(length(n), dot(first.carry(u), now))


def turned(world: Surroundings, entry: Entry, bodies: tuple[BodyFrame, BodyFrame], axis: Direction) -> Iterator[Tree]:
    """The angle about the axis is the law: sin cos f - cos sin f = 0."""
    if entry.get("drive") is not None:
        sine, cosine = sine_and_cosine(*bodies, axis)
        law = world.law(entry["drive"])
        yield add(times(sine, call("cos", law)), negative(times(cosine, call("sin", law))))


def revolute(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A hinge."""
    first, second = ends(world, entry)
    yield from together(first, second, world.place(entry.get("at")))
    if world.dimension == 2:
        if entry.get("axis") is not None:
            raise CheckError("a hinge of the plane has no axis")
        if entry.get("drive") is not None:
            yield add(difference(second.angle, first.angle), negative(world.law(entry["drive"])))
        return
    axis = axis_of(world, entry)
    yield from aligned(first, second, axis)
    yield from turned(world, entry, (first, second), axis)


def prismatic(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A slider: no turn, no displacement across the axis."""
    first, second = ends(world, entry)
    n, across = axis_of(world, entry)
    yield from parallel(first, second)
    yield from (slid(first, second, None, u)[0] for u in across)
    yield from driven(world, entry, slid(first, second, None, n), n)


def weld(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The second body moves as the first: p2 - p1 = A1 (p02 - p01)."""
    first, second = ends(world, entry)
    world.welded.append((first.name, second.name))
    yield from parallel(first, second)
    yield from apart(first.point(second.start), MaterialPoint(second.position, ONE, second.start, second.name))[0]


def coaxial(world: Surroundings, entry: Entry) -> tuple[list[Tree], tuple[BodyFrame, BodyFrame], Vector, Direction]:
    """The axis stays one line: its equations, the bodies, the place and the axis."""
    first, second = ends(world, entry)
    place, axis = world.place(entry.get("at")), axis_of(world, entry)
    equations = [*aligned(first, second, axis), *(slid(first, second, place, u)[0] for u in axis[1])]
    return equations, (first, second), place, axis


def cylindrical(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A sleeve on a shaft."""
    equations, (first, second), place, axis = coaxial(world, entry)
    yield from equations
    yield from driven(world, entry, slid(first, second, place, axis[0]), axis[0])


def screw(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A sleeve whose displacement is pitch times angle / (2 pi), the angle between -pi and pi."""
    equations, (first, second), place, axis = coaxial(world, entry)
    yield from equations
    moved, factor = slid(first, second, place, axis[0])
    angle = call("atan2", *sine_and_cosine(first, second, axis))
    turns = times(angle, power(times(number(2), PI), number(-1)))
    yield add(moved, negative(times(length(axis[0]), factor, world.value(entry["pitch"]), turns)))
    yield from turned(world, entry, (first, second), axis)


def universal(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A Cardan joint: the places stay together, and the two axes across each other."""
    first, second = ends(world, entry)
    axes = entry.get("axes")
    if axes is None and entry.get("at") is not None:
        raise CheckError("a universal joint with a place has axes")
    yield from together(first, second, world.place(entry.get("at")))
    if axes is None:
        a, (u, v) = world.direction(None)
        ratio = world.fresh("axis")
        b = tuple(add(p, times(ratio, q)) for p, q in zip(u, v, strict=True))
    else:
        a, b = (world.vector(axis) for axis in axes)
    yield dot(first.carry(a), second.carry(b))


def spherical(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A ball in a socket."""
    first, second = ends(world, entry)
    yield from together(first, second, world.place(entry.get("at")))


def planar(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """A face on a face: the normal keeps its direction, and the distance along it stays."""
    first, second = ends(world, entry)
    axis = axis_of(world, entry)
    yield from aligned(first, second, axis)
    yield slid(first, second, None, axis[0])[0]


def gear(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """theta2 - ratio theta1 = 0 for angles from the reference, against the carrier if there is one."""
    first, second = ends(world, entry)
    carrier = entry.get("carrier")
    ratio = world.value(entry["ratio"])
    if ratio == ZERO or carrier in entry["between"]:
        raise CheckError("a gear pair has a ratio that is not 0 and a carrier of its own")
    arm = ZERO if carrier is None else world.frame(carrier).angle
    yield add(difference(second.angle, arm), negative(times(ratio, difference(first.angle, arm))))
