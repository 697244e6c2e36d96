"""Links along a line: a link is redundant if and only if it closes a cycle (the graphic matroid) [Kirchhoff1847]."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.base.libraries import nx
from dofkit.mobility.graph.links import Proof, Question

_PROOF = Proof("proved", "spanning forest: in one dimension a link is redundant if and only if it closes a cycle")


class LineGraph:
    """A graph of links in one dimension; see `dofkit.mobility.graph.links.GraphAnswer`."""

    def __init__(self, joints: int, ends: Any) -> None:
        self._ends = list(zip(ends[::2].tolist(), ends[1::2].tolist(), strict=True))
        self.redundant: list[int] = []
        self._forest: nx.Graph[int] = nx.Graph()
        self._forest.add_nodes_from(range(joints))
        trees: nx.utils.UnionFind[int] = nx.utils.UnionFind(range(joints))
        for i, (a, b) in enumerate(self._ends):
            if trees[a] == trees[b]:
                self.redundant.append(i)
            else:
                trees.union(a, b)
                self._forest.add_edge(a, b, number=i)

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        parent: dict[int, int] = {}
        depth: dict[int, int] = {}
        for root in map(min, nx.connected_components(self._forest)):
            depth[root] = 0
            for a, b in nx.bfs_edges(self._forest, root):
                parent[b], depth[b] = a, depth[a] + 1
        for i in links:
            a, b = self._ends[i]
            path = []
            while a != b:
                if depth[a] < depth[b]:
                    a, b = b, a
                path.append(self._forest.edges[a, parent[a]]["number"])
                a = parent[a]
            yield i, sorted(path)

    def groups(self) -> list[list[int]]:
        links: dict[frozenset[int], list[int]] = {}
        for i, pair in enumerate(self._ends):
            links.setdefault(frozenset(pair), []).append(i)
        blocks = nx.biconnected_component_edges(nx.Graph(self._ends))
        members = (sorted(i for pair in block for i in links[frozenset(pair)]) for block in blocks)
        return sorted(group for group in members if len(group) > 1)

    def clusters(self) -> list[list[int]]:
        return sorted(map(sorted, nx.connected_components(self._forest)))

    def proof(self, question: Question) -> Proof:
        return _PROOF
