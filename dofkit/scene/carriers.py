"""Gears whose wheel turns on a moving arm: without ``carrier`` their ratio is one of angles against the ground."""

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


def _held(connections: Sequence[Connection]) -> set[str]:
    """The ground, and the bodies that are fixed or welded to it."""
    still = {GROUND}
    welds = [_Pair(*c.members) for c in connections if c.facts.welded and len(c.members) == 2]
    still |= {c.members[0] for c in connections if c.facts.held and len(c.members) == 1 and not c.points}
    for _ in welds:
        still |= {body for pair in welds for body in pair if not still.isdisjoint(pair)}
    return still
