"""From a scene to its `System`: names, frames and constraints, with their faults.

Faults are collected in the order of the scene's keys; those that depend on the size of the scene come last.
"""

from __future__ import annotations

import math
import weakref
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, TypeAlias

from dofkit.base.deadline import check as check_time
from dofkit.base.deadline import gc_rarely
from dofkit.base.errors import Fault, SceneError
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.renaming import Unwritten
from dofkit.expressions.text import Names
from dofkit.expressions.tree import MINUS_ONE, ZERO, Expr, mul, parameter, power
from dofkit.expressions.vectors import Vec
from dofkit.report import Companion, Report
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.constraints.base import LETTERS
from dofkit.scene.drawing import Drawing, centre_of, drawing_of, placed_bodies, pose_of, reference_of, size_of, unplaced
from dofkit.scene.fields import suggestion
from dofkit.scene.ledger import MOVING, Texts, symbols_of
from dofkit.scene.names import Vocabulary, name_faults, names_by_position, owner_kinds, vocabulary_of, within_member
from dofkit.scene.parts import Body, Force, texts_of
from dofkit.scene.picture import picture_of
from dofkit.scene.scene import Scene
from dofkit.scene.world import World, within
from dofkit.system import GROUND, Connection, Constraint, ListedForce, Rotation, System

#: Values of coordinates.
Pose: TypeAlias = dict[Expr, Expr]
#: Hint, by dimension, for a type that is not defined in this dimension.
_INSTEAD = {
    1: "on a line use coincident, fixed, link or an equation",
    2: "in the plane use revolute, prismatic, weld or slot",
    3: "in space use cylindrical, screw or an equation",
}

#: The warning if the given geometry is not used because lengths are parameters.
SPECIAL = (
    "The given geometry has numbers where lengths are parameters: it is compatible with special values of them only, "
    "so it is not used as a reference configuration."
)
#: A sine below this bound is treated as 0.
SINGULAR = 1e-9
#: The warning if the reference configuration is singular for Euler angles.
LEVEL = (
    "The given geometry is not used as a reference configuration: texts contain Euler angles, which are singular for "
    "{} there (theta = 0: the other two angles turn alike). Give another theta in `configuration`."
)


@dataclass(frozen=True)
class Survey:
    """The result of reading a whole scene: the world of its constraints, their relations, connections and the faults.

    ``placed``: the bodies placed in the reference configuration; ``size``: the largest distance in that configuration.
    """

    world: World
    constraints: tuple[Constraint, ...]
    connections: tuple[Connection, ...]
    placed: frozenset[str]
    size: float
    faults: tuple[Fault, ...]

    @property
    def drawing(self) -> Drawing:
        """Frames and positions before any constraint is read."""
        return self.world.drawing

    @property
    def names(self) -> Names:
        """The names that texts may mention."""
        return self.drawing.vocabulary.names


def check(scene: Scene) -> tuple[Fault, ...]:
    """Return every fault of a scene in its texts and between its fields, each with its path; empty if it is correct."""
    return survey_of(scene).faults


def survey_of(scene: Scene) -> Survey:
    """Return the survey of a scene, which is kept with the scene as long as its mappings do not change."""
    mappings = [dict(part) for part in (scene.parameters, scene.functions, scene.configuration, scene.expect)]
    survey_kept: Survey
    if scene._kept.about is not None:
        owner, written, survey_kept = scene._kept.about
        if owner() is scene and written == mappings:
            return survey_kept
    new_survey = survey(scene)
    scene._kept = Companion((weakref.ref(scene), mappings, new_survey))
    return new_survey


@gc_rarely()
def survey(scene: Scene, euler: bool = False) -> Survey:
    """Read all of a scene and return the result, with every fault; none is raised.

    ``euler``: every spatial body has Euler angles, even if no text mentions them.
    """
    vocabulary = vocabulary_of(scene)
    every = frozenset(q.name for q in vocabulary.table.coordinates)
    faults = [*vocabulary.faults]
    drawing = drawing_of(scene, vocabulary, every if euler else _mentioned_names(scene, vocabulary), faults)
    faults += name_faults(scene, vocabulary.table)
    faults += _repeat_faults("constraints", "c", [c.name for c in scene.constraints])
    names = names_by_position("c", [c.name for c in scene.constraints])
    world = World(drawing, (), faults, dict(zip(names, scene.constraints, strict=True)))
    constraints, connections = [], []
    for index, (constraint, name) in enumerate(zip(scene.constraints, names, strict=True)):
        check_time()
        world.enter("constraints", index)
        constraints.append(_constraint_of(world, constraint, name))
        connections.append(_connection(world, constraints[-1]))
    _check_other_sections(scene, world, vocabulary)
    size, placed = size_of(world.points), placed_bodies(world.placed, world.welds)
    misfits = (m for m in world.misfits if m.body is None or m.body in placed)
    faults += [m.fault for m in misfits if not within(m.distance, drawing.tolerance, size)]
    return Survey(world, tuple(constraints), tuple(connections), placed, size, tuple(faults))


