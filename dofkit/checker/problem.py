"""A scene's document as a problem: coordinates, scalar relations with their owners, and the reference.

This reads the contract a second time and shares nothing with the engines. Velocities of q are the symbols ``qdot``, the
rate of time is ``tdot``. A generic symbol ``square_c3`` is the square of a length that was left out by the third
constraint, ``length_c3`` the length of a string, ``place_c3`` and ``axis_c3`` components of a place or of an axis.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal

from dofkit.checker.constraints import TYPES, Entry, Surroundings, known_fields
from dofkit.checker.derivatives import TIME_RATE, symbols_in
from dofkit.checker.document import canonical
from dofkit.checker.geometry import MaterialPoint, body_frame, ground
from dofkit.checker.grammar import BUILT_IN, KnownNames, Sided, spelled_out
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, refuse, symbol

MOST_RELATIONS = 20_000
SIGNS = ("real", "positive", "nonzero")
ROLES = {1: ("x",), 2: ("x", "y", "theta"), 3: ("x", "y", "z", "phi", "theta", "psi")}
FIELDS = {
    "scene": "name title source notes dimension parameters functions particles bodies coordinates constraints forces "
    "energies tolerance configuration expect",
    "particles": "name coordinates at mass",
    "bodies": "name coordinates mass inertia",
}
Kind = Literal["finite", "velocity", "inequality"]


@dataclass(frozen=True)
class CheckedRelation:
    """One scalar relation: ``left`` = 0, or of an inequality ``left`` > 0 (``strict``) or >= 0."""

    name: str
    owner: str
    kind: Kind
    left: Tree
    strict: bool = False


@dataclass(frozen=True)
class CheckedProblem:
    """What a scene says. ``parameters``: those that stay symbols; ``reference`` holds at t = 0, empty where none is."""

    name: str
    dimension: int
    coordinates: tuple[str, ...]
    parameters: Mapping[str, str]
    functions: Mapping[str, int]
    relations: tuple[CheckedRelation, ...]
    generic: tuple[str, ...]
    reference: Mapping[str, Tree]
    tolerance: str | None

    @property
    def rates(self) -> tuple[str, ...]:
        """The names of the velocities."""
        return tuple(f"{q}dot" for q in self.coordinates)


Problem = CheckedProblem


def read_problem(document: Mapping[str, Any], cayley: frozenset[str] = frozenset()) -> CheckedProblem:
    """The problem of a document; bodies in ``cayley`` are read with Cayley parameters in the place of angles."""
    try:
        known_fields(document, FIELDS["scene"])
        scene = canonical(document)
        world, coordinates, reference = _surroundings(scene, cayley)
        relations = tuple(_relations(world, scene.get("constraints", []), coordinates))
        names = [*coordinates, *world.names.values, *world.names.functions, *world.generic]
        twice = any(len({*told}) < len(told) for told in (names, [one.name for one in relations]))
        refuse(twice, "a name is that of a generic symbol, or relations have one name")
        return CheckedProblem(
            name=str(document.get("name") or "scene"),
            dimension=world.dimension,
            coordinates=coordinates,
            parameters=world.signs,
            functions={name: len(given) for name, given in world.names.functions.items()},
            relations=relations,
            generic=tuple(world.generic),
            reference={} if world.generic else _reference(world, coordinates, reference),
            tolerance=str(scene["tolerance"]) if "tolerance" in scene else None,
        )
    except CheckError:
        raise
    except (LookupError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise CheckError(f"the scene cannot be read: {type(error).__name__} {str(error)[:80]}") from None


def _surroundings(scene: Entry, cayley: frozenset[str]) -> tuple[Surroundings, tuple[str, ...], dict[str, Tree]]:
    """The names, points and bodies of a scene; its coordinates; the values that its configuration gives."""
    d = scene.get("dimension", 3)
    refuse(type(d) is not int or d not in ROLES, "a world has 1, 2 or 3 dimensions")
    world = Surroundings(d, {"ground": ground(d)})
    particles, bodies = _owners(scene, "particles", ROLES[d][:d]), _owners(scene, "bodies", ROLES[d])
    refuse(not cayley <= bodies.keys() or (cayley and d != 3), "Cayley parameters are of bodies of space")
    charts = bodies | {body: [*bodies[body][:3], *(f"{body}_{g}" for g in "abc")] for body in cayley}
    written, coordinates = (
        [q for names in (*particles.values(), *owned.values(), scene.get("coordinates", [])) for q in names]
        for owned in (bodies, charts)
    )
    values = _parameters(world, scene.get("parameters", {}))
    functions = {h: tuple(given) for h, given in scene.get("functions", {}).items()}
    own = [spelled_out(name) for name in (*written, *values, *functions)]
    every = KnownNames(frozenset([*written, *coordinates]), values, functions)
    twice = any(len({*names}) < len(names) for names in ([*own, *BUILT_IN, TIME_RATE], coordinates))
    plain = all(re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name) and not every.moved(name) for name in own)
    plain = plain and all(isinstance(given, list) for given in scene.get("functions", {}).values())
    refuse(twice or not plain, "a name is taken, or not made of letters and digits")
    given = {q: world.expression(value) for q, value in scene.get("configuration", {}).items()}
    refuse(not given.keys() <= {*written}, "the configuration mentions what is no coordinate")
    world.names = KnownNames(frozenset(written).intersection(coordinates), values, functions)
    at = {entry["name"]: world.vector(entry["at"]) for entry in scene.get("particles", []) if "at" in entry}
    for name, chart in particles.items():
        drawn = tuple(given[q] for q in chart) if given.keys() >= {*chart} else None
        world.particles[name] = MaterialPoint(tuple(map(symbol, chart)), ONE, at.get(name, drawn))
    for name, chart in charts.items():
        world.frames[name] = body_frame(name, d, {q: given.get(q, ZERO) for q in chart}, name in cayley)
        if not given.keys().isdisjoint(bodies[name]):
            world.drawn.add(name)
    return world, tuple(coordinates), given


def _owners(scene: Entry, key: str, roles: Sequence[str]) -> dict[str, list[str]]:
    """The coordinates of each particle or body."""
    found: dict[str, list[str]] = {}
    for entry in scene.get(key, []):
        known_fields(entry, FIELDS[key])
        names = entry.get("coordinates") or [f"{role}_{entry['name']}" for role in roles]
        refuse(len(names) != len(roles) or entry["name"] in {*found, "ground"}, f"`{key}` cannot be read")
        found[entry["name"]] = names
    return found


def _parameters(world: Surroundings, given: Entry) -> dict[str, Tree]:
    """The parameters: symbols, whose signs are noted, and values, in which those before may stand."""
    found: dict[str, Tree] = {}
    for name, value in given.items():
        if value in SIGNS:
            world.signs[name] = value
        found[name] = symbol(name) if value in SIGNS else world.expression(value)
        world.names = KnownNames(values=dict(found))
    return found


def _relations(
    world: Surroundings, constraints: Sequence[Entry], coordinates: Sequence[str]
) -> Iterator[CheckedRelation]:
    """The relations of every constraint, in order."""
    rates, left, owners = {*(f"{q}dot" for q in coordinates), TIME_RATE}, MOST_RELATIONS, set[str]()
    for world.index, entry in enumerate(constraints, 1):
        called = entry.get("type", "equation")
        read, fields, dimensions = TYPES[called]
        known_fields(entry, f"type name {fields}")
        refuse(str(world.dimension) not in dimensions, f"no {called} is defined in dimension {world.dimension}")
        owner = str(entry.get("name", f"c{world.index}"))
        found = [one if isinstance(one, Sided) else Sided(one) for one in islice(read(world, entry), left + 1)]
        left -= len(found)
        refuse(left < 0 or owner in owners, f"'{owner}' names two constraints, or there are too many relations")
        owners.add(owner)
        for place, one in enumerate(found, 1):
            moving = not symbols_in(one.tree).isdisjoint(rates)
            kind: Kind = "inequality" if one.sign != "=" else "velocity" if moving else "finite"
            name = owner if len(found) == 1 else f"{owner}.{place}"
            yield CheckedRelation(name, owner, kind, one.tree, one.strict)


def _reference(world: Surroundings, coordinates: Sequence[str], given: Mapping[str, Tree]) -> dict[str, Tree]:
    """The drawing, where it places every body and gives every other coordinate; else nothing."""
    drawn = world.drawn | {"ground"}
    for _ in world.welded:
        drawn |= {name for pair in world.welded for name in pair if not drawn.isdisjoint(pair)}
    found = dict(given)
    for point in world.particles.values():
        found |= {str(q.value): part for q, part in zip(point.over, point.start or (), strict=False)}
    for frame in world.frames.values():
        found |= frame.reference
    complete = drawn.issuperset(world.frames) and found.keys() >= {*coordinates}
    return {q: found[q] for q in coordinates} if complete else {}
