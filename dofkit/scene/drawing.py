"""The frames and points of a scene before any constraint is read; its size, its reference configuration."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from itertools import product as every_product
from math import dist
from operator import mul as times

from dofkit.base.errors import Fault
from dofkit.exact.matrices.sparse import components
from dofkit.expressions.enclosures import approximate, differs_from_zero
from dofkit.expressions.tree import ONE, ZERO, Expr, coordinate, num
from dofkit.expressions.vectors import Vec
from dofkit.scene.frames import Chart, Frame, Placed
from dofkit.scene.ledger import Texts
from dofkit.scene.names import Vocabulary
from dofkit.scene.parts import Declarations, Particle
from dofkit.system import GROUND

#: Up to this many points the distance of every pair is computed.
EVERY_PAIR = 1000


@dataclass(frozen=True)
class Drawing:
    """The particles and bodies of a scene, in its coordinates and in the reference configuration.

    ``configuration``: the given values of coordinates; ``points``: the given positions of particles; ``placed``: the
    bodies whose position is given (at least in part) in ``configuration``.
    """

    vocabulary: Vocabulary
    dimension: int
    tolerance: Fraction | None
    configuration: Mapping[str, Expr]
    particles: Mapping[str, Placed]
    ground: Frame
    frames: Mapping[str, Frame]
    points: tuple[Vec, ...]
    placed: frozenset[str]


def drawing_of(scene: Declarations, vocabulary: Vocabulary, mentioned: frozenset[str], faults: list[Fault]) -> Drawing:
    """Return the `Drawing` of a scene; a spatial body has Euler angles if one is ``mentioned``, else a Gibbs vector.

    The faults of the configuration and of the particles' positions are added to ``faults``.
    """
    texts = Texts(vocabulary.texts, ("configuration",), faults)
    coordinates = {q.name: q for q in vocabulary.table.coordinates}
    configuration: dict[str, Expr] = {}
    for name, value in scene.configuration.items():
        if name in coordinates:
            configuration[name] = texts.fixed(value, name)
        else:
            texts.unknown("coordinate", name, coordinates, name)
    origin = (ZERO,) * scene.dimension
    points: list[Vec] = []
    particles: dict[str, Placed] = {}
    for index, particle in enumerate(scene.particles):
        names, place = vocabulary.table.particles[particle.name], None
        if particle.at is not None or configuration:
            texts.here = ("particles", index)
            place = _place(texts, particle, names, configuration)
            points += [] if place is None else [place]
        particles[particle.name] = Placed(tuple([coordinate(n) for n in names]), ONE, place, None, particle.name)
    return Drawing(
        vocabulary=vocabulary,
        dimension=scene.dimension,
        tolerance=scene.tolerance,
        configuration=configuration,
        particles=particles,
        ground=Frame(GROUND, origin, origin),
        frames=_frames(scene.dimension, vocabulary, configuration, mentioned),
        points=tuple(points),
        placed=frozenset(b for b, names in vocabulary.table.bodies.items() if any(n in configuration for n in names)),
    )


def _place(texts: Texts, particle: Particle, names: tuple[str, ...], configuration: Mapping[str, Expr]) -> Vec | None:
    """Return the reference position of a particle, None if it is not given. Two different positions are a fault."""
    place = None if particle.at is None else texts.vector(particle.at, len(names), "at")
    configured = [name for name in names if name in configuration]
    if place is not None and configured:
        for name, part in zip(names, place, strict=True):
            if name in configuration and differs_from_zero(configuration[name] - part):
                message = f"'{particle.name}' is given two positions: `at`, and {name} in `configuration`"
                texts.fault(message, "at", hint="leave one of them out")
    if place is None and len(configured) == len(names):
        place = tuple(configuration[name] for name in names)
    return place


def _frames(
    d: int, vocabulary: Vocabulary, configuration: Mapping[str, Expr], mentioned: frozenset[str]
) -> dict[str, Frame]:
    """Return {body: frame}, with the coordinates and the reference values of position and angles."""
    frames: dict[str, Frame] = {}
    for body, names in vocabulary.table.bodies.items():
        values = [configuration.get(name, ZERO) for name in names]
        chart: Chart = "line" if d == 1 else "plane"
        if d == 3:
            chart = "gibbs" if mentioned.isdisjoint(names[3:]) else "euler"
        position = tuple(coordinate(name) for name in names[:d])
        frames[body] = Frame(body, position, tuple(values[:d]), chart, names[d:], tuple(values[d:]))
    return frames


def size_of(points: Sequence[Vec]) -> float:
    """Return the largest distance between points whose positions are numbers; 1.0 if it is 0 or there are none."""
    return _diameter(sorted({numbers for numbers in map(_numbers, points) if numbers is not None})) or 1.0


def centre_of(points: Sequence[Vec]) -> Vec | None:
    """Return the centre of the bounding box of the points whose positions are numbers; None if there are none."""
    numbers = [place for place in map(_numbers, points) if place is not None]
    return tuple(num(Fraction((min(xs) + max(xs)) / 2)) for xs in zip(*numbers, strict=True)) or None


def _numbers(point: Vec) -> tuple[float, ...] | None:
    numbers = [approximate(part) for part in point]
    return tuple(part for part in numbers if part is not None) if None not in numbers else None


def _diameter(points: list[tuple[float, ...]]) -> float:
    """Return the largest distance of two points; with more than `EVERY_PAIR` points, between extreme points only."""
    few = points if len(points) <= EVERY_PAIR else _extremes(points)
    return max((dist(p, q) for p, q in combinations(few, 2)), default=0.0)


def _extremes(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """Return the points that are extreme along axes and diagonals: their distances give the size of the scene."""
    extremes = set()
    for direction in every_product((-1, 0, 1), repeat=len(points[0])):
        if direction > (0,) * len(direction):
            reach = [sum(map(times, point, direction)) for point in points]
            extremes |= {points[reach.index(max(reach))], points[reach.index(min(reach))]}
    return list(extremes)


def placed_bodies(placed: Iterable[str], welds: Iterable[Sequence[str]]) -> frozenset[str]:
    """Return the bodies that are ``placed``, and those that pairs of ``welds`` connect to them or to the ground."""
    groups = [{GROUND, *placed}, *map(set, welds)]
    return frozenset[str]().union(*(groups[i] for i in components(groups)[0])) - {GROUND}


def pose_of(drawing: Drawing) -> dict[Expr, Expr]:
    """Return {coordinate: value} at which the joints close: the bodies' reference and all given values."""
    pose: dict[Expr, Expr] = {}
    for particle in drawing.particles.values():
        if particle.reference is not None:
            pose.update(zip(particle.over, particle.reference, strict=True))
    for frame in drawing.frames.values():
        pose.update(zip(frame.position, frame.start, strict=True))
        turned = frame.initial if frame.chart != "gibbs" else (ZERO,) * len(frame.angles)
        pose.update(zip(map(coordinate, frame.angles), turned, strict=True))
    for name, value in drawing.configuration.items():
        pose.setdefault(coordinate(name), value)
    return pose


