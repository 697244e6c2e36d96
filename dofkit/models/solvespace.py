"""SolveSpace's sketches as planar scenes: points are particles, radii of circles are coordinates.

The workplane with most drawn points is read; points in space and parts derived from sketches are noted as left out.
Names are those of SolveSpace: r004 for the entity drawn fourth, c001 for the first constraint. All groups are solved
together, whereas SolveSpace solves each group with the earlier ones fixed.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import many
from dofkit.expressions.text.characters import MAX_CHARACTERS
from dofkit.models.joint_relations import figures
from dofkit.models.model_document import COARSEST, FINEST, ModelDocument, ModelFile, SceneDraft, listed, number
from dofkit.models.sketch_constraints import KINDS, NOT_READ, Arrow, Round, SketchMentions, SketchPoint, Written

#: The most records of a file.
MOST_RECORDS = 400_000
_KINDS = ("Group", "Request", "Entity", "Constraint")
#: The bit in the handles of entities that a group derived from others.
DERIVED = 0x80000000
#: Types of entities.
POINT_2D, POINTS, LINE, CIRCLE, ARC = 2001, range(2000, 3000), 11000, 13000, 14000
CUBICS, RECTANGLES = (12000, 12001), (15000, 16000)
#: Types of groups with drawn entities (in space, in a workplane), and the handle of the group of the axes.
DRAWN_GROUPS, REFERENCES = (5000, 5001), 1
#: {type of entity: names of its points}.
_ROLES = {LINE: ("start", "end"), CIRCLE: ("centre",), ARC: ("centre", "start", "end")}
#: The residual to which SolveSpace satisfies its equations.
SOLVED = 1e-6
_COMMENT, _COINCIDENT = 1000, 20
#: Kinds with a number; a group may make all of them mere reference dimensions.
_DIMENSIONS = frozenset({*range(30, 35), 51, 56, 90, 120, *range(210, 214)})
_MENTIONS = ("ptA", "ptB", "entityA", "entityB", "entityC", "entityD")


@dataclass(frozen=True)
class Record:
    """The lines before an ``Add...``: {key without the kind: value}, and the line where they begin."""

    kind: str
    values: Mapping[str, str]
    line: int

    def handle(self, key: str = "h.v") -> int:
        """Return a handle, written in hexadecimal; 0 for none. Raises SceneError for any other text."""
        return int(self._read(key, lambda text: int(text, 16), "a handle such as 00040001"))

    def whole(self, key: str) -> int:
        """Return an integer; 0 if the key is missing. Raises SceneError for any other text."""
        return int(self._read(key, int, "a whole number"))

    def number(self, key: str) -> float:
        """Return a finite number; 0 if the key is missing. Raises SceneError for any other text."""
        value = self._read(key, float, "a number")
        if not math.isfinite(value):
            raise SceneError((self.fault(f"{self.kind}.{key} is not finite", "write a number"),))
        return value

    def numbers(self, key: str, components: str) -> list[float]:
        """Return the components of a vector or a quaternion, named by a list such as ``x y z``."""
        return [self.number(f"{key}.{component}") for component in components.split()]

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
    """The records of a file by kind, as {handle: record}."""

    groups: dict[int, Record] = field(default_factory=dict)
    requests: dict[int, Record] = field(default_factory=dict)
    entities: dict[int, Record] = field(default_factory=dict)
    constraints: dict[int, Record] = field(default_factory=dict)

    def group_of(self, handle: int) -> int:
        """Return the group in which an entity was drawn, or which derived it; 0 if that is not known."""
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
    """Return SolveSpace's name of an entity that was drawn, such as ``r004``."""
    return f"r{handle >> 16:03x}"


def is_drawn(handle: int) -> bool:
    """Return whether an entity was drawn, and not derived by a group."""
    return not handle & DERIVED


def read_sketch(file: ModelFile) -> SketchFile:
    """Return the records of a file. Raises SceneError if it has no entity, or too many records."""
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
    """Yield the records of a file, each of lines ``kind.name=value`` up to a line ``AddKind``."""
    values: dict[str, str] = {}
    first = 1
    for at, line in enumerate(text.splitlines(), 1):
        if line.startswith("Add"):
            if line[3:].strip() in _KINDS:
                yield Record(line[3:].strip(), values, first)
            values = {}
            continue
        key, equals, value = line.partition("=")
        kind, dot, name = key.partition(".")
        if equals and dot and kind in _KINDS:
            first = first if values else at
            values[name] = value.strip()


# The scene


