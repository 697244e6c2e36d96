"""What is known of a scene before it is drawn: where its joints are, how large its symbols, what the report says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import networkx as nx
import numpy as np

from dofkit.pictures.arrangement import EXAMPLES, Arrangement, arrangement_of
from dofkit.pictures.rates import FreeMotion, free_motions, is_linear, movers
from dofkit.pictures.shapes import AT_REST, Array, Place, State, Vertex, place
from dofkit.pictures.states import can_hold, meanings, state_of
from dofkit.report import Report
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.scene.symbols import Symbol
from dofkit.system import GROUND, Connection, System

#: A symbol's size by the picture's; and by the least distance between places.
SYMBOL, CROWDED, LEAST = 0.032, 0.2, 0.014
#: Joints whose place is free keep so many symbols apart.
APART = 7.0
#: More coordinates than this, and what moves is not looked for.
MOST_COLUMNS = 300
TOO_MANY = f"More than {MOST_COLUMNS} coordinates: which parts move was not determined."
NOT_LINEAR = "A constraint is nonlinear in the velocities: individual motions are not shown."


@dataclass(frozen=True)
class StagedScene:
    """A scene with its places. ``places``: of each constraint's symbol in the drawing (None: it has none); ``unit``:
    the size of symbols, ``size`` that of the whole, ``schematic``: some places are made up; ``measurable``: lengths
    mean something; ``unseen``: why it was not looked for what moves.
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

    @property
    def system(self) -> System:
        """The scene's mathematics."""
        return self.arrangement.system

    @property
    def flat(self) -> bool:
        """Is the world at most a plane?"""
        return self.system.dimension < 3

    def symbol(self, number: int) -> Symbol:
        """How the constraint of a number is drawn."""
        return self.scene.constraints[number].symbol

    def state(self, name: str) -> State:
        """What the report says of a constraint."""
        return state_of(self.report, name)

    def state_of_body(self, name: str) -> State:
        """Does a body or particle move?"""
        return "moving" if name in self.moving else "plain"

    @property
    def meanings(self) -> Mapping[State, str]:
        """What the legend says of states."""
        return meanings(self.report, self.unseen is None and can_hold(self.report))

    def here(self, vertex: Vertex) -> Array:
        """Where a vertex is."""
        return self.arrangement.poses.get(vertex.carrier, AT_REST).moved(vertex.at)

    def vertices(self, connection: Connection) -> Iterator[Vertex]:
        """The points that a constraint mentions, where they are known."""
        yield from vertices_of(self.arrangement, connection)

    def spot(self, number: int, member: str) -> Array:
        """Where a symbol stands in the drawing of a member: particles are their own place, rails about the point."""
        connection, at = self.system.connections[number], np.array(self.places[number] or (0.0, 0.0, 0.0))
        if any(p.carrier == member and p.particle for p in connection.points):
            return np.zeros(3)
        vertex = next(self.vertices(connection), None)
        if vertex is None or not connection.facts.slides:
            return at
        axis = axis_of(self.arrangement, connection, 0)
        there = np.array(self.carried(member, place(self.here(vertex))).at)
        return np.asarray(at + axis * float(axis @ (there - at)))

    def carried(self, carrier: str, point: Sequence[float]) -> Vertex:
        """The vertex of a carrier that is now at a point of the world."""
        return Vertex(carrier, self.arrangement.poses.get(carrier, AT_REST).back(point))


def vertices_of(arrangement: Arrangement, connection: Connection) -> Iterator[Vertex]:
    """The points that a constraint mentions, where they are known."""
    for point in connection.points:
        if point.particle:
            yield Vertex(point.carrier, (0.0, 0.0, 0.0))
        elif point.at is not None:
            yield Vertex(point.carrier, arrangement.point(point.at))


