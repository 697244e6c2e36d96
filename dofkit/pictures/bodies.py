"""Bodies as hulls of what is attached to them, particles, springs, and the names of all."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from dofkit.pictures.arrangement import about
from dofkit.pictures.shapes import Array, Place, Shape, Vertex, place
from dofkit.pictures.stage import StagedScene, axis_of
from dofkit.pictures.symbols import name_of
from dofkit.scene.parts import Force
from dofkit.system import GROUND

#: How far a hull reaches beyond what it holds, how long a stub is and the sides of a free body; in symbols.
PAD, THIN, STUB, FREE = 0.85, 0.45, 6.0, (3.0, 1.8, 1.2)
#: More particles than this are not named.
MOST_NAMES = 60


def body_shapes(stage: StagedScene) -> Iterator[Shape]:
    """A hull for each body, and its name."""
    for body in stage.system.bodies:
        spots = attached(stage, body)
        state = stage.state_of_body(body)
        wheel = any(_shapes_body(stage, k, body) for k in range(len(stage.system.connections)))
        if not spots and not wheel:
            yield from _free(stage, body)
            continue
        far = [s for s in spots if np.linalg.norm(np.array(s) - np.array(spots[0])) > 1e-6 * stage.size]
        if spots and not far and not wheel:
            spots = [*spots, *_stub(stage, body, spots[0])]
        corners = tuple(Vertex(body, s) for s in spots)
        if corners:
            yield Shape("hull", corners, "body", state, body, (PAD if stage.flat else THIN) * stage.unit)
        centre = stage.arrangement.point(stage.system.starts[body])
        yield name_of(stage, body, corners or (Vertex(body, centre),), state)


def _shapes_body(stage: StagedScene, number: int, body: str) -> bool:
    """Does a constraint draw the body itself: a wheel, a toothed one, a cam?"""
    members = stage.system.connections[number].members
    run = stage.symbol(number).run
    return (run == "profile" and members[-1] == body) or (run in ("wheel", "teeth") and body in members[:2])


def attached(stage: StagedScene, body: str) -> list[Place]:
    """Where something is attached to a body, in its drawing."""
    found = []
    for k, connection in enumerate(stage.system.connections):
        at = stage.places[k]
        if body not in connection.members or stage.symbol(k).run == "teeth":
            continue
        own = [v.at for v in stage.vertices(connection) if v.carrier == body]
        found += own
        if not own and at is not None and stage.symbol(k).run == "":
            found.append(place(stage.spot(k, body)))
    return list(dict.fromkeys(found))


def _stub(stage: StagedScene, body: str, at: Place) -> list[Place]:
    """Something to see of a body that is attached at one place only."""
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
            way = (math.cos(turn) * across + math.sin(turn) * np.cross(axis, across)) / size
            return [place(np.array(at) + length * way)]
    way = np.array([0.55, 0.83, 0.0]) if stage.flat else np.array([0.55, 0.2, 0.8])
    return [place(np.array(at) + length * (about(2, turn) @ way))]


def _free(stage: StagedScene, body: str) -> Iterator[Shape]:
    """A body that nothing is attached to: a box with its axes."""
    centre = np.array(stage.arrangement.point(stage.system.starts[body]))
    state, u = stage.state_of_body(body), stage.unit
    half = np.array(FREE) * u
    if stage.system.dimension == 1:
        half[1] = 1.2 * u
    corners = [np.array([x, y, 0.0]) * half for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    vertex = Vertex(body, place(centre))
    if stage.flat:
        yield Shape("area", tuple(Vertex(body, place(centre + c)) for c in corners), "body", state, body)
    else:
        for face in _faces(half):
            yield Shape("area", tuple(Vertex(body, place(centre + c)) for c in face), "body", state, body)
    for way in np.eye(3)[: max(1, stage.system.dimension)]:
        tip = place(centre + way * 2.2 * u)
        yield Shape("line", (vertex, Vertex(body, tip)), "axis", owner=body)
    yield name_of(stage, body, (Vertex(body, place(centre + np.array([0.0, half[1], 0.0]))),), state)


def _faces(half: Array) -> Iterator[list[Array]]:
    square = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    for axis in range(3):
        i, j = [k for k in range(3) if k != axis]
        for side in (-1, 1):
            face = []
            for a, b in square:
                corner = np.zeros(3)
                corner[axis], corner[i], corner[j] = side, a, b
                face.append(corner * half)
            yield face


def particle_shapes(stage: StagedScene) -> Iterator[Shape]:
    """A dot for each particle, and its name."""
    for particle in stage.system.particles:
        vertex, state = Vertex(particle, (0.0, 0.0, 0.0)), stage.state_of_body(particle)
        yield Shape("ball", (vertex,), "point", state, particle, 0.42 * stage.unit)
        if len(stage.system.particles) <= MOST_NAMES:
            yield name_of(stage, particle, (vertex,), state)


def rail_shapes(stage: StagedScene) -> Iterator[Shape]:
    """In one dimension: the line that everything is on."""
    if stage.system.dimension != 1:
        return
    reach = [pose.moved((0.0, 0.0, 0.0))[0] for name, pose in stage.arrangement.poses.items() if name != GROUND]
    reach = reach or [0.0]
    low, high = min(reach) - 6 * stage.unit, max(reach) + 6 * stage.unit
    yield Shape("line", (Vertex(GROUND, (low, 0.0, 0.0)), Vertex(GROUND, (high, 0.0, 0.0))), "guide")


def force_shapes(stage: StagedScene) -> Iterator[Shape]:
    """Springs and dampers between points that are drawn."""
    for force in stage.scene.forces:
        ends = _ends(stage, force)
        if len(ends) == 2:
            yield Shape("coil", (ends[0], ends[1]), "force", owner=force.name or force.type, size=0.5 * stage.unit)


def _ends(stage: StagedScene, force: Force) -> list[Vertex]:
    found = []
    for end in force.between or ():
        if isinstance(end, str) and end in stage.system.starts:
            found.append(Vertex(end, stage.arrangement.point(stage.system.starts[end])))
        elif isinstance(end, str) and end in stage.system.particles:
            found.append(Vertex(end, (0.0, 0.0, 0.0)))
        elif isinstance(end, tuple) and not any(isinstance(part, str) for part in end):
            found.append(Vertex(GROUND, place([float(part) for part in end if not isinstance(part, str)])))
    return found
