"""The world that constraints are written in: the frames, points and directions of a scene.

A constraint type asks `World` for what it mentions (``world.frame("crank", "between", 0)``); what
cannot be found is recorded as a fault at that path and replaced by a stand-in, so that all faults
come to light at once. Geometry that is left out is asked for here too and becomes a generic parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from typing import NamedTuple

from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate, differs_from_zero
from dofkit.expressions.tree import ONE, TIME, ZERO, Expr, coordinate, parameter
from dofkit.expressions.vectors import Vec, across
from dofkit.scene.fields import Vector
from dofkit.scene.frames import Chart, Frame, Placed
from dofkit.scene.ledger import Texts
from dofkit.scene.names import Declared, coordinate_table, declared_names, read_parameters
from dofkit.scene.parts import BodyPoint, Particle, show_point
from dofkit.system import GROUND, Distance, DrawnPoint, Place


class Direction(NamedTuple):
    """A direction in the reference, and d - 1 independent vectors across it."""

    vector: Vec
    across: tuple[Vec, ...]


@dataclass
class Joined:
    """What one constraint asks for, in order."""

    members: list[str] = field(default_factory=list)
    points: list[DrawnPoint] = field(default_factory=list)
    places: list[Vec | None] = field(default_factory=list)
    directions: list[Vec | None] = field(default_factory=list)
    number: Expr | None = None


class World(Texts):
    """A scene's names resolved.

    Collects, besides faults and warnings: ``generic`` parameters, the given ``points``, the bodies
    that are ``drawn``, ``welds``, ``links`` and ``distances``, and checks to make ``later``, once the size of the
    drawing is known. ``special`` tells that symbolic lengths meet a drawing with numbers.
    that are ``drawn``, ``welds`` and ``links``, what the constraint being read has ``asked`` for, and checks
    to make ``later``, once the size of the drawing is known. ``special`` tells that symbolic lengths meet a
    drawing with numbers.
    """

    def __init__(self, scene: Declared) -> None:
        super().__init__()
        self.dimension = scene.dimension
        self.tolerance = scene.tolerance
        self.generic: list[str] = []
        self.points: list[Vec] = []
        self.drawn: set[str] = set()
        self.welds: list[tuple[str, str]] = []
        self.links: list[tuple[int, str, str]] = []
        self.distances: dict[int, list[Distance]] = {}
        self.later: list[tuple[tuple[str | int, ...], Callable[[float], None]]] = []
        self.special = False
        self.asked = Joined()
        self.table = coordinate_table(scene)
        self.parameters, self.signs = read_parameters(scene, self)
        self.names = declared_names(scene, self.table, self.parameters)
        self.forget()
        self.configuration = self._configuration(scene.configuration)
        origin = (ZERO,) * self.dimension
        self.ground = Frame(GROUND, origin, origin, "fixed")
        self.frames: dict[str, Frame] = {}
        self.standing = {p.name: self._stands(i, p) for i, p in enumerate(scene.particles)}
        self._placed: dict[str, Placed] = {}

    def _configuration(self, given: Mapping[str, Fraction | str]) -> dict[str, Expr]:
        self.here = ("configuration",)
        known = [q.name for q in self.table.coordinates]
        names = frozenset(known)
        found: dict[str, Expr] = {}
        for name, value in given.items():
            if name in names:
                found[name] = self.fixed(value, name)
            else:
                self.unknown("coordinate", name, known, name)
        return found

    def _stands(self, index: int, particle: Particle) -> Vec | None:
        """Where a particle stands in the reference configuration."""
        self.here = ("particles", index)
        names = self.table.particles[particle.name]
        found = None if particle.at is None else self.position(particle.at, "at")
        given = [name for name in names if name in self.configuration]
        if found is not None and given:
            for name, part in zip(names, found, strict=True):
                if name in self.configuration and differs_from_zero(self.configuration[name] - part):
                    message = f"'{particle.name}' is given two places: `at`, and {name} in `configuration`"
                    self.fault(message, "at", hint="leave one of them out")
        if found is None and len(given) == len(names):
            found = tuple(self.configuration[name] for name in names)
            self.points.append(found)
        return found

    def make_frames(self, mentioned: frozenset[str]) -> None:
        """The bodies' frames; a body whose angles some text mentions keeps its Euler angles."""
        d = self.dimension
        for body, names in self.table.bodies.items():
            values = [self.configuration.get(name, ZERO) for name in names]
            chart: Chart = "line" if d == 1 else "plane"
            if d == 3:
                chart = "gibbs" if mentioned.isdisjoint(names[3:]) else "euler"
            position = tuple(coordinate(name) for name in names[:d])
            self.frames[body] = Frame(body, position, tuple(values[:d]), chart, names[d:], tuple(values[d:]))
            if any(name in self.configuration for name in names):
                self.drawn.add(body)

    # what constraints ask for

    def vector(self, values: Vector, *where: str | int) -> Vec | None:
        """The components as expressions; None after a fault in their number."""
        d = self.dimension
        if len(values) != d:
            message = f"{len(values)} component{'s' * (len(values) != 1)} given where the dimension is {d}"
            self.fault(message, *where, hint=f"write {d}, or change the scene's `dimension`")
            return None
        return tuple(self.fixed(value, *where, i) for i, value in enumerate(values))

    def position(self, values: Vector, *where: str | int) -> Vec | None:
        """A given point of the drawing."""
        found = self.vector(values, *where)
        if found is not None:
            self.points.append(found)
        return found

    def place(self, values: Vector | None, *where: str | int) -> Vec:
        """A given point of the drawing, or a generic one."""
        found = self._place(values, *where)
        self.asked.places.append(None if values is None else found)
        return found

    def _place(self, values: Vector | None, *where: str | int) -> Vec:
        if values is None:
            return tuple(self.fresh() for _ in range(self.dimension))
        found = self.position(values, *where)
        return (ZERO,) * self.dimension if found is None else found

    def direction(self, values: Vector | None, *where: str | int) -> Direction:
        """A given direction, or a generic one."""
        found = self._direction(values, *where)
        self.asked.directions.append(None if values is None else found.vector)
        return found

    def _direction(self, values: Vector | None, *where: str | int) -> Direction:
        if values is None:
            n = (ONE, *(self.fresh() for _ in range(self.dimension - 1)))
            return Direction(n, across(n, 0))
        found = self.vector(values, *where)
        if found is not None:
            sizes = [_size(part) for part in found]
            pivot = max(range(len(sizes)), key=sizes.__getitem__)
            if sizes[pivot] > 0:
                return Direction(found, across(found, pivot))
            self.fault("a direction cannot be zero", *where, hint="give at least one component that is not 0")
        n = (ONE, *(ZERO,) * (self.dimension - 1))
        return Direction(n, across(n, 0))

    def fresh(self, stem: str = "a") -> Expr:
        """A new generic parameter."""
        name = f"_{stem}{len(self.generic) + 1}"
        self.generic.append(name)
        return parameter(name)

    def frame(self, name: str, *where: str | int) -> Frame:
        """The frame of a body, or of the ground."""
        found = self.ground if name == GROUND else self.frames.get(name)
        if found is not None:
            self.asked.members.append(name)
            return found
        if name in self.standing:
            hint = "a particle is held by `coincident`, `fixed`, `slot` or `link`"
            self.fault(f"'{name}' is a particle where a body is needed", *where, hint=hint)
        else:
            self.unknown("body", name, chain(self.frames, (GROUND,)), *where, plural="bodies")
        return self.ground

    def particle(self, name: str, *where: str | int) -> Placed:
        """A particle's position."""
        found = self._placed.get(name)
        if found is None and name in self.standing:
            q = tuple(coordinate(c) for c in self.table.particles[name])
            found = self._placed[name] = Placed(q, ONE, self.standing[name], None, name)
        if found is not None:
            self.asked.members.append(name)
            self.asked.points.append(DrawnPoint(name, found.reference, particle=True))
            return found
        if name in self.frames or name == GROUND:
            place = ", ".join("..." for _ in range(self.dimension))
            hint = f"name one of its points: {{on: {name}, at: [{place}]}}"
            self.fault(f"'{name}' is a body where a point is needed", *where, hint=hint)
        else:
            self.unknown("particle", name, self.standing, *where)
        return Placed((ZERO,) * self.dimension, ONE, None, None, f"({name})")

    def point(self, point: str | Vector | BodyPoint, *where: str | int) -> Placed:
        """A particle, a point fixed in the world, or a material point of a body."""
        if isinstance(point, str):
            return self.particle(point, *where)
        if isinstance(point, BodyPoint):
            frame = self.frame(point.on, *where, "on")
            at = self._place(point.at, *where, "at")
            self.drawn.add(frame.name)
            self.asked.points.append(DrawnPoint(frame.name, at))
            return frame.point(at, show_point(point))
        at = self._place(point, *where)
        self.asked.members.append(GROUND)
        self.asked.points.append(DrawnPoint(GROUND, at))
        return self.ground.point(at, show_point(point))

    def apart(self, first: Placed, second: Placed, squared: Expr, at_most: bool = False) -> None:
        """Two points keep a squared distance, or at most that; nothing is kept of one that moves or is generic."""
        if any(s.args[0] != "parameter" or s.args[1].startswith("_") for s in squared.symbols):
            return
        a, b = (Place(p.frame, p.label, p.reference if p.frame else None) for p in (first, second))
        self.distances.setdefault(int(self.here[-1]), []).append(Distance(a, b, squared, at_most))

    # the drawing

    def differs(self, gap: Expr) -> bool:
        """Whether what should vanish in the drawing certainly does not.

        A gap that holds parameters vanishes only at special values of them: it is no contradiction,
        but the drawing is no reference then.
        """
        gap = substitute(gap, {TIME: ZERO})
        if gap.is_zero or any(symbol.args[0] != "parameter" for symbol in gap.symbols) or not differs_from_zero(gap):
            return False
        if gap.symbols:
            self.special = True
        return not gap.symbols

    def any_differs(self, gaps: Sequence[Expr]) -> bool:
        """Whether any of several gaps differs; every one is looked at."""
        return sum(self.differs(gap) for gap in gaps) > 0

    def within(self, distance: float | None, size: float) -> bool:
        """Whether a distance is inside the scene's tolerance."""
        return distance is not None and bool(self.tolerance) and abs(distance) <= float(self.tolerance or 0) * size

    def check_later(self, check: Callable[[float], None]) -> None:
        """Run ``check(size)`` at the end, its faults at the present place."""
        self.later.append((self.here, check))


def _size(part: Expr) -> float:
    """How far a component is from 0: its size if it is a number, 1 for what holds parameters."""
    if part.is_zero:
        return 0.0
    found = approximate(part)
    if found is None:
        return 1.0
    return abs(found) if differs_from_zero(part) else 0.0
