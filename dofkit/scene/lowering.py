"""From what a person wrote to the mathematics: `lower` makes a `System` of a `Scene`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache, partial

from dofkit.base.errors import SceneError
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import MINUS_ONE, ZERO, mul, parameter, power
from dofkit.expressions.vectors import Vec
from dofkit.scene.drawing import Drawing
from dofkit.scene.elaboration import names_by_position
from dofkit.scene.reference import pose_of, reference_of, undrawn
from dofkit.scene.scene import Scene, survey_of
from dofkit.scene.survey import Survey
from dofkit.system import Constraint, ListedForce, Rotation, System

#: Said where the drawing is not used.
SPECIAL = (
    "The given geometry has numbers where lengths are parameters: it is compatible with special values of them only, "
    "so it is not used as a reference configuration."
)
#: Below this size a sine is taken for 0: such a drawing is not looked at.
SINGULAR = 1e-9
#: Said where the drawing shows no velocities.
LEVEL = (
    "The given geometry is not used as a reference configuration: texts contain Euler angles, which are singular for "
    "{} there (theta = 0: the other two angles turn alike). Give another theta in `configuration`."
)


def lower(scene: Scene) -> System:
    """The coordinates and exact relations of a scene. Raises SceneError with all its faults if it has any."""
    found = survey_of(scene)
    if found.faults:
        raise SceneError(found.faults)
    return system_of(scene, found)


def system_of(scene: Scene, found: Survey) -> System:
    """The mathematics of a scene that was surveyed without faults."""
    drawing, vocabulary = found.drawing, found.drawing.vocabulary
    pose = pose_of(drawing)
    reference, singular, warnings = None, None, list(found.warnings)
    if found.special:
        warnings.append(SPECIAL)
    elif not found.generic:
        touched = cache(partial(_touched, found.constraints))
        reference = reference_of(drawing, found.drawn, pose, touched)
        level = [] if reference is None else _level(drawing, touched)
        if level:
            reference, singular = None, reference
            warnings.append(LEVEL.format(", ".join(level)))
        elif reference is None:
            warnings += _partly(found, undrawn(drawing, found.drawn, pose, touched()) if found.drawn else ())
    return System(
        name=scene.name,
        dimension=scene.dimension,
        coordinates=vocabulary.table.coordinates,
        constraints=found.constraints,
        parameters={n: sign for n, sign in vocabulary.signs.items() if vocabulary.parameters[n] == parameter(n)},
        generic=found.generic,
        functions={name: len(arguments) for name, arguments in scene.functions.items()},
        rotations=_rotations(drawing),
        reference=reference,
        pose=pose if reference is None else reference,
        particles=tuple(vocabulary.table.particles),
        bodies=tuple(vocabulary.table.bodies),
        forces=_forces(scene),
        links=found.links,
        distances=found.distances if reference is None else {},
        connections=found.connections,
        starts={name: frame.start for name, frame in drawing.frames.items()},
        arms=_arms(drawing, found.centre),
        tolerance=scene.tolerance or None,
        size=found.size,
        warnings=tuple(warnings),
        left_out=scene.left_out,
        drawn=singular,
    )


def _forces(scene: Scene) -> tuple[ListedForce, ...]:
    names = names_by_position("f", [force.name for force in scene.forces])
    return tuple(ListedForce(name, force.reason) for name, force in zip(names, scene.forces, strict=True))


def _touched(constraints: Iterable[Constraint]) -> frozenset[str]:
    """The coordinates that relations mention."""
    return frozenset[str]().union(*(c.mentioned for c in constraints))


def _partly(found: Survey, missing: Sequence[str]) -> Iterator[str]:
    """A line where bodies are drawn and something else that is constrained is not."""
    if missing and found.drawn:
        shown = ", ".join(missing[:8]) + (", ..." if len(missing) > 8 else "")
        yield f"There is no reference configuration: the position of {shown} is not given."


def _level(drawing: Drawing, touched: Callable[[], frozenset[str]]) -> list[str]:
    """The bodies with Euler angles in texts that are drawn where these are singular: sin(theta) = 0."""
    found = []
    for frame in drawing.frames.values():
        if frame.chart == "euler" and not touched().isdisjoint(frame.angles):
            tilt = approximate(frame.initial[1])
            if tilt is None or abs(math.sin(tilt)) < SINGULAR:
                found.append(frame.name)
    return found


def _arms(drawing: Drawing, centre: Vec | None) -> dict[str, Vec]:
    """Return, for every body that turns, the vector from its origin to its material point at the scene's centre."""
    if centre is None:
        return {}
    found = {}
    for frame in drawing.frames.values():
        if frame.angles:
            point = replace(frame, position=(ZERO,) * frame.dimension).point(centre)
            found[frame.name] = tuple(mul(x, power(point.under, MINUS_ONE)) for x in point.over)
    return found


def _rotations(drawing: Drawing) -> tuple[Rotation, ...]:
    found = []
    for frame in drawing.frames.values():
        if frame.chart == "gibbs" or frame.chart == "euler":
            (phi, theta, psi), (a, b, c) = frame.angles, frame.initial
            found.append(Rotation(frame.name, (phi, theta, psi), frame.chart, (a, b, c)))
    return tuple(found)
