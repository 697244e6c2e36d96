"""Random SolveSpace sketches in space: their files, and the rank of what SolveSpace solves, by its formulas in floats.

Unknowns are SolveSpace's own: u and v of points in workplanes, quaternions of workplanes, vectors of extrusions, and
the factors of points on lines and of parallel lines. Copies move with what they are copies of.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from models.sketches import RandomSketch, Values

Vector = np.ndarray
At = Callable[[Values], Vector]
SIXTH = math.sqrt(0.5)
TURNS = (
    (1.0, 0.0, 0.0, 0.0),
    (0.5, 0.5, 0.5, 0.5),
    (SIXTH, SIXTH, 0.0, 0.0),
    (0.8, 0.6, 0.0, 0.0),
    (0.2, 0.4, 0.4, 0.8),
)
REFERENCE, TILTED, COPIES, ON_LINES = 1, 2, 4, 5


class Point(NamedTuple):
    """A point: its handle, where it is, and the workplane it is drawn in (0: none)."""

    handle: int
    at: At
    plane: int = 0


class Line(NamedTuple):
    """A line by its ends, or the direction of a normal (no ends)."""

    handle: int
    along: At
    ends: tuple[Point, ...] = ()
    plane: int = 0


class Plane(NamedTuple):
    """A workplane: its origin, and its axes u, v and n."""

    handle: int
    origin: At
    axes: tuple[At, At, At]


class Circle(NamedTuple):
    """A circle: its centre, its axes and the number of its radius."""

    handle: int
    centre: Point
    axes: tuple[At, At, At]
    radius: int


def _turned(w: Any, x: Any, y: Any, z: Any) -> tuple[Vector, Vector, Vector]:
    return (
        np.array([w * w + x * x - y * y - z * z, 2 * w * z + 2 * x * y, 2 * x * z - 2 * w * y]),
        np.array([2 * x * y - 2 * w * z, w * w - x * x + y * y - z * z, 2 * w * x + 2 * y * z]),
        np.array([2 * w * y + 2 * x * z, 2 * y * z - 2 * w * x, w * w - x * x - y * y + z * z]),
    )


def _axes_of(read: Callable[[Values], Sequence[Any]]) -> tuple[At, At, At]:
    u, v, n = ((lambda q, k=k: _turned(*read(q))[k]) for k in range(3))
    return u, v, n


def _size(a: Vector) -> Any:
    return (a @ a) ** 0.5


@dataclass
class RandomSpace(RandomSketch):
    """A sketch in space in the making."""

    places: list[Point] = field(default_factory=list)
    segments: list[Line] = field(default_factory=list)
    normals: list[tuple[Line, tuple[At, At, At]]] = field(default_factory=list)
    planes: list[Plane] = field(default_factory=list)
    rings: list[Circle] = field(default_factory=list)
    faces: list[Plane] = field(default_factory=list)
    group: int = 3

    def __post_init__(self) -> None:
        self.record("Group", h_v="00000001", type="5000", name="#references")
        self.record("Group", h_v="00000003", type="5000", name="sketch-in-3d")
        for k, turn in ((1, TURNS[0]), (2, TURNS[1])):
            self.record("Request", h_v=f"{k:08x}", type="100", group_v="00000001")
            self.entity(k << 16, 10000, point_0=(k << 16) + 1, normal_v=(k << 16) + 32)
            self.entity((k << 16) + 1, 2000)
            self.plane(k << 16, (k << 16) + 32, Point((k << 16) + 1, lambda q: np.zeros(3)), (3000, turn), None)

    def entity(self, handle: int, kind: int, drawn: dict[str, float] | None = None, **handles: int) -> None:
        told = {key: f"{value:08x}" for key, value in handles.items()}
        numbers = {key: f"{value:.20f}" for key, value in (drawn or {}).items()}
        self.record("Entity", h_v=f"{handle:08x}", type=str(kind), **told, **numbers)

    def unknown(self, value: float) -> int:
        self.drawn.append(value)
        return len(self.drawn) - 1

    def now(self, at: At) -> Vector:
        return np.real(at([complex(v) for v in self.drawn]))

    def request(self, kind: int) -> int:
        self.requests += 1
        self.record("Request", h_v=f"{self.requests:08x}", type=str(kind), group_v=f"{self.group:08x}")
        return self.requests << 16

    def point(self, handle: int, place: Sequence[float], plane: Plane | None = None) -> Point:
        """A point drawn in space, or by u and v in a workplane."""
        k = [self.unknown(v) for v in place]
        if plane is None:
            found = Point(handle, lambda q: np.array([q[i] for i in k]))
        else:
            u, v, _ = plane.axes
            found = Point(handle, lambda q: plane.origin(q) + u(q) * q[k[0]] + v(q) * q[k[1]], plane.handle)
        self.placed(found, 2000 if plane is None else 2001)
        return found

    def placed(self, point: Point, kind: int) -> None:
        drawn = {f"actPoint_{c}": v for c, v in zip("xyz", self.now(point.at), strict=True)}
        self.entity(point.handle, kind, drawn, **({"workplane_v": point.plane} if point.plane else {}))
        self.places.append(point)

    def segment(self, handle: int, a: Point, b: Point) -> None:
        self.entity(handle, 11000, point_0=a.handle, point_1=b.handle)
        plane = a.plane if a.plane == b.plane else 0
        self.segments.append(Line(handle, lambda q: a.at(q) - b.at(q), (a, b), plane))

    def drawn_line(self, a: Sequence[float], b: Sequence[float], plane: Plane | None = None) -> None:
        base = self.request(200)
        self.segment(base, self.point(base + 1, a, plane), self.point(base + 2, b, plane))

    def plane(
        self, handle: int, normal: int, origin: Point, how: tuple[int, Sequence[float]], axes: tuple[At, At, At] | None
    ) -> Plane:
        """A workplane with its normal: of given axes, or turned by numbers."""
        kind, turn = how
        drawn = {f"actNormal_{k}": v for k, v in zip(("w", "vx", "vy", "vz"), turn, strict=True)}
        self.entity(normal, kind, drawn, point_0=origin.handle)
        axes = axes or _axes_of(lambda q: turn)
        found = Plane(handle, origin.at, axes)
        self.planes.append(found)
        self.normals.append((Line(normal, axes[2]), axes))
        return found

    def free_axes(self, turn: Sequence[float]) -> tuple[At, At, At]:
        """Axes of a quaternion of their own."""
        k = [self.unknown(v) for v in turn]
        self.residuals.append(lambda q: [sum(q[i] ** 2 for i in k) ** 0.5 - 1])
        return _axes_of(lambda q: [q[i] for i in k])

    def free_plane(self, place: Sequence[float], turn: Sequence[float]) -> Plane:
        base = self.request(100)
        origin = self.point(base + 1, place)
        self.entity(base, 10000, point_0=base + 1, normal_v=base + 32)
        return self.plane(base, base + 32, origin, (3000, turn), self.free_axes(turn))

    def group_plane(self, group: int, origin: Point, how: dict[str, str], axes: Any, turn: Sequence[float]) -> Plane:
        base = 0x80000000 + (group << 16)
        self.record(
            "Group",
            h_v=f"{group:08x}",
            type="5001",
            name=f"plane-{group}",
            predef_origin_v=f"{origin.handle:08x}",
            **how,
        )
        self.entity(base, 10000, point_0=base + 2, normal_v=base + 1)
        self.entity(base + 2, 2012, {f"actPoint_{c}": v for c, v in zip("xyz", self.now(origin.at), strict=True)})
        return self.plane(base, base + 1, origin, (3010, turn), axes)

    def circle(self, place: Sequence[float], radius: float, turn: Sequence[float]) -> None:
        base = self.request(400)
        centre = self.point(base + 1, place)
        axes = self.free_axes(turn)
        drawn = {f"actNormal_{k}": v for k, v in zip(("w", "vx", "vy", "vz"), turn, strict=True)}
        self.entity(base + 32, 3000, drawn, point_0=base + 1)
        self.entity(base + 64, 4000, {"actDistance": radius})
        self.entity(base, 13000, point_0=base + 1, normal_v=base + 32, distance_v=base + 64)
        self.normals.append((Line(base + 32, axes[2]), axes))
        self.rings.append(Circle(base, centre, axes, self.unknown(radius)))

    def extruded(self, plane: Plane, depth: float, two_sided: bool) -> None:
        """Copies of the lines of a workplane, moved along its normal to one side or to both."""
        lines = [one for one in self.segments if one.plane == plane.handle]
        start = depth * self.now(plane.axes[2])
        k = [self.unknown(v / (1 if two_sided else 2)) for v in start]
        self.residuals.append(lambda q: [a(q) @ np.array([q[i] for i in k]) for a in plane.axes[:2]])
        base, table, count = 0x80000000 + (COPIES << 16), list[str](), 0
        ends = ((1002, -1), (1001, 1)) if two_sided else ((1002, 0), (1001, 2))
        made = []
        for which, steps in ends:
            for line in lines:
                copies = []
                for end in line.ends:
                    count += 1
                    table.append(f"    {count} {end.handle:08x} {which}")
                    copies.append(Point(base + count, _moved(end.at, steps, k)))
                count += 1
                table.append(f"    {count} {line.handle:08x} {which}")
                made.append((base + count, copies))
        faces = []
        for line in lines:
            count += 1
            table.append(f"    {count} {line.handle:08x} 1004")
            faces.append((base + count, 5001, line.ends[0], _side(line, k)))
        ends_at = {which: made[i * len(lines)][1][0] for i, (which, _) in enumerate(ends)}
        for which, point in ends_at.items():
            count += 1
            table.append(f"    {count} 00000000 {which}")
            faces.append((base + count, 5000, point, plane.axes[2]))
        how = {"type": "5100", "name": "extrude", "predef_entityB_v": f"{plane.handle:08x}", "scale": "1.0"}
        self.record("Group", h_v=f"{COPIES:08x}", subtype="7001" if two_sided else "7000", **how)
        self.records[-1] = self.records[-1].replace("AddGroup", "\n".join(["Group.remap={", *table, "}", "AddGroup"]))
        for handle, copies in made:
            for one in copies:
                self.placed(one, 2010)
            self.segment(handle, copies[0], copies[1])
        for handle, kind, point, normal in faces:
            drawn = {f"actNormal_v{c}": v for c, v in zip("xyz", self.now(normal), strict=True)}
            self.entity(handle, kind, drawn, point_0=point.handle)
            self.faces.append(Plane(handle, point.at, (normal, normal, normal)))


def _side(line: Line, vector: Sequence[int]) -> At:
    """The normal of a face that a line makes."""

    def normal(q: Values) -> Vector:
        found = np.cross(np.array([q[i] for i in vector]), -line.along(q))
        return found / _size(found)

    return normal


def _moved(at: At, steps: int, vector: Sequence[int]) -> At:
    return lambda q: at(q) + steps * np.array([q[i] for i in vector])


def _on_lines(u: Line, v: Line) -> tuple[At, At, At]:
    """The axes of a workplane through two lines."""

    def axes(q: Values) -> tuple[Vector, Vector, Vector]:
        first = u.along(q) / _size(u.along(q))
        n = np.cross(first, v.along(q))
        second = np.cross(n, first)
        second = second / _size(second)
        return first, second, np.cross(first, second)

    a, b, c = ((lambda q, k=k: axes(q)[k]) for k in range(3))
    return a, b, c


def _quaternion(axes: Sequence[Vector]) -> list[float]:
    """A quaternion with these axes."""
    turn = np.array(axes).T
    four = np.array(
        [
            [turn[0, 0] + turn[1, 1] + turn[2, 2], 0, 0, 0],
            [turn[2, 1] - turn[1, 2], turn[0, 0] - turn[1, 1] - turn[2, 2], 0, 0],
            [turn[0, 2] - turn[2, 0], turn[0, 1] + turn[1, 0], turn[1, 1] - turn[0, 0] - turn[2, 2], 0],
            [
                turn[1, 0] - turn[0, 1],
                turn[0, 2] + turn[2, 0],
                turn[1, 2] + turn[2, 1],
                turn[2, 2] - turn[0, 0] - turn[1, 1],
            ],
        ]
    )
    values, vectors = np.linalg.eigh(four + np.tril(four, -1).T)
    return [float(v) for v in vectors[:, np.argmax(values)]]


def random_space(seed: int) -> RandomSpace:
    """Lines and circles in space, in workplanes that are fixed, turn or lie on copies, and constraints."""
    rng = random.Random(f"space {seed}")
    s = RandomSpace()

    def place(count: int = 3) -> list[float]:
        return [float(rng.randrange(-2, 3)) for _ in range(count)]

    def lines(plane: Plane | None, count: int) -> None:
        for _ in range(count):
            a, b = (place(3 if plane is None else 2) for _ in range(2))
            if a != b:
                s.drawn_line(a, b, plane)

    origin = Point(0x10001, lambda q: np.zeros(3))
    tilted = rng.random() < 0.7
    if tilted:
        turn = rng.choice(TURNS)
        plane = s.group_plane(TILTED, origin, {"subtype": "6000"}, None, turn)
        s.group = TILTED
        s.drawn_line([0.0, 0.0], [2.0, 1.0], plane)
        lines(plane, rng.randrange(0, 3))
    s.group = 3
    lines(None, rng.randrange(0 if tilted else 1, 3))
    if rng.random() < 0.4:
        lines(s.free_plane(place(), rng.choice(TURNS)), rng.randrange(0, 3))
    if rng.random() < 0.3:
        s.circle(place(), float(rng.randrange(1, 3)), rng.choice(TURNS))
    if tilted and rng.random() < 0.5:
        s.extruded(plane, float(rng.randrange(1, 3)), rng.random() < 0.3)
        if rng.random() < 0.6:
            _sketch_on_copies(s, rng, lines)
    wanted = rng.randrange(1, 9)
    for _ in range(300):
        if s.constraints < wanted:
            rng.choice(KINDS)(s, rng)
    return s


def _sketch_on_copies(s: RandomSpace, rng: random.Random, lines: Callable[[Plane, int], None]) -> None:
    """A workplane on a copy of a line and another line, and lines in it."""
    own, others = [one for one in s.segments if one.handle & 0x80000000], s.segments
    u, v = rng.choice(own), rng.choice(others)
    if _size(np.cross(s.now(u.along), s.now(v.along))) < 1e-9:
        return
    how = {"subtype": "6001", "predef_entityB_v": f"{u.handle:08x}", "predef_entityC_v": f"{v.handle:08x}"}
    axes = _on_lines(u, v)
    fields = {**how, "predef_swapUV": "0", "predef_negateU": "0", "predef_negateV": "0"}
    turn = _quaternion([s.now(axis) for axis in axes])
    plane = s.group_plane(ON_LINES, u.ends[0], fields, axes, turn)
    s.group = ON_LINES
    lines(plane, rng.randrange(1, 3))


def _seen(s: RandomSpace, rng: random.Random, planes: Sequence[int], flat: bool = False) -> Plane | None:
    """The workplane in which a constraint is seen: that of all it mentions, another one, or none."""
    if len({*planes}) == 1 and planes[0]:
        return next(p for p in s.planes if p.handle == planes[0])
    fixed = [p for p in s.planes if p.handle >> 16 != 0x8000 + ON_LINES]
    return rng.choice(fixed) if flat or rng.random() < 0.3 else None


def _parts(plane: Plane | None, a: At) -> At:
    """A vector as it is seen."""
    if plane is None:
        return a
    u, v, _ = plane.axes
    return lambda q: np.array([u(q) @ a(q), v(q) @ a(q)])


def _from(a: Point, b: Point) -> At:
    return lambda q: b.at(q) - a.at(q)


def _in(plane: Plane | None) -> dict[str, int]:
    return {} if plane is None else {"workplane": plane.handle}


def _pair(s: RandomSpace, rng: random.Random) -> tuple[Point, Point]:
    one, other = rng.sample(s.places, 2)
    return one, other


def _two_lines(s: RandomSpace, rng: random.Random, normals: bool = False) -> list[Line]:
    every = [*s.segments, *(line for line, _ in s.normals if normals)]
    return rng.sample(every, 2) if len(every) > 1 else []


def coincident(s: RandomSpace, rng: random.Random) -> None:
    a, b = _pair(s, rng)
    plane = _seen(s, rng, [a.plane, b.plane])
    apart = _parts(plane, _from(a, b))
    s.add(20, lambda q: list(apart(q)), ptA=a.handle, ptB=b.handle, **_in(plane))


def distance(s: RandomSpace, rng: random.Random) -> None:
    a, b = _pair(s, rng)
    plane = _seen(s, rng, [a.plane, b.plane])
    apart = _parts(plane, _from(a, b))
    value = float(_size(s.now(apart)))
    if value > 1e-9:
        s.add(30, lambda q: [_size(apart(q)) - value], value, ptA=a.handle, ptB=b.handle, **_in(plane))


def plane_distance(s: RandomSpace, rng: random.Random) -> None:
    a, plane = rng.choice(s.places), rng.choice([*s.planes, *s.faces])
    if a.plane == plane.handle:
        return
    by_face = 2 if plane in s.faces else 0

    def away(q: Values) -> Any:
        return plane.axes[2](q) @ (a.at(q) - plane.origin(q))

    value = float(np.real(away([complex(v) for v in s.drawn])))
    if abs(value) > 1e-9:
        s.add(31 + by_face, lambda q: [away(q) - value], value, ptA=a.handle, entityA=plane.handle)
    else:
        s.add(41 + by_face, lambda q: [away(q)], ptA=a.handle, entityA=plane.handle)


def projected(s: RandomSpace, rng: random.Random) -> None:
    a, b = _pair(s, rng)
    line = rng.choice([*s.segments, *(one for one, _ in s.normals)])

    def along(q: Values) -> Any:
        return (b.at(q) - a.at(q)) @ line.along(q) / _size(line.along(q))

    value = float(np.real(along([complex(v) for v in s.drawn])))
    s.add(34, lambda q: [along(q) - value], value, ptA=a.handle, ptB=b.handle, entityA=line.handle)


def line_distance(s: RandomSpace, rng: random.Random) -> None:
    if not s.segments:
        return
    a, line = rng.choice(s.places), rng.choice(s.segments)
    if a in line.ends:
        return
    plane = _seen(s, rng, [a.plane, line.plane])
    along, to = _parts(plane, line.along), _parts(plane, _from(line.ends[0], a))

    def away(q: Values) -> Any:
        d, t = along(q), to(q)
        area = d[0] * t[1] - d[1] * t[0] if plane is not None else _size(np.cross(d, t))
        return area / _size(d)

    if _size(s.now(along)) < 1e-9:
        return
    d, t = s.now(along), s.now(to)
    value = float(max(d @ d * (t @ t) - (d @ t) ** 2, 0.0) ** 0.5 / _size(d))
    if value > 1e-9:
        signed = float(np.real(away([complex(v) for v in s.drawn])))
        s.add(32, lambda q: [away(q) - signed], value, ptA=a.handle, entityA=line.handle, **_in(plane))
    elif plane is not None:
        s.add(42, lambda q: [away(q)], ptA=a.handle, entityA=line.handle, **_in(plane))
    else:
        k = s.unknown(float(t @ d / (d @ d)))
        if not s.add(42, lambda q: list(to(q) - q[k] * along(q)), ptA=a.handle, entityA=line.handle):
            s.drawn.pop()


def between_lines(s: RandomSpace, rng: random.Random) -> None:
    found = _two_lines(s, rng)
    if not found:
        return
    one, other = found
    plane = _seen(s, rng, [one.plane, other.plane])
    a, b = _parts(plane, one.along), _parts(plane, other.along)
    sizes = [float(_size(s.now(x))) for x in (a, b)]
    told = {"entityA": one.handle, "entityB": other.handle, **_in(plane)}
    if min(sizes) < 1e-9:
        return
    pick = rng.randrange(3)
    if pick == 0:
        s.add(50, lambda q: [_size(a(q)) - _size(b(q))], **told)
    elif pick == 1:
        ratio = sizes[0] / sizes[1]
        s.add(51, lambda q: [_size(a(q)) / _size(b(q)) - ratio], ratio, **told)
    else:
        less = sizes[0] - sizes[1]
        s.add(56, lambda q: [_size(a(q)) - _size(b(q)) - less], less, **told)


def directions(s: RandomSpace, rng: random.Random) -> None:
    found = _two_lines(s, rng, normals=True)
    if not found:
        return
    one, other = found
    plane = _seen(s, rng, [one.plane, other.plane])
    a, b = _parts(plane, one.along), _parts(plane, other.along)
    told = {"entityA": one.handle, "entityB": other.handle, **_in(plane)}
    u, v = s.now(a), s.now(b)
    if min(_size(u), _size(v)) < 1e-9:
        return

    def cosine(q: Values) -> Any:
        return a(q) @ b(q) / (_size(a(q)) * _size(b(q)))

    value = float(u @ v / (_size(u) * _size(v)))
    if abs(value) < 1e-9:
        s.add(122, cosine_is(cosine, 0.0), **told)
    elif abs(value) < 0.999:
        s.add(120, cosine_is(cosine, value), math.degrees(math.acos(value)), **told)
    elif plane is not None:
        s.add(121, lambda q: [a(q)[0] * b(q)[1] - a(q)[1] * b(q)[0]], **told)
    else:
        k = s.unknown(float(u @ v / (v @ v)))
        if not s.add(121, lambda q: list(a(q) - q[k] * b(q)), **told):
            s.drawn.pop()


def cosine_is(cosine: Callable[[Values], Any], value: float) -> Callable[[Values], list[complex]]:
    return lambda q: [cosine(q) - value]


def midpoint(s: RandomSpace, rng: random.Random) -> None:
    if not s.segments:
        return
    line = rng.choice(s.segments)
    one, other = line.ends
    if rng.random() < 0.4:
        plane = rng.choice(s.planes)
        if plane.handle != line.plane:
            s.add(70, lambda q: [plane.axes[2](q) @ ((one.at(q) + other.at(q)) / 2 - plane.origin(q))],
                  entityA=line.handle, entityB=plane.handle)  # fmt: skip
        return
    for a in rng.sample(s.places, len(s.places)):
        plane_or_none = _seen(s, rng, [a.plane, line.plane])
        off = _parts(plane_or_none, lambda q, a=a: (one.at(q) + other.at(q)) / 2 - a.at(q))
        told = {"ptA": a.handle, "entityA": line.handle, **_in(plane_or_none)}
        if a not in line.ends and s.add(70, lambda q, off=off: list(off(q)), **told):
            return


def level(s: RandomSpace, rng: random.Random) -> None:
    k = rng.randrange(2)
    a, b = _pair(s, rng)
    plane = _seen(s, rng, [a.plane, b.plane], flat=True)
    apart = _parts(plane, _from(a, b))
    s.add((81, 80)[k], lambda q: [apart(q)[k]], ptA=a.handle, ptB=b.handle, **_in(plane))


def symmetric(s: RandomSpace, rng: random.Random) -> None:
    plane = rng.choice(s.planes)
    pairs = [(a, b) for a in s.places for b in s.places if a.handle < b.handle]
    for a, b in rng.sample(pairs, min(30, len(pairs))):
        u, v, _ = plane.axes
        common = a.plane if a.plane == b.plane else 0
        if common == plane.handle:
            continue
        if common:
            seen = next(p for p in s.planes if p.handle == common)
            told = {"ptA": a.handle, "ptB": b.handle, "entityA": plane.handle, "workplane": common}
            across = _across(plane, seen)
            if _size(s.now(across)) > 1e-9 and s.add(60, _mirror(plane, a, b, [across]), **told):
                return
        elif s.add(60, _mirror(plane, a, b, [u, v]), ptA=a.handle, ptB=b.handle, entityA=plane.handle):
            return


def _across(plane: Plane, seen: Plane) -> At:
    return lambda q: np.cross(plane.axes[2](q), seen.axes[2](q))


def _mirror(plane: Plane, a: Point, b: Point, across: Sequence[At]) -> Callable[[Values], list[complex]]:
    def residual(q: Values) -> list[complex]:
        middle = (a.at(q) + b.at(q)) / 2 - plane.origin(q)
        return [plane.axes[2](q) @ middle, *(axis(q) @ (a.at(q) - b.at(q)) for axis in across)]

    return residual


def same_orientation(s: RandomSpace, rng: random.Random) -> None:
    (one, first), (other, second) = rng.sample(s.normals, 2)
    a, b = ([s.now(axis) for axis in axes] for axes in (first, second))
    if abs(abs(a[2] @ b[2]) - 1) > 1e-9:
        return
    k = s.unknown(float(a[2] @ b[2]))
    which = 1 if abs(a[0] @ b[1]) < abs(a[0] @ b[0]) else 0
    if not s.add(110, lambda q: [*(first[2](q) - q[k] * second[2](q)), first[0](q) @ second[which](q)],
                 entityA=one.handle, entityB=other.handle):  # fmt: skip
        s.drawn.pop()


def rings(s: RandomSpace, rng: random.Random) -> None:
    if not s.rings:
        return
    ring, a = rng.choice(s.rings), rng.choice(s.places)
    if rng.random() < 0.5:
        value = 2 * s.drawn[ring.radius]
        s.add(90, lambda q: [2 * q[ring.radius] - value], value, entityA=ring.handle)
    elif a is not ring.centre:
        to = _parts(Plane(0, ring.centre.at, ring.axes), _from(ring.centre, a))
        s.add(100, lambda q: [to(q) @ to(q) - q[ring.radius] ** 2], ptA=a.handle, entityA=ring.handle)


def dragged(s: RandomSpace, rng: random.Random) -> None:
    a = rng.choice(s.places)
    plane = _seen(s, rng, [a.plane, a.plane])
    at = _parts(plane, a.at)
    start = s.now(at)
    s.add(200, lambda q: list(at(q) - start), ptA=a.handle, **_in(plane))


def equal_angle(s: RandomSpace, rng: random.Random) -> None:
    if len(s.segments) < 3:
        return
    four = [rng.choice(s.segments) for _ in range(4)]
    if four[0] is four[1] or four[2] is four[3]:
        return

    def residual(q: Values) -> list[complex]:
        a, b, c, d = (one.along(q) for one in four)
        return [a @ b / (_size(a) * _size(b)) - c @ d / (_size(c) * _size(d))]

    plane = _seen(s, rng, [one.plane for one in four])
    if plane is None or all(one.plane == plane.handle for one in four):
        told = {f"entity{k}": one.handle for k, one in zip("ABCD", four, strict=True)}
        s.add(54, residual, **told, **_in(plane))


KINDS = (
    coincident, coincident, distance, distance, plane_distance, projected, line_distance, line_distance, between_lines,
    directions, directions, midpoint, level, symmetric, same_orientation, rings, dragged, equal_angle,
)  # fmt: skip
