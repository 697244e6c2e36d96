"""Positions of bodies and particles, and the infinitesimal motions there; for pictures only.

The positions are those of the reference configuration, or else some that satisfy the holonomic equations.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations, pairwise
from typing import NamedTuple

import networkx as nx
import numpy as np

from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import DT, TIME, Expr, coordinate, differential, parameter, velocity
from dofkit.motion.loops import by_pivots
from dofkit.motion.poses import euler_angles, from_euler, matrix_of
from dofkit.pictures.evaluation import derivatives, evaluated, kernel, values_at, with_unit_rows
from dofkit.pictures.placed_shapes import ShapePlacement, carrier_placements
from dofkit.pictures.shapes import AT_REST, Array, Displacement, Place, place
from dofkit.system import GROUND, PARTICLE_ROLES, Rotation, System

#: Rounds of Newton's method, the residual that counts as 0, and the number of starting points.
ROUNDS, MET, STARTS = 60, 1e-9, 8
#: The angle between successive points of a spiral that spreads points over a sphere.
GOLDEN = math.pi * (3 - math.sqrt(5))
#: The time at which a scene is drawn if its equations contain time and there is no reference.
MOMENT = 0.5
#: The most coordinates for which positions are computed from the equations.
MOST_COORDINATES = 400
#: The least displacement that counts as motion, relative to the step.
MOVES = 1e-5
EXAMPLES = "The scene gives no positions: those drawn are examples."
CHOSEN = "The scene gives no positions: those drawn were chosen to satisfy its constraints."
SCHEMATIC = "Schematic: no positions were found that satisfy all constraints."


@dataclass(frozen=True)
class Arrangement:
    """Numbers for all symbols of a system; ``note`` says where they come from, ``met`` whether the equations hold."""

    system: System
    numbers: Mapping[Expr, float]
    note: str | None
    met: bool
    placements: Mapping[str, ShapePlacement] = field(default_factory=dict)

    @cached_property
    def poses(self) -> dict[str, Displacement]:
        """The displacement of every carrier (body, particle or placed shape)."""
        return self.poses_at(self.numbers, gibbs=True)

    def poses_at(self, numbers: Mapping[Expr, float], *, gibbs: bool) -> dict[str, Displacement]:
        """Return the displacement of every carrier; ``gibbs``: rotations in ``numbers`` are in the system's charts."""
        poses = {GROUND: AT_REST, **_spatial_poses(self.system, numbers, gibbs)}
        values = dict(numbers)
        for r in (r for r in self.system.rotations if gibbs and r.chart == "gibbs"):
            turn = poses[r.body].turn @ _initial(r, numbers)
            values |= zip(map(coordinate, r.names), euler_angles(turn, [0.0, 0.0, 0.0]), strict=True)
        return poses | {name: placement.pose(values) for name, placement in self._moving.items()}

    @cached_property
    def _moving(self) -> dict[str, ShapePlacement]:
        return {name: placement for name, placement in self.placements.items() if placement.moves}

    def along(self, path: Iterable[Mapping[str, float]]) -> Iterator[dict[Expr, float]]:
        """Yield the numbers of all symbols at configurations, which have Euler angles for spatial bodies."""
        for q in path:
            yield {**self.numbers, **{TIME if n == TIME.args[1] else coordinate(n): v for n, v in q.items()}}

    @property
    def first_values(self) -> dict[str, float]:
        """{name: value} at which a motion begins: of parameters; without a reference of t and coordinates too."""
        values = {p: self.numbers[parameter(p)] for p in (*self.system.parameters, *self.system.generic)}
        if self.system.reference is None:
            values["t"] = self.numbers[TIME]
            turning = {n for r in self.system.rotations for n in r.names}
            names = [c.name for c in self.system.coordinates if c.name not in turning]
            values |= {n: self.numbers[coordinate(n)] for n in names if coordinate(n) in self.numbers}
        return values

    def number(self, e: Expr) -> float:
        """Return the value of an expression, 0 if it has none."""
        value = float(evaluated(e, self.numbers))
        return value if math.isfinite(value) else 0.0

    def point(self, at: Sequence[Expr]) -> Place:
        """Return a point of the reference configuration."""
        return place([self.number(e) for e in at])


