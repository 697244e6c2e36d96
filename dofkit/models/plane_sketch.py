"""SolveSpace's sketches in one workplane as scenes: points are particles, radii of circles are coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from typing_extensions import override

from dofkit.models.joint_relations import figures
from dofkit.models.model_document import number
from dofkit.models.sketch_file import Record
from dofkit.models.sketch_geometry import Arrow, Cubic, Round, SketchPoint, fixed_point, particle_point
from dofkit.models.sketch_relations import KINDS, SketchMentions, Written
from dofkit.models.sketch_scene import SketchScene, UnreadError
from dofkit.models.sketch_space import PlaneFrame, fixed_frame
from dofkit.models.sketch_types import (
    ARC,
    CUBIC,
    LINE,
    POINT_2D,
    POINTS,
    RECTANGLES,
    REFERENCES,
    corners,
    drawn_name,
    is_own,
    shown_name,
)


@dataclass
class PlaneSketch(SketchScene):
    """The scene as it grows: points, lines and rounds by the handles of their entities."""

    plane: int
    points: dict[int, SketchPoint] = field(default_factory=dict)
    lines: dict[int, Arrow] = field(default_factory=dict)
    rounds: dict[int, Round] = field(default_factory=dict)
    cubics: dict[int, Cubic] = field(default_factory=dict)

    def __post_init__(self) -> None:
        plane = self.file.entities.get(self.plane)
        normal = None if plane is None else self.file.entities.get(plane.handle("normal.v"))
        origin = None if plane is None else self.file.entities.get(plane.handle("point[0].v"))
        self.origin = np.zeros(3) if origin is None else np.array(origin.place("actPoint"))
        self.axes = np.eye(3)[:2] if normal is None else _axes(fixed_frame(normal.turn("actNormal")))

    @override
    def _places(self) -> Iterator[tuple[float, ...]]:
        return (p.at for p in self.points.values())

    @override
    def _entities(self) -> None:
        for handle, record in self.file.entities.items():
            if record.whole("type") in POINTS:
                self._point(handle, record)
        for handle, record in self.file.entities.items():
            count = corners(record)
            ends = [self.points.get(record.handle(f"point[{k}].v")) for k in range(count)]
            known = [end for end in ends if end is not None]
            if count and len(known) == count:
                self._drawn(handle, record, known)

    def _point(self, handle: int, record: Record) -> None:
        """A point of the sketch, or one of the references, which stays."""
        at = self.axes @ (np.array(record.place("actPoint")) - self.origin)
        place = (float(number(at[0])), float(number(at[1])))
        own = is_own(handle) and record.whole("type") == POINT_2D and record.handle("workplane.v") == self.plane
        if own:
            name = self.draft.particle(shown_name(self.file, handle), record.line, place)
            self.points[handle] = particle_point(name, place)
        elif self._is_reference(handle):
            self.points[handle] = fixed_point(place)
        elif is_own(handle):
            self.missed += 1

    def _is_reference(self, handle: int) -> bool:
        """Is it the origin, or that of the sketch's plane?"""
        if not is_own(handle):
            plane = self.file.entities.get(self.plane)
            return plane is not None and plane.handle("point[0].v") == handle
        return self.file.group_of(handle) == REFERENCES

    def _drawn(self, handle: int, record: Record, ends: list[SketchPoint]) -> None:
        """A line, circle, arc or text; an arc's ends are as far from its centre."""
        kind = record.whole("type")
        if kind == LINE:
            self.lines[handle] = Arrow(ends[0], ends[1])
        elif kind == CUBIC:
            self.cubics[handle] = Cubic((Arrow(ends[1], ends[0]), Arrow(ends[-2], ends[-1])))
        elif kind in RECTANGLES:
            self._rectangle(handle, record, ends)
        elif kind == ARC:
            first, second = Arrow(ends[0], ends[1]), Arrow(ends[0], ends[2])
            self.rounds[handle] = Round(ends[0], first.squared, first.length, (ends[1], ends[2]))
            if is_own(handle) and not self.is_whole_circle(record):
                text = f"{first.squared} = {second.squared}"
                self.draft.constraint(f"{drawn_name(handle)}-arc", "equation", record.line, text=text)
        else:
            distance = self.file.entities.get(record.handle("distance.v"))
            radius = f"radius_{drawn_name(handle)}"
            if distance is not None and is_own(handle):
                self.draft.coordinate(radius, distance.number("actDistance"))
                self.rounds[handle] = Round(ends[0], f"{radius}^2", radius)

    def _rectangle(self, handle: int, record: Record, ends: list[SketchPoint]) -> None:
        """Corners a, o, b, c of a text or an image: b - o = c - a = k (a - o), turned right by a right angle."""
        a, o, b, _ = ends
        up, over = Arrow(o, a), Arrow(o, b)
        (x, y), (u, v) = up.drawn, over.drawn
        ratio = figures((u * y - v * x) / ((x * x + y * y) or 1.0))
        for name, side in (("bottom", over), ("top", Arrow(a, ends[3]))):
            texts = (f"{side.parts[0]} = {ratio}*{up.parts[1]}", f"{side.parts[1]} = -({ratio})*{up.parts[0]}")
            for axis, text in zip("uv", texts, strict=True):
                self.draft.constraint(f"{drawn_name(handle)}-{name}-{axis}", "equation", record.line, text=text)

    @override
    def _written(self, record: Record) -> Iterator[Written]:
        kind = KINDS[record.whole("type")]
        if kind.says is None:
            raise UnreadError("constraints of this kind are not read")
        if record.handle("workplane.v") not in (0, self.plane):
            raise UnreadError("it belongs to a workplane other than the one that is read")
        mentioned = self._mentioned(record)
        given = len(mentioned.points), len(mentioned.lines), len(mentioned.curves)
        fits = given in kind.needs and all(isinstance(one, kind.curves) for one in mentioned.curves)
        if not fits or sum(given) != len(self.mentioned(record)):
            raise UnreadError("it refers to something outside the plane that is read")
        return kind.says(mentioned)

    def _mentioned(self, record: Record) -> SketchMentions:
        points = [self.points.get(record.handle(f"pt{k}.v")) for k in "AB"]
        entities = [record.handle(f"entity{k}.v") for k in "ABCD"]
        return SketchMentions(
            tuple(p for p in points if p is not None),
            tuple(self.lines[e] for e in entities if e in self.lines),
            tuple(one for e in entities if (one := self.rounds.get(e) or self.cubics.get(e)) is not None),
            record.number("valA"),
            bool(record.whole("other")),
            bool(record.whole("other2")),
        )

    @override
    def _rest(self) -> None:
        if self.missed:
            self.draft.leave_out(f"{self.missed} points outside the plane of most points: one plane is read")
        super()._rest()


def _axes(frame: PlaneFrame) -> np.ndarray:
    """The directions u and v of a plane."""
    return np.array([frame.u.drawn, frame.v.drawn])
