"""The shapes of a scene's `picture`: their looks, and their poses at given values of the coordinates.

Each shape has carriers of its own: a disc, ball or box one frame, a rod one for each end.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import product
from typing import NamedTuple

import numpy as np

from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import ZERO, Expr, coordinate, fn, num
from dofkit.expressions.vectors import Vec
from dofkit.motion.poses import about
from dofkit.pictures.evaluation import Values, evaluated
from dofkit.pictures.shapes import SQUARE, Array, Displacement, Kind, Role, Shape, Vertex, circle, fixed, place
from dofkit.scene.picture import PlacedPicture, PlacedShape
from dofkit.system import GROUND, System

#: Points of a curve at rest and of a moving one, lines of a surface in each direction and their points, corners of a
#: disc, strokes of the ground.
CURVE, MOVING_CURVE, MESH, MESH_POINTS, RIM, STROKES = 61, 11, 9, 25, 40, 12
#: {shape that is one line or dot: (kind, role, size in symbols if no radius is given)}.
_LINES: Mapping[str, tuple[Kind, Role, float]] = {
    "rod": ("line", "bar", 0.0), "string": ("line", "rope", 0.0), "spring": ("coil", "force", 0.8),
    "arrow": ("arrow", "arrow", 0.8), "point": ("ball", "point", 0.42), "curve": ("curve", "guide", 0.0),
}  # fmt: skip
#: Default lengths of the ground, of axes and of a blade.
SIDE, AXIS, BLADE = 4.0, 1.0, 0.8
#: The rim of a blade, seen from above in the plane and from the side in space, for half its length.
BLADES = {
    2: [(-1, 0, 0), (-0.5, -0.2, 0), (0.5, -0.2, 0), (1, 0, 0), (0.5, 0.2, 0), (-0.5, 0.2, 0)],
    3: [(-1, 0, 0.5), (-0.7, 0, 0), (0.7, 0, 0), (1, 0, 0.5)],
}


class ShapePlacement(NamedTuple):
    """The pose of a carrier as expressions: its place, its axis (in space) or heading, and its rotation about that.

    ``start`` is the point of the carrier that is at the place.
    """

    at: Vec
    axis: Vec | None = None
    heading: Expr | None = None
    turn: Expr | None = None
    #: Whether a heading is that of a wheel that stands upright in space.
    upright: bool = False
    start: Vec = ()

    def depends_on(self, *kinds: str) -> bool:
        """Return whether symbols of one of these kinds occur in the placement."""
        exprs = [*self.at, *(self.axis or ()), *(e for e in (self.heading, self.turn) if e is not None)]
        return any(s.args[0] in kinds for e in exprs for s in e.symbols)

    @property
    def moves(self) -> bool:
        """Whether the placement depends on coordinates or time."""
        return self.depends_on("coordinate", "time")

    def pose(self, values: Values) -> Displacement:
        """Return the displacement of the carrier's frame, in which the axis is z and the mark of a disc on y."""

        def number(e: Expr | None) -> float:
            return 0.0 if e is None else float(evaluated(e, values))

        shift = np.array(place(number(e) for e in self.at))
        heading, turn = number(self.heading), number(self.turn)
        if self.axis is not None and len(self.axis) == 3:
            across = np.array([number(e) for e in self.axis])
        elif self.upright and self.heading is not None:
            across = np.array([-math.sin(heading), math.cos(heading), 0.0])
        else:
            rotation = about(2, heading + turn)
            return Displacement(rotation, shift - rotation @ np.array(place(number(e) for e in self.start)))
        return Displacement(_frame(across) @ about(2, turn), shift)

    def planar(self) -> tuple[Expr, ...]:
        """Return the (x, y) shift from ``start`` to ``at``, and if it rotates (cosine, sine) of heading + turn."""
        (x, y), (a, b) = ((*at, ZERO, ZERO)[:2] for at in (self.at, self.start))
        angles = [e for e in (self.heading, self.turn) if e is not None]
        if not angles:
            return x - a, y - b
        c, s = fn("cos", sum(angles, ZERO)), fn("sin", sum(angles, ZERO))
        return x - c * a + s * b, y - s * a - c * b, c, s


def carrier_placements(system: System) -> dict[str, ShapePlacement]:
    """Return {name: placement} of particles, and of the bodies of a line or plane; bodies turn from the reference."""
    placements: dict[str, ShapePlacement] = {}
    flat = system.bodies if system.dimension < 3 else ()
    for carrier in (*flat, *system.particles):
        symbols = tuple(coordinate(c.name) for c in system.coordinates if c.owner == carrier)
        angles = [q - system.pose.get(q, ZERO) for q in symbols[system.dimension :]]
        at, start = symbols[: system.dimension], system.starts.get(carrier, ())
        placements[carrier] = ShapePlacement(at, turn=angles[0] if angles else None, start=start)
    return placements


