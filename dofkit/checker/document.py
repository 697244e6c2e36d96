"""The document of a scene: YAML 1.2 or JSON, safe and bounded, its numbers exact.

Whole numbers stay numbers; others become texts such as ``1/2``, which a scene reads as the same value. The canonical
form leaves out what says nothing of the mathematics, so that one scene has one hash however it is written.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction
from hashlib import sha256
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from dofkit.checker.errors import CheckError

MOST_CHARACTERS = 4_000_000
MOST_ENTRIES = 400_000
DEEPEST = 40
LARGEST_POWER = 1000

_WORDS = {"": None, "~": None, **dict.fromkeys(("null", "Null", "NULL"))} | {
    word: truth for truth in (True, False) for word in (str(truth), str(truth).lower(), str(truth).upper())
}
_DECIMAL = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,6})?", re.ASCII)
_VALUE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,6})?)(?:\s*/\s*(\d+))?\s*", re.ASCII)
_BASED = re.compile(r"0o([0-7]+)|0x([0-9a-fA-F]+)", re.ASCII)
_NOT_FINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_SILENT = ("name", "title", "source", "notes", "expect")
_TEXTS = ("name", "text", "surface", "curve", "drive")


def document_of(text: str) -> Mapping[str, Any]:
    """The document that a text writes in YAML 1.2 or JSON."""
    if len(text) > MOST_CHARACTERS:
        raise CheckError(f"a document of more than {MOST_CHARACTERS} characters is not read")
    try:
        found = _from_json(text) if text.lstrip()[:1] == "{" else _from_yaml(text)
    except (YAMLError, RecursionError, json.JSONDecodeError) as error:
        raise CheckError(f"the document cannot be read: {str(error)[:200]}") from None
    return exact_document(found)


def _from_json(text: str) -> object:
    try:
        return json.loads(text, parse_float=exact_number, parse_constant=_refused, object_pairs_hook=_pairs)
    except json.JSONDecodeError:
        return _from_yaml(text)


def _refused(text: str) -> object:
    raise CheckError(f"a finite number is needed, not {text}")


def _pairs(pairs: list[tuple[str, object]]) -> dict[str, object]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise CheckError("a key stands twice in one mapping")
    return found


def _from_yaml(text: str) -> object:
    """A document from the events of a YAML text: no tags, no aliases, plain scalars by the core schema."""
    events: Iterator[Event] = iter(YAML(typ="safe", pure=True).parse(text))
    stack: list[list[object]] = [[]]
    kinds: list[str] = []
    for count, event in enumerate(events):
        if count > MOST_ENTRIES or len(stack) > DEEPEST:
            raise CheckError("a document is too large or nested too deep")
        if isinstance(event, AliasEvent) or getattr(event, "anchor", None) or _tagged(event):
            raise CheckError("tags and aliases are not read")
        if isinstance(event, ScalarEvent):
            stack[-1].append(event.value if event.style else _plain(event.value))
        elif isinstance(event, (MappingStartEvent, SequenceStartEvent)):
            stack.append([])
            kinds.append("map" if isinstance(event, MappingStartEvent) else "list")
        elif isinstance(event, (MappingEndEvent, SequenceEndEvent)):
            entries = stack.pop()
            stack[-1].append(entries if kinds.pop() == "list" else _mapping(entries))
    if len(stack[0]) != 1:
        raise CheckError("one document is needed")
    return stack[0][0]


def _tagged(event: Event) -> bool:
    return getattr(event, "tag", None) not in (None, "!")


def _mapping(entries: list[object]) -> dict[str, object]:
    keys = entries[::2]
    return _pairs(
        [
            (key if isinstance(key, str) else _refused_key(key), value)
            for key, value in zip(keys, entries[1::2], strict=True)
        ]
    )


def _refused_key(key: object) -> str:
    raise CheckError(f"a key is a text, not {str(key)[:40]}")


def _plain(text: str) -> object:
    """A scalar without quotes, by the core schema of YAML 1.2."""
    if text in _WORDS:
        return _WORDS[text]
    if _DECIMAL.fullmatch(text):
        return exact_number(text)
    if _NOT_FINITE.fullmatch(text):
        raise CheckError(f"a finite number is needed, not {text}")
    based = _BASED.fullmatch(text) if len(text) < 100 else None
    return text if based is None else int(based[1], 8) if based[1] else int(based[2], 16)


def exact_number(text: str) -> Fraction:
    """The exact value of a decimal in bounded time."""
    mantissa, _, exponent = text.lower().partition("e")
    if len(text) > 400 or abs(int(exponent or "0")) > LARGEST_POWER:
        raise CheckError("a number is too large or too small")
    del mantissa
    return Fraction(Decimal(text))


def exact_document(document: object) -> Mapping[str, Any]:
    """A document with all its numbers exact, as plain mappings, lists, texts and whole numbers; a copy."""
    left = [MOST_ENTRIES]
    found = _exact(document, 0, left)
    if not isinstance(found, dict):
        raise CheckError("a scene is a mapping")
    return found


def _exact(value: object, depth: int, left: list[int]) -> object:
    left[0] -= 1
    if left[0] < 0 or depth > DEEPEST:
        raise CheckError("a document is too large or nested too deep")
    if isinstance(value, Mapping):
        return {_key(key): _exact(part, depth + 1, left) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_exact(part, depth + 1, left) for part in value]
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, float):
        value = exact_number(repr(value)) if abs(value) < 1e308 else _refused(str(value))
    if isinstance(value, Decimal):
        value = exact_number(str(value))
    if not isinstance(value, (int, Fraction)) or value.numerator.bit_length() > 4000:
        raise CheckError(f"{str(value)[:40]} cannot stand in a document")
    return int(value) if value == int(value) else str(value)


def _key(key: object) -> str:
    return key if isinstance(key, str) else _refused_key(key)


def value_text(value: object) -> object:
    """A text that writes a number as that number: ``0.5`` is ``1/2``; others are left as they are."""
    match = _VALUE.fullmatch(value) if isinstance(value, str) and len(value) <= 400 else None
    if match is None or (match[2] and not int(match[2])):
        return value
    found = exact_number(match[1]) / int(match[2] or 1)
    return int(found) if found.denominator == 1 else str(found)


def canonical(document: Mapping[str, Any]) -> dict[str, Any]:
    """The document without its name, titles, notes and empty entries, short forms written out and values exact."""
    found: dict[str, Any] = {
        key: _canonical(value, key) for key, value in exact_document(document).items() if key not in _SILENT
    }
    found = {key: value for key, value in found.items() if value not in (None, [], {}) and value != _DEFAULTS.get(key)}
    if isinstance(found.get("parameters"), (list, str)):
        names = found["parameters"]
        found["parameters"] = dict.fromkeys([names] if isinstance(names, str) else names, "real")
    for key in ("particles", "bodies"):
        if key in found:
            found[key] = [{"name": one} if isinstance(one, str) else one for one in found[key]]
    if "functions" in found:
        found["functions"] = {k: [v] if isinstance(v, str) else v for k, v in found["functions"].items()}
    if "parameters" in found:
        found["parameters"] = {k: "real" if v is None else v for k, v in found["parameters"].items()}
    if "constraints" in found:
        found["constraints"] = [_written_out(one) for one in found["constraints"]]
    return found


_DEFAULTS = {"dimension": 3, "tolerance": 0}


def _written_out(constraint: object) -> object:
    if isinstance(constraint, str):
        return {"type": "equation", "text": constraint}
    if isinstance(constraint, dict) and isinstance(constraint.get("curve"), str):
        return {**constraint, "curve": [constraint["curve"]]}
    return constraint


def _canonical(value: object, key: str) -> object:
    if isinstance(value, dict):
        parts = {k: _canonical(part, k) for k, part in value.items()}
        return (
            parts if key in ("parameters", "functions") else {k: p for k, p in parts.items() if p not in (None, {}, [])}
        )
    if isinstance(value, list):
        return [_canonical(part, key) for part in value]
    return value if key in _TEXTS else value_text(value)


def sha256_of(document: Mapping[str, Any]) -> str:
    """The hash of the canonical JSON of a document."""
    text = json.dumps(canonical(document), sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
