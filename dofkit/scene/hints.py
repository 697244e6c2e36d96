"""Hints for the faults of a scene: the type and the keys that were meant, and an example line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from dofkit.base.documents import package_table
from dofkit.base.errors import Fault
from dofkit.base.wording import nearest
from dofkit.expressions.text.characters import LETTERS_OF_NAMES
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.constraints.base import Equation
from dofkit.scene.fields import meant_key
from dofkit.scene.synonyms import Path, dimension_of, other_keys

UNKNOWN_KEY = "unknown key"
UNKNOWN_TYPE = "there is no constraint type"
#: Hints that need no example line.
_ENOUGH = re.compile(
    r"`|'[^']*[:=]|column|^the (?:particles|bodies|joints|coordinates) are|"
    r"^(?:give each|declared|rename|leave|choose|check|delete|keep|move)"
)
#: The differential or a velocity of a name.
_RATE = re.compile(rf"d((?:[a-zA-Z]|{'|'.join(LETTERS_OF_NAMES)})(?:_\w+)?)|(\w+?)d{{0,2}}dot")
SUGGESTED = re.compile(r"did you mean '(\w+)'\?")
_MEANT_NAME = re.compile(r"did you mean `(.+)`\?")
_FORCES = ("spring", "damper", "force", "gravity")
#: The largest number of names in a hint that declares them.
MOST_DECLARED = 12


def section_lines() -> dict[str, str]:
    """Return {section: example line} in the order in which `dofkit explain` lists the sections."""
    lines: dict[str, str] = package_table(__package__, "hints.yaml")["sections"]
    return lines


def lines() -> dict[str, str]:
    """Return {section or key within a section: example line}."""
    return {**section_lines(), **package_table(__package__, "hints.yaml")["keys"]}


def without_echoes(faults: Iterable[Fault], value: Mapping[str, Any]) -> list[Fault]:
    """Return ``faults`` without those that another fault explains.

    A misspelt key explains a missing key; a refused name explains that the name is not declared.
    """
    faults = list(faults)
    meant = {
        (fault.where[:-1], match[1])
        for fault in faults
        if fault.message.startswith(UNKNOWN_KEY) and (match := SUGGESTED.fullmatch(fault.hint or ""))
    }
    kept = [
        fault
        for fault in faults
        if not (fault.where and "needs" in fault.message and (fault.where[:-1], fault.where[-1]) in meant)
    ]
    refused = tuple(
        _name_at(value, fault.where) for fault in kept if re.match("the name h|.* cannot be the name of", fault.message)
    )
    kept = [f for f in kept if not ((match := _MEANT_NAME.fullmatch(f.hint or "")) and match[1].endswith(refused))]
    return _undeclared_at_once(kept, value)


def _name_at(value: Any, where: Path) -> str:
    """Return the name at the path ``where`` in a document: a key, or a text; a key `name` stands for its value."""
    owner: Any = value
    for key in where:
        if isinstance(owner, Mapping):
            part = owner.get(key)
            owner = part if key == "name" or isinstance(part, (Mapping, list, tuple)) else key
        elif isinstance(owner, (list, tuple)) and isinstance(key, int):
            owner = owner[key]
    return str(owner)


def _undeclared_at_once(faults: list[Fault], value: Mapping[str, Any]) -> list[Fault]:
    """Return ``faults``; undeclared bodies of a scene without bodies become one fault, and particles too."""
    for section, what in (("bodies", "body"), ("particles", "particle")):
        missing = {f: match[1] for f in faults if (match := re.match(f"there is no {what} '(.+)'$", f.message))}
        if not missing or value.get(section) or any((fault.hint or "").startswith("did") for fault in missing):
            continue
        first, names = next(iter(missing)), list(dict.fromkeys(missing.values()))
        listed = ", ".join(names[:MOST_DECLARED]) + (", ..." if len(names) > MOST_DECLARED else "")
        message = first.message if len(names) == 1 else f"the {section} {listed} are not declared"
        joint_fault = replace(first, message=message, hint=f"declare `{section}: [{listed}]`")
        faults = [joint_fault if f is first else f for f in faults if f is first or f not in missing]
    return faults


def type_advice(word: object, entry: Mapping[str, Any]) -> str | None:
    """Return the hint for a constraint ``entry`` whose type ``word`` is unknown (None: missing), or None."""
    if isinstance(word, str) and word in _FORCES:
        return f"write it under `forces`: `forces: [{{type: {word}, between: [A, B]}}]`; a force is not a constraint"
    near = nearest("type", map(str, entry.keys() - {"type"})) if word is None else None
    if near is not None:
        return f"write `type` in place of `{near}`"
    if word is None and _is_named_text(entry):
        return "; ".join(f'write `{{name: {name}, text: "{text}"}}`' for name, text in entry.items())
    kinds = likely_types(word, entry)
    if len(kinds) == 1:
        return f"did you mean '{kinds[0]}'?"
    return f"the types with these keys are {', '.join(kinds)}" if kinds else None


def likely_types(word: object, entry: Mapping[str, Any]) -> list[str]:
    """Return the type that ``word`` means, or else all types that have the keys of ``entry``, perhaps misspelt.

    Without a word, a key may be the name of a type: `{equation: x = y}`.
    """
    if word is None:
        types_as_keys = (key for key in entry if key not in _ALL_FIELDS and meant_type(key, {}))
        word = next((entry[key] for key in entry if nearest("type", [str(key)])), next(types_as_keys, None))
        word = Equation.kind() if _is_named_text(entry) else word
    meant, keys = meant_type(word, entry), [str(key) for key in entry if str(key).lower() not in ("type", "name")]
    if meant or not keys:
        return [meant] if meant else []
    fields = {kind: cls.model_fields.keys() for kind, cls in TYPES.items()}
    having = [kind for kind, cls in TYPES.items() if _required(cls) <= {*keys} <= fields[kind]]
    return having or [kind for kind in TYPES if all(meant_key(key, tuple(fields[kind])) for key in keys)]


def _is_named_text(entry: Mapping[str, Any]) -> bool:
    """Return whether an entry is a relation with its name as the key, such as ``wall: x >= 0``."""
    unknown = len(entry) == 1 and not any(key in TYPES or meant_key(key, tuple(_ALL_FIELDS)) for key in entry)
    return unknown and all(isinstance(text, str) and re.search("[=<>≤≥]", text) for text in entry.values())


#: The keys of constraints of any type.
_ALL_FIELDS = frozenset(key for cls in TYPES.values() for key in cls.model_fields)


def _required(cls: type[ConstraintBase]) -> set[str]:
    return {key for key, about in cls.model_fields.items() if about.is_required()} - {"type"}


def meant_type(word: object, entry: Mapping[str, Any]) -> str | None:
    """Return the constraint type that ``word`` most likely means, by the keys of ``entry``; None if there is none."""
    words = {kind: (kind, *cls.words().synonyms, *cls.words().understood) for kind, cls in TYPES.items()}
    terms, keys = {name for names in words.values() for name in names}, entry.keys() - {"name", "type"}
    fitting = {name for kind in words if keys & TYPES[kind].model_fields.keys() for name in words[kind]}
    text = word.lower() if isinstance(word, str) else ""
    near = next((part for part in re.split(r"\W+", text) if part in terms), None) or nearest(text, fitting or terms)
    fields = {kind: TYPES[kind].model_fields for kind, names in words.items() if near in names}
    return max(fields, key=lambda kind: sum(key in fields[kind] for key in entry), default=None)


def with_hint(fault: Fault, value: Mapping[str, Any]) -> Fault:
    """Return ``fault`` with its field in the message, a hint and a reference; ``value`` is the scene's document."""
    message = re.sub(r"^Input should be (.*)", r"\1 is needed", fault.message)
    keys = [key for key in fault.where if isinstance(key, str)]
    if len(fault.where) > 2 and keys[-1] not in ("text", "name", "type") and keys[-1] not in message:
        message = f"`{keys[-1]}`: {message}"
    return replace(fault, message=message, hint=_hint(fault, value), see=_see(fault, value))


