"""Warnings about joints that mean something else than they seem to say.

Gears whose wheel turns on a moving arm: without ``carrier`` their ratio is one of angles against the ground. A motor
that is written as a second joint: its bodies are joined twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from dofkit.system import GROUND, Connection, Constraint


class _Pair(NamedTuple):
    """Two bodies that turn against each other, or are held together."""

    one: str
    other: str

    def beside(self, body: str) -> str | None:
        """The other body; None where ``body`` is none of the two."""
        if body not in self:
            return None
        return self.other if body == self.one else self.one


def carrier_warnings(constraints: Sequence[Constraint], connections: Sequence[Connection]) -> Iterator[str]:
    """A warning for each pair of gears without a carrier of which a wheel turns on a body that moves."""
    gears = [c for c in connections if c.facts.geared and len(c.members) == 2]
    if not gears:
        return
    still = _held(connections)
    hinges = [_Pair(*c.members) for c in connections if c.facts.axial and c.facts.planar_pair and len(c.members) == 2]
    for gear in gears:
        for wheel in gear.members:
            arms = [arm for pair in hinges if (arm := pair.beside(wheel)) is not None]
            if any(arm in still for arm in arms):
                continue
            for arm in [arm for arm in arms if arm not in gear.members][:1]:
                name = constraints[gear.constraint].name
                yield (
                    f"'{name}': the wheel '{wheel}' turns on '{arm}', which moves; without `carrier` the ratio is that "
                    f"of the angles against the ground. If '{arm}' carries the gears, write `carrier: {arm}`."
                )


def motor_warnings(constraints: Sequence[Constraint], connections: Sequence[Connection]) -> Iterator[str]:
    """Yield a warning for each driven joint that repeats another joint of the same bodies, at the same place."""
    joints = [c for c in connections if c.facts.joint and len(c.members) == 2]
    for motor in joints:
        for joint in joints if motor.driven else ():
            if joint is motor or not _repeats(motor, joint):
                continue
            name, other = constraints[motor.constraint].name, constraints[joint.constraint].name
            yield (
                f"'{name}' and '{other}' join '{motor.members[0]}' and '{motor.members[1]}' at the same place, so "
                f"their equations occur twice. If '{name}' is the motor of '{other}', write its `drive` on "
                f"'{other}' and remove '{name}'."
            )


def _repeats(motor: Connection, joint: Connection) -> bool:
    """Return whether two joints of one type connect the same bodies in the same geometry, which is given."""
    same = (motor.facts, {*motor.members}, motor.places, motor.directions)
    given = None not in (*motor.places, *motor.directions) and bool(motor.places)
    return given and same == (joint.facts, {*joint.members}, joint.places, joint.directions)


def _held(connections: Sequence[Connection]) -> set[str]:
    """The ground, and the bodies that are fixed or welded to it."""
    still = {GROUND}
    welds = [_Pair(*c.members) for c in connections if c.facts.welded and len(c.members) == 2]
    still |= {c.members[0] for c in connections if c.facts.held and len(c.members) == 1 and not c.points}
    for _ in welds:
        still |= {body for pair in welds for body in pair if not still.isdisjoint(pair)}
    return still
