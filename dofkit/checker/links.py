"""Constraints of distance: links, rigid sets, strings."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

from dofkit.checker.bodies import MaterialPoint, apart, difference, less, square
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import Tree, add, call, negative, number, power, times


def link(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """|A - B|^2 - length^2, times the square of the denominator of A - B."""
    first, second = map(world.point, entry["between"])
    length = entry.get("length")
    given = None if length is None else world.expression(length, world.names.coordinates | {"t"})
    yield distance(world, first, second, None if given is None else power(given, number(2)))


def distance(world: Surroundings, first: MaterialPoint, second: MaterialPoint, squared: Tree | None) -> Tree:
    """The relation of a distance whose square is given, drawn or generic."""
    if squared is None:
        drawn = first.start and second.start
        squared = square(less(first.start or (), second.start or ())) if drawn else world.fresh("square")
    arm, under = apart(first, second)
    return difference(square(arm), times(squared, under, under))


def rigid(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distance of every pair of particles."""
    for first, second in combinations([world.particles[member] for member in entry["members"]], 2):
        yield distance(world, first, second, None)


def string(world: Surroundings, entry: Entry) -> Iterator[Tree]:
    """The distances along the points add up to the length."""
    parts: list[Tree] = []
    drawn: list[Tree] = []
    for first, second in pairwise(map(world.point, entry["along"])):
        arm, under = apart(first, second)
        parts.append(times(call("sqrt", square(arm)), power(under, number(-1))))
        if first.start and second.start:
            drawn.append(call("sqrt", square(less(first.start, second.start))))
    if entry.get("length") is not None:
        length = world.expression(entry["length"], world.names.coordinates | {"t"})
    else:
        length = add(*drawn) if len(drawn) == len(parts) else world.fresh("length")
    yield add(*parts, negative(length))
