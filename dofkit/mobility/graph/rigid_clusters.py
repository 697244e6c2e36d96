"""The rigid clusters of a plane framework: after the pebble game, do links at a joint turn together?

Two links x-y and x-z turn together if and only if the distance of y and z is fixed: with three pebbles at x and y none
can be had at z. All links of a cluster are found so, because a rigid graph stays connected without a joint. Only
loops over arrays and numbers, so that the same functions run compiled.
"""

from __future__ import annotations

from dofkit.mobility.graph.net import Net
from dofkit.mobility.graph.pebbles import FREE, Board, bring, condense, gather, join, leader, search

KERNELS = (
    "search", "bring", "gather", "leader", "join", "condense",
    "hold", "release", "turn_together", "core_clusters", "outer_clusters",
)  # fmt: skip


def hold(board: Board, x: int, y: int) -> int:
    """Both pebbles at x and one at y, spent on themselves so that none of them moves; the place of y's."""
    out = board.out
    gather(board, x, x)
    while out[2 * y] >= 0 and out[2 * y + 1] >= 0:
        place, _ = search(board, y, x)
        bring(board, y, place)
    place = 2 * y if out[2 * y] < 0 else 2 * y + 1
    out[2 * x] = x
    out[2 * x + 1] = x
    out[place] = y
    return place


def release(board: Board, x: int, place: int) -> None:
    """What `hold` held is free."""
    board.out[2 * x] = FREE
    board.out[2 * x + 1] = FREE
    board.out[place] = FREE


def turn_together(board: Board, x: int, y: int, place: int, z: int, i: int) -> bool:
    """Is z rigid with x and y, whose pebbles are held? Then all that is between joins the group of link i."""
    out = board.out
    if out[2 * z] < 0 or out[2 * z + 1] < 0:
        return False
    free, reached = search(board, z, z)
    if free >= 0:
        bring(board, z, free)
        return False
    release(board, x, place)
    condense(board, x, y, reached, i)
    hold(board, x, y)
    return True


def core_clusters(board: Board, net: Net, first: int) -> None:
    """The links at every joint of ``order[first:]`` compared in pairs, those taken off left out."""
    ends, at, group = net.ends, net.at, board.group
    for k in range(first, len(net.order)):
        x = net.order[k]
        for p in range(net.start[x], net.start[x + 1]):
            i = at[p]
            if net.gone[i]:
                continue
            y, place = -1, -1
            for q in range(p + 1, net.start[x + 1]):
                j = at[q]
                if net.gone[j] or leader(group, i) == leader(group, j):
                    continue
                if place < 0:
                    y = ends[2 * i] + ends[2 * i + 1] - x
                    place = hold(board, x, y)
                z = ends[2 * j] + ends[2 * j + 1] - x
                if turn_together(board, x, y, place, z, i):
                    join(group, i, j)
            if place >= 0:
                release(board, x, place)


def outer_clusters(board: Board, net: Net, first: int) -> None:
    """The joints of ``order[:first]``, last first: both links of one turn together if their other ends do."""
    ends = net.ends
    for k in range(first - 1, -1, -1):
        x = net.order[k]
        y, i = -1, -1
        for p in range(net.start[x], net.start[x + 1]):
            j = net.at[p]
            if net.gone[j] != k + 1:
                continue
            z = ends[2 * j] + ends[2 * j + 1] - x
            if y < 0:
                y, i = z, j
                continue
            gather(board, y, y)
            free, reached = gather(board, z, y)
            if not free:
                condense(board, y, z, reached, i)
                join(board.group, i, j)
