"""All circuits of a large rigid group in the plane at once, 64 in one pass over the links.

The independent links of a group are isostatic: on them three pebbles are free. For each redundant link they are taken
to its ends, along a way that knows how far they are, and the circuit is what the ends reach then. The ways differ
between redundant links in few places only, so one bit of a word is one redundant link.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heappop, heappush
from typing import Any, NamedTuple

from dofkit.base.libraries import np
from dofkit.mobility.graph.pebbles import FREE

#: Circuits in one word.
WORD = 64


class Rooted(NamedTuple):
    """An isostatic set of links, its joints numbered from 0: ``out`` as of a `Board`, three places of it free.

    ``far``: for each joint that has a free pebble how many links lead there from every joint; ``ends`` of the links.
    """

    out: list[int]
    far: dict[int, list[int]]
    ends: list[tuple[int, int]]


def rooted(out: list[int], ends: list[tuple[int, int]]) -> Rooted:
    """With the distances from the pebbles that are free now."""
    into: list[list[int]] = [[] for _ in range(len(out) // 2)]
    for place, w in enumerate(out):
        if w >= 0:
            into[w].append(place >> 1)
    roots = dict.fromkeys(place >> 1 for place, w in enumerate(out) if w == FREE)
    return Rooted(out, {root: _distances(root, into) for root in roots}, ends)


def _distances(root: int, into: Sequence[Sequence[int]]) -> list[int]:
    far = [-1] * len(into)
    far[root] = 0
    reached = [root]
    for v in reached:
        for w in into[v]:
            if far[w] < 0:
                far[w] = far[v] + 1
                reached.append(w)
    return far


def circuits(group: Rooted, redundant: Sequence[tuple[int, int]]) -> Iterator[list[int]]:
    """For each pair of joints the links that fix their distance, ascending."""
    for first in range(0, len(redundant), WORD):
        yield from _word(group, redundant[first : first + WORD])


def _word(group: Rooted, pairs: Sequence[tuple[int, int]]) -> Iterator[list[int]]:
    """Up to 64 circuits: what every pair reaches, bit by bit."""
    out = np.array(group.out, dtype=np.int64)
    tails, heads = np.arange(len(out)) >> 1, np.where(out < 0, 0, out)
    allowed = np.where(out < 0, 0, np.uint64(2**64 - 1)).astype(np.uint64)
    words = np.zeros(len(out) // 2, dtype=np.uint64)
    more: list[tuple[int, int, int]] = []
    for k, (a, b) in enumerate(pairs):
        bit = np.uint64(1 << k)
        words[a] |= bit
        words[b] |= bit
        for place, (was, now) in _moved(group, a, b).items():
            if was >= 0:
                allowed[place] &= ~bit
            if now >= 0:
                more.append((place >> 1, now, 1 << k))
    if more:
        tails = np.concatenate([tails, [m[0] for m in more]])
        heads = np.concatenate([heads, [m[1] for m in more]])
        allowed = np.concatenate([allowed, np.array([m[2] for m in more], dtype=np.uint64)])
    _spread(words, tails, heads, allowed)
    first, second = np.array(group.ends, dtype=np.int64).reshape(-1, 2).T
    both = words[first] & words[second]
    for k in range(len(pairs)):
        yield np.flatnonzero(both & np.uint64(1 << k)).tolist()


def _spread(words: Any, tails: Any, heads: Any, allowed: Any) -> None:
    """Every joint gets the bits of those that lead to it, until nothing changes."""
    order = np.argsort(heads, kind="stable")
    tails, heads, allowed = tails[order], heads[order], allowed[order]
    targets, starts = np.unique(heads, return_index=True)
    while True:
        had = words[targets]
        has = had | np.bitwise_or.reduceat(words[tails] & allowed, starts)
        if np.array_equal(had, has):
            return
        words[targets] = has


def _moved(group: Rooted, a: int, b: int) -> dict[int, tuple[int, int]]:
    """The places that differ once both pebbles of a and one of b are free: what they held and what they hold then."""
    out = group.out
    before: dict[int, int] = {}
    for root, held in ((a, a), (a, a), (b, a)):
        free = (out[2 * root] < 0) + (out[2 * root + 1] < 0)
        if free >= (2 if root == a else 1):
            continue
        place, via = _nearest(group, root, held)
        v = place >> 1
        while v != root:
            earlier = via[v]
            before.setdefault(place, out[place])
            out[place] = earlier >> 1
            place, v = earlier, earlier >> 1
        before.setdefault(place, out[place])
        out[place] = FREE
    found = {place: (was, out[place]) for place, was in before.items() if was != out[place]}
    for place, was in before.items():
        out[place] = was
    return found


def _nearest(group: Rooted, root: int, held: int) -> tuple[int, dict[int, int]]:
    """A free pebble that ``root`` can have, ``held`` keeping its own, and the places by which joints were reached."""
    out = group.out
    free = [v for v in group.far if v not in (root, held) and (out[2 * v] < 0 or out[2 * v + 1] < 0)]
    far = group.far[free[0]] if free else [0] * (len(out) // 2)
    via = {root: FREE, held: FREE}
    heap = [(far[root], root)]
    while heap:
        _, v = heappop(heap)
        for place in (2 * v, 2 * v + 1):
            w = out[place]
            if w < 0 or w in via:
                continue
            via[w] = place
            if out[2 * w] < 0:
                return 2 * w, via
            if out[2 * w + 1] < 0:
                return 2 * w + 1, via
            heappush(heap, (far[w], w))
    raise ArithmeticError("three pebbles can always be gathered on an isostatic set of links")
