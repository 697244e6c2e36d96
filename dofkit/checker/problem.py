"""A scene's document as a problem: coordinates, scalar relations with their owners, and the reference.

This reads the contract a second time and shares nothing with the engines. Velocities of q are the symbols ``qdot``, the
rate of time is ``tdot``. A generic symbol ``square_c3`` is the square of a length that was left out by the third
constraint, ``length_c3`` the length of a string, ``place_c3`` and ``axis_c3`` components of a place or of an axis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal

from dofkit.checker import equations, joints, links, places
from dofkit.checker.bodies import (
    CheckedFrame,
    MaterialPoint,
    cayley_turn,
    euler_turn,
    identity,
    matrix_product,
    plane_turn,
    square,
    transposed,
)
from dofkit.checker.derivatives import symbols_in
from dofkit.checker.document import document_of, exact_document, value_text
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import Sided
from dofkit.checker.surroundings import Entry, Surroundings, known_fields
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, symbol
from dofkit.checker.words import BUILT_IN, KnownNames, spelled_out

__all__ = ["CheckedRelation", "Problem", "document_of", "read_problem"]

MOST_RELATIONS = 20_000
SIGNS = ("real", "positive", "nonzero")
ROLES = {1: ("x",), 2: ("x", "y", "theta"), 3: ("x", "y", "z", "phi", "theta", "psi")}
KEYS = (
    *("name", "title", "source", "notes", "dimension", "parameters", "functions", "particles", "bodies", "coordinates"),
    *("constraints", "forces", "energies", "tolerance", "configuration", "expect"),
)
Kind = Literal["finite", "velocity", "inequality"]
Read = Callable[[Surroundings, Entry], Iterator[Tree | Sided]]
#: Every type: how it is read, the fields it has, and the dimensions in which it is defined.
TYPES: dict[str, tuple[Read, str, str]] = {
    "equation": (equations.equation, "text", "123"),
    "on": (equations.on, "members surface curve", "123"),
    "link": (links.link, "between length", "123"),
    "rigid": (links.rigid, "members", "123"),
    "string": (links.string, "along length", "123"),
    "fixed": (places.fixed, "point body", "123"),
    "coincident": (places.coincident, "between", "123"),
    "slot": (places.slot, "point body at axis", "23"),
    "cam": (places.cam, "point body curve", "2"),
    "roll": (places.roll, "body radius", "23"),
    "revolute": (joints.joint, "between at axis drive", "23"),
    "prismatic": (joints.joint, "between at axis drive", "23"),
    "weld": (joints.joint, "between", "23"),
    "cylindrical": (joints.joint, "between at axis drive", "3"),
    "screw": (joints.joint, "between at axis drive pitch", "3"),
    "universal": (joints.joint, "between at axes", "3"),
    "spherical": (joints.joint, "between at axis", "3"),
    "planar": (joints.joint, "between at axis", "3"),
    "gear": (joints.gear, "between ratio carrier", "2"),
}


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
    scene = exact_document(document)
    known_fields(scene, "scene", KEYS)
    try:
        return _DocumentReading({key: value for key, value in scene.items() if value is not None}, cayley).problem()
    except CheckError:
        raise
    except (LookupError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise CheckError(f"the scene cannot be read: {type(error).__name__} {str(error)[:80]}") from None


class _DocumentReading:
    """One document while it is read."""

    def __init__(self, scene: Mapping[str, Any], cayley: frozenset[str]) -> None:
        self.scene, self.cayley, self.dimension = scene, cayley, scene.get("dimension", 3)
        roles = ROLES[self.dimension]
        self.particles = self._owners("particles", roles[: self.dimension], ("name", "coordinates", "at", "mass"))
        self.bodies = self._owners("bodies", roles, ("name", "coordinates", "mass", "inertia"))
        if not cayley <= set(self.bodies) or (cayley and self.dimension != 3):
            raise CheckError("Cayley parameters are of bodies of space")
        further = scene.get("coordinates", [])
        owned = [names for owners in (self.particles, self.bodies) for names, _ in owners.values()]
        self.written = [q for names in (*owned, further) for q in names]
        self.charts = {body: own for body, (own, _) in self.bodies.items()}
        self.charts |= {body: [*self.charts[body][:3], *(f"{body}_{letter}" for letter in "abc")] for body in cayley}
        points = [names for names, _ in self.particles.values()]
        self.coordinates = tuple(q for names in (*points, *self.charts.values(), further) for q in names)
        functions = {h: (s,) if isinstance(s, str) else tuple(s) for h, s in scene.get("functions", {}).items()}
        self.signs: dict[str, str] = {}
        plain = Surroundings(self.dimension, KnownNames(), self.signs, {})
        for name, value in self._parameters().items():
            sign = "real" if value is None else value if value in SIGNS else None
            if sign is not None:
                self.signs[name] = sign
            tree = symbol(name) if sign is not None else plain.expression(value)
            plain.names = KnownNames(values={**plain.names.values, name: tree})
        self._check_names([*self.written, *plain.names.values, *functions])
        self.configuration = {q: plain.expression(value) for q, value in scene.get("configuration", {}).items()}
        if not set(self.configuration) <= set(self.written):
            raise CheckError("the configuration mentions what is no coordinate")
        known = frozenset(self.written).intersection(self.coordinates)
        self.names = KnownNames(known, plain.names.values, functions)

    def _owners(self, key: str, roles: tuple[str, ...], fields: tuple[str, ...]) -> dict[str, tuple[list[str], Entry]]:
        """Particles or bodies: their coordinates and entries."""
        found: dict[str, tuple[list[str], Entry]] = {}
        for written in self.scene.get(key, []):
            entry: Entry = {"name": written} if isinstance(written, str) else written
            known_fields(entry, key, fields)
            names = entry.get("coordinates") or [f"{role}_{entry['name']}" for role in roles]
            if len(names) != len(roles) or entry["name"] in found or entry["name"] == "ground":
                raise CheckError(f"'{entry['name']}' in `{key}` cannot be read")
            found[entry["name"]] = names, entry
        return found

    def _parameters(self) -> Mapping[str, Any]:
        given = self.scene.get("parameters", {})
        return given if isinstance(given, dict) else dict.fromkeys([given] if isinstance(given, str) else given)

    def _check_names(self, names: list[str]) -> None:
        """No name is given twice, reserved, or the velocity or differential of another."""
        spelled = [spelled_out(name) for name in names]
        derived = {form.format(q) for q in {*self.written, *self.coordinates} for form in ("d{}", "{}dot", "{}ddot")}
        taken = {*BUILT_IN, "tdot", "ground", *derived, *map(spelled_out, derived)}
        taken |= set(self.coordinates) - set(self.written)
        plain = all(word[:1].isalpha() and word.isascii() and word.replace("_", "").isalnum() for word in spelled)
        if len(set(spelled)) < len(spelled) or not plain or not taken.isdisjoint({*names, *spelled}):
            raise CheckError("a name is given twice, taken, or not made of letters and digits")

    def problem(self) -> CheckedProblem:
        """All that the scene says."""
        world = self._world()
        relations = tuple(self._relations(world))
        taken = {*self.coordinates, *self.names.values, *self.names.functions}
        if not taken.isdisjoint(world.generic) or len({one.name for one in relations}) < len(relations):
            raise CheckError("a name is that of a generic symbol, or relations have one name")
        tolerance = value_text(self.scene.get("tolerance"))
        return CheckedProblem(
            name=str(self.scene.get("name", "scene")),
            dimension=self.dimension,
            coordinates=self.coordinates,
            parameters=self.signs,
            functions={name: len(given) for name, given in self.names.functions.items()},
            relations=relations,
            generic=tuple(world.generic),
            reference={} if world.generic else self._reference(world),
            tolerance=str(tolerance) if tolerance else None,
        )

    def _world(self) -> Surroundings:
        d, zero = self.dimension, (ZERO,) * self.dimension
        world = Surroundings(d, self.names, self.signs, {"ground": CheckedFrame("ground", zero, zero, identity(d))})
        for particle, (names, entry) in self.particles.items():
            start = world.vector(entry["at"]) if entry.get("at") is not None else None
            if start is None and all(q in self.configuration for q in names):
                start = tuple(self.configuration[q] for q in names)
            world.particles[particle] = MaterialPoint(tuple(map(symbol, names)), ONE, start)
        for body, (names, _) in self.bodies.items():
            values = tuple(self.configuration.get(q, ZERO) for q in names)
            world.frames[body] = _frame(body, self.charts[body], values, body in self.cayley)
            if any(q in self.configuration for q in names):
                world.drawn.add(body)
        return world

    def _relations(self, world: Surroundings) -> Iterator[CheckedRelation]:
        rates = {f"{q}dot" for q in self.coordinates} | {"tdot"}
        total, used = 0, set[str]()
        for world.index, written in enumerate(self.scene.get("constraints", []), 1):
            entry = {"type": "equation", **({"text": written} if isinstance(written, str) else written)}
            read, fields, dimensions = TYPES[entry["type"]]
            known_fields(entry, entry["type"], ("type", "name", *fields.split()))
            if str(self.dimension) not in dimensions:
                raise CheckError(f"a constraint of type {entry['type']} is not defined in dimension {self.dimension}")
            owner = str(entry.get("name") or f"c{world.index}")
            first = islice(read(world, entry), MOST_RELATIONS - total + 1)
            found = [one if isinstance(one, Sided) else Sided(one) for one in first]
            total += len(found)
            if total > MOST_RELATIONS or owner in used:
                raise CheckError(f"'{owner}' is the name of two constraints, or there are too many relations")
            used.add(owner)
            for place, one in enumerate(found, 1):
                moving = not symbols_in(one.tree).isdisjoint(rates)
                kind: Kind = "inequality" if one.sign != "=" else "velocity" if moving else "finite"
                yield CheckedRelation(
                    owner if len(found) == 1 else f"{owner}.{place}", owner, kind, one.tree, one.strict
                )

    def _reference(self, world: Surroundings) -> dict[str, Tree]:
        """The drawing, where it places every body and gives every other coordinate; else nothing."""
        drawn = world.drawn | {"ground"}
        for _ in world.welded:
            drawn |= {name for pair in world.welded for name in pair if not drawn.isdisjoint(pair)}
        found = dict(self.configuration)
        for point in world.particles.values():
            found |= {str(q.value): part for q, part in zip(point.over, point.start or (), strict=False)}
        for frame in world.frames.values():
            names = (*(str(q.value) for q in frame.position), *frame.angles)
            found |= dict(zip(names, (*frame.start, *frame.initial), strict=True))
        complete = drawn.issuperset(world.frames) and all(q in found for q in self.coordinates)
        return {q: found[q] for q in self.coordinates} if complete else {}


def _frame(body: str, chart: list[str], values: tuple[Tree, ...], cayley: bool) -> CheckedFrame:
    """A body with its coordinates and their reference values."""
    d = {1: 1, 3: 2, 6: 3}[len(chart)]
    position, start, initial, angles = tuple(map(symbol, chart[:d])), values[:d], values[d:], tuple(chart[d:])
    turning = tuple(map(symbol, angles))
    if cayley:
        under = add(ONE, square(turning))
        return CheckedFrame(body, position, start, cayley_turn(turning), under, angles, (ZERO,) * 3, cayley)
    turn = identity(d)
    if d == 2:
        turn = plane_turn(add(turning[0], negative(initial[0])))
    if d == 3:
        turn = euler_turn(*turning)
        if any(value != ZERO for value in initial):
            turn = matrix_product(turn, transposed(euler_turn(*initial)))
    return CheckedFrame(body, position, start, turn, ONE, angles, initial)
