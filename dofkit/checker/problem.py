"""A scene's document as a problem: coordinates, scalar relations with their owners, and the reference.

A document is what YAML or JSON writes: mappings, lists, texts, numbers. Its canonical form leaves out what says nothing
of the mathematics, so that one scene has one hash however it is written; in it whole numbers are numbers, others texts
such as ``1/2``.

This reads the contract a second time and shares nothing with the engines. Velocities of q are the symbols ``qdot``, the
rate of time is ``tdot``. A generic symbol ``square_c3`` is the square of a length that was left out by the third
constraint, ``length_c3`` the length of a string, ``place_c3`` and ``axis_c3`` components of a place or of an axis.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from hashlib import sha256
from itertools import chain, islice
from typing import Any, NamedTuple

from dofkit.checker.constraints import TYPES, Entry, Surroundings, known_fields
from dofkit.checker.geometry import MaterialPoint, body_frame, ground
from dofkit.checker.grammar import BUILT_IN, DECIMAL, KnownNames, Sided, parse, spelled_out
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, homogeneous_degree, refuse, substituted, symbol

LONGEST_VALUE, DEEPEST, MOST_RELATIONS = 400, 40, 8_000
#: What is as good as left out; no name is one of these.
_NULLS = (None, "", "~", "null", "Null", "NULL")
_VALUE = re.compile(rf"\s*([-+]?{DECIMAL})(?:\s*/\s*(\d*[1-9]\d*))?\s*", re.ASCII)
#: Keys that say nothing of the mathematics, and values that are as good as left out.
_SILENT = ("name", "title", "source", "notes", "left_out", "expect", "picture")
_DEFAULTS = {"dimension": 3, "tolerance": 0}
#: What a text alone stands for in these lists.
_SHORT = {"particles": ("name", {}), "bodies": ("name", {}), "constraints": ("text", {"type": "equation"})}
SIGNS = ("real", "positive", "nonzero")
ROLES = {1: ("x",), 2: ("x", "y", "theta"), 3: ("x", "y", "z", "phi", "theta", "psi")}
KEYS = "dimension parameters functions particles bodies coordinates constraints forces energies tolerance configuration"
FIELDS = {"particles": "name coordinates at mass", "bodies": "name coordinates mass inertia"}


def _mapping(pairs: list[tuple[Any, Any]]) -> dict[str, Any]:
    mapping = dict(pairs) if all(isinstance(key, str) for key, _ in pairs) else {}
    refuse(len(mapping) < len(pairs), "a key is no text, or stands twice in one mapping")
    return mapping


def canonical(document: object) -> dict[str, Any]:
    """The document without its name, titles, notes and empty entries, short forms written out and values exact."""
    mapping = _canonical(document, "", 0)
    refuse(not isinstance(mapping, dict), "a scene is a mapping")
    return {key: part for key, part in mapping.items() if key not in _SILENT and part != _DEFAULTS.get(key)}


def _canonical(value: Any, key: str, depth: int) -> Any:
    """A part of a document that stands under ``key``."""
    refuse(depth > DEEPEST, "a document is nested too deep")
    if key == "parameters" and isinstance(value, list):
        value = _mapping([(name, None) for name in value])
    if isinstance(value, Mapping):
        missing = "real" if key == "parameters" else None
        pairs = [(name, missing if part in _NULLS else part) for name, part in value.items()]
        mapping = _mapping([(name, _canonical(part, name, depth + 1)) for name, part in pairs])
        return {name: part for name, part in mapping.items() if part not in (None, {}, [])}
    if isinstance(value, (list, tuple)):
        short, defaults = _SHORT.get(key, ("", {}))
        longer = [{**defaults, short: item} if short and isinstance(item, str) else item for item in value]
        return [_canonical(item, "" if short else key, depth + 1) for item in longer]
    if isinstance(value, bool) or (key == "name" and isinstance(value, str)):
        return value
    if value in _NULLS:
        return None
    match = _VALUE.fullmatch(str(value)) if len(str(value)) <= LONGEST_VALUE else None
    if match is None:
        refuse(not isinstance(value, str), f"{str(value)[:40]} cannot stand in a document")
        return value
    exact = Fraction(match[1]) / int(match[2] or 1)
    return int(exact) if exact.denominator == 1 else str(exact)


def sha256_of(document: object) -> str:
    """The hash of the canonical JSON of a document."""
    text = json.dumps(canonical(document), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


class CheckedRelation(NamedTuple):
    """One scalar relation: ``tree`` = 0, or of an inequality ``tree`` > 0 (``strict``) or >= 0.

    ``kind``: ``finite``, ``velocity`` or ``inequality``; ``leaf``: an integral, which keeps its value at the point.
    """

    name: str
    owner: str
    kind: str
    tree: Tree
    strict: bool = False
    leaf: bool = False


class CheckedProblem(NamedTuple):
    """What a scene says. ``reference`` is at t = 0, empty where there is none.

    ``turns``: the Euler angles of bodies; where the sine of the second is 0 they are no chart of the poses around.
    ``world``: the ``scene`` as it was read.
    """

    coordinates: tuple[str, ...]
    relations: tuple[CheckedRelation, ...]
    reference: Mapping[str, Tree]
    turns: tuple[tuple[str, ...], ...]
    scene: Entry
    world: Surroundings

    def in_rates(self, value: Any) -> Tree:
        """A number or text in which velocities may occur."""
        tree = value if isinstance(value, Tree) else parse(value, self.world.names)
        refuse(homogeneous_degree(tree, ["dt"]) != 0, "an energy holds differentials")
        return substituted(tree, {"dt": ONE})


def problem_of_canonical(scene: Entry, cayley: frozenset[str] = frozenset()) -> CheckedProblem:
    """The problem of a document in its canonical form; bodies in ``cayley`` have Cayley parameters, not angles."""
    try:
        known_fields(scene, KEYS)
        world, coordinates, configured = _surroundings(scene, cayley)
        relations = tuple(_relations(world, scene, coordinates))
        symbols = frozenset[str]().union(*(relation.tree.symbols for relation in relations))
        reference = {} if world.generic else _reference(world, coordinates, configured, symbols)
    except (LookupError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise CheckError(f"the scene cannot be read: {type(error).__name__} {str(error)[:200]}") from None
    names = [*coordinates, *world.names.values, *world.names.functions, *world.generic]
    for group in (names, [relation.name for relation in relations]):
        refuse(len({*group}) < len(group), "a name is that of a generic symbol, or relations have one name")
    turning = (relation for relation in world.frames.values() if world.dimension == 3 and relation.cayley is None)
    turns = tuple(tuple(relation.reference)[3:] for relation in turning)
    return CheckedProblem(coordinates, relations, reference, turns, scene, world)


def _surroundings(scene: Entry, cayley: frozenset[str]) -> tuple[Surroundings, tuple[str, ...], dict[str, Tree]]:
    """The names, points and bodies of a scene; its coordinates; the values that its configuration gives."""
    d, others, functions = scene.get("dimension", 3), scene.get("coordinates", []), scene.get("functions", {})
    refuse(type(d) is not int or d not in ROLES, "a world has 1, 2 or 3 dimensions")
    world = Surroundings(d, {"ground": ground(d)})
    particles, bodies = _owners(scene, "particles", ROLES[d][:d]), _owners(scene, "bodies", ROLES[d])
    refuse(not cayley <= bodies.keys() or (cayley and d != 3), "Cayley parameters are of bodies of space")
    charts = bodies | {body: [*bodies[body][:3], *(f"{body}_{g}" for g in "abc")] for body in cayley}
    written = [*chain(*particles.values(), *bodies.values(), others)]
    coordinates = (*chain(*particles.values(), *charts.values(), others),)
    world.signs = {name: value for name, value in scene.get("parameters", {}).items() if value in SIGNS}
    values: dict[str, Tree] = {}
    for name, value in scene.get("parameters", {}).items():
        values[name] = symbol(name) if name in world.signs else world.expression(value)
        world.names = KnownNames(values={**values})
    names = [spelled_out(name) for name in (*written, *values, *functions)]
    twice = len({*names, *BUILT_IN, "tdot"}) <= len(names) + len(BUILT_IN)
    every = KnownNames(frozenset([*written, *coordinates]), values, functions)
    for name in (*names, *map(spelled_out, coordinates)):
        word = re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name) and name not in _NULLS
        refuse(twice or not word or every.moved(name), "a name is taken, or is not made of letters")
    listed = all(isinstance(arguments, list) for arguments in functions.values())
    refuse(not listed, "a function has a list of arguments")
    configured = {q: world.expression(value) for q, value in scene.get("configuration", {}).items()}
    refuse(not configured.keys() <= {*written}, "the configuration mentions what is no coordinate")
    world.names = KnownNames(frozenset(written).intersection(coordinates), values, functions)
    at = {entry["name"]: world.vector(entry["at"]) for entry in scene.get("particles", []) if "at" in entry}
    for name, chart in particles.items():
        drawn = tuple(configured[q] for q in chart) if configured.keys() >= {*chart} else None
        world.particles[name] = MaterialPoint(tuple(map(symbol, chart)), ONE, at.get(name, drawn))
    for name, chart in charts.items():
        world.frames[name] = body_frame(name, d, {q: configured.get(q, ZERO) for q in chart}, name in cayley)
        if not configured.keys().isdisjoint(bodies[name]):
            world.drawn.add(name)
        angles = bodies[name][3:]
        if name in cayley and all(configured.get(q, ZERO) == ZERO for q in angles):
            world.angles[name] = angles
    return world, coordinates, configured


def _owners(scene: Entry, key: str, roles: Sequence[str]) -> dict[str, list[str]]:
    """The coordinates of each particle or body."""
    charts: dict[str, list[str]] = {}
    for entry in scene.get(key, []):
        known_fields(entry, FIELDS[key])
        names = entry.get("coordinates") or [f"{role}_{entry['name'].replace('-', '_')}" for role in roles]
        refuse(len(names) != len(roles) or entry["name"] in {*charts, "ground"}, f"`{key}` cannot be read")
        charts[entry["name"]] = names
    return charts


def _relations(world: Surroundings, scene: Entry, coordinates: Sequence[str]) -> Iterator[CheckedRelation]:
    """The relations of every constraint, in order."""
    rates, remaining = {*(f"{q}dot" for q in coordinates), "tdot"}, MOST_RELATIONS
    entries = enumerate(scene.get("constraints", []), 1)
    named = {str(entry.get("name", f"c{place}")): entry for place, entry in entries}
    refuse(len(named) < len(scene.get("constraints", [])), "two constraints have one name")
    world.joints |= named
    for world.index, (owner, entry) in enumerate(named.items(), 1):
        called = entry.get("type", "equation")
        refuse(called not in TYPES, f"no type of constraint is called {called}")
        read, fields, dimensions = TYPES[called]
        known_fields(entry, f"type name {fields}")
        refuse(str(world.dimension) not in dimensions, f"no {called} is defined in dimension {world.dimension}")
        sided = islice(read(world, entry), remaining + 1)
        relations = [relation if isinstance(relation, Sided) else Sided(relation) for relation in sided]
        remaining -= len(relations)
        refuse(remaining < 0, "there are too many relations")
        for place, relation in enumerate(relations, 1):
            moving = not relation.tree.symbols.isdisjoint(rates)
            kind = "inequality" if relation.sign != "=" else "velocity" if moving else "finite"
            name = owner if len(relations) == 1 else f"{owner}.{place}"
            yield CheckedRelation(name, owner, kind, relation.tree, relation.sign == ">")


def _reference(
    world: Surroundings, coordinates: Sequence[str], configured: Mapping[str, Tree], symbols: frozenset[str]
) -> dict[str, Tree]:
    """The reference, where it places every body and gives every other coordinate that a relation holds; else nothing.

    ``symbols``: of relations. Where no relation holds any, it has to give all. What none holds may stand anywhere.
    """
    drawn = world.drawn | {"ground"}
    poses = dict(configured)
    for point in world.particles.values():
        poses |= {str(q.value): part for q, part in zip(point.over, point.start or (), strict=False)}
    for frame in world.frames.values():
        poses |= frame.reference
    held = {q for q in coordinates if not symbols.isdisjoint((q, f"{q}dot"))} or {*coordinates}
    placed = all(name in drawn or held.isdisjoint(frame.reference) for name, frame in world.frames.items())
    return {q: poses.get(q, ZERO) for q in coordinates} if placed and poses.keys() >= held else {}