def _see(fault: Fault, value: Mapping[str, Any]) -> str | None:
    """Return the constraint type or the section of a scene that a fault is about, None if there is none."""
    where = fault.where
    suggested = SUGGESTED.match(fault.hint or "")
    if where[:1] == ("constraints",) and len(where) > 1:
        kind = _type_at(value, where[1]) or (suggested[1] if suggested else None)
        entry = _entry_at(value, where[1])
        if isinstance(entry, Mapping) and entry.get("type") in _FORCES:
            return "forces"
        if kind is None or kind not in TYPES:
            kinds = likely_types(None, entry) if isinstance(entry, Mapping) else []
            kind = kinds[0] if len(kinds) == 1 else None
        kind = Equation.kind() if isinstance(entry, str) else kind
        return kind if kind in TYPES else None
    section = suggested[1] if suggested and len(where) == 1 else next(iter(where), None)
    return section if section in section_lines() else None


def _hint(fault: Fault, value: Mapping[str, Any]) -> str:
    """Return the hint of a fault: its own or one of hints.yaml, with a declaration or an example line if useful."""
    hints = package_table(__package__, "hints.yaml")["hints"].items()
    hint = _said_twice(fault, value) or _direction(fault, value) or _owner(fault, value) or fault.hint
    hint = hint or next((hint for pattern, hint in hints if re.search(pattern, fault.message)), None)
    undeclared = re.match(r"`(\w+)` is not declared(, and numbers)?", fault.message)
    name = undeclared[1] if undeclared else ""
    if undeclared and undeclared[2]:
        return f"for a unit, {hint}; for a quantity, declare `parameters: [{name}]`"
    called = re.match(r"there is no function `(\w+)`", fault.message)
    if called and hint and hint.startswith("the functions are"):
        return f"declare it: `functions: {{{called[1]}: [s]}}`; {hint}"
    rate = _RATE.fullmatch(name)
    if rate and hint:
        other = f"; {hint}" if re.search(r"`(?:d\w+|\w+dot)`", hint) else ""
        return f"declare the coordinate: `coordinates: [{rate[1] or rate[2]}]`{other}"
    if undeclared and hint and re.match("the declared|no names", hint):
        return f"declare it: `coordinates: [{name}]`, or `parameters: [{name}]` for a constant; {hint}"
    if hint is not None and _ENOUGH.search(hint):
        return hint
    line = _line(fault, hint or "", value)
    if line is None:
        return hint or "'dofkit schema' lists what can stand here"
    example = f"for example `{line}`"
    return example if hint is None else f"{hint}{'' if hint.endswith('?') else ';'} {example}"


