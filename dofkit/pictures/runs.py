"""What constraints draw besides symbols: bars, strings over pulleys, gears, wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations, pairwise

import numpy as np

from dofkit.pictures.loci import locus, profile
from dofkit.pictures.shapes import Array, Place, Shape, State, Vertex, place
from dofkit.pictures.stage import StagedScene, radius_of
from dofkit.pictures.symbols import hatching, stand
from dofkit.scene.symbols import Run
from dofkit.system import GROUND, Connection

#: Teeth of the smaller wheel of a pair, and the depth of a tooth by its radius.
TEETH, DEPTH = 14, 0.07


def run_shapes(stage: StagedScene, number: int) -> Iterator[Shape]:
    """What a constraint draws besides strokes."""
    draw = _RUNS.get(stage.symbol(number).run)
    if draw is not None:
        name = stage.system.constraints[number].name
        for shape in draw(stage, number, stage.system.connections[number]):
            own = shape.role == "body"
            yield shape if own else shape._replace(owner=name, state=stage.state(name))


def _bar(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Bars between its points, with a ring at each end; along a line they are bows, so that they can be told apart."""
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
    """A line over small pulleys."""
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
            above = np.array(point.at) + np.array([0.0, (1.6 if inner else 0.0) * stage.unit, 0.0])
            half = np.array([1.2 * stage.unit, 0.0, 0.0])
            yield Shape("line", (Vertex(GROUND, place(above - half)), Vertex(GROUND, place(above + half))), "ground")
            yield hatching(stage, above, half, np.array([0.0, 1.0, 0.0]), 5)
            yield Shape("line", (Vertex(GROUND, place(above)), point), "ground")
        elif point.carrier == GROUND:
            yield from stand(stage, point.at)


def _teeth(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Two toothed wheels about the pins of their bodies, of radii by the ratio."""
    members = connection.members[:2]
    ratio = 1.0 if connection.number is None else stage.arrangement.number(connection.number)
    centres = [_pin(stage, m, number) for m in members]
    gap = float(np.linalg.norm(np.array(centres[1]) - np.array(centres[0])))
    if gap < 1e-9 * stage.size:
        gap = 8 * stage.unit
        centres[1] = place(np.array(centres[0]) + np.array([gap, 0.0, 0.0]))
    share = abs(ratio) if ratio else 1.0
    large = gap * share / (1 + share) if ratio < 0 or math.isclose(share, 1.0) else gap * share / abs(1 - share)
    radii = (large, large / share)
    count = TEETH / min(1.0, share, 1 / share)
    for k, (member, centre, radius) in enumerate(zip(members, centres, radii, strict=True)):
        teeth = max(6, round(min(count, 60) * radius / max(radii)))
        way = np.array(centres[1 - k]) - np.array(centre)
        phase = math.atan2(way[1], way[0]) + (math.pi / teeth if k else 0.0)
        rim = tuple(Vertex(member, place(np.array(centre) + p)) for p in _toothed(radius, teeth, phase))
        yield Shape("area", rim, "body", stage.state_of_body(member), member)
        spoke = np.array([math.cos(phase), math.sin(phase), 0.0]) * radius * 0.85
        yield Shape("line", (Vertex(member, centre), Vertex(member, place(np.array(centre) + spoke))), "guide")


def _toothed(radius: float, teeth: int, phase: float) -> list[Array]:
    spots = []
    for k in range(4 * teeth):
        size = radius * (1 + (DEPTH if k % 4 in (0, 3) else -DEPTH))
        angle = phase + 2 * math.pi * (k + 0.5) / (4 * teeth)
        spots.append(size * np.array([math.cos(angle), math.sin(angle), 0.0]))
    return spots


def _pin(stage: StagedScene, member: str, number: int) -> Place:
    """The pin about which a body turns; else where it begins."""
    for k, other in enumerate(stage.system.connections):
        at = stage.places[k]
        if k != number and member in other.members and other.facts.axial and at is not None:
            return at
    return stage.arrangement.point(stage.system.starts.get(member, ()))


def _wheel(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """A disc on a hatched line; in space a ball on a plane."""
    body = connection.members[0]
    radius = radius_of(stage.scene, stage.arrangement, number)
    centre = stage.arrangement.point(stage.system.starts[body])
    middle = stage.here(Vertex(body, centre))
    if stage.flat:
        rim = _circle(body, centre, radius, np.eye(3)[:2], stage.state_of_body(body))
        yield rim._replace(role="body", owner=body)
        half, foot = np.array([2.2 * radius, 0.0, 0.0]), np.array([middle[0], 0.0, 0.0])
        yield Shape("line", tuple(Vertex(GROUND, place(foot + s * half)) for s in (-1, 1)), "ground")
        yield hatching(stage, foot, half, np.array([0.0, -1.0, 0.0]), 16)
        spoke = Vertex(body, place(np.array(centre) + np.array([0.0, radius, 0.0])))
        yield Shape("line", (Vertex(body, centre), spoke), "guide")
        yield Shape("ball", (Vertex(body, centre),), "joint", size=0.3 * stage.unit)
        return
    yield ground_plane(middle, 2.2 * radius)
    yield Shape("ball", (Vertex(body, centre),), "body", stage.state_of_body(body), body, radius)
    for first, second in ((0, 1), (0, 2), (1, 2)):
        yield _circle(body, centre, radius, np.eye(3)[[first, second]], "plain")._replace(kind="line")


def _circle(carrier: str, centre: Place, radius: float, frame: Array, state: State) -> Shape:
    angles = [2 * math.pi * k / 36 for k in range(37)]
    spots = (np.array(centre) + radius * (math.cos(a) * frame[0] + math.sin(a) * frame[1]) for a in angles)
    return Shape("area", tuple(Vertex(carrier, place(s)) for s in spots), "guide", state)


def ground_plane(middle: Array, half: float) -> Shape:
    """A patch of the plane z = 0 below a point."""
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return Shape(
        "area", tuple(Vertex(GROUND, (middle[0] + x * half, middle[1] + y * half, 0.0)) for x, y in corners), "plane"
    )


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
