"""Implications between geometric equations near a reference, on the manifold of those that are independent there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.preparation import all_of, any_of
from dofkit.configuration.implied_relations import ImpliedRelations
from dofkit.configuration.variety import field_jacobian, point_at
from dofkit.exact.matrices.sparse import echelon, rank_of_rows
from dofkit.exact.zero import odd_constants
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import NOBODY, Block, Row, coordinates_of, make_chart, split
from dofkit.relations.linear_relations import linear, solve_linear
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.relations.setting import Setting


@dataclass(frozen=True)
class BlockImplication:
    """Implications between the rows of a block, which are given by their numbers."""

    block: Block
    setting: Setting

    def linearly(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a linear relation is a combination of others over Q; None if not all of them are linear."""
        pieces = [self.block.rows[i].piece for i in (*others, row)]
        relations = [p.expr for p in pieces if isinstance(p, Finite) and linear(p.expr) is not None]
        return solve_linear(relations[:-1]).implies(relations[-1]) if len(relations) == len(pieces) else None

    def removes_several(self, row: int, others: Sequence[int]) -> bool:
        """Return whether a row may remove several freedoms where independent ``others`` are satisfied.

        With x = 0, x + y^2 + z^2 = 0 removes two more. Fewer rows than the rank may then imply all the others. If the
        freedom is not known, they may do so except near a reference, and except as many rows as coordinates.
        """
        rows = [self.block.rows[i] for i in (*others, row)]
        remaining = freedom(self.block.coordinates, rows, self.setting)
        if remaining is None:
            several = len(frozenset[str]().union(*(coordinates_of(r.piece) for r in rows))) > len(rows)
            return several and self.setting.reference is None
        return remaining < len(self.block.coordinates) - len(rows)


class NearReference(BlockImplication):
    """Implications between geometric equations near a reference that satisfies them; premises must be independent."""

    @cached_property
    def _relations(self) -> ImpliedRelations:
        return ImpliedRelations(make_chart(self.block, self.setting), self.setting.reference or {})

    def are_independent(self, rows: range) -> bool:
        """Return whether some rows are independent at the reference, which has to be a point without odd constants."""
        chart = self._relations.chart
        point = point_at(chart, {**(self.setting.reference or {}), ex.TIME: ex.ZERO}, 3)
        if point is None or odd_constants(chart.ring, named=True):
            return False
        return rank_of_rows([field_jacobian(chart, point)[i] for i in rows], point.p) == len(rows)

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a relation that is dependent at the reference is implied by the others near it, or None."""
        answer = self.linearly(row, others)
        return self._relations.follows(row, others) if answer is None else answer

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """Return whether the relation vanishes to some order near the reference where the others do."""
        answer = self.linearly(row, others)
        return bool(self._relations.follows(row, others, False) if answer is None else answer)

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Return the others whose multiplier in the relation is not 0 all along a curve of the set."""
        return self._relations.needed(row, others)

    def imply(self, others: Sequence[int], rows: Sequence[int], a: Answer) -> bool:
        """Return whether the relations ``others`` (those independent at the reference) imply ``rows`` near it."""
        result = echelon([a.matrix[i] for i in others], a.modulus).independent
        pivots = [others[k] for k in result]
        return all(self.follows(i, pivots) for i in rows)

    def seem_to_imply(self, others: Sequence[int], rows: Sequence[int]) -> bool:
        """Return whether ``rows`` are satisfied at all sampled points near the reference at which ``others`` are."""
        return self._relations.seem_to_follow(rows, others)

    def is_orbit(self, rows: Sequence[int], dof: int | None) -> bool:
        """Return whether the set of some relations, of dimension ``dof``, is an orbit of rigid motions.

        It is a union of orbits; those of this dimension are finitely many, and pass through the reference.
        """
        return dof is not None and self._relations.rigid(rows) == dof


def freedom(coordinates: Sequence[str], rows: Sequence[Row], setting: Setting) -> int | None:
    """Return the freedom of some coordinates with some rows; None if undecided."""
    blocks, untouched = split(coordinates, rows)
    dofs = [answer(block, setting).dof for block in blocks]
    return None if None in dofs else len(untouched) + sum(dof for dof in dofs if dof is not None)


def is_at_reference(block: Block, a: Answer, setting: Setting) -> bool:
    """Return whether all rows are finite and the answer is about the reference configuration."""
    return setting.reference is not None and a.instantaneous is not None and len(block.finite) == len(block.rows)


def implied_near(rows: Sequence[Row], relation: Normal, setting: Setting) -> bool | None:
    """Return whether one of the relation's branches is satisfied near the reference configuration where the rows are.

    None where the rows are not geometric equations that are independent there, or a branch has conditions.
    """
    all_rows = (*rows, *(Row(NOBODY, p) for branch in relation.branches for p in branch))
    if setting.reference is None or not rows or not all(isinstance(row.piece, Finite) for row in all_rows):
        return None
    names = {n for row in all_rows for n in coordinates_of(row.piece)}
    near, premises = NearReference(Block(tuple(sorted(names)), all_rows), setting), range(len(rows))
    if not near.are_independent(premises):
        return None
    numbers = iter(range(len(rows), len(all_rows)))
    return any_of([all_of([near.follows(next(numbers), premises) for _ in branch]) for branch in relation.branches])
