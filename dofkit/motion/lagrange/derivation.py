"""Lagrange's equations d/dt dL/dqdot - dL/dq + sum lam a = Q [Lagrange1788] in readable form, derived by SymPy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows, sparse
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.motion.lagrange.model import LagrangeModel, NoEquationsError
from dofkit.motion.lagrange.tidying import Tidier, ordered

#: Random points over GF(p) at which a rank is computed, and the most points that are tried.
POINTS, ATTEMPTS = 3, 20
SINGULAR = "The kinetic energy is degenerate: these equations do not determine all accelerations."


def _at_points(model: LagrangeModel, rows: Sequence[Sequence[Expr]]) -> Iterator[tuple[list[SparseRow], int]]:
    """Yield (rows modulo p, p) of a matrix at random points where it has a value."""
    ring = Ring([e for row in rows for e in row], model.positive)
    nodes = [[ring.node(e) for e in row] for row in rows]
    for seed in range(ATTEMPTS):
        point = field_point([ring], 300 + seed)
        try:
            at = values(ring, point)
        except NoValueError:
            continue
        yield list(sparse([at[i] for i in row] for row in nodes)), point.p


@dataclass(frozen=True)
class Derived:
    """Lagrange's equations e = 0, momenta and generalized forces by remaining coordinate; names of multipliers."""

    model: LagrangeModel
    lagrangian: Expr
    momenta: dict[str, Expr]
    forces: dict[str, Expr]
    equations: dict[str, Expr]
    multipliers: tuple[str, ...]

    def is_degenerate(self) -> bool:
        """Return whether [[M, A^T], [A, 0]], of masses M and constraints A, is singular at random points.

        If so, the equations do not determine all accelerations. Raises NoEquationsError if an equation is a constant
        other than 0, or no velocity occurs in the energies.
        """
        model = self.model
        multipliers = [ex.parameter(n) for n in self.multipliers]
        for name, e in self.equations.items():
            constant = all(s.args[0] == "parameter" for s in e.symbols) and e.symbols.isdisjoint(multipliers)
            if constant and not e.is_zero:
                raise NoEquationsError(f"there is no motion: Lagrange's equation for {name} reads {to_text(e)} = 0")
        if model.names and not any(s.args[0] == "velocity" for s in self.lagrangian.symbols):
            raise NoEquationsError("the kinetic energy holds no velocity, so no equations of motion can be derived")
        unknown = [*(ex.sym("acceleration", n) for n in model.names), *multipliers]
        rows = [[diff(e, s) for s in unknown] for e in self.equations.values()]
        rows += [[*(slopes[n] for n in model.names), *(ZERO for _ in multipliers)] for slopes in model.slopes]
        ranks = [rank_of_rows(m, p) for (m, p), _ in zip(_at_points(model, rows), range(POINTS), strict=False)]
        return bool(rows) and len(ranks) == POINTS and max(ranks) < len(rows)

    def sympys_method(self) -> Any:
        """Return SymPy's LagrangesMethod of the model; its equations are not yet formed."""
        return sympys_method(self.model, Bridge(self.model.names, self.model.positive))


def derive(model: LagrangeModel) -> Derived:
    """Return Lagrange's equations of a model. Raises UntranslatableError if SymPy's result cannot be converted back."""
    bridge = Bridge(model.names, model.positive)
    method, tidy, multipliers = sympys_method(model, bridge), Tidier(bridge, model.positive), _multipliers(model)
    formed = list(method.form_lagranges_equations()) if model.names else []
    symbols = [bridge.to_sympy(ex.parameter(name)) for name in multipliers]
    swapped = dict(zip(getattr(method, "lam_vec", ()) or (), symbols, strict=False))
    equations = {n: tidy(e.xreplace(swapped)) for n, e in zip(model.names, formed, strict=True)}
    if not multipliers:
        equations = {n: without_exponentials(e, model.positive) for n, e in equations.items()}
    lagrangian = bridge.to_sympy(model.energy.lagrangian)
    momenta, forces = {}, {}
    for n, q in bridge.positions.items():
        momenta[n] = tidy(lagrangian.diff(bridge.velocity(n)))
        forces[n] = tidy(lagrangian.diff(q) + bridge.to_sympy(model.applied(n)))
    return Derived(model, tidy(lagrangian), momenta, forces, equations, multipliers)


def sympys_method(model: LagrangeModel, bridge: Bridge) -> Any:
    """Return SymPy's LagrangesMethod of a model; its equations are not yet formed."""
    from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame

    frame, loads = ReferenceFrame("N"), []
    for n, q in bridge.positions.items():
        force = bridge.to_sympy(model.applied(n))
        if force != 0:
            point = Point(f"P_{n}")
            point.set_vel(frame, q.diff() * frame.x)
            loads.append((point, force * frame.x))
    return LagrangesMethod(
        bridge.to_sympy(model.energy.lagrangian),
        list(bridge.positions.values()),
        forcelist=loads or None,
        frame=frame if loads else None,
        hol_coneqs=[bridge.to_sympy(g) for g in model.holonomic] or None,
        nonhol_coneqs=[bridge.to_sympy(r) for r in model.nonholonomic] or None,
    )


def without_exponentials(e: Expr, positive: frozenset[Expr]) -> Expr:
    """Return ``e``, the left side of e = 0, divided by the exponentials that are common to all its terms."""
    for node in sorted((n for n in ex.nodes(e) if n.op == "fn" and n.args[0] == "exp"), key=to_text):
        over = ex.power(node, ex.MINUS_ONE)
        terms = e.args if e.op == "add" else (e,)
        quotient = ex.add(*(ex.mul(*(t.args if t.op == "mul" else (t,)), over) for t in terms))
        if node not in set(ex.nodes(quotient)) and is_identically_zero(quotient * node - e, positive) is True:
            e = ordered(quotient)
    return e


def _multipliers(model: LagrangeModel) -> tuple[str, ...]:
    """Return names for the multipliers, lam1, lam2, ..., or others if the scene uses these."""
    system = model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    numbers = range(1, len(model.constraints) + 1)
    stems = ("lam", "lambda_", "mult", "multiplier_", "Lagrange_multiplier_")
    stem = next(s for s in stems if taken.isdisjoint(f"{s}{i}" for i in numbers))
    return tuple(f"{stem}{i}" for i in numbers)
