"""Every type of constraint: the equations it stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations, pairwise
from typing import NamedTuple

from dofkit.checker.derivatives import in_velocities, substituted
from dofkit.checker.geometry import (
    CheckedFrame,
    MaterialPoint,
    Vector,
    apart,
    cross,
    dot,
    length,
    less,
    rotation,
    scaled,
    square,
)
from dofkit.checker.grammar import PI, Sided, parse_relations
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import TWO, ZERO, Tree, add, call, difference, number, power, refuse, symbol, times

Read = Callable[[Surroundings, Entry], Iterator[Tree | Sided]]


def equation(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """The relations of a text, in velocities."""
    for found in parse_relations(entry["text"], world.names):
        yield found._replace(tree=in_velocities(found.tree, world.names.coordinates))


def on(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """Every text at every member, whose coordinates x, y, z stand for."""
    refuse(("surface" in entry) == ("curve" in entry), "either a surface or a curve is needed")
    relations = world.on_places(entry["curve"] if "curve" in entry else [entry["surface"]])
    for member in entry["members"]:
        values = dict(zip("xyz", world.point(member).place, strict=False))
        yield from (found._replace(tree=substituted(found.tree, values)) for found in relations)


def cam(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The profile's equation at the point in the body's own coordinates R(theta)^T (P - p)."""
    point, frame = world.point(entry["point"]), world.frames[entry["body"]]
    (profile,) = world.on_places([entry["curve"]])
    refuse(profile.sign != "=", "a profile is one equation in x and y")
    rows = rotation(2, 0, 1, symbol(list(frame.reference)[2]) if frame.reference else ZERO)
    arm = less(point.place, frame.position)
    own = [dot(column, arm) for column in zip(*rows, strict=True)]
    yield substituted(profile.tree, dict(zip("xy", own, strict=True)))


