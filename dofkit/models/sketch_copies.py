"""Copies of points that a group of a sketch moves along: extrusions and translations, each by a vector of its own."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from dofkit.expressions.text import to_text
from dofkit.models.model_document import SceneDraft
from dofkit.models.sketch_file import Record, SketchFile
from dofkit.models.sketch_space import SpacePlane, SpacePoint, SpaceVector, inner, moving_vector
from dofkit.models.sketch_types import EXTRUDE, TRANSLATE, group_name

#: Which copy: the last of a translation, the top and the bottom of an extrusion.
_LAST, _TOP, _BOTTOM = 1000, 1001, 1002
#: To one side, in the direction of the workplane's normal or in any.
_ONE_SIDED, _SKEWED = (7000, 7004), (7004, 7005)
#: A copy stands where it should to within this.
_NEAR = 1e-5
_MOST = 10_000


class Copy(NamedTuple):
    """Of which entity something is a copy, and by how many times the group's vector it was moved."""

    source: int
    steps: int


@dataclass
class MovedCopies:
    """The copies that groups made, by the group's handle; ``vectors``: those that were written."""

    file: SketchFile
    draft: SceneDraft
    vectors: dict[int, SpaceVector] = field(default_factory=dict)
    _tables: dict[int, dict[int, tuple[int, int]]] = field(default_factory=dict)

    def source(self, group: Record, handle: int) -> tuple[int, int] | None:
        """What an entity of the group was made of, and which copy it is."""
        own = group.handle()
        if own not in self._tables:
            self._tables[own] = {made: (source, which) for made, source, which in group.copies}
        return self._tables[own].get(handle & 0xFFFF)

    def copy(self, group: Record, handle: int) -> Copy | None:
        """What an entity of the group is a copy of; None where that is not read."""
        found = self.source(group, handle)
        steps = None if found is None else _steps(group, found[1])
        return None if found is None or steps is None else Copy(found[0], steps)

    def moved(
        self, group: Record, source: SpacePoint, steps: int, record: Record, plane: SpacePlane | None
    ) -> SpacePoint | None:
        """The source moved along; None where it is not drawn there."""
        if not steps:
            return source._replace(plane=0)
        drawn = record.place("actPoint")
        vector = self._vector(group, [(a - b) / steps for a, b in zip(drawn, source.place.drawn, strict=True)], plane)
        place = source.place.plus(vector.times(steps))
        if max(abs(a - b) for a, b in zip(drawn, place.drawn, strict=True)) > _NEAR:
            return None
        return SpacePoint(place)

    def _vector(self, group: Record, drawn: list[float], plane: SpacePlane | None) -> SpaceVector:
        """By what the group moves its copies: along the normal of its workplane, or in that."""
        own = group.handle()
        if own in self.vectors:
            return self.vectors[own]
        names = [f"{c}_g{own:03x}" for c in "xyz"]
        for name, value in zip(names, drawn, strict=True):
            self.draft.coordinate(name, value)
        vector = self.vectors[own] = moving_vector(names, drawn)
        if plane is None:
            if group.handle("predef.entityB.v") and group.whole("subtype") not in _SKEWED:
                self.draft.leave_out(f"{group_name(self.file, own)}: its displacement", binding=True)
            return vector
        along = group.whole("type") == EXTRUDE
        axes = (plane.frame.u, plane.frame.v) if along else (plane.frame.n,)
        for letter, axis in zip("ab", () if along and group.whole("subtype") in _SKEWED else axes, strict=False):
            text = f"{to_text(inner(axis, vector))} = 0"
            self.draft.constraint(f"{group_name(self.file, own)}-{letter}", "equation", group.line, text=text)
        return vector


def _steps(group: Record, which: int) -> int | None:
    """By how many times its vector a group moves a copy; None where it does more than move it.

    SolveSpace counts in halves of a step: an extrusion to one side ends at twice its vector.
    """
    one_sided = group.whole("subtype") in _ONE_SIDED
    if abs(group.number("scale") - 1) > _NEAR:
        return None
    if group.whole("type") == EXTRUDE:
        return {_BOTTOM: 0 if one_sided else -1, _TOP: 2 if one_sided else 1}.get(which)
    if group.whole("type") != TRANSLATE or not 0 < group.number("valA") < _MOST:
        return None
    count = int(group.number("valA")) + (one_sided and bool(group.whole("skipFirst")))
    place = count - 1 if which == _LAST else which
    return 2 * place - (0 if one_sided else count - 1) if place < count else None
