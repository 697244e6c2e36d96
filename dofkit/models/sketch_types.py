"""The types of what a SolveSpace file holds, by their numbers, and what SolveSpace calls what was drawn."""

from __future__ import annotations

from dofkit.models.sketch_file import DERIVED, Record, SketchFile

#: Types of entities.
POINT_3D, POINT_2D, NORMAL_3D, NORMAL_2D, WORKPLANE = 2000, 2001, 3000, 3001, 10000
LINE, CIRCLE, ARC = 11000, 13000, 14000
CUBIC, CUBIC_RING, RECTANGLES = 12000, 12001, (15000, 16000)
#: A cubic has so many points at the least, and at the most.
_CUBIC_POINTS = 4, 12
POINTS, NORMALS, FACES = range(2000, 3000), range(3000, 4000), range(5000, 6000)
#: Types of groups: drawn in space and in a workplane, and those that move copies along.
IN_SPACE, IN_PLANE, EXTRUDE, TRANSLATE = 5000, 5001, 5100, 5201
#: The group of the axes.
REFERENCES = 1
#: What the points of an entity are called.
_ROLES = {LINE: ("start", "end"), CIRCLE: ("centre",), ARC: ("centre", "start", "end")}


def corners(record: Record) -> int:
    """How many points something drawn is told by; 0 where it is not read."""
    kind, (least, most) = record.whole("type"), _CUBIC_POINTS
    if kind == CUBIC:
        return min(max(least, least + record.whole("extraPoints")), most)
    return 4 if kind in RECTANGLES else len(_ROLES.get(kind, ()))


def shown_name(file: SketchFile, handle: int) -> str:
    """As SolveSpace calls what was drawn, and which point of that it is."""
    whole = file.entities.get(handle & ~0xFFFF)
    roles = () if whole is None else _ROLES.get(whole.whole("type"), ())
    k = next((k for k in range(len(roles)) if whole is not None and whole.handle(f"point[{k}].v") == handle), None)
    return drawn_name(handle) + ("" if k is None else f"_{roles[k]}")


def drawn_name(handle: int) -> str:
    """As SolveSpace calls what was drawn by one request."""
    return f"r{handle >> 16:03x}"


def group_name(file: SketchFile, handle: int) -> str:
    """As SolveSpace calls a group."""
    group = file.groups.get(handle)
    return f"g{handle:03x}-{'' if group is None else group.values.get('name', '')}"


def is_own(handle: int) -> bool:
    """Was it drawn, and not made by a group?"""
    return not handle & DERIVED
