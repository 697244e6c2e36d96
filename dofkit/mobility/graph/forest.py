"""Links along a line on integer arrays: spanning forests. Only loops, so that the same functions run compiled."""

from __future__ import annotations

from typing import Any

KERNELS = ("top", "span", "root", "close")


def top(parent: Any, v: int) -> int:
    """The joint that stands for all that v is joined to."""
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v


def span(parent: Any, ends: Any, dependent: Any) -> None:
    """``dependent[i] = 1`` for every link i that closes a cycle of those before it [Kirchhoff1847]."""
    for i in range(len(dependent)):
        a, b = top(parent, ends[2 * i]), top(parent, ends[2 * i + 1])
        if a == b:
            dependent[i] = 1
        else:
            parent[b] = a


def root(ends: Any, start: Any, at: Any, up: Any, depth: Any, queue: Any) -> None:
    """``up[v]``: the link from joint v towards the root of its tree, -1 at a root; ``depth`` its distance from it."""
    for r in range(len(up)):
        if depth[r] >= 0:
            continue
        depth[r] = 0
        queue[0] = r
        first, last = 0, 1
        while first < last:
            v = queue[first]
            first += 1
            for k in range(start[v], start[v + 1]):
                i = at[k]
                w = ends[2 * i] + ends[2 * i + 1] - v
                if depth[w] < 0:
                    depth[w] = depth[v] + 1
                    up[w] = i
                    queue[last] = w
                    last += 1


def close(ends: Any, dependent: Any, up: Any, depth: Any, group: Any, summit: Any) -> None:
    """``group`` leads from a link to the one that stands for all on common cycles with it: a block of the graph.

    The links of a block that are in the forest form one subtree; ``summit``, of the link that stands for them, is its
    joint next to the root. So from either end of a link that closes a cycle one goes up block by block.
    """
    for v in range(len(up)):
        if up[v] >= 0:
            summit[up[v]] = ends[2 * up[v]] + ends[2 * up[v] + 1] - v
    for i in range(len(dependent)):
        if not dependent[i]:
            continue
        a, b = ends[2 * i], ends[2 * i + 1]
        while a != b:
            if depth[a] < depth[b]:
                a, b = b, a
            mine, other = top(group, i), top(group, up[a])
            a = summit[other]
            if mine != other:
                if summit[mine] < 0 or depth[a] < depth[summit[mine]]:
                    summit[mine] = a
                group[other] = mine
