"""A faulty constraint put right: the type and the keys that were meant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from dofkit.base.wording import nearest
from dofkit.scene.constraints import TYPES
from dofkit.scene.fields import meant_key


def likely_types(word: object, entry: Mapping[str, Any]) -> list[str]:
    """Return the type that a word means, or else the types with the keys of an entry, misspelt ones only if need be."""
    if word is None:
        word = next((part for key, part in entry.items() if str(key).lower() == "type"), None)
    meant = meant_type(word, entry)
    able = [] if meant else [kind for kind in TYPES if with_right_keys(kind, entry)]
    exact = [kind for kind in able if set(entry) - {"type"} <= TYPES[kind].model_fields.keys()]
    return [meant] if meant else exact or able


def meant_type(word: object, entry: Mapping[str, Any]) -> str | None:
    """Return the constraint type that a word most likely means, by the keys that stand beside it; None for no idea."""
    words = {kind: (kind, *cls.synonyms, *cls.understood) for kind, cls in TYPES.items()}
    near = nearest(word.lower(), {one for known in words.values() for one in known}) if isinstance(word, str) else None
    fields = {kind: TYPES[kind].model_fields for kind, known in words.items() if near in known}
    return max(fields, key=lambda kind: sum(key in fields[kind] for key in entry), default=None)


def with_right_keys(kind: str, entry: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return an entry as a constraint of a type, its keys and their form put right; None where that cannot be done."""
    fields, given = TYPES[kind].model_fields, TYPES[kind].restated(entry)
    right: dict[str, Any] = {"type": kind}
    for key, part in given.items():
        if str(key).lower() == "type":
            continue
        meant = key if key in fields else meant_key(key, tuple(field for field in fields if field not in given))
        if meant is None or meant in right:
            return None
        right[meant] = part
    renamed = {key: part if key in entry else _in_form(key, part) for key, part in right.items()}
    for attempt in (renamed, {key: _in_form(key, part) for key, part in right.items()}):
        try:
            TYPES[kind].model_validate(attempt)
        except ValidationError:
            continue
        return attempt
    return None


def _in_form(key: str, part: Any) -> Any:
    """Return what is given for a key as a list or as one name, as that key takes it."""
    if key in ("between", "members", "along"):
        return [part] if isinstance(part, str) else part
    return part[0] if key in ("point", "body") and isinstance(part, (list, tuple)) and len(part) == 1 else part
