"""The energies of a tree of bodies in space in the angles and displacements of its joints.

A body's point that is drawn at a stands at g(a); over a joint g' = g o J, with J a turn or a shift by q written at the
reference. Velocities are kept in the axes of each body: c = R^T (velocity of a point), s = R^T (angular velocity).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import parse_relations
from dofkit.expressions.text.names import Names, valid_name
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

#: Said of the coordinates.
COUNTED = "Joint angles and displacements are measured from the reference configuration: {}."
_AXES = tuple(unit(i, 3) for i in range(3))


class JointStep(NamedTuple):
    """A part of a joint's motion: a turn about ``along`` through ``at``, or a shift along it, by ``amount``."""

    along: Vec
    at: Vec | None
    amount: Expr
    rate: Expr

    def back(self) -> JointStep:
        """The motion of the first body against the second."""
        return self._replace(amount=-self.amount, rate=-self.rate)


class MovingBody(NamedTuple):
    """How a body moves: ``velocity`` of its point drawn at ``point``, its ``spin``, and gravity's ``pull``, all in its
    axes; ``fall``: gravity times where that point stands."""

    point: Vec
    velocity: Vec
    spin: Vec
    pull: Vec
    fall: Expr

    def at(self, point: Vec) -> MovingBody:
        """The same, about another point."""
        arm = minus(point, self.point)
        return MovingBody(
            point, plus(self.velocity, cross(self.spin, arm)), self.spin, self.pull, self.fall + dot(self.pull, arm)
        )

    def after(self, step: JointStep) -> MovingBody:
        """The body that a step carries."""
        along = step.along
        if step.at is None:
            more = plus(cross(self.spin, scaled(step.amount, along)), scaled(step.rate, along))
            fall = self.fall + step.amount * dot(self.pull, along)
            return self._replace(velocity=plus(self.velocity, more), fall=fall)
        here = self.at(step.at)
        spin = plus(_turned_back(step, here.spin), scaled(step.rate, along))
        return here._replace(velocity=_turned_back(step, here.velocity), spin=spin, pull=_turned_back(step, here.pull))


def _turned_back(step: JointStep, v: Vec) -> Vec:
    """A direction of the first body in the axes of the second: (u.v) u + cos q (v - (u.v) u) - sin q u x v."""
    parallel = scaled(dot(step.along, v), step.along)
    across, turned = minus(v, parallel), cross(step.along, v)
    cosine, sine = ex.fn("cos", step.amount), ex.fn("sin", step.amount)
    return plus(parallel, scaled(cosine, across), scaled(-sine, turned))


@dataclass(frozen=True)
class JointMotion:
    """A scene in which joints' angles and displacements are the coordinates, as a mapping; and its energies."""

    value: Mapping[str, object]
    energy: Energy


def joint_motion(scene: Scene, drawing: Drawing, system: System) -> JointMotion | None:
    """The motion of a tree in space; None of what is none, or has particles, other forces than gravity, or screws."""
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
    """Reads a tree; ``names``: the coordinate for each angle and displacement, as far as they were met."""

    scene: Scene
    drawing: Drawing
    system: System
    names: dict[str, str]

    def _named(self, quantity: str) -> str:
        """The coordinate of an angle or displacement, ``shoulder.angle``: ``shoulder_angle``, or the like."""
        taken = {*self.names.values(), *self.system.parameters, *self.system.functions}
        name = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in quantity).strip("_")
        name = name if name[:1].isalpha() else f"q_{name}"
        while name in taken or valid_name(name) is not None:
            name += "_"
        self.names[quantity] = name
        return name

    def steps_of(self, joint: Connection) -> list[JointStep] | None:
        """What the second body of a joint does against the first; None of a screw, or of general position."""
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
        """T and V in the coordinates of joints; None where not every body hangs on the ground."""
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
                other, coordinate = (second, steps) if body == first else (first, [s.back() for s in reversed(steps)])
                moving[other] = moving[body]
                for step in coordinate:
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
        note = COUNTED.format(", ".join(f"{coordinate} is {name}" for name, coordinate in self.names.items()))
        return None if worlds.faults else Energy(ex.add(*kinetic), ex.add(*potential), ZERO, {}, (note,))

    def couplings(self) -> list[str] | None:
        """Relations between joints as texts; None where one mentions what is no coordinate here."""
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
        """The coordinate that a coupling means by a joint's name, with what is meant of it or alone."""
        alone = [
            coordinate
            for quantity, coordinate in self.names.items()
            if quantity == name or quantity.rpartition(".")[0] == name
        ]
        return alone[0] if len(alone) == 1 else None


def _line_of(what: str, number: int, lines: Sequence[Vec]) -> tuple[Vec, bool]:
    """The line of a part of a joint's motion, and whether it turns about it.

    A rotation turns about x, y and z; of a plane's motion the displacements are across its normal.
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
    """From directions of the reference configuration to the body's own axes."""
    return transposed(euler(*frame.initial))
