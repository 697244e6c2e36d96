"""Constraints that are texts: equations, and points on surfaces and curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from dofkit.checker.derivatives import homogeneous_degree, linear_parts, substituted, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import Sided, parse_relations
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ONE, ZERO, Tree, add, symbol, times

TIME_RATE = "tdot"


def equation(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """The relations of a text, in velocities."""
    for found in parse_relations(entry["text"], world.names):
        yield found._replace(tree=in_velocities(found.tree, world.names.coordinates))


def in_velocities(tree: Tree, coordinates: frozenset[str]) -> Tree:
    """A relation with velocities in the place of differentials.

    What is linear in velocities becomes a form, its terms without one times ``tdot``. Other relations that are
    homogeneous in differentials are divided by a power of dt.
    """
    found = {name for name in symbols_in(tree) if name[0] == "d" and (name == "dt" or name[1:] in coordinates)}
    differentials = {name: symbol(f"{name[1:]}dot") for name in found}
    if differentials:
        degree = homogeneous_degree(tree, differentials.keys())
        if degree is None:
            raise CheckError("differentials and finite terms are added together")
        tree = substituted(tree, differentials)
        form = linear_parts(tree, rates_in(tree, coordinates)) if degree == 1 else None
        if form is not None and form[1] == ZERO:
            return tree
        tree = substituted(tree, {TIME_RATE: ONE})
    parts = linear_parts(tree, rates_in(tree, coordinates))
    if parts is None or parts[1] == ZERO:
        return tree
    if not parts[0]:
        return parts[1]
    return add(*(times(slope, symbol(rate)) for rate, slope in parts[0].items()), times(parts[1], symbol(TIME_RATE)))


def rates_in(tree: Tree, coordinates: frozenset[str]) -> set[str]:
    """The names of the velocities in a tree, that of time too."""
    return {
        name for name in symbols_in(tree) if name.endswith("dot") and (name == TIME_RATE or name[:-3] in coordinates)
    }


def lettered(world: Surroundings, texts: Sequence[Any], letters: Sequence[str], more: frozenset[str]) -> list[Sided]:
    """Relations in letters that stand for coordinates of a point, parameters, t and what ``more`` names."""
    names = world.names
    own = replace(
        names,
        coordinates=more.union(letters),
        values={name: tree for name, tree in names.values.items() if name not in letters},
        functions={name: given for name, given in names.functions.items() if name not in letters},
    )
    found = [relation for text in texts for relation in parse_relations(text, own)]
    if any(not symbols_in(one.tree) <= own.coordinates.union(world.signs, "t") for one in found):
        raise CheckError("a surface mentions positions, parameters and t only")
    return found


def on(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """Every text at every member, whose coordinates x, y, z stand for."""
    texts = [text for key in ("surface", "curve") if (text := entry.get(key)) is not None]
    if len(texts) != 1:
        raise CheckError("either a surface or a curve is needed")
    letters = ("x", "y", "z")[: world.dimension]
    read = lettered(world, texts[0] if isinstance(texts[0], list) else texts, letters, world.names.coordinates)
    for member in entry["members"]:
        values = dict(zip(letters, world.point(member).place, strict=True))
        yield from (found._replace(tree=substituted(found.tree, values)) for found in read)
