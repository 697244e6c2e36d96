"""One pass over a scene: every name, text and constraint read, every fault found on the way."""

from __future__ import annotations

import gc
import weakref
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple, Protocol

from dofkit.base.deadline import check as out_of_time
from dofkit.base.errors import Fault
from dofkit.expressions.tree import Expr
from dofkit.report import Report
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.constraints.equations import LETTERS
from dofkit.scene.fields import suggestion
from dofkit.scene.ledger import MOVING
from dofkit.scene.names import Declared, Owners, check_names, within_member
from dofkit.scene.parts import Energies, Force, texts_of
from dofkit.scene.reference import size_of
from dofkit.scene.world import Joined, World
from dofkit.system import GROUND, Connection, Constraint


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


class Survey(NamedTuple):
    """The scene's world with its faults, its constraints lowered, what they connect, and the size of its drawing."""

    world: World
    constraints: tuple[Constraint, ...]
    connections: tuple[Connection, ...]
    size: float


@contextmanager
def _unhurried() -> Iterator[None]:
    """No garbage collection while many small immutable objects are made: it would take half of the time."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


@_unhurried()
def survey(scene: Surveyed, euler: bool = False) -> Survey:
    """Read everything; the faults are in ``world.faults``, in the order of the scene's keys.

    ``euler``: every spatial body is turned by its Euler angles, also where no text mentions them.
    """
    world = World(scene)
    check_names(scene, world.table, world)
    every = frozenset(q.name for q in world.table.coordinates)
    world.make_frames(every if euler else _mentioned(scene, world))
    names = names_by_position("c", [c.name for c in scene.constraints])
    _check_repeats(world, "constraints", [c.name for c in scene.constraints], names)
    constraints, connections = [], []
    for i, c in enumerate(scene.constraints):
        world.asked = Joined()
        constraints.append(_lowered(world, i, c, names[i]))
        connections.append(_connection(world.asked, i, constraints[-1]))
    _check_forces(scene, world)
    _check_energies(scene, world)
    world.here = ("expect",)
    known = list(Report.model_fields)
    for key in scene.expect:
        if key not in Report.model_fields:
            world.fault(f"'{key}' is no part of a report", key, hint=suggestion(key, known, "keys"))
    size = size_of(world.points)
    for place, look in world.later:
        world.here = place
        look(size)
    world.here = ()
    return Survey(world, tuple(constraints), tuple(connections), size)


#: Sound surveys made by `checked`, each until `taken` or until its scene is gone.
_KEPT: dict[int, tuple[weakref.ref[Any], Survey]] = {}


def checked(scene: Surveyed) -> tuple[Fault, ...]:
    """The faults of a scene; where there are none the survey is kept for the lowering that follows."""
    found = survey(scene)
    if not found.world.faults:
        key = id(scene)
        _KEPT[key] = weakref.ref(scene, lambda _: _KEPT.pop(key, None)), found
    return tuple(found.world.faults)


def taken(scene: Surveyed) -> Survey:
    """The survey that `checked` kept for this very scene, or a new one."""
    reference, found = _KEPT.pop(id(scene), (None, None))
    return found if reference is not None and found is not None and reference() is scene else survey(scene)


def names_by_position(letter: str, given: Sequence[str | None]) -> tuple[str, ...]:
    """``c1``, ``c2``, ... by position for those without a name."""
    return tuple(f"{letter}{i + 1}" if name is None else name for i, name in enumerate(given))


def _check_repeats(world: World, key: str, given: Sequence[str | None], names: Sequence[str]) -> None:
    repeated = {name for name, times in Counter(names).items() if times > 1}
    first: dict[str, int] = {}
    for i, name in enumerate(names):
        if name in repeated and first.setdefault(name, i) != i:
            world.here = (key, i)
            other = first[name]
            if given[i] is None or given[other] is None:
                default = i if given[i] is None else other
                message = f"the name '{name}' is given twice: it is the default name of entry {default + 1}"
            else:
                message = f"the name '{name}' is given twice"
            world.fault(message, *(() if given[i] is None else ("name",)), hint="rename one of them")


def _lowered(world: World, index: int, constraint: ConstraintBase, name: str) -> Constraint:
    out_of_time()
    world.here = ("constraints", index)
    kind = constraint.kind()
    if world.dimension not in constraint.dimensions:
        allowed = " or ".join(str(d) for d in constraint.dimensions)
        message = f"'{kind}' is for dimension {allowed}; this scene has dimension {world.dimension}"
        world.fault(message, "type", hint=_INSTEAD[world.dimension])
        return Constraint(name, kind, constraint.facts, constraint.shown, ())
    relations = tuple(constraint.relations(world))
    return Constraint(name, kind, constraint.facts, constraint.shown, relations, tuple(constraint.notes(world)))


def _connection(asked: Joined, index: int, constraint: Constraint) -> Connection:
    """What a constraint that has been lowered connects."""
    return Connection(
        index,
        constraint.facts,
        tuple(dict.fromkeys(asked.members)),
        tuple(asked.points),
        tuple(asked.places),
        tuple(asked.directions),
        asked.number,
        any(relation.part == "drive" for relation in constraint.relations),
    )


_INSTEAD = {
    1: "on a line use coincident, fixed, link or an equation",
    2: "in the plane use revolute, prismatic, weld or slot",
    3: "in space use cylindrical, screw or an equation",
}


def _mentioned(scene: Surveyed, world: World) -> frozenset[str]:
    """The coordinates that some text names, where a spatial body's chart depends on it."""
    if world.dimension != 3 or not scene.bodies:
        return frozenset()
    found: set[str] = set()
    member = within_member(world.names, LETTERS)
    for constraint in scene.constraints:
        names = member if constraint.facts.lettered else None
        for text in constraint.texts():
            found.update(_moving_names(world.symbols_of(text, names)))
    given: list[Any] = [*scene.forces, *([scene.energies] if scene.energies else [])]
    for part in given:
        for text in texts_of(part.model_dump(exclude={"name", "type", "between", "point", "body"})):
            found.update(_moving_names(world.symbols_of(text, None)))
    if scene.energies:
        found.update(scene.energies.forces)
    return frozenset(found)


