"""The drawing of a scene: frames and positions before any constraint is read, its size, its reference configuration.

Vectors are exact and cleared of denominators. A spatial body in the Gibbs chart turns by R = N / w with
N = (1 - g.g) I + 2 g g^T + 2 g~ and w = 1 + g.g, the factor that never vanishes; points are kept as numerator over w,
so that relations between them are polynomial. For every other frame w is 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from itertools import product as every_product
from math import dist
from operator import mul as times
from typing import Literal, NamedTuple

from dofkit.base.errors import Fault
from dofkit.expressions.enclosures import approximate, differs_from_zero
from dofkit.expressions.tree import MINUS_ONE, ONE, TWO, ZERO, Expr, add, coordinate, fn, mul, num, velocity
from dofkit.expressions.vectors import (
    Matrix,
    Vec,
    apply,
    cross,
    difference,
    dot,
    is_zero,
    minus,
    plus,
    product,
    scaled,
    square,
    transposed,
    unit,
)
from dofkit.scene.ledger import Texts
from dofkit.scene.names import Vocabulary
from dofkit.scene.parts import Declarations, Particle
from dofkit.system import GROUND

Chart = Literal["fixed", "line", "plane", "gibbs", "euler"]


def turn(angle: Expr) -> Matrix:
    """Return the rotation of the plane by ``angle``."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((c, mul(MINUS_ONE, s)), (s, c))


def turn_z(angle: Expr) -> Matrix:
    """Return the rotation by ``angle`` about the z axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((c, mul(MINUS_ONE, s), ZERO), (s, c, ZERO), (ZERO, ZERO, ONE))


def turn_x(angle: Expr) -> Matrix:
    """Return the rotation by ``angle`` about the x axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((ONE, ZERO, ZERO), (ZERO, c, mul(MINUS_ONE, s)), (ZERO, s, c))


def euler(phi: Expr, theta: Expr, psi: Expr) -> Matrix:
    """Return the rotation Rz(phi) Rx(theta) Rz(psi)."""
    return product(turn_z(phi), product(turn_x(theta), turn_z(psi)))


def gibbs_numerator(g: Vec) -> Matrix:
    """N = (1 - g.g) I + 2 g g^T + 2 g~, so that R = N / (1 + g.g)."""
    x, y, z = g
    diagonal = difference(ONE, square(g))
    twice = [mul(TWO, part) for part in g]
    return (
        (add(diagonal, mul(twice[0], x)), difference(mul(twice[0], y), twice[2]), add(mul(twice[0], z), twice[1])),
        (add(mul(twice[0], y), twice[2]), add(diagonal, mul(twice[1], y)), difference(mul(twice[1], z), twice[0])),
        (difference(mul(twice[0], z), twice[1]), add(mul(twice[1], z), twice[0]), add(diagonal, mul(twice[2], z))),
    )


class Placed(NamedTuple):
    """A point X = over / under; ``reference`` is where it stands in the reference configuration, if known.

    ``frame`` names the body that carries it (``ground`` too), None for a particle; ``label`` tells
    points apart.
    """

    over: Vec
    under: Expr
    reference: Vec | None
    frame: str | None
    label: str


