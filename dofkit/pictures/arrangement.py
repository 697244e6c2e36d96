"""Where everything stands: the drawing's own places, or some that meet the finite relations; for pictures only."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise

import networkx as nx
import numpy as np

from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import TIME, Expr, coordinate, parameter
from dofkit.motion.sampled.configurations import configurations
from dofkit.pictures.evaluation import derivatives, evaluated, values_at, with_unit_rows
from dofkit.pictures.shapes import AT_REST, Array, Displacement, Place, place
from dofkit.system import GROUND, PARTICLE_ROLES, Coordinate, System

#: Rounds of Newton's method, the residual that is as good as 0, and how many beginnings are tried.
ROUNDS, MET, STARTS = 60, 1e-9, 8
#: More coordinates than this are not moved onto the relations.
MOST_COORDINATES = 400
#: What carries the point that stands for the configuration, where there is nothing but coordinates.
POINT = "configuration"
EXAMPLES = "The scene gives no positions: those drawn are examples."
CHOSEN = "The scene gives no positions: those drawn were chosen to satisfy its constraints."
SCHEMATIC = "Schematic: no positions were found that satisfy all constraints."


@dataclass(frozen=True)
class Arrangement:
    """Numbers for all symbols of a system; ``note`` says where the places are from, ``met`` whether they are right."""

    system: System
    numbers: Mapping[Expr, float]
    note: str | None
    met: bool

    @cached_property
    def poses(self) -> dict[str, Displacement]:
        """Where everything that carries something is."""
        return poses_of(self.system, self.numbers, gibbs=True)

    def number(self, e: Expr) -> float:
        """The value of an expression."""
        found = float(evaluated(e, self.numbers))
        return found if math.isfinite(found) else 0.0

    def point(self, at: Sequence[Expr]) -> Place:
        """A given place of the drawing."""
        return place([self.number(e) for e in at])


def finite_relations(system: System, senses: Sequence[str] = ("=",)) -> list[Expr]:
    """The relations between places alone, of some senses."""
    told = (r for c in system.constraints for r in c.relations if r.sense in senses)
    return [r.expr for r in told if all(s.args[0] in ("coordinate", "parameter", "time") for s in r.expr.symbols)]


def arrangement_of(system: System) -> Arrangement:
    """The reference configuration; else places that meet the relations; else a schematic."""
    numbers: dict[Expr, float] = {parameter(p): 1.0 for p in (*system.parameters, *system.generic)} | {TIME: 0.0}
    if system.reference is not None:
        return Arrangement(system, numbers | _known(system.reference, numbers), None, True)
    for seed in range(STARTS):
        start = numbers | _start(system, seed) | _known(system.pose, numbers)
        found = onto(system, start)
        if found is not None:
            free = not any(c.relations for c in system.constraints)
            note = EXAMPLES if free else CHOSEN
            return Arrangement(system, found, note, True)
    try:
        told = configurations(system, steps=0)[0]
    except DofkitError:
        return Arrangement(system, numbers | _start(system, 0) | _known(system.pose, numbers), SCHEMATIC, False)
    found = numbers | _symbols(system, told)
    limits = values_at(finite_relations(system, (">=", ">")), found)
    met = bool(np.all(limits >= -MET))
    return Arrangement(system, found, CHOSEN if met else SCHEMATIC, met)


def _known(given: Mapping[Expr, Expr], numbers: Mapping[Expr, float]) -> dict[Expr, float]:
    return {s: v for s, e in given.items() if math.isfinite(v := float(evaluated(e, numbers)))}


def _symbols(system: System, told: Mapping[str, float]) -> dict[Expr, float]:
    """A configuration that was told, by its symbols; a body in the Gibbs chart is left as it is drawn."""
    names = {c.name for c in system.coordinates} - {n for r in system.rotations for n in r.names}
    return {(coordinate if n in names else parameter)(n): v for n, v in told.items()}


def onto(system: System, numbers: Mapping[Expr, float]) -> dict[Expr, float] | None:
    """Nearby numbers for coordinates and generic lengths at which the finite relations hold; None if not found."""
    held, limits = finite_relations(system), finite_relations(system, (">=", ">"))
    moving = [*(coordinate(c.name) for c in system.coordinates), *map(parameter, system.generic)]
    now = dict(numbers)
    if len(moving) > MOST_COORDINATES:
        return None
    for _ in range(ROUNDS):
        broken = [e for e in limits if float(evaluated(e, now)) < 0]
        wrong = values_at([*held, *broken], now)
        rows = derivatives([*held, *broken], moving, now)
        size = np.linalg.norm(rows, axis=1)
        if not np.all(np.isfinite(wrong)) or not np.all(np.isfinite(rows)):
            return None
        gap = wrong / np.where(size > 1e-9, size, 1.0)
        if not gap.size or float(np.max(np.abs(gap))) < MET:
            return now
        step = -np.linalg.lstsq(with_unit_rows(rows), gap, rcond=1e-9)[0]
        step *= min(1.0, 0.7 / max(float(np.linalg.norm(step)), 1e-12))
        now |= {s: now.get(s, 1.0) + float(d) for s, d in zip(moving, step, strict=True)}
    return None


def _start(system: System, seed: int) -> dict[Expr, float]:
    """Places to begin from: particles hang in a chain or stand as their links say; all else is a little off 0."""
    rng = np.random.default_rng(seed)
    found = {coordinate(c.name): 0.6 - 0.2 * (k % 3) for k, c in enumerate(system.coordinates) if c.owner is None}
    for r in system.rotations:
        if r.chart == "euler":
            angles = (0.4, 0.7, 0.2)
            found |= {coordinate(n): a for n, a in zip(r.names, angles, strict=True)}
    spots = _spots(system)
    for name, spot in spots.items():
        own = [c.name for c in system.coordinates if c.owner == name]
        found |= {coordinate(n): float(v) for n, v in zip(own, spot, strict=False)}
    if seed:
        found = {s: v + 0.5 * float(rng.standard_normal()) for s, v in found.items()}
    return found


def _spots(system: System) -> dict[str, Array]:
    """Where particles that nothing places are put."""
    d = len(PARTICLE_ROLES[system.dimension])
    graph, fixed = _links(system)
    if not system.particles:
        return {}
    if len(system.particles) == 1 and not fixed:
        return {system.particles[0]: np.array([0.62, 0.5, 0.55])}
    if d == 1:
        return {name: np.array([1.0 + 1.5 * k]) for k, name in enumerate(system.particles)}
    if fixed and nx.is_forest(graph):
        return _hanging(graph, fixed, d)
    if not graph.edges and d == 2:
        return {str(n): 1.5 * np.asarray(p) for n, p in nx.circular_layout(graph).items()}
    if len(graph) > MOST_COORDINATES:
        return {str(n): np.append(p, 0.0) for n, p in nx.circular_layout(graph).items()}
    laid = nx.spring_layout(graph, dim=d, seed=7, pos=fixed or None, fixed=list(fixed) or None, scale=1.6)
    return {str(n): np.asarray(p) for n, p in laid.items() if n not in fixed}


def _links(system: System) -> tuple[nx.Graph, dict[str, list[float]]]:
    """Particles and fixed points, joined where a constraint runs between them; and where the fixed ones are."""
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
        graph.add_edges_from(combinations(nodes, 2) if connection.facts.complete else pairwise(nodes))
    for name in (n for n in graph if n in fixed and graph.degree(n) == 0):
        fixed.pop(name)
    graph.remove_nodes_from([n for n in graph if str(n).startswith("@") and n not in fixed])
    return graph, fixed


def _hanging(graph: nx.Graph, fixed: Mapping[str, Sequence[float]], d: int) -> dict[str, Array]:
    """Chains that hang from fixed points, each next particle lower and to one side."""
    down = np.array([0.45, -0.9]) if d == 2 else np.array([0.45, 0.3, -0.85])
    found: dict[str, Array] = {n: np.array(p, dtype=float) for n, p in fixed.items()}
    for root in [*fixed, *graph]:
        found.setdefault(root, np.array([1.0 + 0.8 * len(found)] + [0.0] * (d - 1)))
        for parent, child in nx.bfs_edges(graph, root):
            tilt = np.array([(-1.0) ** len(found), *[1.0] * (d - 1)])
            found.setdefault(child, found[parent] + down * tilt)
    return {n: p for n, p in found.items() if n not in fixed}


def poses_of(system: System, numbers: Mapping[Expr, float], *, gibbs: bool) -> dict[str, Displacement]:
    """Where everything is; ``gibbs``: turns of spatial bodies are in the system's own charts, else Euler's angles."""
    found = {GROUND: AT_REST}
    rotations = {r.body: r for r in system.rotations}
    owned: dict[str | None, list[Coordinate]] = {}
    for c in system.coordinates:
        owned.setdefault(c.owner, []).append(c)
    for body in system.bodies:
        own = owned[body]
        told = [float(numbers.get(coordinate(c.name), 0.0)) for c in own]
        start = np.array(place([float(evaluated(e, numbers)) for e in system.starts[body]]))
        turn = np.eye(3)
        if system.dimension == 2:
            names = system.pose.get(coordinate(own[-1].name))
            turn = about(2, told[-1] - (float(evaluated(names, numbers)) if names is not None else 0.0))
        elif system.dimension == 3 and body in rotations:
            r = rotations[body]
            initial = [float(evaluated(e, numbers)) for e in r.initial]
            if gibbs and r.chart == "gibbs":
                turn = _from_gibbs(np.array(told[3:]))
            else:
                turn = _from_euler(told[3:]) @ _from_euler(initial).T
        origin = np.array(place(told[: system.dimension]))
        found[body] = Displacement(turn, origin - turn @ start)
    if not system.bodies and not system.particles:
        told = [numbers.get(coordinate(c.name), 0.0) for c in system.coordinates[:3]]
        found[POINT] = Displacement(np.eye(3), np.array(place(told)))
        for c in system.coordinates:
            found[c.name] = Displacement(np.eye(3), np.array(place([numbers.get(coordinate(c.name), 0.0)])))
    for particle in system.particles:
        own = owned[particle]
        found[particle] = Displacement(np.eye(3), np.array(place([numbers.get(coordinate(c.name), 0.0) for c in own])))
    return found


def about(axis: int, angle: float) -> Array:
    """The rotation about a coordinate axis."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    found = np.eye(3)
    found[i, i], found[i, j], found[j, i], found[j, j] = c, -s, s, c
    return found


def _from_euler(angles: Sequence[float]) -> Array:
    phi, theta, psi = angles
    return about(2, phi) @ about(0, theta) @ about(2, psi)


def _from_gibbs(g: Array) -> Array:
    cross = np.array([[0, -g[2], g[1]], [g[2], 0, -g[0]], [-g[1], g[0], 0]])
    return np.asarray(np.eye(3) + 2 * (cross + cross @ cross) / (1 + g @ g))
