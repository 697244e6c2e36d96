"""From what a person wrote to the mathematics: `lower` makes a `System` of a `Scene`."""

from __future__ import annotations

from dofkit.base.errors import SceneError
from dofkit.expressions.tree import parameter
from dofkit.scene.reference import pose_of, reference_of
from dofkit.scene.scene import Scene
from dofkit.scene.survey import Survey, names_by_position, taken
from dofkit.scene.world import World
from dofkit.system import ListedForce, Rotation, System


def lower(scene: Scene) -> System:
    """The coordinates and exact relations of a scene. Raises SceneError with all its faults if it has any."""
    found = taken(scene)
    if found.world.faults:
        raise SceneError(tuple(found.world.faults))
    return system_of(scene, found)


def system_of(scene: Scene, found: Survey) -> System:
    """The mathematics of a scene that was surveyed without faults."""
    world = found.world
    pose = pose_of(world)
    reference = reference_of(world, pose)
    if world.special:
        world.warnings.append(
            "The drawing has numbers where lengths are parameters: it fits only special values of them, "
            "so it is not used as a reference configuration."
        )
    names = names_by_position("f", [force.name for force in scene.forces])
    return System(
        name=scene.name,
        dimension=scene.dimension,
        coordinates=world.table.coordinates,
        constraints=found.constraints,
        parameters={name: sign for name, sign in world.signs.items() if world.parameters[name] == parameter(name)},
        generic=tuple(world.generic),
        functions={name: len(arguments) for name, arguments in scene.functions.items()},
        rotations=_rotations(world),
        reference=reference,
        pose=pose if reference is None else reference,
        particles=tuple(world.table.particles),
        bodies=tuple(world.table.bodies),
        forces=tuple(ListedForce(name, force.reason) for name, force in zip(names, scene.forces, strict=True)),
        links=tuple(world.links),
        distances=world.distances if reference is None else {},
        connections=found.connections,
        starts={name: frame.start for name, frame in world.frames.items()},
        tolerance=scene.tolerance or None,
        size=found.size,
        warnings=tuple(world.warnings),
    )


def _rotations(world: World) -> tuple[Rotation, ...]:
    found = []
    for frame in world.frames.values():
        if frame.chart == "gibbs" or frame.chart == "euler":
            (phi, theta, psi), (a, b, c) = frame.angles, frame.initial
            found.append(Rotation(frame.name, (phi, theta, psi), frame.chart, (a, b, c)))
    return tuple(found)
