"""What is left of a graph of links in space once joints of three links or fewer, and cut joints, are dealt with.

A joint of at most three links adds them all to the rank (0-extension [Henneberg1911]): they are independent of all
others. Two parts that share one joint only turn freely about it: their ranks add up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dofkit.base.libraries import nx

Ends = Sequence[tuple[int, int]]

#: Links that a joint adds to the rank whatever the others are: the dimension.
DEGREE = 3


@dataclass(frozen=True)
class PeeledGraph:
    """Joints taken off with their links, in that order, and what is left: several parts, or one ``core`` of links."""

    peeled: list[tuple[int, list[int]]]
    parts: list[PeeledGraph]
    core: list[int]

    def cores(self) -> list[list[int]]:
        """The cores of all parts."""
        found = [core for part in self.parts for core in part.cores()]
        return [self.core, *found] if self.core else found


def decompose(links: Sequence[int], ends: Ends) -> PeeledGraph:
    """Links with different pairs of ends taken apart; joints of at most three links are taken off."""
    peeled, core = peel(links, ends)
    blocks = _blocks(core, ends)
    if len(blocks) < 2:
        return PeeledGraph(peeled, [], core)
    return PeeledGraph(peeled, [decompose(block, ends) for block in blocks], [])


def peel(links: Sequence[int], ends: Ends) -> tuple[list[tuple[int, list[int]]], list[int]]:
    """(joints of at most three links taken off one after another with them, the links left)."""
    at: dict[int, dict[int, None]] = {}
    for i in links:
        for v in ends[i]:
            at.setdefault(v, {})[i] = None
    pending = [v for v, own in at.items() if len(own) <= DEGREE]
    taken = set(pending)
    peeled = []
    for v in pending:
        own = list(at[v])
        peeled.append((v, own))
        for i in own:
            w = ends[i][0] + ends[i][1] - v
            del at[w][i]
            if len(at[w]) <= DEGREE and w not in taken:
                taken.add(w)
                pending.append(w)
    gone = {i for _, own in peeled for i in own}
    return peeled, [i for i in links if i not in gone]


def _blocks(links: Sequence[int], ends: Ends) -> list[list[int]]:
    """The links of each part that no single joint cuts."""
    number = {frozenset(ends[i]): i for i in links}
    graph = nx.Graph([ends[i] for i in links])
    blocks = [sorted(number[frozenset(pair)] for pair in block) for block in nx.biconnected_component_edges(graph)]
    return sorted(blocks)
