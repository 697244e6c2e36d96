"""Floating point: singular values above a tolerance, at the drawing or where Newton's method ends."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dofkit import expr as ex
from dofkit.alone.pointwise import Looked, Matrix, Rows, drawn_value, droppable, freedom, labels, look, same
from dofkit.alone.told import Knobs, Told
from dofkit.alone.written import Written, as_written, posed
from dofkit.asking import CONTRADICTORY
from dofkit.exact.balls import FloatPoint, RealSearch
from dofkit.exact.ring import Scalar
from dofkit.expr import Expr
from dofkit.scene import Scene

#: Starts of Newton's method, and points that are looked at.
STARTS, POINTS = 10, 5
NOWHERE = "Newton's method found no configuration from {} starts"


class Floats:
    """The numbers of this method: what is below ``tolerance`` of the largest is 0."""

    zero = 0.0

    def __init__(self, tolerance: float, seed: int) -> None:
        self.tolerance, self.seed = tolerance, seed

    def rank(self, matrix: Matrix) -> int:
        if not matrix or not matrix[0]:
            return 0
        return self._rank(singular_values(matrix))

    def _rank(self, singular: np.ndarray) -> int:
        return int(np.sum(singular > self.tolerance * float(singular.max(initial=0.0))))

    def kernel(self, matrix: Matrix, columns: int) -> Matrix:
        """An orthonormal basis of what the rows vanish on."""
        if not matrix:
            return [list(row) for row in np.eye(columns)]
        _, singular, right = np.linalg.svd(np.array(matrix, dtype=float), full_matrices=True)
        return [list(row) for row in right[self._rank(singular) :]]

    def vanishes(self, value: Scalar, scale: Sequence[Scalar]) -> bool:
        return bool(abs(value) <= self.tolerance * max(map(abs, scale), default=1.0))

    def points(self, written: Written, rows: Rows, drawn: bool) -> list[FloatPoint]:
        if drawn:
            return [self._drawn(written, rows)]
        found: list[FloatPoint] = []
        for k in range(STARTS):
            point = self._found(written, rows, k)
            if point is not None:
                found.append(point)
            if len(found) == POINTS:
                break
        return found

    def _drawn(self, written: Written, rows: Rows) -> FloatPoint:
        rng = random.Random(f"dofkit floats {self.seed}")
        symbols: dict[Expr, float] = {v.key: rng.uniform(0.5, 2) for v in rows.ring.vars if v.kind == "symbol"}
        reference = written.system.reference or {}
        parameters = {s for value in reference.values() for s in value.symbols}
        symbols |= {s: rng.uniform(0.5, 2) for s in sorted(parameters, key=repr) if s not in symbols}
        given = FloatPoint(symbols, self.seed)
        symbols |= {s: float(drawn_value(value, given)) for s, value in reference.items()}
        symbols[ex.TIME] = 0.0
        return FloatPoint(symbols, self.seed)

    def _found(self, written: Written, rows: Rows, k: int) -> FloatPoint | None:
        """Where Gauss and Newton's method ends that begins at random."""
        unknowns = [*written.coordinates, *(ex.parameter(p) for p in written.system.generic)]
        nodes = [node for _, node in rows.finite]
        search = RealSearch(rows.ring, nodes, unknowns, written.positive)
        symbols = search.start(STARTS * self.seed + k, {})
        if search.descend(symbols, self.seed) is None:
            return None
        rng = random.Random(f"dofkit floats {self.seed} {k}")
        symbols |= {s: rng.uniform(-2, 2) for s in rows.columns if s not in symbols}
        return FloatPoint(symbols, self.seed)


def singular_values(matrix: Matrix) -> Any:
    """From the largest to the smallest."""
    return np.linalg.svd(np.array(matrix, dtype=float), compute_uv=False)


def _look(scene: Scene, knobs: Knobs) -> tuple[Looked | None, Floats]:
    numbers = Floats(knobs.tolerance, knobs.seed)
    return look(as_written(scene), numbers), numbers


def dof(scene: Scene, knobs: Knobs) -> Told:
    """Coordinates less the numeric rank, forms that pass Frobenius' test included."""
    found, numbers = _look(scene, knobs)
    if found is None:
        return Told(CONTRADICTORY, NOWHERE.format(STARTS))
    return Told(freedom(found, numbers))


def integrability(scene: Scene, knobs: Knobs) -> Told:
    """By Frobenius' test within the tolerance, at a few points."""
    found, _ = _look(scene, knobs)
    return Told(None, NOWHERE.format(STARTS)) if found is None else Told(labels(found))


def redundancy(scene: Scene, knobs: Knobs) -> Told:
    """By the numeric ranks with and without each constraint."""
    found, numbers = _look(scene, knobs)
    return Told(None, NOWHERE.format(STARTS)) if found is None else Told(droppable(found, numbers))


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> Told:
    """By differences within the tolerance, at a few points."""
    return same(posed(scene, answer), Floats(knobs.tolerance, knobs.seed))