def _frame(across: Array) -> Array:
    """Return a rotation that takes z to the direction ``across``, and y as far upwards as possible."""
    size = float(np.linalg.norm(across))
    normal = across / size if size > 1e-12 else np.array([0.0, 0.0, 1.0])
    up = np.array([0.0, 0.0, 1.0]) - normal[2] * normal
    up = up / np.linalg.norm(up) if np.linalg.norm(up) > 1e-6 else np.array([0.0, 1.0, 0.0])
    return np.column_stack([np.cross(up, normal), up, normal])


def placements_of(picture: PlacedPicture) -> Mapping[str, ShapePlacement]:
    """Return {carrier: placement} of all shapes in a picture."""
    placements: dict[str, ShapePlacement] = {}
    for k, shape in enumerate(picture.shapes):
        for j, at in enumerate(_sampled(shape)):
            upright = picture.dimension == 3 and shape.kind in ("disc", "wheel")
            placements[_carrier(k, j)] = ShapePlacement(at, shape.axis, shape.heading, shape.turn, upright)
    return placements


def _carrier(shape: int, number: int) -> str:
    return f"shape {shape}.{number}"


def _sampled(shape: PlacedShape) -> Iterator[Vec]:
    """Yield the places of a shape; for a curve or a surface, points along it."""
    if not shape.range:
        yield from shape.places
        return
    ends = [e for _, low, high in shape.range for e in (low, high)]
    moves = ShapePlacement((*shape.places[0], *ends)).moves
    straight = all(diff(diff(e, s), s) == ZERO for e in shape.places[0] for s, _, _ in shape.range)
    for fractions in _grid(len(shape.range), 2 if straight else MOVING_CURVE if moves else CURVE):
        ranges = zip(shape.range, fractions, strict=True)
        values = {s: low + num(part) * (high - low) for (s, low, high), part in ranges}
        yield tuple(substitute(e, values) for e in shape.places[0])


def _grid(count: int, points: int) -> Iterator[tuple[Fraction, ...]]:
    """Yield the positions, from 0 to 1 in each parameter, of the points of a curve or of the lines of a surface."""
    if count == 1:
        yield from ((part,) for part in _fractions(points))
        return
    for line, along in product(_fractions(MESH), _fractions(MESH_POINTS)):
        yield line, along
    for line, along in product(_fractions(MESH), _fractions(MESH_POINTS)):
        yield along, line


def _fractions(count: int) -> list[Fraction]:
    return [Fraction(k, count - 1) for k in range(count)]


