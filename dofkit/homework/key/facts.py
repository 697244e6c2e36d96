"""Counts of a scene (links, curves, walls, drives, ...) from which the numbers of known errors are computed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import networkx as nx

from dofkit.expressions.tree import Expr
from dofkit.homework.key.key import Key
from dofkit.report import ConstraintEntry
from dofkit.system import Constraint, System

_STRINGS = ("string", "rope", "cable", "cord")
_BODY_FREEDOM = {1: 1, 2: 3, 3: 6}
#: The number of coordinates of a point in space.
SPACE = 3


class SceneCounts:
    """Counts of a scene whose number of degrees of freedom is known.

    Attributes
    ----------
    dof, n, d, naive
        The dimension of the configuration space, the number of coordinates, the dimension of the world, and the
        number of coordinates less all equations between coordinates that are written.
    body_freedom
        d (d + 1) / 2.
    links, rods, clusters
        Bars between particles, those of rigid sets included; pairs of particles joined by one bar and by nothing else;
        sets of three particles or more of which each keeps its distance from each.
    surplus, on_curves
        Surfaces beyond one for each particle that is kept on a curve in space; particles that one curve keeps.
    planes, fixed
        Equations of their own that hold one Cartesian coordinate, or any coordinate, at a number.
    forces, energies, entries
        The types of the forces; whether there are energies; the number of constraints.
    walls, nonholonomic, integrable, drives
        Inequalities; independent velocity equations that no equation between coordinates implies; equations of
        integrable differential constraints; prescribed motions.
    strings, guides, joints
        Strings by type or by name; particles and bodies on a straight guide of their own; hinges and sliders.
    """

    def __init__(self, key: Key) -> None:
        scene, report, system = key.scene, key.report, key.system
        pairs = list(zip(report.constraints, system.constraints, strict=True))
        particles = [p.name for p in scene.particles]
        self.dof, self.n, self.d = report.dof or 0, len(key.coordinates), scene.dimension
        self.naive, self.body_freedom = report.count.naive_dof, _BODY_FREEDOM[self.d]
        self.particles, self.bodies = len(particles), len(scene.bodies)
        bars: nx.Graph = nx.Graph()
        bars.add_nodes_from(particles)
        bars.add_edges_from((a, b) for _, a, b in system.links)
        groups = [bars.subgraph(c) for c in nx.connected_components(bars)]
        self.links = bars.number_of_edges()
        self.rods = sum(len(g) == 2 for g in groups)
        self.clusters = sum(len(g) > 2 and g.number_of_edges() == len(g) * (len(g) - 1) // 2 for g in groups)
        self.surplus, self.on_curves, guides = _surfaces(pairs, system, particles, self.d)
        self.guides = 0 if self.particles + self.bodies < 2 and self.n < SPACE else guides
        held = [name for entry, constraint in pairs for name in _held(entry, constraint)]
        self.planes = sum(name[0] in "xyzXYZ" for name in held) if self.n >= SPACE else 0
        self.fixed, self.entries = len(held), len(pairs)
        self.forces, self.energies = [force.type for force in scene.forces], scene.energies is not None
        self.walls = sum(r.sense != "=" for _, c in pairs for r in c.relations)
        self.nonholonomic = 0 if report.velocity_dof is None else self.dof - report.velocity_dof
        self.integrable = sum(e.equations for e, _ in pairs if e.form == "pfaffian" and e.holonomic)
        self.drives = sum(e.form == "finite" and e.scleronomic is False for e, _ in pairs)
        self.strings = sum(c.facts.string or any(word in e.name.lower() for word in _STRINGS) for e, c in pairs)
        self.joints = sum(c.facts.planar_pair for _, c in pairs)


def _surfaces(
    pairs: Sequence[tuple[ConstraintEntry, Constraint]], system: System, particles: Sequence[str], d: int
) -> tuple[int, int, int]:
    """Return the numbers of surplus surfaces, of particles on curves, and of guides."""
    alone, shared = Counter[str | None](), Counter[str | None]()
    surplus, guides = 0, sum(constraint.facts.slides for _, constraint in pairs)
    for entry, constraint in pairs:
        facts, owners = constraint.facts, _owners(constraint, system)
        if entry.form != "finite":
            continue
        for owner in owners if len(owners) == 1 or facts.shared else ():
            shared[owner] += entry.equations // len(owners)
        if len(owners) == 1 and facts.surface:
            guides += facts.written
            alone.update(dict.fromkeys(owners, entry.equations))
        elif facts.shared and d == SPACE:
            surplus += entry.equations - len(owners)
    if d == SPACE:
        surplus += sum(max(0, alone[name] - 1) for name in particles)
    return surplus, sum(shared[name] == d - 1 for name in particles), guides


def _coordinates(e: Expr) -> list[str]:
    return [str(s.args[1]) for s in e.symbols if s.args[0] == "coordinate"]


def _owners(constraint: Constraint, system: System) -> frozenset[str | None]:
    """Return the particles and bodies whose coordinates a constraint mentions."""
    owner = {c.name: c.owner for c in system.coordinates}
    return frozenset(owner.get(name) for r in constraint.relations for name in _coordinates(r.expr))


def _held(entry: ConstraintEntry, constraint: Constraint) -> list[str]:
    """Return the coordinates that the equations of a constraint, such as ``x = 2``, fix at a number."""
    facts, held = constraint.facts, []
    if not facts.written or not facts.surface or facts.shared or entry.form != "finite":
        return []
    for relation in constraint.relations:
        moving = _coordinates(relation.expr)
        if len(moving) == 1 and relation.expr.op in ("sym", "add") and not _powers(relation.expr):
            held += moving
    return held


def _powers(e: Expr) -> bool:
    terms = e.args if e.op == "add" else (e,)
    return any(p.op in ("pow", "fn") or (p.op == "mul" and any(f.op in ("pow", "fn") for f in p.args)) for p in terms)
