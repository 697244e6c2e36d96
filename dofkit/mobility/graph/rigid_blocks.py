"""Rigid blocks of a plane framework while links are added: the joints of each, and the union of two of them.

A block is the set of joints of a connected component, with more than one link, of the rigidity matroid: redundant links
and all links on which they depend. It is rigid. Two blocks that share two joints are united: ranks are submodular
[Whitney1935], so that their union has at most the rank 2n - 3, less than the sum of theirs. All links between two
joints of a block belong to its component.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

#: In place of a block: there is none.
NONE = -1


class RigidBlocks:
    """``of[v]``: the last block to which joint v was added (`NONE` without one); `now` gives its present number."""

    def __init__(self, joints: int) -> None:
        self.of = [NONE] * joints
        #: {joint in several blocks: the numbers of them all}.
        self.several: dict[int, set[int]] = {}
        self._became: list[int] = []
        self._poles: list[tuple[int, int]] = []

    def now(self, block: int) -> int:
        """Return the number of the block with which a block has been united (a union-find structure)."""
        became = self._became
        while became[block] != block:
            became[block] = became[became[block]]
            block = became[block]
        return block

    def is_same(self, g: int, h: int) -> bool:
        """Return whether g and h are the same block now, and neither is `NONE`."""
        return g >= 0 and h >= 0 and (g == h or self.now(g) == self.now(h))

    def holding(self, v: int) -> set[int]:
        """Return all blocks that contain joint v."""
        if v in self.several:
            return {self.now(g) for g in self.several[v]}
        return {self.now(self.of[v])} if self.of[v] >= 0 else set()

    def common(self, v: int, w: int) -> int:
        """Return the block that contains two joints; NONE if there is none."""
        of, several = self.of, self.several
        if v not in several and w not in several:
            return self.now(of[v]) if self.is_same(of[v], of[w]) else NONE
        return next(iter(self.holding(v) & self.holding(w)), NONE)

    def poles(self, block: int) -> tuple[int, int]:
        """Return the two joints of a block to which the pebbles of the others lead."""
        return self._poles[self.now(block)]

    def unite(self, joints: Sequence[int], poles: tuple[int, int]) -> None:
        """Make a block of these joints, united with all blocks that share two of them."""
        block = self._merged(joints)
        self._poles[block] = poles
        for v in joints:
            earlier = self.of[v]
            if earlier >= 0 and self.now(earlier) != block:
                self.several.setdefault(v, {earlier}).add(block)
            self.of[v] = block

    def _merged(self, joints: Iterable[int]) -> int:
        """Unite all blocks that contain two or more of the joints, or begin a new one, and return its number."""
        once, block = set[int](), NONE
        for v in joints:
            for g in self.holding(v):
                if g not in once:
                    once.add(g)
                elif block < 0:
                    block = g
                elif g != block:
                    self._became[g] = block
        if block < 0:
            block = len(self._became)
            self._became.append(block)
            self._poles.append((NONE, NONE))
        return block
