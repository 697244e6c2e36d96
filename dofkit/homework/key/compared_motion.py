"""Compares the Lagrangian or the equations of motion of an answer with the right ones.

Lagrangians are equivalent if their difference satisfies Euler's equation identically (it is then a total time
derivative). Equations of motion are equivalent if they allow the same accelerations: an answer's equation follows if
the accelerations of the scene's equations satisfy it, and the system is complete if it determines all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.residues import residue_matrix
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, in_velocities, substitute
from dofkit.expressions.tree import ZERO, Expr
from dofkit.homework.key.right_motion import POINTS, RightMotion, is_zero, points
from dofkit.motion.lagrange.elimination import by_time


def euler(e: Expr, name: str) -> Expr:
    """Return d/dt de/dqdot - de/dq for the coordinate q = ``name``."""
    return by_time(diff(e, ex.velocity(name))) - diff(e, ex.coordinate(name))


def same_lagrangian(answer: Expr, right: Expr, motion: RightMotion) -> bool | None:
    """Return whether two Lagrangians are equivalent, or None if undecided.

    Their difference is a total time derivative if and only if it satisfies Euler's equation identically. With geometric
    equations, it is enough that its forces are combinations of the constraint forces where the equations are satisfied.
    """
    gap = answer - right
    if any(s.args[0] == "acceleration" for s in gap.symbols):
        return None
    forces = [euler(gap, n) for n in motion.names]
    zeros = [is_zero(e, motion.positive) for e in forces]
    if False in zeros and motion.relations:
        return _spanned(forces, motion)
    return False if False in zeros else None if None in zeros else True


def _spanned(forces: Sequence[Expr], motion: RightMotion) -> bool | None:
    """Return whether forces are combinations of constraint forces at all admissible states, or None if undecided."""
    columns = [ex.sym("acceleration", n) for n in motion.names]
    lines = [linear(motion.on_constraints(e), columns) for e in forces]
    held = [linear(motion.on_constraints(e), columns) for e in motion.rows]
    if None in lines or None in held:
        return None
    ring = Ring([e for row in (*lines, *held) for e in row or ()] + [*motion.relations], motion.positive)
    nodes = [[[ring.node(e) for e in row or ()] for row in rows] for rows in (lines, held)]
    agreements = []
    for p, at in points(ring, motion.relations):
        force_rows, rows = ([[int(at[i]) for i in row] for row in part] for part in nodes)
        moving = _accelerations(rows, p)
        if moving is None:
            continue
        force = [(_dot(row[:-1], moving) + row[-1]) % p for row in force_rows]
        gradients = [row[:-1] for row in rows]
        agreements.append(rank_of([*gradients, force], p) == rank_of(gradients, p))
    if len(agreements) < POINTS:
        return None
    return all(agreements) if all(agreements) or independent_generators(ring) else None


def _accelerations(rows: Sequence[Sequence[int]], p: int) -> list[int] | None:
    """Return accelerations that satisfy rows (coefficients, constant term) modulo p, or None if there are none."""
    if not rows:
        return []
    n = len(rows[0]) - 1
    solution = [pow(3, 7 + i, p) for i in range(n)]
    reduced, rank = residue_matrix([list(row) for row in rows], p).rref()
    for i in range(int(rank)):
        row = [int(reduced[i, j]) for j in range(n + 1)]
        pivot = next(j for j, v in enumerate(row) if v)
        if pivot == n:
            return None
        solution[pivot] = (-row[n] - sum(v * solution[j] for j, v in enumerate(row[:n]) if j != pivot)) % p
    return solution


class MotionSameness(Enum):
    """How an equation of motion compares with the scene's; the value is a stable code."""

    FOLLOWS = "FOLLOWS"
    NOT = "WRONG_MOTION"
    TRIVIAL = "NO_ACCELERATION"


class Followed(NamedTuple):
    """How each equation compares, the rank of those that follow, and whether equations contradict each other."""

    sameness: list[MotionSameness]
    rank: int
    contradictory: bool


