"""What SymPy's mechanics needs: `Handover` is ready for LagrangesMethod and KanesMethod."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.sparse import last_columns, sparse
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.model import LagrangeModel

#: Random points that are tried.
ATTEMPTS = 20


@dataclass(frozen=True)
class Handover:
    """A system in SymPy's terms.

    ``coordinates`` q and ``speeds`` u = qdot (dynamic symbols), ``kinematics`` (u - qdot = 0), ``lagrangian`` in q and
    qdot, ``configuration`` and ``velocity`` constraints as expressions that are 0, generalized ``forces`` by position,
    ``eliminated`` coordinates as functions of those kept. ``tied_coordinates`` and ``tied_speeds`` are the places of
    as many as the constraints fix by the others. ``loads`` and ``frame`` carry the forces: each acts on a point that
    moves along an axis of the frame with the velocity of its coordinate.
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
        """u - qdot."""
        return tuple(u - q.diff() for u, q in zip(self.speeds, self.coordinates, strict=True))

    @cached_property
    def frame(self) -> Any:
        """The frame in which the forces act."""
        from sympy.physics.mechanics import ReferenceFrame

        return ReferenceFrame("N")

    @cached_property
    def loads(self) -> list[tuple[Any, Any]]:
        """(point, force) for every generalized force that is not 0."""
        from sympy.physics.mechanics import Point

        found = []
        for i, (q, force) in enumerate(zip(self.coordinates, self.forces, strict=True)):
            if force != 0:
                point = Point(f"P{i + 1}")
                point.set_vel(self.frame, q.diff() * self.frame.x)
                found.append((point, force * self.frame.x))
        return found

    def lagranges_method(self) -> Any:
        """SymPy's LagrangesMethod, its equations not yet formed."""
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
        """The keyword arguments of KanesMethod that describe coordinates, speeds and constraints."""
        swapped = {q.diff(): u for q, u in zip(self.coordinates, self.speeds, strict=True)}
        rates = [g.diff() for g in self.configuration] + list(self.velocity)
        q_free, q_tied = _parted(self.coordinates, self.tied_coordinates)
        u_free, u_tied = _parted(self.speeds, self.tied_speeds)
        found: dict[str, Any] = {"q_ind": q_free, "u_ind": u_free, "kd_eqs": list(self.kinematics)}
        if q_tied:
            found |= {"q_dependent": q_tied, "configuration_constraints": list(self.configuration)}
        if u_tied:
            found |= {"u_dependent": u_tied, "velocity_constraints": [r.xreplace(swapped) for r in rates]}
        return found


def _parted(given: tuple[Any, ...], tied: tuple[int, ...]) -> tuple[list[Any], list[Any]]:
    return [g for i, g in enumerate(given) if i not in tied], [given[i] for i in tied]


def _tied(model: LagrangeModel, rows: Sequence[Sequence[Expr]]) -> tuple[int, ...]:
    """Columns, the last ones possible, in which the rows are independent at a random point over GF(p)."""
    if not rows:
        return ()
    ring = Ring([e for row in rows for e in row], model.positive)
    nodes = [[ring.node(e) for e in row] for row in rows]
    for seed in range(ATTEMPTS):
        point = field_point([ring], seed)
        try:
            found = values(ring, point)
        except NoValueError:
            continue
        return last_columns(sparse([found[i] for i in row] for row in nodes), len(model.names), point.p)
    return tuple(range(len(model.names) - len(rows), len(model.names)))


def handover(model: LagrangeModel, bridge: Bridge) -> Handover:
    """A model in SymPy's terms."""
    from sympy import Function

    taken = {*bridge.positions, *model.study.system.parameters, *model.study.system.functions}
    stem = "u" if not any(f"u_{n}" in taken for n in model.names) else "speed"
    energy = model.energy
    finite = [[diff(g, ex.coordinate(n)) for n in model.names] for g in model.holonomic]
    moving = [[diff(r, ex.velocity(n)) for n in model.names] for r in model.nonholonomic]
    forces = []
    for name in model.names:
        friction = diff(energy.dissipation, ex.velocity(name))
        forces.append(bridge.sympy(energy.forces.get(name, ex.ZERO) - friction))
    return Handover(
        tuple(bridge.positions[n] for n in model.names),
        tuple(Function(f"{stem}_{n}", real=True)(bridge.time) for n in model.names),
        bridge.sympy(energy.lagrangian),
        tuple(bridge.sympy(g) for g in model.holonomic),
        tuple(bridge.sympy(g) for g in model.nonholonomic),
        tuple(forces),
        {bridge.positions[n]: bridge.sympy(e) for n, e in model.elimination.solved.items()},
        _tied(model, finite),
        _tied(model, [*finite, *moving]),
    )
