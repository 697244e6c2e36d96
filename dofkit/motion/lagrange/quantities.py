"""Masses and other quantities of a scene as expressions: one that is left out matters where motion depends on it."""

from __future__ import annotations

from fractions import Fraction

from dofkit.base.errors import Fault
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import ZERO, Expr
from dofkit.scene.ledger import MOVING
from dofkit.scene.scene import Scene
from dofkit.scene.world import World

#: Stand for a mass or an inertia that the scene leaves out; an error where the motion depends on it.
MISSING = "_missing "


def moving(world: World, value: object, *where: str | int) -> Expr:
    """A number or a text, which may mention velocities; 0, and a fault of the world's, where it is neither."""
    if isinstance(value, (str, Fraction)):
        return world.expression(value, *where, allow=MOVING)
    world.fault("one value is needed here, not a list", *where, hint="write a number or a text")
    return ZERO


def mass(world: World, value: object, key: str, name: str) -> Expr:
    """A mass or an inertia, or a parameter in its place that says that it is missing."""
    return ex.parameter(f"{MISSING}{key} of {name}") if value is None else moving(world, value, key)


def missing(symbols: frozenset[Expr], scene: Scene) -> list[Fault]:
    """A fault for everything that was left out and that the motion depends on, where it belongs."""
    named = sorted(str(s.args[1]).removeprefix(MISSING) for s in symbols if str(s.args[1]).startswith(MISSING))
    where: dict[str, tuple[str | int, ...]] = {p.name: ("particles", i) for i, p in enumerate(scene.particles)}
    where.update({b.name: ("bodies", i) for i, b in enumerate(scene.bodies)})
    hint = "give it, or `energies: {kinetic: ...}`"
    return [Fault(f"the {name} is missing", where.get(name.rpartition(" ")[2], ()), hint=hint) for name in named]
