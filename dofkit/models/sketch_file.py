"""A SolveSpace file as records of keys and values, each with its line, and the names that SolveSpace shows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelFile

#: A file of more records is refused.
MOST_RECORDS = 400_000
_KINDS = ("Group", "Request", "Entity", "Constraint")
#: The handles of what groups made have this bit.
DERIVED = 0x80000000
#: Types of entities.
POINT_2D, POINTS, LINE, CIRCLE, ARC = 2001, range(2000, 3000), 11000, 13000, 14000
CUBICS, RECTANGLES = (12000, 12001), (15000, 16000)
#: The least and the largest number of points of a cubic.
_CUBIC_POINTS = 4, 12
#: Types of groups that are drawn, in space and in a workplane, and the handle of the group of the axes.
DRAWN_GROUPS, REFERENCES = (5000, 5001), 1
#: Names of the points of an entity.
_ROLES = {LINE: ("start", "end"), CIRCLE: ("centre",), ARC: ("centre", "start", "end")}


@dataclass(frozen=True)
class Record:
    """What stands before an ``Add...``: its values by key, without the kind, and the line where it begins."""

    kind: str
    values: Mapping[str, str]
    line: int

    def handle(self, key: str = "h.v") -> int:
        """Return a handle, written in hexadecimal; 0 for none. Raises SceneError for any other text."""
        return int(self._read(key, lambda text: int(text, 16), "a handle such as 00040001"))

    def whole(self, key: str) -> int:
        """Return a whole number; 0 where there is none. Raises SceneError for any other text."""
        return int(self._read(key, int, "a whole number"))

    def number(self, key: str) -> float:
        """Return a number; 0 where there is none. Raises SceneError for any other text."""
        value = self._read(key, float, "a number")
        if not math.isfinite(value):
            raise SceneError((self.fault(f"{self.kind}.{key} is not finite", "write a number"),))
        return value

    def numbers(self, key: str, components: str) -> list[float]:
        """Return the components of a vector or a quaternion, named by a list such as ``x y z``."""
        return [self.number(f"{key}.{component}") for component in components.split()]

    def corners(self) -> int:
        """Return how many points define the entity; 0 where it is not read."""
        kind, (least, most) = self.whole("type"), _CUBIC_POINTS
        if kind == CUBICS[0]:
            return min(max(least, least + self.whole("extraPoints")), most)
        return 4 if kind in RECTANGLES else len(_ROLES.get(kind, ()))

    def fault(self, message: str, hint: str) -> Fault:
        """Return a fault in the line of this record."""
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
        """Return the group in which an entity was drawn, or which made it; 0 where that is not known."""
        if not is_drawn(handle):
            return (handle & ~DERIVED) >> 16
        request = self.requests.get(handle >> 16)
        return 0 if request is None else request.handle("group.v")

    def point_name(self, handle: int) -> str:
        """Return SolveSpace's name of an entity with the role of one of its points, such as ``r004_start``."""
        entity = self.entities.get(handle & ~0xFFFF)
        roles = () if entity is None else _ROLES.get(entity.whole("type"), ())
        points = [entity.handle(f"point[{k}].v") for k in range(len(roles))] if entity is not None else []
        return drawn_name(handle) + (f"_{roles[points.index(handle)]}" if handle in points else "")


def drawn_name(handle: int) -> str:
    """Return SolveSpace's name of what was drawn by one request, such as ``r004``."""
    return f"r{handle >> 16:03x}"


def is_drawn(handle: int) -> bool:
    """Return whether an entity was drawn, and not made by a group."""
    return not handle & DERIVED


def read_sketch(file: ModelFile) -> SketchFile:
    """Return the records of a file. Raises SceneError for what is no such file."""
    sketch = SketchFile()
    by_kind = {kind: getattr(sketch, name) for kind, name in zip(_KINDS, vars(sketch), strict=True)}
    for count, record in enumerate(_records(file.text)):
        if count >= MOST_RECORDS:
            raise SceneError((record.fault(f"more than {MOST_RECORDS} records", "split the sketch"),), file.name)
        by_kind[record.kind][record.handle()] = record
    if not sketch.entities:
        hint = "save it with SolveSpace: a sketch has entities"
        raise SceneError((Fault("this file has no entity", line=1, column=1, hint=hint),), file.name)
    return sketch


def _records(text: str) -> Iterator[Record]:
    values: dict[str, str] = {}
    first = 1
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("Add"):
            if line[3:].strip() in _KINDS:
                yield Record(line[3:].strip(), values, first)
            values = {}
            continue
        key, equals, value = line.partition("=")
        kind, dot, name = key.partition(".")
        if equals and dot and kind in _KINDS:
            first = first if values else number
            values[name] = value.strip()
