"""Which blocks measured geometry enters, and where they are drawn."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.base.libraries import nx
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, coordinates_of
from dofkit.relations.chart import Chart
from dofkit.relations.setting import Setting
from dofkit.system import GROUND


def is_measured(block: Block, setting: Setting) -> bool:
    """Do numbers of a drawing enter that are right to within a tolerance: geometry, or places of particles and bodies?

    Texts on coordinates that belong to no particle and no body, or to one that is not drawn, hold no such numbers.
    """
    if setting.tolerance is None:
        return False
    if any(row.constraint in setting.geometric for row in block.rows):
        return True
    bodies = {c.owner for c in setting.roles if c.role not in ("x", "y", "z")}
    drawn = {c.name for c in setting.roles if c.owner and ex.coordinate(c.name) in setting.pose and
             (setting.reference is not None or c.owner not in bodies)}  # fmt: skip
    return not drawn.isdisjoint(block.coordinates)


def is_tree(block: Block, setting: Setting) -> bool:
    """Do constraints of geometry alone join particles, bodies and the ground without a loop?

    The relations are then independent wherever they hold, whatever their numbers are.
    """
    owners = {c.name: c.owner for c in setting.roles}
    rows: dict[int, set[str | None]] = {}
    for row in block.rows:
        rows.setdefault(row.constraint, set()).update(owners[name] for name in coordinates_of(row.piece))
    joined: nx.Graph = nx.Graph()
    for constraint, members in rows.items():
        if constraint not in setting.geometric or None in members:
            return False
        ends = [*members, GROUND] if len(members) == 1 else [*members]
        joined.add_edges_from((("joint", constraint), ("member", end)) for end in ends)
    return bool(nx.is_forest(joined)) if joined else True


def drawing_of_block(chart: Chart, setting: Setting) -> Mapping[Expr, Expr] | None:
    """The reference configuration, or what is drawn of it where that is all the relations mention; None else."""
    if setting.reference is not None:
        return setting.reference
    mentioned = {v.key for v in chart.ring.vars if v.kind == "symbol"} - {ex.TIME}
    return setting.pose if mentioned <= setting.pose.keys() else None
