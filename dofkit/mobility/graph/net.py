"""Which links meet at a joint, and joints of few links taken off one after another.

Only loops over arrays and numbers, so that the same functions run compiled.
"""

from __future__ import annotations

from typing import Any, NamedTuple

KERNELS = ("incidence", "removable", "peel", "sweep")


class Net(NamedTuple):
    """Links between joints: ``at[start[v] : start[v + 1]]`` those of joint v; ``ends[2 i]``, ``ends[2 i + 1]``.

    ``degree``: links of a joint that are left; ``order``: joints as they are taken off, then the others so that
    neighbours are near; ``gone``: links taken off with a joint, by its place in ``order`` plus one.
    """

    ends: Any
    start: Any
    at: Any
    degree: Any
    order: Any
    gone: Any


def incidence(ends: Any, left_out: Any, start: Any, at: Any, degree: Any) -> None:
    """Fills ``at[start[v] : start[v + 1]]`` with the links of joint v, ``degree[v]`` of them, all but those marked."""
    for i in range(len(left_out)):
        if not left_out[i]:
            degree[ends[2 * i]] += 1
            degree[ends[2 * i + 1]] += 1
    for v in range(len(degree)):
        start[v + 1] = start[v] + degree[v]
        degree[v] = 0
    for i in range(len(left_out)):
        if not left_out[i]:
            for v in (ends[2 * i], ends[2 * i + 1]):
                at[start[v] + degree[v]] = i
                degree[v] += 1


def removable(net: Net, v: int) -> bool:
    """Do the links left at joint v, two at most, lead to different joints?"""
    other = -1
    for k in range(net.start[v], net.start[v + 1]):
        i = net.at[k]
        if not net.gone[i]:
            w = net.ends[2 * i] + net.ends[2 * i + 1] - v
            if w == other:
                return False
            other = w
    return True


def peel(net: Net) -> int:
    """Takes joints of two links or fewer off one after another; how many. Their links are independent of all others."""
    ends, degree, order, gone = net.ends, net.degree, net.order, net.gone
    last = 0
    for v in range(len(degree)):
        if degree[v] <= 2 and removable(net, v):
            order[last] = v
            last += 1
    first = 0
    while first < last:
        v = order[first]
        first += 1
        for k in range(net.start[v], net.start[v + 1]):
            i = net.at[k]
            if gone[i]:
                continue
            gone[i] = first
            w = ends[2 * i] + ends[2 * i + 1] - v
            degree[w] -= 1
            if degree[w] == 2 and removable(net, w):
                order[last] = w
                last += 1
    return last


def sweep(net: Net, first: int) -> None:
    """The joints that are left behind ``order[:first]``, each after a neighbour where that can be."""
    order, degree = net.order, net.degree
    last = first
    for root in range(len(degree)):
        if degree[root] < 3:
            continue
        order[last] = root
        last += 1
        degree[root] = 0
        while first < last:
            v = order[first]
            first += 1
            for k in range(net.start[v], net.start[v + 1]):
                i = net.at[k]
                w = net.ends[2 * i] + net.ends[2 * i + 1] - v
                if not net.gone[i] and degree[w] >= 3:
                    degree[w] = 0
                    order[last] = w
                    last += 1
