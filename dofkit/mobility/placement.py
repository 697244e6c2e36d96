"""Connections with numbers for their geometry, at the reference or in general position, and their velocity relations.

Numbers are integers modulo p, or floats. A body has the velocity v of its point at ``start``, and the angular velocity
w: its point at a has the velocity v + w x (a - start). Columns are v, then w, of every member in order. Angles do not
occur, so that singularities of angle coordinates do not either.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.base.libraries import nx
from dofkit.exact.matrices.sparse import LinearRow, Numbers, less
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr
from dofkit.system import GROUND, Connection, DrawnPoint, JointRate, Kinematics, System, TypeFacts

#: Bound on random numbers if there is no prime.
FREE = 1000
#: Attempts at a point modulo a prime where the reference has a value.
DRAWS = 20

NumberTuple = tuple[Any, ...]
Vector = tuple[Expr, ...]


@dataclass(frozen=True)
class Placement:
    """The system's connections with numbers (``located``), in order; ``p``: the modulus, 0 for floats.

    ``members``: bodies, particles and ground by name; ``places``: the positions of particles.
    """

    p: int
    members: Mapping[str, Member]
    located: tuple[Located, ...]
    places: Mapping[str, NumberTuple]


def reference_placement(system: System, positive: frozenset[Expr]) -> Placement | None:
    """Return the placement at the reference configuration modulo p, with random values for missing geometry."""
    geometry = _geometry_of(system)
    ring = Ring(geometry, positive)
    nodes = {e: ring.node(e) for e in geometry}
    for seed in range(DRAWS):
        point = field_point([ring], seed)
        try:
            at = values(ring, point)
            numbers = {e: int(at[node]) for e, node in nodes.items()}
        except NoValueError:
            continue
        return _placement(system, _ReferenceNumbers(point.p, numbers))
    return None


def measured_placement(system: System) -> Placement | None:
    """Return the placement at the reference configuration in floats, lengths in units of the scene's size.

    None if the geometry contains parameters. Directions are divided by the size as well, which does not matter.
    """
    approximate_of = {e: approximate(e) for e in _geometry_of(system)}
    numbers = {e: value / system.size for e, value in approximate_of.items() if value is not None}
    if len(numbers) < len(approximate_of):
        return None
    return _placement(system, _ReferenceNumbers(0, numbers, system.size))


def general_placement(system: System, p: int, seed: int = 0) -> Placement:
    """Return the placement with random geometry, in which points that coincide by definition still coincide."""
    return _placement(system, _RandomNumbers(p, system, seed))


class _ReferenceNumbers:
    """The numbers of the reference, divided by ``size``; a particle without a position has a random one."""

    def __init__(self, p: int, numbers: Mapping[Expr, Any], size: float = 1.0) -> None:
        self.p, self._numbers, self._size = p, numbers, size
        self._rng = random.Random("dofkit drawn")
        self._turn = self._rng.randrange(1, p or FREE)
        self._random_places: dict[str, NumberTuple] = {}

    def random(self, dimension: int) -> NumberTuple:
        return tuple(self._rng.randrange(1, self.p or FREE) for _ in range(dimension))

    def vector(self, reference: Vector | None, dimension: int) -> NumberTuple:
        return self.random(dimension) if reference is None else tuple(self._numbers[e] for e in reference)

    def place(self, member: str, reference: Vector | None, dimension: int) -> NumberTuple:
        return self.vector(reference, dimension)

    def point(self, point: DrawnPoint, dimension: int) -> NumberTuple:
        """Return a point's position; random ones, the same for all points of a carrier, if none is given."""
        if point.at is not None:
            return self.vector(point.at, dimension)
        if point.carrier not in self._random_places:
            self._random_places[point.carrier] = self.random(dimension)
        return self._random_places[point.carrier]

    def number(self, reference: Expr | None, by_turn: bool) -> Any:
        """Return a number of a connection; a screw's pitch times any factor, because 2 pi is no number of GF(p)."""
        if reference is None:
            return 0
        scaled: Any = self._numbers[reference] * (self._turn if by_turn else 1)
        return scaled % self.p if self.p else scaled

    def factor(self, rate: JointRate) -> Any:
        """Return the factor of a rate in a coupling, for lengths (and directions) in units of the size."""
        ratio: Any = self._numbers[rate.factor]
        return ratio % self.p if self.p else ratio * self._size ** (1 + bool(rate.direction) + rate.slides)