def read(file: ModelFile) -> ModelDocument:
    """Return the scene of a sketch. Raises SceneError if the file has no point in a workplane."""
    sketch = read_sketch(file)
    drawn = [e for h, e in sketch.entities.items() if is_drawn(h) and e.whole("type") == POINT_2D]
    planes = Counter(plane for e in drawn if (plane := e.handle("workplane.v")) in sketch.entities)
    if not planes:
        hint = "draw points, lines or circles in a workplane; sketches in space are not read"
        raise SceneError((Fault("this file has no point that dofkit reads", line=1, column=1, hint=hint),), file.name)
    draft = SceneDraft(f"SolveSpace sketch {file.name}", dimension=2)
    return _SketchScene(sketch, draft, planes.most_common(1)[0][0]).document()


class UnreadError(Exception):
    """A constraint cannot be read; the message says why."""


@dataclass
class _SketchScene:
    """Writes the scene: points, lines and curves by the handles of their entities; ``outside``: skipped points."""

    file: SketchFile
    draft: SceneDraft
    plane: int
    points: dict[int, SketchPoint] = field(default_factory=dict)
    lines: dict[int, Arrow] = field(default_factory=dict)
    curves: dict[int, Round] = field(default_factory=dict)
    outside: int = 0

    def __post_init__(self) -> None:
        plane = self.file.entities[self.plane]
        normal, origin = (self.file.entities.get(plane.handle(key)) for key in ("normal.v", "point[0].v"))
        self.origin = np.zeros(3) if origin is None else np.array(origin.numbers("actPoint", "x y z"))
        self.axes = np.eye(3)[:2]
        if normal is not None:
            w, x, y, z = normal.numbers("actNormal", "w vx vy vz")
            u = (w * w + x * x - y * y - z * z, 2 * (w * z + x * y), 2 * (x * z - w * y))
            v = (2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (w * x + y * z))
            self.axes = np.array([u, v])

    def document(self) -> ModelDocument:
        """Return the scene, with its parts in the order of the file."""
        for handle, record in self.file.entities.items():
            if record.whole("type") in POINTS:
                self._point(handle, record)
        for handle, record in self.file.entities.items():
            count = len(_ROLES.get(record.whole("type"), ()))
            points = [self.points.get(record.handle(f"point[{k}].v")) for k in range(count)]
            ends = [point for point in points if point is not None]
            if ends and len(ends) == count:
                self._drawn(handle, record, ends)
        for record in self.file.constraints.values():
            if record.whole("type") != _COMMENT:
                self._constraint(record)
        self._leave_out()
        size = float(np.ptp(np.array([p.at for p in self.points.values()]), axis=0).max()) or 1.0
        return self.draft.document(min(COARSEST, max(FINEST, SOLVED / size)), special=True)

    def _point(self, handle: int, record: Record) -> None:
        """Add a drawn point of the plane as a particle, or a reference point as fixed; count other drawn points."""
        at = self.axes @ (np.array(record.numbers("actPoint", "x y z")) - self.origin)
        place = (float(number(at[0])), float(number(at[1])))
        drawn = is_drawn(handle)
        if drawn and record.whole("type") == POINT_2D and record.handle("workplane.v") == self.plane:
            name = self.draft.particle(self.file.point_name(handle), record.line, place)
            self.points[handle] = SketchPoint(f"x_{name}", f"y_{name}", place, name)
        elif self.file.entities[self.plane].handle("point[0].v") == handle or (
            drawn and self.file.group_of(handle) == REFERENCES
        ):
            self.points[handle] = SketchPoint(figures(place[0]), figures(place[1]), place)
        else:
            self.outside += drawn

    def _drawn(self, handle: int, record: Record, ends: list[SketchPoint]) -> None:
        """Add a line, circle or arc; for an arc also the equation that both ends have the same radius."""
        kind = record.whole("type")
        if kind == LINE:
            self.lines[handle] = Arrow(ends[0], ends[1])
        elif kind == ARC:
            first, second = Arrow(ends[0], ends[1]), Arrow(ends[0], ends[2])
            self.curves[handle] = Round(ends[0], first.squared, first.length, (ends[1], ends[2]))
            if is_drawn(handle) and not self._is_whole_circle(record):
                text = f"{first.squared} = {second.squared}"
                self.draft.constraint(f"{drawn_name(handle)}-arc", "equation", record.line, text=text)
        else:
            distance = self.file.entities.get(record.handle("distance.v"))
            radius = f"radius_{drawn_name(handle)}"
            if distance is not None and is_drawn(handle):
                self.draft.coordinate(radius, distance.number("actDistance"))
                self.curves[handle] = Round(ends[0], f"{radius}^2", radius)

    def _is_whole_circle(self, arc: Record) -> bool:
        """Return whether the ends of an arc are joined by a constraint of its group, so that it is a circle."""
        ends = frozenset((arc.handle("point[1].v"), arc.handle("point[2].v")))
        return not self._joined.isdisjoint({(ends, 0), (ends, self.file.group_of(arc.handle()))})

    @cached_property
    def _joined(self) -> set[tuple[frozenset[int], int]]:
        """Pairs of points that constraints make coincide, with the group of each constraint."""
        together = [c for c in self.file.constraints.values() if c.whole("type") == _COINCIDENT]
        return {(frozenset((c.handle("ptA.v"), c.handle("ptB.v"))), c.handle("group.v")) for c in together}

    def _constraint(self, record: Record) -> None:
        """Add a constraint of the sketch, or note why it is left out."""
        kind = KINDS.get(record.whole("type"))
        title = NOT_READ.get(record.whole("type"), "") if kind is None else kind.name
        name = f"c{record.handle():03x}" + (f"-{title}" if title else f": of kind {record.whole('type')}")
        if idle := self._idle(record):
            self.draft.leave_out(f"{name}: {idle}")
            return
        try:
            written = list(self._written(record))
        except UnreadError as why:
            self.draft.leave_out(f"{name}: {why}", binding=True)
            return
        for k, constraint in enumerate(written):
            fields = {"type": "equation", "text": constraint} if isinstance(constraint, str) else dict(constraint)
            called = name if len(written) == 1 else f"{name}-{'abcd'[k]}"
            self.draft.constraint(called, fields.pop("type"), record.line, **fields)

    def _idle(self, record: Record) -> str:
        """Return why a constraint is not enforced in SolveSpace either; empty if it is."""
        kind, group = record.whole("type"), self.file.groups.get(record.handle("group.v"))
        measures = group is not None and kind in _DIMENSIONS and group.whole("allDimsReference")
        if record.whole("reference") or measures:
            return "a reference dimension, which only measures"
        relaxed = group is not None and group.whole("relaxConstraints") and kind != _COINCIDENT
        return "its group is relaxed, so it is not enforced" if relaxed else ""

    def _written(self, record: Record) -> Iterable[Written]:
        """Return the scene's constraints for a constraint of the sketch. Raises UnreadError if it cannot be read."""
        kind = KINDS.get(record.whole("type"))
        if kind is None:
            raise UnreadError("constraints of this kind are not read")
        if record.handle("workplane.v") not in (0, self.plane):
            raise UnreadError("it belongs to a workplane other than the one that is read")
        mentions = self._mentions(record)
        counts = len(mentions.points), len(mentions.lines), len(mentions.curves)
        named = sum(bool(record.handle(f"{key}.v")) for key in _MENTIONS)
        if counts not in kind.needs or sum(counts) != named:
            raise UnreadError("it refers to something outside the plane that is read")
        written = list(kind.writes(mentions))
        if not written:
            raise UnreadError("the entities that it refers to have no such ends")
        if any(len(text) > MAX_CHARACTERS for text in written if isinstance(text, str)):
            raise UnreadError("its equation is longer than a text of a scene may be")
        return written

    def _mentions(self, record: Record) -> SketchMentions:
        handles = [record.handle(f"{key}.v") for key in _MENTIONS]
        return SketchMentions(
            tuple(self.points[h] for h in handles[:2] if h in self.points),
            tuple(self.lines[h] for h in handles[2:] if h in self.lines),
            tuple(self.curves[h] for h in handles[2:] if h in self.curves),
            record.number("valA"),
            bool(record.whole("other")),
            bool(record.whole("other2")),
        )

    def _leave_out(self) -> None:
        """Note the parts of the file that are left out: outside the plane, derived, or an order of groups."""
        if self.outside:
            self.draft.leave_out(f"{many(self.outside, 'point')} outside the plane of most points: one plane is read")
        if len({c.handle("group.v") for c in self.file.constraints.values()}) > 1:
            self.draft.leave_out(
                "the order of the groups: all constraints are enforced at once, whereas SolveSpace keeps earlier "
                "groups as they were solved"
            )
        drawn = {e.whole("type") for h, e in self.file.entities.items() if is_drawn(h)}
        if not drawn.isdisjoint(CUBICS):
            self.draft.leave_out("cubic curves: only their points are read")
        if not drawn.isdisjoint(RECTANGLES):
            self.draft.leave_out("texts and images: their corners keep no shape", binding=True)
        groups = [g.values.get("name", "") for g in self.file.groups.values() if g.whole("type") not in DRAWN_GROUPS]
        if groups:
            self.draft.leave_out(f"{listed(groups)}: groups that are derived from sketches")
