"""Constraints that are texts: equations, and points on surfaces and curves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from dofkit.checker.derivatives import degree_parts, homogeneous_degree, substituted, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import Sided, parse_relations
from dofkit.checker.places import scaled_down
from dofkit.checker.surroundings import Entry, Surroundings
from dofkit.checker.trees import ONE, ZERO, Tree, add, symbol, times

TIME_RATE = "tdot"


def equation(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """The relations of a text, in velocities."""
    for found in parse_relations(str(entry["text"]), world.names):
        yield found._replace(tree=in_velocities(found.tree, world.names.coordinates))


def in_velocities(tree: Tree, coordinates: frozenset[str]) -> Tree:
    """A relation with velocities in the place of differentials.

    What is linear in velocities becomes a form, its terms without one times ``tdot``. Other relations that are
    homogeneous in differentials are divided by a power of dt.
    """
    names = symbols_in(tree)
    if any(f"{q}ddot" in names for q in coordinates):
        raise CheckError("second derivatives are not read")
    differentials = {"dt": symbol(TIME_RATE)} | {f"d{q}": symbol(f"{q}dot") for q in coordinates}
    rates = {f"{q}dot" for q in coordinates} | {TIME_RATE}
    if not names.isdisjoint(differentials):
        degree = homogeneous_degree(tree, differentials.keys())
        if degree is None:
            raise CheckError("differentials and finite terms are added together")
        moving = substituted(tree, differentials)
        if degree == 1 and set(degree_parts(moving, rates) or ()) == {1}:
            return moving
        tree = substituted(moving, {TIME_RATE: ONE})
        names = symbols_in(tree)
    if names.isdisjoint(rates):
        return tree
    parts = degree_parts(tree, rates)
    if parts is None or max(parts) > 1:
        return tree
    return add(parts.get(1, ZERO), times(parts[0], symbol(TIME_RATE))) if 0 in parts else tree


def on(world: Surroundings, entry: Entry) -> Iterator[Sided]:
    """Every text at every member, whose coordinates x, y, z stand for."""
    if (entry.get("surface") is None) == (entry.get("curve") is None):
        raise CheckError("either a surface or a curve is needed")
    curve = entry.get("curve")
    texts = [entry["surface"]] if curve is None else [curve] if isinstance(curve, str) else list(curve)
    letters = ("x", "y", "z")[: world.dimension]
    names = world.names
    own = replace(
        names,
        coordinates=names.coordinates | set(letters),
        values={name: tree for name, tree in names.values.items() if name not in letters},
        functions={name: given for name, given in names.functions.items() if name not in letters},
    )
    read = [found for text in texts for found in parse_relations(str(text), own)]
    for found in read:
        other = symbols_in(found.tree) - own.coordinates - {"t", *world.signs}
        if other:
            raise CheckError(f"`{min(other)}` cannot stand in a surface")
    for member in entry["members"]:
        values = dict(zip(letters, scaled_down(world.point(member)), strict=True))
        for found in read:
            yield found._replace(tree=substituted(found.tree, values))
