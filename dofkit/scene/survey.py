"""From what is written to what is known: names, then frames, then constraints, each step a value for the next.

Faults are collected on the way, in the order of the scene's keys; those that need the size of the whole drawing last.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any, Protocol

from dofkit.base.deadline import gc_rarely
from dofkit.base.errors import Fault
from dofkit.expressions.text import Names
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import Vec
from dofkit.report import Report
from dofkit.scene.carriers import carrier_warnings, motor_warnings
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.constraints.equations import LETTERS
from dofkit.scene.drawing import Drawing, drawing_of
from dofkit.scene.elaboration import Elaboration, elaborations, repeat_faults
from dofkit.scene.fields import suggestion
from dofkit.scene.ledger import MOVING, Texts, symbols_of
from dofkit.scene.names import Declared, Owners, Vocabulary, name_faults, vocabulary_of, within_member
from dofkit.scene.parts import Body, Energies, Force, texts_of
from dofkit.scene.reference import centre_of, drawn_bodies, size_of
from dofkit.scene.world import NO_FINDINGS, Before, Findings, World, within
from dofkit.system import GROUND, Connection, Constraint, Distance


class Surveyed(Declared, Protocol):
    """A scene, as far as the survey needs one."""

    @property
    def constraints(self) -> tuple[ConstraintBase, ...]: ...
    @property
    def forces(self) -> tuple[Force, ...]: ...
    @property
    def energies(self) -> Energies | None: ...
    @property
    def expect(self) -> Mapping[str, Any]: ...


@dataclass(frozen=True)
class Survey:
    """All that is known of a scene: its drawing, its constraints lowered, what they connect, and its faults.

    ``generic``, ``links``, ``distances`` (these two by constraint index), ``special`` and ``warnings`` are as in
    `Findings`, of all entries; ``drawn``: the bodies that the drawing places; ``size``: that of the drawing;
    ``centre``: its middle, where the geometry is measured.
    """

    drawing: Drawing
    constraints: tuple[Constraint, ...]
    connections: tuple[Connection, ...]
    generic: tuple[str, ...]
    drawn: frozenset[str]
    links: tuple[tuple[int, str, str], ...]
    distances: Mapping[int, tuple[Distance, ...]]
    special: bool
    size: float
    centre: Vec | None
    warnings: tuple[str, ...]
    faults: tuple[Fault, ...]

    @property
    def names(self) -> Names:
        """What texts may mention."""
        return self.drawing.vocabulary.names


@gc_rarely()
def survey(scene: Surveyed, euler: bool = False) -> Survey:
    """Read everything; nothing is raised for what is at fault.

    ``euler``: every spatial body is turned by its Euler angles, also where no text mentions them.
    """
    vocabulary = vocabulary_of(scene)
    every = frozenset(q.name for q in vocabulary.table.coordinates)
    drawing = drawing_of(scene, vocabulary, every if euler else _mentioned_names(scene, vocabulary))
    faults = [*vocabulary.faults, *drawing.faults, *name_faults(scene, vocabulary.table)]
    faults += repeat_faults("constraints", "c", [c.name for c in scene.constraints])
    read = tuple(elaborations(scene.constraints, drawing, len(faults)))
    faults += chain.from_iterable(e.findings.faults for e in read)
    faults += repeat_faults("forces", "f", [f.name for f in scene.forces])
    forces = []
    for index, force in enumerate(scene.forces):
        forces.append(_force_findings(force, World(drawing, ("forces", index), Before(len(faults)))))
        faults += forces[-1].faults
    faults += _mass_faults(scene, vocabulary)
    faults += _energy_faults(scene, vocabulary, len(faults))
    faults += _expect_faults(scene)
    return _whole(drawing, read, forces, faults)


def _whole(drawing: Drawing, read: tuple[Elaboration, ...], forces: list[Findings], faults: list[Fault]) -> Survey:
    """What was read of all entries, put together."""
    findings = [f for f in (*(e.findings for e in read), *forces) if f is not NO_FINDINGS]
    points = [*drawing.points, *(p for f in findings for p in f.points)]
    size = size_of(points)
    placed = drawing.drawn.union(*(f.drawn for f in findings if f.drawn))
    drawn = drawn_bodies(placed, (ends for f in findings for ends in f.welds))
    constraints, connections = tuple(e.constraint for e in read), tuple(e.connection for e in read)
    misfits = (m for f in findings for m in f.misfits if m.body is None or m.body in drawn)
    return Survey(
        drawing=drawing,
        constraints=constraints,
        connections=connections,
        generic=tuple(name for f in findings for name in f.generic),
        drawn=drawn,
        links=tuple((i, first, second) for i, e in enumerate(read) for first, second in e.findings.links),
        distances={i: e.findings.distances for i, e in enumerate(read) if e.findings.distances},
        special=any(f.special or not drawn.isdisjoint(f.special_of) for f in findings),
        size=size,
        centre=centre_of(points) if drawing.tolerance else None,
        warnings=(
            *(w for f in findings for w in f.warnings),
            *carrier_warnings(constraints, connections),
            *motor_warnings(constraints, connections),
        ),
        faults=(*faults, *(m.fault for m in misfits if not within(m.distance, drawing.tolerance, size))),
    )


class KeptSurvey:
    """The survey of one very scene, made when it is first asked for.

    It is no part of what is written: equal to every other, and empty in a copy and in another process. A copy of a
    model shares it with the original, for whom alone it is kept, and only while its mappings hold what they held.
    """

    def __init__(self) -> None:
        self._known: tuple[weakref.ref[Any], tuple[dict[str, Any], ...], Survey] | None = None

    def of(self, scene: Surveyed) -> Survey:
        """The survey of a scene."""
        mappings = (dict(scene.parameters), dict(scene.functions), dict(scene.configuration), dict(scene.expect))
        if self._known is not None:
            owner, written, known = self._known
            if owner() is not scene and owner() is not None:
                return survey(scene)
            if owner() is scene and written == mappings:
                return known
        found = survey(scene)
        self._known = weakref.ref(scene), mappings, found
        return found

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KeptSurvey)

    def __hash__(self) -> int:
        return hash(KeptSurvey)

    def __reduce__(self) -> tuple[type[KeptSurvey], tuple[()]]:
        return KeptSurvey, ()


def _mentioned_names(scene: Surveyed, vocabulary: Vocabulary) -> frozenset[str]:
    """The coordinates that some text names, where a spatial body's chart depends on it."""
    if scene.dimension != 3 or not scene.bodies:
        return frozenset()
    found: set[str] = set()
    member = within_member(vocabulary.names, LETTERS)
    for constraint in scene.constraints:
        names = member if constraint.facts.lettered else vocabulary.names
        for text in constraint.texts():
            found.update(_moving_names(symbols_of(text, names)))
    given: list[Any] = [*scene.forces, *([scene.energies] if scene.energies else [])]
    for part in given:
        for text in texts_of(part.model_dump(exclude={"name", "type", "between", "point", "body"})):
            found.update(_moving_names(symbols_of(text, vocabulary.names)))
    if scene.energies:
        found.update(scene.energies.forces)
    return frozenset(found)