def _check_other_sections(scene: Scene, world: World, vocabulary: Vocabulary) -> None:
    """Record the faults of forces, masses, energies, picture and expectations in ``world.faults``."""
    world.faults += _repeat_faults("forces", "f", [f.name for f in scene.forces])
    for index, force in enumerate(scene.forces):
        world.enter("forces", index)
        _check_force(force, world)
    texts = Texts(vocabulary.texts, (), world.faults)
    _check_masses(scene, texts)
    _check_energies(scene, texts, [q.name for q in vocabulary.table.coordinates])
    if scene.picture:
        picture_of(scene, vocabulary, world.faults)
    world.faults += _expect_faults(scene)


def _repeat_faults(key: str, letter: str, written_names: Sequence[str | None]) -> Iterator[Fault]:
    """Yield a fault for each entry of the section ``key`` whose name, given or by position, an earlier entry has."""
    names = names_by_position(letter, written_names)
    repeated = {name for name, times in Counter(names).items() if times > 1}
    first: dict[str, int] = {}
    for i, name in enumerate(names):
        if name in repeated and first.setdefault(name, i) != i:
            message = f"the name '{name}' is given twice"
            if written_names[i] is None or written_names[first[name]] is None:
                message += f": it is the default name of entry {(i if written_names[i] is None else first[name]) + 1}"
            where = (key, i) if written_names[i] is None else (key, i, "name")
            yield Fault(message, where, hint=f"rename one of them: `name: {name}_2`")


def _constraint_of(world: World, constraint: ConstraintBase, name: str) -> Constraint:
    """Return the constraint with its relations, without any (and a fault) in a dimension where it is not defined."""
    kind = constraint.kind()
    if world.dimension not in constraint.dimensions:
        allowed = " or ".join(str(d) for d in constraint.dimensions)
        message = f"'{kind}' is defined in dimension {allowed}; this scene has dimension {world.dimension}"
        world.fault(message, "type", hint=_INSTEAD[world.dimension])
        return Constraint(name, kind, constraint.facts, constraint.in_words, ())
    relations = constraint.relations(world)
    written = relations if isinstance(relations, Unwritten) else tuple(relations)
    return Constraint(name, kind, constraint.facts, constraint.in_words, written, tuple(constraint.notes(world)))


def _connection(world: World, constraint: Constraint) -> Connection:
    """Return which bodies, points and directions the constraint that was read last connects."""
    mentioned, relations = world.mentioned, constraint.relations
    return Connection(
        world.index,
        constraint.facts,
        tuple(dict.fromkeys(mentioned.members)),
        tuple(mentioned.points),
        tuple(mentioned.places),
        tuple(mentioned.directions),
        mentioned.number,
        not isinstance(relations, Unwritten) and any(relation.part == "drive" for relation in relations),
        tuple(mentioned.rates),
    )


def _mentioned_names(scene: Scene, vocabulary: Vocabulary) -> frozenset[str]:
    """Return the coordinates in the texts of a spatial scene: bodies with these have Euler angles."""
    if scene.dimension != 3 or not scene.bodies:
        return frozenset()
    member = within_member(vocabulary.names, LETTERS)
    texts = [
        (text, member if constraint.facts.lettered else vocabulary.names)
        for constraint in scene.constraints
        for text in constraint.texts()
    ]
    for part in (*scene.forces, *([scene.energies] if scene.energies else [])):
        written = part.model_dump(exclude={"name", "type", "between", "point", "body"})
        texts += [(text, vocabulary.names) for text in texts_of(written)]
    symbols: frozenset[Expr] = frozenset().union(*(symbols_of(text, names) for text, names in texts))
    named = {str(s.args[1]) for s in symbols if s.args[0] not in ("parameter", "time", "dt")}
    return frozenset(named.union(scene.energies.forces if scene.energies else ()))


