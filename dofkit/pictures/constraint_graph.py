"""The constraint graph: redundant constraints are marked, and circuits are highlighted under the pointer."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Literal

import networkx as nx
import numpy as np

from dofkit.pictures.shapes import AT_REST, SQUARE, Place, Shape, Sketch, fixed, place
from dofkit.pictures.words import alternative, answer, meanings, state_of, sure
from dofkit.report import Report
from dofkit.scene.scene import Scene
from dofkit.system import GROUND, System

#: The most nodes that are spread by springs (more are put on a circle), and the most nodes with names.
MOST_SPREAD, MOST_NAMES = 450, 90
#: The most circuits in the notes, and the most members of each.
MOST_CIRCUITS, MOST_MEMBERS = 3, 12
WHAT = "Constraint graph: dots are bodies, particles and coordinates; boxes are constraints."
#: ("thing", name of a body, particle or coordinate), or ("constraint", name).
Node = tuple[str, str]


def graph_sketch(scene: Scene, system: System, report: Report, reason: str | None = None) -> Sketch:
    """Return the sketch of the constraint graph: carriers (dots), constraints (boxes), lines to what each mentions."""
    graph = constraint_graph(system)
    positions = _positions_of(graph)
    unit = 0.16 / max(1.0, (len(graph) / 14) ** 0.5)
    shapes: list[Shape] = []
    for first, second in graph.edges:
        name = first[1] if first[0] == "constraint" else second[1]
        state = state_of(report, name)
        role: Literal["axis", "bar"] = "axis" if state == "plain" else "bar"
        shapes.append(Shape("line", fixed(positions[first], positions[second]), role, state, name))
    for node in graph:
        shapes += _node(report, node, positions[node], unit, len(graph) <= MOST_NAMES)
    return Sketch(
        title=f"{scene.title or scene.name}: constraint graph",
        dimension=2,
        shapes=tuple(shapes),
        poses={GROUND: AT_REST},
        size=2.0,
        answer=answer(report),
        alternative=f"{alternative(scene, report)} {WHAT}",
        notes=(*(() if reason is None else (reason,)), *_circuit_notes(report)),
        meanings=meanings(report, looked=False),
        axes=(),
    )


def constraint_graph(system: System) -> nx.Graph:
    """Return the graph with an edge from each constraint to the carriers and free coordinates that it mentions."""
    graph = nx.Graph()
    graph.add_nodes_from(("thing", n) for n in (*system.bodies, *system.particles))
    graph.add_nodes_from(("thing", c.name) for c in system.coordinates if c.owner is None)
    for constraint, connection in zip(system.constraints, system.connections, strict=True):
        node = ("constraint", constraint.name)
        graph.add_node(node)
        owners = {c.owner or c.name for c in system.coordinates if c.name in constraint.mentioned}
        graph.add_edges_from((("thing", m), node) for m in {*connection.members, *owners})
    return graph


def _positions_of(graph: nx.Graph) -> dict[Node, Place]:
    if len(graph) > MOST_SPREAD:
        laid = nx.circular_layout(graph)
    elif len(graph) < 3:
        laid = {n: np.array([0.7 * k, 0.0]) for k, n in enumerate(graph)}
    else:
        start = nx.circular_layout(graph)
        laid = nx.spring_layout(graph, pos=start, seed=5, iterations=200, k=1.4 / len(graph) ** 0.5)
    return {n: place(np.asarray(p) * np.array([1.25, 1.0])) for n, p in laid.items()}


def _node(report: Report, node: Node, position: Place, unit: float, named: bool) -> Iterator[Shape]:
    kind, name = node
    state = state_of(report, name) if kind == "constraint" else "plain"
    if kind == "thing":
        yield Shape("ball", fixed(position), "ground" if name == GROUND else "node", owner=name, size=0.4 * unit)
    else:
        rim = ((position[0] + 0.32 * unit * x, position[1] + 0.32 * unit * y) for x, y in SQUARE)
        yield Shape("area", fixed(*rim), "joint", state, name)
    if named:
        yield Shape("words", fixed(position), "name", state, name, text=name)


def circuits_of(report: Report) -> Mapping[str, list[str]]:
    """Return {redundant constraint: it and the constraints that it depends on}."""
    return {entry.name: [entry.name, *entry.circuit] for entry in report.constraints if entry.circuit}


def _circuit_notes(report: Report) -> Iterator[str]:
    circuits = circuits_of(report)
    for name, (_, *members) in list(circuits.items())[:MOST_CIRCUITS]:
        others = " and others" if len(members) > MOST_MEMBERS else ""
        yield f"{name} depends on {', '.join(members[:MOST_MEMBERS])}{others}{sure(report, 'redundant')}."
    if len(circuits) > MOST_CIRCUITS:
        more = len(circuits) - MOST_CIRCUITS
        yield f"There are {more} more circuits: point at a constraint to highlight its own."


def hover_script(report: Report) -> str:
    """Return the script of the SVG that highlights a circuit."""
    circuits = json.dumps(circuits_of(report), ensure_ascii=True).replace("<", "\\u003c")
    script = (files("dofkit.pictures") / "graph.js").read_text(encoding="utf-8").rstrip()
    return script.replace("@circuits@", circuits)