def geometric_equations(system: System, senses: Sequence[str] = ("=",)) -> list[Expr]:
    """Return the relations of the given senses in which no velocities occur."""
    relations = (r for c in system.constraints for r in c.relations if r.sense in senses)
    return [r.expr for r in relations if all(s.args[0] in ("coordinate", "parameter", "time") for s in r.expr.symbols)]


def arrangement_of(system: System) -> Arrangement:
    """Return the reference configuration, else positions that satisfy the equations, else schematic positions."""
    numbers: dict[Expr, float] = {parameter(p): 1.0 for p in (*system.parameters, *system.generic)}
    equations = (r.expr for c in system.constraints for r in c.relations if r.sense == "=")
    driven = system.reference is None and any(TIME in e.symbols for e in equations)
    numbers[TIME] = MOMENT if driven else 0.0
    placements = carrier_placements(system)
    if system.reference is not None:
        return Arrangement(system, numbers | _finite_values(system.reference, numbers), None, True, placements)
    posed = _finite_values(system.pose, numbers)
    for seed in range(STARTS):
        solved = onto(system, numbers | _start(system, numbers, seed) | posed)
        if solved is not None:
            note = CHOSEN if any(c.relations for c in system.constraints) else EXAMPLES
            return Arrangement(system, solved, note, True, placements)
    return Arrangement(system, numbers | _start(system, numbers, 0) | posed, SCHEMATIC, False, placements)


def _finite_values(exprs: Mapping[Expr, Expr], numbers: Mapping[Expr, float]) -> dict[Expr, float]:
    return {s: v for s, e in exprs.items() if math.isfinite(v := float(evaluated(e, numbers)))}


def onto(system: System, numbers: Mapping[Expr, float]) -> dict[Expr, float] | None:
    """Return nearby numbers for coordinates and generic lengths that satisfy the equations, or None."""
    equations, limits = geometric_equations(system), geometric_equations(system, (">=", ">"))
    moving = [*(coordinate(c.name) for c in system.coordinates), *map(parameter, system.generic)]
    now = dict(numbers)
    if len(moving) > MOST_COORDINATES:
        return None
    for _ in range(ROUNDS):
        active = [*equations, *(e for e in limits if float(evaluated(e, now)) < 0)]
        residuals = values_at(active, now)
        rows = derivatives(active, moving, now)
        size = np.linalg.norm(rows, axis=1)
        if not np.all(np.isfinite(residuals)) or not np.all(np.isfinite(rows)):
            return None
        gap = residuals / np.where(size > 1e-9, size, 1.0)
        if not gap.size or float(np.max(np.abs(gap))) < MET:
            return now
        step = -np.linalg.lstsq(with_unit_rows(rows), gap, rcond=1e-9)[0]
        step *= min(1.0, 0.7 / max(float(np.linalg.norm(step)), 1e-12))
        now |= {s: now.get(s, 1.0) + float(d) for s, d in zip(moving, step, strict=True)}
    return None


def _start(system: System, numbers: Mapping[Expr, float], seed: int) -> dict[Expr, float]:
    """Return starting values of coordinates: particles by their links, others near 0; random for ``seed`` > 0."""
    rng = np.random.default_rng(seed)
    values = {coordinate(c.name): 0.6 - 0.2 * (k % 3) for k, c in enumerate(system.coordinates) if c.owner is None}
    for r in system.rotations:
        if r.chart == "euler":
            values |= {coordinate(n): a for n, a in zip(r.names, (0.4, 0.7, 0.2), strict=True)}
    for name, position in _initial_positions(system, numbers).items():
        names = [c.name for c in system.coordinates if c.owner == name]
        values |= {coordinate(n): float(v) for n, v in zip(names, position, strict=False)}
    if seed:
        values = {s: v + 0.5 * float(rng.standard_normal()) for s, v in values.items()}
    return values


