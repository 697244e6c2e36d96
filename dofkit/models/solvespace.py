"""SolveSpace's sketches in a plane as scenes: points are particles, radii of circles are coordinates.

A file may hold several sketches: that of one plane is read, the plane with most points; the rest is told. Names are
those that SolveSpace shows: r004 for what was drawn fourth, c001 for the first constraint.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import field

import numpy as np

from dofkit.base.errors import Fault, SceneError
from dofkit.base.records import dataclass
from dofkit.models.model_document import (
    COARSEST,
    FINEST,
    ModelDocument,
    ModelFile,
    SceneDraft,
    listed,
    number,
)
from dofkit.models.sketch_file import Record, SketchFile, read_sketch
from dofkit.models.sketch_geometry import Arrow, Round, SketchPoint, fixed_point, particle_point
from dofkit.models.sketch_relations import KINDS, SketchMentions

#: Types of entities and requests.
_POINT_2D, _LINE, _CIRCLE, _ARC = 2001, 11000, 13000, 14000
_POINTS = range(2000, 3000)
_COMMENT = 1000
#: SolveSpace stops where its equations hold to within this.
SOLVED = 1e-6
_DERIVED = 0x80000000
_IN_SPACE = 5000
#: The group of the axes.
_REFERENCES = 1
_SKETCHES = (_IN_SPACE, 5001)
#: What the points of an entity are called.
_ROLES = {_LINE: ("start", "end"), _CIRCLE: ("centre",), _ARC: ("centre", "start", "end")}


def read(file: ModelFile) -> ModelDocument:
    """The scene of a sketch. Raises SceneError for what is no such file."""
    found = read_sketch(file)
    plane = _main_plane(found)
    if not plane:
        drawn = [g for h, g in found.groups.items() if g.whole("type") == _IN_SPACE and h != _REFERENCES]
        names = f": {listed(g.values.get('name', '') for g in drawn)} is drawn in space" if drawn else ""
        hint = "draw it in a workplane: Sketch, In Workplane; sketches of space are not read"
        line = drawn[0].line if drawn else 1
        fault = Fault(f"no point of this file is drawn in a workplane{names}", line=line, column=1, hint=hint)
        raise SceneError((fault,), file.name)
    draft = SceneDraft(f"SolveSpace sketch {file.name}", dimension=2)
    return _SketchScene(found, draft, plane).document()


def _main_plane(file: SketchFile) -> int:
    """The workplane of most points; 0 where there is none."""
    drawn = [e for h, e in file.entities.items() if not h & _DERIVED and e.whole("type") == _POINT_2D]
    planes = Counter(e.handle("workplane.v") for e in drawn)
    return planes.most_common(1)[0][0] if planes else 0


@dataclass
class _SketchScene:
    """The scene as it grows: points, lines and rounds by the handles of their entities."""

    file: SketchFile
    draft: SceneDraft
    plane: int
    points: dict[int, SketchPoint] = field(default_factory=dict)
    lines: dict[int, Arrow] = field(default_factory=dict)
    rounds: dict[int, Round] = field(default_factory=dict)

    def __post_init__(self) -> None:
        plane = self.file.entities.get(self.plane)
        normal = None if plane is None else self.file.entities.get(plane.handle("normal.v"))
        origin = None if plane is None else self.file.entities.get(plane.handle("point[0].v"))
        self.origin = np.zeros(3) if origin is None else np.array(origin.place("actPoint"))
        self.axes = np.eye(3)[:2] if normal is None else _axes(normal)

    def document(self) -> ModelDocument:
        """Everything, in the order of the file."""
        self._entities()
        for record in self.file.constraints.values():
            self._constraint(record)
        self._rest()
        reach = [p.at for p in self.points.values()] or [(0.0, 0.0)]
        size = float(np.ptp(np.array(reach), axis=0).max()) or 1.0
        return self.draft.document(min(COARSEST, max(FINEST, SOLVED / size)), special=True)

    def _entities(self) -> None:
        for handle, record in self.file.entities.items():
            if record.whole("type") in _POINTS:
                self._point(handle, record)
        for handle, record in self.file.entities.items():
            kind = record.whole("type")
            ends = [self.points.get(record.handle(f"point[{k}].v")) for k in range(len(_ROLES.get(kind, ())))]
            known = [end for end in ends if end is not None]
            if kind in _ROLES and len(known) == len(ends):
                self._drawn(handle, record, known)

    def _point(self, handle: int, record: Record) -> None:
        """A point of the sketch, or one of the references, which stays."""
        at = self.axes @ (np.array(record.place("actPoint")) - self.origin)
        place = (float(number(at[0])), float(number(at[1])))
        own = not handle & _DERIVED and record.whole("type") == _POINT_2D and record.handle("workplane.v") == self.plane
        if own:
            name = self.draft.particle(self._name(handle), record.line, place)
            self.points[handle] = particle_point(name, place)
        elif self._is_reference(handle):
            self.points[handle] = fixed_point(place)

    def _is_reference(self, handle: int) -> bool:
        """Is it the origin, or that of the sketch's plane?"""
        if handle & _DERIVED:
            plane = self.file.entities.get(self.plane)
            return plane is not None and plane.handle("point[0].v") == handle
        request = self.file.requests.get(handle >> 16)
        return request is not None and request.handle("group.v") == 1

    def _name(self, handle: int) -> str:
        """As SolveSpace calls what was drawn, and which point of that it is."""
        whole = self.file.entities.get(handle & ~0xFFFF)
        kind = 0 if whole is None else whole.whole("type")
        roles = _ROLES.get(kind, ())
        k = next((k for k in range(len(roles)) if whole is not None and whole.handle(f"point[{k}].v") == handle), None)
        return f"r{handle >> 16:03x}" + ("" if k is None else f"_{roles[k]}")

    def _drawn(self, handle: int, record: Record, ends: list[SketchPoint]) -> None:
        """A line, circle or arc; an arc's ends are as far from its centre."""
        kind = record.whole("type")
        if kind == _LINE:
            self.lines[handle] = Arrow(ends[0], ends[1])
        elif kind == _ARC:
            first, second = Arrow(ends[0], ends[1]), Arrow(ends[0], ends[2])
            self.rounds[handle] = Round(ends[0], first.squared, first.length, (ends[1], ends[2]))
            if not handle & _DERIVED:
                text = f"{first.squared} = {second.squared}"
                self.draft.constraint(f"r{handle >> 16:03x}-arc", "equation", record.line, text=text)
        else:
            distance = self.file.entities.get(record.handle("distance.v"))
            radius = f"radius_r{handle >> 16:03x}"
            if distance is not None and not handle & _DERIVED:
                self.draft.coordinates.append(radius)
                self.draft.configuration[radius] = number(distance.number("actDistance"))
                self.rounds[handle] = Round(ends[0], f"{radius}^2", radius)

    def _constraint(self, record: Record) -> None:
        kind = KINDS.get(record.whole("type"))
        if record.whole("type") == _COMMENT:
            return
        number_ = f"c{record.handle():03x}"
        if kind is None or kind.says is None:
            told = f"{number_}: of kind {record.whole('type') if kind is None else kind.name}, which is not read"
            self.draft.leave_out(told, binding=True)
            return
        name = f"{number_}-{kind.name}"
        if record.whole("reference"):
            self.draft.leave_out(f"{name}: a reference dimension, which only measures")
            return
        mentioned = self._mentioned(record)
        given = len(mentioned.points), len(mentioned.lines), len(mentioned.rounds)
        if given not in kind.needs:
            self.draft.leave_out(f"{name}: it mentions what is not in the plane that is read", binding=True)
            return
        written = list(kind.says(mentioned))
        for k, one in enumerate(written):
            called = name if len(written) == 1 else f"{name}-{'ab'[k]}"
            fields = {key: part for key, part in one.items() if key != "type"}
            self.draft.constraint(called, one["type"], record.line, **fields)

    def _mentioned(self, record: Record) -> SketchMentions:
        points = [self.points.get(record.handle(f"pt{k}.v")) for k in "AB"]
        entities = [record.handle(f"entity{k}.v") for k in "ABCD"]
        return SketchMentions(
            tuple(p for p in points if p is not None),
            tuple(self.lines[e] for e in entities if e in self.lines),
            tuple(self.rounds[e] for e in entities if e in self.rounds),
            record.number("valA"),
            bool(record.whole("other")),
            bool(record.whole("other2")),
        )

    def _rest(self) -> None:
        """What of the file is in no plane, or derived."""
        own = {h for h, e in self.file.entities.items() if not h & _DERIVED}
        other = [e for h, e in self.file.entities.items() if h in own and self._elsewhere(h, e)]
        if other:
            self.draft.leave_out(f"{len(other)} points outside the plane of most points: one plane is read")
        space = [group.values.get("name", "") for group in self._spatial_groups(other)]
        if space:
            self.draft.leave_out(f"{listed(space)}: sketches in space, whose constraints would need three coordinates")
        odd = {e.whole("type") for h, e in self.file.entities.items() if h in own} & {12000, 12001, 15000, 16000}
        if odd:
            self.draft.leave_out("cubic curves, texts and images: their points are read, and not what they do between")
        groups = [g.values.get("name", "") for g in self.file.groups.values() if g.whole("type") not in _SKETCHES]
        if groups:
            self.draft.leave_out(f"{listed(groups)}: groups that are derived from sketches")

    def _spatial_groups(self, entities: Iterable[Record]) -> list[Record]:
        """The sketches of space in which entities were drawn, in the order of the file."""
        requests = [self.file.requests.get(entity.handle() >> 16) for entity in entities]
        drawn_in = {request.handle("group.v") for request in requests if request is not None}
        return [g for h, g in self.file.groups.items() if h in drawn_in and g.whole("type") == _IN_SPACE]

    def _elsewhere(self, handle: int, record: Record) -> bool:
        return record.whole("type") in _POINTS and handle not in self.points


def _axes(normal: Record) -> np.ndarray:
    """The directions u and v of a plane whose normal has this quaternion."""
    w, x, y, z = (normal.number(f"actNormal.{k}") for k in ("w", "vx", "vy", "vz"))
    u = (w * w + x * x - y * y - z * z, 2 * (w * z + x * y), 2 * (x * z - w * y))
    v = (2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (w * x + y * z))
    return np.array([u, v])
