"""Lagrange's equations d/dt dL/dqdot - dL/dq = Q + sum lam a [Lagrange1788], by SymPy's mechanics, in readable form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.handover import Handover, handover
from dofkit.motion.lagrange.model import LagrangeModel
from dofkit.motion.lagrange.term_order import ordered
from dofkit.motion.lagrange.tidying import Tidier


@dataclass(frozen=True)
class Derived:
    """The equations (each is zero), momenta and generalized forces of the coordinates kept; multipliers by name."""

    model: LagrangeModel
    lagrangian: Expr
    momenta: dict[str, Expr]
    forces: dict[str, Expr]
    equations: dict[str, Expr]
    multipliers: tuple[str, ...]
    handover: Handover


def derive(model: LagrangeModel) -> Derived:
    """Lagrange's equations of a model. Raises UntranslatableError where SymPy's answer cannot be written here."""
    bridge = Bridge([c.name for c in model.study.system.coordinates], model.positive)
    given = handover(model, bridge)
    method = given.lagranges_method()
    tidy = Tidier(bridge, model.positive)
    formed = list(method.form_lagranges_equations()) if model.names else []
    multipliers = _multipliers(model)
    swapped = dict(zip(getattr(method, "lam_vec", ()) or (), _symbols(bridge, multipliers), strict=False))
    equations = {n: tidy(e.xreplace(swapped)) for n, e in zip(model.names, formed, strict=True)}
    if not multipliers:
        equations = {n: without_exponentials(e, model.positive) for n, e in equations.items()}
    lagrangian = given.lagrangian
    momenta, forces = {}, {}
    for n, force in zip(model.names, given.forces, strict=True):
        q, rate = bridge.positions[n], bridge.velocity(n)
        momenta[n] = tidy(lagrangian.diff(rate))
        forces[n] = tidy(lagrangian.diff(q) + force)
    return Derived(model, tidy(lagrangian), momenta, forces, equations, multipliers, given)


def without_exponentials(e: Expr, positive: frozenset[Expr]) -> Expr:
    """An expression that is 0, divided by an exponential that all its terms hold: that is never 0."""
    for node in sorted((n for n in ex.nodes(e) if n.op == "fn" and n.args[0] == "exp"), key=to_text):
        rest = ex.add(*(_over(t, node) for t in (e.args if e.op == "add" else (e,))))
        if node not in set(ex.nodes(rest)) and is_identically_zero(rest * node - e, positive) is True:
            e = ordered(rest)
    return e


def _over(term: Expr, factor: Expr) -> Expr:
    return ex.mul(*(term.args if term.op == "mul" else (term,)), ex.power(factor, ex.MINUS_ONE))


def _multipliers(model: LagrangeModel) -> tuple[str, ...]:
    """lam1, lam2, ..., or the like where the scene has such names."""
    system = model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    many = len(model.constraints)
    stem = next(s for s in ("lam", "lambda_", "mult", "multiplier_", "Lagrange_multiplier_") if not any(
        f"{s}{i + 1}" in taken for i in range(many)))  # fmt: skip
    return tuple(f"{stem}{i + 1}" for i in range(many))


def _symbols(bridge: Bridge, names: tuple[str, ...]) -> list[Any]:
    return [bridge.sympy(ex.parameter(name)) for name in names]