class _RandomNumbers:
    """Random numbers; a point of a member has one position, also as a point of other members joined there."""

    def __init__(self, p: int, system: System, seed: int) -> None:
        self.p = p
        self._rng = random.Random(f"dofkit general position {seed}")
        self._same: nx.utils.UnionFind[Hashable] = nx.utils.UnionFind()
        self._places: dict[Hashable, NumberTuple] = {}
        for c in system.connections:
            for at in c.places:
                if at is not None:
                    self._same.union(*((m, at) for m in c.members))
            if c.facts.merged:
                self._same.union(*(_key(point) for point in c.points))

    def random(self, dimension: int) -> NumberTuple:
        return tuple(self._rng.randrange(self.p) for _ in range(dimension))

    def vector(self, reference: Vector | None, dimension: int) -> NumberTuple:
        return self.random(dimension)

    def place(self, member: str, reference: Vector | None, dimension: int) -> NumberTuple:
        return self.random(dimension) if reference is None else self._at((member, reference), dimension)

    def point(self, point: DrawnPoint, dimension: int) -> NumberTuple:
        return self._at(_key(point), dimension)

    def _at(self, key: Hashable, dimension: int) -> NumberTuple:
        root = self._same[key]
        if root not in self._places:
            self._places[root] = self.random(dimension)
        return self._places[root]

    def number(self, reference: Expr | None, by_turn: bool) -> int:
        return self._rng.randrange(self.p)

    def factor(self, rate: JointRate) -> int:
        return self._rng.randrange(self.p)


_NumberSource = _ReferenceNumbers | _RandomNumbers


def _key(point: DrawnPoint) -> Hashable:
    """Return the key of a point: points of one particle have one place."""
    return point.carrier if point.particle else (point.carrier, point.at)


def _geometry_of(system: System) -> set[Expr]:
    """Return every expression in the geometry of the reference configuration."""
    vectors: list[Vector | None] = [*system.starts.values()]
    numbers = [c.number for c in system.connections if c.number is not None]
    for c in system.connections:
        vectors += [*c.places, *c.directions, *(point.at for point in c.points)]
        vectors += [vector for rate in c.rates for vector in (rate.place, rate.direction)]
        numbers += [rate.factor for rate in c.rates]
    return {*numbers, *(part for vector in vectors if vector is not None for part in vector)}


def _placement(system: System, numbers: _NumberSource) -> Placement:
    """Return the placement with the numbers of a source."""
    d = system.dimension
    first: dict[str, int] = {}
    for k, c in enumerate(system.coordinates):
        if c.owner is not None:
            first.setdefault(c.owner, k)
    members = {name: Member(first[name]) for name in system.particles}
    members |= {name: Member(first[name], numbers.vector(start, d)) for name, start in system.starts.items()}
    members[GROUND] = Member(None)
    located = tuple(_located_connection(c, members, numbers, d) for c in system.connections)
    places = {name: numbers.point(DrawnPoint(name, None, particle=True), d) for name in system.particles}
    return Placement(numbers.p, members, located, places)


def _located_connection(c: Connection, members: Mapping[str, Member], numbers: _NumberSource, d: int) -> Located:
    """Return a connection with its numbers; directions that it does not state get random ones."""
    wanted = max(len(c.directions), c.facts.directions)
    return Located(
        c.facts,
        d,
        tuple(members[m] for m in c.members),
        tuple((members[point.carrier], numbers.point(point, d)) for point in c.points),
        tuple(numbers.place(c.members[0], at, d) for at in c.places),
        tuple(numbers.vector(c.directions[i] if i < len(c.directions) else None, d) for i in range(wanted)),
        numbers.number(c.number, c.facts.by_turn),
        c.driven,
        tuple(_part(c.facts, rate, members, numbers, d) for rate in c.rates),
    )