@dataclass(frozen=True, eq=False)
class Frame:
    """A body's pose, or the ground's: a material point at ``a`` in the reference is X = p + R (a - start).

    ``position`` is p, ``start`` its reference value, ``angles`` the names of the angle coordinates
    and ``initial`` their reference values. ``chart`` is ``fixed`` for the ground, ``line`` in one
    dimension, ``plane``, ``gibbs`` or ``euler``.
    """

    name: str
    position: Vec
    start: Vec
    chart: Chart
    angles: tuple[str, ...] = ()
    initial: Vec = ()

    @property
    def dimension(self) -> int:
        """d."""
        return len(self.position)

    @property
    def fixed(self) -> bool:
        """True for the ground."""
        return self.chart == "fixed"

    @cached_property
    def gibbs(self) -> Vec | None:
        """The Gibbs vector of the rotation from the reference, where the chart has one."""
        if self.fixed:
            return (ZERO, ZERO, ZERO)
        return tuple(coordinate(name) for name in self.angles) if self.chart == "gibbs" else None

    @cached_property
    def angle(self) -> Expr:
        """In the plane, the angle from the reference."""
        return difference(coordinate(self.angles[0]), self.initial[0]) if self.angles else ZERO

    @cached_property
    def under(self) -> Expr:
        """The factor w by which rotated vectors are multiplied."""
        return add(ONE, square(self.gibbs)) if self.chart == "gibbs" and self.gibbs else ONE

    @cached_property
    def turn(self) -> Matrix | None:
        """w R; None for the identity."""
        if self.chart == "plane":
            return turn(self.angle)
        if self.chart == "gibbs" and self.gibbs:
            return gibbs_numerator(self.gibbs)
        if self.chart == "euler":
            now = euler(*(coordinate(name) for name in self.angles))
            return now if is_zero(self.initial) else product(now, transposed(euler(*self.initial)))
        return None

    def carry(self, a: Vec) -> Vec:
        """w R a: where a direction of the reference points now, times w."""
        return a if self.turn is None else apply(self.turn, a)

    def point(self, a: Vec, label: str = "") -> Placed:
        """Return the material point that stands at ``a`` in the reference configuration."""
        if self.fixed:
            return Placed(a, ONE, a, self.name, label)
        arm = minus(a, self.start)
        if is_zero(arm):
            return Placed(self.position, ONE, a, self.name, label)
        return Placed(plus(scaled(self.under, self.position), self.carry(arm)), self.under, a, self.name, label)

    def spin(self) -> tuple[Vec, Expr]:
        """Return the angular velocity in world axes as numerator and denominator, velocities as symbols.

        Gibbs: 2 (gdot + g x gdot) / (1 + g.g). Euler: phidot e_z + thetadot (cos phi, sin phi, 0)
        + psidot (sin phi sin theta, -cos phi sin theta, cos theta).
        """
        rates = tuple(velocity(name) for name in self.angles)
        if self.gibbs is not None:
            return scaled(TWO, plus(rates, cross(self.gibbs, rates))), self.under
        phi, theta = (coordinate(name) for name in self.angles[:2])
        line = (fn("cos", phi), fn("sin", phi), ZERO)
        tilt = fn("sin", theta)
        axle = (mul(fn("sin", phi), tilt), mul(MINUS_ONE, fn("cos", phi), tilt), fn("cos", theta))
        return plus(scaled(rates[0], unit(2, 3)), scaled(rates[1], line), scaled(rates[2], axle)), ONE


def relative(first: Frame, second: Frame) -> tuple[Expr, Vec] | None:
    """Return the rotation R1^T R2 as a quaternion (scalar, vector), up to a positive factor; None outside Gibbs charts.

    (1, -g1)(1, g2) = (1 + g1.g2, g2 - g1 - g1 x g2).
    """
    if first.gibbs is None or second.gibbs is None:
        return None
    g, h = first.gibbs, second.gibbs
    return add(ONE, dot(g, h)), minus(minus(h, g), cross(g, h))


def between(first: Placed, second: Placed) -> tuple[Vec, Expr]:
    """second - first as numerator and denominator."""
    if first.under == second.under:
        return minus(second.over, first.over), first.under
    first_over, second_over = scaled(second.under, first.over), scaled(first.under, second.over)
    return minus(second_over, first_over), mul(first.under, second.under)


# The drawing

#: Up to this many points the distance of every pair is measured.
EVERY_PAIR = 1000


@dataclass(frozen=True)
class Drawing:
    """The particles and bodies of a scene in its coordinates, and their positions in the reference configuration.

    ``configuration``: the values given of coordinates; ``points``: positions given as numbers or texts; ``drawn``: the
    bodies that the configuration places.
    """

    vocabulary: Vocabulary
    dimension: int
    tolerance: Fraction | None
    configuration: Mapping[str, Expr]
    particles: Mapping[str, Placed]
    ground: Frame
    frames: Mapping[str, Frame]
    points: tuple[Vec, ...]
    drawn: frozenset[str]


