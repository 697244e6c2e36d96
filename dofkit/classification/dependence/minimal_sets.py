"""Sets of constraints by an oracle that tells what a set implies: minimal sets, and largest sets that are redundant.

The oracle is a rank, an implication or a proof of a contradiction; the search is the same for all of them. What a set
suffices for, every larger set suffices for, and what can be left out together can be left out one by one.

Rows of a block that are dependent at a point need not imply each other. Three points on a line: the first two distances
give the third infinitesimally, and not nearby. A form with a coefficient that is 0 on the set is another form at its
points: where y = 0, dx - y dz is dx. So a row's support is asked whether it implies the row, and else all independent
rows are, less those that are not needed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple, TypeVar

from dofkit.base.deadline import check
from dofkit.classification.dependence.implication import Everywhere, NearDrawing

T = TypeVar("T")


def minimal_set(members: Sequence[T], suffices: Callable[[list[T]], object], chunk: int = 1) -> list[T]:
    """Return the members of a set that suffices without those that can be left out, the last left out first.

    ``chunk``: so many are left out at once at first, then half as many, down to single ones (a deletion filter).
    """
    kept = list(members)
    while chunk:
        for end in range(len(kept), 0, -chunk):
            fewer = kept[: max(0, end - chunk)] + kept[end:]
            if suffices(fewer):
                kept = fewer
        chunk //= 2
    return kept


class RedundantSet(NamedTuple):
    """The largest set that can be left out, and the members of which it is undecided whether they can be."""

    members: list[int]
    undecided: list[int]


def largest_redundant_set(
    members: Iterable[int], is_redundant: Callable[[Sequence[int]], bool | None], exchange: bool = False
) -> RedundantSet:
    """Return as many members as can be left out together, of several choices the last ones.

    ``exchange``: no set that cannot be enlarged is smaller than another (a matroid), so none larger is searched.
    """
    single, gone, undecided = list[int](), list[int](), list[int]()
    for member in members:
        alone = is_redundant([member])
        together = is_redundant([*gone, member]) if alone and gone else alone
        single += [member] if alone else []
        gone += [member] if together else []
        undecided += [member] if together is None else []
    while len(gone) < len(single) and not exchange:
        asked = ((choice, is_redundant(choice)) for choice in combinations(single, len(gone) + 1))
        larger, answer = next(((choice, answer) for choice, answer in asked if answer is not False), ((), False))
        if not answer:
            undecided += larger
            break
        gone = list(larger)
    return RedundantSet(sorted(gone), sorted(set(undecided) - set(gone)))


#: Rows that are taken into all questions about one block; what is undecided then stays so.
WORK = 1500


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
            if not self._ask(among) or not self.implication.seems(row, among):
                continue
            fewer = self.implication.needed(row, among)
            if len(fewer) < len(among) and self._ask(fewer) and self.implication.follows(row, fewer):
                return sorted(fewer)
            fewer = self._fewest(row, among, fewer)
            return fewer if self._ask(fewer) and self.implication.follows(row, fewer) else None
        return None

    def _ask(self, rows: Sequence[int]) -> bool:
        """Return whether one more question about so many rows may be asked."""
        check()
        self._asked += len(rows)
        return self._asked <= WORK

    def _fewest(self, row: int, rows: Sequence[int], needed: Sequence[int]) -> list[int]:
        """Rows of which the row follows, less those of constraints without which it does too, the last written first.

        Those ``needed`` stay.
        """
        staying = {self.owners[i] for i in (row, *needed)}
        spare = sorted({self.owners[i] for i in rows} - staying)

        def rows_of(owners: Sequence[int]) -> list[int]:
            return [i for i in rows if self.owners[i] in staying or self.owners[i] in owners]

        def suffice(owners: Sequence[int]) -> bool:
            fewer = rows_of(owners)
            return self._ask(fewer) and self.implication.seems(row, fewer)

        return rows_of(minimal_set(spare, suffice, len(spare) // 2 or 1))
