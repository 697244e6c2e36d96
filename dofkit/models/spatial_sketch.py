"""SolveSpace's sketches in space as scenes: points are particles, and those of a workplane stay in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TypeVar

from typing_extensions import override

from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr, coordinate
from dofkit.models.model_document import number
from dofkit.models.sketch_entities import SketchEntities
from dofkit.models.sketch_faces import face
from dofkit.models.sketch_file import Record
from dofkit.models.sketch_frames import keep_in_plane
from dofkit.models.sketch_mentions import SpaceMentions
from dofkit.models.sketch_relations import Written
from dofkit.models.sketch_scene import SketchScene, UnreadError
from dofkit.models.sketch_space import Projection, SpacePlane, SpacePoint, inner, inner_drawn, squared
from dofkit.models.sketch_space_relations import SPACE_KINDS
from dofkit.models.sketch_types import (
    ARC,
    CIRCLE,
    CUBIC,
    FACES,
    NORMALS,
    POINTS,
    RECTANGLES,
    WORKPLANE,
    drawn_name,
    group_name,
    is_own,
)

_Read = TypeVar("_Read")
#: Under which name what is no point, line or normal is mentioned.
_PLACES = {WORKPLANE: "planes", CIRCLE: "curves", ARC: "curves", CUBIC: "curves"}


@dataclass
class SpatialSketch(SketchScene):
    """The scene as it grows."""

    def __post_init__(self) -> None:
        self.found = SketchEntities(self.file, self.draft)

    @override
    def _places(self) -> Iterator[tuple[float, ...]]:
        return (p.place.drawn for p in self.found.points.values() if p is not None)

    @override
    def _derived(self) -> set[int]:
        return {*self.found.copies.vectors}

    @override
    def _entities(self) -> None:
        own = [(h, e) for h, e in self.file.entities.items() if is_own(h)]
        for handle, record in self.file.entities.items():
            if record.whole("type") in POINTS:
                self.missed += self.found.point(handle) is None and is_own(handle)
        for plane, names in self.found.members.items():
            self._keep_in_plane(plane, names)
        for handle, record in own:
            kind = record.whole("type")
            if kind in NORMALS:
                self.found.frame(handle)
            elif kind == CIRCLE:
                self.found.radius(record.handle("distance.v"))
            elif kind == ARC and not self.is_whole_circle(record):
                self._arc(handle, record)
            elif kind in RECTANGLES:
                self._rectangle(handle, record)

    def _keep_in_plane(self, handle: int, names: list[str]) -> None:
        plane, line = self.found.plane(handle), self.file.entities[handle].line
        group = self.file.group_of(handle)
        name = drawn_name(handle) if is_own(handle) else group_name(self.file, group)
        if plane is not None:
            keep_in_plane(self.draft, plane, names, name, line)

    def _arc(self, handle: int, record: Record) -> None:
        """An arc's ends are as far from its centre."""
        c, a, b = self._corners(record, 3)
        if c is not None and a is not None and b is not None:
            one, other = (to_text(squared(end.place.minus(c.place))) for end in (a, b))
            self.draft.constraint(f"{drawn_name(handle)}-arc", "equation", record.line, text=f"{one} = {other}")

    def _corners(self, record: Record, count: int) -> list[SpacePoint | None]:
        return [self.found.point(record.handle(f"point[{k}].v")) for k in range(count)]

    def _rectangle(self, handle: int, record: Record) -> None:
        """Corners a, o, b, c of a text or an image: b - o = c - a = k (a - o), turned right by a right angle."""
        corners = [p.place for p in self._corners(record, 4) if p is not None and p.plane]
        plane = self.found.plane(record.handle("workplane.v"))
        if len(corners) < 4 or plane is None or not plane.frame.unit:
            if record.handle("point[2].v"):
                self.draft.leave_out(f"{drawn_name(handle)}: the shape of a text or an image", binding=True)
            return
        a, o, b, c = corners
        u, v, up, over = plane.frame.u, plane.frame.v, a.minus(o), b.minus(o)
        turned = inner_drawn(v, up) * inner_drawn(u, over) - inner_drawn(u, up) * inner_drawn(v, over)
        ratio = number(turned / (inner_drawn(up, up) or 1.0))
        for name, side in (("bottom", over), ("top", c.minus(a))):
            for letter, axis, other, factor in (("u", u, v, ratio), ("v", v, u, -ratio)):
                text = f"{to_text(inner(axis, side))} = ({factor})*({to_text(inner(other, up))})"
                self.draft.constraint(f"{drawn_name(handle)}-{name}-{letter}", "equation", record.line, text=text)

    @override
    def _written(self, record: Record) -> Iterator[Written]:
        kind = SPACE_KINDS.get(record.whole("type"))
        if kind is None:
            raise UnreadError("constraints of this kind are not read")
        found = self._mentions(record)
        if found.counted not in kind.needs:
            raise UnreadError("it refers to something that is not read")
        measured = self._measured(found, record) if kind.seen else found
        if not kind.reads(measured):
            raise UnreadError("it belongs to a workplane in which such constraints are not read")
        return kind.says(measured)

    def _mentions(self, record: Record) -> SpaceMentions:
        """What a constraint mentions. Raises UnreadError where some of that is not read."""
        by_kind: dict[str, list[int]] = {"points": [], "lines": [], "normals": [], "planes": [], "curves": []}
        for handle in self.mentioned(record):
            entity = self.file.entities.get(handle)
            kind = 0 if entity is None else entity.whole("type")
            place = "points" if kind in POINTS else "planes" if kind in FACES else "lines"
            by_kind[_PLACES.get(kind, place)].append(handle)
            by_kind["normals"] += [handle] if kind in NORMALS else []
        read = self.found
        return SpaceMentions(
            _read(by_kind["points"], read.point), _read(by_kind["lines"], read.line),
            _read(by_kind["normals"], read.frame), _read(by_kind["planes"], self._plane),
            _read(by_kind["curves"], read.curve),
            self._fresh(record), record.number("valA"), (bool(record.whole("other")), bool(record.whole("other2"))),
        )  # fmt: skip

    def _plane(self, handle: int) -> SpacePlane | None:
        """A workplane, or a face."""
        return self.found.plane(handle) or face(self.found, handle)

    def _measured(self, found: SpaceMentions, record: Record) -> SpaceMentions:
        """With the workplane in which it is seen: the one it names, else that of all that it mentions."""
        common = found.common_plane
        seen = record.handle("workplane.v") or (common if not found.frames and not found.planes else 0)
        if not seen:
            return found
        plane = self.found.plane(seen)
        if plane is None:
            raise UnreadError("it belongs to a workplane that is not read")
        return found._replace(measure=Projection(plane.frame, seen == common), origin=plane.origin)

    def _fresh(self, record: Record) -> Callable[[float], Expr]:
        """What makes the unknown of a constraint."""
        return lambda drawn: coordinate(self.draft.coordinate(f"t_c{record.handle():03x}", drawn))


def _read(handles: Iterable[int], reader: Callable[[int], _Read | None]) -> tuple[_Read, ...]:
    """All of them read. Raises UnreadError where one is not."""
    found = []
    for handle in handles:
        one = reader(handle)
        if one is None:
            raise UnreadError("it refers to something that is not read")
        found.append(one)
    return tuple(found)
