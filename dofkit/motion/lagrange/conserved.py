"""Cyclic coordinates and first integrals that a Lagrangian shows at once: translations of q and of t [Noether1918]."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.elimination import Remaining
from dofkit.motion.lagrange.report import Conserved
from dofkit.motion.lagrange.tidying import Tidier
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian

#: Seconds for writing the energy shorter.
SECONDS = 2.0


def cyclic(derived: Derived) -> list[str]:
    """The coordinates with dL/dq = 0 identically."""
    return [n for n in derived.model.names if _zero(derived, diff(derived.lagrangian, ex.coordinate(n)))]


def conserved(derived: Derived) -> Iterator[Conserved]:
    """Momenta on which no force acts, and the energy function h = sum qdot p - L.

    dp/dt = dL/dq + Q + sum lam a; dh/dt = -dL/dt + sum Q qdot + sum lam a qdot, where a qdot = 0 if a constraint
    has no term free of velocities.
    """
    model = derived.model
    for name in model.names:
        if _zero(derived, derived.forces[name]) and not any(_acts(c, name, derived) for c in model.constraints):
            quantity = to_text(derived.momenta[name])
            yield Conserved(name=f"p_{name}", quantity=quantity, reason=f"no generalized force acts along {name}.")
    energy = model.energy
    idle = all(_zero(derived, e) for e in (energy.dissipation, *energy.forces.values()))
    timeless = _zero(derived, diff(derived.lagrangian, ex.TIME))
    if model.names and idle and timeless and all(_workless(c, derived) for c in model.constraints):
        function, total = energy_function(derived)
        reason = "L has no explicit time dependence, and all non-conservative and constraint forces are workless."
        if not total:
            reason = (
                "L has no explicit time dependence, and no non-conservative force acts; this is the Jacobi integral "
                "sum p qdot - L, which differs from T + V."
            )
        yield Conserved(name="energy" if total else "h", quantity=to_text(function), reason=reason)


def energy_function(derived: Derived) -> tuple[Expr, bool]:
    """h = sum qdot dL/dqdot - L, and whether that is T + V, as it is where T is quadratic in the velocities."""
    own = derived.model.energy
    powers = ex.add(*(ex.velocity(n) * p for n, p in derived.momenta.items()))
    function = powers - derived.lagrangian
    total = own.kinetic + own.potential
    whole = _zero(derived, function - total)
    tidy = Tidier(Bridge(derived.model.names, derived.model.positive), derived.model.positive, SECONDS)
    return tidy.shorter(total if whole else function), whole


def _zero(derived: Derived, e: Expr) -> bool:
    return e.is_zero or is_identically_zero(e, derived.model.positive) is True


def _acts(piece: Remaining, name: str, derived: Derived) -> bool:
    """May the constraint's force have a component along a coordinate?"""
    if isinstance(piece, Pfaffian):
        return name in piece.coefficients and not _zero(derived, piece.coefficients[name])
    symbol = ex.coordinate(name) if isinstance(piece, Finite) else ex.velocity(name)
    return not _zero(derived, diff(piece.expr, symbol))


def _workless(piece: Remaining, derived: Derived) -> bool:
    """Does the constraint's force do no work in the motion itself?"""
    if isinstance(piece, Pfaffian):
        return _zero(derived, piece.dt)
    return not isinstance(piece, Nonlinear) and _zero(derived, diff(piece.expr, ex.TIME))