def _moving_names(symbols: frozenset[Expr]) -> Iterator[str]:
    for symbol in symbols:
        if symbol.args[0] not in ("parameter", "time", "dt"):
            yield symbol.args[1]


def _force_findings(force: Force, world: World) -> Findings:
    for j, end in enumerate(force.between or ()):
        if not (isinstance(end, str) and (end in world.frames or end == GROUND)):
            world.point(end, "between", j)
    if force.point is not None:
        world.point(force.point, "point")
    if force.body is not None:
        world.frame(force.body, "body")
    for key in ("stiffness", "rest_length", "damping", "value", "direction", "acceleration"):
        _check_value(world, getattr(force, key), key)
    return world.findings()


def _check_value(texts: Texts, value: Any, *where: str | int) -> None:
    if isinstance(value, str):
        texts.expression(value, *where, allow=MOVING)
    elif isinstance(value, tuple):
        for i, part in enumerate(value):
            _check_value(texts, part, *where, i)


def _mass_faults(scene: Surveyed, vocabulary: Vocabulary) -> Iterator[Fault]:
    both: tuple[tuple[str, Owners], ...] = (("particles", scene.particles), ("bodies", scene.bodies))
    for key, owners in both:
        for i, owner in enumerate(owners):
            inertia = owner.inertia if key == "bodies" and isinstance(owner, Body) else None
            if owner.mass is not None or inertia is not None:
                texts = Texts(vocabulary.texts, (key, i))
                _check_value(texts, owner.mass, "mass")
                _check_value(texts, inertia, "inertia")
                yield from texts.faults


def _energy_faults(scene: Surveyed, vocabulary: Vocabulary, before: int) -> list[Fault]:
    if scene.energies is None:
        return []
    texts = Texts(vocabulary.texts, ("energies",), before)
    for key in ("kinetic", "potential", "dissipation"):
        _check_value(texts, getattr(scene.energies, key), key)
    known = [q.name for q in vocabulary.table.coordinates]
    for name, text in scene.energies.forces.items():
        if name not in known:
            texts.unknown("coordinate", name, known, "forces", name)
        texts.expression(text, "forces", name, allow=MOVING)
    return texts.faults


def _expect_faults(scene: Surveyed) -> Iterator[Fault]:
    known = list(Report.model_fields)
    for key in scene.expect:
        if key not in Report.model_fields:
            hint = suggestion(key, known, "keys")
            yield Fault(f"'{key}' is not a field of a report", ("expect", key), hint=hint)
