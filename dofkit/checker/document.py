"""The document of a scene: YAML 1.2 or JSON, safe and bounded, its numbers exact.

The canonical form leaves out what says nothing of the mathematics, so that one scene has one hash however it is
written. In it whole numbers are numbers, others texts such as ``1/2``, which a scene reads as the same value.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from fractions import Fraction
from hashlib import sha256
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import CollectionEndEvent, CollectionStartEvent, MappingEndEvent, ScalarEvent

from dofkit.checker.grammar import DECIMAL
from dofkit.checker.trees import CheckError, refuse

MOST_CHARACTERS, LONGEST_VALUE, DEEPEST = 2_000_000, 400, 40
_NULLS = ("", "~", "null", "Null", "NULL")
_VALUE = re.compile(rf"\s*([-+]?{DECIMAL})(?:\s*/\s*(\d*[1-9]\d*))?\s*", re.ASCII)
#: Keys that say nothing of the mathematics, and entries that are as good as left out.
_SILENT, _NOTHING = ("name", "title", "source", "notes", "expect"), (None, {}, [])
_DEFAULTS = {"dimension": 3, "tolerance": 0}
#: What a text alone stands for in these lists.
_SHORT = {"particles": ("name", {}), "bodies": ("name", {}), "constraints": ("text", {"type": "equation"})}


def document_of(text: str) -> Any:
    """The document that a text writes in YAML 1.2 or JSON; in YAML numbers stay texts."""
    refuse(len(text) > MOST_CHARACTERS, f"a document of more than {MOST_CHARACTERS} characters is not read")
    try:
        try:
            return json.loads(text, parse_float=str, object_pairs_hook=_mapping)
        except json.JSONDecodeError:
            return _from_yaml(text)
    except (YAMLError, RecursionError, ValueError) as error:
        raise CheckError(f"the document cannot be read: {str(error)[:200]}") from None


def _mapping(pairs: list[tuple[Any, Any]]) -> dict[str, Any]:
    found = dict(pairs) if all(isinstance(key, str) for key, _ in pairs) else {}
    refuse(len(found) < len(pairs), "a key is no text, or stands twice in one mapping")
    return found


def _from_yaml(text: str) -> Any:
    """A document from the events of a YAML text: no tags, no aliases, and nothing but texts and nulls."""
    stack: list[list[Any]] = [[]]
    for event in YAML(typ="safe", pure=True).parse(text):
        odd = getattr(event, "tag", None) not in (None, "!") or getattr(event, "anchor", None)
        refuse(odd or len(stack) > DEEPEST, "tags, aliases and depths are not read")
        if isinstance(event, ScalarEvent):
            stack[-1].append(None if event.value in _NULLS and not event.style else event.value)
        elif isinstance(event, CollectionStartEvent):
            stack.append([])
        elif isinstance(event, CollectionEndEvent):
            found = stack.pop()
            pairs = list(zip(found[::2], found[1::2], strict=False))
            stack[-1].append(_mapping(pairs) if isinstance(event, MappingEndEvent) else found)
    refuse(len(stack[0]) != 1, "one document is needed")
    return stack[0][0]


def canonical(document: object) -> dict[str, Any]:
    """The document without its name, titles, notes and empty entries, short forms written out and values exact."""
    found = _canonical(document, "", 0)
    refuse(not isinstance(found, dict), "a scene is a mapping")
    return {key: part for key, part in found.items() if key not in _SILENT and part != _DEFAULTS.get(key)}


def _canonical(value: Any, key: str, depth: int) -> Any:
    """A part of a document that stands under ``key``."""
    refuse(depth > DEEPEST, "a document is nested too deep")
    if key == "parameters" and isinstance(value, list):
        value = _mapping([(name, None) for name in value])
    if isinstance(value, Mapping):
        missing = "real" if key == "parameters" else None
        parts = [(name, missing if part is None else part) for name, part in value.items()]
        found = _mapping([(name, _canonical(part, name, depth + 1)) for name, part in parts])
        return {name: part for name, part in found.items() if part not in _NOTHING}
    if isinstance(value, (list, tuple)):
        short, rest = _SHORT.get(key, ("", {}))
        longer = [{**rest, short: one} if short and isinstance(one, str) else one for one in value]
        return [_canonical(one, "" if short else key, depth + 1) for one in longer]
    if value is None or isinstance(value, bool) or (key == "name" and isinstance(value, str)):
        return value
    match = _VALUE.fullmatch(str(value)) if len(str(value)) <= LONGEST_VALUE else None
    refuse(match is None and not isinstance(value, str), f"{str(value)[:40]} cannot stand in a document")
    exact = Fraction(match[1]) / int(match[2] or 1) if match else Fraction(0)
    return value if match is None else int(exact) if exact == int(exact) else str(exact)


def sha256_of(document: object) -> str:
    """The hash of the canonical JSON of a document."""
    text = json.dumps(canonical(document), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
