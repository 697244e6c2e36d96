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
from dofkit.mobility.graph.rigid_blocks import NONE, RigidBlocks

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


@pytest.mark.parametrize("seed", range(20))
def test_what_a_pebble_lies_on(seed: int) -> None:
    """A link of the joint itself, or one of a group that holds both joints."""
    pairs = bodies(random.Random(seed))
    joints = 1 + max(map(max, pairs))
    own = played(pairs, joints)
    board = own.board()
    holds = {group: {v for i, g in enumerate(board.group) if g == group for v in pairs[i]} for group in board.group}
    for place, (w, i) in enumerate(zip(board.out, board.link, strict=True)):
        assert (w == FREE) == (i == FREE)
        assert w == FREE or {place >> 1, w} <= holds[board.group[i]]


def test_a_link_twice_is_superfluous() -> None:
    assert played([(0, 1), (1, 0), (1, 2)], 3).redundant == [1]


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
def test_what_is_played_for(pairs: Pairs, joints: int, left: list[int]) -> None:
    """Both joints of such a link have three links, or two to one joint, when those after it are gone; K33's last link
    is played for although it is independent."""
    assert game(pairs, joints).played_for() == left


def test_what_goes_with_a_joint_is_paid_for_by_it() -> None:
    """Of K4 the last link is superfluous: without it 2 goes with its two links, so does 3, and then 0 with the last."""
    assert played(FOUR, 4).redundant == [5]
    assert played(FOUR, 4).groups() == [0] * 6
    once = played(FOUR[:5], 4)
    assert [sorted((once.first[v], once.second[v])) for v in (2, 3)] == [[0, 1], [0, 1]]
    assert sorted(once.board().link) == [FREE, FREE, FREE, 0, 1, 2, 3, 4]


class Counted(PlainGame):
    """Searches that find no pebble are counted."""

    in_vain = 0

    def bring(self, root: int, held: int) -> list[int] | None:
        reached = super().bring(root, held)
        self.in_vain += reached is not None
        return reached


ALL = list(range(6))


@pytest.mark.parametrize(
    ("more", "searched", "groups"),
    [
        ([(4, 0), (4, 1), (4, 2)], 0, [[*ALL, 6, 7, 8]]),
        ([(4, 0), (4, 1), (4, 2), (4, 3)], 0, [[*ALL, 6, 7, 8, 9]]),
        ([(4, 0), (4, 1), (5, 2), (5, 3), (5, 4)], 0, [[*ALL, 6, 7, 8, 9, 10]]),
        ([(4, 0), (4, 1), (5, 4), (5, 3), (5, 2)], 1, [[*ALL, 6, 7, 8, 9, 10]]),
        ([(4, 0), (4, 1), (4, 0)], 1, [ALL, [6, 8]]),
        ([(4, 0), (4, 1), (4, 0), (4, 2)], 2, [[*ALL, 6, 7, 8, 9]]),
        ([(3, 4), (3, 5), (4, 5), (3, 6), (4, 6), (5, 6)], 1, [ALL, [k + 6 for k in ALL]]),
    ],
    ids=["a joint by three", "and by four", "two by two, linked", "one on the other", "held twice by one joint",
         "and by a third", "two bodies at a joint"],
)  # fmt: skip
def test_a_joint_that_hangs_on_a_block(more: Pairs, searched: int, groups: list[list[int]]) -> None:
    """Beside K4, for which there is one search in vain: nothing is searched where a block fixes both ends. A link that
    repeats another makes a group with it, to which what else holds the joint does not belong."""
    pairs = [*FOUR, *more]
    own = Counted(1 + max(map(max, pairs)), [v for pair in pairs for v in pair])
    own.play()
    assert [group for group in places_by_label(own.groups()) if len(group) > 1] == groups
    assert own.in_vain == 1 + searched


def test_blocks_that_share_two_joints_are_one() -> None:
    blocks = RigidBlocks(8)
    blocks.unite([0, 1, 2], (0, 1))
    blocks.unite([2, 3, 4], (2, 3))
    assert blocks.common(0, 3) == NONE
    assert len(blocks.holding(2)) == 2
    assert blocks.common(0, 2) != blocks.common(2, 4) != NONE
    blocks.unite([1, 4, 5, 2], (4, 5))
    assert {blocks.common(v, w) for v, w in combinations(range(6), 2)} == {blocks.common(0, 1)}
    assert blocks.poles(blocks.common(0, 1)) == (4, 5)
    assert blocks.holding(6) == set()
    assert not blocks.alike(NONE, NONE)
