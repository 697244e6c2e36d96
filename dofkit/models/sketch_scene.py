"""What the scenes of sketches in a plane and in space have in common: constraints in order, and what was left out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dofkit.expressions.text.bounds import MAX_CHARACTERS
from dofkit.models.model_document import COARSEST, FINEST, ModelDocument, SceneDraft, listed
from dofkit.models.sketch_file import Record, SketchFile
from dofkit.models.sketch_relations import KINDS, Written
from dofkit.models.sketch_types import CUBIC, CUBIC_RING, IN_PLANE, IN_SPACE, is_own

#: SolveSpace stops where its equations hold to within this.
SOLVED = 1e-6
_COMMENT, _COINCIDENT = 1000, 20
#: Kinds that have a number, which a group may make all of them measure.
_DIMENSIONS = frozenset({*range(30, 35), 51, 56, 90, 120, *range(210, 214)})
_MENTIONS = ("ptA", "ptB", "entityA", "entityB", "entityC", "entityD")


class UnreadError(Exception):
    """A constraint that is not read, and why."""


@dataclass
class SketchScene(ABC):
    """A scene as it grows; ``missed``: how many points of the file are not read."""

    file: SketchFile
    draft: SceneDraft
    missed: int = field(default=0, init=False)

    def document(self) -> ModelDocument:
        """Everything, in the order of the file."""
        self._entities()
        for record in self.file.constraints.values():
            self._constraint(record)
        self._rest()
        reach = [*self._places()] or [(0.0, 0.0)]
        size = float(np.ptp(np.array(reach), axis=0).max()) or 1.0
        return self.draft.document(min(COARSEST, max(FINEST, SOLVED / size)), special=True)

    @abstractmethod
    def _entities(self) -> None:
        """Read what is drawn."""

    @abstractmethod
    def _written(self, record: Record) -> Iterator[Written]:
        """What a constraint says. Raises UnreadError where that is not read."""

    @abstractmethod
    def _places(self) -> Iterator[tuple[float, ...]]:
        """Where the points are drawn."""

    def _derived(self) -> set[int]:
        """The derived groups that are read."""
        return set()

    def _constraint(self, record: Record) -> None:
        kind = KINDS.get(record.whole("type"))
        if record.whole("type") == _COMMENT:
            return
        number = f"c{record.handle():03x}"
        if kind is None:
            self.draft.leave_out(f"{number}: of kind {record.whole('type')}, which is not read", binding=True)
            return
        name = f"{number}-{kind.name}"
        if idle := self._idle(record):
            self.draft.leave_out(f"{name}: {idle}")
            return
        try:
            written = list(self._written(record))
            if not written:
                raise UnreadError("the entities that it refers to have no such ends")
            if any(len(one.get("text", "")) > MAX_CHARACTERS for one in written):
                raise UnreadError("its equation is longer than a text of a scene may be")
        except UnreadError as why:
            self.draft.leave_out(f"{name}: {why}", binding=True)
            return
        for k, one in enumerate(written):
            called = name if len(written) == 1 else f"{name}-{'abcd'[k]}"
            fields = {key: part for key, part in one.items() if key != "type"}
            self.draft.constraint(called, one["type"], record.line, **fields)

    def _idle(self, record: Record) -> str:
        """Why a constraint says nothing in SolveSpace either; empty where it does."""
        kind, group = record.whole("type"), self.file.groups.get(record.handle("group.v"))
        measures = group is not None and kind in _DIMENSIONS and group.whole("allDimsReference")
        if record.whole("reference") or measures:
            return "a reference dimension, which only measures"
        relaxed = group is not None and group.whole("relaxConstraints") and kind != _COINCIDENT
        return "its group is relaxed, so it is not enforced" if relaxed else ""

    def is_whole_circle(self, arc: Record) -> bool:
        """Is an arc made a whole circle, its ends by a constraint of its group in one place?"""
        ends = frozenset((arc.handle("point[1].v"), arc.handle("point[2].v")))
        return not self._joined.isdisjoint({(ends, 0), (ends, self.file.group_of(arc.handle()))})

    @cached_property
    def _joined(self) -> set[tuple[frozenset[int], int]]:
        """The points that constraints put in one place, by the group of each constraint."""
        together = [c for c in self.file.constraints.values() if c.whole("type") == _COINCIDENT]
        return {(frozenset((c.handle("ptA.v"), c.handle("ptB.v"))), c.handle("group.v")) for c in together}

    def mentioned(self, record: Record) -> list[int]:
        """The handles of what a constraint mentions."""
        return [handle for key in _MENTIONS if (handle := record.handle(f"{key}.v"))]

    def _rest(self) -> None:
        """What of the file no constraint holds, or is derived and not read."""
        if len({c.handle("group.v") for c in self.file.constraints.values()}) > 1:
            self.draft.leave_out(
                "the order of the groups: all constraints are enforced at once, whereas SolveSpace keeps earlier "
                "groups as they were solved"
            )
        if any(is_own(h) and e.whole("type") in (CUBIC, CUBIC_RING) for h, e in self.file.entities.items()):
            self.draft.leave_out("cubic curves: only their points and the tangents at their ends are read")
        drawn = {h for h, g in self.file.groups.items() if g.whole("type") in (IN_SPACE, IN_PLANE)}
        groups = [g.values.get("name", "") for h, g in self.file.groups.items() if h not in drawn | self._derived()]
        if groups:
            self.draft.leave_out(f"{listed(groups)}: groups that are derived from sketches")
