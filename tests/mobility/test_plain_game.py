"""The pebble game written for Python itself, against the one that is compiled elsewhere, run as it is written."""

from __future__ import annotations

import random

import pytest

from dofkit.mobility.graph import net as nets
from dofkit.mobility.graph import pebbles
from dofkit.mobility.graph.grouping import places_by_label
from dofkit.mobility.graph.net import Net
from dofkit.mobility.graph.pebbles import FREE, Board
from dofkit.mobility.graph.plain_game import PlainGame, plain_net


def fresh(joints: int, links: int) -> Board:
    """All pebbles free."""
    out, link = [FREE] * (2 * joints), [FREE] * (2 * joints)
    return Board(out, link, list(range(links)), [0] * joints, [0] * joints, [0] * joints, [0])


def told(board: Board, dependent: list[int]) -> tuple[list[int], list[list[int]]]:
    """The superfluous links, and all links by groups."""
    return dependent, places_by_label([pebbles.leader(board.group, i) for i in range(len(dependent))])


@pytest.mark.parametrize("seed", range(40))
def test_both_games_end_alike(seed: int) -> None:
    rng = random.Random(seed)
    joints = rng.randint(2, 30)
    pairs = [rng.sample(range(joints), 2) for _ in range(rng.randint(1, 3 * joints))]
    ends, links = [v for pair in pairs for v in pair], len(pairs)
    net = Net(ends, [0] * (joints + 1), [0] * (2 * links), [0] * joints, [0] * joints, [0] * links)
    board, dependent = fresh(joints, links), [0] * links
    nets.incidence(net.ends, dependent, net.start, net.at, net.degree)
    outer = nets.peel(net)
    assert plain_net(ends, joints) == (net, outer)
    pebbles.play(board, net, outer, dependent)
    own, found = fresh(joints, links), [0] * links
    PlainGame(own).play(*plain_net(ends, joints), found)
    assert told(own, found) == told(board, dependent)
    pays = sorted((i, v) for v in range(joints) for k in (0, 1) if (i := own.link[2 * v + k]) >= 0)
    assert all(v in pairs[i] for i, v in pays if own.group[i] == i and not any(found))


def test_a_link_twice_is_superfluous() -> None:
    dependent = [0, 0, 0]
    PlainGame(fresh(3, 3)).play(*plain_net([0, 1, 1, 0, 1, 2], 3), dependent)
    assert dependent == [0, 1, 0]