def _initial_positions(system: System, numbers: Mapping[Expr, float]) -> dict[str, Array]:
    """Return {particle: starting position}: hanging chains, or the links as a graph spread by springs."""
    d = len(PARTICLE_ROLES[system.dimension])
    graph, fixed = _links(system)
    if not system.particles:
        return {}
    if len(system.particles) == 1 and not fixed:
        return {system.particles[0]: _lone(system, numbers, d)}
    if d == 1:
        return {name: np.array([1.0 + 1.5 * k]) for k, name in enumerate(system.particles)}
    if fixed and nx.is_forest(graph):
        return _hanging(graph, fixed, d)
    if not graph.edges:
        heights = [(2 * k + 1) / len(graph) - 1 if d == 3 else 0.0 for k in range(len(graph))]
        turn = GOLDEN if d == 3 else 2 * math.pi / len(graph)
        return {
            n: 1.5 * np.array([math.sqrt(1 - z * z) * math.cos(k * turn), math.sqrt(1 - z * z) * math.sin(k * turn), z])
            for k, (n, z) in enumerate(zip(graph, heights, strict=True))
        }
    if len(graph) > MOST_COORDINATES:
        return {str(n): np.append(p, 0.0) for n, p in nx.circular_layout(graph).items()}
    laid = nx.spring_layout(graph, dim=d, seed=7, pos=fixed or None, fixed=list(fixed) or None, scale=1.6)
    return {str(n): np.asarray(p) for n, p in laid.items() if n not in fixed}


def _lone(system: System, numbers: Mapping[Expr, float], d: int) -> Array:
    """Return a position for a single particle: below the origin if equations are satisfied as near there as above."""
    up = np.array([0.9, 0.7, 0.8])[:d]
    down = up * np.where(np.arange(d) == d - 1, -1.0, 1.0)
    symbols = [coordinate(c.name) for c in system.coordinates if c.owner == system.particles[0]]

    def gap(place: Array) -> float:
        solved = onto(system, {**numbers, **dict(zip(symbols, map(float, place), strict=False))})
        return math.inf if solved is None else math.dist([solved[s] for s in symbols], place)

    return down if geometric_equations(system) and gap(down) <= gap(up) + MET else up


def _links(system: System) -> tuple[nx.Graph, dict[str, list[float]]]:
    """Return (graph of particles and fixed points, {fixed point: position}), with an edge for each link."""
    graph = nx.Graph()
    graph.add_nodes_from(system.particles)
    fixed: dict[str, list[float]] = {}
    for connection in system.connections:
        nodes = []
        for point in connection.points:
            if point.particle:
                nodes.append(point.carrier)
            elif point.carrier == GROUND and point.at is not None:
                at = [float(evaluated(e, {})) for e in point.at]
                nodes.append(f"@{at}")
                fixed[nodes[-1]] = at
        if not connection.facts.shared:
            graph.add_edges_from(combinations(nodes, 2) if connection.facts.complete else pairwise(nodes))
    return graph, {name: at for name, at in fixed.items() if name in graph}


def _hanging(graph: nx.Graph, fixed: Mapping[str, Sequence[float]], d: int) -> dict[str, Array]:
    """Return chains that hang from fixed points, each particle lower than the one before and to one side."""
    down = np.array([0.45, -0.9]) if d == 2 else np.array([0.45, 0.3, -0.85])
    positions: dict[str, Array] = {n: np.array(p, dtype=float) for n, p in fixed.items()}
    for root in [*fixed, *graph]:
        positions.setdefault(root, np.array([1.0 + 0.8 * len(positions)] + [0.0] * (d - 1)))
        for parent, child in nx.bfs_edges(graph, root):
            tilt = np.array([(-1.0) ** len(positions), *[1.0] * (d - 1)])
            positions.setdefault(child, positions[parent] + down * tilt)
    return {n: p for n, p in positions.items() if n not in fixed}


# Poses


def _spatial_poses(system: System, numbers: Mapping[Expr, float], gibbs: bool) -> dict[str, Displacement]:
    """Return {spatial body: displacement from the reference} with the coordinates' values in ``numbers``.

    ``gibbs``: bodies with a Gibbs chart have Gibbs vectors there, as in the system; otherwise all have Euler angles.
    """
    poses = {}
    for r in system.rotations:
        at = np.array([numbers.get(coordinate(c.name), 0.0) for c in system.coordinates if c.owner == r.body])
        start = np.array(place([float(evaluated(e, numbers)) for e in system.starts[r.body]]))
        if gibbs and r.chart == "gibbs":
            quaternion = np.array([1.0, *at[3:]])
            turn = matrix_of(quaternion / np.linalg.norm(quaternion))
        else:
            turn = from_euler(*at[3:]) @ _initial(r, numbers).T
        poses[r.body] = Displacement(turn, at[:3] - turn @ start)
    return poses


