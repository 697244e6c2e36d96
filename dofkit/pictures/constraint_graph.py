"""Constraints and what they hold as a graph: redundant ones marked, circuits lit where one points at them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

import networkx as nx
import numpy as np

from dofkit.pictures.alternative import alternative, answer
from dofkit.pictures.shapes import AT_REST, Place, Shape, Sketch, State, Vertex, place
from dofkit.pictures.states import meanings, state_of, sure
from dofkit.report import Report
from dofkit.scene.scene import Scene
from dofkit.system import GROUND, Constraint, System

#: More nodes than this are put on circles instead of being spread by springs.
MOST_SPREAD = 450
#: More nodes than this have no names.
MOST_NAMES = 90
WHAT = "Constraint graph: dots are bodies, particles and coordinates; boxes are constraints."


def graph_sketch(scene: Scene, system: System, report: Report, reason: str | None = None) -> Sketch:
    """The graph of a scene: what moves as dots, constraints as boxes, a line from each to all that it mentions."""
    graph = constraint_graph(system)
    spots = _spots(graph)
    unit = 0.16 / max(1.0, (len(graph) / 14) ** 0.5)
    shapes: list[Shape] = []
    for first, second in graph.edges:
        name = first[1] if first[0] == "constraint" else second[1]
        ends = (Vertex(GROUND, spots[first]), Vertex(GROUND, spots[second]))
        shapes.append(
            Shape("line", ends, "axis" if state_of(report, name) == "plain" else "bar", state_of(report, name), name)
        )
    named = len(graph) <= MOST_NAMES
    for node in graph:
        shapes += _node(report, node, spots[node], unit, named)
    notes = [] if reason is None else [reason]
    return Sketch(
        title=f"{scene.title or scene.name}: constraint graph",
        dimension=2,
        shapes=tuple(shapes),
        poses={GROUND: AT_REST},
        size=2.0,
        answer=answer(report),
        alternative=f"{alternative(scene, report)} {WHAT}",
        notes=(*notes, *_circuits_told(report)),
        meanings=meanings(report, looked=False),
        axes=(),
    )


#: ("body", name) and the like, or ("constraint", name).
_Node = tuple[str, str]


def constraint_graph(system: System) -> nx.Graph:
    """Owners, free coordinates and the ground, joined to the constraints that mention them."""
    graph = nx.Graph()
    graph.add_nodes_from(("thing", n) for n in (*system.bodies, *system.particles))
    graph.add_nodes_from(("thing", c.name) for c in system.coordinates if c.owner is None)
    for constraint, connection in zip(system.constraints, system.connections, strict=True):
        node = ("constraint", constraint.name)
        graph.add_node(node)
        graph.add_edges_from((("thing", m), node) for m in {*connection.members, *_mentioned(system, constraint)})
    return graph


def _mentioned(system: System, constraint: Constraint) -> Iterator[str]:
    """The owners, or else the names, of the coordinates in a constraint's relations."""
    named = {s.args[1] for r in constraint.relations for s in r.expr.symbols}
    for c in system.coordinates:
        if c.name in named:
            yield c.owner or c.name


def _spots(graph: nx.Graph) -> dict[_Node, Place]:
    if len(graph) > MOST_SPREAD:
        laid = nx.circular_layout(graph)
    elif len(graph) < 3:
        laid = {n: np.array([0.7 * k, 0.0]) for k, n in enumerate(graph)}
    else:
        start = nx.circular_layout(graph)
        laid = nx.spring_layout(graph, pos=start, seed=5, iterations=200, k=1.4 / len(graph) ** 0.5)
    return {n: place(np.asarray(p) * np.array([1.25, 1.0])) for n, p in laid.items()}


def _node(report: Report, node: _Node, spot: Place, unit: float, named: bool) -> Iterator[Shape]:
    kind, name = node
    vertex = (Vertex(GROUND, spot),)
    if kind == "thing":
        yield Shape("ball", vertex, "ground" if name == GROUND else "node", owner=name, size=0.4 * unit)
        state: State = "plain"
    else:
        state = state_of(report, name)
        corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
        rim = tuple(Vertex(GROUND, (spot[0] + 0.32 * unit * x, spot[1] + 0.32 * unit * y, 0.0)) for x, y in corners)
        yield Shape("area", rim, "joint", state, name)
    if named:
        yield Shape("words", vertex, "name", state, name, text=name)


def circuits_of(report: Report) -> Mapping[str, list[str]]:
    """Each redundant constraint with those that it depends on."""
    return {entry.name: [entry.name, *entry.circuit] for entry in report.constraints if entry.circuit}


def _circuits_told(report: Report) -> Iterator[str]:
    circuits = circuits_of(report)
    for name, members in list(circuits.items())[:3]:
        others = " and others" if len(members) > 13 else ""
        yield f"{name} depends on {', '.join(members[1:13])}{others}{sure(report, 'redundant')}."
    if len(circuits) > 3:
        yield f"There are {len(circuits) - 3} more circuits: point at a constraint to highlight its own."


def hover_script(report: Report) -> str:
    """What lights a circuit, as a script of the SVG."""
    told = json.dumps(circuits_of(report), ensure_ascii=True).replace("<", "\\u003c")
    return f"""(function () {{
  var circuits = {told};
  var root = document.currentScript ? document.currentScript.closest("svg") : document.documentElement;
  var parts = root.querySelectorAll("[data-owner]");
  function light(names) {{
    parts.forEach(function (part) {{
      var lit = !names || names.indexOf(part.getAttribute("data-owner")) >= 0;
      part.style.opacity = lit ? "" : "0.15";
    }});
  }}
  function circuit(name) {{
    if (circuits[name]) {{ return circuits[name]; }}
    for (var key in circuits) {{ if (circuits[key].indexOf(name) >= 0) {{ return circuits[key]; }} }}
    return null;
  }}
  parts.forEach(function (part) {{
    part.addEventListener("mouseenter", function () {{ light(circuit(part.getAttribute("data-owner"))); }});
    part.addEventListener("mouseleave", function () {{ light(null); }});
  }});
}})();"""
