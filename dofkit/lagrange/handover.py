"""What SymPy's mechanics needs: `Handover` is ready for LagrangesMethod and KanesMethod."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dofkit import expr as ex
from dofkit.lagrange.bridge import Bridge
from dofkit.lagrange.model import Model


@dataclass(frozen=True)
class Handover:
    """A system in SymPy's terms.

    ``coordinates`` q and ``speeds`` u = qdot (dynamic symbols), ``kinematics`` (u - qdot = 0), ``lagrangian`` in q and
    qdot, ``configuration`` and ``velocity`` constraints as expressions that are 0, generalized ``forces`` by position,
    ``eliminated`` coordinates as functions of those kept. ``loads`` and ``frame`` carry the forces: each acts on a
    point that moves along an axis of the frame with the velocity of its coordinate.
    """

    coordinates: tuple[Any, ...]
    speeds: tuple[Any, ...]
    lagrangian: Any
    configuration: tuple[Any, ...]
    velocity: tuple[Any, ...]
    forces: tuple[Any, ...]
    eliminated: dict[Any, Any]

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
        """The keyword arguments of KanesMethod that describe coordinates, speeds and constraints.

        With as many dependent coordinates and speeds as there are constraints: the last ones.
        """
        n, holds, moves = len(self.coordinates), len(self.configuration), len(self.configuration) + len(self.velocity)
        swapped = {q.diff(): u for q, u in zip(self.coordinates, self.speeds, strict=True)}
        rates = [g.diff() for g in self.configuration] + list(self.velocity)
        found: dict[str, Any] = {
            "q_ind": list(self.coordinates[: n - holds]),
            "u_ind": list(self.speeds[: n - moves]),
            "kd_eqs": list(self.kinematics),
        }
        if holds:
            found |= {"q_dependent": list(self.coordinates[n - holds :])}
            found |= {"configuration_constraints": list(self.configuration)}
        if moves:
            found |= {"u_dependent": list(self.speeds[n - moves :])}
            found |= {"velocity_constraints": [r.xreplace(swapped) for r in rates]}
        return found


def handover(model: Model, bridge: Bridge) -> Handover:
    """A model in SymPy's terms."""
    from sympy import Function

    taken = {*bridge.positions, *model.study.system.parameters, *model.study.system.functions}
    stem = "u" if not any(f"u_{n}" in taken for n in model.names) else "speed"
    energy = model.energy
    forces = []
    for name in model.names:
        friction = ex.diff(energy.dissipation, ex.velocity(name))
        forces.append(bridge.sympy(energy.forces.get(name, ex.ZERO) - friction))
    return Handover(
        tuple(bridge.positions[n] for n in model.names),
        tuple(Function(f"{stem}_{n}", real=True)(bridge.time) for n in model.names),
        bridge.sympy(energy.lagrangian),
        tuple(bridge.sympy(g) for g in model.holonomic),
        tuple(bridge.sympy(g) for g in model.nonholonomic),
        tuple(forces),
        {bridge.positions[n]: bridge.sympy(e) for n, e in model.elimination.solved.items()},
    )