def reference_of(
    drawing: Drawing, placed: Set[str], pose: Mapping[Expr, Expr], touched: Callable[[], Set[str]]
) -> dict[Expr, Expr] | None:
    """Return ``pose``, with 0 elsewhere, if it places all coordinates that constraints mention, else None.

    ``placed``: the bodies that it places; ``touched`` returns the mentioned coordinates (if empty, all count), and is
    called only if something is not placed, because it takes time.
    """
    names = [q.name for q in drawing.vocabulary.table.coordinates]
    every = frozenset(names)
    if unplaced(drawing, placed, pose, every) and unplaced(drawing, placed, pose, touched() or every):
        return None
    return {s: pose.get(s, ZERO) for s in map(coordinate, names)}


def unplaced(drawing: Drawing, placed: Set[str], pose: Mapping[Expr, Expr], touched: Set[str]) -> tuple[str, ...]:
    """Return the bodies, particles and coordinates in ``touched`` that are not in ``placed`` or ``pose``."""
    table, posed = drawing.vocabulary.table, frozenset(str(s.args[1]) for s in pose)
    bodies = [b for b, names in table.bodies.items() if b not in placed and not touched.isdisjoint(names)]
    others = (q for q in table.coordinates if q.name in touched and q.name not in posed)
    return tuple(dict.fromkeys([*bodies, *(q.owner or q.name for q in others)]))
