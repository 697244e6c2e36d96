"""Sets of constraints by an oracle that tells what a set implies: minimal sets, and largest sets that are redundant.

The oracle is a rank, an implication or a proof of a contradiction; the search is the same for all of them. What a set
suffices for, every larger set suffices for, and what can be left out together can be left out one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations
from typing import NamedTuple, TypeVar

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
