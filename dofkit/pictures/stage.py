"""A scene prepared for drawing: places of its joints, sizes of symbols, what moves, states of constraints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import networkx as nx
import numpy as np

from dofkit.pictures.arrangement import (
    EXAMPLES,
    Arrangement,
    FreeMotion,
    arrangement_of,
    free_motions,
    geometric_equations,
    is_linear,
    movers,
)
from dofkit.pictures.evaluation import exemplified
from dofkit.pictures.placed_shapes import picture_shapes, placements_of
from dofkit.pictures.recognition import recognised
from dofkit.pictures.shapes import AT_REST, Array, Place, State, Vertex, place
from dofkit.pictures.words import can_hold, meanings, state_of
from dofkit.report import Report
from dofkit.scene.lowering import lower
from dofkit.scene.names import vocabulary_of
from dofkit.scene.parts import BodyPoint, Force, Particle
from dofkit.scene.picture import PlacedPicture, picture_of
from dofkit.scene.scene import Scene
from dofkit.scene.symbols import Symbol
from dofkit.system import GROUND, Connection, System

#: A symbol's size by the picture's size, by the least distance between points, and its least size.
SYMBOL, CROWDED, LEAST = 0.032, 0.2, 0.014
#: The distance, in symbols, between joints whose positions are free.
APART = 7.0
#: The name of the particle whose position is the configuration of a scene of coordinates.
POINT = "configuration"
#: The most coordinates for which motions are computed.
MOST_COLUMNS = 300
TOO_MANY = f"More than {MOST_COLUMNS} coordinates: which parts move was not determined."
NOT_LINEAR = "A constraint is nonlinear in the velocities: individual motions are not shown."
#: Displacements (to the side, upwards) that are tried for a joint whose position is occupied.
_ASIDE = ((0, 0), (0, 1), (1, 0), (1, 1), (0, -1), (-1, 0), (2, 0), (0, 2))


@dataclass(frozen=True)
class StagedScene:
    """A scene with positions, sizes and motions.

    ``places``: the place of each constraint's symbol in the reference configuration (None: it has none); ``unit``: the
    size of symbols; ``size``: that of the system; ``schematic``: whether some positions are invented; ``measurable``:
    whether lengths mean something; ``unseen``: why motions were not computed, or None.
    """

    scene: Scene
    report: Report
    arrangement: Arrangement
    places: tuple[Place | None, ...]
    motions: tuple[FreeMotion, ...]
    moving: frozenset[str]
    unit: float
    size: float
    centre: Place
    schematic: bool
    measurable: bool
    unseen: str | None
    picture: PlacedPicture

    @property
    def system(self) -> System:
        """The scene's mathematics."""
        return self.arrangement.system

    @property
    def flat(self) -> bool:
        """Whether the world is at most a plane."""
        return self.system.dimension < 3

    @property
    def title(self) -> str:
        """The scene's title, or its name."""
        return self.scene.title or self.scene.name

    def symbol(self, number: int) -> Symbol:
        """Return the symbol of the constraint of a number."""
        return self.scene.constraints[number].symbol

    def state(self, name: str) -> State:
        """Return the state of a constraint according to the report."""
        return state_of(self.report, name)

    def state_of_body(self, name: str) -> State:
        """Return whether a body or particle moves."""
        return "moving" if name in self.moving else "plain"

    @property
    def meanings(self) -> Mapping[State, str]:
        """{state: text of the legend}."""
        return meanings(self.report, self.unseen is None and can_hold(self.report))

    def here(self, vertex: Vertex) -> Array:
        """Return the position of a vertex."""
        return self.arrangement.poses.get(vertex.carrier, AT_REST).moved(vertex.at)

    def vertices(self, connection: Connection) -> Iterator[Vertex]:
        """Yield the points that a constraint mentions, if they are known."""
        yield from vertices_of(self.arrangement, connection)

    def origin(self, carrier: str) -> Vertex:
        """Return the origin of a body, or a particle."""
        starts = self.system.starts
        return Vertex(carrier, self.arrangement.point(starts[carrier]) if carrier in starts else (0.0, 0.0, 0.0))

    def position(self, number: int, member: str) -> Array:
        """Return the place of a symbol in the frame of a member; on a slide it is where the sliding point is."""
        connection, at = self.system.connections[number], np.array(self.places[number] or (0.0, 0.0, 0.0))
        if any(p.carrier == member and p.particle for p in connection.points):
            return np.zeros(3)
        vertex = next(self.vertices(connection), None)
        if vertex is None or not connection.facts.slides:
            return at
        axis = axis_of(self.arrangement, connection, 0)
        there = np.array(self.carried(member, self.here(vertex)).at)
        return np.asarray(at + axis * float(axis @ (there - at)))

    def carried(self, carrier: str, point: Sequence[float] | Array) -> Vertex:
        """Return the vertex of a carrier that is now at a point of the world."""
        return Vertex(carrier, self.arrangement.poses.get(carrier, AT_REST).back(point))


