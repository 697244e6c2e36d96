"""The sketch of a mechanism, from a scene and its report: bodies, particles, springs, names, and notes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from dofkit.expressions.tree import TIME, parameter
from dofkit.motion.poses import about
from dofkit.pictures.joints import joint_shapes, name_of, run_shapes
from dofkit.pictures.loci import meeting_shapes
from dofkit.pictures.placed_shapes import faces, picture_shapes
from dofkit.pictures.shapes import SQUARE, Place, Shape, Sketch, State, Vertex, carried_by, fixed, place
from dofkit.pictures.stage import POINT, StagedScene, axis_of, force_ends
from dofkit.pictures.words import alternative, answer
from dofkit.system import GROUND, System

#: In symbol sizes: the padding of hulls (in the plane, in space), the length of a stub, half the sides of a free body.
PAD, THIN, STUB, FREE = 0.85, 0.45, 6.0, (3.0, 1.8, 1.2)
#: The most particles and constraints that are named, the most equations in the notes, the most traced points.
MOST_PARTICLES, MOST_NAMES, MOST_TEXTS, MOST_TRACED = 60, 24, 4, 8
_WEIGHT: tuple[State, ...] = ("plain", "moving", "redundant", "conflicting")
BY_FORM = "Drawn by the form of its constraints: an upright disc that rolls, or a knife edge."
FREE_PLACES = "Schematic: the scene gives no positions of its joints."


def is_bare(system: System) -> bool:
    """Return whether a system has coordinates only."""
    return not system.bodies and not system.particles


def sketch_of(stage: StagedScene) -> Sketch:
    """Return the sketch of a mechanism."""
    shapes = [*_rail(stage), *_body_shapes(stage), *_force_shapes(stage)]
    for number, constraint in enumerate(stage.system.constraints):
        if constraint.name not in stage.picture.taken:
            shapes += [*run_shapes(stage, number), *joint_shapes(stage, number)]
    shapes += [*meeting_shapes(stage), *_particle_shapes(stage), *_names(stage)]
    shapes = [shape for shape in shapes if shape.owner not in stage.picture.taken]
    shapes += picture_shapes(stage.picture, stage.arrangement.numbers, stage.unit)
    return Sketch(
        title=stage.title,
        dimension=stage.picture.dimension if is_bare(stage.system) else stage.system.dimension,
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=stage.size,
        answer=answer(stage.report),
        alternative=alternative(stage.scene, stage.report),
        notes=tuple(notes_of(stage)),
        meanings=stage.meanings,
        measurable=stage.measurable,
        traced=tuple(_traced(stage, shapes)),
    )


def _traced(stage: StagedScene, shapes: Sequence[Shape]) -> Iterator[Vertex]:
    """Yield the points whose paths are drawn: balls, else origins of placed shapes, corners of hulls, or bodies."""
    dots = [s.vertices[0] for s in shapes if s.kind == "ball" and s.vertices[0].at == (0.0, 0.0, 0.0)]
    dots = [v for v in dots if v.carrier != GROUND]
    frames = [v for s in shapes if s.role == "body" for v in s.vertices if v.carrier not in stage.system.bodies]
    origins = [Vertex(v.carrier, (0.0, 0.0, 0.0)) for v in frames if v.carrier != GROUND]
    corners = [v for s in shapes if s.kind == "hull" for v in s.vertices]
    traced = dots or origins or corners or [stage.origin(b) for b in stage.system.bodies]
    yield from dict.fromkeys(traced[:MOST_TRACED])


def _body_shapes(stage: StagedScene) -> Iterator[Shape]:
    """Yield a hull for each body, and its name."""
    for body in stage.system.bodies:
        positions = _attached(stage, body)
        state = stage.state_of_body(body)
        wheel = any(_shapes_body(stage, k, body) for k in range(len(stage.system.connections)))
        if not positions and not wheel:
            yield from _free_body(stage, body)
            continue
        far = [s for s in positions if np.linalg.norm(np.array(s) - np.array(positions[0])) > 1e-6 * stage.size]
        if positions and not far and not wheel:
            positions = [*positions, *_stub(stage, body, positions[0])]
        corners = carried_by(body, positions)
        if corners:
            yield Shape("hull", corners, "body", state, body, (PAD if stage.flat else THIN) * stage.unit)
        yield name_of(stage, body, corners or (stage.origin(body),), state)


def _shapes_body(stage: StagedScene, number: int, body: str) -> bool:
    """Return whether a constraint's shapes include the body itself: a wheel, a gear, a cam."""
    members = stage.system.connections[number].members
    run = stage.symbol(number).run
    return (run == "profile" and members[-1] == body) or (run in ("wheel", "teeth") and body in members[:2])


def _attached(stage: StagedScene, body: str) -> list[Place]:
    """Return the points of a body at which constraints or forces are attached."""
    points: list[Place] = []
    for k, connection in enumerate(stage.system.connections):
        if body not in connection.members or stage.symbol(k).run == "teeth":
            continue
        mentioned = [v.at for v in stage.vertices(connection) if v.carrier == body]
        points += mentioned
        if not mentioned and stage.places[k] is not None and stage.symbol(k).run == "":
            points.append(place(stage.position(k, body)))
    ends = (v for force in stage.scene.forces for v in force_ends(stage.arrangement, force))
    points += [v.at for v in ends if v.carrier == body]
    return list(dict.fromkeys(points))


