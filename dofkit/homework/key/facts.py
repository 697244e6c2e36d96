"""What the known errors are made of: how many links, curves, walls, drives and the like a scene has."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import networkx as nx

from dofkit.homework.key.key import Key
from dofkit.report import ConstraintEntry
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System, TypeFacts

_STRINGS = ("string", "rope", "cable", "cord")
_PLANE = {1: 1, 2: 3, 3: 6}

#: Coordinates of a point in space.
SPACE = 3


@dataclass(frozen=True)
class BarCounts:
    """Particles joined by bars, those of rigid sets included."""

    scene: Scene
    system: System

    @cached_property
    def graph(self) -> nx.Graph:
        """Particles, and the pairs of them that keep their distance."""
        graph: nx.Graph = nx.Graph()
        graph.add_nodes_from(p.name for p in self.scene.particles)
        graph.add_edges_from((a, b) for _, a, b in self.system.links)
        return graph

    @cached_property
    def links(self) -> int:
        """Bars between particles, those of rigid sets included."""
        return int(self.graph.number_of_edges())

    @cached_property
    def rods(self) -> int:
        """Pairs of particles joined by one bar and by nothing else."""
        return sum(len(c) == 2 for c in nx.connected_components(self.graph))

    @cached_property
    def clusters(self) -> int:
        """Sets of three particles or more of which each keeps its distance from each."""
        parts = (self.graph.subgraph(c) for c in nx.connected_components(self.graph) if len(c) > 2)
        return sum(g.number_of_edges() == len(g) * (len(g) - 1) // 2 for g in parts)


@dataclass(frozen=True)
class SurfaceCounts:
    """Finite constraints as curves and surfaces on which particles and bodies are held."""

    key: Key
    system: System

    @cached_property
    def touching(self) -> list[tuple[TypeFacts, int, frozenset[str | None]]]:
        """Of every finite constraint its type, its equations, and whose coordinates it mentions."""
        owner = {c.name: c.owner for c in self.system.coordinates}
        found = []
        for entry, constraint in zip(self.key.report.constraints, self.system.constraints, strict=True):
            if entry.form == "finite":
                symbols = [s for r in constraint.relations for s in r.expr.symbols if s.args[0] == "coordinate"]
                owners = frozenset(owner.get(str(s.args[1])) for s in symbols)
                found.append((constraint.facts, entry.equations, owners))
        return found

    @cached_property
    def surplus(self) -> int:
        """Surfaces beyond one for each particle that is held on a curve in space."""
        more = 0
        alone: dict[str | None, int] = {}
        for kind, equations, owners in self.touching:
            if self.key.scene.dimension == 3 and len(owners) == 1 and kind.surface:
                (owner,) = owners
                alone[owner] = alone.get(owner, 0) + equations
            elif self.key.scene.dimension == 3 and kind.shared:
                more += equations - len(owners)
        names = {p.name for p in self.key.scene.particles}
        return more + sum(count - 1 for owner, count in alone.items() if count > 1 and owner in names)

    @cached_property
    def on_curves(self) -> int:
        """Particles that one curve holds: d - 1 equations for each."""
        alone: dict[str | None, int] = {}
        for kind, equations, owners in self.touching:
            for owner in owners:
                if len(owners) == 1 or kind.shared:
                    alone[owner] = alone.get(owner, 0) + equations // max(1, len(owners))
        names = {p.name for p in self.key.scene.particles}
        return sum(count == self.key.scene.dimension - 1 for owner, count in alone.items() if owner in names)

    @cached_property
    def planes(self) -> int:
        """Equations of their own that hold one Cartesian coordinate at a number, z = 0."""
        return sum(name[0] in "xyzXYZ" for name in self._held) if len(self.key.coordinates) >= SPACE else 0

    @property
    def fixed(self) -> int:
        """Equations of their own that hold any coordinate at a number."""
        return len(self._held)

    @cached_property
    def _held(self) -> list[str]:
        found = []
        for entry, constraint in zip(self.key.report.constraints, self.system.constraints, strict=True):
            kind = constraint.facts
            own = kind.written and kind.surface and not kind.shared and entry.form == "finite"
            for relation in constraint.relations if own else ():
                moving = [s for s in relation.expr.symbols if s.args[0] == "coordinate"]
                if len(moving) == 1 and relation.expr.op in ("sym", "add") and not _powers(relation.expr):
                    found.append(str(moving[0].args[1]))
        return found


@dataclass(frozen=True)
class SceneCounts:
    """Counts of a scene, each worked out when it is asked for; ``dof`` and ``n`` are known."""

    key: Key

    @cached_property
    def dof(self) -> int:
        """f: the dimension of the configuration space."""
        return self.key.report.dof or 0

    @cached_property
    def n(self) -> int:
        """The number of coordinates."""
        return len(self.key.coordinates)

    @cached_property
    def d(self) -> int:
        """The dimension of the world."""
        return self.key.scene.dimension

    @cached_property
    def naive(self) -> int:
        """N d - k with every finite equation that was written."""
        return self.key.report.count.naive_dof

    @cached_property
    def particles(self) -> int:
        """How many there are."""
        return len(self.key.scene.particles)

    @cached_property
    def bodies(self) -> int:
        """How many there are."""
        return len(self.key.scene.bodies)

    @cached_property
    def body_freedom(self) -> int:
        """d(d+1)/2."""
        return _PLANE[self.d]

    @cached_property
    def system(self) -> System:
        """The mathematics of the scene."""
        return lower(self.key.scene)

    @cached_property
    def entries(self) -> list[tuple[Any, ConstraintEntry]]:
        """Every constraint as written, with what the report says of it."""
        return list(zip(self.key.scene.constraints, self.key.report.constraints, strict=True))

    @cached_property
    def types(self) -> list[TypeFacts]:
        """What is true of each constraint's type."""
        return [c.facts for c in self.system.constraints]

    @cached_property
    def bars(self) -> BarCounts:
        """Of the graph of bars between particles."""
        return BarCounts(self.key.scene, self.system)

    @cached_property
    def surfaces(self) -> SurfaceCounts:
        """Of what is held on curves and surfaces."""
        return SurfaceCounts(self.key, self.system)

    @cached_property
    def forces(self) -> list[str]:
        """The kinds of the scene's forces."""
        return [force.type for force in self.key.scene.forces]

    @cached_property
    def walls(self) -> int:
        """Inequalities."""
        return sum(sum(r.sense != "=" for r in c.relations) for c in self.system.constraints)

    @cached_property
    def nonholonomic(self) -> int:
        """Independent velocity equations that are no consequence of finite relations."""
        return self.dof - (self.dof if self.key.report.velocity_dof is None else self.key.report.velocity_dof)

    @cached_property
    def integrable(self) -> int:
        """Differential equations that integrate."""
        return sum(e.equations for _, e in self.entries if e.form == "pfaffian" and e.holonomic)

    @cached_property
    def drives(self) -> int:
        """Finite constraints that hold the time: prescribed motions."""
        return sum(e.form == "finite" and e.scleronomic is False for _, e in self.entries)

    @cached_property
    def strings(self) -> int:
        """Strings, by type or by name."""
        named = [any(word in e.name.lower() for word in _STRINGS) for _, e in self.entries]
        return sum(kind.string or rope for kind, rope in zip(self.types, named, strict=True))

    @cached_property
    def guides(self) -> int:
        """Particles and bodies on a straight guide of their own beside which something else moves."""
        if self.particles + self.bodies < 2 and self.n < 3:
            return 0
        named = sum(kind.slides for kind in self.types)
        touching = self.surfaces.touching
        return named + sum(len(owners) == 1 and kind.written and kind.surface for kind, _, owners in touching)

    @cached_property
    def joints(self) -> int:
        """Hinges and sliders."""
        return sum(kind.planar_pair for kind in self.types)


def _powers(e: Any) -> bool:
    parts = e.args if e.op == "add" else (e,)
    return any(p.op in ("pow", "fn") or (p.op == "mul" and any(f.op in ("pow", "fn") for f in p.args)) for p in parts)
