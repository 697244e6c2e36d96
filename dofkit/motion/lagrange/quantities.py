"""Masses and other quantities of a scene as expressions: one that is left out matters where motion depends on it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

from dofkit.base.errors import Fault
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import ZERO, Expr
from dofkit.scene.drawing import Drawing
from dofkit.scene.ledger import MOVING
from dofkit.scene.scene import Scene
from dofkit.scene.world import World

#: Stand for a mass or an inertia that the scene leaves out; an error where the motion depends on it.
MISSING = "_missing "


@dataclass
class EntryWorlds:
    """The world as each entry of a scene sees it that is read for the motion, and all their faults."""

    drawing: Drawing
    _worlds: list[World] = field(default_factory=list)

    def at(self, *here: str | int) -> World:
        """The world of the entry at a path."""
        self._worlds.append(World(self.drawing, here))
        return self._worlds[-1]

    @property
    def faults(self) -> tuple[Fault, ...]:
        """In the order in which the entries were read."""
        return tuple(fault for world in self._worlds for fault in world.faults)


def moving(world: World, value: object, *where: str | int) -> Expr:
    """A number or a text, which may mention velocities; 0, and a fault of the world's, where it is neither."""
    if isinstance(value, (str, Fraction)):
        return world.expression(value, *where, allow=MOVING)
    world.fault("one value is needed here, not a list", *where, hint="write a number or a text")
    return ZERO


def needed(world: World, value: object, key: str, what: str) -> Expr:
    """The same of a value that must be given."""
    if value is None:
        world.fault(f"the `{key}` {what} is missing", hint="give a number or a parameter")
        return ZERO
    return moving(world, value, key)


def mass(world: World, value: object, key: str, name: str) -> Expr:
    """A mass or an inertia, or a parameter in its place that says that it is missing."""
    return ex.parameter(f"{MISSING}{key} of {name}") if value is None else moving(world, value, key)


def masses(scene: Scene, worlds: EntryWorlds) -> Iterator[tuple[World, Expr, tuple[str, ...]]]:
    """For every particle, then every body: its world, its mass and the coordinates of its place."""
    table = worlds.drawing.vocabulary.table
    for i, particle in enumerate(scene.particles):
        world = worlds.at("particles", i)
        yield world, mass(world, particle.mass, "mass", particle.name), table.particles[particle.name]
    for i, body in enumerate(scene.bodies):
        world = worlds.at("bodies", i)
        yield world, mass(world, body.mass, "mass", body.name), table.bodies[body.name][: worlds.drawing.dimension]


def missing(symbols: frozenset[Expr], scene: Scene) -> list[Fault]:
    """A fault for everything that was left out and that the motion depends on, where it belongs."""
    named = sorted(str(s.args[1]).removeprefix(MISSING) for s in symbols if str(s.args[1]).startswith(MISSING))
    where: dict[str, tuple[str | int, ...]] = {p.name: ("particles", i) for i, p in enumerate(scene.particles)}
    where.update({b.name: ("bodies", i) for i, b in enumerate(scene.bodies)})
    hint = "give it, or `energies: {kinetic: ...}`"
    return [Fault(f"the {name} is missing", where.get(name.rpartition(" ")[2], ()), hint=hint) for name in named]
