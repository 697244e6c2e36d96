"""The pebble game written for Python itself, against the one that is compiled elsewhere, run as it is written."""

from __future__ import annotations

import random

import pytest

from dofkit.mobility.graph import net as nets
from dofkit.mobility.graph import pebbles
from dofkit.mobility.graph.grouping import places_by_label
from dofkit.mobility.graph.net import Net
from dofkit.mobility.graph.pebbles import FREE, Board
from dofkit.mobility.graph.plain_game import PlainGame


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
    pebbles.play(board, net, outer, dependent)
    own, found = fresh(joints, links), [0] * links
    PlainGame(own, ends, found).play()
    assert told(own, found) == told(board, dependent)
    pays = sorted((i, v) for v in range(joints) for k in (0, 1) if (i := own.link[2 * v + k]) >= 0)
    assert all(v in pairs[i] for i, v in pays if own.group[i] == i and not any(found))


def game(pairs: list[tuple[int, int]], joints: int) -> PlainGame:
    """The game of some links, before it is played."""
    return PlainGame(fresh(joints, len(pairs)), [v for pair in pairs for v in pair], [0] * len(pairs))


def test_a_link_twice_is_superfluous() -> None:
    played = game([(0, 1), (1, 0), (1, 2)], 3)
    played.play()
    assert played.dependent == [0, 1, 0]


FOUR = [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)]


@pytest.mark.parametrize(
    ("pairs", "joints", "left"),
    [
        ([(0, 1), (1, 2), (2, 0), (2, 3), (3, 1)], 4, []),
        (FOUR, 4, [5]),
        ([*FOUR, (3, 4), (4, 5), (5, 3)], 6, [5]),
        ([(3, 4), (4, 5), *FOUR, (5, 3)], 6, [7]),
        ([(0, 1), (1, 0), (1, 2)], 3, [1]),
        ([(0, 1), (0, 1), (0, 1)], 2, [2, 1]),
        ([(a, b) for b in (3, 4, 5) for a in (0, 1, 2)], 6, [8]),
    ],
    ids=["two triangles", "K4", "and a triangle after", "and around it", "a link twice", "thrice", "K33"],
)
def test_what_is_played_for(pairs: list[tuple[int, int]], joints: int, left: list[int]) -> None:
    """Both joints of such a link have three links, or two to one joint, when those after it are gone; K33's last link
    is played for although it is independent."""
    assert list(game(pairs, joints).played_for()) == left


def test_what_goes_with_a_joint_is_paid_for_by_it() -> None:
    """Of K4 the last link is superfluous: without it 2 goes with its two links, so does 3, and then 0 with the last."""
    played = game(FOUR, 4)
    played.play()
    assert played.dependent == [0, 0, 0, 0, 0, 1]
    assert pebbles.leader(played.board.group, 0) == pebbles.leader(played.board.group, 5)
    once = game(FOUR[:5], 4)
    once.play()
    assert [sorted(once.board.link[2 * v : 2 * v + 2]) for v in (2, 3)] == [[1, 2], [3, 4]]
    assert FREE in once.board.link[:2]
