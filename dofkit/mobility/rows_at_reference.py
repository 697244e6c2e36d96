"""Rows of joints over GF(p) at the reference configuration, without a program for their equations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from dofkit.exact.matrices.sparse import SparseRow
from dofkit.expressions.tree import Expr
from dofkit.mobility.placement import Located, Placement, reference_placement, rows_of
from dofkit.relations.setting import NamedRows
from dofkit.system import Connection, System


@dataclass(frozen=True)
class RowsAtReference:
    """The rows of joints at the reference configuration, computed from their geometry without writing equations.

    The columns of a body are those of its twist: w is twice the rate of a Gibbs vector that is 0, or the rate of an
    angle in the plane. So the rows have the same dependences as those of the relations.
    """

    system: System
    positive: frozenset[Expr]

    @cached_property
    def _joints(self) -> tuple[Connection, ...]:
        """The undriven joints with complete geometry."""
        return tuple(c for c in self.system.connections if self._is_plain(c))

    @cached_property
    def _placement(self) -> Placement | None:
        return reference_placement(replace(self.system, connections=self._joints), self.positive)

    @cached_property
    def _located(self) -> dict[int, Located]:
        """The joints with numbers, by constraint."""
        located = () if self._placement is None else self._placement.located
        return {c.constraint: at for c, at in zip(self._joints, located, strict=True)} if located else {}

    @cached_property
    def _turned_by_euler(self) -> frozenset[str]:
        return frozenset(r.body for r in self.system.rotations if r.chart == "euler")

    def rows_of_joints(self, constraints: Iterable[int]) -> NamedRows | None:
        """Return rows modulo p at the reference; None if a constraint is not an undriven joint with given geometry."""
        if self._placement is None:
            return None
        names = [q.name for q in self.system.coordinates]
        p, named = self._placement.p, list[dict[str, int]]()
        for i in constraints:
            rows = self._rows(i, p)
            if rows is None:
                return None
            named += [{names[c]: v for c, v in row.items()} for row in rows]
        return NamedRows(named, p)

    def _is_plain(self, c: Connection) -> bool:
        """Return whether a connection is an undriven joint with complete geometry, of bodies without Euler angles."""
        facts = c.facts
        plain = facts.placed and facts.joint and c.number is None and not c.driven and not facts.bars and not c.points
        complete = all(vector is not None for vector in (*c.places, *c.directions))
        return plain and complete and self._turned_by_euler.isdisjoint(c.members)

    def _rows(self, number: int, p: int) -> list[SparseRow] | None:
        """Return a joint's rows, without zeros modulo p; None if there is not one for each of its relations."""
        at = self._located.get(number)
        if at is None:
            return None
        rows = rows_of(at) or []
        short = [{k: int(v % p) for k, v in row.items() if v % p} for row in rows]
        return short if len(rows) == len(self.system.constraints[number].relations) else None
