"""Every type of constraint: the equations it stands for, and the points, bodies and directions that it mentions."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import combinations, pairwise
from typing import Any

from dofkit.checker.geometry import CheckedFrame, MaterialPoint, Vector, apart, cross, dot, length, less, scaled, square
from dofkit.checker.grammar import KnownNames, Sided, parse, parse_relations
from dofkit.checker.point import evaluated, not_zero
from dofkit.checker.trees import ONE, TWO, ZERO, Effort, Tree, add, call, in_velocities, refuse, substituted, symbol

Entry = Mapping[str, Any]


@dataclass
class Surroundings:
    """A scene as one constraint after the other sees it.

    ``names``: what texts may mention; ``signs``: of the parameters that stay symbols. ``generic`` grows by a symbol for
    each length or component that was left out, ``counts`` by name; ``drawn`` by the bodies that the scene
    places. ``joints``: the constraints by name; ``index``: the place of the constraint that is read, from 1.
    ``angles``: those of bodies with Cayley parameters that are 0 in the reference.
    """

    dimension: int
    frames: dict[str, CheckedFrame]
    names: KnownNames = field(default_factory=KnownNames)
    signs: dict[str, str] = field(default_factory=dict)
    particles: dict[str, MaterialPoint] = field(default_factory=dict)
    generic: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    drawn: set[str] = field(default_factory=set)
    joints: dict[str, Entry] = field(default_factory=dict)
    angles: dict[str, list[str]] = field(default_factory=dict)
    index: int = 0

    def expression(self, value: object, *allowed: str) -> Tree:
        """A number or text that mentions parameters, and what is ``allowed`` besides."""
        tree = parse(value, self.names)
        refuse(not tree.symbols <= {*self.signs, *allowed}, f"`{value}` mentions what cannot stand there")
        return tree

    def length(self, entry: Entry) -> Tree | None:
        """The length that is given, if any; it may change with time and place."""
        return self.expression(entry["length"], "t", *self.names.coordinates) if "length" in entry else None

    def vector(self, values: Any) -> Vector:
        """A place or direction."""
        refuse(not isinstance(values, list) or len(values) != self.dimension, "a place has as many components as space")
        return tuple(map(self.expression, values))

    def fresh(self, stem: str) -> Tree:
        """A new generic symbol, named by the constraint it belongs to."""
        name = f"{stem}_c{self.index}"
        self.counts[name] = self.counts.get(name, 0) + 1
        self.generic.append(f"{name}_{self.counts[name]}" if self.counts[name] > 1 else name)
        return symbol(self.generic[-1])

    def place(self, values: object) -> Vector:
        """A given place, or a generic one."""
        return self.vector(values) if values is not None else tuple(self.fresh("place") for _ in range(self.dimension))

    def point(self, written: Any) -> MaterialPoint:
        """A particle, a point of the world, or a point of a body."""
        if isinstance(written, Mapping):
            known_fields(written, "on at")
            self.drawn.add(written["on"])
            return self.frames[written["on"]].point(self.vector(written["at"]))
        listed = isinstance(written, list)
        return self.frames["ground"].point(self.vector(written)) if listed else self.particles[str(written)]

    def charted(self, names: Sequence[str]) -> list[str]:
        """What stands for coordinates: for an angle the Cayley parameter of the axis about which it turns, at first.

        Those of z, x and z; where all three angles of a body are named, they stand for all three parameters.
        """
        parameters: dict[str, str] = {}
        for body, (phi, theta, psi) in self.angles.items():
            a, b, c = list(self.frames[body].reference)[3:]
            parameters |= {phi: c, theta: a, psi: b if {phi, theta, psi}.issubset(names) else c}
        return [parameters.get(name, name) for name in names]

    def direction(self, values: object) -> tuple[Vector, tuple[Vector, ...]]:
        """A direction n, given or generic, and d - 1 independent vectors across it."""
        every = range(self.dimension)
        n = self.vector(values) if values is not None else (ONE, *(self.fresh("axis") for _ in every[1:]))
        sure = [i for i in every if nowhere_zero(n[i], self.signs, Effort())]
        refuse(not sure and (self.dimension == 3 or not any(part.symbols for part in n)), "a direction may be 0")
        k = min(sure, key=lambda i: n[i].head != "number", default=0)
        rows = [{i: n[k], k: -n[i]} for i in every if i != k]
        return n, tuple(tuple(row.get(j, ZERO) for j in every) for row in rows)

    def between(self, texts: Any, letters: Iterable[str]) -> list[Sided]:
        """Relations between letters, coordinates and time; no velocity occurs."""
        refuse(not isinstance(texts, list), "a curve is a list of texts")
        known_names = KnownNames(self.names.coordinates.union(letters), self.names.values, self.names.functions)
        relations = [relation for text in texts for relation in parse_relations(text, known_names)]
        held = frozenset().union(*(sided.tree.symbols for sided in relations))
        refuse(held - {*known_names.coordinates, *self.signs, "t"}, "a text mentions places, parameters and t")
        return relations


def known_fields(entry: Entry, fields: str) -> None:
    """Refuse an entry with a field that is not known: it would be read past."""
    unknown = entry.keys() - set(fields.split())
    refuse(unknown, f"there is no {' '.join(sorted(unknown))}; known are {fields}")


def nowhere_zero(tree: Tree, signs: Mapping[str, str], effort: Effort, positive: bool = False) -> bool:
    """Whether a tree is a product of powers of numbers and parameters that are not 0, or sums of positive ones."""
    if not tree.symbols:
        ball = evaluated(tree, {}, effort)
        return bool(ball > 0) if positive else not_zero(ball)
    if tree.head == "product":
        return all(nowhere_zero(part, signs, effort, positive) for part in tree.below)
    if tree.head == "sum":
        return all(nowhere_zero(part, signs, effort, True) for part in tree.below)
    if tree.head == "power":
        return nowhere_zero(tree.below[0], signs, effort, positive) and not tree.below[1].symbols
    sign = signs.get(str(tree.value)) if tree.head == "symbol" else "positive" if tree.head == "exp" else ""
    return sign == "positive" or (sign == "nonzero" and not positive)


def equation(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """The relations of a text, in velocities."""
    for relation in parse_relations(entry["text"], world.names):
        yield relation._replace(tree=in_velocities(relation.tree, world.names.coordinates))


def on(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """Every text at every member, whose coordinates x, y, z stand for."""
    refuse(("surface" in entry) == ("curve" in entry), "either a surface or a curve is needed")
    relations = world.between(entry["curve"] if "curve" in entry else [entry["surface"]], "xyz"[: world.dimension])
    for member in entry["members"]:
        values = dict(zip("xyz", world.point(member).place, strict=False))
        yield from (relation._replace(tree=substituted(relation.tree, values)) for relation in relations)


def cam(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The profile's equation at the point in the body's own coordinates."""
    point, frame = world.point(entry["point"]), world.frames[entry["body"]]
    (profile,) = world.between([entry["curve"]], "xy")
    refuse(profile.sign != "=", "a profile is one equation in x and y")
    yield substituted(profile.tree, dict(zip("xy", frame.in_body_axes(point.place), strict=True)))


