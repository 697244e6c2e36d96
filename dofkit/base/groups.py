"""What belongs together because it shares something."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence


def sharing(entries: Sequence[Iterable[Hashable]]) -> list[list[int]]:
    """The numbers of the entries in groups that share something, also by way of others; in order of their first.

    >>> sharing([{"x", "y"}, {"z"}, {"y", "u"}, ()])
    [[0, 2], [1], [3]]
    """
    above = list(range(len(entries)))

    def first(i: int) -> int:
        while above[i] != i:
            above[i] = above[above[i]]
            i = above[i]
        return i

    owner: dict[Hashable, int] = {}
    for i, shared in enumerate(entries):
        root = i
        for thing in shared:
            other = owner.setdefault(thing, root)
            if other != root:
                other = first(other)
                if other < root:
                    other, root = root, other
                above[other] = root
    groups: dict[int, list[int]] = {}
    for i in range(len(entries)):
        groups.setdefault(first(i), []).append(i)
    return list(groups.values())
