"""Graphs of links: hand-known ones, laws on thousands of small ones, and what is no graph."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from itertools import combinations, pairwise, product
from typing import Any, NamedTuple

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import dofkit
from dofkit.mobility.graph import space
from dofkit.mobility.graph.linkage import LinkageError

Link = tuple[Any, Any]
Pairs = Sequence[tuple[int, int]]
#: A prime at which random positions are special with a chance of error below 1e-15.
P = 2**61 - 1


# What is known by hand


class Known(NamedTuple):
    """A graph and its answers.

    ``inner``: the freedom without that of one body; ``clusters``: how many joints each has; ``groups``: redundant and
    all links of each.
    """

    links: list[Link]
    dimension: int
    rank: int
    inner: int
    clusters: tuple[int, ...]
    groups: tuple[tuple[int, int], ...] = ()


def complete(names: Iterable[Any]) -> list[Link]:
    return list(combinations(names, 2))


def bipartite(m: int, n: int) -> list[Link]:
    return list(product([f"a{i}" for i in range(m)], [f"b{i}" for i in range(n)]))


def read(text: str) -> list[Link]:
    """Links written together: "AB BC"."""
    return [(pair[0], pair[1]) for pair in text.split()]


def grid(rows: int, columns: int) -> list[Link]:
    """The rods of rows x columns squares."""
    joints = list(product(range(rows + 1), range(columns + 1)))
    return [((i, j), w) for i, j in joints for w in ((i + 1, j), (i, j + 1)) if w in joints]


SQUARE, BOWTIE = read("AB BC CD DA"), read("AB BC CA CD DE EC")
OCTAHEDRON = [e for e in complete("AaBbCc") if e[0].lower() != e[1].lower()]
PRISM = read("AB BC CA DE EF FD AD BE CF")
BANANAS = [e for side in ("ABcde", "ABfgh") for e in complete(side) if e != ("A", "B")]
#: Two rhombi of two triangles each at A, their far ends D and G linked.
MOSER = read("AB AC BC BD CD AE AF EF EG FG DG")
CUBE = [(a, a ^ bit) for a in range(8) for bit in (1, 2, 4) if not a & bit]

KNOWN = {
    "nothing": Known([], 2, 0, 0, ()),
    "one link in space": Known(read("AB"), 3, 1, 0, (2,)),
    "a pair twice": Known(read("AB BA"), 2, 1, 0, (2,), ((1, 2),)),
    "a pair three times in space": Known(read("AB BC CA AB AB"), 3, 3, 0, (3,), ((2, 3),)),
    "two trees on a line": Known(read("AB BC DE"), 1, 3, 1, (3, 2)),
    # a triangle and a pair that share a joint: of one component, and of two blocks of the graph
    "two cycles on a line": Known(read("AB BC CA CD DC"), 1, 3, 0, (4,), ((1, 3), (1, 2))),
    "K4 on a line": Known(complete("ABCD"), 1, 3, 0, (4,), ((3, 6),)),
    "K4 in the plane": Known(complete("ABCD"), 2, 5, 0, (4,), ((1, 6),)),
    "K4 in space": Known(complete("ABCD"), 3, 6, 0, (4,)),
    "K5 in the plane": Known(complete("ABCDE"), 2, 7, 0, (5,), ((3, 10),)),
    "K5 in space": Known(complete("ABCDE"), 3, 9, 0, (5,), ((1, 10),)),
    "K6 in space": Known(complete("ABCDEF"), 3, 12, 0, (6,), ((3, 15),)),
    "a square in the plane": Known(SQUARE, 2, 4, 1, (2, 2, 2, 2)),
    "a square in space": Known(SQUARE, 3, 4, 2, (2, 2, 2, 2)),
    "two triangles at a joint": Known(BOWTIE, 2, 6, 1, (3, 3)),
    "two triangles at a joint in space": Known(BOWTIE, 3, 6, 3, (3, 3)),
    "two triangles at a link in space": Known(read("AB BC CA BD CD"), 3, 5, 1, (3, 3)),
    # two K4 that share a joint: each has its own redundant link
    "two K4 at a joint": Known(complete("ABCD") + complete("DEFG"), 2, 10, 1, (4, 4), ((1, 6), (1, 6))),
    # two K4 that share two joints: the shared link comes twice, and all depends on all
    "two K4 at a link": Known(complete("ABCD") + complete("CDEF"), 2, 9, 0, (6,), ((3, 12),)),
    "K33 in the plane": Known(bipartite(3, 3), 2, 9, 0, (6,)),
    # its joints have three links each, so all are independent, also with one link more
    "K33 in space": Known(bipartite(3, 3), 3, 9, 3, (2,) * 9),
    # Bolker and Roth 1980: stresses of K_mn are products of affine dependences, and those by quadrics through all
    "K44 in the plane": Known(bipartite(4, 4), 2, 13, 0, (8,), ((3, 16),)),
    "K46 in space": Known(bipartite(4, 6), 3, 24, 0, (10,)),
    "K55 in space": Known(bipartite(5, 5), 3, 24, 0, (10,), ((1, 25),)),
    "a prism": Known(PRISM, 2, 9, 0, (6,)),
    "a prism in space": Known(PRISM, 3, 9, 3, (3, 3, 2, 2, 2)),
    "Moser's spindle": Known(MOSER, 2, 11, 0, (7,)),
    "an octahedron": Known(OCTAHEDRON, 3, 12, 0, (6,)),
    "an octahedron in the plane": Known(OCTAHEDRON, 2, 9, 0, (6,), ((3, 12),)),
    "a cube": Known(CUBE, 3, 12, 6, (2,) * 12),
    # 18 = 3 8 - 6 links, yet each half is K5 less the same link, which would have been redundant once
    "a double banana": Known(BANANAS, 3, 17, 1, (5, 5), ((1, 18),)),
    # a door ABFG on the hinge AB of one body; at F it carries another: F is a cut joint, and was lost to the door
    "a body on a door": Known(
        [*complete("ABCDE"), *read("AF BF AG BG FG"), *complete("HIJKL"), *read("FH FI FJ")],
        3, 26, 4, (5, 4, 6), ((1, 10), (1, 10)),
    ),
    "a double banana with its hinge": Known([*BANANAS, ("A", "B")], 3, 17, 1, (5, 5), ((2, 19),)),
    "a double banana across": Known([*BANANAS, ("c", "f")], 3, 18, 0, (8,), ((1, 18),)),
}  # fmt: skip


@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN)
def test_known_graphs(known: Known) -> None:
    told = dofkit.linkage(known.links, known.dimension)
    assert (told.rank, told.inner_freedom, told.rigid) == (known.rank, known.inner, known.inner == 0)
    assert told.freedom == len(told.joints) * known.dimension - known.rank
    assert len(told.redundant) == len(known.links) - known.rank
    assert sorted(map(len, told.clusters)) == sorted(known.clusters)
    assert sorted((g.nullity, len(g.members)) for g in told.redundancies) == sorted(known.groups)
    assert told.verdict == "proved"


def test_the_double_banana_by_name() -> None:
    told = dofkit.linkage(BANANAS, 3)
    assert told.redundant == [("g", "h")]  # the last written
    assert told.circuit(("h", "g")) == BANANAS[:-1]
    assert told.clusters == [list("AcdeB"), list("ABfgh")]  # joints as they first occur


def test_the_last_written_is_redundant() -> None:
    for links in (complete("ABCD"), complete("ABCD")[::-1]):
        told = dofkit.linkage(links, 2)
        assert told.redundant == links[-1:] == dofkit.redundant_links(links, 2)
        assert told.circuit(links[-1]) == links[:-1]


@pytest.mark.parametrize("seed", range(20))
def test_braces_of_a_grid(seed: int) -> None:
    """A grid bends in rows + columns - 1 ways; braces that close no cycle between rows and columns take one each."""
    rng = random.Random(seed)
    rows, columns = rng.randint(1, 4), rng.randint(1, 4)
    braced = nx.Graph()
    braced.add_nodes_from([("row", i) for i in range(rows)] + [("column", j) for j in range(columns)])
    braces = []
    for i, j in rng.sample(list(product(range(rows), range(columns))), rows * columns // 2):
        if not nx.has_path(braced, ("row", i), ("column", j)):
            braced.add_edge(("row", i), ("column", j))
            braces.append(((i, j), (i + 1, j + 1)))
    told = dofkit.linkage(grid(rows, columns) + braces, 2)
    assert not told.redundant
    assert told.inner_freedom == nx.number_connected_components(braced) - 1


# Laws


class Positions:
    """The rigidity matrix of joints 0, 1, ... at random positions modulo a large prime."""

    def __init__(self, joints: int, d: int) -> None:
        rng = random.Random(f"{joints} {d}")
        self.at = [[rng.randrange(P) for _ in range(d)] for _ in range(joints)]
        self.d = d

    def row(self, link: Link) -> dict[int, int]:
        a, b = link
        arm = [x - y for x, y in zip(self.at[a], self.at[b], strict=True)]
        return {self.d * v + k: sign * x % P for v, sign in ((a, 1), (b, -1)) for k, x in enumerate(arm)}

    def basis(self, links: Pairs) -> tuple[dict[int, dict[int, int]], list[int]]:
        """(an echelon basis, the links that depend on those before)."""
        pivots: dict[int, dict[int, int]] = {}
        dependent = []
        for i, link in enumerate(links):
            row = reduced(self.row(link), pivots)
            if row:
                first = min(row)
                inverse = pow(row[first], -1, P)
                pivots[first] = {c: x * inverse % P for c, x in row.items()}
            else:
                dependent.append(i)
        return pivots, dependent

    def rank(self, links: Pairs) -> int:
        return len(self.basis(links)[0])


def reduced(row: dict[int, int], pivots: dict[int, dict[int, int]]) -> dict[int, int]:
    row = dict(row)
    for c in sorted(pivots):
        factor = row.get(c, 0)
        if factor:
            for k, x in pivots[c].items():
                row[k] = (row.get(k, 0) - factor * x) % P
    return {c: x for c, x in row.items() if x}


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, int, list[tuple[int, int]]]:
    """(dimension, joints, links); a pair may come again."""
    d = draw(st.integers(1, 3))
    n = draw(st.integers(2, 5 + d))
    every = list(combinations(range(n), 2))
    links = draw(st.lists(st.sampled_from(every), max_size=d * n, unique=draw(st.booleans())))
    return d, n, links


def answers(told: dofkit.Linkage) -> dict[str, Any]:
    """All that is told, by names."""
    return {
        "rank": told.rank,
        "freedom": told.freedom,
        "redundant": told.redundant,
        "circuits": told.circuit_places,
        "redundancies": told.redundancies,
        "clusters": told.clusters,
        "verdict": told.verdict,
    }


@settings(max_examples=300)
@given(graphs())
def test_circuits_are_minimal(graph: tuple[int, int, list[tuple[int, int]]]) -> None:
    d, n, links = graph
    told = dofkit.linkage(links, d)
    positions, together = Positions(n, d), nx.Graph()
    for i, circuit in told.circuit_places.items():
        assert all(j < i for j in circuit)
        every = [*circuit, i]
        assert positions.rank([links[j] for j in every]) == len(circuit)
        assert all(positions.rank([links[j] for j in every if j != k]) == len(circuit) for k in every)
        nx.add_path(together, every)
    groups = sorted(sorted(group) for group in nx.connected_components(together))
    assert [g.members for g in told.redundancies] == [[links[i] for i in group] for group in groups]
    assert sum(g.nullity for g in told.redundancies) == len(told.redundant)


@settings(max_examples=200)
@given(graphs(), st.randoms(use_true_random=False))
def test_names_and_order_change_nothing_else(graph: tuple[int, int, list[tuple[int, int]]], rng: random.Random) -> None:
    d, n, links = graph
    told = dofkit.linkage(links, d)
    names = rng.sample("ABCDEFGHIJ", n)
    renamed = dofkit.linkage([(names[a], names[b]) for a, b in links], d)
    assert renamed.circuit_places == told.circuit_places
    assert renamed.clusters == [[names[v] for v in members] for members in told.clusters]
    mixed = [(b, a) if rng.random() < 0.5 else (a, b) for a, b in rng.sample(links, len(links))]
    other = dofkit.linkage(mixed, d)
    assert (other.rank, other.freedom, other.verdict) == (told.rank, told.freedom, told.verdict)
    assert {frozenset(c) for c in other.clusters} == {frozenset(c) for c in told.clusters}
    assert groups_of(other) == groups_of(told)


def groups_of(told: dofkit.Linkage) -> list[tuple[int, list[list[Any]]]]:
    return sorted((g.nullity, sorted(map(sorted, g.members))) for g in told.redundancies)


@settings(max_examples=100)
@given(graphs(), graphs())
def test_graphs_apart_add_up(
    first: tuple[int, int, list[tuple[int, int]]], second: tuple[int, int, list[tuple[int, int]]]
) -> None:
    d, n, links = first
    others = [(a + n, b + n) for a, b in second[2]]
    one, two = dofkit.linkage(links, d, range(n)), dofkit.linkage(others, d)
    both = dofkit.linkage(links + others, d, range(n))
    assert both.rank == one.rank + two.rank
    assert both.redundant == one.redundant + two.redundant
    assert both.redundancies == one.redundancies + two.redundancies
    assert both.clusters == one.clusters + two.clusters


def random_links(rng: random.Random, d: int) -> list[tuple[int, int]]:
    """Links between 26 joints, enough for some large groups."""
    return rng.choices(list(combinations(range(26), 2)), k=d * 26 - rng.randint(-4, 12))


def bodies(rng: random.Random, d: int) -> list[tuple[int, int]]:
    """Small bodies that share joints, in any order: blocks that share one joint, or two and become one."""
    sets = [rng.sample(range(20), rng.randint(2, 3 + d)) for _ in range(9)]
    pairs = [pair for members in sets for pair in combinations(sorted(members), 2) if rng.random() < 0.85]
    rng.shuffle(pairs)
    return pairs or [(0, 1)]


def braced(rng: random.Random, d: int) -> list[tuple[int, int]]:
    """Squares with diagonals, most of them there: one block that grows, or several."""
    m = rng.randint(2, 5)
    number = {joint: i for i, joint in enumerate(product(range(m), repeat=2))}
    steps = ((1, 0), (0, 1), (1, 1))
    pairs = [(k, number[i + a, j + b]) for (i, j), k in number.items() for a, b in steps if (i + a, j + b) in number]
    pairs = [pair for pair in pairs if rng.random() < 0.9]
    rng.shuffle(pairs)
    return pairs or [(0, 1)]


@pytest.mark.parametrize("kind", [random_links, bodies, braced])
@pytest.mark.parametrize("d", [1, 2, 3])
@pytest.mark.parametrize("seed", range(6))
def test_larger_graphs(kind: Callable[[random.Random, int], list[tuple[int, int]]], seed: int, d: int) -> None:
    """The redundant links are those that depend at random positions; each circuit is one, and clusters are cliques."""
    links = kind(random.Random(seed), d)
    n = 1 + max(map(max, links))
    told, positions = dofkit.linkage(links, d, range(n)), Positions(n, d)
    pivots, dependent = positions.basis(links)
    assert list(told.redundant_places) == dependent
    for i, circuit in told.circuit_places.items():
        assert positions.rank([links[j] for j in [*circuit, i]]) == len(circuit)
        assert len(positions.basis([links[j] for j in [i, *circuit]])[1]) == 1
    fixed = [pair for pair in combinations(range(n), 2) if not reduced(positions.row(pair), pivots)]
    cliques = nx.find_cliques(nx.Graph([*fixed, *((v, v) for v in range(n))]))
    assert sorted(map(sorted, told.clusters)) == sorted(map(sorted, cliques))


# How graphs are given, and how sure answers are


def test_kinds_of_graphs() -> None:
    links = [(7, 3), (3, 5), (5, 9), (9, 7), (7, 5), (9, 3)]
    expected = answers(dofkit.linkage(links, 2))
    assert expected["redundant"] == [(9, 3)]
    for given_as in (iter(links), [list(link) for link in links], nx.Graph(links), nx.DiGraph(links)):
        assert answers(dofkit.linkage(given_as, 2))["clusters"] == expected["clusters"]
    for kind in (np.int8, np.int32, np.int64, np.uint64):
        assert answers(dofkit.linkage(np.array(links, dtype=kind), 2)) == expected
    far = np.array(links, dtype=np.uint64) + np.uint64(2**64 - 20)
    assert dofkit.linkage(far, 2).redundant == [(2**64 - 11, 2**64 - 17)]
    wide = [(a * 10**30, b * 10**30) for a, b in links]
    assert dofkit.linkage(wide, 2).redundant == wide[-1:]
    assert dofkit.linkage([(True, 2), (2, 1)], 2).redundant == [(2, 1)]  # True == 1
    assert dofkit.linkage([("A", 1), (1, None), ((), "A")], 2).rank == 3


def test_graphs_with_joints_of_their_own() -> None:
    graph = nx.MultiGraph([("A", "B"), ("A", "B"), ("B", "C")])
    graph.add_node("D")
    told = dofkit.linkage(graph, 2)
    assert (told.rank, told.freedom, told.redundant) == (2, 6, [("A", "B")])
    assert told.clusters == [["A", "B"], ["B", "C"], ["D"]]
    for d in (1, 2, 3):
        empty = dofkit.linkage(nx.Graph(), d)
        assert (empty.rank, empty.freedom, empty.redundant, empty.clusters) == (0, 0, [], [])
        assert dofkit.linkage(np.empty((0, 2), dtype=int), d, "AB").freedom == 2 * d


@pytest.mark.parametrize(
    ("links", "dimension", "said"),
    [
        ([("A", "B")], 4, "1, 2 or 3 dimensions, not 4"),
        ([("A", "B")], 0, "1, 2 or 3 dimensions, not 0"),
        ([("A", "B")], 2.0, "1, 2 or 3 dimensions, not 2.0"),
        ([("A", "B")], "2", "1, 2 or 3 dimensions, not '2'"),
        ([("A", "B"), ("C", "C")], 2, "link number 2 joins 'C' to itself"),
        ([(1, 2), (3, 3)], 1, "link number 2 joins 3 to itself"),
        (np.array([[1, 2], [3, 3]]), 3, "link number 2 joins 3 to itself"),
        (nx.Graph([("A", "A")]), 2, "link number 1 joins 'A' to itself"),
        ([("A", "B"), "AB"], 2, "link number 2 is 'AB'"),
        ([("A", "B", "C")], 2, "link number 1 is"),
        (np.zeros((2, 3), dtype=int), 2, "link number 1 is"),
        ([("A",)], 2, "link number 1 is"),
        ([7], 2, "link number 1 is 7"),
        (7, 2, "not 7"),
        (None, 2, "not None"),
        ([("A", ["B"])], 2, "unhashable"),
    ],
)
def test_what_is_no_graph(links: Any, dimension: Any, said: str) -> None:
    with pytest.raises(LinkageError, match=said.replace("(", r"\(")):
        dofkit.linkage(links, dimension)


def test_what_is_not_in_the_graph() -> None:
    told = dofkit.linkage(read("AB BC"), 2)
    with pytest.raises(LinkageError, match="is not a redundant link"):
        told.circuit(("A", "B"))


def test_a_dependence_that_no_count_proves_is_probable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "hinged_bound", lambda _: 10**9)
    told = dofkit.linkage(BANANAS, 3)
    assert (told.rank, told.verdict) == (17, "probable")
    assert "chance of error below" in told.proof.reason


def test_a_large_part_that_is_not_rigid_is_not_separated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "MAX_JOINTS", 5)
    assert dofkit.linkage(complete("ABCDEF"), 3).clusters == [list("ABCDEF")]
    with pytest.raises(LinkageError, match="too many to separate"):
        _ = dofkit.linkage(BANANAS, 3).clusters


@pytest.mark.sweep
def test_every_run_gives_the_same() -> None:
    script = (
        "import dofkit, random; rng = random.Random(5); names = [chr(65 + i) for i in range(20)]\n"
        "for d in (1, 2, 3):\n"
        "    told = dofkit.linkage([tuple(rng.sample(names, 2)) for _ in range(20 * d)], d)\n"
        "    print(told, told.redundant, told.circuit_places, told.redundancies, told.clusters)\n"
    )
    told = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(told) == 1
    assert len(next(iter(told)).splitlines()) == 3


def test_long_chains_and_large_grids() -> None:
    """No recursion, and nothing quadratic: 20 000 joints in a row, and a triangulated grid of 10 000."""
    told = dofkit.linkage(list(pairwise(range(20_000))), 2)
    assert (told.freedom, told.redundant) == (20_001, [])
    m = 100
    joints = list(product(range(m), range(m)))
    links = [((i, j), w) for i, j in joints for w in ((i + 1, j), (i, j + 1), (i + 1, j + 1)) if max(w) < m]
    told = dofkit.linkage(links, 2)
    assert told.rigid
    assert len(told.redundant) == 2 * m * (m - 1) + (m - 1) ** 2 - (2 * m * m - 3)