def _said_twice(fault: Fault, value: Mapping[str, Any]) -> str | None:
    """Return the hint for a constraint's key that is a synonym of a key which is given too, or None."""
    key = fault.where[-1] if fault.where and fault.message.startswith(UNKNOWN_KEY) else ""
    kind = _type_at(value, fault.where[1]) if fault.where[:1] == ("constraints",) and len(fault.where) == 3 else None
    meant = other_keys(kind).get(str(key)) if kind is not None else None
    return None if meant is None else f"`{key}` is a synonym of `{meant}`, which is given too: leave one of them out"


def _direction(fault: Fault, value: Mapping[str, Any]) -> str | None:
    """Return the hint for an ``axis`` that is not a direction, or None."""
    if fault.where[-1:] != ("axis",) or "a list is needed" not in fault.message:
        return None
    letters = ("x", "x or y", "x, y or z")[dimension_of(value) - 1]
    return f"a direction is {letters}, or its components"


def _owner(fault: Fault, value: Mapping[str, Any]) -> str | None:
    """Return what to write where the configuration has the name of a body or a particle in place of coordinates."""
    name = fault.where[1] if fault.where[:1] == ("configuration",) and len(fault.where) == 2 else None
    for section, what in (("bodies", "body"), ("particles", "particle")):
        for entry in listed if isinstance(listed := value.get(section), (list, tuple)) else ():
            declared = entry if isinstance(entry, Mapping) else {"name": entry}
            if name is not None and declared.get("name") == name:
                renamed = declared.get("coordinates")
                first = renamed[0] if isinstance(renamed, (list, tuple)) and renamed else f"x_{name}"
                return f"'{name}' is a {what}: give its coordinates by their names, as `configuration: {{{first}: 0}}`"
    return None


def _line(fault: Fault, hint: str, value: Mapping[str, Any]) -> str | None:
    """Return an example line for the constraint or the key of a fault, or None."""
    where, d = fault.where, dimension_of(value)
    suggested = SUGGESTED.fullmatch(hint)
    if "a point of a body" in fault.message:
        return f"{{on: crank, at: [{', '.join('0' * d)}]}}"
    if where[:1] == ("constraints",) and len(where) > 1:
        if suggested and suggested[1] not in TYPES:
            return None  # the key that was meant says enough
        kind = suggested[1] if suggested else _type_at(value, where[1])
        return TYPES[kind].example(d)[0] if kind is not None and d in TYPES[kind].dimensions else None
    unknown = len(where) == 1 and fault.message.startswith(UNKNOWN_KEY) and not suggested
    if unknown or (hint and where[:1] == ("picture",)):
        return None
    keys = [suggested[1]] if suggested else [k for k in reversed(where) if k in where[:1] or k not in section_lines()]
    return next((lines()[str(key)] for key in keys if key in lines()), None)


def _entry_at(value: Mapping[str, Any], index: object) -> Any:
    entries = value.get("constraints")
    if not isinstance(entries, (list, tuple)) or not isinstance(index, int):
        return None
    return entries[index] if index < len(entries) else None


def _type_at(value: Mapping[str, Any], index: object) -> str | None:
    """Return the type of the constraint at ``index`` in a document, None if it is not a constraint type."""
    entry = _entry_at(value, index)
    kind = entry.get("type") if isinstance(entry, Mapping) else None
    return kind if isinstance(kind, str) and kind in TYPES else None
