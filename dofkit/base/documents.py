"""YAML and JSON documents: plain exact values with the line and column of everything in them, and values as YAML.

A decimal never becomes a float. Locations are computed when one is first needed.
"""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal
from functools import cache, cached_property
from importlib.resources import files
from typing import Any

from dofkit.base.errors import Fault
from dofkit.base.yaml_events import DEEPEST, Path, Places, compose

__all__ = ["DEEPEST", "MOST_BYTES", "Document", "Path", "on_one_line", "package_table", "read_document", "yaml_text"]

#: The most characters of an input; a longer one is refused.
MOST_BYTES = 64_000_000
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_BREAK = re.compile(r"\r\n|\r|\n")
#: One character of a double-quoted text, perhaps escaped.
_CHARACTER = re.compile(r"\\u[0-9a-fA-F]{4}|\\x[0-9a-fA-F]{2}|\\U[0-9a-fA-F]{8}|\\.|[^\\\n]")
#: A text that YAML 1.2 reads as itself without quotes, also inside brackets, unless it is one of `_RESERVED`.
_PLAIN = re.compile(r"[A-Za-z_][\w./-]*(?: [\w./-]+)*", re.ASCII)
_RESERVED = frozenset({"null", "true", "false", "nan", "inf"})


@dataclass(frozen=True)
class Document:
    """A document that was read: its ``value``, its ``text`` and the ``faults`` of its syntax."""

    name: str
    text: str
    value: Any
    faults: tuple[Fault, ...]
    locate: Callable[[], Places] = field(repr=False, default=dict)

    @cached_property
    def places(self) -> Places:
        """The locations of all values in the document: {path: (offset of the value, offset of its key or -1)}."""
        return self.locate()

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(match.end() for match in _BREAK.finditer(self.text))]

    def line(self, number: int) -> str:
        """Return the text of line ``number``, counted from 1; empty for a line that does not exist."""
        starts = [*self._line_starts, len(self.text)]
        return self.text[starts[number - 1] : starts[number]].rstrip("\r\n") if 1 <= number < len(starts) else ""

    def place(self, path: Path, *, key: bool = False, column: int | None = None) -> tuple[int, int]:
        """Return (line, column) of the value at ``path``, of its ``key``, or of a ``column`` within its text.

        An absent value has the location of the innermost value on its path that is present.
        """
        present = next((path[:n] for n in range(len(path), -1, -1) if path[:n] in self.places), ())
        start, key_at = self.places.get(present, (0, -1))
        if key and present == path and key_at >= 0:
            return self.position(key_at)
        if column is not None:
            start += _offset_of_column(self.text[start : start + 4 * column + 400], column)
        return self.position(start)

    def position(self, offset: int) -> tuple[int, int]:
        """Return (line, column), counted from 1, of an offset into the text."""
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1


def read_document(data: bytes | str, name: str) -> Document:
    """Return the document in ``data``. Unreadable content does not raise: the value is None, with ``faults``."""
    text, fault = _decoded(data)
    if fault is None and len(text) > MOST_BYTES:
        fault = 0, Fault(f"the file is longer than {MOST_BYTES // 10**6} MB", hint="split the scene")
    if fault is None and (forbidden := _FORBIDDEN.search(text)):
        message = f"the character U+{ord(forbidden[0]):04X} is not allowed in a text file"
        fault = forbidden.start(), Fault(message, hint="delete it, and check that this is a text file")
    if fault is None and not text.strip():
        fault = 0, Fault("the file is empty", hint="write a mapping, such as 'coordinates: [x, y]'")
    if fault is not None:
        return _document(name, text, None, [fault], dict)
    composed = compose(text)
    return _document(name, text, composed.value, composed.faults, lambda: composed.places)


@cache
def package_table(package: str, file: str) -> Any:
    """Return the value of a YAML file in a package; it is kept, and must not be changed."""
    return read_document(files(package).joinpath(file).read_bytes(), file).value


def _document(
    name: str, text: str, value: Any, faults: list[tuple[int, Fault]], locate: Callable[[], Places]
) -> Document:
    """Return the document with its faults, given as (offset, fault), sorted and with line and column."""
    document = Document(name, text, value, (), locate)
    placed = []
    for offset, fault in sorted(faults, key=lambda pair: pair[0]):
        line, column = document.position(offset)
        placed.append(replace(fault, line=line, column=column))
    return replace(document, faults=tuple(placed)) if placed else document


def _decoded(data: bytes | str) -> tuple[str, tuple[int, Fault] | None]:
    """Return (text, None), or for bytes that are not UTF-8 (beginning of the text, (offset, fault))."""
    if isinstance(data, str):
        return data.removeprefix("\ufeff"), None
    try:
        return data.decode("utf-8-sig"), None
    except UnicodeDecodeError as error:
        before = error.object[: error.start].decode("utf-8", "replace")
        other = " (it looks like UTF-16)" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ""
        text = before + error.object[error.start : error.start + 10_000].decode("utf-8", "replace")
        return text, (len(before), Fault(f"the file is not in UTF-8{other}", hint="save it as UTF-8"))


def _offset_of_column(source: str, column: int) -> int:
    """Return the offset of a value's ``column`` in the ``source`` of the value: 1 for column 1 of ``"x"``.

    It is 0 (not known) for a block scalar and for a value of several lines.
    """
    if source[:1] in ("|", ">"):
        return 0
    if source[:1] not in ('"', "'"):
        return column - 1 if "\n" not in source[: column - 1] else 0
    at = 1
    for _ in range(column - 1):
        if source[:1] == "'":
            width = 2 if source.startswith("''", at) else 1
        else:
            match = _CHARACTER.match(source, at)
            width = len(match[0]) if match else 1
        if source[at : at + 1] in ("\n", ""):
            return 0
        at += width
    return at


def yaml_text(value: Mapping[str, Any], sections: tuple[str, ...] = (), remarks: tuple[str, ...] = ()) -> str:
    """Return a mapping as YAML for a person to edit, with remarks as comments before it.

    ``sections``: keys of lists and mappings that are written with an entry on each line.

    >>> print(yaml_text({"name": "arm", "bodies": [{"name": "a", "mass": 1}]}, ("bodies",)), end="")
    name: arm
    bodies:
    - {name: a, mass: 1}
    """
    lines = [f"# {' '.join(remark.split())}" for remark in remarks]
    return "".join(f"{line}\n" for line in (*lines, *_yaml_lines(value, sections)))


def _yaml_lines(value: Mapping[str, Any], sections: tuple[str, ...]) -> Iterator[str]:
    """Yield YAML with each key on a line; those of ``sections`` as blocks with an entry on each line."""
    for key, part in value.items():
        if key not in sections:
            yield f"{key}: {on_one_line(part)}"
            continue
        yield f"{key}:"
        if isinstance(part, Mapping):
            yield from (f"  {on_one_line(name)}: {on_one_line(entry)}" for name, entry in part.items())
        else:
            yield from (f"- {on_one_line(entry)}" for entry in part)


def on_one_line(value: Any) -> str:
    """Return a value as YAML on one line; a text is quoted only if YAML would read it as something else."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{on_one_line(key)}: {on_one_line(part)}" for key, part in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(on_one_line, value)) + "]"
    if isinstance(value, str):
        is_plain = _PLAIN.fullmatch(value) and value.lower() not in _RESERVED
        return value if is_plain else json.dumps(value, ensure_ascii=False)
    return str(value) if isinstance(value, Decimal) else json.dumps(value)
