"""Equations of motion held against accelerations derived by hand, at random exact points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import dofkit
from dofkit.base.errors import NoValueError
from dofkit.exact.points.field import field_point
from dofkit.exact.residues import residue_matrix
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.text import Names, parse_expression, parse_relations
from dofkit.expressions.tree import ZERO, Expr, coordinate, parameter, sym, velocity
from dofkit.motion.lagrange.report import MotionReport
from dofkit.scene.names import vocabulary_of
from dofkit.scene.scene import Scene

POINTS = 3
POSITIVE = ("m", "M", "m1", "m2", "l", "l1", "l2", "g", "k", "R", "J", "I1", "I3", "a", "b", "c", "w", "h")
PARAMETERS = dict.fromkeys(POSITIVE, "positive")


def names_of(scene: Scene, report: MotionReport) -> Names:
    """What the report's texts may mention."""
    known = vocabulary_of(scene).names
    own = {name: parameter(name) for name in report.multipliers}
    return Names(known.coordinates, {**known.parameters, **own}, known.functions, known.arguments, True, True, True)


def zero(text: str, names: Names) -> Expr:
    """The expression that a text says is 0."""
    (found,) = parse_relations(text, names)
    assert found.relation == "="
    return found.left - found.right


def vanishes(e: Expr) -> bool:
    """Is an expression 0 at random points of GF(p), exactly?"""
    ring = Ring([e], frozenset())
    node = ring.node(e)
    tried = 0
    for seed in range(40):
        point = field_point([ring], 100 + seed)
        try:
            if values(ring, point)[node] != 0:
                return False
        except NoValueError:
            continue
        tried += 1
        if tried == POINTS:
            return True
    raise AssertionError("no point was found")


def acceleration(name: str) -> Expr:
    return sym("acceleration", name)


def check(scene: Scene, expected: Mapping[str, str], multipliers: Mapping[str, str] | None = None) -> MotionReport:
    """The report's equations hold with the accelerations by hand, and fix them: there is one equation for each."""
    report = dofkit.lagrange(scene)
    names = names_of(scene, report)
    assert set(report.coordinates) == set(expected)
    assert len(report.equations) == len(report.coordinates)
    known = {acceleration(n): parse_expression(text, names) for n, text in expected.items()}
    known |= {parameter(n): parse_expression(text, names) for n, text in (multipliers or {}).items()}
    for text in report.equations:
        assert vanishes(substitute(zero(text, names), known)), text
    assert regular(report, names)
    return report


def regular(report: MotionReport, names: Names) -> bool:
    """Is the matrix of accelerations and multipliers regular? Then no others than those by hand satisfy it."""
    equations = [zero(text, names) for text in report.equations]
    columns = [acceleration(n) for n in report.coordinates]
    forces = [parameter(n) for n in report.multipliers]
    velocities = [zero(text, names) for text in report.constraints]
    rows = [[diff(e, s) for s in (*columns, *forces)] for e in equations]
    for g in velocities:
        holds = any(s.args[0] == "velocity" for s in g.symbols)
        slopes = [diff(g, velocity(n) if holds else coordinate(n)) for n in report.coordinates]
        rows.append([*slopes, *(ZERO for _ in forces)])
    flat = [e for row in rows for e in row]
    ring = Ring(flat, frozenset())
    nodes = [[ring.node(e) for e in row] for row in rows]
    for seed in range(40):
        point = field_point([ring], 7 + seed)
        try:
            found = values(ring, point)
        except NoValueError:
            continue
        matrix = residue_matrix([[int(found[i]) for i in row] for row in nodes], point.p)
        return not rows or int(matrix.rank()) == len(rows)
    raise AssertionError("no point was found")


def scene(*constraints: Any, coordinates: str = "", **more: Any) -> Scene:
    made = {"parameters": PARAMETERS, "coordinates": coordinates.split(), "constraints": list(constraints)}
    return dofkit.load({**made, **more})


PLANE = "m (xdot^2 + ydot^2)/2"


def energies(kinetic: str, potential: str = "0", **more: Any) -> dict[str, Any]:
    return {"energies": {"kinetic": kinetic, "potential": potential, **more}}