def _moving_names(symbols: frozenset[Expr]) -> Iterator[str]:
    for symbol in symbols:
        if symbol.args[0] not in ("parameter", "time", "dt"):
            yield symbol.args[1]


def _check_forces(scene: Surveyed, world: World) -> None:
    given = [force.name for force in scene.forces]
    _check_repeats(world, "forces", given, names_by_position("f", given))
    for i, force in enumerate(scene.forces):
        world.here = ("forces", i)
        for j, end in enumerate(force.between or ()):
            if not (isinstance(end, str) and (end in world.frames or end == GROUND)):
                world.point(end, "between", j)
        if force.point is not None:
            world.point(force.point, "point")
        if force.body is not None:
            world.frame(force.body, "body")
        for key in ("stiffness", "rest_length", "damping", "value", "direction", "acceleration"):
            _check_value(world, getattr(force, key), key)


def _check_value(world: World, value: Any, *where: str | int) -> None:
    if isinstance(value, str):
        world.expression(value, *where, allow=MOVING)
    elif isinstance(value, tuple):
        for i, part in enumerate(value):
            _check_value(world, part, *where, i)


def _check_energies(scene: Surveyed, world: World) -> None:
    both: tuple[tuple[str, Owners], ...] = (("particles", scene.particles), ("bodies", scene.bodies))
    for key, owners in both:
        for i, owner in enumerate(owners):
            world.here = (key, i)
            _check_value(world, owner.mass, "mass")
            _check_value(world, getattr(owner, "inertia", None), "inertia")
    if scene.energies is None:
        return
    world.here = ("energies",)
    for key in ("kinetic", "potential", "dissipation"):
        _check_value(world, getattr(scene.energies, key), key)
    known = [q.name for q in world.table.coordinates]
    for name, text in scene.energies.forces.items():
        if name not in known:
            world.unknown("coordinate", name, known, "forces", name)
        world.expression(text, "forces", name, allow=MOVING)
