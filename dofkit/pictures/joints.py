"""The symbols of joints, and further shapes of constraints: bars, strings over pulleys, gears, wheels, the ground."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np

from dofkit.pictures.loci import locus, profile
from dofkit.pictures.placed_shapes import hatching
from dofkit.pictures.shapes import (
    AT_REST,
    SQUARE,
    Array,
    Clip,
    Place,
    Role,
    Shape,
    Sketch,
    State,
    Vertex,
    carried_by,
    circle,
    fixed,
    place,
)
from dofkit.pictures.stage import StagedScene, axis_of, carriers, radius_of
from dofkit.scene.symbols import Run, Stroke
from dofkit.system import GROUND, Connection

#: The distance of a rail's hatching from the axis in symbols, and its number of strokes.
RAIL, TICKS = 0.8, 9
#: Teeth of the smaller wheel of a pair, and the depth of a tooth by its radius.
TEETH, DEPTH = 14, 0.07
_X, _UP, _DOWN = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, -1.0, 0.0])


def name_of(stage: StagedScene, text: str, vertices: tuple[Vertex, ...], state: State = "plain") -> Shape:
    """Return a name next to the middle of some vertices."""
    return Shape("words", vertices, "name", state, text, size=stage.unit, text=text)


def joint_shapes(stage: StagedScene, number: int) -> Iterator[Shape]:
    """Yield the strokes of a constraint's symbol."""
    connection, symbol, at = stage.system.connections[number], stage.symbol(number), stage.places[number]
    if at is None:
        return
    name = stage.system.constraints[number].name
    state = stage.state(name)
    frame = _frame(stage, connection)
    members = carriers(connection)
    positions = {k: stage.position(number, m) for k, m in members.items()}
    strokes = symbol.plane if stage.flat else symbol.space
    for stroke in strokes:
        k = min(stroke.member, len(members) - 1)
        yield _stroke(stage, stroke, members[k], positions[k], frame)._replace(owner=name, state=state)
    if len(members) > 1 and strokes and not connection.points:
        ends = (Vertex(members[0], place(positions[0])), Vertex(members[1], place(positions[1])))
        yield Shape("line", ends, "guide", state, name)
    grounded = GROUND in connection.members or len(members) == 1
    if grounded and strokes and (stage.flat or not symbol.rails):
        yield from (shape._replace(owner=name, state=state) for shape in _footing(stage, number, at, frame))


def _frame(stage: StagedScene, connection: Connection) -> Array:
    """Return the orthonormal directions along the axis, across it, and across both, as rows."""
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


def _stroke(stage: StagedScene, stroke: Stroke, carrier: str, position: Array, frame: Array) -> Shape:
    """Return a stroke of a joint's symbol as a shape on ``carrier``; in the plane an unfilled stroke is a guide."""
    role: Role = "joint" if stroke.filled or not stage.flat else "guide"
    points = [position + stage.unit * (np.array((*at, 0.0, 0.0)[:3]) @ frame) for at in stroke.positions]
    vertices = carried_by(carrier, points)
    if len(vertices) == 1:
        return Shape("ball", vertices, role, size=stroke.radius * stage.unit)
    return Shape("area" if stroke.closed else "line", vertices, role)


def with_long_guides(stage: StagedScene, sketch: Sketch, clips: Sequence[Clip]) -> Sketch:
    """Return the sketch with guides as long as the motions of the sliders in the clips."""
    shapes = list(sketch.shapes)
    for number, connection in enumerate(stage.system.connections):
        symbol, members = stage.symbol(number), carriers(connection)
        strokes = symbol.plane if stage.flat else symbol.space
        if not symbol.rails or not strokes or stage.places[number] is None or len(members) < 2:
            continue
        longest = max(strokes, key=lambda stroke: max(point[0] for point in stroke.positions))
        half = stage.unit * max(point[0] for point in longest.positions)
        guide, slider = members[longest.member], members[1 - longest.member]
        axis, middle = axis_of(stage.arrangement, connection, 0), stage.position(number, guide)
        block, reach = Vertex(slider, place(stage.position(number, slider))), [0.0]
        for poses in (poses for clip in clips if not clip.dropped for poses in clip.frames):
            seen = poses.get(guide, AT_REST).back(sketch.at(block, poses))
            reach.append(float(axis @ (np.array(seen) - middle)))
        low, stretch = min(reach), 1 + (max(reach) - min(reach)) / (2 * half)
        name = stage.system.constraints[number].name
        for k, shape in enumerate(shapes):
            if shape.owner == name and shape.kind != "words" and {v.carrier for v in shape.vertices} == {guide}:
                along = [float(axis @ (np.array(v.at) - middle)) for v in shape.vertices]
                ends = [(low - half + (a + half) * stretch - a) * axis for a in along]
                moved = [np.array(v.at) + end for v, end in zip(shape.vertices, ends, strict=True)]
                shapes[k] = shape._replace(vertices=carried_by(guide, moved))
    return replace(sketch, shapes=tuple(shapes))


