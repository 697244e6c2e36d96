"""Components of things that share names."""

from __future__ import annotations

import random

import networkx as nx

from dofkit.base.libraries import components


def test_by_hand() -> None:
    assert components([]) == []
    assert components([(), ()]) == [[0], [1]]
    assert components(["ab", "cd", "ef", "bc"]) == [[0, 1, 3], [2]]
    assert components([(1,), (2,), (2, 1)]) == [[0, 1, 2]]


def test_as_the_graph_of_things_and_names_has_them() -> None:
    for seed in range(20):
        rng = random.Random(f"components {seed}")
        names = [tuple(rng.sample(range(60), rng.randrange(4))) for _ in range(30)]
        graph = nx.Graph()
        graph.add_nodes_from(("thing", i) for i in range(len(names)))
        graph.add_edges_from((("thing", i), ("name", n)) for i, own in enumerate(names) for n in own)
        found = [sorted(i for kind, i in c if kind == "thing") for c in nx.connected_components(graph)]
        assert components(names) == sorted(c for c in found if c)
