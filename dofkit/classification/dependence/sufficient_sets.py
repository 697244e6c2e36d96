"""From dependent rows to relations that imply: sets of rows that are enlarged until what depends on them follows.

Rows that are dependent at a point are no relations of which one follows from the others. Three points on a line: the
first two distances give the third to first order, but not beside it. A form with a coefficient that is 0 on the set is
another form at its points: there y = 0 makes a multiple of dx of dx - y dz. So a row's support is asked whether it implies
the row, and else takes up more of the independent rows, those first that share a coordinate with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from dofkit.base.deadline import check


class Implication(Protocol):
    """What the rows of a block imply of each other, by their numbers."""

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Does what ``row`` says follow from what others say? None where it was not decided."""

    def beside(self, rows: Iterable[int]) -> set[int]:
        """The rows that share a coordinate with some rows, those among them."""


@dataclass(frozen=True)
class SufficientSets:
    """The ``pivots``, independent rows that others depend on, each of the constraint ``owners`` tells."""

    implication: Implication
    owners: Sequence[int]
    pivots: Sequence[int]

    def enough(self, row: int, support: Sequence[int]) -> list[int] | None:
        """Pivots of which the row follows: its support where that is enough; else the rows of a minimal set of
        constraints, written before it where such are enough. None where no such set was found.
        """
        if self.implication.follows(row, support):
            return list(support)
        before = [i for i in self.pivots if self.owners[i] <= self.owners[row]]
        for among in (before, self.pivots):
            grown = self._grown(row, support, among)
            if grown is not None:
                return self.fewest(row, grown)
        return None

    def _grown(self, row: int, support: Sequence[int], among: Sequence[int]) -> list[int] | None:
        """The support with the rows around it, as far as it takes to imply the row; None where that is never enough."""
        grown = set(support)
        while True:
            check()
            near = self.implication.beside([row, *grown])
            more = {i for i in among if i in near} | grown
            if more == grown:
                return None
            grown = more
            if self.implication.follows(row, sorted(grown)):
                return sorted(grown)

    def fewest(self, row: int, rows: Sequence[int]) -> list[int]:
        """Rows of which the row follows, less those of constraints without which it does too, the last written first."""
        kept = list(rows)
        for owner in sorted({self.owners[i] for i in rows} - {self.owners[row]}, reverse=True):
            check()
            fewer = [i for i in kept if self.owners[i] != owner]
            if self.implication.follows(row, fewer):
                kept = fewer
        return kept
