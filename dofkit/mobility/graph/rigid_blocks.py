"""Rigid blocks of a plane framework while links are added: which joints each holds, and when two become one.

A block is the set of joints of a connected component of the matroid, more than one link: superfluous links and all they
depend on. It is rigid. Two that share two joints are one: ranks are submodular [Whitney1935], so that their union has
rank 2n - 3 at most, less than the sum of theirs. And all links between two joints of a block belong to its component.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

#: No block.
NONE = -1


class RigidBlocks:
    """``of[v]``: a block of joint v, the one it was found in last, by a number that leads to the one it is now."""

    def __init__(self, joints: int) -> None:
        self.of = [NONE] * joints
        #: Joints that were found in several, with the numbers of them all.
        self.several: dict[int, set[int]] = {}
        self._became: list[int] = []
        self._poles: list[tuple[int, int]] = []

    def now(self, block: int) -> int:
        """What a block has become."""
        became = self._became
        while became[block] != block:
            became[block] = became[became[block]]
            block = became[block]
        return block

    def is_same(self, g: int, h: int) -> bool:
        """Return whether both are the same block, and neither is `NONE`."""
        return g >= 0 and h >= 0 and (g == h or self.now(g) == self.now(h))

    def holding(self, v: int) -> set[int]:
        """All blocks of joint v."""
        if v in self.several:
            return {self.now(g) for g in self.several[v]}
        return {self.now(self.of[v])} if self.of[v] >= 0 else set()

    def common(self, v: int, w: int) -> int:
        """Return the block that holds two joints."""
        of, several = self.of, self.several
        if v not in several and w not in several:
            return self.now(of[v]) if self.is_same(of[v], of[w]) else NONE
        return next(iter(self.holding(v) & self.holding(w)), NONE)

    def poles(self, block: int) -> tuple[int, int]:
        """Two joints of a block by which the others are held."""
        return self._poles[self.now(block)]

    def unite(self, joints: Sequence[int], poles: tuple[int, int]) -> None:
        """A block of these joints; all that share two of them become one with it."""
        block = self._merged(joints)
        self._poles[block] = poles
        for v in joints:
            earlier = self.of[v]
            if earlier >= 0 and self.now(earlier) != block:
                self.several.setdefault(v, {earlier}).add(block)
            self.of[v] = block

    def _merged(self, joints: Iterable[int]) -> int:
        """Return the blocks that hold two of the joints, as one; a new one where there is none."""
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
