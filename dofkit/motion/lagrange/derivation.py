"""Lagrange's equations d/dt dL/dqdot - dL/dq = Q + sum lam a [Lagrange1788], by SymPy's mechanics, in readable form.

`Handover` has a system in SymPy's terms, ready for LagrangesMethod and KanesMethod; `derive` writes what the first of
them forms as expressions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.sparse import SparseRow, last_columns, rank_of_rows, sparse
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

#: Points of GF(p) at which a rank is taken, and how many are tried for them.
POINTS, ATTEMPTS = 3, 20
SINGULAR = "The kinetic energy is degenerate: these equations do not determine all accelerations."


@dataclass(frozen=True)
class Handover:
    """A system in SymPy's terms.

    Attributes
    ----------
    coordinates, speeds
        q and u = qdot, dynamic symbols.
    lagrangian
        L in q and qdot.
    configuration, velocity
        Constraints as expressions that are 0.
    forces
        Non-conservative generalized forces, in the order of the coordinates.
    eliminated
        Coordinates as functions of those kept.
    tied_coordinates, tied_speeds
        The positions of as many as the constraints fix by the others.
    """

    coordinates: tuple[Any, ...]
    speeds: tuple[Any, ...]
    lagrangian: Any
    configuration: tuple[Any, ...]
    velocity: tuple[Any, ...]
    forces: tuple[Any, ...]
    eliminated: dict[Any, Any]
    tied_coordinates: tuple[int, ...] = ()
    tied_speeds: tuple[int, ...] = ()

    @property
    def kinematics(self) -> tuple[Any, ...]:
        """The kinematic equations u - qdot = 0."""
        return tuple(u - q.diff() for u, q in zip(self.speeds, self.coordinates, strict=True))

    @cached_property
    def frame(self) -> Any:
        """The frame in which the forces act."""
        from sympy.physics.mechanics import ReferenceFrame

        return ReferenceFrame("N")

    @cached_property
    def loads(self) -> list[tuple[Any, Any]]:
        """A (point, force) for every force that is not 0; the point moves with the velocity of the coordinate."""
        from sympy.physics.mechanics import Point

        loads = []
        for i, (q, force) in enumerate(zip(self.coordinates, self.forces, strict=True)):
            if force != 0:
                point = Point(f"P{i + 1}")
                point.set_vel(self.frame, q.diff() * self.frame.x)
                loads.append((point, force * self.frame.x))
        return loads

    def lagranges_method(self) -> Any:
        """Return SymPy's LagrangesMethod, its equations not yet formed."""
        from sympy.physics.mechanics import LagrangesMethod

        return LagrangesMethod(
            self.lagrangian,
            list(self.coordinates),
            forcelist=self.loads or None,
            frame=self.frame if self.loads else None,
            hol_coneqs=list(self.configuration) or None,
            nonhol_coneqs=list(self.velocity) or None,
        )

    def kanes_arguments(self) -> dict[str, Any]:
        """Return the keyword arguments of KanesMethod that describe coordinates, speeds and constraints."""
        swapped = {q.diff(): u for q, u in zip(self.coordinates, self.speeds, strict=True)}
        rates = [g.diff() for g in self.configuration] + list(self.velocity)
        q_free, q_tied = _separated(self.coordinates, self.tied_coordinates)
        u_free, u_tied = _separated(self.speeds, self.tied_speeds)
        arguments: dict[str, Any] = {"q_ind": q_free, "u_ind": u_free, "kd_eqs": list(self.kinematics)}
        if q_tied:
            arguments |= {"q_dependent": q_tied, "configuration_constraints": list(self.configuration)}
        if u_tied:
            arguments |= {"u_dependent": u_tied, "velocity_constraints": [r.xreplace(swapped) for r in rates]}
        return arguments


def _separated(symbols: tuple[Any, ...], tied: tuple[int, ...]) -> tuple[list[Any], list[Any]]:
    return [s for i, s in enumerate(symbols) if i not in tied], [symbols[i] for i in tied]


def _handover(model: LagrangeModel, bridge: Bridge) -> Handover:
    from sympy import Function

    taken = {*bridge.positions, *model.study.system.parameters, *model.study.system.functions}
    stem = "u" if not any(f"u_{n}" in taken for n in model.names) else "speed"
    energy = model.energy
    finite = [[diff(g, ex.coordinate(n)) for n in model.names] for g in model.holonomic]
    moving = [[diff(r, ex.velocity(n)) for n in model.names] for r in model.nonholonomic]
    friction = {n: diff(energy.dissipation, ex.velocity(n)) for n in model.names}
    return Handover(
        tuple(bridge.positions[n] for n in model.names),
        tuple(Function(f"{stem}_{n}", real=True)(bridge.time) for n in model.names),
        bridge.sympy(energy.lagrangian),
        tuple(bridge.sympy(g) for g in model.holonomic),
        tuple(bridge.sympy(g) for g in model.nonholonomic),
        tuple(bridge.sympy(energy.forces.get(n, ZERO) - friction[n]) for n in model.names),
        {bridge.positions[n]: bridge.sympy(e) for n, e in model.elimination.solved.items()},
        _tied(model, finite),
        _tied(model, [*finite, *moving]),
    )