def _initial(rotation: Rotation, numbers: Mapping[Expr, float]) -> Array:
    """Return the rotation of a body in the reference configuration."""
    return from_euler(*(float(evaluated(e, numbers)) for e in rotation.initial))


# Infinitesimal motions


class FreeMotion(NamedTuple):
    """An admissible velocity: the ``rates`` of all symbols; ``symbol``: the one that moves in no other free motion."""

    name: str
    symbol: Expr
    rates: Mapping[Expr, float]


def free_motions(arrangement: Arrangement, chosen: Sequence[str] = (), freedom: int | None = None) -> list[FreeMotion]:
    """Return independent infinitesimal motions; each moves one coordinate alone, of those ``chosen`` if possible.

    ``freedom``: their number, if it is known and time does not occur. If time occurs, it advances in the first motion,
    and driven parts move.
    """
    rows, columns = velocity_rows(arrangement.system, arrangement.numbers)
    timed = columns[-1:] == [TIME]
    basis = kernel(rows, len(columns), None if timed else freedom)
    names = [str(c.args[1]) for c in columns]
    order = [names.index("t")] if timed else []
    order += [names.index(n) for n in chosen if n in names]
    order += [k for k in range(len(names)) if k not in order]
    reduced, pivots = by_pivots(basis, order)
    turning = {
        name: f"{r.body} about {letter}"
        for r in arrangement.system.rotations
        if r.chart == "gibbs"
        for name, letter in zip(r.names, "xyz", strict=True)
    }
    titles = {**turning, "t": "time"} if timed else turning
    return [
        FreeMotion(titles.get(names[k], names[k]), columns[k], dict(zip(columns, map(float, row), strict=True)))
        for row, k in zip(reduced, pivots, strict=False)
    ]


def velocity_rows(system: System, numbers: Mapping[Expr, float]) -> tuple[Array, list[Expr]]:
    """Return (rows of the linear equations of velocities, columns: coordinates, then time if it occurs)."""
    columns = [coordinate(c.name) for c in system.coordinates]
    finite = geometric_equations(system)
    others = [r.expr for c in system.constraints for r in c.relations if r.sense == "=" and r.expr not in set(finite)]
    if any(TIME in e.symbols or DT in e.symbols for e in [*finite, *others]):
        columns.append(TIME)
    rates = [velocity(c.name) for c in system.coordinates]
    forms = [differential(c.name) for c in system.coordinates]
    rows = derivatives(others, rates, numbers) + derivatives(others, forms, numbers)
    if columns[-1:] == [TIME]:
        constant = derivatives(others, [DT], numbers) + values_at(others, numbers).reshape(-1, 1)
        rows = np.hstack([rows, np.nan_to_num(constant)])
    return np.vstack([derivatives(finite, columns, numbers), rows]), columns


def is_linear(system: System) -> bool:
    """Return whether all relations with velocities are linear in them."""
    written = [r.expr for c in system.constraints for r in c.relations]
    slopes = (diff(e, s) for e in written for s in e.symbols if s.args[0] == "velocity")
    return not any(s.args[0] == "velocity" for slope in slopes for s in slope.symbols)


def movers(arrangement: Arrangement, motions: Sequence[FreeMotion]) -> frozenset[str]:
    """Return the bodies and particles that some motion moves."""
    moving: set[str] = set()
    for motion in motions:
        for name, pose in displaced(arrangement, motion, 1e-3).items():
            here = arrangement.poses[name]
            if np.linalg.norm(pose.turn - here.turn) + np.linalg.norm(pose.shift - here.shift) > 1e-3 * MOVES:
                moving.add(name)
    return frozenset(moving)


def displaced(arrangement: Arrangement, motion: FreeMotion, far: float) -> dict[str, Displacement]:
    """Return where every carrier is after a step along a motion."""
    return arrangement.poses_at(moved_numbers(arrangement, motion, far), gibbs=True)


def moved_numbers(arrangement: Arrangement, motion: FreeMotion, far: float) -> dict[Expr, float]:
    """Return the numbers after a step along a motion."""
    moved = {s: arrangement.numbers.get(s, 0.0) + far * rate for s, rate in motion.rates.items()}
    return {**arrangement.numbers, **moved}
