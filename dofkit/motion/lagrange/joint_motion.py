"""The energies of a tree of bodies in space in the angles and displacements of its joints.

A body's point at ``a`` of the reference is at g(a). Across a joint g' = g o J, J a rotation or a translation by q,
written in the reference. Velocities are in the axes of each body, R its rotation: c = R^T (velocity of a point),
s = R^T (angular velocity).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import parse_relations
from dofkit.expressions.text.names import Names, why_invalid
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import HALF, ZERO, Expr
from dofkit.expressions.vectors import (
    Vec,
    apply,
    cross,
    dot,
    is_zero,
    length,
    minus,
    plus,
    scaled,
    square,
    transposed,
    unit,
)
from dofkit.mobility.joint_tree import tree_coordinates
from dofkit.motion.lagrange.energies import Energy, EntryWorlds, gravity_of, masses, spin_energy
from dofkit.scene.constraints.coupling import Coupling
from dofkit.scene.drawing import Drawing
from dofkit.scene.frames import Frame, euler
from dofkit.scene.scene import Scene
from dofkit.system import GROUND, Connection, System

#: The note on the coordinates.
COUNTED = "Joint angles and displacements are measured from the reference configuration: {}."
_AXES = tuple(unit(i, 3) for i in range(3))


class JointStep(NamedTuple):
    """A part of a joint's motion, by ``amount``: rotation about ``along`` through ``at``, or (at None) translation."""

    along: Vec
    at: Vec | None
    amount: Expr
    rate: Expr

    def back(self) -> JointStep:
        """Return the motion of the first body relative to the second."""
        return self._replace(amount=-self.amount, rate=-self.rate)


class MovingBody(NamedTuple):
    """A body's motion in its axes: ``velocity`` of its material point at ``point`` of the reference, angular velocity
    ``spin``, acceleration of gravity ``pull``; ``fall``: gravity times the position of that point."""

    point: Vec
    velocity: Vec
    spin: Vec
    pull: Vec
    fall: Expr

    def at(self, point: Vec) -> MovingBody:
        """Return the same motion, stated for another point."""
        arm = minus(point, self.point)
        return MovingBody(
            point, plus(self.velocity, cross(self.spin, arm)), self.spin, self.pull, self.fall + dot(self.pull, arm)
        )

    def after(self, step: JointStep) -> MovingBody:
        """Return the motion of the next body, which moves by ``step`` relative to this one."""
        along = step.along
        if step.at is None:
            more = plus(cross(self.spin, scaled(step.amount, along)), scaled(step.rate, along))
            fall = self.fall + step.amount * dot(self.pull, along)
            return self._replace(velocity=plus(self.velocity, more), fall=fall)
        here = self.at(step.at)
        spin = plus(_turned_back(step, here.spin), scaled(step.rate, along))
        return here._replace(velocity=_turned_back(step, here.velocity), spin=spin, pull=_turned_back(step, here.pull))


def _turned_back(step: JointStep, v: Vec) -> Vec:
    """Return v rotated by -q about the axis u: (u.v) u + cos q (v - (u.v) u) - sin q u x v."""
    parallel = scaled(dot(step.along, v), step.along)
    across, turned = minus(v, parallel), cross(step.along, v)
    cosine, sine = ex.fn("cos", step.amount), ex.fn("sin", step.amount)
    return plus(parallel, scaled(cosine, across), scaled(-sine, turned))


@dataclass(frozen=True)
class JointMotion:
    """A scene, as a mapping, whose coordinates are joint angles and displacements; and its energies."""

    value: Mapping[str, object]
    energy: Energy


def joint_motion(scene: Scene, drawing: Drawing, system: System) -> JointMotion | None:
    """Return the motion of a spatial tree; None for scenes with loops, particles, screws, or forces but gravity."""
    kinds = {force.type for force in scene.forces}
    if scene.dimension != 3 or scene.particles or scene.coordinates or kinds - {"gravity"} or len(scene.bodies) < 2:
        return None
    if scene.energies is not None or tree_coordinates(system) is None:
        return None
    reader = _TreeReader(scene, drawing, system, {})
    steps = [reader.steps_of(c) for c in system.joints]
    complete = [of_joint for of_joint in steps if of_joint is not None]
    couplings = reader.couplings()
    if len(complete) < len(steps) or couplings is None:
        return None
    energy = reader.energy({c.members: of_pair for c, of_pair in zip(system.joints, complete, strict=True)})
    if energy is None:
        return None
    kept = {"name": scene.name, "title": scene.title, "parameters": scene.parameters, "functions": scene.functions}
    value = {key: part for key, part in kept.items() if part} | {"coordinates": [*reader.names.values()]}
    return JointMotion({**value, "constraints": couplings}, energy)


