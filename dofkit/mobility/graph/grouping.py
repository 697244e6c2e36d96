"""Numbers gathered by what they have in common."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any


def places_by_label(labels: Sequence[int]) -> list[list[int]]:
    """The places of each label, in the order in which the labels first occur.

    >>> places_by_label([5, 3, 5])
    [[0, 2], [1]]
    """
    found: dict[int, list[int]] = {}
    for place, label in enumerate(labels):
        found.setdefault(label, []).append(place)
    return list(found.values())


def ascending(numbers: Any) -> list[int]:
    """Integers of a list or an array, sorted, as a list."""
    if isinstance(numbers, list):
        return sorted(numbers)
    numbers.sort()
    found: list[int] = numbers.tolist()
    return found


def components(sets: Iterable[Sequence[int]]) -> list[list[int]]:
    """Sets that share a member are one; members ascending, sets by their first.

    >>> components([[1, 4], [2, 3], [4, 0]])
    [[0, 1, 4], [2, 3]]
    """
    leader: dict[int, int] = {}
    for members in sets:
        first = _leader(leader, members[0])
        for i in members[1:]:
            leader[_leader(leader, i)] = first
    found: dict[int, list[int]] = {}
    for i in sorted(leader):
        found.setdefault(_leader(leader, i), []).append(i)
    return list(found.values())


def _leader(leader: dict[int, int], i: int) -> int:
    leader.setdefault(i, i)
    while leader[i] != i:
        leader[i] = leader[leader[i]]
        i = leader[i]
    return i
