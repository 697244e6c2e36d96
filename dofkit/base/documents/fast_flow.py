"""A fast reader of what most long inputs are made of: JSON, and YAML in brackets on one line.

It takes a subset of JSON and YAML's flow style on which both agree and raises `UnusualError` on anything
else (comments, anchors, tags, unusual quoting, errors); the caller then turns to the full YAML parser.
"""

from __future__ import annotations

import json
import re
from typing import Any, TypeAlias

from dofkit.base.documents.scalars import BadScalarError, joined, plain
from dofkit.base.errors import Fault

#: Deeper nesting is refused.
DEEPEST = 50
#: The longest key that YAML takes without a mark of its own.
_LONGEST_KEY = 1000

Path: TypeAlias = tuple[str | int, ...]
#: Where a value begins, and its key (-1: it has none): offsets into the text.
Places: TypeAlias = dict[Path, tuple[int, int]]

_TOKEN = re.compile(
    r"""[ \t\r\n]*(?:
        ([{}\[\],:])
      | "((?:[^"\\\n\r\u0085\u2028\u2029]|\\["\\/bfnrt]|\\u[0-9a-fA-F]{4})*)"
      | '((?:[^'\n\r\u0085\u2028\u2029]|'')*)'
      | ((?:[A-Za-z0-9_]|[-+.][A-Za-z0-9.])[^,\[\]{}:\#\n\r\t\u0085\u2028\u2029]*)
    )""",
    re.VERBOSE | re.ASCII,
)
#: Most keys, with their colon.
_EASY_KEY = re.compile(r"[ \t\r\n]*([A-Za-z_][A-Za-z0-9_]{0,63}):(?=[ \t\r\n])", re.ASCII)
_MARK, _DOUBLE, _SINGLE, _PLAIN = 1, 2, 3, 4
_DOTS = re.compile(r"\.{3}|-\.{2}")


class UnusualError(Exception):
    """Not in the subset: the full parser decides."""


class FlowReader:
    """Reads one value from ``text``; ``places``, where given, receives the place of every value below ``path``."""

    def __init__(self, text: str, stop: int, places: Places | None = None) -> None:
        self.text = text
        self.stop = stop
        self.places = places
        self.faults: list[tuple[int, Fault]] = []
        self.position = 0

    def read(self, start: int, path: Path = ()) -> Any:
        """The value that begins at ``start`` and fills the text up to ``stop``, blanks apart."""
        self.position = start
        value = self._value(self._next(), path, -1, 0)
        if self.text[self.position : self.stop].strip(" \t\r\n"):
            raise UnusualError
        return value

    def prefix(self, start: int, path: Path, key: int, depth: int) -> Any:
        """Read the value that begins at ``start``; ``position`` tells where it ends."""
        self.position = start
        return self._value(self._next(), path, key, depth)

    def resolved(self, start: int, text: str) -> Any:
        """The value of an unquoted scalar that begins at ``start``."""
        try:
            return plain(text)
        except BadScalarError as error:
            self.faults.append((start, Fault(error.message, hint=error.hint)))
            return 1

    def _next(self) -> re.Match[str]:
        match = _TOKEN.match(self.text, self.position, self.stop)
        if match is None:
            raise UnusualError
        self.position = match.end()
        return match

    def _value(self, token: re.Match[str], path: Path, key: int, depth: int) -> Any:
        if self.places is not None:
            self.places[path] = (_start(token), key)
        if token.lastindex != _MARK:
            return self._scalar(token)
        mark = token[_MARK]
        if mark not in "{[" or depth >= DEEPEST:
            raise UnusualError
        return self._mapping(path, depth + 1) if mark == "{" else self._sequence(path, depth + 1)

    def _scalar(self, token: re.Match[str]) -> Any:
        if token.lastindex != _PLAIN:
            return self._quoted(token)
        text = token[_PLAIN].rstrip(" ")
        if _DOTS.match(text):
            raise UnusualError
        return self.resolved(_start(token), text)

    def _quoted(self, token: re.Match[str]) -> str:
        if token.lastindex == _SINGLE:
            return token[_SINGLE].replace("''", "'")
        text = token[_DOUBLE]
        if "\\" not in text:
            return text
        found = joined(json.loads(f'"{text}"', strict=False))
        if found is None:
            raise UnusualError
        return found

    def _mapping(self, path: Path, depth: int) -> dict[str, Any]:
        found: dict[str, Any] = {}
        while True:
            easy = _EASY_KEY.match(self.text, self.position, self.stop)
            if easy is not None:
                key, offset, self.position = easy[1], easy.start(1), easy.end()
            else:
                token = self._next()
                if token[_MARK] == "}" and not found:
                    return found
                key, offset = self._key(token), _start(token)
            if key in found:
                self.faults.append((offset, twice(key)))
                places, self.places = self.places, None
                self._value(self._next(), path, offset, depth)
                self.places = places
            else:
                below = (*path, key) if self.places is not None else path
                found[key] = self._value(self._next(), below, offset, depth)
            if self._ends("}"):
                return found

    def _key(self, token: re.Match[str]) -> str:
        if token.lastindex == _MARK or token.end() - _start(token) > _LONGEST_KEY:
            raise UnusualError
        if token.lastindex == _PLAIN:
            key = token[_PLAIN].rstrip(" ")
            ended = self.text[self.position : self.position + 2] in (": ", ":\t", ":\r", ":\n")
        else:
            key, ended = self._quoted(token), True
        if not ended or key == "<<" or _DOTS.match(key) or self._next()[_MARK] != ":":
            raise UnusualError
        return key

    def _ends(self, close: str) -> bool:
        mark = self.text[self.position] if self.position < self.stop else ""
        if mark in (",", close):
            self.position += 1
            return mark == close
        mark = self._next()[_MARK]
        if mark not in (",", close):
            raise UnusualError
        return mark == close

    def _sequence(self, path: Path, depth: int) -> list[Any]:
        found: list[Any] = []
        token = self._next()
        if token[_MARK] == "]":
            return found
        while True:
            below = (*path, len(found)) if self.places is not None else path
            found.append(self._value(token, below, -1, depth))
            if self._ends("]"):
                return found
            token = self._next()


def _start(token: re.Match[str]) -> int:
    """Where a token begins, its quote included."""
    index = token.lastindex or 0
    return token.start(index) - (index in (_DOUBLE, _SINGLE))


def twice(key: str) -> Fault:
    """A key that is written again in the same mapping."""
    return Fault(f"the key '{key[:60]}' is written twice", hint="keep one of the two")
