"""Lagrange's equations d/dt dL/dqdot - dL/dq = Q + sum lam a, by SymPy's mechanics, in readable form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from dofkit import expr as ex
from dofkit.deadline import check
from dofkit.exact.canon import is_identically_zero
from dofkit.expr import Expr
from dofkit.lagrange.bridge import Bridge, UntranslatableError
from dofkit.lagrange.handover import Handover, handover
from dofkit.lagrange.model import Model
from dofkit.lagrange.order import ordered

#: Expressions with fewer operations than this are simplified by SymPy, and longer ones only expanded.
SIMPLIFIED = 250
#: Expressions with more operations than this are left as they are.
EXPANDED = 3000


@dataclass(frozen=True)
class Derived:
    """The equations (each is zero), momenta and generalized forces of the coordinates kept; multipliers by name."""

    model: Model
    lagrangian: Expr
    momenta: dict[str, Expr]
    forces: dict[str, Expr]
    equations: dict[str, Expr]
    multipliers: tuple[str, ...]
    handover: Handover


def derive(model: Model) -> Derived:
    """Lagrange's equations of a model. Raises UntranslatableError where SymPy's answer cannot be written here."""
    bridge = Bridge([c.name for c in model.study.system.coordinates], model.positive)
    given = handover(model, bridge)
    method = given.lagranges_method()
    tidy = Tidier(bridge, model.positive, bool(model.elimination.solved))
    formed = list(method.form_lagranges_equations()) if model.names else []
    multipliers = _multipliers(model)
    swapped = dict(zip(getattr(method, "lam_vec", ()) or (), _symbols(bridge, multipliers), strict=False))
    equations = {n: tidy(e.xreplace(swapped)) for n, e in zip(model.names, formed, strict=True)}
    lagrangian = given.lagrangian
    momenta, forces = {}, {}
    for n, force in zip(model.names, given.forces, strict=True):
        q, rate = bridge.positions[n], bridge.velocity(n)
        momenta[n] = tidy(lagrangian.diff(rate))
        forces[n] = tidy(lagrangian.diff(q) + force)
    return Derived(model, tidy(lagrangian), momenta, forces, equations, multipliers, given)


def _multipliers(model: Model) -> tuple[str, ...]:
    """lam1, lam2, ..., or the like where the scene has such names."""
    system = model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    many = len(model.constraints)
    stem = next(s for s in ("lam", "lambda_", "mult", "multiplier_", "Lagrange_multiplier_") if not any(
        f"{s}{i + 1}" in taken for i in range(many)))  # fmt: skip
    return tuple(f"{stem}{i + 1}" for i in range(many))


def _symbols(bridge: Bridge, names: tuple[str, ...]) -> list[Any]:
    return [bridge.sympy(ex.parameter(name)) for name in names]


@dataclass(frozen=True)
class Tidier:
    """Writes SymPy's expressions shorter; a form counts only where it is proved equal to what was given."""

    bridge: Bridge
    positive: frozenset[Expr]
    thorough: bool

    def __call__(self, e: Any) -> Expr:
        plain = self.bridge.expr(e)
        best, size = plain, _length(plain)
        for form in self._forms(e):
            check()
            try:
                found = self.bridge.expr(form)
            except (UntranslatableError, ZeroDivisionError):
                continue
            if _length(found) < size and is_identically_zero(found - plain, self.positive) is True:
                best, size = found, _length(found)
        return ordered(best)

    def _forms(self, e: Any) -> Iterator[Any]:
        import sympy

        size = int(e.count_ops())
        if size > EXPANDED:
            return
        expanded = e.expand()
        yield expanded
        rates = [self.bridge.velocity(n, k) for k in (2, 1) for n in self.bridge.positions]
        yield sympy.collect(expanded, rates[: len(rates) // 2])
        if size < SIMPLIFIED:
            if e.has(sympy.sin, sympy.cos, sympy.tan):
                yield sympy.trigsimp(expanded)
            if self.thorough:
                yield sympy.simplify(e)


def _length(e: Expr) -> int:
    """How long an expression is to read."""
    return 1 + sum(map(_length, ex.children(e)))