def vertices_of(arrangement: Arrangement, connection: Connection) -> Iterator[Vertex]:
    """Yield the points that a constraint mentions, if they are known."""
    for point in connection.points:
        if point.particle:
            yield Vertex(point.carrier, (0.0, 0.0, 0.0))
        elif point.at is not None:
            yield Vertex(point.carrier, arrangement.point(point.at))


def force_ends(arrangement: Arrangement, force: Force) -> Iterator[Vertex]:
    """Yield the ends of a force between points, if they are known."""
    system = arrangement.system
    for end in force.between or ():
        carrier, at = (end.on, end.at) if isinstance(end, BodyPoint) else (GROUND, end)
        if isinstance(end, str) and (end in system.starts or end in system.particles):
            yield Vertex(end, arrangement.point(system.starts[end]) if end in system.starts else (0.0, 0.0, 0.0))
        elif not any(isinstance(number, str) for number in at):
            yield Vertex(carrier, place(float(number) for number in at))


def stage_of(scene: Scene, report: Report) -> StagedScene:
    """Return a scene with its positions. Raises SceneError as `lower` does."""
    system = exemplified(lower(scene))
    picture = picture_of(scene, vocabulary_of(scene), [])
    if not (system.bodies or system.particles or picture.shapes):
        picture = recognised(system) or picture
        if not picture.shapes and has_set(system):
            system = exemplified(lower(as_particle(scene)))
    arrangement = arrangement_of(system)
    arrangement = replace(arrangement, placements={**arrangement.placements, **placements_of(picture)})
    written = [_written_place(arrangement, c) for c in system.connections]
    points = _points(scene, arrangement, written)
    sizes = [s for s in picture_shapes(picture, arrangement.numbers, 0.0) if s.kind != "words"]
    drawn = [arrangement.poses.get(v.carrier, AT_REST).moved(v.at) for s in sizes for v in s.vertices]
    size, _ = _extent([*points, *drawn])
    unit = _unit(points, size)
    points += drawn
    places, schematic = _all_places(scene, arrangement, written, unit)
    size, centre = _extent([*points, *(p for p, w in zip(places, written, strict=True) if p and w is None)])
    unseen = None if is_linear(system) else NOT_LINEAR
    if len(system.coordinates) > MOST_COLUMNS:
        unseen = TOO_MANY
    motions = () if unseen or not can_hold(report) else _motions(arrangement, report)
    apart = len({tuple(np.round(p, 9)) for p in points}) > 1
    invented = schematic or system.generic or arrangement.note == EXAMPLES
    return StagedScene(
        scene=scene,
        report=report,
        arrangement=arrangement,
        places=tuple(places),
        motions=motions,
        moving=movers(arrangement, motions),
        unit=unit,
        size=size,
        centre=centre,
        schematic=schematic,
        measurable=apart and arrangement.met and not invented,
        unseen=unseen,
        picture=picture,
    )


