"""A fast reader of YAML's block style as most people write it: indented keys and dashes, one value a line.

Like `FlowReader`, which reads the values in brackets and quotes, it takes a subset and raises `UnusualError` on
anything else (anchors, tags, texts over several lines, tabs, errors); the full YAML parser then decides.
"""

from __future__ import annotations

import re
from typing import Any

from dofkit.base.documents.fast_flow import DEEPEST, FlowReader, Path, Places, UnusualError, twice

_KEY = re.compile(r"(?:([A-Za-z0-9_][\w./-]*)|\"([^\"\\\n]*)\"|'([^'\n]*)') *(:)(?=[ \r\n]|\Z)")
_BLANK = re.compile(r"(?: *(?:#[^\n]*)?\r?\n)*( *)(?:#[^\n]*\Z)?")
_LINE_END = re.compile(r" *(?: #[^\n]*)?\r?(?:\n|\Z)")
_SPACES = re.compile(r" *")
_PLAIN_START = re.compile(r"[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-[^\s\-]")
_HEADER = re.compile(r"([|>])(-?) *\r?\n")
_RAW_LINE = re.compile(r"( *)([^\r\n]*)\r?(?:\n|\Z)")
_UNUSUAL = re.compile(r"[\x85\u2028\u2029]|\r(?!\n)|^(?:---|\.\.\.|%)", re.MULTILINE)


class BlockReader:
    """Reads the one value of ``text``; ``places``, where given, receives the place of everything in it."""

    def __init__(self, text: str, places: Places | None = None) -> None:
        self.text = text
        self.flow = FlowReader(text, len(text), places)
        self.faults = self.flow.faults
        self.at = 0
        self.column = 0

    def read(self) -> Any:
        """The value of the whole text."""
        if _UNUSUAL.search(self.text):
            raise UnusualError
        self._advance(0)
        value = self._node((), -1, 0)
        if self.column >= 0:
            raise UnusualError
        return value

    def _advance(self, line: int) -> None:
        """Go to the first line with something on it, from the beginning of ``line`` on; column -1 at the end."""
        match = _BLANK.match(self.text, line)
        if match is None or match.end() >= len(self.text):
            self.at, self.column = len(self.text), -1
        else:
            self.at, self.column = match.end(), len(match[1])

    def _end(self, position: int) -> None:
        match = _LINE_END.match(self.text, position)
        if match is None:
            raise UnusualError
        self._advance(match.end())

    def _note(self, path: Path, at: int, key: int) -> None:
        if self.flow.places is not None:
            self.flow.places[path] = (at, key)

    def _dash(self, at: int) -> bool:
        return self.text.startswith("-", at) and self.text[at + 1 : at + 2] in (" ", "\n", "\r", "")

    def _node(self, path: Path, key: int, depth: int) -> Any:
        """The mapping or list that begins where the reader stands."""
        if depth >= DEEPEST:
            raise UnusualError
        self._note(path, self.at, key)
        return self._sequence(path, depth) if self._dash(self.at) else self._mapping(path, depth)

    def _mapping(self, path: Path, depth: int) -> dict[str, Any]:
        column, found = self.column, dict[str, Any]()
        while self.column == column:
            match = _KEY.match(self.text, self.at)
            if match is None:
                raise UnusualError
            key, key_at = match[1] or next(part for part in match.groups() if part is not None), self.at
            if key in found:
                self.faults.append((key_at, twice(key)))
                places, self.flow.places = self.flow.places, None
                self._value((), key_at, match.end(), column, depth)
                self.flow.places = places
            else:
                found[key] = self._value((*path, key), key_at, match.end(), column, depth)
        if self.column > column:
            raise UnusualError
        return found

    def _sequence(self, path: Path, depth: int) -> list[Any]:
        column, found = self.column, list[Any]()
        while self.column == column and self._dash(self.at):
            below = (*path, len(found))
            start = self._past_spaces(self.at + 1)
            if self._dash(start) or _KEY.match(self.text, start):
                self.at, self.column = start, column + start - self.at
                found.append(self._node(below, -1, depth + 1))
            else:
                found.append(self._value(below, -1, self.at + 1, column, depth, dashes=False))
        if self.column > column:
            raise UnusualError
        return found

    def _value(self, path: Path, key: int, after: int, parent: int, depth: int, *, dashes: bool = True) -> Any:
        """What follows a key or a dash, which ends at ``after``: on its line, or indented below it.

        ``dashes``: below a key, a list need not be indented.
        """
        start = self._past_spaces(after)
        first = self.text[start : start + 1]
        if first in ("", "\n", "\r") or (first == "#" and start > after):
            self._end(after)
            if self.column > parent or (dashes and self.column == parent and self._dash(self.at)):
                return self._node(path, key, depth + 1)
            self._note(path, after, key)
            return None
        if first in "{[\"'":
            value = self.flow.prefix(start, path, key, depth + 1)
            self._end(self.flow.position)
            return value
        self._note(path, start, key)
        return self._long_text(start, parent) if first in "|>" else self._plain(start)

    def _past_spaces(self, at: int) -> int:
        match = _SPACES.match(self.text, at)
        return match.end() if match else at

    def _plain(self, start: int) -> Any:
        stop = self.text.find("\n", start)
        stop = len(self.text) if stop < 0 else stop
        text = self.text[start:stop].rstrip("\r").partition(" #")[0].rstrip(" ")
        if not _PLAIN_START.match(text) or ": " in text or text.endswith(":") or "\t" in text:
            raise UnusualError
        self._advance(stop + 1 if stop < len(self.text) else stop)
        return self.flow.resolved(start, text)

    def _long_text(self, start: int, parent: int) -> str:
        """The text of lines indented below ``|`` or ``>``, all alike and none of them blank."""
        header = _HEADER.match(self.text, start)
        if header is None:
            raise UnusualError
        at, lines, margin = header.end(), list[str](), -1
        while at < len(self.text):
            line = _RAW_LINE.match(self.text, at)
            if line is None or not line[2] or len(line[1]) <= max(parent, 0):
                break
            margin = len(line[1]) if margin < 0 else margin
            if len(line[1]) != margin or line[2].startswith("\t"):
                raise UnusualError
            lines.append(line[2])
            at = line.end()
        self._advance(at)
        if not lines or self.column > max(parent, 0):
            raise UnusualError
        return (" " if header[1] == ">" else "\n").join(lines) + (
            "" if header[2] or self.text[at - 1] != "\n" else "\n"
        )
