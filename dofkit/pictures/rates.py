"""What can move to first order where a system is drawn, and the motions that show it; for pictures only."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dofkit.expressions.tree import DT, TIME, Expr, coordinate, differential, velocity
from dofkit.pictures.arrangement import Arrangement, finite_relations, poses_of
from dofkit.pictures.evaluation import by_pivots, derivatives, kernel, values_at
from dofkit.pictures.shapes import Array, Clip, Displacement
from dofkit.system import System

#: What counts as moving, of a unit velocity.
MOVES = 1e-5
#: Frames of one swing to both sides, how far it goes by the picture's size, and the largest turn in radians.
SWING, REACH, TURN = 32, 0.22, 0.6
#: So many free motions are shown by themselves.
MOST_MOTIONS = 12


class FreeMotion(NamedTuple):
    """A velocity that the constraints allow: ``rates`` of symbols; ``name`` of the coordinate that it moves alone."""

    name: str
    rates: Mapping[Expr, float]


def free_motions(arrangement: Arrangement, chosen: Sequence[str] = (), freedom: int | None = None) -> list[FreeMotion]:
    """Independent first-order motions; each moves one coordinate alone of those ``chosen``, where it can.

    ``freedom``: how many there are, where that is known and time does not enter. Where time occurs it is what the first
    of them follows: what is driven moves with it.
    """
    system, numbers = arrangement.system, arrangement.numbers
    rows, columns = velocity_rows(system, numbers)
    basis = kernel(rows, len(columns), None if columns[-1:] == [TIME] else freedom)
    names = [str(c.args[1]) for c in columns]
    order = [names.index("t")] if columns and columns[-1] == TIME else []
    order += [names.index(n) for n in chosen if n in names]
    order += [k for k in range(len(names)) if k not in order]
    reduced, pivots = by_pivots(basis, order)
    found = []
    for row, pivot in zip(reduced, pivots, strict=False):
        found.append(FreeMotion(names[pivot], dict(zip(columns, map(float, row), strict=True))))
    return found


def velocity_rows(system: System, numbers: Mapping[Expr, float]) -> tuple[Array, list[Expr]]:
    """Linear equations of the velocities, and their columns: coordinates, then time where it occurs."""
    columns = [coordinate(c.name) for c in system.coordinates]
    finite = finite_relations(system)
    others = [r.expr for c in system.constraints for r in c.relations if r.sense == "=" and r.expr not in set(finite)]
    if any(TIME in e.symbols or DT in e.symbols for e in [*finite, *others]):
        columns.append(TIME)
    rates = [velocity(c.name) for c in system.coordinates]
    forms = [differential(c.name) for c in system.coordinates]
    rows = derivatives(others, rates, numbers) + derivatives(others, forms, numbers)
    if columns[-1:] == [TIME]:
        constant = derivatives(others, [DT], numbers) + values_at(others, numbers).reshape(-1, 1)
        rows = np.hstack([rows, np.nan_to_num(constant)])
    return np.vstack([derivatives(finite, columns, numbers), rows]), columns


def is_linear(arrangement: Arrangement) -> bool:
    """Are all relations with velocities linear in them, as far as two velocities show?"""
    system = arrangement.system
    rates = [velocity(c.name) for c in system.coordinates]
    written = [r.expr for c in system.constraints for r in c.relations if r.expr.symbols & set(rates)]
    if not written:
        return True
    random = np.random.default_rng(1)
    at_rest = derivatives(written, rates, arrangement.numbers)
    moving = {rate: float(random.standard_normal()) for rate in rates}
    return bool(np.allclose(derivatives(written, rates, {**arrangement.numbers, **moving}), at_rest, atol=1e-5))


def movers(arrangement: Arrangement, motions: Sequence[FreeMotion]) -> frozenset[str]:
    """The bodies and particles that some motion moves."""
    found: set[str] = set()
    for motion in motions:
        moved = _poses(arrangement, motion, 1e-3)
        for name, pose in moved.items():
            here = arrangement.poses[name]
            far = np.linalg.norm(pose.turn - here.turn) + np.linalg.norm(pose.shift - here.shift)
            if far > 1e-3 * MOVES:
                found.add(name)
    return frozenset(found)


def _poses(arrangement: Arrangement, motion: FreeMotion, far: float) -> dict[str, Displacement]:
    moved = {s: arrangement.numbers.get(s, 0.0) + far * rate for s, rate in motion.rates.items()}
    return poses_of(arrangement.system, {**arrangement.numbers, **moved}, gibbs=True)


def swings(arrangement: Arrangement, motions: Sequence[FreeMotion], size: float) -> list[Clip]:
    """Each infinitesimal motion on its own, to one side and back to the other."""
    found = []
    for k, motion in enumerate(motions[:MOST_MOTIONS]):
        of = f" {k + 1} of {len(motions)}" if len(motions) > 1 else ""
        moved = "time" if motion.name == str(TIME.args[1]) else motion.name
        name = f"infinitesimal motion{of}: {moved}"
        far = _reach(arrangement, motion, size)
        sides = [math.sin(2 * math.pi * j / SWING) for j in range(SWING)]
        found.append(Clip(name, tuple(_poses(arrangement, motion, far * s) for s in sides), closed=True))
    return found


def _reach(arrangement: Arrangement, motion: FreeMotion, size: float) -> float:
    """How far a motion is followed: a part of the picture's size, or a turn that is still small."""
    step = 1e-3
    far, turned = 0.0, 0.0
    for name, pose in _poses(arrangement, motion, step).items():
        here = arrangement.poses[name]
        middle = here.turn.T @ (np.zeros(3) - here.shift)
        far = max(far, float(np.linalg.norm(pose.moved(middle) - here.moved(middle))) / step)
        turned = max(turned, float(np.linalg.norm(pose.turn - here.turn)) / step / math.sqrt(2))
    bounds = [REACH * size / far if far > MOVES else math.inf, TURN / turned if turned > MOVES else math.inf]
    return min((b for b in bounds if math.isfinite(b)), default=0.0)
