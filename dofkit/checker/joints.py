"""Joints of two bodies: what keeps places, axes and angles together, with as many equations as freedoms they take."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.checker.bodies import CheckedFrame, Vector, apart, cross, difference, dot, identity, length, less
from dofkit.checker.errors import CheckError
from dofkit.checker.places import along
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ZERO, Tree, add, call, negative, number, power, times
from dofkit.checker.words import PI

Direction = tuple[Vector, tuple[Vector, ...]]
#: What each type keeps, in this order: the places together; the axis in its direction; no turn; the place on the axis.
POINT, AXIS, TURN, LINE = "point", "axis", "turn", "line"
KEEPS = {
    "revolute": (POINT, AXIS),
    "prismatic": (TURN, LINE),
    "weld": (TURN, POINT),
    "cylindrical": (AXIS, LINE),
    "screw": (AXIS, LINE),
    "universal": (POINT,),
    "spherical": (POINT,),
    "planar": (AXIS,),
}


def joint(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The equations of a joint, and of its drive."""
    kind, d = entry["type"], world.dimension
    first, second = map(world.frame, entry["between"])
    if any(entry.get(key) is not None for key in ("at", "axis", "axes")):
        world.drawn.update(entry["between"])
    if kind == "weld":
        world.welded.append((first.name, second.name))
    # what does not turn moves as its origin does
    place = second.start if TURN in KEEPS[kind] or kind == "planar" else world.place(entry.get("at"))
    if TURN in KEEPS[kind]:
        yield from parallel(first, second)
    if POINT in KEEPS[kind]:
        yield from apart(first.point(place), second.point(place))[0]
    if kind in ("universal", "spherical", "weld") or (kind == "revolute" and d == 2):
        yield from crossed(world, entry, first, second) if kind == "universal" else ()
        if entry.get("drive") is not None:
            yield add(difference(second.angle, first.angle), negative(law(world, entry)))
        return
    if entry.get("axis") is None and entry.get("at") is not None:
        raise CheckError("a joint with a place has an axis")
    axis = world.direction(entry.get("axis"))
    if AXIS in KEEPS[kind]:
        yield from (dot(first.carry(u), second.carry(axis[0])) for u in axis[1])
    point = second.point(place)
    if LINE in KEEPS[kind]:
        yield from (along(first, point, place, u) for u in axis[1])
    moved = along(first, point, place, axis[0]), times(first.under, point.under, length(axis[0]))
    yield from movement(world, entry, (first, second, axis), moved)


def movement(
    world: Surroundings, entry: Entry, about: tuple[CheckedFrame, CheckedFrame, Direction], moved: tuple[Tree, Tree]
) -> Iterator[Tree]:
    """Along and about the axis: a plane that is kept, a thread, a drive. ``moved``: a displacement and its factor.

    The angle about n has the sine (A1 w).(A2 u) and the cosine |n| (A1 u).(A2 u), times one positive factor, with u
    across n and w = n x u.
    """
    kind, (first, second, (n, (u, *_))) = entry["type"], about
    if kind == "planar":
        yield moved[0]
    if kind in ("screw", "revolute"):
        now = second.carry(u)
        sine, cosine = dot(first.carry(cross(n, u)), now), times(length(n), dot(first.carry(u), now))
    if kind == "screw":
        turns = times(call("atan2", sine, cosine), power(times(number(2), PI), number(-1)))
        yield add(moved[0], times(number(-1), moved[1], world.expression(entry["pitch"]), turns))
    if entry.get("drive") is not None and kind in ("screw", "revolute"):
        angle = law(world, entry)
        yield add(times(sine, call("cos", angle)), negative(times(cosine, call("sin", angle))))
    elif entry.get("drive") is not None:
        yield add(moved[0], times(number(-1), moved[1], law(world, entry)))


def law(world: Surroundings, entry: Entry) -> Tree:
    """What a drive prescribes."""
    return world.expression(entry["drive"], frozenset("t"))


def parallel(first: CheckedFrame, second: CheckedFrame) -> Iterator[Tree]:
    """No turn of one against the other: the angle; the Cayley parameters; or three entries of A1^T A2."""
    if len(first.position) == 2:
        yield difference(second.angle, first.angle)
    elif first.gibbs is not None and second.gibbs is not None:
        yield from less(second.gibbs, first.gibbs)
    else:
        e = identity(3)
        yield from (dot(first.carry(e[i]), second.carry(e[j])) for i, j in ((0, 1), (1, 2), (2, 0)))


def crossed(world: Surroundings, entry: Entry, first: CheckedFrame, second: CheckedFrame) -> Iterator[Tree]:
    """The axes of a universal joint, each carried by its body, stay across each other."""
    if entry.get("axes") is not None:
        a, b = map(world.vector, entry["axes"])
    else:
        a, (u, v) = world.direction(None)
        ratio = world.fresh("axis")
        b = tuple(add(p, times(ratio, q)) for p, q in zip(u, v, strict=True))
    yield dot(first.carry(a), second.carry(b))


def gear(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """theta2 - ratio theta1 = 0 for angles from the reference, against the carrier if there is one."""
    first, second = (world.frame(name).angle for name in entry["between"])
    arm = ZERO if entry.get("carrier") is None else world.frame(entry["carrier"]).angle
    ratio = world.expression(entry["ratio"])
    yield add(difference(second, arm), negative(times(ratio, difference(first, arm))))