def picture_shapes(picture: PlacedPicture, values: Values, unit: float) -> Iterator[Shape]:
    """Yield the shapes of a picture; ``unit``: the size of symbols."""
    placements = placements_of(picture)
    for k, shape in enumerate(picture.shapes):
        drawn = list(_DrawnShape(k, shape, picture.dimension, placements, values, unit).shapes())
        yield from drawn
        if shape.name and shape.kind not in ("text", "axes") and drawn:
            ends = drawn[0].vertices
            positions = ends[len(ends) // 2 :][:1] if shape.kind == "curve" and len(ends) > 2 else ends
            yield Shape("words", positions, "name", owner=shape.name, text=shape.name)


class _DrawnShape(NamedTuple):
    """One shape of a picture, with the data to draw it."""

    number: int
    shape: PlacedShape
    dimension: int
    placements: Mapping[str, ShapePlacement]
    values: Values
    unit: float

    def shapes(self) -> Iterator[Shape]:
        """Yield the basic shapes that draw it."""
        shape = self.shape
        if shape.kind in _LINES:
            kind, role, size = _LINES[shape.kind]
            yield self._shape_of(kind, self._places(), role, self._value(shape.radius, size * self.unit))
        elif shape.kind == "surface":
            places = self._places()
            for start in range(0, len(places), MESH_POINTS):
                yield self._shape_of("line", places[start : start + MESH_POINTS], "mesh")
        elif shape.kind == "text":
            yield Shape("words", self._places(), "name", owner=shape.name, text=shape.name)
        elif shape.kind == "ball":
            yield self._shape_of("ball", self._in_frame([(0, 0, 0)]), "body", self._value(shape.radius, 1.0))
        elif shape.kind in ("disc", "wheel"):
            yield from self._round(self._value(shape.radius, 1.0))
        elif shape.kind == "axes":
            yield from self._axes()
        elif shape.kind == "plane":
            yield from self._ground(self._sizes(1, SIDE)[0] / 2)
        elif shape.kind == "box":
            yield from self._box()
        else:
            yield from self._blade(self._sizes(1, BLADE)[0] / 2)

    def _shape_of(self, kind: Kind, vertices: tuple[Vertex, ...], role: Role, size: float = 0.0) -> Shape:
        moves = any(v.carrier != GROUND for v in vertices)
        return Shape(kind, vertices, role, "moving" if moves else "plain", self.shape.name, size)

    def _value(self, e: Expr | None, default: float) -> float:
        return default if e is None else float(evaluated(e, self.values))

    def _sizes(self, count: int, default: float) -> list[float]:
        sizes = [self._value(e, default) for e in self.shape.size] or [default]
        return [*sizes, *[sizes[-1]] * count][:count]

    def _places(self) -> tuple[Vertex, ...]:
        carriers = (_carrier(self.number, j) for j in range(len(self.placements)))
        return tuple(self._vertex(c, (0, 0, 0)) for c in carriers if c in self.placements)

    def _in_frame(self, points: Iterable[Iterable[float]]) -> tuple[Vertex, ...]:
        carrier = _carrier(self.number, 0)
        return tuple(self._vertex(carrier, p) for p in points)

    def _vertex(self, carrier: str, at: Iterable[float]) -> Vertex:
        """Return a vertex of a carrier, or a fixed vertex if the carrier never moves."""
        placement = self.placements[carrier]
        if placement.moves:
            return Vertex(carrier, place(at))
        return fixed(placement.pose(self.values).moved(place(at)))[0]

    def _round(self, radius: float) -> Iterator[Shape]:
        yield self._shape_of("area", self._in_frame(radius * circle(RIM)), "body")
        if self.shape.kind == "disc":
            yield self._shape_of("line", self._in_frame([(0, 0, 0), (0, radius, 0)]), "guide")
            yield self._shape_of("ball", self._in_frame([(0, 0.86 * radius, 0)]), "point", 0.09 * radius)
            return
        for spoke in radius * circle(6)[:3]:
            yield self._shape_of("line", self._in_frame([spoke, -spoke]), "guide")
        yield self._shape_of("ball", self._in_frame([(0, 0, 0)]), "joint", 0.14 * radius)

    def _axes(self) -> Iterator[Shape]:
        origin = self._in_frame([(0, 0, 0)]) if self.shape.places else fixed((0.0, 0.0, 0.0))
        for direction, letter in zip(self._sizes(1, AXIS)[0] * np.eye(3)[: self.dimension], "xyz", strict=False):
            tip = self._in_frame([direction]) if self.shape.places else fixed(direction)
            yield self._shape_of("arrow", (*origin, *tip), "axis", self.unit)
            yield Shape("words", tip, "name", text=letter)

    def _ground(self, half: float) -> Iterator[Shape]:
        """Yield the ground: a plane, or in the plane a line with strokes on the side opposite to its axis."""
        if self.dimension == 3:
            yield self._shape_of("area", self._in_frame([(half * x, half * y, 0) for x, y in SQUARE]), "plane")
            return
        up = np.array(place(self._value(e, 0.0) for e in self.shape.axis or ())) if self.shape.axis else np.eye(3)[1]
        up = up / max(float(np.linalg.norm(up)), 1e-12)
        along = half * np.array([up[1], -up[0], 0.0])
        yield self._shape_of("line", self._in_frame([-along, along]), "ground")
        yield self._shape_of("line", self._in_frame(hatching(self.unit, np.zeros(3), along, -up, STROKES)), "hatch")

    def _box(self) -> Iterator[Shape]:
        half = np.array(self._sizes(3, 1.0)) / 2
        for face in [[(x, y, 0) for x, y in SQUARE]] if self.dimension == 2 else faces(np.ones(3)):
            yield self._shape_of("area", self._in_frame([half * corner for corner in np.array(face)]), "body")

    def _blade(self, half: float) -> Iterator[Shape]:
        yield self._shape_of("area", self._in_frame(half * np.array(BLADES[self.dimension])), "body")


def hatching(unit: float, middle: Array, half: Array, side: Array, ticks: int) -> list[Array]:
    """Return short strokes along a line, on one side of it, as one zigzag; ``unit``: the size of symbols."""
    direction = half / max(float(np.linalg.norm(half)), 1e-12)
    slant = (side - direction) * max(0.55 * unit, 0.07 * float(np.linalg.norm(half)))
    roots = [middle + half * (2 * (k + 0.7) / ticks - 1) for k in range(ticks)]
    return [point for root in roots for point in (root, root + slant, root)]


def faces(half: Array) -> list[list[Array]]:
    """Return the faces of a box about the origin."""
    return [
        [np.insert(np.array(corner), axis, side) * half for corner in SQUARE]
        for axis in range(3)
        for side in (-1.0, 1.0)
    ]