def stage_of(scene: Scene, report: Report) -> StagedScene:
    """Look at a scene. Raises SceneError as `lower` does."""
    system = lower(scene)
    arrangement = arrangement_of(system)
    given = [_given_place(arrangement, c) for c in system.connections]
    known = _known_points(scene, arrangement, given)
    size, centre = _extent(known)
    unit = _unit(known, size)
    places, schematic = _all_places(scene, arrangement, given, unit)
    size, centre = _extent([*known, *(p for p, told in zip(places, given, strict=True) if p and told is None)])
    unseen = _unseen(arrangement)
    motions = () if unseen or not can_hold(report) else _motions(arrangement, report)
    apart = len({tuple(np.round(p, 9)) for p in known}) > 1
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
        measurable=apart and arrangement.met and not (schematic or system.generic or arrangement.note == EXAMPLES),
        unseen=unseen,
    )


def _unseen(arrangement: Arrangement) -> str | None:
    """Why it is not looked for what moves, where it is not."""
    if len(arrangement.system.coordinates) > MOST_COLUMNS:
        return TOO_MANY
    return None if is_linear(arrangement) else NOT_LINEAR


def _motions(arrangement: Arrangement, report: Report) -> tuple[FreeMotion, ...]:
    drawn = arrangement.system.reference is not None
    freedom = report.instantaneous_dof if drawn else report.velocity_dof
    return tuple(free_motions(arrangement, report.generalized_coordinates or (), freedom))


def _given_place(arrangement: Arrangement, connection: Connection) -> Place | None:
    """Where the drawing puts a constraint's symbol."""
    for at in connection.places:
        if at is not None:
            return arrangement.point(at)
    for vertex in vertices_of(arrangement, connection):
        return vertex.at
    return None


def _known_points(scene: Scene, arrangement: Arrangement, given: Sequence[Place | None]) -> list[Array]:
    """The places of the drawing where they are now, wheels with their rims."""
    found = [arrangement.poses[p].moved((0.0, 0.0, 0.0)) for p in arrangement.system.particles]
    for number, (connection, at) in enumerate(zip(arrangement.system.connections, given, strict=True)):
        found += [arrangement.poses[v.carrier].moved(v.at) for v in vertices_of(arrangement, connection)]
        body = next((m for m in connection.members if m in arrangement.system.bodies), None)
        if at is not None and connection.places and body is not None:
            found.append(arrangement.poses[body].moved(at))
        radius = radius_of(scene, arrangement, number)
        if radius and body is not None:
            middle = arrangement.poses[body].moved(arrangement.point(arrangement.system.starts[body]))
            found += [middle + radius * np.array(way) for way in ((1, 1, 0), (-1, -1, 0))]
    return found


def radius_of(scene: Scene, arrangement: Arrangement, number: int) -> float:
    """The radius of a wheel that rolls, as the first relation (height less radius) has it; 0 for what is none."""
    if not scene.constraints[number].symbol.size:
        return 0.0
    contact = arrangement.system.constraints[number].relations[0].expr
    height = [s for s in contact.symbols if s.args[0] == "coordinate"]
    flat = {**arrangement.numbers, **dict.fromkeys(height, 0.0)}
    return -Arrangement(arrangement.system, flat, None, True).number(contact)


def _extent(points: Sequence[Array | Place]) -> tuple[float, Place]:
    """The largest side of the box around points, and its middle."""
    if not points:
        return 1.0, (0.0, 0.0, 0.0)
    low, high = np.min(np.array(points), axis=0), np.max(np.array(points), axis=0)
    size = float(np.max(high - low))
    return (size if size > 1e-9 else 1.0), place((low + high) / 2)


def _unit(points: Sequence[Array], size: float) -> float:
    """The size of symbols: smaller where places crowd."""
    distinct = np.unique(np.round(np.array(points) / size, 6), axis=0) * size if points else np.zeros((0, 3))
    if len(distinct) < 2:
        return 0.055 * size
    gaps = np.linalg.norm(distinct[:, None] - distinct[None], axis=2) if len(distinct) < 600 else np.full((1, 1), size)
    least = float(np.min(gaps[gaps > 1e-9 * size], initial=size))
    return float(np.clip(CROWDED * least, LEAST * size, SYMBOL * size))