def link(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """|A - B|^2 - length^2, times the square of the denominator of A - B."""
    yield distance(world, world.length(entry), *map(world.point, entry["between"]))


def rigid(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distance of every pair of particles."""
    for first, second in combinations([world.particles[str(member)] for member in entry["members"]], 2):
        yield distance(world, None, first, second)


def distance(world: Surroundings, prescribed: Tree | None, first: MaterialPoint, second: MaterialPoint) -> Tree:
    """The relation of a distance that is given, drawn or generic."""
    drawn = first.start and second.start and square(less(first.start, second.start))
    squared = prescribed**2 if prescribed else drawn or world.fresh("square")
    arm, under = apart(first, second)
    return square(arm) - squared * under * under


def string(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distances along the points add up to the length."""
    pairs = list(pairwise(map(world.point, entry["along"])))
    drawn = [length(less(b.start, a.start)) for a, b in pairs if a.start and b.start]
    total = world.length(entry) or (add(*drawn) if len(drawn) == len(pairs) else world.fresh("length"))
    yield add(*(length(less(b.place, a.place)) for a, b in pairs)) - total


def fixed(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """X - a for a point; every coordinate at its reference for a body."""
    refuse(("point" in entry) == ("body" in entry), "either a point or a body is fixed")
    if "body" in entry:
        world.drawn.add(entry["body"])
        yield from (symbol(q) - value for q, value in world.frames[entry["body"]].reference.items())
    else:
        point = world.point(entry["point"])
        yield from less(point.over, scaled(point.under, point.start or world.place(None)))


def coincident(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """B - A."""
    yield from apart(*map(world.point, entry["between"]))[0]


def slot(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The point stays on the line along the axis: it has no offset across it."""
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
    yield frame.position[-1] - radius
    if world.dimension == 2:
        yield rates[0] + radius * rates[2]
        return
    if frame.cayley:
        spin = scaled(TWO, tuple(map(add, rates[3:], cross(frame.cayley, rates[3:]))))
    else:
        phi, theta, _ = map(symbol, list(frame.reference)[3:])
        c, s, tilt = call("cos", phi), call("sin", phi), rates[5] * call("sin", theta)
        spin = rates[4] * c + s * tilt, rates[4] * s - c * tilt
    yield frame.under * rates[0] - radius * spin[1]
    yield frame.under * rates[1] + radius * spin[0]


def gear(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """theta2 - ratio theta1 = 0 for angles from the reference, against the carrier if there is one."""
    arm = world.frames[entry.get("carrier", "ground")].angle
    first, second = (world.frames[name].angle - arm for name in entry["between"])
    yield second - world.expression(entry["ratio"]) * first


def joint(world: Surroundings, entry: Entry, keeps: str) -> Iterator[Tree]:
    """What a joint keeps, one after the other, and what its drive prescribes.

    No ``turn`` of one body against the other; the ``point`` together; the ``axis`` in its direction (in the plane it
    is); the point on the ``line``, or in the ``plane`` across the axis; the ``cross`` of two axes; the ``thread``.
    """
    first, second = (world.frames[name] for name in entry["between"])
    if keeps == "turn point" or not entry.keys().isdisjoint(("at", "axis", "axes")):
        world.drawn.update(entry["between"])
    # what does not turn moves as its origin does
    place = second.start if "turn" in keeps or "plane" in keeps else world.place(entry.get("at"))
    asks = "line" in keeps or ("axis" in keeps and world.dimension == 3)
    refuse(asks and "at" in entry and "axis" not in entry, "a joint with a place has an axis")
    n, across = world.direction(entry.get("axis")) if asks else ((), ())
    moved = second.point(place)
    slid = partial(displaced, first, moved, place, n)
    equations: dict[str, Callable[[], Iterable[Tree]]] = {
        "turn": lambda: parallel(first, second),
        "point": lambda: apart(first.point(place), moved)[0],
        "axis": lambda: (aligned(first, second, n, n, u) for u in across),
        "line": lambda: (first.offset(moved, place, u) for u in across),
        "plane": lambda: [first.offset(moved, place, n)],
        "cross": lambda: [dot(first.carry(a), second.carry(b)) for a, b in [map(world.vector, entry["axes"])]],
        "thread": lambda: [slid() - world.expression(entry["pitch"]) * TURN * turn_about(first, second, n, across)],
    }
    for kept in keeps.split():
        yield from equations[kept]()
    if "drive" in entry:
        law = world.expression(entry["drive"], "t")
        if keeps in ("turn line", "axis line"):
            yield slid() - law
        elif not across:
            yield second.angle - first.angle - law
        else:
            u, w, s, c = across[0], cross(n, across[0]), call("sin", law), call("cos", law)
            start = tuple(map(add, scaled(c, u), scaled(s / length(n), w)))
            yield aligned(first, second, start, u, less(scaled(c, w), scaled(length(n) * s, u)))


def aligned(first: CheckedFrame, second: CheckedFrame, start: Vector, now: Vector, across: Vector) -> Tree:
    """What is 0 where ``now`` of the second body is ``start``, as long, of the first, and not where it is reversed."""
    g, h, moved = first.cayley, second.cayley, second.carry(now)
    if g and h and start is now:  # the vector of the quaternion (1, -g) (1, h)
        return dot(less(less(h, g), cross(g, h)), across)
    return dot(first.carry(across), moved) / (first.under * second.under * square(now) + dot(first.carry(start), moved))


def displaced(frame: CheckedFrame, point: MaterialPoint, place: Vector, n: Vector) -> Tree:
    """How far a point has moved from a place of a body, along n."""
    return frame.offset(point, place, n) / (frame.under * point.under * length(n))


def coupling(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """A relation between angles and displacements of joints, which are 0 at the reference."""
    names = entry["joints"] if isinstance(entry["joints"], Mapping) else {name: name for name in entry["joints"]}
    values = {letter: measured(world, name) for letter, name in names.items()}
    for relation in world.between([entry["text"]], names):
        yield relation._replace(tree=substituted(relation.tree, values))


def measured(world: Surroundings, written: str) -> Tree:
    """The angle or displacement of a joint; of one that has both, ``JOINT.angle`` or ``JOINT.displacement``."""
    name, what = (written, "") if written in world.joints else written.rsplit(".", 1)
    entry = world.joints[name]
    only = MEASURES[entry["type"]]
    refuse((what or only) not in ("angle", "displacement") or only not in ("", what or only), f"`{written}` is unclear")
    first, second = (world.frames[end] for end in entry["between"])
    if world.dimension == 2 and only == "angle":
        return second.angle - first.angle
    n, across = world.direction([*entry["axis"]])
    if (what or only) == "angle":
        return turn_about(first, second, n, across)
    place = second.start if only else world.vector(entry["at"])
    return displaced(first, second.point(place), place, n)


def turn_about(first: CheckedFrame, second: CheckedFrame, n: Vector, across: Sequence[Vector]) -> Tree:
    """The angle of the second body against the first about n."""
    u, now = across[0], second.carry(across[0])
    return call("atan2", dot(first.carry(cross(n, u)), now), length(n) * dot(first.carry(u), now))


def parallel(first: CheckedFrame, second: CheckedFrame) -> Iterable[Tree]:
    """No turn of one against the other: the angle; Cayley parameters, those of B = A1^T A2 by B - B^T over 1 + tr B."""
    if len(first.position) == 2:
        return [second.angle - first.angle]
    if first.cayley is not None and second.cayley is not None:
        return less(second.cayley, first.cayley)
    a, b = (tuple(zip(*frame.turn, strict=True)) for frame in (first, second))
    half = add(first.under * second.under, *(dot(a[i], b[i]) for i in range(3))) ** -1
    return [half * (dot(a[i], b[j]) - dot(a[j], b[i])) for i, j in ((0, 1), (1, 2), (2, 0))]


#: What a coupling tells of a joint; "" where it has to say which. How many turns a radian is.
MEASURES = {"revolute": "angle", "prismatic": "displacement", "cylindrical": "", "screw": ""}
TURN = parse("1/(2*pi)", KnownNames())
#: What each joint keeps, the fields it has beside ``between``, and the dimensions in which it is defined.
JOINTS = {
    "revolute": ("point axis", "at axis drive", "23"), "prismatic": ("turn line", "at axis drive", "23"),
    "weld": ("turn point", "", "23"), "cylindrical": ("axis line", "at axis drive", "3"),
    "screw": ("axis line thread", "at axis drive pitch", "3"), "planar": ("axis plane", "at axis", "3"),
    "universal": ("point cross", "at axes", "3"), "spherical": ("point", "at axis", "3"),
}  # fmt: skip
#: Every type: how it is read, the fields it has, and the dimensions in which it is defined.
TYPES: dict[str, tuple[Callable[[Surroundings, Entry], Iterator[Tree | Sided]], str, str]] = {
    "equation": (equation, "text", "123"), "rigid": (rigid, "members", "123"), "fixed": (fixed, "point body", "123"),
    "on": (on, "members surface curve", "123"), "link": (link, "between length", "123"),
    "roll": (roll, "body radius", "23"), "string": (string, "along length", "123"),
    "slot": (slot, "point body at axis", "23"), "coincident": (coincident, "between", "123"),
    "gear": (gear, "between ratio carrier", "2"), "cam": (cam, "point body curve", "2"),
    "coupling": (coupling, "joints text", "23"),
    **{name: (partial(joint, keeps=keeps), f"between {more}", where) for name, (keeps, more, where) in JOINTS.items()},
}  # fmt: skip
