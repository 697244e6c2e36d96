"""The (2,3) pebble game on integer arrays: which links of a plane framework are independent in general position.

Every joint has two pebbles; a link is independent of those before it if and only if all four pebbles of its ends can
be gathered there, and then one of them is spent on it [JacobsHendrickson1997], on [Laman1970]. Where the fourth
cannot be had, the joints that were reached form a rigid block. Its links are then replaced by another tree-like set
that makes the same block rigid, every joint held by the two ends of the link, so that later searches there are short.

Only loops over arrays and numbers, so that the same functions run compiled.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from dofkit.mobility.graph.net import Net

KERNELS = (
    "search", "bring", "gather", "leader", "join", "condense",
    "extend", "play", "spend", "orient", "circuit",
)  # fmt: skip

FREE = -1


class Board(NamedTuple):
    """The pebbles of n joints and where they are.

    ``out[2 v]``, ``out[2 v + 1]``: the joints on the other end of the links that the pebbles of joint v are spent on,
    or FREE; ``link`` the link of each, or one of the same group where it was replaced. ``group``: a forest over links.
    ``seen``, ``via``, ``queue`` belong to the last search; ``clock[0]`` counts searches.
    """

    out: Any
    link: Any
    group: Any
    seen: Any
    via: Any
    queue: Any
    clock: Any


def search(board: Board, root: int, held: int) -> tuple[int, int]:
    """(a free pebble's place reached from ``root`` along links it is not held by, joints reached); -1 for none.

    The pebbles of ``held`` stay. The joints reached stand in ``queue``.
    """
    out, seen, via, queue = board.out, board.seen, board.via, board.queue
    board.clock[0] += 1
    now = board.clock[0]
    seen[root] = now
    seen[held] = now
    queue[0] = root
    first, last = 0, 1
    while first < last:
        v = queue[first]
        first += 1
        for place in range(2 * v, 2 * v + 2):
            w = out[place]
            if w >= 0 and seen[w] != now:
                seen[w] = now
                via[w] = place
                if out[2 * w] < 0:
                    return 2 * w, last
                if out[2 * w + 1] < 0:
                    return 2 * w + 1, last
                queue[last] = w
                last += 1
    return FREE, last


def bring(board: Board, root: int, place: int) -> None:
    """The pebble at ``place`` moves to ``root``: every link on the way is paid for from its other end."""
    out, link, via = board.out, board.link, board.via
    v = place >> 1
    while v != root:
        before = via[v]
        out[place] = before >> 1
        link[place] = link[before]
        place = before
        v = before >> 1
    out[place] = FREE


def gather(board: Board, root: int, held: int) -> tuple[bool, int]:
    """Both pebbles of ``root`` freed, those of ``held`` kept; else (False, joints that the last search reached)."""
    while board.out[2 * root] >= 0 or board.out[2 * root + 1] >= 0:
        place, reached = search(board, root, held)
        if place < 0:
            return False, reached
        bring(board, root, place)
    return True, 0


def leader(group: Any, i: int) -> int:
    """The link that stands for the group of link i."""
    while group[i] != i:
        group[i] = group[group[i]]
        i = group[i]
    return i


def join(group: Any, i: int, j: int) -> int:
    """The groups of two links become one."""
    i, j = leader(group, i), leader(group, j)
    group[j] = i
    return i


def condense(board: Board, a: int, b: int, reached: int, i: int) -> None:
    """The joints in ``queue`` with a and b are a rigid block: each is held by a and b; its links join link i's group.

    ``a`` has both pebbles and b has one.
    """
    out, link, queue = board.out, board.link, board.queue
    for k in range(reached):
        v = queue[k]
        if v == a:
            continue
        for place in range(2 * v, 2 * v + 2):
            if out[place] >= 0:
                i = join(board.group, i, link[place])
                link[place] = i
                out[place] = a
        if v != b:
            out[2 * v + 1] = b


def play(board: Board, net: Net, outer: int, dependent: Any) -> None:
    """``dependent[i] = 1`` for every link i that those before it make superfluous.

    Only among the links left behind ``order[:outer]``; the others are independent of all (0-extension [Henneberg1911]).
    """
    for i in range(len(dependent)):
        if net.gone[i]:
            continue
        a, b = net.ends[2 * i], net.ends[2 * i + 1]
        gather(board, a, a)
        free, reached = gather(board, b, a)
        if free:
            board.out[2 * a] = b
            board.link[2 * a] = i
        else:
            dependent[i] = 1
            condense(board, a, b, reached, i)
    extend(board, net, outer)


def extend(board: Board, net: Net, outer: int) -> None:
    """The joints of ``order[:outer]`` put back, last first: each pays for the links that went with it."""
    for k in range(outer - 1, -1, -1):
        v = net.order[k]
        place = 2 * v
        for p in range(net.start[v], net.start[v + 1]):
            i = net.at[p]
            if net.gone[i] == k + 1:
                board.out[place] = net.ends[2 * i] + net.ends[2 * i + 1] - v
                board.link[place] = i
                place += 1


def orient(board: Board, net: Net, outer: int, dependent: Any) -> None:
    """The independent links themselves on an empty board, each paid for by one pebble of an end."""
    for i in range(len(dependent)):
        if not dependent[i] and not net.gone[i]:
            spend(board, net.ends[2 * i], net.ends[2 * i + 1], i)
    extend(board, net, outer)


def spend(board: Board, a: int, b: int, i: int) -> None:
    """A pebble of a or b is spent on link i; one is brought there where neither has any."""
    out = board.out
    if out[2 * a] >= 0 and out[2 * a + 1] >= 0:
        if out[2 * b] < 0 or out[2 * b + 1] < 0:
            a, b = b, a
        else:
            free, _ = search(board, a, a)
            bring(board, a, free)
    place = 2 * a if out[2 * a] < 0 else 2 * a + 1
    out[place] = b
    board.link[place] = i


def circuit(board: Board, a: int, b: int, found: Any) -> int:
    """The links that already fix the distance of a and b, on a board of `orient`; how many there are.

    With three pebbles at a and b what they reach is closed and tight, and lies in every tight set that holds both.
    """
    out, queue = board.out, board.queue
    gather(board, a, a)
    _, reached = gather(board, b, a)
    number = 0
    for k in range(reached):
        for place in range(2 * queue[k], 2 * queue[k] + 2):
            if out[place] >= 0:
                found[number] = board.link[place]
                number += 1
    return number