def link(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """|A - B|^2 - length^2, times the square of the denominator of A - B."""
    first, second = map(world.point, entry["between"])
    given = world.moving(entry["length"]) if "length" in entry else None
    yield distance(world, first, second, given and power(given, TWO))


def rigid(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distance of every pair of particles."""
    for first, second in combinations([world.particles[str(member)] for member in entry["members"]], 2):
        yield distance(world, first, second, None)


def distance(world: Surroundings, first: MaterialPoint, second: MaterialPoint, squared: Tree | None) -> Tree:
    """The relation of a distance whose square is given, drawn or generic."""
    if squared is None:
        drawn = first.start and second.start and square(less(first.start, second.start))
        squared = drawn or world.fresh("square")
    arm, under = apart(first, second)
    return difference(square(arm), times(squared, under, under))


def string(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distances along the points add up to the length."""
    pairs = list(pairwise(map(world.point, entry["along"])))
    drawn = [length(less(b.start, a.start)) for a, b in pairs if a.start and b.start]
    if "length" in entry:
        total = world.moving(entry["length"])
    else:
        total = add(*drawn) if len(drawn) == len(pairs) else world.fresh("length")
    yield difference(add(*(length(less(b.place, a.place)) for a, b in pairs)), total)


def fixed(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """X - a for a point; every coordinate at its reference for a body."""
    refuse(("point" in entry) == ("body" in entry), "either a point or a body is fixed")
    if "body" in entry:
        world.drawn.add(entry["body"])
        yield from (difference(symbol(q), value) for q, value in world.frames[entry["body"]].reference.items())
    else:
        point = world.point(entry["point"])
        yield from less(point.over, scaled(point.under, point.start or world.place(None)))


def coincident(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """B - A."""
    yield from apart(*map(world.point, entry["between"]))[0]


def slot(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The point does not leave the line across its axis."""
    point, frame = world.point(entry["point"]), world.frames[entry["body"]]
    across = world.direction(entry.get("axis"))[1]
    place = point.start if "at" not in entry and point.start else world.place(entry.get("at"))
    if not entry.keys().isdisjoint(("at", "axis")):
        world.drawn.add(frame.name)
    yield from (frame.offset(point, place, u) for u in across)


def roll(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """Contact, and no velocity of the lowest point: v + w x (0, 0, -r) = 0, in the plane xdot + r thetadot = 0."""
    frame, radius = world.frames[entry["body"]], world.expression(entry["radius"])
    rates = [symbol(f"{q}dot") for q in frame.reference]
    yield difference(frame.position[-1], radius)
    if world.dimension == 2:
        yield add(rates[0], times(radius, rates[2]))
        return
    if frame.cayley:
        spin = scaled(TWO, tuple(map(add, rates[3:], cross(frame.cayley, rates[3:]))))
    else:
        phi, theta, _ = map(symbol, list(frame.reference)[3:])
        c, s, tilt = call("cos", phi), call("sin", phi), times(rates[5], call("sin", theta))
        spin = add(times(rates[4], c), times(s, tilt)), difference(times(rates[4], s), times(c, tilt))
    yield difference(times(frame.under, rates[0]), times(radius, spin[1]))
    yield add(times(frame.under, rates[1]), times(radius, spin[0]))


def gear(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """theta2 - ratio theta1 = 0 for angles from the reference, against the carrier if there is one."""
    arm = world.frames[entry.get("carrier", "ground")].angle
    first, second = (difference(world.frames[name].angle, arm) for name in entry["between"])
    yield difference(second, times(world.expression(entry["ratio"]), first))


#: What each joint keeps: no ``turn`` of one body against the other; the ``point`` together; the ``axis`` in its
#: direction (in the plane it is); the point on the ``line``, or in the ``plane`` across the axis; the ``cross`` of two
#: axes; the ``thread``.
KEEPS = {
    "revolute": "point axis", "prismatic": "turn line", "weld": "turn point", "cylindrical": "axis line",
    "screw": "axis line thread", "universal": "point cross", "spherical": "point", "planar": "axis plane",
}  # fmt: skip


class CheckedJoint(NamedTuple):
    """The bodies of a joint, the place where they meet, a direction n that they keep, and vectors across n."""

    first: CheckedFrame
    second: CheckedFrame
    place: Vector
    n: Vector
    across: tuple[Vector, ...]

    def offset(self, direction: Vector) -> Tree:
        """How far the place has moved along a direction of the first body."""
        return self.first.offset(self.second.point(self.place), self.place, direction)

    def shifted(self, by: Tree) -> Tree:
        """How much more than by a given length the place has moved along n."""
        under = times(self.first.under, self.second.point(self.place).under)
        return difference(self.offset(self.n), times(under, length(self.n), by))

    def turned(self) -> tuple[Tree, Tree]:
        """The sine and cosine of the angle about n, times one positive factor."""
        u, now = self.across[0], self.second.carry(self.across[0])
        return dot(self.first.carry(cross(self.n, u)), now), times(length(self.n), dot(self.first.carry(u), now))

    def turns(self) -> Tree:
        """How often the second body has turned about n."""
        return times(call("atan2", *self.turned()), power(times(TWO, PI), number(-1)))

    def turned_by(self, angle: Tree) -> Tree:
        """The angle about n is a given one."""
        if not self.across:
            return difference(difference(self.second.angle, self.first.angle), angle)
        sine, cosine = self.turned()
        return difference(times(sine, call("cos", angle)), times(cosine, call("sin", angle)))


def joint(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """What a joint keeps, one after the other, and what its drive prescribes."""
    kind, keeps = entry["type"], KEEPS[entry["type"]].split()
    first, second = (world.frames[name] for name in entry["between"])
    if not entry.keys().isdisjoint(("at", "axis", "axes")):
        world.drawn.update(entry["between"])
    if kind == "weld":
        world.welded.append((first.name, second.name))
    # what does not turn moves as its origin does
    place = second.start if "turn" in keeps or kind == "planar" else world.place(entry.get("at"))
    asks = "line" in keeps or ("axis" in keeps and world.dimension == 3)
    refuse(asks and "at" in entry and "axis" not in entry, "a joint with a place has an axis")
    hinge = CheckedJoint(first, second, place, *(world.direction(entry.get("axis")) if asks else ((), ())))
    equations: dict[str, Callable[[], Iterable[Tree]]] = {
        "turn": lambda: parallel(first, second),
        "point": lambda: apart(first.point(place), second.point(place))[0],
        "axis": lambda: (dot(first.carry(u), second.carry(hinge.n)) for u in hinge.across),
        "line": lambda: map(hinge.offset, hinge.across),
        "plane": lambda: [hinge.offset(hinge.n)],
        "cross": lambda: [crossed(world, entry, first, second)],
        "thread": lambda: [hinge.shifted(times(world.expression(entry["pitch"]), hinge.turns()))],
    }
    for kept in keeps:
        yield from equations[kept]()
    if "drive" in entry:
        law = world.expression(entry["drive"], "t")
        yield hinge.turned_by(law) if kind in ("revolute", "screw") else hinge.shifted(law)


def parallel(first: CheckedFrame, second: CheckedFrame) -> Iterable[Tree]:
    """No turn of one against the other: the angle; the Cayley parameters; or three entries of A1^T A2."""
    if len(first.position) == 2:
        return [difference(second.angle, first.angle)]
    if first.cayley is not None and second.cayley is not None:
        return less(second.cayley, first.cayley)
    e = rotation(3, 0, 1)
    return [dot(first.carry(e[i]), second.carry(e[j])) for i, j in ((0, 1), (1, 2), (2, 0))]


def crossed(world: Surroundings, entry: Entry, first: CheckedFrame, second: CheckedFrame) -> Tree:
    """The axes of a universal joint, each carried by its body, stay across each other."""
    if "axes" in entry:
        a, b = map(world.vector, entry["axes"])
    else:
        a, (u, v) = world.direction(None)
        b = tuple(map(add, u, scaled(world.fresh("axis"), v)))
    return dot(first.carry(a), second.carry(b))


#: Every type: how it is read, the fields it has, and the dimensions in which it is defined.
TYPES: dict[str, tuple[Read, str, str]] = {
    "equation": (equation, "text", "123"), "on": (on, "members surface curve", "123"),
    "link": (link, "between length", "123"), "rigid": (rigid, "members", "123"),
    "string": (string, "along length", "123"), "fixed": (fixed, "point body", "123"),
    "coincident": (coincident, "between", "123"), "slot": (slot, "point body at axis", "23"),
    "cam": (cam, "point body curve", "2"), "roll": (roll, "body radius", "23"),
    "revolute": (joint, "between at axis drive", "23"), "prismatic": (joint, "between at axis drive", "23"),
    "weld": (joint, "between", "23"), "cylindrical": (joint, "between at axis drive", "3"),
    "screw": (joint, "between at axis drive pitch", "3"), "universal": (joint, "between at axes", "3"),
    "spherical": (joint, "between at axis", "3"), "planar": (joint, "between at axis", "3"),
    "gear": (gear, "between ratio carrier", "2"),
}  # fmt: skip