def _footing(stage: StagedScene, number: int, at: Place, frame: Array) -> Iterator[Shape]:
    """Yield the symbol that a joint is on the ground: hatching along a rail, or a stand under a pin."""
    symbol, connection = stage.symbol(number), stage.system.connections[number]
    if symbol.rails and stage.flat:
        side = frame[1] if frame[1][1] < 0 or (frame[1][1] == 0 and frame[1][0] > 0) else -frame[1]
        middle = stage.position(number, GROUND) + side * (0.7 if connection.points else RAIL) * stage.unit
        yield _hatched(stage, middle, frame[0] * symbol.rails * stage.unit, side)
    elif not symbol.rails:
        member = connection.members[0]
        here = stage.here(Vertex(member, place(stage.position(number, member))))
        yield from stand(stage, at if GROUND in connection.members else place(here))


def _hatched(stage: StagedScene, middle: Array, half: Array, side: Array, ticks: int = TICKS) -> Shape:
    return Shape("line", fixed(*hatching(stage.unit, middle, half, side, ticks)), "hatch")


def stand(stage: StagedScene, at: Place) -> Iterator[Shape]:
    """Yield a triangle on hatched ground below a point of the world; in space four legs on a plate."""
    u, root = stage.unit, np.array(at)
    if stage.flat:
        feet = [root + u * (1.5 * _DOWN + side * _X) for side in (-0.9, 0.9)]
        yield Shape("area", fixed(root, *feet), "ground")
        base = root + 1.5 * u * _DOWN
        yield Shape("line", fixed(base - 1.4 * u * _X, base + 1.4 * u * _X), "ground")
        yield _hatched(stage, base, 1.4 * u * _X, _DOWN, 5)
        return
    down = np.array([0.0, 0.0, -1.8 * u])
    corners = [np.array([0.9 * x, 0.9 * y, 0.0]) * u + down for x, y in SQUARE]
    yield Shape("area", fixed(*(root + c for c in corners)), "ground")
    for corner in corners:
        yield Shape("line", fixed(at, root + corner), "ground")


# Further shapes of constraints


def run_shapes(stage: StagedScene, number: int) -> Iterator[Shape]:
    """Yield the shapes of a constraint other than strokes, by the `run` of its symbol."""
    draw = _RUNS.get(stage.symbol(number).run)
    if draw is not None:
        name = stage.system.constraints[number].name
        for shape in draw(stage, number, stage.system.connections[number]):
            yield shape if shape.role == "body" else shape._replace(owner=name, state=stage.state(name))


