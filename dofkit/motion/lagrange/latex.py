"""The equations of motion in LaTeX, by SymPy's printer for mechanics."""

from __future__ import annotations

from collections.abc import Iterable

from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.model import LagrangeModel


def latex_of(model: LagrangeModel, lagrangian: Expr, equations: Iterable[Expr]) -> str:
    """The Lagrangian, the equations and the constraints that keep a multiplier, as one display."""
    from sympy.physics.vector.printing import vlatex

    bridge = Bridge([c.name for c in model.study.system.coordinates], model.positive)
    lines = [f"L &= {vlatex(bridge.sympy(lagrangian))}"]
    lines += [f"0 &= {vlatex(bridge.sympy(e))}" for e in equations]
    lines += [f"0 &= {vlatex(bridge.sympy(g))}" for g in (*model.holonomic, *model.nonholonomic)]
    return "$\\displaystyle \\begin{aligned}" + " \\\\ ".join(lines) + "\\end{aligned}$"
