"""Libraries that are imported when something of them is first used (SPEC 1), and a function that needs none."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import TYPE_CHECKING

import lazy_loader as lazy

__all__ = ["components", "np", "nx"]

if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = lazy.load("networkx"), lazy.load("numpy")


def components(names_of: Iterable[Iterable[Hashable]]) -> list[list[int]]:
    """Return the groups of things that are joined by names in common, by their numbers and in order.

    >>> components([("x", "y"), ("z",), ("y", "u"), ()])
    [[0, 2], [1], [3]]
    """
    leader: list[int] = []
    owner: dict[Hashable, int] = {}

    def led(i: int) -> int:
        while leader[i] != i:
            leader[i] = i = leader[leader[i]]
        return i

    for i, names in enumerate(names_of):
        leader.append(i)
        root = i
        for name in names:
            first_owner = owner.setdefault(name, root)
            if first_owner != root:
                first_owner = led(first_owner)
                root, first_owner = (root, first_owner) if root < first_owner else (first_owner, root)
                leader[first_owner] = root
    groups: dict[int, list[int]] = {}
    for i in range(len(leader)):
        groups.setdefault(led(i), []).append(i)
    return list(groups.values())
