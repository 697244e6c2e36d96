"""The names of a scene: the coordinates of its particles and bodies, its parameters, and faults of names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.errors import Fault
from dofkit.base.wording import nearest
from dofkit.expressions.text import Names, spelled, why_invalid
from dofkit.expressions.tree import Expr, num, parameter
from dofkit.scene.ledger import Ledger, ParsedTexts, Texts
from dofkit.scene.parts import Body, Declarations, Particle
from dofkit.system import BODY_ROLES, GROUND, PARTICLE_ROLES, Coordinate, Sign

SIGNS: tuple[Sign, ...] = ("real", "positive", "nonzero")
_KINDS_HINT = "write real, positive or nonzero, or a value in numbers and the parameters before it"
RESERVED = frozenset({"t", GROUND})
_OMIT = "leave it out, or choose another name"


class OwnerKind(NamedTuple):
    """The particles or the bodies of a scene: section, what one is ``called``, the ``roles`` of its coordinates."""

    section: str
    called: str
    owners: Sequence[Particle | Body]
    roles: tuple[str, ...]


def owner_kinds(scene: Declarations) -> tuple[OwnerKind, OwnerKind]:
    """Return the particles of a scene, then its bodies."""
    d = scene.dimension
    particles = OwnerKind("particles", "particle", scene.particles, PARTICLE_ROLES[d])
    return particles, OwnerKind("bodies", "body", scene.bodies, BODY_ROLES[d])


class NameTable(NamedTuple):
    """All coordinates in order, and the names of the coordinates of each particle and each body."""

    coordinates: tuple[Coordinate, ...]
    particles: dict[str, tuple[str, ...]]
    bodies: dict[str, tuple[str, ...]]


def coordinate_table(scene: Declarations) -> NameTable:
    """Return the coordinates of particles, then of bodies, then the further ones, in the order declared."""
    coordinates: list[Coordinate] = []
    names_by_owner: tuple[dict[str, tuple[str, ...]], dict[str, tuple[str, ...]]] = {}, {}
    for kind, names_of_owners in zip(owner_kinds(scene), names_by_owner, strict=True):
        roles = kind.roles
        kinds = ("x", "y", "angle") if scene.dimension == 2 and len(roles) == 3 else roles
        for owner in kind.owners:
            renamed, name = owner.coordinates, owner.name
            names = tuple([f"{r}_{subscript(name)}" for r in roles])
            names = renamed if renamed and len(renamed) == len(roles) else names
            names_of_owners[name] = names
            coordinates += [Coordinate(q, name, role) for q, role in zip(names, kinds, strict=True)]
    coordinates += [Coordinate(name) for name in scene.coordinates]
    return NameTable(tuple(coordinates), *names_by_owner)


def names_by_position(letter: str, written_names: Sequence[str | None]) -> tuple[str, ...]:
    """Return the names of constraints or forces: ``c1``, ``c2``, ... by position for those without a name."""
    return tuple(f"{letter}{i + 1}" if name is None else name for i, name in enumerate(written_names))


def subscript(name: str) -> str:
    """Return the name of a particle or body as part of its coordinates' names: with `_` for each hyphen.

    >>> subscript("k-1_0")
    'k_1_0'
    """
    return name.replace("-", "_")


def readable_name(name: str) -> str:
    """Return a name that a text can mention, similar to ``name``: `_` replaces all but letters and digits.

    >>> readable_name("k-1_0"), readable_name("left link"), readable_name("9 mm")
    ('k_1_0', 'left_link', 'n9_mm')
    """
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_") or "q"
    return plain if plain[0].isalpha() else f"n{plain}"


def _renaming_hint(name: str, why: str) -> str:
    latin = re.search(r"not the \w+ (`.`)$", why)
    if latin is not None:
        return f"type {latin[1]} instead"
    plain, words = readable_name(name), re.split(r"[\s,]+", name)
    several = "" if any(map(why_invalid, words)) else f", or `{', '.join(words)}` for several names"
    return f"write `{plain}`{several}" if plain != name and why_invalid(plain) is None else "choose another name"


@dataclass(frozen=True)
class Vocabulary:
    """The names of a scene: coordinates (``table``), values of ``parameters``, and a parser of texts with these names.

    ``signs``: real, positive or nonzero, of the parameters without a value; ``faults``: those of parameters' values.
    """

    table: NameTable
    parameters: Mapping[str, Expr]
    signs: Mapping[str, Sign]
    texts: ParsedTexts
    faults: tuple[Fault, ...]

    @property
    def names(self) -> Names:
        """The names that texts may mention."""
        return self.texts.names


def vocabulary_of(scene: Declarations) -> Vocabulary:
    """Return the vocabulary of a scene from its declarations."""
    table = coordinate_table(scene)
    parameters, signs, faults = _parameters(scene)
    return Vocabulary(table, parameters, signs, ParsedTexts(_declared_names(scene, table, parameters)), faults)


def _parameters(scene: Declarations) -> tuple[dict[str, Expr], dict[str, Sign], tuple[Fault, ...]]:
    """Return {parameter: symbol or value}, {parameter without a value: sign}, and the faults of the values.

    A value may mention the parameters declared before it.
    """
    stands: dict[str, Expr] = {}
    signs: dict[str, Sign] = {}
    faults: list[Fault] = []
    for name, value in scene.parameters.items():
        sign = next((sign for sign in SIGNS if sign == value), None)
        if isinstance(value, Fraction):
            stands[name] = num(value)
        elif sign is None:
            texts = Texts(ParsedTexts(Names(parameters=dict(stands))), ("parameters",), faults)
            stands[name] = _parameter_value(texts, name, value)
        else:
            stands[name], signs[name] = parameter(name), sign
    return stands, signs, tuple(faults)


def _parameter_value(texts: Texts, name: str, value: str) -> Expr:
    """Return the value of the parameter ``name``; after a fault, such as a misspelt sign, the symbol of that name."""
    if value.isalpha() and value not in (*texts.names.parameters, "pi", "E"):
        near = nearest(value, SIGNS)
        hint = f"did you mean '{near}'?" if near else _KINDS_HINT
        texts.fault(f"'{value}' is not a kind of parameter", name, hint=hint)
        return parameter(name)
    return texts.fixed(value, name)


def _declared_names(scene: Declarations, table: NameTable, parameters: Mapping[str, Expr]) -> Names:
    return Names(
        coordinates=frozenset(q.name for q in table.coordinates),
        parameters=dict(parameters),
        functions={name: len(arguments) for name, arguments in scene.functions.items()},
        arguments=dict(scene.functions),
        allow_accelerations=True,
    )


def within_member(names: Names, letters: tuple[str, ...]) -> Names:
    """Return the names in a formula about one particle or body, whose coordinates ``letters`` hide other meanings."""
    letter_names = frozenset(letters)
    return replace(
        names,
        coordinates=names.coordinates | letter_names,
        parameters={name: value for name, value in names.parameters.items() if name not in letter_names},
        functions={name: arity for name, arity in names.functions.items() if name not in letter_names},
        arguments={name: words for name, words in names.arguments.items() if name not in letter_names},
        allow_accelerations=True,
    )


#: A declared name: (name, what it names, path in the scene).
Entry = tuple[str, str, tuple[str | int, ...]]


def name_faults(scene: Declarations, table: NameTable) -> tuple[Fault, ...]:
    """Return a fault for every name that is reserved, cannot be read in a text, is repeated or clashes."""
    ledger = Ledger()
    _check_owners(scene, ledger)
    entries = [*_owned(scene, table), *_further(scene)]
    seen: dict[str, str] = {}
    for name, what, where in entries:
        word = name if name.isascii() else spelled(name)
        if word in seen:
            detail = f"{what} and {seen[word]}" if what != seen[word] else f"each time as {what}"
            ledger.fault(
                f"the name '{name}' is given twice: {detail}", *where, hint=f"rename one of them, for example `{name}2`"
            )
            continue
        seen[word] = what
        if name in RESERVED:
            detail = "time, and is never declared" if name == "t" else "the fixed world, and is never declared"
            ledger.fault(f"'{name}' is {detail}", *where, hint=_OMIT)
        else:
            why = why_invalid(name)
            if why is not None:
                ledger.fault(f"{why} ({what})", *where, hint=_renaming_hint(name, why))
    _check_derived(entries, seen, ledger)
    for name, arguments in scene.functions.items():
        for i, argument in enumerate(arguments):
            why = None if argument == "t" else why_invalid(argument)
            if why is not None:
                ledger.fault(why, "functions", name, i, hint="the arguments are names, such as [s] or [x, t]")
    return tuple(ledger.faults)


def _check_owners(scene: Declarations, ledger: Ledger) -> None:
    """Record the faults of the names of particles and bodies, and of the number of their coordinates."""
    seen: dict[str, str] = {}
    for section, called, owners, roles in owner_kinds(scene):
        for i, owner in enumerate(owners):
            name, where = owner.name, (section, i, "name")
            if name in RESERVED:
                meaning = "time" if name == "t" else "the fixed world"
                ledger.fault(f"'{name}' is {meaning}, and never declared", *where, hint=_OMIT)
            elif not _is_owner_name(name):
                hint = f"write `{readable_name(name)}`: a name has letters, digits, `_` and hyphens"
                ledger.fault(f"'{name}' cannot be the name of a {called}", *where, hint=hint)
            if name in seen:
                hint = f"rename it: `{name}` is a {seen[name]} already"
                ledger.fault(f"the name '{name}' is given twice", *where, hint=hint)
            seen.setdefault(name, called)
            if owner.coordinates is not None and len(owner.coordinates) != len(roles):
                needed = f"a {called} has {len(roles)} coordinates in dimension {scene.dimension}"
                hint = f"name them in the order {', '.join(roles)}"
                ledger.fault(f"{needed}, not {len(owner.coordinates)}", section, i, "coordinates", hint=hint)


def _is_owner_name(name: str) -> bool:
    """Return whether texts can mention the coordinates of a particle or body of this name."""
    return why_invalid(f"x_{subscript(name)}") is None


def _owned(scene: Declarations, table: NameTable) -> Iterator[Entry]:
    """Yield the coordinates of particles and bodies, without repeated owners, whose names are faults already."""
    seen: set[str] = set()
    for kind, owned in zip(owner_kinds(scene), (table.particles, table.bodies), strict=True):
        for i, owner in enumerate(kind.owners):
            if owner.name in seen:
                continue
            seen.add(owner.name)
            renamed = owner.coordinates is not None and owner.coordinates == owned[owner.name]
            if not renamed and not _is_owner_name(owner.name):
                continue
            what = f"a coordinate of {kind.called} '{owner.name}'"
            for j, name in enumerate(owned[owner.name]):
                yield name, what, (kind.section, i, "coordinates", j) if renamed else (kind.section, i, "name")


def _further(scene: Declarations) -> Iterator[Entry]:
    for i, name in enumerate(scene.coordinates):
        yield name, "a coordinate", ("coordinates", i)
    for name in scene.parameters:
        yield name, "a parameter", ("parameters", name)
    for name in scene.functions:
        yield name, "a function", ("functions", name)


def _check_derived(entries: list[Entry], seen: Mapping[str, str], ledger: Ledger) -> None:
    """Record a fault for every name that already means a differential, velocity or acceleration of a coordinate."""
    places = {name: k for k, (name, what, _) in enumerate(entries) if "coordinate" in what}
    for name, what, where in entries:
        if name[:1] != "d" and name[-3:] != "dot":
            continue
        meant = [(places[q], kind, q) for q, kind in _rates(name) if q in places]
        if meant and name in seen:
            _, kind, q = max(meant)
            ledger.fault(f"{what} is named '{name}', the {kind} of '{q}'", *where, hint="rename one of them")


def _rates(name: str) -> Iterator[tuple[str, str]]:
    """Yield (base, kind) for each way to read a name as the differential, velocity or acceleration of a base."""
    if name.startswith("d"):
        yield name[1:], "differential"
    if name.endswith("dot"):
        yield name[:-3], "velocity"
    if name.endswith("ddot"):
        yield name[:-4], "acceleration"
