"""The equations of motion in LaTeX, by SymPy's printer for mechanics."""

from __future__ import annotations

from dofkit.expressions.sympy_bridge import Bridge
from dofkit.motion.lagrange.derivation import Derived


def latex_of(derived: Derived) -> str:
    """The Lagrangian, the equations and the constraints that keep a multiplier, as one display."""
    from sympy.physics.vector.printing import vlatex

    model = derived.model
    bridge = Bridge([c.name for c in model.study.system.coordinates], model.positive)
    lines = [f"L &= {vlatex(bridge.sympy(derived.lagrangian))}"]
    lines += [f"0 &= {vlatex(bridge.sympy(e))}" for e in derived.equations.values()]
    lines += [f"0 &= {vlatex(bridge.sympy(g))}" for g in (*model.holonomic, *model.nonholonomic)]
    return "$\\displaystyle \\begin{aligned}" + " \\\\ ".join(lines) + "\\end{aligned}$"
