"""Rows of joints at the drawing over the coordinates of a system, from their geometry alone: no relation is written."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from dofkit.exact.matrices.sparse import SparseRow
from dofkit.expressions.tree import Expr
from dofkit.mobility.placement import Placement, drawn_placement
from dofkit.mobility.twists import Located, rows_of
from dofkit.relations.setting import NamedRows
from dofkit.system import Connection, System


@dataclass(frozen=True)
class RowsAtDrawing:
    """The rows of a system's constraints; its drawing is turned into numbers once, where it is asked for.

    The columns of a body are those of its twist: w is twice the rate of a Gibbs vector that is 0, and the rate of an
    angle of the plane. So the rows depend on each other, and on columns, as those of the relations do.
    """

    system: System
    positive: frozenset[Expr]

    @cached_property
    def _joints(self) -> tuple[Connection, ...]:
        """Those that are told here: joints drawn in full, whose motion nothing prescribes."""
        return tuple(c for c in self.system.connections if self._is_plain(c))

    @cached_property
    def _placement(self) -> Placement | None:
        return drawn_placement(replace(self.system, connections=self._joints), self.positive)

    @cached_property
    def _located(self) -> dict[int, Located]:
        """The joints with numbers, by constraint."""
        located = () if self._placement is None else self._placement.located
        return {c.constraint: at for c, at in zip(self._joints, located, strict=True)} if located else {}

    @cached_property
    def _turned_by_euler(self) -> frozenset[str]:
        return frozenset(r.body for r in self.system.rotations if r.chart == "euler")

    def of(self, constraints: Iterable[int]) -> NamedRows | None:
        """The rows of constraints by the names of coordinates; None where not all of them are such joints."""
        if self._placement is None:
            return None
        names = [q.name for q in self.system.coordinates]
        p, found = self._placement.p, list[dict[str, int]]()
        for i in constraints:
            own = self._rows(i, p)
            if own is None:
                return None
            found += [{names[c]: v for c, v in row.items()} for row in own]
        return NamedRows(found, p)

    def _is_plain(self, c: Connection) -> bool:
        facts = c.facts
        plain = facts.placed and facts.joint and c.number is None and not c.driven and not facts.bars and not c.points
        given = all(vector is not None for vector in (*c.places, *c.directions))
        return plain and given and self._turned_by_euler.isdisjoint(c.members)

    def _rows(self, number: int, p: int) -> list[SparseRow] | None:
        at = self._located.get(number)
        if at is None:
            return None
        rows = rows_of(at) or []
        short = [{k: int(v % p) for k, v in row.items() if v % p} for row in rows]
        return short if len(rows) == len(self.system.constraints[number].relations) else None