def _part(
    facts: TypeFacts, rate: JointRate, members: Mapping[str, Member], numbers: _NumberSource, d: int
) -> tuple[Callable[[Kinematics], LinearRow], Any, Located]:
    """Return (rate, factor, joint) of one joint of a coupling."""
    pair = tuple(members[m] for m in rate.members)
    place = numbers.place(rate.members[0], rate.place, d)
    directions = (numbers.vector(rate.direction, d),) if rate.direction else ()
    return rate.rate, numbers.factor(rate), Located(facts, d, pair, (), (place,), directions)


# Velocities that connections allow

#: Columns of the angular velocity by dimension.
TURNS = {1: 0, 2: 1, 3: 3}


@dataclass(frozen=True)
class Member:
    """A body or particle: its first ``column`` (None: the ground), and its origin ``start`` (None: no rotation)."""

    column: int | None
    start: tuple[Any, ...] | None = None


@dataclass(frozen=True)
class Located:
    """A connection with numbers: points of members, places, directions, and the ``number`` (a screw's pitch, a ratio).

    ``couplings``: for a coupling the (rate, factor, joint) of each joint.
    """

    facts: TypeFacts
    dimension: int
    members: tuple[Member, ...]
    points: tuple[tuple[Member, tuple[Any, ...]], ...]
    places: tuple[tuple[Any, ...], ...]
    directions: tuple[tuple[Any, ...], ...]
    number: Any = 0
    driven: bool = False
    couplings: tuple[tuple[Callable[[Kinematics], LinearRow], Any, Located], ...] = ()

    def shift(self) -> list[LinearRow]:
        """Return the velocity of the second body's point at the joint relative to the first body's."""
        first, second = self.members[:2]
        d = self.dimension
        place = self.places[0] if self.places else (0,) * d
        return less(velocity(second, place, d), velocity(first, place, d))

    def turn(self) -> list[LinearRow]:
        """Return the angular velocity of the second body relative to the first."""
        return less(self.spin(1), self.spin(0))

    def slip(self) -> list[LinearRow]:
        """Return the velocity of the first point relative to the other member, or the ground."""
        point, at = self.points[0]
        carrier = next((m for m in self.members if m is not point), Member(None))
        return less(velocity(point, at, self.dimension), velocity(carrier, at, self.dimension))

    def velocity(self, k: int) -> list[LinearRow]:
        """Return the velocity of the point number ``k``."""
        return velocity(*self.points[k], self.dimension)

    def origin(self, k: int) -> list[LinearRow]:
        """Return the velocity of the origin of the member number ``k``."""
        member = self.members[k]
        return velocity(member, member.start or (0,) * self.dimension, self.dimension)

    def spin(self, k: int) -> list[LinearRow]:
        """Return the angular velocity of the member number ``k``."""
        return spin(self.members[k], self.dimension)


def rows_of(located: Located) -> list[LinearRow] | None:
    """Return the velocity relations of a connection, one for each of its equations; None for a type without them."""
    facts = located.facts
    if facts.velocities is None:
        return None
    rows = list(facts.velocities(located))
    if located.driven and facts.drive is not None:
        rows.append(facts.drive(located))
    return rows


def velocity(member: Member, at: Numbers, dimension: int) -> list[LinearRow]:
    """Return the velocity v + w x (at - start) of the member's point at a place, one row for each component."""
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
    """Return the angular velocity of a member, one row for each component; none for particles and the ground."""
    if member.column is None or member.start is None:
        return [{} for _ in range(TURNS[dimension])]
    return [{member.column + dimension + i: 1} for i in range(TURNS[dimension])]
