"""How far configurations along a motion are from satisfying what a scene demands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from dofkit.expressions.tree import Expr, coordinate
from dofkit.pictures.arrangement import Arrangement, geometric_equations, velocity_rows
from dofkit.pictures.evaluation import derivatives, values_at
from dofkit.pictures.shapes import quaternion
from dofkit.system import System

#: Gibbs vectors are compared as long as the quaternion's scalar part is larger than this: near half a turn they end.
NEAR_HALF_TURN = 0.05


def residual(system: System, path: Iterable[Mapping[Expr, float]], *, chords: bool = False) -> float:
    """Return the largest residual of geometric equations, by their gradients and the size of the coordinates.

    ``path``: numbers for all symbols, with Euler angles of bodies; ``chords``: forms count along them too.
    """
    symbols, finite = [coordinate(c.name) for c in system.coordinates], geometric_equations(system)
    worst, last = 0.0, None
    for numbers in (_in_gibbs_vectors(system, q) for q in path):
        if numbers is not None and finite:
            slopes = np.linalg.norm(derivatives(finite, symbols, numbers), axis=1)
            gaps = np.abs(values_at(finite, numbers).reshape(len(finite)))
            reach = max(1.0, *(abs(numbers[s]) for s in symbols))
            worst = max(worst, float(np.max(gaps / np.maximum(slopes, 1.0) / reach)))
        if chords and numbers is not None and last is not None and not system.rotations:
            step = np.array([numbers[s] - last[s] for s in symbols])
            middle = numbers | {s: numbers[s] - d / 2 for s, d in zip(symbols, step, strict=True)}
            worst = max([worst, *map(float, np.abs(velocity_rows(system, middle)[0][len(finite) :] @ step))])
        last = numbers
    return worst


def _in_gibbs_vectors(system: System, q: Mapping[Expr, float]) -> dict[Expr, float] | None:
    """Return the numbers with the Gibbs vectors of bodies in space; None near half a turn."""
    numbers, poses = dict(q), Arrangement(system, q, None, True).poses_at(q, gibbs=False)
    for r in (r for r in system.rotations if r.chart == "gibbs"):
        w, *vector = map(float, quaternion(poses[r.body].turn))
        if w < NEAR_HALF_TURN:
            return None
        numbers |= {coordinate(n): v / w for n, v in zip(r.names, vector, strict=True)}
    return numbers
