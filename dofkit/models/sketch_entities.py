"""The points, workplanes, lines and circles of a sketch in space, each read once, whatever it rests on before it.

Workplanes stand where their origin is, turned as they are given: fixed, by a quaternion of their own, or by lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from dofkit.expressions.tree import Expr, coordinate, sqrt
from dofkit.models.model_document import SceneDraft
from dofkit.models.sketch_copies import MovedCopies
from dofkit.models.sketch_file import Record, SketchFile
from dofkit.models.sketch_frames import frame_of_lines, turning_frame
from dofkit.models.sketch_space import (
    PlaneFrame,
    SpaceCubic,
    SpaceLine,
    SpacePlane,
    SpacePoint,
    SpaceRound,
    fixed_frame,
    fixed_vector,
    line_between,
    moving_vector,
    squared,
)
from dofkit.models.sketch_types import (
    ARC,
    CIRCLE,
    CUBIC,
    IN_PLANE,
    LINE,
    NORMAL_2D,
    NORMAL_3D,
    NORMALS,
    POINT_2D,
    POINT_3D,
    POINTS,
    REFERENCES,
    WORKPLANE,
    corners,
    drawn_name,
    group_name,
    is_own,
    shown_name,
)

#: How the workplane of a group is given: by its turn, by two lines, by a normal.
_BY_TURN, _BY_LINES, _BY_NORMAL = 6000, 6001, 6002
#: Entities rest on so many others in a row at most.
DEEPEST = 60


@dataclass
class SketchEntities:
    """What was found of entities, by their handles: None where they cannot be read.

    ``members``: the particles of each workplane.
    """

    file: SketchFile
    draft: SceneDraft
    points: dict[int, SpacePoint | None] = field(default_factory=dict)
    frames: dict[int, PlaneFrame | None] = field(default_factory=dict)
    members: dict[int, list[str]] = field(default_factory=dict)
    copied: dict[int, SpacePoint | None] = field(default_factory=dict)
    _depth: int = 0

    def __post_init__(self) -> None:
        self.copies = MovedCopies(self.file, self.draft)

    def point(self, handle: int) -> SpacePoint | None:
        """A point: of the references, one that is drawn, or one that stands where another one puts it."""
        if handle not in self.points:
            record = self.file.entities.get(handle)
            self.points[handle] = None
            if record is not None and record.whole("type") in POINTS and self._depth < DEEPEST:
                self._depth += 1
                self.points[handle] = self._point(handle, record)
                self._depth -= 1
        return self.points[handle]

    def _point(self, handle: int, record: Record) -> SpacePoint | None:
        kind, drawn = record.whole("type"), record.place("actPoint")
        if not is_own(handle):
            return self._derived_point(handle, record)
        if self.file.group_of(handle) == REFERENCES:
            return SpacePoint(fixed_vector(drawn))
        plane = record.handle("workplane.v") if kind == POINT_2D else 0
        if kind not in (POINT_2D, POINT_3D) or (kind == POINT_2D and self.plane(plane) is None):
            return None
        name = self.draft.particle(shown_name(self.file, handle), record.line, drawn)
        if plane:
            self.members.setdefault(plane, []).append(name)
        return SpacePoint(moving_vector([f"{c}_{name}" for c in "xyz"], drawn), name, plane)

    def _derived_point(self, handle: int, record: Record) -> SpacePoint | None:
        """The origin of a group's workplane, or a copy that a group moved along."""
        group = self.file.groups.get(self.file.group_of(handle))
        if group is None:
            return None
        if group.whole("type") == IN_PLANE:
            return self.point(group.handle("predef.origin.v"))
        copy = self.copies.copy(group, handle)
        source = None if copy is None else self.point(copy.source)
        if copy is None or source is None:
            return None
        return self.copies.moved(group, source, copy.steps, record, self.plane(group.handle("predef.entityB.v")))

    def plane(self, handle: int) -> SpacePlane | None:
        """A workplane."""
        record = self.file.entities.get(handle)
        if record is None or record.whole("type") != WORKPLANE:
            return None
        origin, frame = self.point(record.handle("point[0].v")), self.frame(record.handle("normal.v"))
        return None if origin is None or frame is None else SpacePlane(origin.place, frame, handle)

    def frame(self, handle: int) -> PlaneFrame | None:
        """The axes that a normal stands for."""
        if handle not in self.frames:
            record = self.file.entities.get(handle)
            self.frames[handle] = None
            if record is not None and record.whole("type") in NORMALS and self._depth < DEEPEST:
                self._depth += 1
                self.frames[handle] = self._frame(handle, record)
                self._depth -= 1
        return self.frames[handle]

    def _frame(self, handle: int, record: Record) -> PlaneFrame | None:
        kind, drawn = record.whole("type"), record.turn("actNormal")
        if not is_own(handle):
            group = self.file.groups.get(self.file.group_of(handle))
            if group is not None and group.whole("type") == IN_PLANE:
                return self._frame_of_group(group, drawn)
            copy = None if group is None else self.copies.copy(group, handle)
            return None if copy is None else self.frame(copy.source)
        if kind == NORMAL_2D:
            plane = self.plane(record.handle("workplane.v"))
            return None if plane is None else plane.frame
        if kind != NORMAL_3D:
            return None
        if self.file.group_of(handle) == REFERENCES:
            return fixed_frame(drawn)
        origin = self.point(record.handle("point[0].v"))
        return turning_frame(self.draft, record, origin, drawn_name(handle))

    def _frame_of_group(self, group: Record, drawn: Sequence[float]) -> PlaneFrame | None:
        """The axes of the workplane that a group is drawn in."""
        how = group.whole("subtype")
        if how == _BY_TURN:
            return fixed_frame(drawn)
        if how == _BY_NORMAL:
            return self.frame(group.handle("predef.entityB.v"))
        found = [self.line(group.handle(f"predef.entity{k}.v")) for k in "BC"]
        known = [line for line in found if line is not None]
        if how != _BY_LINES or len(known) < len(found):
            return None
        if all(line.along.constant for line in known):
            return fixed_frame(drawn)
        name = group_name(self.file, group.handle())
        return frame_of_lines(self.draft, group, name, (known[0].along, known[1].along))

    def line(self, handle: int) -> SpaceLine | None:
        """A line by its ends, or the direction of a normal."""
        record = self.file.entities.get(handle)
        if record is None:
            return None
        if record.whole("type") in NORMALS:
            frame = self.frame(handle)
            return None if frame is None else SpaceLine(frame.n, unit=frame.unit)
        if record.whole("type") != LINE:
            return None
        a, b = (self.point(record.handle(f"point[{k}].v")) for k in (0, 1))
        return None if a is None or b is None else line_between(a, b)

    def round(self, handle: int) -> SpaceRound | None:
        """A circle or an arc that was drawn."""
        record = self.file.entities.get(handle)
        if record is None or not is_own(handle) or record.whole("type") not in (CIRCLE, ARC):
            return None
        count = corners(record)
        known = [p for k in range(count) if (p := self.point(record.handle(f"point[{k}].v"))) is not None]
        frame = self.frame(record.handle("normal.v"))
        if len(known) < count:
            return None
        if count == 1:
            radius = self.radius(record.handle("distance.v"))
            return None if radius is None else SpaceRound(known[0], radius * radius, radius, frame)
        size = squared(known[1].place.minus(known[0].place))
        return SpaceRound(known[0], size, sqrt(size), frame, (known[1], known[2]))

    def curve(self, handle: int) -> SpaceRound | SpaceCubic | None:
        """A circle, an arc or a cubic that was drawn."""
        record = self.file.entities.get(handle)
        if record is None or not is_own(handle) or record.whole("type") != CUBIC:
            return self.round(handle)
        count = corners(record)
        known = [p for k in range(count) if (p := self.point(record.handle(f"point[{k}].v"))) is not None]
        if len(known) < count:
            return None
        tangents = known[0].place.minus(known[1].place), known[-1].place.minus(known[-2].place)
        planes = {p.plane for p in known}
        return SpaceCubic(tangents, planes.pop() if len(planes) == 1 else 0)

    def radius(self, handle: int) -> Expr | None:
        """The radius of a circle that was drawn."""
        record = self.file.entities.get(handle)
        if record is None or not is_own(handle):
            return None
        return coordinate(self.draft.coordinate(f"radius_{drawn_name(handle)}", record.number("actDistance")))
