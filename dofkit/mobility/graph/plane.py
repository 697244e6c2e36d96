"""Links in the plane: the pebble game, circuits, groups and rigid clusters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

from dofkit.base.libraries import np
from dofkit.mobility.graph import net as nets
from dofkit.mobility.graph import pebbles, rigid_clusters
from dofkit.mobility.graph.answer import Proof, Question
from dofkit.mobility.graph.circuits import circuits, rooted
from dofkit.mobility.graph.compiled import Engine, engine_for
from dofkit.mobility.graph.grouping import ascending, places_by_label
from dofkit.mobility.graph.net import Net
from dofkit.mobility.graph.pebbles import FREE, Board
from dofkit.mobility.graph.plain_game import PlainGame

# [JacobsHendrickson1997] [PollaczekGeiringer1927] [Laman1970]
_PROOF = Proof(
    "proved",
    "the (2,3) pebble game (Jacobs and Hendrickson 1997): links in the plane are independent in general position if "
    "and only if every n joints carry at most 2n - 3 of them (Pollaczek-Geiringer 1927, Laman 1970)",
)


#: Joints times circuits from which many circuits at once are faster than one after another.
WORTH_WORDS = 2_000_000
#: So many times faster is the game written for Python than the one for arrays, run as it is written.
PLAIN_GAME = 4


def _board(engine: Engine, joints: int, links: int) -> Board:
    """All pebbles free, every link a group of its own."""
    return Board(
        out=engine.filled(2 * joints, FREE),
        link=engine.filled(2 * joints, FREE),
        group=engine.array(range(links)),
        seen=engine.filled(joints, 0),
        via=engine.filled(joints, 0),
        queue=engine.filled(joints, 0),
        clock=engine.filled(1, 0),
    )


def _net(engine: Engine, ends: Any, joints: int, left_out: Any) -> tuple[Net, int]:
    """The links that are not left out, and how many joints of few links could be taken off one after another."""
    links = len(left_out)
    net = Net(
        ends=ends,
        start=engine.filled(joints + 1, 0),
        at=engine.filled(2 * links, 0),
        degree=engine.filled(joints, 0),
        order=engine.filled(joints, 0),
        gone=engine.filled(links, 0),
    )
    kernels = engine.running(nets)
    kernels.incidence(net.ends, left_out, net.start, net.at, net.degree)
    return net, kernels.peel(net)


def _leaders(engine: Engine, group: Any) -> list[int]:
    """The link that stands for each link's group."""
    return [int(engine.kernels.leader(group, i)) for i in range(len(group))]


class CompiledGame:
    """The game on arrays; see `dofkit.mobility.graph.plain_game.PlainGame`."""

    def __init__(self, engine: Engine, joints: int, ends: Any) -> None:
        self._engine, links = engine, len(ends) // 2
        self._board = _board(engine, joints, links)
        dependent = engine.filled(links, 0)
        net, outer = _net(engine, engine.array(ends), joints, dependent)
        engine.kernels.play(self._board, net, outer, dependent)
        self.redundant: list[int] = np.flatnonzero(dependent).tolist()

    def groups(self) -> list[int]:
        """For every link one that stands for its group."""
        return _leaders(self._engine, self._board.group)

    def board(self) -> Board:
        """A copy."""
        return Board(*(value.copy() for value in self._board))


class PlaneGraph:
    """A graph of links in two dimensions; see `dofkit.mobility.graph.answer.GraphAnswer`."""

    def __init__(self, joints: int, ends: Sequence[int]) -> None:
        self._joints, self._links, self._given = joints, len(ends) // 2, ends
        engine = engine_for(pebbles, self._links, if_ready=True, faster=PLAIN_GAME)
        self._game = CompiledGame(engine, joints, ends) if engine.compiled else PlainGame(joints, ends)
        if isinstance(self._game, PlainGame):
            self._game.play()

    @property
    def redundant(self) -> list[int]:
        return self._game.redundant

    @cached_property
    def _dependent(self) -> list[int]:
        """1 for every redundant link, 0 for the others."""
        found = [0] * self._links
        for i in self.redundant:
            found[i] = 1
        return found

    @cached_property
    def _ends(self) -> list[int]:
        found: list[int] = Engine(pebbles, False).array(self._given)
        return found

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        work = len(links) * self._joints
        engine = engine_for(pebbles, max(self._links, work // 100))
        if engine.compiled or work < WORTH_WORDS:
            return self._one_by_one(links, engine)
        return self._in_words(links)

    def _one_by_one(self, links: Sequence[int], engine: Engine) -> Iterator[tuple[int, list[int]]]:
        ends, kernels = engine.array(self._given), engine.kernels
        board = _board(engine, self._joints, 0)
        dependent = engine.array(self._dependent)
        kernels.orient(board, *_net(engine, ends, self._joints, dependent), dependent)
        found = engine.filled(2 * self._joints, 0)
        for i in links:
            number = kernels.circuit(board, int(ends[2 * i]), int(ends[2 * i + 1]), found)
            yield i, ascending(found[:number])

    def _in_words(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        """Group by group: every circuit lies in one, and its independent links are isostatic."""
        asked, plain = set(links), Engine(pebbles, False)
        for group in self.groups():
            pairs = [i for i in group if i in asked]
            if not pairs:
                continue
            basis = [i for i in group if not self._dependent[i]]
            number: dict[int, int] = {}
            ends = [number.setdefault(self._ends[place], len(number)) for i in basis for place in (2 * i, 2 * i + 1)]
            board = _board(plain, len(number), 0)
            independent = [0] * len(basis)
            pebbles.orient(board, *_net(plain, ends, len(number), independent), independent)
            root = rooted(board.out, list(zip(ends[::2], ends[1::2], strict=True)))
            wanted = [(number[self._ends[2 * i]], number[self._ends[2 * i + 1]]) for i in pairs]
            for i, found in zip(pairs, circuits(root, wanted), strict=True):
                yield i, [basis[k] for k in found]

    def groups(self) -> list[list[int]]:
        return [g for g in places_by_label(self._game.groups()) if len(g) > 1]

    def clusters(self) -> list[list[int]]:
        n = self._joints
        if self._links - len(self.redundant) == 2 * n - 3:
            return [list(range(n))]
        alone, joints = set(range(n)), []
        for links in places_by_label(self._cluster_leaders()):
            members = {int(self._ends[place]) for i in links for place in (2 * i, 2 * i + 1)}
            alone -= members
            joints.append(sorted(members))
        return sorted([*joints, *([v] for v in alone)])

    def _cluster_leaders(self) -> Sequence[int]:
        """For every link the one that stands for its rigid cluster."""
        e = engine_for(rigid_clusters, self._links)
        board = Board(*(e.array(value) for value in self._game.board()))
        net, outer = _net(e, e.array(self._given), self._joints, e.array(self._dependent))
        e.running(nets).sweep(net, outer)
        e.kernels.core_clusters(board, net, outer)
        e.kernels.outer_clusters(board, net, outer)
        return _leaders(e, board.group)

    def proof(self, question: Question) -> Proof:
        return _PROOF
