"""Links in space: independence is decided by ranks, because no count does (the double banana satisfies Maxwell's).

The rigidity matrix has a row (p_a - p_b) . (v_a - v_b) for every link a-b. It is eliminated at random positions modulo
a random prime. Links that are independent there are independent in general position, because a nonzero minor is not 0
identically. Dependences there are proved by a count if possible, otherwise they are probable [SchwartzZippel].

Rigid clusters are the maximal sets of joints all of whose distances stay the same in a random motion. In general
position a joint that is fixed to three joints of a cluster belongs to it, so that clusters are the maximal cliques of
fixed pairs, and two clusters share at most two joints.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

from dofkit.base.libraries import nx
from dofkit.exact.matrices.sparse import SparseRow, components, echelon, rank_of_rows, vector_in_kernel
from dofkit.exact.points.field import prime_for
from dofkit.mobility.graph.links import Ends, LinkageError, Proof

#: Bound on the joints of a flexible part that is divided into clusters.
MAX_JOINTS = 2000
_INDEPENDENT = "links are independent in general position where they are at one point modulo a prime"


class SpaceGraph:
    """A graph of links in three dimensions; see `dofkit.mobility.graph.links.LineGraph`."""

    def __init__(self, joints: int, ends: Sequence[Ends]) -> None:
        self._joints, self._ends = joints, ends
        first: dict[frozenset[int], int] = {}
        self._parallel_to: dict[int, int] = {}  # {link: the first link between the same joints}
        for i, pair in enumerate(self._ends):
            original = first.setdefault(frozenset(pair), i)
            if original != i:
                self._parallel_to[i] = original
        self._links = list(first.values())
        self._pairs = [self._ends[i] for i in self._links]

        self._matrix = _matrix(self._pairs)

    @cached_property
    def redundant(self) -> list[int]:
        independent = {self._links[k] for k in echelon(self._matrix.rows, self._matrix.p).independent}
        return [i for i in range(len(self._ends)) if i not in independent]

    @cached_property
    def _circuits(self) -> dict[int, list[int]]:
        """Return {redundant link: the earlier links on which it depends}."""
        if len(self.redundant) == len(self._parallel_to):
            supports: dict[int, tuple[int, ...]] = {}
        else:
            supports = echelon(self._matrix.rows, self._matrix.p, supports=True).supports
        circuits = {self._links[k]: [self._links[j] for j in support] for k, support in supports.items()}
        return circuits | {i: circuits.get(original, [original]) for i, original in self._parallel_to.items()}

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        return ((i, self._circuits[i]) for i in links)

    def groups(self) -> list[list[int]]:
        circuits = [[*circuit, i] for i, circuit in self._circuits.items()]
        return [sorted({i for k in part for i in circuits[k]}) for part in components(circuits)]

    def clusters(self) -> list[list[int]]:
        sets = rigid_sets(self._pairs)
        return sorted([*sets, *([v] for v in set(range(self._joints)).difference(*sets))])

    def proof(self) -> Proof:
        circuits = {i: c for i, c in self._circuits.items() if i not in self._parallel_to}
        uncounted = [i for i, c in circuits.items() if not _is_counted([self._ends[j] for j in (i, *c)])]
        if uncounted:
            chance = chance_of_error(len(uncounted), len(self._ends))
            why = f"{_INDEPENDENT}; some dependences are probable, with a chance of error below {chance:.1e}"
            return Proof("probable", why)
        if not circuits:
            return Proof("proved", _INDEPENDENT)
        return Proof("proved", f"{_INDEPENDENT}, and more than 3n - 6 links on n joints, or hinged bodies, depend")


class _Matrix(NamedTuple):
    """The ``rows`` of a rigidity matrix modulo ``p``, with the joints at random positions ``at``."""

    rows: list[SparseRow]
    p: int
    at: dict[int, list[int]]


def _matrix(pairs: Iterable[Ends]) -> _Matrix:
    """Return the rigidity matrix of links."""
    rng, p, rows = random.Random("dofkit links in space"), prime_for(), list[SparseRow]()
    at: dict[int, list[int]] = {}
    for a, b in pairs:
        for v in (a, b):
            if v not in at:
                at[v] = [rng.randrange(p) for _ in range(3)]
        arm = [(x - y) % p for x, y in zip(at[a], at[b], strict=True)]
        rows.append({3 * v + k: sign * x % p for v, sign in ((a, 1), (b, -1)) for k, x in enumerate(arm)})
    return _Matrix(rows, p, at)


def chance_of_error(dependent: int, links: int) -> float:
    """Return a bound on the probability that some dependence is wrong: each is a minor that is 0 [SchwartzZippel]."""
    return dependent * links / 2**59


def _rank(pairs: Sequence[Ends]) -> int:
    """Return the rank of links between different pairs at a random point, a lower bound of that in general position."""
    matrix = _matrix(pairs)
    return rank_of_rows(matrix.rows, matrix.p)


def _full_rank(joints: int) -> int:
    """Return the rank of all links between some joints."""
    return 3 * joints - 6 if joints > 2 else joints - 1


def rigid_sets(pairs: Sequence[Ends]) -> list[list[int]]:
    """Return the maximal sets of joints that keep their distances in a generic motion; may raise LinkageError.

    ``pairs`` are distinct. Biconnected parts rotate about shared joints, so that each is analysed separately.
    """
    sets: list[list[int]] = []
    for block in nx.biconnected_component_edges(nx.Graph(list(pairs))):
        part = sorted({(min(pair), max(pair)) for pair in block})
        joints = sorted({v for pair in part for v in pair})
        if len(part) >= _full_rank(len(joints)) and _rank(part) == _full_rank(len(joints)):
            sets.append(joints)
        elif len(joints) > MAX_JOINTS:
            raise LinkageError(f"rigid clusters of {len(part)} links in space are too many to separate")
        else:
            sets += map(sorted, nx.find_cliques(nx.Graph(_fixed_pairs(part, joints))))
    return sorted(sets)


def _fixed_pairs(pairs: Sequence[Ends], joints: Sequence[int]) -> list[Ends]:
    """Return the pairs of joints whose distance stays the same in a random motion: (p_i - p_j) . (v_i - v_j) = 0."""
    rows, p, at = _matrix(pairs)
    motion = vector_in_kernel(rows, p, random.Random("dofkit motion in space"))

    def is_fixed(a: int, b: int) -> bool:
        return sum((at[a][k] - at[b][k]) * (motion[3 * a + k] - motion[3 * b + k]) for k in range(3)) % p == 0

    return [(a, b) for a, b in combinations(joints, 2) if is_fixed(a, b)]


def _is_counted(circuit: Sequence[Ends]) -> bool:
    """Return whether a count proves that links are dependent: Maxwell's [Maxwell1864], or that of hinged bodies."""
    joints = {v for pair in circuit for v in pair}
    return len(circuit) > 3 * len(joints) - 6 or len(circuit) > hinged_bound(rigid_sets(circuit))


def hinged_bound(bodies: Sequence[Sequence[int]]) -> int:
    """Return a bound on the rank of links in general position, each of them in one of the bodies (sets of joints).

    r <= r(H) + sum of (3|X| - 6 - r(H in X)) over bodies X, for the pairs H of joints that two of them share: by
    submodularity [Whitney1935], after linking all pairs of every body. The double banana: 1 + 8 + 8 = 17.
    """
    shared = (x & y for x, y in combinations(map(frozenset, bodies), 2))
    hinges = sorted({(min(pair), max(pair)) for pair in shared if len(pair) == 2})
    bound = len(hinges)
    for body in map(frozenset, bodies):
        bound += _full_rank(len(body)) - _rank([pair for pair in hinges if body.issuperset(pair)])
    return bound