def _check_force(force: Force, world: World) -> None:
    for j, end in enumerate(force.between or ()):
        if not (isinstance(end, str) and (end in world.frames or end == GROUND)):
            world.point(end, "between", j)
    if force.point is not None:
        world.point(force.point, "point")
    if force.body is not None:
        world.frame(force.body, "body")
    for key in ("stiffness", "rest_length", "damping", "value", "direction", "acceleration"):
        _check_value(world, getattr(force, key), key)


def _check_value(texts: Texts, value: Any, *where: str | int) -> None:
    if isinstance(value, str):
        texts.expression(value, *where, allow=MOVING)
    elif isinstance(value, tuple):
        for i, part in enumerate(value):
            _check_value(texts, part, *where, i)


def _check_masses(scene: Scene, texts: Texts) -> None:
    for kind in owner_kinds(scene):
        for i, owner in enumerate(kind.owners):
            texts.here = (kind.section, i)
            _check_value(texts, owner.mass, "mass")
            if isinstance(owner, Body):
                _check_value(texts, owner.inertia, "inertia")


def _check_energies(scene: Scene, texts: Texts, coordinates: Sequence[str]) -> None:
    texts.here = ("energies",)
    if scene.energies is not None:
        for key in ("kinetic", "potential", "dissipation"):
            _check_value(texts, getattr(scene.energies, key), key)
        for name, text in scene.energies.forces.items():
            if name not in coordinates:
                texts.unknown("coordinate", name, coordinates, "forces", name)
            texts.expression(text, "forces", name, allow=MOVING)


def _expect_faults(scene: Scene) -> Iterator[Fault]:
    fields = list(Report.model_fields)
    for key in scene.expect:
        if key not in fields:
            yield Fault(f"'{key}' is not a field of a report", ("expect", key), hint=suggestion(key, fields, "keys"))


def lower(scene: Scene) -> System:
    """Return the system of a scene. Raises SceneError with all faults if there are any."""
    surveyed = survey_of(scene)
    if surveyed.faults:
        raise SceneError(surveyed.faults)
    return system_of(scene, surveyed)


def system_of(scene: Scene, surveyed: Survey) -> System:
    """Return the system of a scene that `survey_of` has read without faults."""
    drawing, world = surveyed.drawing, surveyed.world
    vocabulary, pose = drawing.vocabulary, pose_of(drawing)
    reference, singular, warning = _reference(surveyed, pose)
    names = names_by_position("f", [force.name for force in scene.forces])
    return System(
        name=scene.name,
        dimension=scene.dimension,
        coordinates=vocabulary.table.coordinates,
        constraints=surveyed.constraints,
        parameters={n: sign for n, sign in vocabulary.signs.items() if vocabulary.parameters[n] == parameter(n)},
        generic=tuple(world.generic),
        functions={name: len(arguments) for name, arguments in scene.functions.items()},
        rotations=_rotations(drawing),
        reference=reference,
        pose=pose if reference is None else reference,
        particles=tuple(vocabulary.table.particles),
        bodies=tuple(vocabulary.table.bodies),
        forces=tuple(ListedForce(name, force.reason) for name, force in zip(names, scene.forces, strict=True)),
        links=tuple(world.links),
        distances={} if reference is not None else {i: tuple(pairs) for i, pairs in world.distances.items()},
        connections=surveyed.connections,
        starts={name: frame.start for name, frame in drawing.frames.items()},
        arms=_arms(drawing, centre_of(world.points) if drawing.tolerance else None),
        tolerance=scene.tolerance or None,
        size=surveyed.size,
        warnings=(*world.warnings, *_joint_warnings(surveyed.constraints, surveyed.connections), *warning),
        left_out=scene.left_out,
        singular_pose=singular,  # the given configuration, where Euler angles are singular
    )


def _reference(surveyed: Survey, pose: Pose) -> tuple[Pose | None, Pose | None, list[str]]:
    """Return (reference or None, a reference that is singular for Euler angles or None, warnings)."""
    special = surveyed.world.special or not surveyed.placed.isdisjoint(surveyed.world.special_of)
    if special or surveyed.world.generic:
        return None, None, [SPECIAL] if special else []
    drawing = surveyed.drawing
    touched = cache(lambda: frozenset[str]().union(*(c.mentioned for c in surveyed.constraints)))
    reference = reference_of(drawing, surveyed.placed, pose, touched)
    if reference is not None:
        level = _level(drawing, touched)
        return (None, reference, [LEVEL.format(", ".join(level))]) if level else (reference, None, [])
    placed = surveyed.placed or drawing.configuration
    missing = unplaced(drawing, surveyed.placed, pose, touched()) if placed else ()
    listed = ", ".join(missing[:8]) + (", ..." if len(missing) > 8 else "")
    position, verb = ("positions", "are") if len(missing) > 1 else ("position", "is")
    message = f"There is no reference configuration: the {position} of {listed} {verb} not given."
    return None, None, [message] if missing else []


