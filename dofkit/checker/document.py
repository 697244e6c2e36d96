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
from ruamel.yaml.events import AliasEvent, CollectionEndEvent, CollectionStartEvent, MappingStartEvent, ScalarEvent

from dofkit.checker.errors import CheckError
from dofkit.checker.tokens import decimal_value

MOST_CHARACTERS, MOST_ENTRIES, DEEPEST = 2_000_000, 200_000, 40
_WORDS = {"": None, "~": None, **dict.fromkeys(("null", "Null", "NULL"))} | {
    form(word): word == "true" for word in ("true", "false") for form in (str.lower, str.upper, str.title)
}
_VALUE = re.compile(r"\s*([-+]?)((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,6})?)(?:\s*/\s*(\d{1,400}))?\s*", re.ASCII)
_NO_NUMBER = re.compile(r"[-+]?\.(?:inf|nan)|0[xo][0-9a-f]+", re.ASCII | re.IGNORECASE)
#: Keys that say nothing of the mathematics, texts that are no values, and entries that are as good as left out.
_SILENT = ("name", "title", "source", "notes", "expect")
_TEXTS = ("name", "text", "surface", "curve", "drive")
_NOTHING: tuple[Any, ...] = (None, {}, [])


def document_of(text: str) -> Mapping[str, Any]:
    """The document that a text writes in YAML 1.2 or JSON."""
    if len(text) > MOST_CHARACTERS:
        raise CheckError(f"a document of more than {MOST_CHARACTERS} characters is not read")
    try:
        try:
            found = json.loads(text, parse_float=Decimal, object_pairs_hook=_mapping)
        except json.JSONDecodeError:
            found = _from_yaml(text)
    except CheckError:
        raise
    except (YAMLError, RecursionError, ValueError) as error:
        raise CheckError(f"the document cannot be read: {str(error)[:200]}") from None
    return exact_document(found)


def _mapping(pairs: list[tuple[Any, Any]]) -> dict[str, Any]:
    found = dict(pairs) if all(isinstance(key, str) for key, _ in pairs) else {}
    if len(found) < len(pairs):
        raise CheckError("a key is no text, or stands twice in one mapping")
    return found


def _from_yaml(text: str) -> Any:
    """A document from the events of a YAML text: no tags, no aliases, plain scalars by the core schema."""
    stack: list[tuple[bool, list[Any]]] = [(False, [])]
    for count, event in enumerate(YAML(typ="safe", pure=True).parse(text)):
        if count > MOST_ENTRIES or len(stack) > DEEPEST:
            raise CheckError("a document is too large or nested too deep")
        tagged = getattr(event, "tag", None) not in (None, "!") or getattr(event, "anchor", None)
        if tagged or isinstance(event, AliasEvent):
            raise CheckError("tags and aliases are not read")
        if isinstance(event, ScalarEvent):
            stack[-1][1].append(event.value if event.style else _plain(event.value))
        elif isinstance(event, CollectionStartEvent):
            stack.append((isinstance(event, MappingStartEvent), []))
        elif isinstance(event, CollectionEndEvent):
            mapped, entries = stack.pop()
            stack[-1][1].append(_mapping(list(zip(entries[::2], entries[1::2], strict=True))) if mapped else entries)
    if len(stack[0][1]) != 1:
        raise CheckError("one document is needed")
    return stack[0][1][0]


def _plain(text: str) -> Any:
    """A scalar without quotes, by the core schema of YAML 1.2."""
    if text in _WORDS:
        return _WORDS[text]
    if _NO_NUMBER.fullmatch(text):
        raise CheckError(f"a decimal number is needed, not {text[:20]}")
    found = None if "/" in text else _number(text)
    return text if found is None else found


def _number(value: object) -> Fraction | int | None:
    """The number that a text writes as a decimal or a quotient."""
    match = _VALUE.fullmatch(value) if isinstance(value, str) and len(value) <= 400 else None
    if match is None or (match[3] and not int(match[3])):
        return None
    return decimal_value(match[2]) / int(match[3] or 1) * (-1 if match[1] == "-" else 1)


def value_text(value: object) -> Any:
    """A text that writes a number as that number: ``0.50`` is ``1/2``; others are left as they are."""
    found = _number(value)
    return value if found is None else int(found) if found == int(found) else str(found)


def exact_document(document: object) -> Mapping[str, Any]:
    """A document with all its numbers exact, as plain mappings, lists, texts and whole numbers; a copy."""
    left = [MOST_ENTRIES]

    def exact(value: object, depth: int) -> Any:
        left[0] -= 1
        if left[0] < 0 or depth > DEEPEST:
            raise CheckError("a document is too large or nested too deep")
        if isinstance(value, Mapping):
            return _mapping([(key, exact(part, depth + 1)) for key, part in value.items()])
        if isinstance(value, (list, tuple)):
            return [exact(part, depth + 1) for part in value]
        if value is None or isinstance(value, (str, bool)):
            return value
        found = value if isinstance(value, (int, Fraction)) else _number(str(value))
        if found is None or found.numerator.bit_length() > 4000:
            raise CheckError(f"{str(value)[:40]} cannot stand in a document")
        return int(found) if found == int(found) else str(found)

    found = exact(document, 0)
    if not isinstance(found, dict):
        raise CheckError("a scene is a mapping")
    return found


def canonical(document: Mapping[str, Any]) -> dict[str, Any]:
    """The document without its name, titles, notes and empty entries, short forms written out and values exact."""
    found = {key: _canonical(value, key) for key, value in exact_document(document).items() if key not in _SILENT}
    silent = {"dimension": 3, "tolerance": 0}
    return {key: value for key, value in found.items() if value not in _NOTHING and value != silent.get(key)}


def _canonical(value: Any, key: str) -> Any:
    if key == "parameters" and isinstance(value, (str, list)):
        value = dict.fromkeys([value] if isinstance(value, str) else value, "real")
    if isinstance(value, dict) and key in ("parameters", "functions"):
        listed = {name: [given] if isinstance(given, str) else given for name, given in value.items()}
        return listed if key == "functions" else {k: "real" if v is None else value_text(v) for k, v in value.items()}
    if isinstance(value, dict):
        if "members" in value and isinstance(value.get("curve"), str):
            value = {**value, "curve": [value["curve"]]}
        parts = {name: _canonical(part, name) for name, part in value.items()}
        return {name: part for name, part in parts.items() if part not in _NOTHING}
    if isinstance(value, list):
        field = {"particles": "name", "bodies": "name", "constraints": "text"}.get(key)
        rest = {"type": "equation"} if field == "text" else {}
        filled = [{**rest, field: one} if field and isinstance(one, str) else one for one in value]
        return [_canonical(one, "" if field else key) for one in filled]
    return value if key in _TEXTS else value_text(value)


def sha256_of(document: Mapping[str, Any]) -> str:
    """The hash of the canonical JSON of a document."""
    text = json.dumps(canonical(document), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
