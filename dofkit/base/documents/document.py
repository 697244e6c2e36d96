"""A YAML or JSON document: its value, and the line and column of everything in it."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from dofkit.base.documents.composer import DEEPEST, SURROGATE, Path, Places, compose
from dofkit.base.documents.scalars import plain
from dofkit.base.errors import Fault

#: A longer input is refused.
MOST_BYTES = 64_000_000
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_BREAK = re.compile(r"\r\n|\r|\n")
_JSON_START = re.compile(r"[ \t\r\n]*[{\[]")


@dataclass(frozen=True)
class Document:
    """What was read: its ``value``, its ``text`` and the ``faults`` of its form, which leave a value all the same."""

    name: str
    text: str
    value: Any
    faults: tuple[Fault, ...]
    locate: Callable[[Places], object] = field(repr=False)

    @cached_property
    def places(self) -> Places:
        """The place of everything in the document; found out when it is first asked for."""
        found: Places = {}
        self.locate(found)
        return found

    @cached_property
    def _lines(self) -> list[int]:
        return _line_starts(self.text)

    def line(self, number: int) -> str:
        """The text of a line, counted from 1."""
        starts = self._lines
        if not 1 <= number <= len(starts):
            return ""
        stop = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : stop].rstrip("\r\n")

    def place(self, path: Path, *, key: bool = False, column: int | None = None) -> tuple[int, int]:
        """Line and column of the value at ``path``, of its key, or of a column within its text.

        What is not there is placed where it is missing from.
        """
        known = next((path[:n] for n in range(len(path), -1, -1) if path[:n] in self.places), ())
        start, key_at = self.places.get(known, (0, -1))
        if key and known == path and key_at >= 0:
            return self._position(key_at)
        if column is not None:
            start += _within(self.text[start : start + 4 * column + 400], column)
        return self._position(start)

    def _position(self, offset: int) -> tuple[int, int]:
        return _position(self._lines, offset)


def read_document(data: bytes | str, name: str) -> Document:
    """Read one document; never raises for what is in it: a value of None and ``faults`` tell."""
    text, fault = _decoded(data)
    if fault is None and len(text) > MOST_BYTES:
        fault = 0, Fault(f"the file is longer than {MOST_BYTES // 10**6} MB", hint="split the scene")
    if fault is None:
        found = _FORBIDDEN.search(text)
        if found:
            message = f"the character U+{ord(found[0]):04X} is not allowed in a text file"
            fault = found.start(), Fault(message, hint="delete it, and check that this is a text file")
    if fault is None and not text.strip():
        fault = 0, Fault("the file is empty", hint="write a mapping, such as 'coordinates: [x, y]'")
    if fault is not None:
        return _document(name, text, None, [fault])
    if _JSON_START.match(text) and not SURROGATE.search(text):
        try:
            return _document(name, text, _from_json(text), [], lambda places: places.update(compose(text).places))
        except _NotPlainError:
            pass
    composer = compose(text)
    return _document(name, text, composer.value, composer.faults, lambda places: places.update(composer.places))


def _decoded(data: bytes | str) -> tuple[str, tuple[int, Fault] | None]:
    if isinstance(data, str):
        return data.removeprefix("\ufeff"), None
    try:
        return data.decode("utf-8-sig"), None
    except UnicodeDecodeError as error:
        before = error.object[: error.start].decode("utf-8", "replace")
        other = " (it looks like UTF-16)" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ""
        text = before + error.object[error.start : error.start + 10_000].decode("utf-8", "replace")
        return text, (len(before), Fault(f"the file is not in UTF-8{other}", hint="save it as UTF-8"))


def _document(
    name: str,
    text: str,
    value: Any,
    faults: list[tuple[int, Fault]],
    locate: Callable[[Places], object] = lambda places: None,
) -> Document:
    told: list[Fault] = []
    if faults:
        starts = _line_starts(text)
        for offset, fault in sorted(faults, key=lambda pair: pair[0]):
            line, column = _position(starts, offset)
            told.append(replace(fault, line=line, column=column))
    return Document(name, text, value, tuple(told), locate)


def _from_json(text: str) -> Any:
    """Return the value of a JSON text. Raises `_NotPlainError` where the YAML parser has to find what is wrong."""
    try:
        value = json.loads(
            text, object_pairs_hook=_mapping, parse_int=plain, parse_float=plain, parse_constant=_not_a_number
        )
    except (ValueError, RecursionError) as error:
        raise _NotPlainError from error
    if _depth(value) > DEEPEST:
        raise _NotPlainError
    return value


class _NotPlainError(ValueError):
    """The text is not plain JSON."""


def _mapping(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) < len(pairs) or "<<" in value:
        raise _NotPlainError
    return value


def _not_a_number(word: str) -> None:
    raise _NotPlainError


def _depth(value: Any) -> int:
    """Return how deep the brackets of a JSON value are nested."""
    depth, level = 0, [value]
    while level := [v for v in level if isinstance(v, dict | list)]:
        depth += 1
        level = [below for v in level for below in (v.values() if isinstance(v, dict) else v)]
    return depth


def _line_starts(text: str) -> list[int]:
    return [0, *(match.end() for match in _BREAK.finditer(text))]


def _position(starts: list[int], offset: int) -> tuple[int, int]:
    line = bisect_right(starts, offset)
    return line, offset - starts[line - 1] + 1


_PIECE = re.compile(r"\\u[0-9a-fA-F]{4}|\\x[0-9a-fA-F]{2}|\\U[0-9a-fA-F]{8}|\\.|[^\\\n]")


def _within(source: str, column: int) -> int:
    """How far a column of a text lies from where the text begins in the file; 0 where it runs over several lines."""
    if source[:1] in ("|", ">"):
        return 0
    if source[:1] not in ('"', "'"):
        return column - 1 if "\n" not in source[:column] else 0
    at, left = 1, column - 1
    while left > 0:
        if source[:1] == "'":
            width = 2 if source.startswith("''", at) else 1
        else:
            match = _PIECE.match(source, at)
            width = len(match[0]) if match else 1
        if source[at : at + 1] in ("\n", ""):
            return 0
        at, left = at + width, left - 1
    return at
