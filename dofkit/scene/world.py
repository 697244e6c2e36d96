"""The world of a scene's constraints: its frames, points and directions.

A constraint type asks `World` for what it mentions (``world.frame("crank", "between", 0)``). An unknown name is a fault
at that path, and another object is returned, so that all faults are reported at once. Geometry that is not given is
replaced by generic parameters.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from typing import NamedTuple

from dofkit.base.errors import Fault, TextError
from dofkit.base.wording import nearest
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate, differs_from_zero
from dofkit.expressions.text import UnknownNameError
from dofkit.expressions.tree import ONE, TIME, ZERO, Expr, parameter
from dofkit.expressions.vectors import Vec, across
from dofkit.scene.drawing import Drawing
from dofkit.scene.fields import Vector
from dofkit.scene.frames import Frame, Placed
from dofkit.scene.ledger import MOST_HINTS, Texts
from dofkit.scene.parts import BodyPoint, show_point
from dofkit.system import GROUND, Distance, DrawnPoint, JointRate, Place

#: A distance as people write it: |A - B| = 3.
_APART = re.compile(r"\s*\|\s*(?:r_)?(\w+)\s*-\s*(?:r_)?(\w+)\s*\|\s*=\s*([\w./()*]+)\s*")


class Direction(NamedTuple):
    """A direction in the reference configuration, and d - 1 independent vectors perpendicular to it (``across``)."""

    vector: Vec
    across: tuple[Vec, ...]


class Misfit(NamedTuple):
    """A fault unless ``distance`` (None: unknown) is within the tolerance, which needs the size of the scene.

    With a ``body``: a fault only if the reference configuration places that body.
    """

    distance: float | None
    fault: Fault
    body: str | None = None


@dataclass(slots=True)
class Mentioned:
    """The names and geometry that one entry of the scene mentions, in order."""

    members: list[str] = field(default_factory=list)
    points: list[DrawnPoint] = field(default_factory=list)
    places: list[Vec | None] = field(default_factory=list)
    directions: list[Vec | None] = field(default_factory=list)
    number: Expr | None = None
    rates: list[JointRate] = field(default_factory=list)


class World(Texts):
    """The frames, points and directions of a scene, and what is collected while its entries are read one by one.

    ``mentioned``: what the current entry mentions, the constraint number ``index``; ``entries``: the constraints of the
    scene by name. Collected from the entries so far: ``generic`` parameters; given ``points``; ``placed``, the bodies
    that these place; ``welds`` as pairs of bodies; ``links`` and ``distances`` with the number of their constraint;
    ``misfits`` and ``warnings``. ``special``: the given geometry fits special values of parameters only;
    ``special_of``: bodies for which this is so if the reference places them.
    """

    def __init__(
        self,
        drawing: Drawing,
        here: tuple[str | int, ...] = (),
        faults: list[Fault] | None = None,
        entries: Mapping[str, object] | None = None,
    ) -> None:
        super().__init__(drawing.vocabulary.texts, here, faults)
        self.entries: Mapping[str, object] = entries or {}
        self.drawing = drawing
        self.dimension, self.tolerance = drawing.dimension, drawing.tolerance
        self.table, self.particles = drawing.vocabulary.table, drawing.particles
        self.ground, self.frames = drawing.ground, drawing.frames
        self.index = 0
        self.mentioned = Mentioned()
        self.generic: list[str] = []
        self.points: list[Vec] = [*drawing.points]
        self.placed: set[str] = {*drawing.placed}
        self.welds: list[tuple[str, str]] = []
        self.links: list[tuple[int, str, str]] = []
        self.distances: dict[int, list[Distance]] = {}
        self.misfits: list[Misfit] = []
        self.warnings: list[str] = []
        self.special = False
        self.special_of: set[str] = set()

    def enter(self, section: str, index: int) -> None:
        """Begin to read the entry number ``index`` of a section."""
        self.here, self.index, self.mentioned = (section, index), index, Mentioned()

    def place(self, values: Vector | None, *where: str | int) -> Vec:
        """Return a point given in the reference configuration, or a generic one for None, and note it."""
        place = self._place(values, *where)
        self.mentioned.places.append(None if values is None else place)
        return place

    def _place(self, values: Vector | None, *where: str | int) -> Vec:
        if values is None:
            return tuple(self.fresh() for _ in range(self.dimension))
        place = self.vector(values, self.dimension, *where)
        if place is None:
            return (ZERO,) * self.dimension
        self.points.append(place)
        return place

    def direction(self, values: Vector | None, *where: str | int) -> Direction:
        """Return a given direction, or a generic one for None, and note it."""
        direction = self._direction(values, *where)
        self.mentioned.directions.append(None if values is None else direction.vector)
        return direction

    def _direction(self, values: Vector | None, *where: str | int) -> Direction:
        if values is None:
            generic = (ONE, *(self.fresh() for _ in range(self.dimension - 1)))
            return Direction(generic, across(generic, 0))
        n = self.vector(values, self.dimension, *where)
        direction = _direction_along(n)
        if direction is None and n is not None:
            self.fault("a direction cannot be zero", *where, hint="give at least one component that is not 0")
        first_axis = (ONE, *(ZERO,) * (self.dimension - 1))
        return direction or Direction(first_axis, across(first_axis, 0))

    def reference_vector(self, values: Vector | None) -> Vec | None:
        """Return a place or direction of another entry, which also records its faults; None after a fault."""
        texts = Texts(self._reader, self.here)
        vector = None if values is None else texts.vector(values, self.dimension)
        return None if texts.faults else vector

    def reference_direction(self, values: Vector | None) -> Direction | None:
        """Return a direction of another entry; None if it is missing or faulty."""
        return _direction_along(self.reference_vector(values))

    def fresh(self, stem: str = "a") -> Expr:
        """Return a new generic parameter."""
        name = f"_{stem}{len(self.generic) + 1}"
        self.generic.append(name)
        return parameter(name)

    def frame(self, name: str, *where: str | int) -> Frame:
        """Return the frame of a body or the ground, noted as a member; after a fault return the ground."""
        frame = self.ground if name == GROUND else self.frames.get(name)
        if frame is not None:
            self.mentioned.members.append(name)
            return frame
        if name in self.particles:
            hint = f"constrain a particle by `link`, `slot`, `coincident` or `fixed`: `{{type: fixed, point: {name}}}`"
            self.fault(f"'{name}' is a particle where a body is needed", *where, hint=hint)
        else:
            self.unknown("body", name, chain(self.frames, (GROUND,)), *where, plural="bodies")
        return self.ground

    def advice(self, error: TextError, text: str) -> str | None:
        """Return the hint for an unreadable text: for the name of a joint, particle or body, how to use it."""
        name = error.name if isinstance(error, UnknownNameError) else ""
        if hasattr(self.entries.get(name), "drive"):
            return f'joints are related by a coupling: `{{type: coupling, joints: {{q: {name}}}, text: "q = 2 t"}}`'
        owners = {**self.table.particles, **self.table.bodies}
        owned = owners.get(name) or owners.get(name.partition("_")[2])
        if owned is None:
            return error.hint
        apart = _APART.fullmatch(text)
        if apart is not None:
            return f"a distance is a link: `{{type: link, between: [{apart[1]}, {apart[2]}], length: {apart[3]}}}`"
        return f"write coordinates: {', '.join(f'`{q}`' for q in owned)}"

    def particle(self, name: str, *where: str | int) -> Placed:
        """Return the position of a particle, noted as a member; after a fault return the origin."""
        placed = self.particles.get(name)
        if placed is not None:
            self.mentioned.members.append(name)
            self.mentioned.points.append(DrawnPoint(name, placed.reference, particle=True))
            return placed
        place = ", ".join(["0"] * self.dimension)
        late = len(self.faults) >= MOST_HINTS
        body = None if late or nearest(name, self.particles) else nearest(name, self.frames)
        if name in self.frames or name == GROUND:
            hint = f"name one of its points: `{{on: {name}, at: [{place}]}}`"
            hint = f"write a fixed point: `[{place}]`" if name == GROUND else hint
            self.fault(f"'{name}' is a body where a point is needed", *where, hint=hint)
        elif body is not None:
            hint = f"did you mean the body '{body}'? name one of its points: `{{on: {body}, at: [{place}]}}`"
            self.fault(f"there is no particle '{name}'", *where, hint=hint)
        else:
            self.unknown("particle", name, self.particles, *where)
        return Placed((ZERO,) * self.dimension, ONE, None, None, f"({name})")

    def point(self, point: str | Vector | BodyPoint, *where: str | int) -> Placed:
        """Return the position of a particle, a point fixed in the world or a material point of a body, and note it."""
        if isinstance(point, str):
            return self.particle(point, *where)
        if isinstance(point, BodyPoint):
            frame = self.frame(point.on, *where, "on")
            at = self._place(point.at, *where, "at")
            self.placed.add(frame.name)
            self.mentioned.points.append(DrawnPoint(frame.name, at))
            return frame.point(at, show_point(point))
        at = self._place(point, *where)
        self.mentioned.members.append(GROUND)
        self.mentioned.points.append(DrawnPoint(GROUND, at))
        return self.ground.point(at, show_point(point))

    def is_apart(self, point: Placed, frame: Frame, *where: str | int) -> bool:
        """Return whether a point is not a point of the body itself; if it is, record a fault."""
        if point.frame == frame.name:
            self.fault(f"the point is a point of {frame.name} itself", *where, hint="name a point of something else")
        return point.frame != frame.name

    def apart(self, first: Placed, second: Placed, squared: Expr, at_most: bool = False) -> None:
        """Note that two points have the squared distance ``squared`` (or at most that), if it is constant and given."""
        if any(s.args[0] != "parameter" or s.args[1].startswith("_") for s in squared.symbols):
            return
        first_place, second_place = (Place(p.frame, p.label, p.reference if p.frame else None) for p in (first, second))
        self.distances.setdefault(self.index, []).append(Distance(first_place, second_place, squared, at_most))

    def differs(self, gap: Expr, body: str | None = None) -> bool:
        """Return whether ``gap``, which should be 0 in the reference configuration, certainly differs from 0.

        A nonzero gap that contains parameters is no contradiction, because it vanishes for special values of them, but
        then the given geometry is not the reference configuration; this is noted, with ``body`` for that body only.
        """
        gap = substitute(gap, {TIME: ZERO})
        if gap.is_zero or any(symbol.args[0] != "parameter" for symbol in gap.symbols) or not differs_from_zero(gap):
            return False
        if gap.symbols and body is not None:
            self.special_of.add(body)
        elif gap.symbols:
            self.special = True
        return not gap.symbols

    def any_differs(self, gaps: Sequence[Expr]) -> bool:
        """Return whether any of ``gaps`` differs from 0; each is examined, because `differs` takes notes."""
        return sum(self.differs(gap) for gap in gaps) > 0

    def misfit(
        self, distance: float | None, message: str, *where: str | int, hint: str, body: str | None = None
    ) -> None:
        """Record a fault that holds unless ``distance`` is within the tolerance, or ``body`` is not placed."""
        self.misfits.append(Misfit(distance, Fault(message, (*self.here, *where), hint=hint), body))


def within(distance: float | None, tolerance: Fraction | None, size: float) -> bool:
    """Return whether a distance is at most the tolerance, a fraction of ``size``; False without a tolerance."""
    return distance is not None and bool(tolerance) and abs(distance) <= float(tolerance or 0) * size


def _direction_along(n: Vec | None) -> Direction | None:
    """Return the direction of a vector; None if there is no vector or it is zero."""
    sizes = [_size(part) for part in n or ()]
    pivot = max(range(len(sizes)), key=sizes.__getitem__, default=0)
    return Direction(n, across(n, pivot)) if n is not None and sizes[pivot] > 0 else None


def _size(component: Expr) -> float:
    """Return the absolute value of a component as a float: 0 if not certainly nonzero, 1 if it contains parameters."""
    if component.is_zero:
        return 0.0
    size = approximate(component)
    if size is None:
        return 1.0
    return abs(size) if differs_from_zero(component) else 0.0