@dataclass
class _TreeReader:
    """Reads a tree; ``names``: {angle or displacement read so far, such as ``shoulder.angle``: its coordinate}."""

    scene: Scene
    drawing: Drawing
    system: System
    names: dict[str, str]

    def _named(self, quantity: str) -> str:
        """Return the new coordinate of an angle or displacement ``shoulder.angle``, ``shoulder_angle`` or similar."""
        taken = {*self.names.values(), *self.system.parameters, *self.system.functions}
        name = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in quantity).strip("_")
        name = name if name[:1].isalpha() else f"q_{name}"
        while name in taken or why_invalid(name) is not None:
            name += "_"
        self.names[quantity] = name
        return name

    def steps_of(self, joint: Connection) -> list[JointStep] | None:
        """Return the steps from a joint's first body to its second; None for a screw or a joint in general position."""
        name = self.system.constraints[joint.constraint].name
        place = joint.places[0] if joint.places else None
        lines = [direction for direction in joint.directions if direction is not None]
        if joint.facts.by_turn or len(lines) < len(joint.directions) or (joint.places and place is None):
            return None
        steps = []
        for number, what in enumerate(joint.facts.freedoms):
            q = self._named(f"{name}.{what}")
            along, turns = _line_of(what, number, lines)
            at = place if turns else None
            if turns and at is None:
                return None
            steps.append(JointStep(scaled(ex.ONE / length(along), along), at, ex.coordinate(q), ex.velocity(q)))
        return steps

    def energy(self, joints: Mapping[tuple[str, ...], list[JointStep]]) -> Energy | None:
        """Return T and V in joint coordinates; None if not every body is connected to the ground, or after a fault."""
        worlds = EntryWorlds(self.drawing)
        pull = gravity_of(self.scene, worlds)
        zero = (ZERO,) * 3
        moving = {GROUND: MovingBody(zero, zero, zero, pull, ZERO)}
        waiting = deque([GROUND])
        while waiting:
            body = waiting.popleft()
            for (first, second), steps in joints.items():
                if body not in (first, second) or {first, second} <= moving.keys():
                    continue
                other, path = (second, steps) if body == first else (first, [s.back() for s in reversed(steps)])
                moving[other] = moving[body]
                for step in path:
                    moving[other] = moving[other].after(step)
                waiting.append(other)
        if len(moving) <= len(self.scene.bodies):
            return None
        kinetic, potential = [], []
        for (world, m, _), part in zip(masses(self.scene, worlds), self.scene.bodies, strict=True):
            frame = world.frames[part.name]
            centre = moving[part.name].at(frame.start)
            kinetic.append(HALF * m * square(centre.velocity))
            kinetic.append(spin_energy(world, part.inertia, part.name, apply(_axes_back(frame), centre.spin)))
            potential.append(-m * centre.fall)
        note = COUNTED.format(", ".join(f"{path} is {name}" for name, path in self.names.items()))
        return None if worlds.faults else Energy(ex.add(*kinetic), ex.add(*potential), ZERO, {}, (note,))

    def couplings(self) -> list[str] | None:
        """Return the equations of the couplings as texts; None if one mentions another quantity than a coordinate."""
        texts = []
        for written in self.scene.constraints:
            if not isinstance(written, Coupling):
                continue
            coordinates = {letter: self._measured(name) for letter, name in written.lettered.items()}
            letters = frozenset(coordinates)
            table = self.drawing.vocabulary.names
            names = Names(letters, table.parameters, table.functions, table.arguments)
            for relation in parse_relations(written.text, names):
                if relation.relation != "=":
                    continue
                renaming = {ex.coordinate(letter): ex.coordinate(name) for letter, name in coordinates.items() if name}
                if len(renaming) < len(coordinates):
                    return None
                texts.append(f"{to_text(substitute(relation.left - relation.right, renaming))} = 0")
        return texts

    def _measured(self, name: str) -> str | None:
        """Return the coordinate of a coupling's name, ``shoulder`` or ``shoulder.angle``; None if it is not unique."""
        alone = [
            coordinate
            for quantity, coordinate in self.names.items()
            if quantity == name or quantity.rpartition(".")[0] == name
        ]
        return alone[0] if len(alone) == 1 else None


def _line_of(what: str, number: int, lines: Sequence[Vec]) -> tuple[Vec, bool]:
    """Return (axis of a part of a joint's motion, whether it is a rotation).

    A spherical joint has rotations about x, y and z; a planar joint has displacements perpendicular to its normal.
    """
    if what.startswith("rotation"):
        return _AXES[number], True
    if what.startswith("angle"):
        return lines[number if len(lines) > 1 else 0], True
    if what == "displacement":
        return lines[0], False
    first = next(across for across in (cross(lines[0], axis) for axis in _AXES) if not is_zero(across))
    return (first, cross(lines[0], first))[number], False


def _axes_back(frame: Frame) -> tuple[Vec, ...]:
    """Return the matrix from directions of the reference configuration to the body's axes."""
    return transposed(euler(*frame.initial))