@dataclass(frozen=True)
class AnsweredMotion:
    """Expressions of an answer (each is 0) and the right motion; ``multipliers``: the answer's names of multipliers."""

    motion: RightMotion
    equations: tuple[Expr, ...]
    multipliers: tuple[Expr, ...] = ()

    @cached_property
    def columns(self) -> list[Expr]:
        """The accelerations of the remaining coordinates."""
        return [ex.sym("acceleration", n) for n in self.motion.names]

    @cached_property
    def rows(self) -> list[list[Expr]] | None:
        """The answer's equations: coefficients of accelerations and multipliers, constant term; None if nonlinear."""
        linear_rows = []
        unknown = [*self.columns, *self.multipliers]
        for e in self.equations:
            e = self.motion.on_constraints(self.motion.in_kept(in_velocities(e)[0]))
            row = linear(e, unknown)
            if row is None:
                return None
            linear_rows.append(row)
        return linear_rows

    @cached_property
    def right(self) -> list[list[Expr]]:
        """The scene's equations and differentiated constraints as such rows, with the scene's multipliers."""
        unknown = [*self.columns, *self.motion.multipliers]
        expressions = [*self.motion.equations.values(), *self.motion.rows]
        return [row for e in expressions if (row := linear(self.motion.on_constraints(e), unknown)) is not None]

    def follow(self) -> Followed | None:
        """Return how each equation compares with the right ones, or None if undecided.

        The answer's multipliers may have any values: equations follow if there are values with which the scene's
        accelerations satisfy all equations that contain them.
        """
        rows = self.rows
        if rows is None or len(self.right) != len(self.motion.names) + len(self.motion.multipliers):
            return None
        ring = Ring([*(e for row in (*rows, *self.right) for e in row), *self.motion.relations], self.motion.positive)
        nodes = [[ring.node(e) for e in row] for row in rows]
        right = [[ring.node(e) for e in row] for row in self.right]
        findings = list(_at_points(ring, right, nodes, len(self.columns), self.motion))
        if not findings:
            return None
        sound = [all(t.sound[i] for t in findings) for i in range(len(rows))]
        if not all(sound) and not independent_generators(ring):
            return None
        n = len(self.columns)
        rank = max(t.rank if all(sound) else t.sound_rank(sound, n) for t in findings)
        still = [not any(v for t in findings for v in t.rows[i][:n]) for i in range(len(rows))]
        moves = [MotionSameness.TRIVIAL if z else MotionSameness.FOLLOWS for z in still]
        verdicts = [m if s else MotionSameness.NOT for s, m in zip(sound, moves, strict=True)]
        return Followed(verdicts, rank, any(sound) and all(t.contradictory(n) for t in findings))


class PointFindings(NamedTuple):
    """Results at one point over GF(p): for each row whether it follows, the rank of all rows, and the rows."""

    sound: list[bool]
    rank: int
    rows: list[list[int]]
    p: int

    def sound_rank(self, sound: Sequence[bool], n: int) -> int:
        """Return the rank for the n accelerations of the rows in ``sound`` that contain no multipliers."""
        return rank_of([row[:n] for row, s in zip(self.rows, sound, strict=True) if s and not any(row[n:-1])], self.p)

    def contradictory(self, n: int) -> bool:
        """Return whether rows that contain accelerations exclude each other."""
        moving = [row for row in self.rows if any(row[:n])]
        return rank_of(moving, self.p) > rank_of([row[:-1] for row in moving], self.p)


def _at_points(
    ring: Ring, right: Sequence[Sequence[int]], nodes: Sequence[Sequence[int]], n: int, motion: RightMotion
) -> Iterator[PointFindings]:
    """Yield at random points which rows the right accelerations satisfy, and the rank of all rows."""
    constraints = len(motion.rows)
    for p, at in points(ring, motion.relations):
        rows = [[int(at[i]) for i in row] for row in right]
        solution = _accelerations(rows, p)
        if solution is None or rank_of([row[:-1] for row in rows], p) < len(rows):
            continue
        answer_rows = [[int(at[i]) for i in row] for row in nodes]
        inserted = [[*row[n:-1], (row[-1] + _dot(row[:n], solution[:n])) % p] for row in answer_rows]
        sound = _consistent(inserted, p)
        held = rows[len(rows) - constraints :] if constraints else []
        width = len(answer_rows[0]) - 1 - n if answer_rows else 0
        every = [row[:-1] for row in answer_rows] + [[*row[:n], *([0] * width)] for row in held]
        rank = rank_of(every, p) - rank_of([row[n:-1] for row in answer_rows], p) if answer_rows else 0
        yield PointFindings(sound, rank - (rank_of([row[:n] for row in held], p) if held else 0), answer_rows, p)


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _consistent(rows: list[list[int]], p: int) -> list[bool]:
    """Return for each row (multipliers, constant) whether it is consistent with the consistent rows before it."""
    kept: list[list[int]] = []
    verdicts = []
    for row in rows:
        tried = [*kept, row]
        holds = rank_of(tried, p) == rank_of([r[:-1] for r in tried], p)
        verdicts.append(holds)
        if holds:
            kept = tried
    return verdicts


def linear(e: Expr, unknown: Sequence[Expr]) -> list[Expr] | None:
    """Return [coefficients of the unknowns, remainder], or None if ``e`` is not linear in them as written.

    None also if other accelerations, or differentials, occur.
    """
    row = [diff(e, s) for s in unknown]
    moving = {*unknown}
    if any(c.symbols & moving or any(s.args[0] == "acceleration" for s in c.symbols) for c in row):
        return None
    remainder = substitute(e, dict.fromkeys(unknown, ZERO))
    if any(s.args[0] in ("acceleration", "differential", "dt") for s in remainder.symbols):
        return None
    return [*row, remainder]