def has_set(system: System) -> bool:
    """Return whether a scene of two or three coordinates has a configuration set that can be drawn."""
    count = len(system.coordinates)
    return (count == 2 and bool(system.constraints)) or (count == 3 and bool(geometric_equations(system)))


def as_particle(scene: Scene) -> Scene:
    """Return a scene of two or three coordinates as one of a particle that has them."""
    particle = Particle(name=POINT, coordinates=scene.coordinates, at=None, mass=None)
    return scene.model_copy(update={"particles": (particle,), "coordinates": (), "dimension": len(scene.coordinates)})


def _motions(arrangement: Arrangement, report: Report) -> tuple[FreeMotion, ...]:
    referred = arrangement.system.reference is not None
    freedom = report.instantaneous_dof if referred else report.velocity_dof
    return tuple(free_motions(arrangement, report.generalized_coordinates or (), freedom))


def _written_place(arrangement: Arrangement, connection: Connection) -> Place | None:
    """Return the position that the scene gives a connection, else that of its first vertex, or None."""
    for at in connection.places:
        if at is not None:
            return arrangement.point(at)
    return next((vertex.at for vertex in vertices_of(arrangement, connection)), None)


def _points(scene: Scene, arrangement: Arrangement, written: Sequence[Place | None]) -> list[Array]:
    """Return the positions of all points of the scene, with the rims of wheels."""
    poses = arrangement.poses
    points = [poses[p].moved((0.0, 0.0, 0.0)) for p in arrangement.system.particles]
    points += [poses[v.carrier].moved(v.at) for force in scene.forces for v in force_ends(arrangement, force)]
    for number, (connection, at) in enumerate(zip(arrangement.system.connections, written, strict=True)):
        points += [poses[v.carrier].moved(v.at) for v in vertices_of(arrangement, connection)]
        body = next((m for m in connection.members if m in arrangement.system.bodies), None)
        if at is not None and connection.places and body is not None:
            points.append(poses[body].moved(at))
        radius = radius_of(scene, arrangement, number)
        if radius and body is not None:
            middle = poses[body].moved(arrangement.point(arrangement.system.starts[body]))
            points += [middle + radius * np.array(direction) for direction in ((1, 1, 0), (-1, -1, 0))]
    return points


def radius_of(scene: Scene, arrangement: Arrangement, number: int) -> float:
    """Return the radius of a rolling wheel, from its first relation height - radius = 0; 0 for other constraints."""
    if not scene.constraints[number].symbol.size:
        return 0.0
    contact = arrangement.system.constraints[number].relations[0].expr
    height = [s for s in contact.symbols if s.args[0] == "coordinate"]
    flat = {**arrangement.numbers, **dict.fromkeys(height, 0.0)}
    return -Arrangement(arrangement.system, flat, None, True).number(contact)


def _extent(points: Sequence[Array | Place]) -> tuple[float, Place]:
    """Return (largest side, centre) of the bounding box of points."""
    if not points:
        return 1.0, (0.0, 0.0, 0.0)
    low, high = np.min(np.array(points), axis=0), np.max(np.array(points), axis=0)
    size = float(np.max(high - low))
    return (size if size > 1e-9 else 1.0), place((low + high) / 2)


def _unit(points: Sequence[Array], size: float) -> float:
    """Return the size of symbols, smaller where points are close."""
    distinct = np.unique(np.round(np.array(points) / size, 6), axis=0) * size if points else np.zeros((0, 3))
    if len(distinct) < 2:
        return 0.055 * size
    gaps = np.linalg.norm(distinct[:, None] - distinct[None], axis=2) if len(distinct) < 600 else np.full((1, 1), size)
    least = float(np.min(gaps[gaps > 1e-9 * size], initial=size))
    return float(np.clip(CROWDED * least, LEAST * size, SYMBOL * size))


