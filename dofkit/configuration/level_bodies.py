"""Bodies that constraints keep level: at theta = 0 the Euler angles phi and psi turn alike, and tell no pose apart."""

from __future__ import annotations

import math

from dofkit.exact.points.real_search import RealSearch
from dofkit.expressions import tree as ex
from dofkit.relations.blocks import Block
from dofkit.relations.chart import make_chart
from dofkit.relations.setting import Setting

#: So many configurations are looked at, and a sine that is smaller is taken for 0.
LOOKED, SINGULAR = 6, 1e-6
LEVEL = (
    "configurations were found where sin({}) is 0: the other Euler angles turn alike there, so that coordinates are no "
    "poses; a `coupling` of joints says such an equation"
)


def level_angle(block: Block, setting: Setting) -> str | None:
    """A tilt of the block that is 0 or pi in a configuration that was found by chance; None where there is none.

    There is a part of the set then where the body is level, and what is counted of the set may be counted there.
    """
    tilts = setting.tilts.intersection(block.coordinates)
    if not tilts or not block.finite:
        return None
    chart = make_chart(block, setting)
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive, chart.symbols)
    for seed in range(LOOKED):
        symbols = search.start(seed, {})
        if search.descend(symbols, seed) is not None:
            level = [name for name in tilts if abs(math.sin(symbols.get(ex.coordinate(name), 1.0))) < SINGULAR]
            if level:
                return min(level)
    return None
