"""The pebble game written for Python itself, against the one that is compiled elsewhere, run as it is written."""

from __future__ import annotations

import random
from collections.abc import Callable
from itertools import combinations, product

import pytest

from dofkit.mobility.graph import net as nets
from dofkit.mobility.graph import pebbles
from dofkit.mobility.graph.grouping import places_by_label
from dofkit.mobility.graph.net import Net
from dofkit.mobility.graph.pebbles import FREE, Board
from dofkit.mobility.graph.plain_game import PlainGame

Pairs = list[tuple[int, int]]


def fresh(joints: int, links: int) -> Board:
    """All pebbles free."""
    out, link = [FREE] * (2 * joints), [FREE] * (2 * joints)
    return Board(out, link, list(range(links)), [0] * joints, [0] * joints, [0] * joints, [0])


def by_arrays(pairs: Pairs, joints: int) -> tuple[list[int], list[list[int]]]:
    """The superfluous links, and all links by groups, from the other game."""
    ends, links = [v for pair in pairs for v in pair], len(pairs)
    net = Net(ends, [0] * (joints + 1), [0] * (2 * links), [0] * joints, [0] * joints, [0] * links)
    board, dependent = fresh(joints, links), [0] * links
    nets.incidence(net.ends, dependent, net.start, net.at, net.degree)
    outer = nets.peel(net)
    pebbles.play(board, net, outer, dependent)
    groups = places_by_label([pebbles.leader(board.group, i) for i in range(links)])
    return [i for i in range(links) if dependent[i]], groups


def game(pairs: Pairs, joints: int) -> PlainGame:
    """The game of some links, before it is played."""
    return PlainGame(joints, [v for pair in pairs for v in pair])


def played(pairs: Pairs, joints: int) -> PlainGame:
    found = game(pairs, joints)
    found.play()
    return found


def anyhow(rng: random.Random) -> Pairs:
    joints = rng.randint(2, 30)
    return rng.choices([(v, w) for v in range(joints) for w in range(joints) if v != w], k=rng.randint(1, 3 * joints))


def bodies(rng: random.Random) -> Pairs:
    """Small bodies that share joints, in any order: blocks that share one joint, or two and become one."""
    joints = rng.randint(5, 26)
    sets = [rng.sample(range(joints), rng.randint(2, 5)) for _ in range(joints // 3)]
    pairs = [pair for one in sets for pair in combinations(one, 2) if rng.random() < 0.85] or [(0, 1)]
    rng.shuffle(pairs)
    return pairs


def grid(rng: random.Random) -> Pairs:
    """Squares with diagonals, most of them there: one block that grows."""
    m, steps = rng.randint(2, 6), ((1, 0), (0, 1), (1, 1))
    pairs = [
        (i * m + j, (i + a) * m + j + b)
        for i, j in product(range(m), repeat=2)
        for a, b in steps
        if i + a < m and j + b < m and rng.random() < 0.95
    ] or [(0, 1)]
    if rng.random() < 0.5:
        rng.shuffle(pairs)
    return pairs


@pytest.mark.parametrize("kind", [anyhow, bodies, grid])
@pytest.mark.parametrize("seed", range(30))
def test_both_games_end_alike(kind: Callable[[random.Random], Pairs], seed: int) -> None:
    """The same links are superfluous, in the same groups; and what is paid for in the end is a basis of their span."""
    pairs = kind(random.Random(seed))
    joints = 1 + max(map(max, pairs))
    own = played(pairs, joints)
    redundant, groups = by_arrays(pairs, joints)
    assert own.redundant == redundant
    assert places_by_label(own.groups()) == groups
    paid = [(v, w) for v in range(joints) for w in (own.first[v], own.second[v]) if w != FREE]
    assert len(paid) == len(pairs) - len(redundant)
    assert by_arrays([*paid, *pairs], joints)[0] == list(range(len(paid), len(paid) + len(pairs)))


def test_a_link_twice_is_superfluous() -> None:
    assert played([(0, 1), (1, 0), (1, 2)], 3).redundant == [1]