def _bar(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield bars between the points of a constraint, with a ring at each end; in one dimension bows, to see all."""
    del number
    ends = list(stage.vertices(connection))
    for first, second in combinations(ends, 2):
        if stage.system.dimension == 1:
            yield Shape("bow", (first, second), "bar", size=0.32)
        else:
            yield Shape("line", (first, second), "bar")
    for end in ends:
        if end.carrier in stage.system.particles:
            continue
        yield Shape("ball", (end,), "joint", size=0.4 * stage.unit)
        if end.carrier == GROUND:
            yield from stand(stage, end.at)


def _rope(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield a line over small pulleys."""
    del number
    points = list(stage.vertices(connection))
    for first, second in pairwise(points):
        yield Shape("line", (first, second), "rope")
    for k, point in enumerate(points):
        inner = 0 < k < len(points) - 1
        if inner and point.carrier not in stage.system.particles:
            yield Shape("ball", (point,), "joint", size=0.9 * stage.unit)
            yield Shape("ball", (point,), "joint", size=0.2 * stage.unit)
        if point.carrier == GROUND and stage.flat:
            above = np.array(point.at) + (1.6 if inner else 0.0) * stage.unit * _UP
            half = 1.2 * stage.unit * _X
            yield Shape("line", fixed(above - half, above + half), "ground")
            yield _hatched(stage, above, half, _UP, 5)
            yield Shape("line", (*fixed(above), point), "ground")
        elif point.carrier == GROUND:
            yield from stand(stage, point.at)


def _teeth(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield two toothed wheels about the pins of their bodies, with radii by the ratio."""
    members = connection.members[:2]
    ratio = 1.0 if connection.number is None else stage.arrangement.number(connection.number)
    centres = [_pin(stage, m, number) for m in members]
    gap = float(np.linalg.norm(np.array(centres[1]) - np.array(centres[0])))
    if gap < 1e-9 * stage.size:
        gap = 8 * stage.unit
        centres[1] = place(np.array(centres[0]) + gap * _X)
    share = abs(ratio) if ratio else 1.0
    large = gap * share / (1 + share) if ratio < 0 or math.isclose(share, 1.0) else gap * share / abs(1 - share)
    radii = (large, large / share)
    count = TEETH / min(1.0, share, 1 / share)
    for k, (member, centre, radius) in enumerate(zip(members, centres, radii, strict=True)):
        teeth = max(6, round(min(count, 60) * radius / max(radii)))
        direction = np.array(centres[1 - k]) - np.array(centre)
        phase = math.atan2(direction[1], direction[0]) + (math.pi / teeth if k else 0.0)
        rim = carried_by(member, (np.array(centre) + p for p in _toothed(radius, teeth, phase)))
        yield Shape("area", rim, "body", stage.state_of_body(member), member)
        spoke = np.array([math.cos(phase), math.sin(phase), 0.0]) * radius * 0.85
        yield Shape("line", carried_by(member, (centre, np.array(centre) + spoke)), "guide")


def _toothed(radius: float, teeth: int, phase: float) -> Iterator[Array]:
    for k in range(4 * teeth):
        size = radius * (1 + (DEPTH if k % 4 in (0, 3) else -DEPTH))
        angle = phase + 2 * math.pi * (k + 0.5) / (4 * teeth)
        yield size * np.array([math.cos(angle), math.sin(angle), 0.0])


def _pin(stage: StagedScene, member: str, number: int) -> Place:
    """Return the position of a pin about which a body turns; without one, the body's origin."""
    for k, other in enumerate(stage.system.connections):
        at = stage.places[k]
        if k != number and member in other.members and other.facts.axial and at is not None:
            return at
    return stage.arrangement.point(stage.system.starts.get(member, ()))


def _wheel(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield a rolling body: a disc on a hatched line, or in space a ball on a plane."""
    body = connection.members[0]
    radius = radius_of(stage.scene, stage.arrangement, number)
    centre = stage.origin(body)
    middle, state = stage.here(centre), stage.state_of_body(body)
    if stage.flat:
        yield Shape("area", _rim(centre, radius, np.eye(3)[:2]), "body", state, body)
        half, foot = 2.2 * radius * _X, middle[0] * _X
        yield Shape("line", fixed(foot - half, foot + half), "ground")
        yield _hatched(stage, foot, half, _DOWN, 16)
        yield Shape("line", (centre, Vertex(body, place(np.array(centre.at) + radius * _UP))), "guide")
        yield Shape("ball", (centre,), "joint", size=0.3 * stage.unit)
        return
    corners = ((middle[0] + 2.2 * radius * x, middle[1] + 2.2 * radius * y) for x, y in SQUARE)
    yield Shape("area", fixed(*corners), "plane")
    yield Shape("ball", (centre,), "body", state, body, radius)
    for pair in ((0, 1), (0, 2), (1, 2)):
        yield Shape("line", _rim(centre, radius, np.eye(3)[list(pair)]), "guide")


def _rim(centre: Vertex, radius: float, frame: Array) -> tuple[Vertex, ...]:
    """Return a circle around ``centre`` in the plane of the two rows of ``frame``."""
    return carried_by(centre.carrier, (np.array(centre.at) + radius * (p[:2] @ frame) for p in circle(36, closed=True)))


_Draw = Callable[[StagedScene, int, Connection], Iterator[Shape]]
_RUNS: Mapping[Run, _Draw] = {
    "bar": _bar,
    "bars": _bar,
    "rope": _rope,
    "teeth": _teeth,
    "wheel": _wheel,
    "profile": profile,
    "locus": locus,
}
