"""The velocities that connections allow, as linear relations between the twists of bodies and particles' velocities.

A body has the velocity v of the point of it that stands at ``start``, and the angular velocity w: its point at a moves
by v + w x (a - start). Columns are v, then w, of every member in order. No angles occur: a singular choice of
coordinates is no singularity here. Numbers are of any kind: integers that stand for GF(p), fractions, floats.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dofkit.exact.matrices.sparse import LinearRow, Numbers, less
from dofkit.system import Kinematics, TypeFacts

#: Columns of the angular velocity by dimension.
TURNS = {1: 0, 2: 1, 3: 3}


@dataclass(frozen=True)
class Member:
    """A body or a particle: its first column (None: the ground), and where its origin stands (None: it cannot turn)."""

    column: int | None
    start: tuple[Any, ...] | None = None


@dataclass(frozen=True)
class Located:
    """A connection with numbers: points that belong to members, places, directions, the screw's pitch or the ratio.

    ``parts``: of a coupling the rate of each joint, its factor, and the joint alone.
    """

    facts: TypeFacts
    dimension: int
    members: tuple[Member, ...]
    points: tuple[tuple[Member, tuple[Any, ...]], ...]
    places: tuple[tuple[Any, ...], ...]
    directions: tuple[tuple[Any, ...], ...]
    number: Any = 0
    driven: bool = False
    parts: tuple[tuple[Callable[[Kinematics], LinearRow], Any, Located], ...] = ()

    def shift(self) -> list[LinearRow]:
        """How the second body's point at the joint moves against the first's; anywhere, where they do not turn."""
        first, second = self.members[:2]
        d = self.dimension
        place = self.places[0] if self.places else (0,) * d
        return less(velocity(second, place, d), velocity(first, place, d))

    def turn(self) -> list[LinearRow]:
        """The angular velocity of the second body against the first."""
        return less(self.spin(1), self.spin(0))

    def slip(self) -> list[LinearRow]:
        """How the first point moves against the other member, or the ground."""
        point, at = self.points[0]
        carrier = next((m for m in self.members if m is not point), Member(None))
        return less(velocity(point, at, self.dimension), velocity(carrier, at, self.dimension))

    def velocity(self, k: int) -> list[LinearRow]:
        """Of the point number ``k``."""
        return velocity(*self.points[k], self.dimension)

    def origin(self, k: int) -> list[LinearRow]:
        """The velocity of the origin of the member number ``k``."""
        member = self.members[k]
        return velocity(member, member.start or (0,) * self.dimension, self.dimension)

    def spin(self, k: int) -> list[LinearRow]:
        """The angular velocity of the member number ``k``."""
        return spin(self.members[k], self.dimension)


def rows_of(found: Located) -> list[LinearRow] | None:
    """The linear relations of a connection, in the order of its scalar equations; None for a type without any here."""
    facts = found.facts
    if facts.velocities is None:
        return None
    rows = list(facts.velocities(found))
    if found.driven and facts.drive is not None:
        rows.append(facts.drive(found))
    return rows


def velocity(member: Member, at: Numbers, dimension: int) -> list[LinearRow]:
    """The velocity of the member's point at a place, a row a component: v + w x (at - start)."""
    first = member.column
    if first is None:
        return [{} for _ in range(dimension)]
    rows: list[LinearRow] = [{first + i: 1} for i in range(dimension)]
    if member.start is None or dimension == 1:
        return rows
    arm = [a - s for a, s in zip(at, member.start, strict=True)]
    turn = first + dimension
    if dimension == 2:
        rows[0][turn], rows[1][turn] = -arm[1], arm[0]
        return rows
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        rows[i][turn + j], rows[i][turn + k] = arm[k], -arm[j]
    return rows


def spin(member: Member, dimension: int) -> list[LinearRow]:
    """The angular velocity, a row a component."""
    if member.column is None or member.start is None:
        return [{} for _ in range(TURNS[dimension])]
    return [{member.column + dimension + i: 1} for i in range(TURNS[dimension])]
