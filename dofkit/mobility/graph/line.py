"""Links along a line: a link is redundant where it closes a cycle (the graphic matroid)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

from dofkit.base.libraries import np
from dofkit.mobility.graph import forest, net
from dofkit.mobility.graph.answer import Proof, Question
from dofkit.mobility.graph.compiled import engine_for
from dofkit.mobility.graph.grouping import places_by_label

# [Kirchhoff1847]
_PROOF = Proof("proved", "spanning forest: in one dimension a link is redundant if and only if it closes a cycle")


class LineGraph:
    """A graph of links in one dimension; see `dofkit.mobility.graph.answer.GraphAnswer`."""

    def __init__(self, joints: int, ends: Sequence[int]) -> None:
        links = len(ends) // 2
        self._joints = joints
        self._engine = engine_for(forest, links)
        self._ends = self._engine.array(ends)
        self._parent = self._engine.array(range(joints))
        self._dependent = self._engine.filled(links, 0)
        self._engine.kernels.span(self._parent, self._ends, self._dependent)

    @cached_property
    def redundant(self) -> list[int]:
        return np.flatnonzero(self._dependent).tolist()

    @cached_property
    def _tree(self) -> tuple[Any, Any]:
        """The link towards the root and the distance from it."""
        e, n = self._engine, self._joints
        up, depth = e.filled(n, -1), e.filled(n, -1)
        start, at = e.filled(n + 1, 0), e.filled(len(self._ends), 0)
        e.running(net).incidence(self._ends, self._dependent, start, at, e.filled(n, 0))
        e.kernels.root(self._ends, start, at, up, depth, e.filled(n, 0))
        return up, depth

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        up, depth = self._tree
        ends = self._ends
        for i in links:
            a, b, found = int(ends[2 * i]), int(ends[2 * i + 1]), []
            while a != b:
                if depth[a] < depth[b]:
                    a, b = b, a
                j = int(up[a])
                found.append(j)
                a = int(ends[2 * j] + ends[2 * j + 1]) - a
            yield i, sorted(found)

    def groups(self) -> list[list[int]]:
        up, depth = self._tree
        e, links = self._engine, len(self._dependent)
        group = e.array(range(links))
        e.kernels.close(self._ends, self._dependent, up, depth, group, e.filled(links, -1))
        return [
            members for members in places_by_label([e.kernels.top(group, i) for i in range(links)]) if len(members) > 1
        ]

    def clusters(self) -> list[list[int]]:
        top = self._engine.kernels.top
        return places_by_label([top(self._parent, v) for v in range(self._joints)])

    def proof(self, question: Question) -> Proof:
        return _PROOF
