"""Sets of joints in space that keep all their distances, from random motions and from joints added one by one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import Any

from dofkit.base.libraries import np
from dofkit.exact.matrices.dense import product, residues


class RigidBodies:
    """Maximal sets of joints that keep all their distances; two of them share two joints at most."""

    def __init__(self) -> None:
        self._members: dict[int, set[int]] = {}
        self._of: dict[int, set[int]] = {}
        self._next = 0

    def add(self, joints: Iterable[int]) -> None:
        """One more, which no other contains."""
        self._members[self._next] = set(joints)
        for v in self._members[self._next]:
            self._of.setdefault(v, set()).add(self._next)
        self._next += 1

    def holding(self, joints: Iterable[int]) -> set[int]:
        """Which of them contain all of some joints."""
        return set.intersection(*(self._of.get(v, set()) for v in joints))

    def attach(self, joint: int, neighbours: Sequence[int]) -> None:
        """A joint linked to at most three others, in general position, which is in bodies of other parts at most.

        Three of one body hold it there; two of one body swing it about their line, so the three are a body.
        """
        if len(neighbours) == 3:
            for number in self.holding(neighbours):
                self._members[number].add(joint)
                self._of.setdefault(joint, set()).add(number)
                return
        alone = dict.fromkeys(neighbours)
        for pair in combinations(neighbours, 2):
            common = self.holding(pair)
            if common:
                for number in common:
                    self._drop_bar(number)
                self.add((joint, *pair))
                alone = {v: None for v in alone if v not in pair}
        for v in alone:
            self.add((joint, v))
        self._of.setdefault(joint, set())

    def _drop_bar(self, number: int) -> None:
        if len(self._members[number]) == 2:
            for v in self._members.pop(number):
                self._of[v].discard(number)

    def sets(self, joints: int) -> list[list[int]]:
        """All of them, and every joint of 0, 1, ... that is in none by itself."""
        found = [sorted(members) for members in self._members.values()]
        return sorted([*found, *([v] for v in range(joints) if not self._of.get(v))])


def fixed_pairs(at: Any, motions: Any, p: int) -> Any:
    """Which pairs of joints keep their distance in all of some random motions: (p_i - p_j) . (v_i - v_j) = 0."""
    fixed = np.ones((len(at), len(at)), dtype=bool)
    for velocities in motions:
        own = residues(residues(at * velocities, p).sum(axis=1), p)
        cross = product(at, velocities.T, p)
        fixed &= residues(own[:, None] + own[None, :] - cross - cross.T, p) == 0
    np.fill_diagonal(fixed, False)
    return fixed


def bodies_of(fixed: Any) -> list[list[int]]:
    """The maximal sets of joints all of whose pairs are fixed, pairs included.

    In general position a joint fixed to three of a body belongs to it, so every fixed triangle lies in one body.
    """
    found: list[list[int]] = []
    of: list[set[int]] = [set() for _ in fixed]
    left = np.triu(fixed)
    for a in range(len(fixed)):
        for b in np.flatnonzero(left[a]):
            if not left[a, b]:
                continue
            candidates = fixed[a] & fixed[b]
            for number in of[a] & of[b]:
                candidates[found[number]] = False
            while candidates.any():
                c = int(np.argmax(candidates))
                members = np.flatnonzero(fixed[a] & fixed[b] & fixed[c]).tolist()
                body = sorted([a, int(b), c, *members])
                candidates[body] = False
                for v in body:
                    of[v].add(len(found))
                _settle(left, fixed, body)
                found.append(body)
            if not of[a] & of[b]:
                of[a].add(len(found))
                of[b].add(len(found))
                found.append([a, int(b)])
            left[a, b] = False
    return found


def _settle(left: Any, fixed: Any, body: Sequence[int]) -> None:
    """The pairs of a body need no more look, but those that a joint outside is fixed to, too: hinges."""
    inside = np.array(body)
    outside = fixed[:, inside].copy()
    outside[inside] = False
    hinges = [inside[np.flatnonzero(outside[y])] for y in np.flatnonzero(outside.sum(axis=1) == 2)]
    kept = [(min(a, b), max(a, b)) for a, b in hinges if left[min(a, b), max(a, b)]]
    left[np.ix_(inside, inside)] = False
    for a, b in kept:
        left[a, b] = True