def _all_places(
    scene: Scene, arrangement: Arrangement, given: Sequence[Place | None], unit: float
) -> tuple[list[Place | None], bool]:
    """The place of every symbol; what the drawing leaves free is put beside what it joins."""
    places = list(given)
    system = arrangement.system
    free = [
        k
        for k, c in enumerate(system.connections)
        if places[k] is None and c.members and scene.constraints[k].symbol.run == ""
    ]
    drawn = any(at is not None for at in places)
    laid = {} if drawn else _layout(system, free, unit)
    taken: list[Place] = []
    for k in free:
        connection = system.connections[k]
        base, pinned = _beside(arrangement, connection, places, k)
        wanted = laid.get(k, base)
        if scene.constraints[k].symbol.rails and base is not None and not pinned:
            axis = axis_of(arrangement, connection, 0)
            wanted = place(np.array(base) + APART * unit * axis)
        places[k] = _clear(wanted or (0.0, 0.0, 0.0), taken, APART * unit, system.dimension)
        taken.append(places[k] or (0.0, 0.0, 0.0))
    return places, bool(laid) and bool(system.generic)


def _layout(system: System, free: Sequence[int], unit: float) -> dict[int, Place]:
    """Places of joints where nothing is drawn: bodies and joints as a graph, spread by springs."""
    graph = nx.Graph()
    for k in free:
        graph.add_edges_from((k, m) for m in system.connections[k].members)
    if not 1 < len(free) <= MOST_COLUMNS:
        return {}
    laid = nx.spring_layout(graph, dim=max(2, system.dimension), seed=3, scale=3.2 * unit * max(3, len(free)))
    return {k: place(laid[k]) for k in free}


def _beside(
    arrangement: Arrangement, connection: Connection, places: Sequence[Place | None], number: int
) -> tuple[Place | None, bool]:
    """A place of the moved body, and whether a pin is there."""
    others = arrangement.system.connections
    for member in reversed([m for m in connection.members if m != GROUND]):
        for k, other in enumerate(others):
            if k != number and places[k] is not None and member in other.members:
                return places[k], other.facts.axial
    body = next((m for m in connection.members if m in arrangement.system.starts), None)
    return (None, False) if body is None else (arrangement.point(arrangement.system.starts[body]), True)


def _clear(wanted: Place, taken: Sequence[Place], gap: float, dimension: int) -> Place:
    """The place nearest to what is wanted that keeps clear of others."""
    up = np.array([0.0, 1.0, 0.0]) if dimension == 2 else np.array([0.0, 0.0, 1.0])
    side = np.array([1.0, 0.0, 0.0])
    ways = [w * side + h * up for w, h in ((0, 0), (0, 1), (1, 0), (1, 1), (0, -1), (-1, 0), (2, 0), (0, 2))]
    for scale in (1.0, 2.0, 3.0, 4.0):
        for way in ways:
            spot = np.array(wanted) + gap * scale * way
            if all(np.linalg.norm(spot - np.array(other)) > 0.9 * gap for other in taken):
                return place(spot)
    return place(np.array(wanted) + gap * len(taken) * side)


def axis_of(arrangement: Arrangement, connection: Connection, number: int) -> Array:
    """A direction of a joint in the drawing: of length 1, and of some way where it is left open."""
    given = connection.directions[number] if number < len(connection.directions) else None
    usual = (
        [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)] if arrangement.system.dimension < 3 else [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    )
    axis = np.array(usual[min(number, 1)] if given is None else arrangement.point(given))
    size = float(np.linalg.norm(axis))
    return axis / size if size > 1e-12 else np.array(usual[0])


def carriers(connection: Connection) -> Mapping[int, str]:
    """The members by number, what is held by the ground second: rails and sockets are the ground's."""
    members = list(connection.members)
    if len(members) > 1 and members[1] == GROUND and not connection.points:
        members[:2] = members[1::-1]
    return dict(enumerate(members))
