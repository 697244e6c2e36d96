"""A core of links in space at random positions modulo a prime: which depend on those before them, and on which.

The rigidity matrix has a row (p_a - p_b) . (v_a - v_b) for every link a-b; here links are columns and joints rows.
Before elimination joints that are not neighbours and have few links are solved for: three links of such a joint carry
what its others do. Dependences are then found on a matrix of the joints left, and taken back to all links.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.base.libraries import np
from dofkit.exact.matrices.dense import Factored, factored, prime_at, product, residues
from dofkit.mobility.graph.decompose import Ends

#: Links of a joint that may be solved for before elimination.
FEW = 8
#: Motions by which joints are told apart that move relative to each other.
MOTIONS = 3


@dataclass(frozen=True)
class Core:
    """``links`` in order, ``circuits`` of those that depend on others before them.

    ``joints`` numbers the joints; ``at`` holds their positions, ``motions`` their velocities in random motions (a
    motion, a joint, a direction), residues modulo ``p``; None where all moves as one body.
    """

    links: tuple[int, ...]
    joints: dict[int, int]
    circuits: dict[int, list[int]]
    p: int
    at: Any
    motions: Any

    @property
    def rank(self) -> int:
        return len(self.links) - len(self.circuits)


@dataclass(frozen=True)
class _Solved:
    """A joint solved for: three ``pivots`` of its links carry what each of the ``others`` does, by ``carry``."""

    joint: int
    pivots: list[int]
    others: list[int]
    carry: Any


def core_of(links: Sequence[int], ends: Ends, seed: str) -> Core:
    """The core at random positions drawn from ``seed``."""
    p = prime_at(seed)
    joints: dict[int, int] = {}
    for i in links:
        for v in ends[i]:
            joints.setdefault(v, len(joints))
    pairs = [(joints[ends[i][0]], joints[ends[i][1]]) for i in links]
    rng = np.random.default_rng(list(seed.encode()))
    at = residues(rng.integers(0, p, (len(joints), 3)).astype(float), p)
    solved = _joints_solved_for(pairs, at, p) if len(links) <= 4 * len(joints) else []
    factors, columns = _factors(pairs, at, solved, p)
    if factors.rank == len(columns):
        circuits = {}
    elif solved:
        circuits = _circuits_of_links(factors, columns, solved, len(pairs), p)
    else:
        others, carry = factors.dependencies()
        circuits = {c: [factors.independent[k] for k in np.flatnonzero(carry[:, j])] for j, c in enumerate(others)}
    rigid = len(pairs) - len(circuits) == 3 * len(joints) - 6
    motions = None if rigid else _motions(factors, pairs, at, solved, p, seed)
    named = {links[c]: [links[k] for k in circuit] for c, circuit in circuits.items()}
    return Core(tuple(links), joints, named, p, at, motions)


def _joints_solved_for(pairs: Sequence[tuple[int, int]], at: Any, p: int) -> list[_Solved]:
    """Joints of few links, no two of them neighbours, those of fewest links first."""
    own: list[list[int]] = [[] for _ in at]
    for i, (a, b) in enumerate(pairs):
        own[a].append(i)
        own[b].append(i)
    found, near = [], set[int]()
    for v in sorted(range(len(own)), key=lambda v: (len(own[v]), v)):
        if len(own[v]) > FEW:
            break
        if v in near:
            continue
        neighbours = [pairs[i][0] + pairs[i][1] - v for i in own[v]]
        arms = residues(at[v] - at[neighbours], p)
        carry = _carry(arms, p)
        if carry is not None:
            near.update(neighbours)
            found.append(_Solved(v, own[v][:3], own[v][3:], carry))
    return found


def _carry(arms: Any, p: int) -> Any:
    """Coefficients c with arm_j = c_j1 arm_1 + c_j2 arm_2 + c_j3 arm_3, j > 3; None where those three are special."""
    if len(arms) < 3:
        return None
    factors = factored(arms.T.copy(), p)
    return factors.dependencies()[1].T if factors.independent == (0, 1, 2) else None


def _factors(
    pairs: Sequence[tuple[int, int]], at: Any, solved: Sequence[_Solved], p: int
) -> tuple[Factored, list[int]]:
    """The matrix of the joints that are not solved for, factored, and its columns: links that are no joint's three."""
    gone = {s.joint for s in solved}
    row = {v: k for k, v in enumerate(v for v in range(len(at)) if v not in gone)}
    of = {i: (s, k) for s in solved for k, i in enumerate(s.others)}
    pivots = {i for s in solved for i in s.pivots}
    columns = [i for i in range(len(pairs)) if i not in pivots]
    matrix = np.zeros((3 * len(row), len(columns)))
    for c, i in enumerate(columns):
        a, b = pairs[i]
        if i not in of:
            arm = at[a] - at[b]
            matrix[3 * row[a] : 3 * row[a] + 3, c] = arm
            matrix[3 * row[b] : 3 * row[b] + 3, c] = -arm
            continue
        s, k = of[i]
        for factor, j in ((-1.0, i), *zip(s.carry[k], s.pivots, strict=True)):
            w = sum(pairs[j]) - s.joint
            matrix[3 * row[w] : 3 * row[w] + 3, c] += residues(factor * residues(at[s.joint] - at[w], p), p)
    return factored(residues(matrix, p), p), columns


def _circuits_of_links(
    factors: Factored, columns: Sequence[int], solved: Sequence[_Solved], links: int, p: int
) -> dict[int, list[int]]:
    """The dependences among all links, then in the order of the links: of each the last is the redundant one."""
    others, carry = factors.dependencies()
    stresses = np.zeros((len(others), links))
    stresses[:, [columns[c] for c in factors.independent]] = -carry.T
    stresses[np.arange(len(others)), [columns[c] for c in others]] = 1.0
    for s in solved:
        stresses[:, s.pivots] = -product(stresses[:, s.others], s.carry, p)
    last = factored(residues(stresses, p)[:, ::-1].copy(), p)
    kept, parts = last.dependencies()
    turned = [links - 1 - c for c in kept]
    return {links - 1 - c: sorted(turned[k] for k in np.flatnonzero(parts[j])) for j, c in enumerate(last.independent)}


def _motions(
    factors: Factored, pairs: Sequence[tuple[int, int]], at: Any, solved: Sequence[_Solved], p: int, seed: str
) -> Any:
    """Random velocities that no link forbids: of the joints left first, then of those solved for."""
    gone = {s.joint for s in solved}
    left = [v for v in range(len(at)) if v not in gone]
    found = np.zeros((MOTIONS, len(at), 3))
    found[:, left] = factors.annihilators(MOTIONS, seed).reshape(MOTIONS, len(left), 3)
    for s in solved:
        ends = [sum(pairs[i]) - s.joint for i in s.pivots]
        arms = residues(at[s.joint] - at[ends], p)
        rates = residues(residues(arms * found[:, ends], p).sum(axis=2), p)
        _, velocity = factored(np.concatenate([arms, rates.T], axis=1), p).dependencies()
        found[:, s.joint] = velocity.T
    return found
