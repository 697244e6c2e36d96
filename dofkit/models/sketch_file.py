"""A SolveSpace file as records of keys and values, each with its line; nothing of its geometry is known here."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelFile

#: A file of more records is refused.
MOST_RECORDS = 400_000
_KINDS = ("Group", "Request", "Entity", "Constraint")
#: The handles of what groups made have this bit.
DERIVED = 0x80000000
#: A line of the table of what a group made: its number, of which entity, and which copy.
_COPY = re.compile(r"\s+(\d{1,9}) ([0-9a-fA-F]{1,8}) (\d{1,9})\s*")


@dataclass(frozen=True)
class Record:
    """What stands before an ``Add...``: its values by key, without the kind, and the line where it begins.

    ``copies``: of a group, the number of what it made, the handle of what that was made of, and which copy it is.
    """

    kind: str
    values: Mapping[str, str]
    line: int
    copies: tuple[tuple[int, int, int], ...] = ()

    def handle(self, key: str = "h.v") -> int:
        """A handle, in hexadecimal; 0 for none. Raises SceneError for what is none."""
        return int(self._read(key, lambda text: int(text, 16), "a handle such as 00040001"))

    def whole(self, key: str) -> int:
        """A whole number; 0 where there is none. Raises SceneError for what is none."""
        return int(self._read(key, int, "a whole number"))

    def number(self, key: str) -> float:
        """A number; 0 where there is none. Raises SceneError for what is none."""
        found = self._read(key, float, "a number")
        if not math.isfinite(found):
            raise SceneError((self.fault(f"{self.kind}.{key} is not finite", "write a number"),))
        return found

    def place(self, key: str) -> tuple[float, float, float]:
        """Three numbers: x, y and z."""
        return self.number(f"{key}.x"), self.number(f"{key}.y"), self.number(f"{key}.z")

    def turn(self, key: str) -> tuple[float, ...]:
        """Four numbers, a quaternion: w, x, y and z."""
        return tuple(self.number(f"{key}.{part}") for part in ("w", "vx", "vy", "vz"))

    def fault(self, message: str, hint: str) -> Fault:
        """A fault in the line of this record."""
        return Fault(message, line=self.line, column=1, hint=hint)

    def _read(self, key: str, read: Callable[[str], float], what: str) -> float:
        text = self.values.get(key, "0") or "0"
        try:
            return read(text)
        except ValueError:
            message = f"{self.kind}.{key} is '{text[:40]}', which is not {what}"
            raise SceneError((self.fault(message, "save the file with SolveSpace again"),)) from None


@dataclass
class SketchFile:
    """The records of a file by their kinds, and by their handles."""

    groups: dict[int, Record] = field(default_factory=dict)
    requests: dict[int, Record] = field(default_factory=dict)
    entities: dict[int, Record] = field(default_factory=dict)
    constraints: dict[int, Record] = field(default_factory=dict)

    def group_of(self, handle: int) -> int:
        """The group in which an entity was drawn, or which made it; 0 where that is not known."""
        if handle & DERIVED:
            return (handle & ~DERIVED) >> 16
        request = self.requests.get(handle >> 16)
        return 0 if request is None else request.handle("group.v")


def read_sketch(file: ModelFile) -> SketchFile:
    """The records of a file. Raises SceneError for what is no such file."""
    found = SketchFile()
    kept = {"Group": found.groups, "Request": found.requests, "Entity": found.entities, "Constraint": found.constraints}
    for count, record in enumerate(_records(file.text)):
        if count >= MOST_RECORDS:
            raise SceneError((record.fault(f"more than {MOST_RECORDS} records", "split the sketch"),), file.name)
        kept[record.kind][record.handle()] = record
    if not found.entities:
        hint = "save it with SolveSpace: a sketch has entities"
        raise SceneError((Fault("this file has no entity", line=1, column=1, hint=hint),), file.name)
    return found


def _records(text: str) -> Iterator[Record]:
    values: dict[str, str] = {}
    copies: list[tuple[int, int, int]] = []
    first = 1
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("Add"):
            kind = line[3:].strip()
            if kind in _KINDS:
                yield Record(kind, values, first, tuple(copies))
            values, copies = {}, []
            continue
        key, equals, value = line.partition("=")
        kind, dot, rest = key.partition(".")
        if equals and dot and kind in _KINDS:
            first = first if values else number
            values[rest] = value.strip()
        elif found := _COPY.fullmatch(line):
            copies.append((int(found[1]), int(found[2], 16), int(found[3])))
