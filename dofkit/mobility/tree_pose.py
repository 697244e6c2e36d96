"""Open trees of joints in space, moved out of their drawing: a pose modulo p at which no choice of angles is singular.

Every joint is moved by random numbers, from the ground on: a body's displacement is that of the body that carries it
after one that the joint leaves free, turns with g = t a for a Gibbs vector, so that no root is needed. The joints' rows
there are those of a generic configuration. A body's angular velocity is phidot e_z + thetadot n + psidot k, with its z
axis k and n along e_z x k; where k stays upright psi stands for the turn about it, theta and phi for tilts.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.base.libraries import nx
from dofkit.exact.matrices.sparse import SparseRow
from dofkit.exact.points.frames import sparse_frame
from dofkit.expressions.tree import Expr
from dofkit.mobility.placement import Located, Member, drawn_placement, rows_of
from dofkit.system import GROUND, System

Vector = tuple[int, ...]
#: A matrix by its rows.
Matrix = tuple[Vector, ...]


class Displaced(NamedTuple):
    """x goes to R x + d, modulo p."""

    turn: Matrix
    shift: Vector

    def point(self, x: Sequence[int], p: int) -> Vector:
        """Where a point goes."""
        return tuple((a + b) % p for a, b in zip(self.direction(x, p), self.shift, strict=True))

    def direction(self, x: Sequence[int], p: int) -> Vector:
        """Where a direction goes."""
        return tuple(sum(a * b for a, b in zip(row, x, strict=True)) % p for row in self.turn)

    def after(self, first: Displaced, p: int) -> Displaced:
        """This displacement after another one."""
        columns = (self.direction(column, p) for column in zip(*first.turn, strict=True))
        return Displaced(tuple(zip(*columns, strict=True)), self.point(first.shift, p))


STILL = Displaced(((1, 0, 0), (0, 1, 0), (0, 0, 1)), (0, 0, 0))


def free_coordinates(system: System, positive: frozenset[Expr]) -> list[str] | None:
    """The first coordinates of an open tree that are independent and enough at generic poses, as modulo p.

    None for what is no tree of joints between bodies, drawn in space with upright frames.
    """
    tree = _tree(system)
    placement = None if tree is None else drawn_placement(system, positive)
    if tree is None or placement is None:
        return None
    pose = _TreePose(system, placement.p, placement.members, placement.located, tree)
    try:
        rows = list(pose.rows())
    except ValueError:
        return None
    n = len(system.coordinates)
    solved = set(sparse_frame(rows, n, placement.p).dependent)
    return [c.name for k, c in enumerate(system.coordinates) if k not in solved]


def _tree(system: System) -> Mapping[str, tuple[str, int]] | None:
    """For every body that a joint holds what carries it, and the number of the joint, from the ground on."""
    joints = system.connections
    plain = [c for c in joints if (c.facts.freedoms or c.facts.welded) and not c.driven and len(c.members) == 2]
    turned = {r.body for r in system.rotations if r.chart == "gibbs" and r.initial[1].is_zero}
    if system.dimension != 3 or turned != {*system.bodies} or len(plain) != len(system.constraints):
        return None
    graph: nx.Graph = nx.Graph((*c.members, {"joint": k}) for k, c in enumerate(joints))
    if len(plain) != len(joints) or graph.number_of_edges() < len(joints) or not nx.is_forest(graph):
        return None
    found: dict[str, tuple[str, int]] = {}
    for component in nx.connected_components(graph):
        root = GROUND if GROUND in component else next(b for b in system.bodies if b in component)
        found |= {child: (parent, graph.edges[parent, child]["joint"]) for parent, child in nx.bfs_edges(graph, root)}
    return found


@dataclass(frozen=True)
class _TreePose:
    system: System
    p: int
    members: Mapping[str, Member]
    located: Sequence[Located]
    tree: Mapping[str, tuple[str, int]]

    def rows(self) -> Iterator[SparseRow]:
        """The rows of the joints over the rates of all coordinates. Raises ValueError where a number divides by 0."""
        displaced = self._displaced()
        moved = {
            name: m if m.start is None else replace(m, start=displaced.get(name, STILL).point(m.start, self.p))
            for name, m in self.members.items()
        }
        axes = {m.column: self._rates(displaced.get(name, STILL)) for name, m in moved.items() if m.column is not None}
        for c, located in zip(self.system.connections, self.located, strict=True):
            check()
            pair = [displaced.get(name, STILL) for name in c.members]
            at = tuple(pair[0].point(place, self.p) for place in located.places)
            ways = tuple(pair[min(k, 1)].direction(a, self.p) for k, a in enumerate(located.directions))
            here = replace(located, members=tuple(moved[m] for m in c.members), places=at, directions=ways)
            own = {m.column: axes[m.column] for m in here.members if m.column is not None}
            for row in rows_of(here) or ():
                yield self._in_rates(row, own)

    def _displaced(self) -> dict[str, Displaced]:
        """A random displacement of every body: of what hangs on nothing too."""
        rng = random.Random("dofkit tree pose")
        found = {GROUND: STILL}
        for name in self.system.bodies:
            if name not in self.tree:
                found[name] = self._about(self._any(rng), (0, 0, 0), self._any(rng))
        for child, (parent, number) in self.tree.items():
            forward = self.system.connections[number].members[0] == parent
            free = self._left_free(self.located[number], self.system.connections[number].facts.freedoms, forward, rng)
            found[child] = found[parent].after(free, self.p)
        return found

    def _left_free(self, joint: Located, freedoms: Sequence[str], forward: bool, rng: random.Random) -> Displaced:
        """A random displacement of the body that is carried, among those that the joint allows."""
        at = joint.places[0] if joint.places else (0, 0, 0)
        kinds = [name.split("_")[0] for name in freedoms]
        turns, slides = kinds.count("angle"), kinds.count("displacement")
        if "rotation" in kinds:
            return self._about(self._any(rng), at, (0, 0, 0))
        axis = joint.directions[0] if joint.directions else (0, 0, 0)
        along = self._scaled(axis, rng.randrange(1, self.p)) if slides == 1 or joint.number else (0, 0, 0)
        if slides == 2:
            along = self._across(axis, self._any(rng))
        first = self._about(self._scaled(axis, rng.randrange(1, self.p) if turns else 0), at, along)
        if turns < 2:
            return first
        second = self._about(self._scaled(joint.directions[1], rng.randrange(1, self.p)), at, (0, 0, 0))
        outer, inner = (first, second) if forward else (second, first)
        return outer.after(inner, self.p)

    def _about(self, g: Vector, at: Sequence[int], along: Sequence[int]) -> Displaced:
        """A turn about a place, and a shift: R = ((1 - g.g) I + 2 g g^T + 2 g~) / (1 + g.g) with the Gibbs vector g."""
        p, square = self.p, sum(v * v for v in g)
        below = pow(1 + square, -1, p)
        x, y, z = g
        cross = ((0, -z, y), (z, 0, -x), (-y, x, 0))
        turn = tuple(
            tuple(((1 - square) * (i == j) + 2 * g[i] * g[j] + 2 * cross[i][j]) * below % p for j in range(3))
            for i in range(3)
        )
        turned = Displaced(turn, (0, 0, 0)).direction(at, p)
        return Displaced(turn, tuple((a - b + s) % p for a, b, s in zip(at, turned, along, strict=True)))

    def _any(self, rng: random.Random) -> Vector:
        return tuple(rng.randrange(1, self.p) for _ in range(3))

    def _scaled(self, a: Sequence[int], factor: int) -> Vector:
        return tuple(v * factor % self.p for v in a)

    def _across(self, a: Sequence[int], b: Sequence[int]) -> Vector:
        return tuple((a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2]) % self.p for i in range(3))

    def _rates(self, displaced: Displaced) -> Matrix:
        """The angular velocities that go with the rates of phi, theta (times a factor) and psi, as rows."""
        k = displaced.direction((0, 0, 1), self.p)
        if not any(k[:2]):
            return ((0, 1, 0), (1, 0, 0), (0, 0, 1))
        return ((0, 0, 1), (-k[1] % self.p, k[0], 0), k)

    def _in_rates(self, row: Mapping[int, int], rates: Mapping[int, Matrix]) -> SparseRow:
        """A row over velocities and angular velocities, over the rates of coordinates instead."""
        found: dict[int, int] = {}
        for first, axes in rates.items():
            turning = [row.get(first + 3 + k, 0) for k in range(3)]
            found |= {first + k: row.get(first + k, 0) for k in range(3)}
            found |= {first + 3 + i: sum(map(int.__mul__, axis, turning)) for i, axis in enumerate(axes)}
        return {c: v % self.p for c, v in found.items() if v % self.p}
