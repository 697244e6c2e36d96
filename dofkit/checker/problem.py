"""A scene's document as a problem: coordinates, scalar relations with their owners, and the reference.

This reads the contract a second time and shares nothing with the engines. Velocities of q are the symbols ``qdot``, the
rate of time is ``tdot``. A generic symbol ``square_c3`` is the square of a length that was left out by the third
constraint, ``length_c3`` the length of a string, ``place_c3`` and ``axis_c3`` components of a place or of an axis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from dofkit.checker import equations, joints, links, places
from dofkit.checker.bodies import (
    BodyFrame,
    MaterialPoint,
    Vector,
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
from dofkit.checker.grammar import Sided, parse
from dofkit.checker.surroundings import Entry, Surroundings, fields_of
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, number, symbol
from dofkit.checker.words import ELEMENTARY, OPERATORS, KnownNames, spelled_out

__all__ = ["CheckedRelation", "Problem", "document_of", "read_problem"]

MOST_RELATIONS = 20_000
SIGNS = ("real", "positive", "nonzero")
PARTICLE = {1: ("x",), 2: ("x", "y"), 3: ("x", "y", "z")}
BODY = {1: ("x",), 2: ("x", "y", "theta"), 3: ("x", "y", "z", "phi", "theta", "psi")}
KEYS = (
    *("name", "title", "source", "notes", "dimension", "parameters", "functions", "particles", "bodies", "coordinates"),
    *("constraints", "forces", "energies", "tolerance", "configuration", "expect"),
)
Kind = Literal["finite", "velocity", "inequality"]
Read = Callable[[Surroundings, Entry], Iterator[Tree] | Iterator[Sided]]
#: Every type: how it is read, and the fields it has.
TYPES: dict[str, tuple[Read, tuple[str, ...]]] = {
    "equation": (equations.equation, ("text",)),
    "on": (equations.on, ("members", "surface", "curve")),
    "link": (links.link, ("between", "length")),
    "rigid": (links.rigid, ("members",)),
    "string": (links.string, ("along", "length")),
    "fixed": (places.fixed, ("point", "body")),
    "coincident": (places.coincident, ("between",)),
    "slot": (places.slot, ("point", "body", "at", "axis")),
    "cam": (places.cam, ("point", "body", "curve")),
    "roll": (places.roll, ("body", "radius")),
    "revolute": (joints.revolute, ("between", "at", "axis", "drive")),
    "prismatic": (joints.prismatic, ("between", "at", "axis", "drive")),
    "weld": (joints.weld, ("between",)),
    "cylindrical": (joints.cylindrical, ("between", "at", "axis", "drive")),
    "screw": (joints.screw, ("between", "at", "axis", "drive", "pitch")),
    "universal": (joints.universal, ("between", "at", "axes")),
    "spherical": (joints.spherical, ("between", "at", "axis")),
    "planar": (joints.planar, ("between", "at", "axis")),
    "gear": (joints.gear, ("between", "ratio", "carrier")),
}
IN_SPACE = ("cylindrical", "screw", "universal", "spherical", "planar")
IN_PLANE = ("gear", "cam")


@dataclass(frozen=True)
class CheckedRelation:
    """One scalar relation: ``left`` = 0, or of an inequality ``left`` > 0 (``strict``) or >= 0."""

    name: str
    owner: str
    kind: Kind
    left: Tree
    strict: bool = False


@dataclass(frozen=True)
class Problem:
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
    names: KnownNames

    @property
    def rates(self) -> tuple[str, ...]:
        """The names of the velocities."""
        return tuple(f"{q}dot" for q in self.coordinates)


def read_problem(document: Mapping[str, Any], cayley: frozenset[str] = frozenset()) -> Problem:
    """The problem of a document; bodies in ``cayley`` are read with Cayley parameters in the place of angles."""
    scene = exact_document(document)
    unknown = {key for key in scene if scene[key] is not None} - {*KEYS}
    if unknown:
        raise CheckError(f"a scene has no `{min(unknown)}`")
    try:
        return _Reading(scene, cayley).problem()
    except (KeyError, TypeError, AttributeError, RecursionError, ZeroDivisionError) as error:
        raise CheckError(f"the scene cannot be read: {type(error).__name__} {str(error)[:80]}") from None


class _Reading:
    """One document while it is read."""

    def __init__(self, scene: Mapping[str, Any], cayley: frozenset[str]) -> None:
        self.scene, self.cayley = scene, cayley
        self.dimension = scene.get("dimension") or 3
        if self.dimension not in (1, 2, 3):
            raise CheckError("the dimension is 1, 2 or 3")
        self.particles = self._owners("particles", PARTICLE[self.dimension], ("at", "mass"))
        self.bodies = self._owners("bodies", BODY[self.dimension], ("mass", "inertia"))
        if cayley - set(self.bodies) or (cayley and self.dimension != 3):
            raise CheckError("Cayley parameters are of bodies of space")
        further = self._list("coordinates")
        written = [q for owned in (self.particles, self.bodies) for names, _ in owned.values() for q in names]
        self.values, self.signs = self._parameters()
        functions = {
            name: (given,) if isinstance(given, str) else tuple(given)
            for name, given in (scene.get("functions") or {}).items()
        }
        self.written = (*written, *further)
        self._check_names([*self.written, *self.values, *functions])
        hidden = {q for body in cayley for q in self.bodies[body][0][3:]}
        self.names = KnownNames(frozenset(self.written) - hidden, self.values, functions)
        self.configuration = {str(q): self._constant(value) for q, value in (scene.get("configuration") or {}).items()}
        if set(self.configuration) - set(self.written):
            raise CheckError("the configuration mentions what is no coordinate")

    def _list(self, key: str) -> list[Any]:
        found = self.scene.get(key)
        if not isinstance(found, (list, type(None))):
            raise CheckError(f"`{key}` is a list")
        return found or []

    def _owners(self, key: str, roles: tuple[str, ...], fields: tuple[str, ...]) -> dict[str, tuple[list[str], Entry]]:
        """Particles or bodies: their coordinates and entries."""
        found: dict[str, tuple[list[str], Entry]] = {}
        for entry in self._list(key):
            entry = {"name": entry} if isinstance(entry, str) else entry
            fields_of(entry, key, ("coordinates", *fields))
            names = entry.get("coordinates") or [f"{role}_{entry['name']}" for role in roles]
            if len(names) != len(roles) or entry["name"] in found or entry["name"] in ("t", "ground"):
                raise CheckError(f"'{entry['name']}' in `{key}` cannot be read")
            found[entry["name"]] = names, entry
        return found

    def _parameters(self) -> tuple[dict[str, Tree], dict[str, str]]:
        given = self.scene.get("parameters") or {}
        if isinstance(given, (str, list)):
            given = dict.fromkeys([given] if isinstance(given, str) else given, "real")
        values: dict[str, Tree] = {}
        signs: dict[str, str] = {}
        for name, value in given.items():
            value = value_text("real" if value is None else value)
            if value in SIGNS:
                values[name], signs[name] = symbol(name), str(value)
            else:
                values[name] = (
                    number(value) if isinstance(value, int) else parse(str(value), KnownNames(values=dict(values)))
                )
                if "t" in symbols_in(values[name]):
                    raise CheckError(f"the parameter '{name}' depends on time")
        return values, signs

    def _constant(self, value: object) -> Tree:
        value = value_text(value)
        found = number(value) if isinstance(value, int) else parse(str(value), KnownNames(values=self.values))
        if symbols_in(found) - set(self.signs):
            raise CheckError(f"`{value}` is no constant")
        return found

    def _check_names(self, names: list[str]) -> None:
        """No name is given twice, reserved, or the velocity or differential of another."""
        spelled = [spelled_out(name) for name in names]
        plain = all(word[:1].isalpha() and word.isascii() and word.replace("_", "").isalnum() for word in spelled)
        reserved = {"t", "dt", "tdot", "ground", "pi", *ELEMENTARY, *OPERATORS}
        derived = {form for q in self.written for form in (f"d{q}", f"{q}dot", f"{q}ddot")}
        own = {f"{body}_{letter}{end}" for body in self.cayley for letter in "abc" for end in ("", "dot")}
        if len(set(spelled)) < len(spelled) or not plain or not reserved.isdisjoint(spelled):
            raise CheckError("a name is given twice, reserved or not made of letters and digits")
        if not (derived | own | {spelled_out(form) for form in derived}).isdisjoint({*names, *spelled}):
            raise CheckError("a name is that of a velocity or differential")

    def problem(self) -> Problem:
        world = self._world()
        relations = tuple(self._relations(world))
        coordinates = tuple(name for q in self._charts() for name in q)
        generic = tuple(world.generic)
        if not {*coordinates, *self.names.values, *self.names.functions}.isdisjoint(generic):
            raise CheckError("a name is that of a generic symbol")
        tolerance = value_text(self.scene.get("tolerance"))
        return Problem(
            name=str(self.scene.get("name") or "scene"),
            dimension=self.dimension,
            coordinates=coordinates,
            parameters=self.signs,
            functions={name: len(given) for name, given in self.names.functions.items()},
            relations=relations,
            generic=generic,
            reference={} if generic else self._reference(world, coordinates),
            tolerance=str(tolerance) if tolerance else None,
            names=KnownNames(
                frozenset(coordinates),
                {**self.values, **{name: symbol(name) for name in generic}},
                self.names.functions,
            ),
        )

    def _charts(self) -> Iterator[list[str]]:
        """The coordinates in order, Cayley parameters in the place of angles."""
        yield from (names for names, _ in self.particles.values())
        for body, (names, _) in self.bodies.items():
            yield [*names[:3], *(f"{body}_{letter}" for letter in "abc")] if body in self.cayley else names
        yield self._list("coordinates")

    def _world(self) -> Surroundings:
        d = self.dimension
        origin = (ZERO,) * d
        world = Surroundings(d, self.names, self.signs, BodyFrame("ground", origin, origin, identity(d)))
        for particle, (names, entry) in self.particles.items():
            start: Vector | None = world.vector(entry["at"]) if entry.get("at") is not None else None
            if start is None and all(q in self.configuration for q in names):
                start = tuple(self.configuration[q] for q in names)
            world.particles[particle] = MaterialPoint(tuple(map(symbol, names)), ONE, start, None)
        for body, (names, _) in self.bodies.items():
            world.frames[body] = self._frame(body, names)
            if any(q in self.configuration for q in names):
                world.drawn.add(body)
        return world

    def _frame(self, body: str, names: list[str]) -> BodyFrame:
        d, cayley = self.dimension, body in self.cayley
        values = tuple(self.configuration.get(q, ZERO) for q in names)
        position, initial = tuple(map(symbol, names[:d])), values[d:]
        angles = tuple(f"{body}_{letter}" for letter in "abc") if cayley else tuple(names[d:])
        if cayley:
            g = tuple(map(symbol, angles))
            start, initial = values[:d], (ZERO,) * 3
            return BodyFrame(body, position, start, cayley_turn(g), add(ONE, square(g)), angles, initial, True)
        turn = identity(d)
        if d == 2:
            turn = plane_turn(symbol(angles[0]) if initial[0] == ZERO else add(symbol(angles[0]), negative(initial[0])))
        if d == 3:
            turn = euler_turn(*(symbol(name) for name in angles))
            if any(value != ZERO for value in initial):
                turn = matrix_product(turn, transposed(euler_turn(*initial)))
        return BodyFrame(body, position, values[:d], turn, ONE, angles, initial)

    def _relations(self, world: Surroundings) -> Iterator[CheckedRelation]:
        rates = {f"{q}dot" for names in self._charts() for q in names} | {"tdot"}
        used: set[str] = set()
        total = 0
        for index, entry in enumerate(self._list("constraints"), 1):
            entry = {"type": "equation", "text": entry} if isinstance(entry, str) else entry
            owner, world.index = str(entry.get("name") or f"c{index}"), index
            found = self._read(world, entry)
            total += len(found)
            if owner in used or total > MOST_RELATIONS:
                raise CheckError(f"the constraint '{owner}' is given twice, or there are too many")
            used.add(owner)
            for number_, one in enumerate(found, 1):
                moving = not symbols_in(one.tree).isdisjoint(rates)
                kind: Kind = "inequality" if one.sign != "=" else "velocity" if moving else "finite"
                name = owner if len(found) == 1 else f"{owner}.{number_}"
                yield CheckedRelation(name, owner, kind, one.tree, one.strict)

    def _read(self, world: Surroundings, entry: Entry) -> list[Sided]:
        kind = str(entry.get("type") or "equation")
        if kind not in TYPES:
            raise CheckError(f"there is no constraint type '{kind}'")
        if (kind in IN_SPACE and self.dimension != 3) or (kind in IN_PLANE and self.dimension != 2):
            raise CheckError(f"a constraint of type {kind} is not defined in dimension {self.dimension}")
        read, fields = TYPES[kind]
        fields_of(entry, kind, fields)
        return [one if isinstance(one, Sided) else Sided(one, "=", False) for one in read(world, entry)]

    def _reference(self, world: Surroundings, coordinates: tuple[str, ...]) -> dict[str, Tree]:
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
        complete = all(body in drawn for body in world.frames) and all(q in found for q in coordinates)
        return {q: found[q] for q in coordinates} if complete else {}
