"""The faces of what a sketch extrudes, as planes: sides by lines and how these move, top and bottom by a workplane."""

from __future__ import annotations

from dofkit.models.sketch_entities import SketchEntities
from dofkit.models.sketch_space import PlaneFrame, SpacePlane, SpaceVector, inner_drawn
from dofkit.models.sketch_types import EXTRUDE

_BY_NORMAL, _BY_LINE = 5000, 5001


def face(found: SketchEntities, handle: int) -> SpacePlane | None:
    """The plane of a face, of which only the normal is told; None where it is of no extrusion that is read."""
    record = found.file.entities.get(handle)
    group = found.file.groups.get(found.file.group_of(handle))
    if record is None or group is None or group.whole("type") != EXTRUDE:
        return None
    source, moved = found.copies.source(group, handle), found.copies.vectors.get(group.handle())
    if record.whole("type") == _BY_LINE and source is not None and moved is not None:
        line = found.line(source[0])
        return (
            None if line is None or line.ends is None else _plane(line.ends[0].place, line.along.cross(moved), handle)
        )
    point, plane = found.point(record.handle("point[0].v")), found.plane(group.handle("predef.entityB.v"))
    if record.whole("type") != _BY_NORMAL or point is None or plane is None:
        return None
    drawn = SpaceVector((), record.turn("actNormal")[1:])
    side = inner_drawn(plane.frame.n, drawn)
    return (
        None if not side else _plane(point.place, plane.frame.n.times(1 if side > 0 else -1), handle, plane.frame.unit)
    )


def _plane(origin: SpaceVector, normal: SpaceVector, handle: int, unit: bool = False) -> SpacePlane:
    return SpacePlane(origin, PlaneFrame(normal, normal, normal, unit), handle)