def _all_places(
    scene: Scene, arrangement: Arrangement, written: Sequence[Place | None], unit: float
) -> tuple[list[Place | None], bool]:
    """Return (place of every constraint's symbol, whether the graph was laid out instead of geometry).

    ``written``: the places that the scene gives; every other symbol is put near the bodies that it joins, apart from
    the others.
    """
    places = list(written)
    system = arrangement.system
    symbols = [constraint.symbol for constraint in scene.constraints]
    free = [k for k, c in enumerate(system.connections) if places[k] is None and c.members and symbols[k].run == ""]
    laid = {} if any(at is not None for at in places) else _layout(system, free, unit)
    taken: list[Place] = []
    for k in free:
        connection = system.connections[k]
        base, pinned = _neighbour(arrangement, connection, places, k)
        wanted = laid.get(k, base)
        if symbols[k].rails and base is not None and not pinned:
            wanted = place(np.array(base) + APART * unit * axis_of(arrangement, connection, 0))
        taken.append(_clear(wanted or (0.0, 0.0, 0.0), taken, APART * unit, system.dimension))
        places[k] = taken[-1]
    return places, bool(laid) and bool(system.generic)


def _layout(system: System, free: Sequence[int], unit: float) -> dict[int, Place]:
    """Return {number: place} of free joints: the graph of bodies and joints spread by springs; {} if too many."""
    graph = nx.Graph()
    for k in free:
        graph.add_edges_from((k, m) for m in system.connections[k].members)
    if not 1 < len(free) <= MOST_COLUMNS:
        return {}
    laid = nx.spring_layout(graph, dim=max(2, system.dimension), seed=3, scale=3.2 * unit * max(3, len(free)))
    return {k: place(laid[k]) for k in free}


def _neighbour(
    arrangement: Arrangement, connection: Connection, places: Sequence[Place | None], number: int
) -> tuple[Place | None, bool]:
    """Return (a place on a body of the joint or None, whether a pin is there)."""
    for member in reversed([m for m in connection.members if m != GROUND]):
        for k, other in enumerate(arrangement.system.connections):
            if k != number and places[k] is not None and member in other.members:
                return places[k], other.facts.axial
    body = next((m for m in connection.members if m in arrangement.system.starts), None)
    return (None, False) if body is None else (arrangement.point(arrangement.system.starts[body]), True)


def _clear(wanted: Place, taken: Sequence[Place], gap: float, dimension: int) -> Place:
    """Return a place near ``wanted`` at a distance of about ``gap`` from the places ``taken``."""
    up = np.array([0.0, 1.0, 0.0]) if dimension == 2 else np.array([0.0, 0.0, 1.0])
    side = np.array([1.0, 0.0, 0.0])
    for scale in (1.0, 2.0, 3.0, 4.0):
        for w, h in _ASIDE:
            position = np.array(wanted) + gap * scale * (w * side + h * up)
            if all(np.linalg.norm(position - np.array(other)) > 0.9 * gap for other in taken):
                return place(position)
    return place(np.array(wanted) + gap * len(taken) * side)


def axis_of(arrangement: Arrangement, connection: Connection, number: int) -> Array:
    """Return a unit direction of a joint in the reference configuration; a default one if none is given."""
    direction = connection.directions[number] if number < len(connection.directions) else None
    plane, space = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    usual = plane if arrangement.system.dimension < 3 else space
    axis = np.array(usual[min(number, 1)] if direction is None else arrangement.point(direction))
    size = float(np.linalg.norm(axis))
    return axis / size if size > 1e-12 else np.array(usual[0])


def carriers(connection: Connection) -> Mapping[int, str]:
    """Return {number: member}, with the ground first, because rails and sockets of a symbol belong to it."""
    members = list(connection.members)
    if len(members) > 1 and members[1] == GROUND and not connection.points:
        members[:2] = members[1::-1]
    return dict(enumerate(members))
