"""Bodies in space that share joints: what they prove about ranks in general position."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

from dofkit.mobility.graph.core import Core, core_of
from dofkit.mobility.graph.decompose import decompose
from dofkit.mobility.graph.rigid_bodies import bodies_of, fixed_pairs

Pairs = Iterable[tuple[int, int]]


def bodies_of_core(core: Core) -> list[list[int]]:
    """The maximal sets of joints that keep all their distances in random motions of a core."""
    joints = list(core.joints)
    if core.motions is None:
        return [sorted(joints)]
    return [[joints[k] for k in body] for body in bodies_of(fixed_pairs(core.at, core.motions, core.p))]


def full(joints: int) -> int:
    """The rank of all links between some joints in space: 3n - 6 from three joints on, 1 for two."""
    return 3 * joints - 6 if joints > 2 else joints - 1


def hinged_bound(bodies: Sequence[Sequence[int]]) -> int:
    """A bound on the rank of links in general position, each of them in one of the bodies.

    r <= r(H) + sum of (3|X| - 6 - r(H in X)) over bodies X, for the pairs H of joints that two of them share: by
    submodularity [Whitney1935], once all pairs of every body are linked. The double banana: 1 + 8 + 8 = 17.
    """
    hinges = {pair for x, y in combinations(map(frozenset, bodies), 2) if len(pair := x & y) == 2}
    bound = len(hinges)
    for body in bodies:
        own = [pair for pair in hinges if pair.issubset(body)]
        bound += full(len(body)) - rank_at_least(_sorted(own))
    return bound


def rigid_by_count(bodies: Sequence[Sequence[int]], links: Pairs) -> bool:
    """Is every body rigid by its own links, and by pairs that it shares with bodies that are?"""
    sure = set(_sorted(links))
    open_bodies = [set(body) for body in bodies]
    while open_bodies:
        proved = []
        for body in open_bodies:
            own = [pair for pair in sure if body.issuperset(pair)]
            if rank_at_least(_sorted(own)) == full(len(body)):
                proved.append(body)
        if not proved:
            return False
        open_bodies = [body for body in open_bodies if body not in proved]
        for body, other in ((body, other) for body in proved for other in open_bodies):
            if len(body & other) == 2:
                sure.update(_sorted([body & other]))
    return True


def _sorted(pairs: Iterable[Iterable[int]]) -> list[tuple[int, int]]:
    return sorted({(min(pair), max(pair)) for pair in map(tuple, pairs)})


def rank_at_least(pairs: Sequence[tuple[int, int]]) -> int:
    """The rank of links of different pairs at a point modulo a prime: in general position it is no less."""
    piece = decompose(range(len(pairs)), pairs)
    return len(pairs) - sum(len(core_of(core, pairs, "rank").circuits) for core in piece.cores())
