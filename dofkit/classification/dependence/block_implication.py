"""What the rows of one block imply of each other: near the reference, or wherever the others are satisfied.

Rows that are dependent at a point are no relations of which one follows from the others. Three points on a line: the
first two distances give the third to first order, but not beside it. A form with a coefficient that is 0 on the set is
another form at its points: where y = 0, dx - y dz is dx. So a row's support is asked whether it implies the row, and
else takes up more of the independent rows, those first that share a coordinate with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from dofkit.base.deadline import check
from dofkit.classification.dependence.implication import follows
from dofkit.configuration.implied_relations import ImpliedRelations
from dofkit.exact.matrices.sparse import echelon
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of, linear, make_chart, presolve
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.relations.setting import Setting

#: Rows that are taken into all questions about one block; what is undecided then stays so.
WORK = 1500


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

    def adjacent_rows(self, rows: Iterable[int]) -> set[int]:
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
        """Return whether a linear relation is a combination of others over Q; None if not all are linear."""
        pieces = [self.block.rows[i].piece for i in (*others, row)]
        relations = [p.expr for p in pieces if isinstance(p, Finite) and linear(p.expr) is not None]
        return len(others) in presolve(relations).superfluous if len(relations) == len(pieces) else None


class NearDrawing(BlockImplication):
    """Of finite relations that hold at the reference: what they imply near it. The others are independent there."""

    @cached_property
    def _relations(self) -> ImpliedRelations:
        return ImpliedRelations(make_chart(self.block, self.setting), self.setting, self.setting.reference or {})

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a relation that is dependent at the reference vanishes near it where the others do."""
        answer = self.linearly(row, others)
        return self._relations.follows(row, others) if answer is None else answer

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """Return whether it vanishes to some order near the reference."""
        answer = self.linearly(row, others)
        return bool(self._relations.follows(row, others, False) if answer is None else answer)

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Those with a multiplier that is not 0 all along a curve of the set."""
        return self._relations.needed(row, others)

    def imply(self, others: Sequence[int], rows: Sequence[int], a: Answer) -> bool:
        """Return whether some relations imply others near the reference, by those that are independent there."""
        result = echelon([a.matrix[i] for i in others], a.modulus).independent
        pivots = [others[k] for k in result]
        return all(self.follows(i, pivots) for i in rows)

    def seem_to_imply(self, others: Sequence[int], rows: Sequence[int]) -> bool:
        """Return whether others are satisfied at all sampled points near the reference at which some relations are."""
        return self._relations.seem_to_follow(rows, others)

    def is_orbit(self, rows: Sequence[int], dof: int | None) -> bool:
        """Return whether the set of ``dof`` dimensions that some relations leave is an orbit near the reference.

        It is a union of orbits of the whole, finitely many of that dimension, and all of them pass through the drawing.
        """
        return dof is not None and self._relations.rigid(rows) == dof


class Everywhere(BlockImplication):
    """Of any rows: what holds at every state of motion that the others leave, on all parts of their set."""

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether what a row says is satisfied wherever the others are.

        A row that depends on others at a generic point follows there, where no other row shares a coordinate with them.
        """
        answer = self.linearly(row, others)
        if answer is not None:
            return answer
        if self.adjacent_rows([row, *others]) <= {row, *others}:
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
    """Return whether all rows are finite, and were answered at the reference."""
    return setting.reference is not None and a.instantaneous is not None and len(block.finite) == len(block.rows)


@dataclass
class SufficientSets:
    """The ``pivots``, independent rows that others depend on, each of the constraint ``owners`` tells."""

    implication: NearDrawing | Everywhere
    owners: Sequence[int]
    pivots: Sequence[int]
    _asked: int = 0

    def enough(self, row: int, support: Sequence[int]) -> list[int] | None:
        """Pivots of which the row follows: its support where that is enough; else the rows of a minimal set of
        constraints, written before it where such are enough. None where no such set was found.
        """
        if self._ask(support) and self.implication.follows(row, support):
            return list(support)
        before = [i for i in self.pivots if self.owners[i] <= self.owners[row]]
        for among in (before, self.pivots):
            grown = self._grown(row, support, among)
            if grown is None:
                continue
            fewer = self.implication.needed(row, grown)
            if len(fewer) < len(grown) and self._ask(fewer) and self.implication.follows(row, fewer):
                return sorted(fewer)
            fewer = self._fewest(row, grown, fewer)
            return fewer if self._ask(fewer) and self.implication.follows(row, fewer) else None
        return None

    def _ask(self, rows: Sequence[int]) -> bool:
        """Return whether one more question about so many rows may be asked."""
        check()
        self._asked += len(rows) + 1
        return self._asked <= WORK

    def _grown(self, row: int, support: Sequence[int], among: Sequence[int]) -> list[int] | None:
        """The support with the rows around it, as far as it takes to imply the row; None where that is never enough.

        First those of its own bodies, then those that share coordinates with them, and so on.
        """
        grown = set(support)
        near = self.implication.within([row, *grown])
        if near.intersection(among) <= grown:
            near = self.implication.adjacent_rows([row, *grown])
        while True:
            more = {i for i in among if i in near} | grown
            if more == grown or not self._ask(sorted(more)):
                return None
            grown = more
            if self.implication.seems(row, sorted(grown)):
                return sorted(grown)
            near = self.implication.adjacent_rows([row, *grown])

    def _fewest(self, row: int, rows: Sequence[int], needed: Sequence[int]) -> list[int]:
        """Rows of which the row follows, less those of constraints without which it does too, the last written first.

        Those ``needed`` stay. Constraints are left out by halves of the list, quarters, and so on down to single ones.
        """
        kept, staying = list(rows), {self.owners[i] for i in (row, *needed)}
        spare = sorted({self.owners[i] for i in rows} - staying)
        size = max(1, len(spare) // 2)
        while spare:
            remaining = list[int]()
            for end in range(len(spare), 0, -size):
                some = spare[max(0, end - size) : end]
                fewer = [i for i in kept if self.owners[i] not in some]
                if self._ask(fewer) and self.implication.seems(row, fewer):
                    kept = fewer
                else:
                    remaining = [*some, *remaining]
            if size == 1:
                break
            spare, size = remaining, max(1, size // 2)
        return kept
