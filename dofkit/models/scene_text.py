"""A scene's mapping as the text of a file that a person can go on from: YAML, an entry a line."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from typing import Any

#: A text that YAML 1.2 reads as itself without quotes, in brackets too.
_PLAIN = re.compile(r"[A-Za-z_][\w./-]*(?: [\w./-]+)*", re.ASCII)
_WORDS = frozenset({"null", "true", "false", "nan", "inf"})
#: Keys whose entries are lists, an entry a line.
_LISTED = ("particles", "bodies", "constraints", "forces", "left_out")


def scene_text(value: Mapping[str, Any], remarks: tuple[str, ...] = ()) -> str:
    """The YAML of a scene, with remarks as comments before it.

    >>> print(scene_text({"name": "arm", "bodies": [{"name": "a", "mass": 1}]}), end="")
    name: arm
    bodies:
    - {name: a, mass: 1}
    """
    return "".join(f"{line}\n" for line in (*(f"# {' '.join(told.split())}" for told in remarks), *_lines(value)))


def _lines(value: Mapping[str, Any]) -> Iterator[str]:
    for key, part in value.items():
        if key in _LISTED:
            yield f"{key}:"
            yield from (f"- {on_one_line(entry)}" for entry in part)
        elif key == "configuration":
            yield f"{key}:"
            yield from (f"  {on_one_line(name)}: {on_one_line(number)}" for name, number in part.items())
        else:
            yield f"{key}: {on_one_line(part)}"


def on_one_line(value: Any) -> str:
    """Return a value as YAML on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{on_one_line(key)}: {on_one_line(part)}" for key, part in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(on_one_line, value)) + "]"
    if isinstance(value, str):
        plain = _PLAIN.fullmatch(value) and value.lower() not in _WORDS
        return value if plain else json.dumps(value, ensure_ascii=False)
    return str(value) if isinstance(value, Decimal) else json.dumps(value)
