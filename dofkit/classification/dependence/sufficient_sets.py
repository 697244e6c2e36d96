"""From dependent rows to relations that imply: sets of rows that are enlarged until what depends on them follows.

Rows that are dependent at a point are no relations of which one follows from the others. Three points on a line: the
first two distances give the third to first order, but not beside it. A form with a coefficient that is 0 on the set is
another form at its points: where y = 0, dx - y dz is dx. So a row's support is asked whether it implies the row, and
else takes up more of the independent rows, those first that share a coordinate with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from dofkit.base.deadline import check

#: Rows that are taken into all questions about one block; what is open then is left open.
WORK = 1500


class Implication(Protocol):
    """What the rows of a block imply of each other, by their numbers."""

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Does what ``row`` says follow from what others say? None where it was not decided."""

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """The same, less surely, to search by."""

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Of others from which a row follows those that it needs, as far as that is seen at once."""

    def beside(self, rows: Iterable[int]) -> set[int]:
        """The rows that share a coordinate with some rows, those among them."""

    def within(self, rows: Iterable[int]) -> set[int]:
        """The rows that mention no other bodies and particles than some rows do, those among them."""


@dataclass
class SufficientSets:
    """The ``pivots``, independent rows that others depend on, each of the constraint ``owners`` tells."""

    implication: Implication
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
        """May one more question about so many rows be asked?"""
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
            near = self.implication.beside([row, *grown])
        while True:
            more = {i for i in among if i in near} | grown
            if more == grown or not self._ask(sorted(more)):
                return None
            grown = more
            if self.implication.seems(row, sorted(grown)):
                return sorted(grown)
            near = self.implication.beside([row, *grown])

    def _fewest(self, row: int, rows: Sequence[int], needed: Sequence[int]) -> list[int]:
        """Rows of which the row follows, less those of constraints without which it does too, the last written first.

        Those ``needed`` stay. Constraints are left out by halves of the list, quarters, and so on down to single ones.
        """
        kept, staying = list(rows), {self.owners[i] for i in (row, *needed)}
        spare = sorted({self.owners[i] for i in rows} - staying)
        size = max(1, len(spare) // 2)
        while spare:
            left = list[int]()
            for end in range(len(spare), 0, -size):
                some = spare[max(0, end - size) : end]
                fewer = [i for i in kept if self.owners[i] not in some]
                if self._ask(fewer) and self.implication.seems(row, fewer):
                    kept = fewer
                else:
                    left = [*some, *left]
            if size == 1:
                break
            spare, size = left, max(1, size // 2)
        return kept
