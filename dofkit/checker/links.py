"""Constraints of distance: links, rigid sets, strings."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

from dofkit.checker.bodies import MaterialPoint, apart, difference, less, square
from dofkit.checker.errors import CheckError
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ONE, Tree, add, call, negative, number, power, times

TWO = number(2)


def link(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """|A - B|^2 - length^2, times the square of the denominator of A - B."""
    first, second = (world.point(end) for end in _two(entry["between"]))
    length = entry.get("length")
    given = None if length is None else power(world.expression(length, world.names.coordinates | {"t"}), TWO)
    yield distance(world, first, second, given)


def _two(ends: object) -> list[object]:
    if not isinstance(ends, (list, tuple)) or len(ends) != 2 or ends[0] == ends[1]:
        raise CheckError("two different ends are needed")
    return list(ends)


def distance(world: Surroundings, first: MaterialPoint, second: MaterialPoint, squared: Tree | None) -> Tree:
    """The relation of a distance whose square is given, drawn or generic."""
    if squared is None:
        drawn = first.start is not None and second.start is not None
        squared = square(less(first.start or (), second.start or ())) if drawn else world.fresh("square")
    arm, under = apart(first, second)
    return difference(square(arm), times(squared, power(under, TWO) if under != ONE else ONE))


def rigid(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distance of every pair of particles."""
    members = entry["members"]
    if not isinstance(members, list) or len(set(map(str, members))) < len(members) or len(members) < 2:
        raise CheckError("a rigid set has two or more different members")
    if not all(isinstance(member, str) for member in members):
        raise CheckError("the members of a rigid set are particles")
    for one, other in combinations(members, 2):
        yield distance(world, world.point(one), world.point(other), None)


def string(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distances along the points add up to the length."""
    points = [world.point(point) for point in entry["along"]]
    parts: list[Tree] = []
    drawn: list[Tree] = []
    for first, second in pairwise(points):
        arm, under = apart(first, second)
        size = call("abs", arm[0]) if len(arm) == 1 else call("sqrt", square(arm))
        parts.append(times(size, power(under, number(-1))) if under != ONE else size)
        if first.start is not None and second.start is not None:
            drawn.append(call("sqrt", square(less(first.start, second.start))))
    if len(points) < 2:
        raise CheckError("a string runs along two points at least")
    if entry.get("length") is not None:
        length = world.expression(entry["length"], world.names.coordinates | {"t"})
    else:
        length = add(*drawn) if len(drawn) == len(parts) else world.fresh("length")
    yield add(*parts, negative(length))
