"""The symbols of joints: strokes of their types, put where the joints are, and the ground's hatching."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from dofkit.pictures.shapes import Array, Place, Role, Shape, State, Vertex, place
from dofkit.pictures.stage import StagedScene, axis_of, carriers
from dofkit.scene.symbols import Stroke
from dofkit.system import GROUND, Connection

#: How far a rail's hatching stands from the axis, and how many strokes of it there are; in symbols.
RAIL, TICKS = 0.8, 9


def joint_shapes(stage: StagedScene, number: int) -> Iterator[Shape]:
    """The strokes of a constraint's symbol."""
    connection, symbol, at = stage.system.connections[number], stage.symbol(number), stage.places[number]
    if at is None:
        return
    name = stage.system.constraints[number].name
    state = stage.state(name)
    frame = _frame(stage, connection)
    members = carriers(connection)
    spot = {k: stage.spot(number, m) for k, m in members.items()}
    strokes = symbol.plane if stage.flat else symbol.space
    for stroke in strokes:
        k = min(stroke.member, len(members) - 1)
        yield _stroke(stage, stroke, members[k], spot[k], frame)._replace(owner=name, state=state)
    if len(members) > 1 and strokes and not connection.points:
        ends = (Vertex(members[0], place(spot[0])), Vertex(members[1], place(spot[1])))
        yield Shape("line", ends, "guide", state, name)
    held = GROUND in connection.members or len(members) == 1
    if held and strokes and (stage.flat or not symbol.rails):
        yield from _footing(stage, number, at, frame)


def _frame(stage: StagedScene, connection: Connection) -> Array:
    """Along the axis, across it, and across both, as rows."""
    first = axis_of(stage.arrangement, connection, 0)
    if stage.flat:
        return np.array([first, [-first[1], first[0], 0.0], [0.0, 0.0, 1.0]])
    if len(connection.directions) > 1:
        second = axis_of(stage.arrangement, connection, 1)
    else:
        second = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
    second = second - first * (first @ second)
    second = second / max(float(np.linalg.norm(second)), 1e-9)
    return np.array([first, second, np.cross(first, second)])


def _stroke(stage: StagedScene, stroke: Stroke, carrier: str, spot: Array, frame: Array) -> Shape:
    role: Role = "joint" if stroke.filled or not stage.flat else "guide"
    vertices = []
    for told in stroke.spots:
        along = np.array((*told, 0.0, 0.0)[:3])
        vertices.append(Vertex(carrier, place(spot + stage.unit * (along @ frame))))
    if len(vertices) == 1:
        return Shape("ball", tuple(vertices), role, size=stroke.radius * stage.unit)
    if stroke.closed:
        return Shape("area", tuple(vertices), role)
    return Shape("line", tuple(vertices), role)


def _footing(stage: StagedScene, number: int, at: Place, frame: Array) -> Iterator[Shape]:
    """What holds a joint to the ground: hatching along a rail, or a stand under a pin."""
    symbol, connection = stage.symbol(number), stage.system.connections[number]
    if symbol.rails and stage.flat:
        side = frame[1] if frame[1][1] < 0 or (frame[1][1] == 0 and frame[1][0] > 0) else -frame[1]
        gap = RAIL if not connection.points else 0.7
        yield hatching(
            stage, stage.spot(number, GROUND) + side * gap * stage.unit, frame[0] * symbol.rails * stage.unit, side
        )
    elif not symbol.rails:
        member = connection.members[0]
        yield from stand(stage, at if GROUND in connection.members else place(_here(stage, number, member)))


def _here(stage: StagedScene, number: int, member: str) -> Array:
    return stage.here(Vertex(member, place(stage.spot(number, member))))


def hatching(stage: StagedScene, middle: Array, half: Array, side: Array, ticks: int = TICKS) -> Shape:
    """Short strokes along a line, on one side of it, as one zigzag."""
    way = half / max(float(np.linalg.norm(half)), 1e-12)
    slant = (side - way) * max(0.55 * stage.unit, 0.07 * float(np.linalg.norm(half)))
    spots: list[Array] = []
    for k in range(ticks):
        root = middle + half * (2 * (k + 0.7) / ticks - 1)
        spots += [root, root + slant, root]
    return Shape("line", tuple(Vertex(GROUND, place(s)) for s in spots), "hatch")


def stand(stage: StagedScene, at: Place) -> Iterator[Shape]:
    """A triangle on hatched ground below a point of the world; in space a tripod on a plate."""
    u, root = stage.unit, np.array(at)
    if stage.flat:
        down = np.array([0.0, -1.0, 0.0])
        across = np.array([1.0, 0.0, 0.0])
        feet = [root + u * (1.5 * down + side * across) for side in (-0.9, 0.9)]
        yield Shape("area", tuple(Vertex(GROUND, place(p)) for p in (root, *feet)), "ground")
        base = root + 1.5 * u * down
        ends = (base - 1.4 * u * across, base + 1.4 * u * across)
        yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in ends), "ground")
        yield hatching(stage, base, 1.4 * u * across, down, 5)
        return
    down = np.array([0.0, 0.0, -1.8 * u])
    corners = [np.array([x, y, 0.0]) * u + down for x, y in ((-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9))]
    yield Shape("area", tuple(Vertex(GROUND, place(root + c)) for c in corners), "ground")
    for corner in corners:
        yield Shape("line", (Vertex(GROUND, at), Vertex(GROUND, place(root + corner))), "ground")


def name_of(stage: StagedScene, text: str, vertices: tuple[Vertex, ...], state: State = "plain") -> Shape:
    """A name beside the middle of some vertices."""
    return Shape("words", vertices, "name", state, text, size=stage.unit, text=text)