def _stub(stage: StagedScene, body: str, at: Place) -> list[Place]:
    """Return a second end for a body that is attached at one point only; none on a rail."""
    length, turn = STUB * stage.unit, 0.9 * stage.system.bodies.index(body)
    for k, connection in enumerate(stage.system.connections):
        if body not in connection.members or stage.places[k] is None:
            continue
        if stage.symbol(k).rails and stage.flat:
            return []
        if not stage.flat and connection.directions:
            axis = axis_of(stage.arrangement, connection, 0)
            across = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
            size = float(np.linalg.norm(across))
            direction = (math.cos(turn) * across + math.sin(turn) * np.cross(axis, across)) / size
            return [place(np.array(at) + length * direction)]
    direction = np.array([0.55, 0.83, 0.0]) if stage.flat else np.array([0.55, 0.2, 0.8])
    return [place(np.array(at) + length * (about(2, turn) @ direction))]


def _free_body(stage: StagedScene, body: str) -> Iterator[Shape]:
    """Yield a box with axes for a body without attached points."""
    origin = stage.origin(body)
    centre, state, u = np.array(origin.at), stage.state_of_body(body), stage.unit
    half = np.array(FREE) * u
    if stage.system.dimension == 1:
        half[1] = 1.2 * u
    sides = [[np.array([x, y, 0.0]) * half for x, y in SQUARE]] if stage.flat else faces(half)
    for face in sides:
        yield Shape("area", carried_by(body, (centre + corner for corner in face)), "body", state, body)
    for direction in np.eye(3)[: max(1, stage.system.dimension)]:
        yield Shape("line", (origin, *carried_by(body, [centre + direction * 2.2 * u])), "axis", owner=body)
    yield name_of(stage, body, carried_by(body, [centre + np.array([0.0, half[1], 0.0])]), state)


def _particle_shapes(stage: StagedScene) -> Iterator[Shape]:
    """Yield a dot for each particle, and its name."""
    for particle in stage.system.particles:
        vertex, state = stage.origin(particle), stage.state_of_body(particle)
        yield Shape("ball", (vertex,), "point", state, particle, 0.42 * stage.unit)
        if len(stage.system.particles) <= MOST_PARTICLES and particle != POINT:
            yield name_of(stage, particle, (vertex,), state)


def _rail(stage: StagedScene) -> Iterator[Shape]:
    """Yield, in one dimension, the line of the motion."""
    if stage.system.dimension != 1:
        return
    poses = stage.arrangement.poses
    reach = [pose.moved((0.0, 0.0, 0.0))[0] for name, pose in poses.items() if name != GROUND] or [0.0]
    yield Shape("line", fixed([min(reach) - 6 * stage.unit], [max(reach) + 6 * stage.unit]), "guide")


def _force_shapes(stage: StagedScene) -> Iterator[Shape]:
    """Yield springs and dampers between points that are drawn."""
    for force in stage.scene.forces:
        ends = tuple(force_ends(stage.arrangement, force))
        if len(ends) == 2:
            yield Shape("coil", ends, "force", owner=force.name or force.type, size=0.5 * stage.unit)


def _names(stage: StagedScene) -> Iterator[Shape]:
    """Yield the names that were given to constraints, one text for all at the same point."""
    by_anchor: dict[tuple[Vertex, ...], list[int]] = {}
    named = [k for k, c in enumerate(stage.scene.constraints) if c.name is not None]
    for number in named if len(named) <= MOST_NAMES else ():
        anchor = _anchor(stage, number)
        if anchor:
            by_anchor.setdefault(anchor, []).append(number)
    for anchor, numbers in by_anchor.items():
        names = [stage.system.constraints[k].name for k in numbers]
        states: list[State] = [stage.state(name) for name in names]
        yield name_of(stage, ", ".join(names), anchor, max(states, key=_WEIGHT.index))


def _anchor(stage: StagedScene, number: int) -> tuple[Vertex, ...]:
    """Return the vertices next to which the name of a constraint is written; none if it has no place."""
    connection, at = stage.system.connections[number], stage.places[number]
    run = stage.symbol(number).run
    if run in ("bar", "bars", "rope"):
        return tuple(stage.vertices(connection))[:2]
    if run == "teeth":
        pins = [stage.places[k] for k, c in enumerate(stage.system.connections) if c.facts.axial]
        positions = [Vertex(m, p) for m, p in zip(connection.members, pins, strict=False) if p is not None]
        return tuple(positions[-2:])
    if at is None or not connection.members:
        return ()
    member = next((m for m in connection.members if m in stage.system.bodies), connection.members[0])
    return carried_by(member, [stage.position(number, member)])


def notes_of(stage: StagedScene) -> Iterator[str]:
    """Yield the notes below a picture: the origin of its positions, numbers, and the equations as written."""
    if stage.unseen is not None:
        yield stage.unseen
    if stage.picture.shapes and not stage.scene.picture:
        yield BY_FORM
    if stage.schematic:
        yield FREE_PLACES
    elif stage.arrangement.note is not None:
        yield stage.arrangement.note
    used = {s for c in stage.system.constraints for r in c.relations for s in r.expr.symbols}
    numbers = stage.arrangement.numbers
    drawn_with = [p for p in map(parameter, stage.system.parameters) if p in used][:6] + [TIME] * bool(numbers[TIME])
    if drawn_with:
        yield f"Drawn with {', '.join(f'{s.args[1]} = {numbers.get(s, 1.0):.4g}' for s in drawn_with)}."
    if stage.scene.functions:
        yield f"Unknown functions ({', '.join(stage.scene.functions)}) are drawn as an example."
    written = [c for c in stage.system.constraints if c.facts.written]
    for constraint in written[:MOST_TEXTS]:
        yield f"{constraint.name}: {constraint.text}"
    if len(written) > MOST_TEXTS:
        yield f"{len(written) - MOST_TEXTS} more equations are not listed."
