"""The document of a scene: YAML 1.2 or JSON, safe and bounded, its numbers exact.

Whole numbers stay numbers; others become texts such as ``1/2``, which a scene reads as the same value. The canonical
form leaves out what says nothing of the mathematics, so that one scene has one hash however it is written.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from hashlib import sha256
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import AliasEvent, CollectionEndEvent, CollectionStartEvent, MappingEndEvent, ScalarEvent

from dofkit.checker.grammar import DECIMAL
from dofkit.checker.trees import CheckError, refuse

MOST_CHARACTERS, MOST_BITS, DEEPEST = 2_000_000, 4000, 40
_WORDS = {"": None, "~": None, **dict.fromkeys(("null", "Null", "NULL"))} | {
    form(word): word == "true" for word in ("true", "false") for form in (str.lower, str.upper, str.title)
}
_VALUE = re.compile(rf"\s*([-+]?{DECIMAL})(?:\s*/\s*(\d{{1,400}}))?\s*", re.ASCII)
#: Keys that say nothing of the mathematics, texts that are no values, and entries that are as good as left out.
_SILENT = ("name", "title", "source", "notes", "expect")
_TEXTS = ("name", "text", "surface", "curve", "drive")
_NOTHING: tuple[Any, ...] = (None, {}, [])
#: What a text alone stands for in these lists.
_SHORT = {"particles": "name", "bodies": "name", "constraints": "text"}


def document_of(text: str) -> Mapping[str, Any]:
    """The document that a text writes in YAML 1.2 or JSON."""
    refuse(len(text) > MOST_CHARACTERS, f"a document of more than {MOST_CHARACTERS} characters is not read")
    try:
        try:
            found = json.loads(text, parse_float=Decimal, object_pairs_hook=_mapping)
        except json.JSONDecodeError:
            found = _from_yaml(text)
        return exact_document(found)
    except (YAMLError, RecursionError, ValueError) as error:
        raise CheckError(f"the document cannot be read: {str(error)[:200]}") from None


def _mapping(pairs: list[tuple[Any, Any]]) -> dict[str, Any]:
    found = dict(pairs) if all(isinstance(key, str) for key, _ in pairs) else {}
    refuse(len(found) < len(pairs), "a key is no text, or stands twice in one mapping")
    return found


def _from_yaml(text: str) -> Any:
    """A document from the events of a YAML text: no tags, no aliases, plain scalars by the core schema."""
    stack: list[list[Any]] = [[]]
    for event in YAML(typ="safe", pure=True).parse(text):
        tagged = getattr(event, "tag", None) not in (None, "!") or getattr(event, "anchor", None)
        refuse(tagged or isinstance(event, AliasEvent) or len(stack) > DEEPEST, "tags, aliases and depths are not read")
        if isinstance(event, ScalarEvent):
            stack[-1].append(event.value if event.style else _plain(event.value))
        elif isinstance(event, CollectionStartEvent):
            stack.append([])
        elif isinstance(event, CollectionEndEvent):
            entries = stack.pop()
            pairs = zip(entries[::2], entries[1::2], strict=False)
            stack[-1].append(_mapping(list(pairs)) if isinstance(event, MappingEndEvent) else entries)
    refuse(len(stack[0]) != 1, "one document is needed")
    return stack[0][0]


def _plain(text: str) -> Any:
    """A scalar without quotes, by the core schema of YAML 1.2; what is no decimal number is a text."""
    found = _WORDS.get(text, text)
    return value_text(found) if isinstance(found, str) and "/" not in found else found


def value_text(value: object) -> Any:
    """A text that writes a number as that number: ``0.50`` is ``1/2``; others are left as they are."""
    match = _VALUE.fullmatch(value) if isinstance(value, str) and len(value) <= 400 else None
    if match is None or not int(match[2] or 1):
        return value
    return _shown(Fraction(match[1]) / int(match[2] or 1))


def _shown(value: Fraction | int) -> int | str:
    refuse(max(map(int.bit_length, value.as_integer_ratio())) > MOST_BITS, "a number is too large")
    return int(value) if value == int(value) else str(value)


def exact_document(document: object) -> dict[str, Any]:
    """A document with all its numbers exact, as plain mappings, lists, texts and whole numbers; a copy."""
    found = _exact(document, 0)
    if not isinstance(found, dict):
        raise CheckError("a scene is a mapping")
    return found


def _exact(value: object, depth: int) -> Any:
    refuse(depth > DEEPEST, "a document is nested too deep")
    if isinstance(value, Mapping):
        return _mapping([(key, _exact(part, depth + 1)) for key, part in value.items()])
    if isinstance(value, (list, tuple)):
        return [_exact(part, depth + 1) for part in value]
    if value is None or isinstance(value, (str, bool)):
        return value
    found = value_text(str(value))
    refuse(isinstance(found, str) and "/" not in found, f"{str(value)[:40]} cannot stand in a document")
    return found


def canonical(document: Mapping[str, Any]) -> dict[str, Any]:
    """The document without its name, titles, notes and empty entries, short forms written out and values exact."""
    found = {key: _canonical(value, key) for key, value in exact_document(document).items() if key not in _SILENT}
    silent = {"dimension": 3, "tolerance": 0}
    return {key: value for key, value in found.items() if value not in _NOTHING and value != silent.get(key)}


def _canonical(value: Any, key: str) -> Any:
    if key == "parameters" and isinstance(value, (str, list)):
        names = [value] if isinstance(value, str) else value
        refuse(not all(isinstance(name, str) for name in names), "a parameter's name is a text")
        value = dict.fromkeys(names)
    if isinstance(value, dict) and key == "parameters":
        return {name: "real" if given is None else value_text(given) for name, given in value.items()}
    if isinstance(value, dict):
        listed = key == "functions" or ("curve" if "members" in value else None)
        filled = {k: [v] if isinstance(v, str) and listed in (True, k) else v for k, v in value.items()}
        parts = {name: _canonical(part, name) for name, part in filled.items()}
        return {name: part for name, part in parts.items() if part not in _NOTHING}
    if isinstance(value, list):
        short = _SHORT.get(key)
        rest = {"type": "equation"} if short == "text" else {}
        longer = [{**rest, short: one} if short and isinstance(one, str) else one for one in value]
        return [_canonical(one, "" if short else key) for one in longer]
    return value if key in _TEXTS else value_text(value)


def sha256_of(document: Mapping[str, Any]) -> str:
    """The hash of the canonical JSON of a document."""
    text = json.dumps(canonical(document), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
