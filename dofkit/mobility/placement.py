"""Connections with numbers modulo a prime: as drawn, or the same connections in general position."""

from __future__ import annotations

import random
from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from dofkit.base.libraries import nx
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.sparse import LinearRow
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr
from dofkit.mobility.twists import Located, Member
from dofkit.system import GROUND, Connection, DrawnPoint, JointRate, Kinematics, System, TypeFacts

#: Random numbers are below this where there is no prime.
FREE = 1000
#: Draws of one drawing modulo a prime.
DRAWS = 20

Numbers = tuple[Any, ...]
Vector = tuple[Expr, ...]


@dataclass(frozen=True)
class Placement:
    """``located``: the system's connections in order, with numbers modulo ``p`` (floats if that is 0).

    ``places`` are those of the particles.
    """

    p: int
    members: Mapping[str, Member]
    located: tuple[Located, ...]
    places: Mapping[str, Numbers]


def drawn_placement(system: System, positive: frozenset[Expr]) -> Placement | None:
    """The connections where they are drawn, roots and angles as exact numbers modulo p; what is not given is random."""
    wanted = {part for vector in _vectors(system) for part in vector}
    wanted |= set(_factors(system))
    ring = Ring([e for e in wanted if e.op != "num"], positive)
    nodes = {e: ring.node(e) for e in wanted}
    for seed in range(DRAWS):
        point = field_point([ring], seed)
        try:
            at = values(ring, point)
            known = {e: int(at[node]) for e, node in nodes.items()}
        except NoValueError:
            continue
        return _placement(system, _Drawn(point.p, known))
    return None


def measured_placement(system: System) -> Placement | None:
    """The drawing in floating point, lengths in units of the scene's size; None where it holds parameters."""
    wanted = {part for vector in _vectors(system) for part in vector}
    wanted |= set(_factors(system))
    known = {e: approximate(e) for e in wanted}
    if None in known.values():
        return None
    return _placement(system, _Drawn(0, {e: float(v or 0) / system.size for e, v in known.items()}, system.size))


def general_placement(system: System, p: int, seed: int = 0) -> Placement:
    """The same connections with everything given in general position: random, but what is one point stays one."""
    return _placement(system, _General(p, system, seed))


class _Drawn:
    """The numbers of the drawing, in units of ``size``; a particle that is not drawn stands at one random place."""

    def __init__(self, p: int, known: Mapping[Expr, Any], size: float = 1.0) -> None:
        self.p, self._known, self._size = p, known, size
        self._rng = random.Random("dofkit drawn")
        self._turn = self._rng.randrange(1, p or FREE)
        self._elsewhere: dict[str, Numbers] = {}

    def random(self, dimension: int) -> Numbers:
        return tuple(self._rng.randrange(1, self.p or FREE) for _ in range(dimension))

    def vector(self, given: Vector | None, dimension: int) -> Numbers:
        return self.random(dimension) if given is None else tuple(self._known[e] for e in given)

    def place(self, member: str, given: Vector | None, dimension: int) -> Numbers:
        return self.vector(given, dimension)

    def point(self, point: DrawnPoint, dimension: int) -> Numbers:
        if point.at is not None:
            return self.vector(point.at, dimension)
        if point.carrier not in self._elsewhere:
            self._elsewhere[point.carrier] = self.random(dimension)
        return self._elsewhere[point.carrier]

    def number(self, given: Expr | None, by_turn: bool) -> Any:
        """A screw's advance by radian holds pi, which is no number of GF(p): any factor will do."""
        if given is None:
            return 0
        found: Any = self._known[given] * (self._turn if by_turn else 1)
        return found % self.p if self.p else found

    def factor(self, rate: JointRate) -> Any:
        """Of a rate about or along a direction in units of the size: of angles with displacements as they are."""
        found: Any = self._known[rate.factor]
        return found % self.p if self.p else found * self._size ** (1 + bool(rate.direction) + rate.slides)


class _General:
    """Random numbers; a point of a member, or of members that a joint holds together there, has one place."""

    def __init__(self, p: int, system: System, seed: int) -> None:
        self.p = p
        self._rng = random.Random(f"dofkit general position {seed}")
        self._same: nx.utils.UnionFind[Hashable] = nx.utils.UnionFind()
        self._places: dict[Hashable, Numbers] = {}
        for c in system.connections:
            for at in c.places:
                if at is not None:
                    self._same.union(*((m, at) for m in c.members))
            if c.facts.merged:
                self._same.union(*(_key(point) for point in c.points))

    def random(self, dimension: int) -> Numbers:
        return tuple(self._rng.randrange(1, self.p) for _ in range(dimension))

    def vector(self, given: Vector | None, dimension: int) -> Numbers:
        return self.random(dimension)

    def place(self, member: str, given: Vector | None, dimension: int) -> Numbers:
        return self.random(dimension) if given is None else self._at((member, given), dimension)

    def point(self, point: DrawnPoint, dimension: int) -> Numbers:
        return self._at(_key(point), dimension)

    def _at(self, key: Hashable, dimension: int) -> Numbers:
        root = self._same[key]
        if root not in self._places:
            self._places[root] = self.random(dimension)
        return self._places[root]

    def number(self, given: Expr | None, by_turn: bool) -> int:
        return self._rng.randrange(1, self.p)

    def factor(self, rate: JointRate) -> int:
        return self._rng.randrange(1, self.p)


def _key(point: DrawnPoint) -> Hashable:
    return point.carrier if point.particle else (point.carrier, point.at)


def _factors(system: System) -> Iterator[Expr]:
    for c in system.connections:
        yield from () if c.number is None else (c.number,)
        yield from (rate.factor for rate in c.rates)


def _vectors(system: System) -> Iterator[Vector]:
    yield from system.starts.values()
    for c in system.connections:
        given = (*c.places, *c.directions, *(point.at for point in c.points))
        yield from (vector for vector in given if vector is not None)
        yield from (vector for rate in c.rates for vector in (rate.place, rate.direction))


def _placement(system: System, numbers: _Drawn | _General) -> Placement:
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


def _located_connection(c: Connection, members: Mapping[str, Member], numbers: _Drawn | _General, d: int) -> Located:
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
    facts: TypeFacts, rate: JointRate, members: Mapping[str, Member], numbers: _Drawn | _General, d: int
) -> tuple[Callable[[Kinematics], LinearRow], Any, Located]:
    """One joint of a coupling."""
    pair = tuple(members[m] for m in rate.members)
    place = numbers.place(rate.members[0], rate.place, d)
    directions = (numbers.vector(rate.direction, d),) if rate.direction else ()
    return rate.rate, numbers.factor(rate), Located(facts, d, pair, (), (place,), directions)
