"""Searches for minimal sufficient sets and largest redundant sets, given a function (oracle) that tests one set.

The oracle is a rank, an implication or a proof of a contradiction. It has to be monotone: every set larger than a
sufficient one is sufficient, and every subset of a redundant set is redundant.

Rows of a block that are dependent at a point need not imply each other. For three points on a line the differential of
the third distance depends on the other two, but these do not imply the distance nearby. A form with a coefficient that
is 0 on the set is another form there: where y = 0, dx - y dz is dx. So `SufficientSets` tests whether a row's support
implies the row, and otherwise searches among all independent rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple, TypeVar

from dofkit.base.deadline import check
from dofkit.classification.dependence.implication import Everywhere
from dofkit.classification.dependence.near_reference import NearReference

T = TypeVar("T")


def minimal_set(members: Sequence[T], suffices: Callable[[list[T]], object], chunk: int = 1) -> list[T]:
    """Return a minimal subset of ``members`` that suffices, by leaving out members, the last ones first.

    ``chunk``: the number that is left out at once at first, then half as many, down to single ones (deletion filter).
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
    """The largest set that can be left out, and the members for which it is undecided whether they can be."""

    members: list[int]
    undecided: list[int]


def largest_redundant_set(
    members: Iterable[int], is_redundant: Callable[[Sequence[int]], bool | None], exchange: bool = False
) -> RedundantSet:
    """Return a largest redundant set, of several one with the first of ``members``.

    ``exchange``: redundant sets have the exchange property of a matroid, so that the greedy search is sufficient;
    otherwise all larger sets are tested as well.
    """
    single, redundant, undecided = list[int](), list[int](), list[int]()
    for member in members:
        alone = is_redundant([member])
        together = is_redundant([*redundant, member]) if alone and redundant else alone
        single += [member] if alone else []
        redundant += [member] if together else []
        undecided += [member] if together is None else []
    while len(redundant) < len(single) and not exchange:
        tested = ((choice, is_redundant(choice)) for choice in combinations(single, len(redundant) + 1))
        larger, answer = next(((choice, answer) for choice, answer in tested if answer is not False), ((), False))
        if not answer:
            undecided += larger
            break
        redundant = list(larger)
    return RedundantSet(sorted(redundant), sorted(set(undecided) - set(redundant)))


#: Bound on the premises in all tests of one block; later tests fail.
WORK = 1500


@dataclass
class SufficientSets:
    """Searches for sets of rows that imply a row; ``pivots`` are independent rows, ``owners`` the rows' constraints."""

    implication: NearReference | Everywhere
    owners: Sequence[int]
    pivots: Sequence[int]
    _work: int = 0

    def enough(self, row: int, support: Sequence[int]) -> list[int] | None:
        """Return pivots that imply the row: its support, or the rows of a minimal set of constraints; None if none.

        The set is searched among constraints written before the row first.
        """
        if self._within_work(support) and self.implication.follows(row, support):
            return list(support)
        before = [i for i in self.pivots if self.owners[i] <= self.owners[row]]
        for among in (before, self.pivots):
            if not self._within_work(among) or not self.implication.seems(row, among):
                continue
            fewer = self.implication.needed(row, among)
            if len(fewer) < len(among) and self._within_work(fewer) and self.implication.follows(row, fewer):
                return sorted(fewer)
            fewer = self._fewest(row, among, fewer)
            return fewer if self._within_work(fewer) and self.implication.follows(row, fewer) else None
        return None

    def _within_work(self, premises: Sequence[int]) -> bool:
        """Count one more test with these premises, and return whether it is within `WORK`."""
        check()
        self._work += len(premises)
        return self._work <= WORK

    def _fewest(self, row: int, rows: Sequence[int], needed: Sequence[int]) -> list[int]:
        """Return the rows of a minimal set of constraints that seem to imply a row, with those of ``needed`` rows."""
        kept = {self.owners[i] for i in (row, *needed)}
        spare = sorted({self.owners[i] for i in rows} - kept)

        def rows_of(owners: Sequence[int]) -> list[int]:
            return [i for i in rows if self.owners[i] in kept or self.owners[i] in owners]

        def suffice(owners: Sequence[int]) -> bool:
            fewer = rows_of(owners)
            return self._within_work(fewer) and self.implication.seems(row, fewer)

        return rows_of(minimal_set(spare, suffice, len(spare) // 2 or 1))