def drawing_of(scene: Declarations, vocabulary: Vocabulary, mentioned: frozenset[str], faults: list[Fault]) -> Drawing:
    """Return the drawing of a scene; a spatial body of whose angles one is ``mentioned`` keeps its Euler angles.

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
    points: list[Vec] = []
    particles: dict[str, Placed] = {}
    for index, particle in enumerate(scene.particles):
        names, place = vocabulary.table.particles[particle.name], None
        if particle.at is not None or configuration:
            texts.here = ("particles", index)
            place = _place(texts, particle, names, configuration)
            points += [] if place is None else [place]
        particles[particle.name] = Placed(tuple([coordinate(n) for n in names]), ONE, place, None, particle.name)
    origin = (ZERO,) * scene.dimension
    return Drawing(
        vocabulary=vocabulary,
        dimension=scene.dimension,
        tolerance=scene.tolerance,
        configuration=configuration,
        particles=particles,
        ground=Frame(GROUND, origin, origin, "fixed"),
        frames=_frames(scene.dimension, vocabulary, configuration, mentioned),
        points=tuple(points),
        drawn=frozenset(b for b, names in vocabulary.table.bodies.items() if any(n in configuration for n in names)),
    )


def _place(texts: Texts, particle: Particle, names: tuple[str, ...], configuration: Mapping[str, Expr]) -> Vec | None:
    """Return the reference position of a particle."""
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
    """Return the largest distance between points whose positions are numbers; 1 if there are none."""
    return _diameter(sorted({numbers for numbers in map(_numbers, points) if numbers is not None})) or 1.0


def centre_of(points: Sequence[Vec]) -> Vec | None:
    """Return the middle of the points whose positions are numbers, rounded to binary; None if there are none."""
    numbers = [place for place in map(_numbers, points) if place is not None]
    return tuple(num(Fraction((min(xs) + max(xs)) / 2)) for xs in zip(*numbers, strict=True)) or None


def _numbers(point: Vec) -> tuple[float, ...] | None:
    numbers = [approximate(part) for part in point]
    return tuple(part for part in numbers if part is not None) if None not in numbers else None


def _diameter(points: list[tuple[float, ...]]) -> float:
    """Return the largest distance of two points; of many points, of those that reach furthest in some directions."""
    few = points if len(points) <= EVERY_PAIR else _extremes(points)
    return max((dist(p, q) for p, q in combinations(few, 2)), default=0.0)


def _extremes(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """Return the points that reach furthest in one of a few dozen directions."""
    extremes = set()
    for direction in every_product((-1, 0, 1), repeat=len(points[0])):
        if direction > (0,) * len(direction):
            reach = [sum(map(times, point, direction)) for point in points]
            extremes |= {points[reach.index(max(reach))], points[reach.index(min(reach))]}
    return list(extremes)


def drawn_bodies(placed: Iterable[str], welds: Iterable[Sequence[str]]) -> frozenset[str]:
    """Return the bodies that are ``placed``, and those welded to the ground or to one that is placed."""
    drawn = set(placed) - {GROUND}
    welded: dict[str, list[str]] = {}
    for first, second in welds:
        if GROUND in (first, second):
            drawn |= {first, second} - {GROUND}
        else:
            welded.setdefault(first, []).append(second)
            welded.setdefault(second, []).append(first)
    stack = list(drawn)
    while stack:
        for other in welded.get(stack.pop(), ()):
            if other not in drawn:
                drawn.add(other)
                stack.append(other)
    return frozenset(drawn)


def pose_of(drawing: Drawing) -> dict[Expr, Expr]:
    """Return values at which the joints close: bodies at their reference, particles and coordinates where given."""
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
    drawing: Drawing, drawn: Set[str], pose: Mapping[Expr, Expr], touched: Callable[[], Set[str]]
) -> dict[Expr, Expr] | None:
    """Return the pose if it has a value for every coordinate that a constraint has ``touched`` (for all if none has).

    Its bodies are ``drawn``. What nothing constrains may be anywhere; what is touched is asked for only where something
    is not drawn.
    """
    names = [q.name for q in drawing.vocabulary.table.coordinates]
    every = frozenset(names)
    if undrawn(drawing, drawn, pose, every) and undrawn(drawing, drawn, pose, touched() or every):
        return None
    return {s: pose.get(s, ZERO) for s in map(coordinate, names)}


def undrawn(drawing: Drawing, drawn: Set[str], pose: Mapping[Expr, Expr], touched: Set[str]) -> tuple[str, ...]:
    """Return the bodies, particles and coordinates that a constraint has ``touched`` and that are not drawn."""
    table, posed = drawing.vocabulary.table, frozenset(str(s.args[1]) for s in pose)
    bodies = [b for b, names in table.bodies.items() if b not in drawn and not touched.isdisjoint(names)]
    others = (q for q in table.coordinates if q.name in touched and q.name not in posed)
    return tuple(dict.fromkeys([*bodies, *(q.owner or q.name for q in others)]))