def _tied(model: LagrangeModel, rows: Sequence[Sequence[Expr]]) -> tuple[int, ...]:
    """Return columns, the last ones possible, in which the rows are independent at a random point over GF(p)."""
    if not rows:
        return ()
    numbers, p = next(_at_points(model, rows), (None, 0))
    if numbers is None:
        return tuple(range(len(model.names) - len(rows), len(model.names)))
    return last_columns(numbers, len(model.names), p)


def _at_points(model: LagrangeModel, rows: Sequence[Sequence[Expr]]) -> Iterator[tuple[list[SparseRow], int]]:
    """Yield a matrix modulo p at random points, and p."""
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
    """The equations (each is zero), momenta and generalized forces of the coordinates kept; multipliers by name."""

    model: LagrangeModel
    lagrangian: Expr
    momenta: dict[str, Expr]
    forces: dict[str, Expr]
    equations: dict[str, Expr]
    multipliers: tuple[str, ...]
    handover: Handover

    def is_degenerate(self) -> bool:
        """Return whether [[M, A^T], [A, 0]] is singular at random points, so that accelerations are not determined.

        Raises NoEquationsError where an equation says that a number is 0, or nothing in the energies moves.
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
        zeros = [ZERO for _ in multipliers]
        rows += [[*(diff(g, ex.coordinate(n)) for n in model.names), *zeros] for g in model.holonomic]
        rows += [[*(diff(r, ex.velocity(n)) for n in model.names), *zeros] for r in model.nonholonomic]
        ranks = [
            rank_of_rows(matrix, p) for (matrix, p), _ in zip(_at_points(model, rows), range(POINTS), strict=False)
        ]
        return bool(rows) and len(ranks) == POINTS and max(ranks) < len(rows)


def derive(model: LagrangeModel) -> Derived:
    """Return Lagrange's equations of a model. Raises UntranslatableError where SymPy's result cannot be written."""
    bridge = Bridge([c.name for c in model.study.system.coordinates], model.positive)
    handover = _handover(model, bridge)
    method = handover.lagranges_method()
    tidy = Tidier(bridge, model.positive)
    formed = list(method.form_lagranges_equations()) if model.names else []
    multipliers = _multipliers(model)
    symbols = [bridge.sympy(ex.parameter(name)) for name in multipliers]
    swapped = dict(zip(getattr(method, "lam_vec", ()) or (), symbols, strict=False))
    equations = {n: tidy(e.xreplace(swapped)) for n, e in zip(model.names, formed, strict=True)}
    if not multipliers:
        equations = {n: without_exponentials(e, model.positive) for n, e in equations.items()}
    lagrangian = handover.lagrangian
    momenta, forces = {}, {}
    for n, force in zip(model.names, handover.forces, strict=True):
        momenta[n] = tidy(lagrangian.diff(bridge.velocity(n)))
        forces[n] = tidy(lagrangian.diff(bridge.positions[n]) + force)
    return Derived(model, tidy(lagrangian), momenta, forces, equations, multipliers, handover)


def without_exponentials(e: Expr, positive: frozenset[Expr]) -> Expr:
    """Return an expression that is 0 divided by an exponential that all its terms hold, which is never 0."""
    for node in sorted((n for n in ex.nodes(e) if n.op == "fn" and n.args[0] == "exp"), key=to_text):
        over = ex.power(node, ex.MINUS_ONE)
        terms = e.args if e.op == "add" else (e,)
        quotient = ex.add(*(ex.mul(*(t.args if t.op == "mul" else (t,)), over) for t in terms))
        if node not in set(ex.nodes(quotient)) and is_identically_zero(quotient * node - e, positive) is True:
            e = ordered(quotient)
    return e


def _multipliers(model: LagrangeModel) -> tuple[str, ...]:
    """Return lam1, lam2, ..., or the like where the scene has such names."""
    system = model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    numbers = range(1, len(model.constraints) + 1)
    stems = ("lam", "lambda_", "mult", "multiplier_", "Lagrange_multiplier_")
    stem = next(s for s in stems if taken.isdisjoint(f"{s}{i}" for i in numbers))
    return tuple(f"{stem}{i}" for i in numbers)
