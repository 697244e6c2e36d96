"""The orbit of a drawing that moves as one body alone: its tangent space there, and over what it is a graph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from dofkit.configuration.generic_points import on_variety, pose_point
from dofkit.configuration.rigid_motions import rigid_fields
from dofkit.exact.matrices.sparse import rank_of
from dofkit.expressions import tree as ex
from dofkit.relations.chart import Chart
from dofkit.relations.setting import Setting


class RigidOrbit(NamedTuple):
    """Displacement fields of the whole at the reference, over GF(p): what is independent there is independent."""

    names: list[str]
    fields: list[list[Any]]
    p: int

    @classmethod
    def at_reference(cls, chart: Chart, setting: Setting, dof: int) -> RigidOrbit | None:
        """The orbit, where it has the dimension ``dof`` and so is all that is near the reference; else None."""
        if setting.reference is None or "field" not in setting.engines:
            return None
        point = pose_point(chart, {**setting.reference, ex.TIME: ex.ZERO}, 3)
        if point is None or not on_variety(chart, point):
            return None
        kept = [(str(s.args[1]), k) for k, s in enumerate(chart.symbols) if s != ex.TIME]
        fields = [[field[k] for _, k in kept] for field in rigid_fields(chart, point)]
        found = cls([name for name, _ in kept], fields, point.p)
        return found if found.rank(found.names) == dof else None

    def rank(self, chosen: Sequence[str]) -> int:
        """The rank of the projection of the tangent space onto some coordinates."""
        columns = [k for k, name in enumerate(self.names) if name in chosen]
        return rank_of([[field[k] for k in columns] for field in self.fields], self.p) if self.fields else 0

    def chart_of(self) -> list[str]:
        """The first coordinates, in order, over which the orbit is a graph near the reference."""
        chosen: list[str] = []
        for name in self.names:
            if self.rank([*chosen, name]) > len(chosen):
                chosen.append(name)
        return chosen
