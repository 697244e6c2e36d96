"""What the rows of one block imply of each other: near the drawing, or wherever the others hold."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from dofkit.classification.dependence.implication import follows
from dofkit.configuration.implied_relations import ImpliedRelations
from dofkit.exact.matrices.sparse import echelon
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.linear import linear, presolve
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.relations.setting import Setting


@dataclass(frozen=True)
class BlockImplication:
    """The rows of a block, and which of them share coordinates."""

    block: Block
    setting: Setting

    @cached_property
    def _coordinates(self) -> list[frozenset[str]]:
        return [coordinates_of(r.piece) for r in self.block.rows]

    @cached_property
    def _users(self) -> dict[str, set[int]]:
        users: dict[str, set[int]] = {}
        for i, names in enumerate(self._coordinates):
            for name in names:
                users.setdefault(name, set()).add(i)
        return users

    def beside(self, rows: Iterable[int]) -> set[int]:
        """The rows that share a coordinate with some rows, those among them."""
        named = frozenset[str]().union(*(self._coordinates[i] for i in rows))
        return set[int]().union(*(self._users[name] for name in named))

    def within(self, rows: Iterable[int]) -> set[int]:
        """The rows that mention no other bodies and particles than some rows do, those among them."""
        held = frozenset[str]().union(*(self._owners[i] for i in rows))
        return {i for i, owners in enumerate(self._owners) if owners <= held}

    @cached_property
    def _owners(self) -> list[frozenset[str]]:
        """Whose coordinates each row mentions: a body's, a particle's, or those that are nobody's."""
        whose = {c.name: f"of {c.owner}" for c in self.setting.roles if c.owner is not None}
        return [frozenset(whose.get(name, name) for name in names) for names in self._coordinates]

    def linearly(self, row: int, others: Sequence[int]) -> bool | None:
        """Is a linear relation a sum of others, by elimination over the rationals? None where not all are linear."""
        pieces = [self.block.rows[i].piece for i in (*others, row)]
        relations = [p.expr for p in pieces if isinstance(p, Finite) and linear(p.expr) is not None]
        return len(others) in presolve(relations).superfluous if len(relations) == len(pieces) else None


class NearDrawing(BlockImplication):
    """Of finite relations that hold at the drawing: what they imply near it. The others are independent there."""

    @cached_property
    def _relations(self) -> ImpliedRelations:
        return ImpliedRelations(make_chart(self.block, self.setting), self.setting, self.setting.reference or {})

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Does a relation that is dependent at the drawing vanish near it where the others do?"""
        told = self.linearly(row, others)
        return self._relations.follows(row, others) if told is None else told

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """Does it vanish to some order near the drawing?"""
        told = self.linearly(row, others)
        return bool(self._relations.follows(row, others, False) if told is None else told)

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Those with a multiplier that is not 0 all along a curve of the set."""
        return self._relations.needed(row, others)

    def imply(self, others: Sequence[int], rows: Sequence[int], a: Answer) -> bool:
        """Do some relations imply others near the drawing, as far as those that are independent there tell?"""
        found = echelon([a.matrix[i] for i in others], a.modulus).independent
        pivots = [others[k] for k in found]
        return all(self.follows(i, pivots) for i in rows)

    def seem_to_imply(self, others: Sequence[int], rows: Sequence[int]) -> bool:
        """Do others hold at all points that are found near the drawing where some relations do?"""
        return self._relations.seem_to_follow(rows, others)

    def is_orbit(self, rows: Sequence[int], dof: int | None) -> bool:
        """Is the set that some relations leave of ``dof`` dimensions one of motions of the whole, near the drawing?

        It is a union of orbits of the whole, finitely many of that dimension, and all of them pass through the drawing.
        """
        return dof is not None and self._relations.rigid(rows) == dof


class Everywhere(BlockImplication):
    """Of any rows: what holds at every state of motion that the others leave, on all parts of their set."""

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Does what a row says hold wherever the others do?

        A row that depends on others at a generic point follows there, where no other row shares a coordinate with them.
        """
        told = self.linearly(row, others)
        if told is not None:
            return told
        if self.beside([row, *others]) <= {row, *others}:
            return True
        return follows(_alone(self.block.rows[row]), [_alone(self.block.rows[i]) for i in others], self.setting)

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """The same: there is no shorter way."""
        return self.follows(row, others) is True

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """All: which are needed is not seen at once."""
        del row
        return list(others)


def _alone(row: Row) -> Normal:
    return Normal(((row.piece,),))


def implication_of(block: Block, a: Answer, setting: Setting) -> NearDrawing | Everywhere:
    """By what the block was answered: its drawing, or generic points."""
    return NearDrawing(block, setting) if is_drawn(block, a, setting) else Everywhere(block, setting)


def is_drawn(block: Block, a: Answer, setting: Setting) -> bool:
    """Are all rows finite, and were they answered at the drawing?"""
    return setting.reference is not None and a.instantaneous is not None and len(block.finite) == len(block.rows)