def _level(drawing: Drawing, touched: Callable[[], frozenset[str]]) -> list[str]:
    """Return the bodies with Euler angles in texts whose reference is singular for these: sin(theta) = 0."""
    bodies = []
    for frame in drawing.frames.values():
        if frame.chart == "euler" and not touched().isdisjoint(frame.angles):
            tilt = approximate(frame.initial[1])
            if tilt is None or abs(math.sin(tilt)) < SINGULAR:
                bodies.append(frame.name)
    return bodies


def _arms(drawing: Drawing, centre: Vec | None) -> dict[str, Vec]:
    """Return, for every body that turns, the vector from its origin to its material point at the scene's centre."""
    arms = {}
    for frame in drawing.frames.values():
        if frame.angles and centre is not None:
            point = replace(frame, position=(ZERO,) * frame.dimension).point(centre)
            arms[frame.name] = tuple(mul(x, power(point.under, MINUS_ONE)) for x in point.over)
    return arms


def _rotations(drawing: Drawing) -> tuple[Rotation, ...]:
    """Return the bodies' rotations in three coordinates, with their reference values."""
    rotations = []
    for frame in drawing.frames.values():
        if frame.chart == "gibbs" or frame.chart == "euler":
            (phi, theta, psi), (a, b, c) = frame.angles, frame.initial
            rotations.append(Rotation(frame.name, (phi, theta, psi), frame.chart, (a, b, c)))
    return tuple(rotations)


def _joint_warnings(constraints: Sequence[Constraint], connections: Sequence[Connection]) -> Iterator[str]:
    """Yield warnings about two likely mistakes with joints.

    Gears whose wheel turns on a moving arm: without ``carrier`` the ratio is that of angles relative to the ground. A
    driven joint at the same place as another joint of the same bodies: the motor of that joint, written as a joint.
    """
    joints = [c for c in connections if (c.facts.joint or c.facts.geared) and len(c.members) == 2]
    hinges = [c.members for c in joints if c.facts.axial and c.facts.planar_pair]
    at_rest = _at_rest(connections) if any(c.facts.geared for c in joints) else set()
    for joint in joints:
        name = constraints[joint.constraint].name
        for wheel in joint.members if joint.facts.geared else ():
            arms = [second if first == wheel else first for first, second in hinges if wheel in (first, second)]
            moving = [arm for arm in arms if arm not in joint.members and at_rest.isdisjoint(arms)]
            for arm in moving[:1]:
                yield (
                    f"'{name}': the wheel '{wheel}' turns on '{arm}', which moves; without `carrier` the ratio is that "
                    f"of the angles against the ground. If '{arm}' carries the gears, write `carrier: {arm}`."
                )
    for motor in joints:
        for joint in joints if motor.driven else ():
            if joint is not motor and _repeats(motor, joint):
                name, other = constraints[motor.constraint].name, constraints[joint.constraint].name
                drive = constraints[motor.constraint].text.rpartition("driven by ")[2]
                yield (
                    f"'{name}' and '{other}' join '{motor.members[0]}' and '{motor.members[1]}' at the same place, so "
                    f"their equations occur twice. If '{name}' is the motor of '{other}', write `drive: {drive}` "
                    f"on '{other}' and remove '{name}'."
                )


def _repeats(motor: Connection, joint: Connection) -> bool:
    """Return whether two joints of one type connect the same bodies with the same given geometry."""
    is_given = None not in (*motor.places, *motor.directions) and bool(motor.places)
    geometry = (motor.facts, {*motor.members}, motor.places, motor.directions)
    return is_given and geometry == (joint.facts, {*joint.members}, joint.places, joint.directions)


def _at_rest(connections: Sequence[Connection]) -> set[str]:
    """Return the ground, the fixed bodies and all bodies welded to these."""
    still = {GROUND} | {c.members[0] for c in connections if c.facts.held and len(c.members) == 1 and not c.points}
    return {
        *placed_bodies(still, [c.members[:2] for c in connections if c.facts.welded and len(c.members) == 2]),
        GROUND,
    }
