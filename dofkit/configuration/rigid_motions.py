"""Rigid motions of the system: their dimension at a point, and the orbit of a configuration without other motions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

from flint import arb

from dofkit.configuration.variety import free_real_point, point_at, pose_point
from dofkit.exact.matrices.dense import rank
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import BallPoint, FloatPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.ring.program import gradient, values
from dofkit.expressions import tree as ex
from dofkit.relations.blocks import Chart

#: A velocity field: {column: [(factor, another column or None)]}: the sum of factor * (that coordinate, or 1 for None).
AffineField = dict[int, list[tuple[int, int | None]]]


def displacement_fields(chart: Chart) -> list[AffineField]:
    """Return the fields of translations and rotations of all particles and planar bodies of a block.

    Empty unless every coordinate is a position x, y, z or the angle of a planar body. Empty also if relations differ by
    region, because a random point may lie in another one.
    """
    if any(v.kind == "sign" and chart.ring.var_expr[v.index].symbols for v in chart.ring.vars):
        return []
    place = {str(s.args[1]): i for i, s in enumerate(chart.symbols) if s != ex.TIME}
    here = [c for c in chart.setting.roles if c.name in place]
    if len(here) != len(place) or any(c.role not in ("x", "y", "z", "angle") for c in here):
        return []
    by_owner: dict[str, dict[str, int]] = {}
    for c in here:
        by_owner.setdefault(str(c.owner), {})[c.role] = place[c.name]
    axes = sorted({r for roles_of in by_owner.values() for r in roles_of if r != "angle"})
    result: list[AffineField] = [{o[a]: [(1, None)] for o in by_owner.values() if a in o} for a in axes]
    for a, b in combinations(axes, 2):
        turn: AffineField = {}
        for o in by_owner.values():
            if a in o and b in o:
                turn[o[a]] = [(-1, o[b])]
                turn[o[b]] = [(1, o[a])]
            if "angle" in o:
                turn[o["angle"]] = [(1, None)]
        result.append(turn)
    return result


def rigid_motions(chart: Chart, point: FieldPoint) -> int:
    """Return the dimension, at the point, of the rigid motions of the system that preserve all relations."""
    return rank_of(rigid_fields(chart, point), point.p)


def rigid_fields(chart: Chart, point: FieldPoint) -> list[list[Any]]:
    """Return the rigid motions of the system that preserve all relations, as velocities at the point over the columns.

    A motion counts only if the derivative of every relation along it is 0 at a random point of the ambient space.
    """
    fields = displacement_fields(chart)
    away = pose_point(chart, {}, 11) if fields else None
    if away is None:
        return []
    slopes = _slopes(chart, away)
    kept = [f for f in fields if _keeps(chart, away, f, slopes)]
    return [_velocity_at(chart, point, f) for f in kept]


def rigid_motions_real(chart: Chart, point: BallPoint | FloatPoint) -> int:
    """Return the dimension, at a real point, of the rigid motions that preserve all relations."""
    return rank(displacements_real(chart, point), 1e-9)


def displacements_real(chart: Chart, point: BallPoint | FloatPoint) -> list[list[float]]:
    """Return the rigid motions that preserve all relations, as velocities at a real point over the columns."""
    fields = displacement_fields(chart)
    by_field = "field" in chart.setting.engines
    away = None if not fields else pose_point(chart, {}, 11) if by_field else free_real_point(chart, 11)
    if away is None:
        return []
    slopes = _slopes(chart, away)
    rows = [_velocity_at(chart, point, field) for field in fields if _keeps(chart, away, field, slopes)]
    return [[float(v.mid()) if isinstance(v, arb) else float(v) for v in row] for row in rows]


def _velocity_at(chart: Chart, point: FieldPoint | BallPoint | FloatPoint, field: AffineField) -> list[Any]:
    """Return the velocity of a field at a point, over the columns."""
    zero = point.number(ex.ZERO.args[0])
    vector = [zero] * len(chart.columns)
    at = values(chart.ring, point)
    coordinates = {k: at[chart.ring.var_node[c]] if c >= 0 else zero for k, c in enumerate(chart.columns)}
    for column, terms in field.items():
        for factor, other in terms:
            vector[column] = vector[column] + (zero + 1 if other is None else coordinates[other]) * factor
    return vector


def _slopes(chart: Chart, point: FieldPoint | BallPoint) -> list[dict[int, Any]]:
    """Return the derivatives of every relation by the generators."""
    at = values(chart.ring, point)
    unit = point.number(ex.ONE.args[0])
    return [gradient(chart.ring, at, point, [(node, unit)]) for node in chart.nodes]


def _keeps(
    chart: Chart, point: FieldPoint | BallPoint, field: AffineField, slopes: Sequence[Mapping[int, Any]]
) -> bool:
    """Return whether the derivatives of all relations along a field are 0 at a point."""
    vector = _velocity_at(chart, point, field)
    unit = point.number(ex.ONE.args[0])
    of = {c: vector[i] for i, c in enumerate(chart.columns) if c >= 0}
    for g in slopes:
        change = sum((v * of[c] for c, v in g.items() if c in of), unit * 0)
        if change != 0 if isinstance(point, FieldPoint) else not change.contains(0):
            return False
    return True


# The orbit of the reference configuration


class RigidOrbit(NamedTuple):
    """The velocities of rigid motions at the reference, over GF(p), by coordinate ``names``."""

    names: list[str]
    fields: list[list[Any]]
    p: int

    @classmethod
    def at_reference(cls, chart: Chart, dof: int) -> RigidOrbit | None:
        """Return the orbit if it has the dimension ``dof``, so that it is the set near the reference; else None."""
        setting = chart.setting
        if setting.reference is None or "field" not in setting.engines:
            return None
        point = point_at(chart, {**setting.reference, ex.TIME: ex.ZERO}, 3)
        if point is None:
            return None
        kept = [(str(s.args[1]), k) for k, s in enumerate(chart.symbols) if s != ex.TIME]
        fields = [[field[k] for _, k in kept] for field in rigid_fields(chart, point)]
        orbit = cls([name for name, _ in kept], fields, point.p)
        return orbit if orbit.rank(orbit.names) == dof else None

    def rank(self, chosen: Sequence[str]) -> int:
        """Return the rank of the projection of the tangent space to some coordinates."""
        columns = [k for k, name in enumerate(self.names) if name in chosen]
        return rank_of([[field[k] for k in columns] for field in self.fields], self.p) if self.fields else 0

    def chart_of(self) -> list[str]:
        """Return the first coordinates, in order, over which the orbit is a graph near the reference."""
        chosen: list[str] = []
        for name in self.names:
            if self.rank([*chosen, name]) > len(chosen):
                chosen.append(name)
        return chosen
