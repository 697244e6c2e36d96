"""A core of links in space that is too large for a dense matrix: eliminated without its zeros.

The prime has 61 bits, so what depends is probable with a chance of error that is next to nothing; no count is tried.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from functools import cached_property

from dofkit.exact.matrices.sparse import SparseRow, echelon
from dofkit.exact.points.field import prime_for
from dofkit.mobility.graph.decompose import Ends
from dofkit.mobility.graph.links import LinkageError

#: Entries of a matrix, zeros counted, beyond which they are left out.
DENSE = 25_000_000


def too_large(links: Sequence[int], ends: Ends) -> bool:
    """Would its matrix not fit?"""
    return 3 * len({v for i in links for v in ends[i]}) * len(links) > DENSE


class Large:
    """See `dofkit.mobility.graph.space.CorePart`."""

    def __init__(self, links: Sequence[int], ends: Ends) -> None:
        self._links = links
        self._joints = sorted({v for i in links for v in ends[i]})
        self._p = prime_for(1, (), 0)
        self._matrix = self._rows([ends[i] for i in links])
        independent = set(echelon(self._matrix, self._p).independent)
        self.dependent = [i for k, i in enumerate(links) if k not in independent]

    def _rows(self, pairs: Sequence[tuple[int, int]]) -> list[SparseRow]:
        rng, p = random.Random("dofkit large core"), self._p
        number = {v: k for k, v in enumerate(self._joints)}
        at = [[rng.randrange(p) for _ in range(3)] for _ in number]
        rows = []
        for a, b in ((number[a], number[b]) for a, b in pairs):
            arm = [(x - y) % p for x, y in zip(at[a], at[b], strict=True)]
            row = {3 * v + k: x if v == a else p - x for v in (a, b) for k, x in enumerate(arm) if x}
            rows.append(row)
        return rows

    @cached_property
    def circuits(self) -> Mapping[int, list[int]]:
        """For every dependent link those before it that it is a sum of."""
        found = echelon(self._matrix, self._p, supports=True).supports
        return {self._links[k]: [self._links[j] for j in support] for k, support in found.items()}

    @property
    def chance(self) -> float:
        """A bound on the chance of an error (each link depends by a minor's being 0 [SchwartzZippel])."""
        return len(self.dependent) * len(self._links) / 2**59

    def bodies(self) -> tuple[list[list[int]], bool]:
        """One where all is rigid. Raises LinkageError where it is not."""
        if len(self._links) - len(self.dependent) < 3 * len(self._joints) - 6:
            raise LinkageError(f"rigid clusters of {len(self._links)} links in space are too many to separate")
        return [self._joints], True
