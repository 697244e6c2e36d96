"""The velocities that connections allow, as linear relations between the twists of bodies and particles' velocities.

A body has the velocity v of the point of it that stands at ``start``, and the angular velocity w: its point at a moves
by v + w x (a - start). Columns are v, then w, of every member in order. No angles occur: a singular choice of
coordinates is no singularity here. Numbers are of any kind: integers that stand for GF(p), fractions, floats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Numbers = Sequence[Any]
LinearRow = dict[int, Any]

#: Columns of the angular velocity by dimension.
TURNS = {1: 0, 2: 1, 3: 3}


@dataclass(frozen=True)
class Member:
    """A body or a particle: its first column (None: the ground), and where its origin stands (None: it cannot turn)."""

    column: int | None
    start: tuple[Any, ...] | None = None


@dataclass(frozen=True)
class Located:
    """A connection with numbers: points that belong to members, places, directions, the screw's pitch or the ratio."""

    type: str
    members: tuple[Member, ...]
    points: tuple[tuple[Member, tuple[Any, ...]], ...]
    places: tuple[tuple[Any, ...], ...]
    directions: tuple[tuple[Any, ...], ...]
    number: Any = 0
    driven: bool = False


def rows_of(found: Located, dimension: int) -> list[LinearRow] | None:
    """The linear relations of a connection, in the order of its scalar equations; None for a type without any here."""
    of_type = _TYPES.get(found.type)
    if of_type is None:
        return None
    rows = list(of_type(found, dimension))
    if found.driven:
        rows.append(_drive(found, dimension))
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


def combined(parts: Iterable[tuple[Any, Mapping[int, Any]]]) -> LinearRow:
    """The sum of numbers times rows."""
    found: LinearRow = {}
    for factor, row in parts:
        for c, v in row.items():
            found[c] = found.get(c, 0) + factor * v
    return found


def along(direction: Numbers, rows: Sequence[LinearRow]) -> LinearRow:
    """The component along a direction."""
    return combined(zip(direction, rows, strict=True))


def less(second: Sequence[LinearRow], first: Sequence[LinearRow]) -> list[LinearRow]:
    """second - first."""
    return [combined(((1, b), (-1, a))) for a, b in zip(first, second, strict=True)]


def spanning(n: Numbers) -> list[tuple[Any, ...]]:
    """Directions across n: d - 1 of them."""
    if len(n) == 2:
        return [(-n[1], n[0])]
    pivot = next(i for i in reversed(range(len(n))) if n[i] != 0)
    found = []
    for i in range(len(n)):
        if i != pivot:
            parts = [0] * len(n)
            parts[i], parts[pivot] = n[pivot], -n[i]
            found.append(tuple(parts))
    return found


def cross(a: Numbers, b: Numbers) -> tuple[Any, ...]:
    """a x b in space."""
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))


def _shift(found: Located, dimension: int) -> list[LinearRow]:
    """How the second body's point at the joint moves against the first's; anywhere, where they do not turn."""
    first, second = found.members[:2]
    place = found.places[0] if found.places else (0,) * dimension
    return less(velocity(second, place, dimension), velocity(first, place, dimension))


def _turn(found: Located, dimension: int) -> list[LinearRow]:
    first, second = found.members[:2]
    return less(spin(second, dimension), spin(first, dimension))


def _aligned(found: Located) -> Iterator[LinearRow]:
    turn = _turn(found, 3)
    yield from (along(u, turn) for u in spanning(found.directions[0]))


def _revolute(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _shift(found, dimension)
    if dimension == 3:
        yield from _aligned(found)


def _prismatic(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _turn(found, dimension)
    shift = _shift(found, dimension)
    yield from (along(u, shift) for u in spanning(found.directions[0]))


def _cylindrical(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _aligned(found)
    shift = _shift(found, dimension)
    yield from (along(u, shift) for u in spanning(found.directions[0]))


def _screw(found: Located, dimension: int) -> Iterator[LinearRow]:
    """n.(v2 - v1) - h n.(w2 - w1) = 0 with h the advance by radian."""
    yield from _cylindrical(found, dimension)
    n = found.directions[0]
    yield combined(((1, along(n, _shift(found, 3))), (-found.number, along(n, _turn(found, 3)))))


def _universal(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _shift(found, dimension)
    yield along(cross(*found.directions), _turn(found, 3))


def _spherical(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _shift(found, dimension)


def _planar(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _aligned(found)
    yield along(found.directions[0], _shift(found, dimension))


def _weld(found: Located, dimension: int) -> Iterator[LinearRow]:
    yield from _turn(found, dimension)
    yield from _shift(found, dimension)


def _fixed(found: Located, dimension: int) -> Iterator[LinearRow]:
    if found.points:
        yield from velocity(*found.points[0], dimension)
        return
    yield from velocity(found.members[0], found.members[0].start or (0,) * dimension, dimension)
    yield from spin(found.members[0], dimension)


def _coincident(found: Located, dimension: int) -> Iterator[LinearRow]:
    (first, a), (second, b) = found.points
    yield from less(velocity(second, b, dimension), velocity(first, a, dimension))


def _slot(found: Located, dimension: int) -> Iterator[LinearRow]:
    point, at = found.points[0]
    carrier = next((m for m in found.members if m is not point), Member(None))
    shift = less(velocity(point, at, dimension), velocity(carrier, at, dimension))
    yield from (along(u, shift) for u in spanning(found.directions[0]))


def _link(found: Located, dimension: int) -> Iterator[LinearRow]:
    first, second = found.points
    yield _length(first, second, dimension)


def _length(first: tuple[Member, Numbers], second: tuple[Member, Numbers], dimension: int) -> LinearRow:
    """(b - a).(v_b - v_a)."""
    arm = [q - p for p, q in zip(first[1], second[1], strict=True)]
    return along(arm, less(velocity(*second, dimension), velocity(*first, dimension)))


def _rigid(found: Located, dimension: int) -> Iterator[LinearRow]:
    for j in range(len(found.points)):
        for k in range(j + 1, len(found.points)):
            yield _length(found.points[j], found.points[k], dimension)


def _gear(found: Located, dimension: int) -> Iterator[LinearRow]:
    """(w2 - w) - ratio (w1 - w) = 0, with w of the carrier if there is one."""
    ratio = found.number
    turns = [spin(m, dimension)[0] for m in found.members]
    carrier = turns[2] if len(turns) > 2 else {}
    yield combined(((1, turns[1]), (-ratio, turns[0]), (ratio - 1, carrier)))


def _drive(found: Located, dimension: int) -> LinearRow:
    if found.type in ("prismatic", "cylindrical"):
        return along(found.directions[0], _shift(found, dimension))
    turn = _turn(found, dimension)
    return turn[0] if dimension == 2 else along(found.directions[0], turn)


_TYPES: dict[str, Callable[[Located, int], Iterator[LinearRow]]] = {
    "revolute": _revolute,
    "prismatic": _prismatic,
    "weld": _weld,
    "cylindrical": _cylindrical,
    "screw": _screw,
    "universal": _universal,
    "spherical": _spherical,
    "planar": _planar,
    "fixed": _fixed,
    "coincident": _coincident,
    "slot": _slot,
    "link": _link,
    "rigid": _rigid,
    "gear": _gear,
}

#: The types whose relations are known here by their geometry.
KINDS = frozenset(_TYPES)
