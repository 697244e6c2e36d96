"""Measured geometry: ranks with a tolerance, in floating point, and the gap they rest on.

The columns of positions are scaled by the scene's size and every row to length 1, so that a singular value
says by what fraction of the size a relation can be met otherwise. Those below the tolerance (times `SLACK`) count as 0.
A motion is followed for a finite step and brought back onto the relations by least squares: it is a motion where
they can then be met within the tolerance.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dofkit.base.deadline import check
from dofkit.configuration.rigid_motions import displacements_real
from dofkit.exact.matrices.singular_values import dependency_pattern, greedy_pivots
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart
from dofkit.system import Coordinate

#: A singular value counts as 0 below tolerance * SLACK; between that and tolerance * GREY nothing is decided.
SLACK, GREY = 3.0, 30.0
#: From so many sizes from the origin singular values are smaller by the square of that, since turns are told about it;
#: from `LEVER` sizes on no motion is followed.
CLOSE, LEVER = 2.0, 30.0
#: How much rounding errors of places grow until they are residuals.
ROOM = 1e3
#: A motion is followed this far, as a fraction of the size, or farther where second-order effects of that size would
#: not stand out from the tolerance by `FAR`; in so many directions.
STEP, FAR, LONGEST, WAYS, ROUNDS = 0.12, 60.0, 0.4, 6, 60
HALF = 0.5
#: In place of a rank: no configuration was found there.
BLOCKED = -1


@dataclass(frozen=True)
class Measured:
    """``dimension`` None where the tolerance does not decide.

    ``dependencies``: a matrix over GF(2) with the pattern of dependent rows that the Jacobian has within the
    tolerance: independent rows are unit vectors, the others sums of those they depend on. ``columns`` are
    dependent coordinates.
    """

    instantaneous: int | None
    dimension: int | None
    dependencies: list[list[int]]
    columns: tuple[int, ...]
    gap: float
    reason: str


class _Scene:
    def __init__(self, chart: Chart, roles: Sequence[Coordinate], size: float) -> None:
        self.chart = chart
        lengths = {c.name for c in roles if c.role in ("x", "y", "z")}
        self.symbols = [s for s in chart.symbols if s != ex.TIME]
        self.lengths = np.array([str(s.args[1]) in lengths for s in self.symbols], dtype=bool)
        self.scale = np.where(self.lengths, size, 1.0)
        self.columns = [c for s, c in zip(chart.symbols, chart.columns, strict=True) if s != ex.TIME]

    def lever(self, j: Any) -> float:
        """How many sizes from the origin the relations act: the largest effect of a turn by that of a shift."""
        shifts = self.lengths
        both = np.abs(j[:, shifts]).max(axis=1, initial=0), np.abs(j[:, ~shifts]).max(axis=1, initial=0)
        mixed = both[0] > 0
        return float(np.max(both[1][mixed] / both[0][mixed], initial=1.0))

    def blurs(self, at: Mapping[Expr, float]) -> float:
        """What rounding to floating point does to places, by the size, with room for what cancels."""
        places = np.array([abs(at.get(s, 0.0)) for s in self.symbols])[self.lengths] / self.scale[self.lengths]
        return ROOM * float(np.finfo(float).eps) * float(np.max(places, initial=0.0))

    def whole(self, at: Mapping[Expr, float]) -> Any:
        """Displacements of everything as one body, in scaled coordinates."""
        variables = self.chart.ring.vars
        fields = displacements_real(self.chart, lambda i: at.get(variables[i].key, 0.0) if i >= 0 else 0.0)
        timed = len(self.chart.symbols) - len(self.symbols)
        fields = fields[:, : fields.shape[1] - timed] if fields.size and timed else fields
        return fields / self.scale if fields.size else fields

    def system(self, at: Mapping[Expr, float]) -> tuple[Any, Any]:
        """(residuals as fractions of the size, scaled Jacobian)."""
        point = FloatPoint(at, 0)
        out = values(self.chart.ring, point)
        f = np.array([out[n] for n in self.chart.nodes], dtype=float)
        j = np.array(jacobian(self.chart.ring, out, point, self.chart.nodes, self.columns, 0.0), dtype=float)
        j = j.reshape(len(f), len(self.symbols)) * self.scale
        norms = np.linalg.norm(j, axis=1)
        norms = np.where(norms > 0, norms, 1.0)
        return f / norms, j / norms[:, None]


@dataclass(frozen=True)
class _MeasuredDrawing:
    """The relations as drawn: the Jacobian ``j`` at ``at``, and its ``rank`` within the tolerance."""

    scene: _Scene
    at: Mapping[Expr, float]
    j: Any
    rank: int
    tolerance: float


def measure(
    chart: Chart, at: Mapping[Expr, float], roles: Sequence[Coordinate], tolerance: float, size: float, rigid: int
) -> Measured:
    """The freedom at a measured configuration; ``rigid`` counts the motions of the whole."""
    scene = _Scene(chart, roles, size)
    n = len(scene.symbols)
    if not chart.nodes:
        return Measured(n, n, [], (), float("inf"), "")
    _, j = scene.system(at)
    singular = np.linalg.svd(j, compute_uv=False)
    rank = int(np.sum(singular > tolerance * SLACK))
    below = float(singular[rank]) if rank < len(singular) else 0.0
    gap = float(singular[rank - 1]) / below if rank and below > 0 else float("inf")
    lever = scene.lever(j)
    least = tolerance * SLACK / (lever * lever if lever > CLOSE else 1.0)
    if np.any((singular > least) & (singular < tolerance * GREY)):
        return Measured(None, None, [], (), gap, "a singular value near the tolerance leaves the rank undecided")
    pattern = dependency_pattern(j, independent_rows(j, rank, tolerance))
    columns = tuple(greedy_pivots(j.T, rank))
    first = n - rank
    whole = scene.whole(at)
    rigid = min(rigid, len(_own(whole, tolerance)))
    drawn = _MeasuredDrawing(scene, at, j, rank, tolerance)
    dimension, reason = _finite(drawn, rigid, lever > LEVER or scene.blurs(at) > tolerance)
    return Measured(first, dimension, pattern, columns, gap, reason)


def _finite(drawn: _MeasuredDrawing, rigid: int, far: bool) -> tuple[int | None, str]:
    """(dimension of the finite motion, why); nothing is followed where that is ``far`` from the origin."""
    rank, (full, columns) = drawn.rank, drawn.j.shape
    first = columns - rank
    if rank == full:
        return first, "all relations are independent within the tolerance"
    if first == rigid:
        return first, "nothing but motions of the whole is possible to first order"
    if far:
        return None, "the drawing is too far from the origin, by its size, to follow a motion in floating point"
    stride = max(STEP, (FAR * drawn.tolerance) ** HALF)
    if stride > LONGEST:
        return None, "the tolerance is too coarse to tell a motion from one of first order only"
    ranks = [_rank_away(drawn, stride, seed) for seed in range(WAYS)]
    if all(r == rank for r in ranks):
        return first, "the motion was followed for a finite step within the tolerance"
    # one dependence leaves a cone of one dimension less, or nothing: wherever it can be entered, that is the motion
    if set(ranks) == {full} or (rank == full - 1 and full in ranks and rank not in ranks):
        return columns - full, "branches cross here; beside it all relations are independent within the tolerance"
    if first - rigid == 1 and set(ranks) == {BLOCKED}:
        return rigid, "the one motion left to first order breaks the relations beyond the tolerance"
    return None, "some of the motions to first order are no finite motions; which was not decided"


def independent_rows(j: Any, rank: int, tolerance: float) -> list[int]:
    """The first rows, in order, independent of those before them within the tolerance."""
    kept: list[int] = []
    for r in range(len(j)):
        if len(kept) == rank:
            break
        check()
        if float(np.linalg.svd(j[[*kept, r]], compute_uv=False)[-1]) > tolerance * SLACK:
            kept.append(r)
    return kept


def _rank(j: Any, tolerance: float) -> int | None:
    """Singular values above the tolerance; None where one is near it."""
    singular = np.linalg.svd(j, compute_uv=False)
    if np.any((singular > tolerance * SLACK) & (singular < tolerance * GREY)):
        return None
    return int(np.sum(singular > tolerance * SLACK))


def _rank_away(drawn: _MeasuredDrawing, stride: float, seed: int) -> int | None:
    """The rank a stride away along some motion to first order; `BLOCKED` where the relations cannot be met there.

    None where the rank is undecided.
    """
    scene, at, tolerance = drawn.scene, drawn.at, drawn.tolerance
    rng = random.Random(f"dofkit measured {seed}")
    _, _, right = np.linalg.svd(drawn.j)
    null = _without_the_whole(right[drawn.rank :], scene.whole(at), tolerance)
    direction = np.array([rng.uniform(-1, 1) for _ in null]) @ null
    direction *= stride / np.linalg.norm(direction)
    moved = {**at}
    step, there = direction, drawn.j
    residual = float("inf")
    for _ in range(ROUNDS):
        check()
        for s, d, scale in zip(scene.symbols, step, scene.scale, strict=True):
            moved[s] = moved[s] + float(d) * float(scale)
        f, there = scene.system(moved)
        residual = float(np.max(np.abs(f)))
        step = np.linalg.lstsq(there, -f, rcond=tolerance * SLACK)[0]
        if float(np.linalg.norm(step)) < tolerance * 1e-3:
            break
    moves = np.array([(moved[s] - at[s]) / k for s, k in zip(scene.symbols, scene.scale, strict=True)])
    if residual > tolerance * SLACK or float(moves @ direction) <= stride**2 / 2:
        return BLOCKED
    return _rank(there, tolerance)


def _own(whole: Any, tolerance: float) -> Any:
    """An orthonormal basis of the displacements of the whole, less those within the tolerance (a turn about a rod).

    Shifts move all places alike; a turn counts by what it does beside shifting, in sizes for a turn by 1.
    """
    if not whole.size:
        return whole
    sizes = np.abs(whole)
    alike = np.array([bool(np.all(row[row > 0] == row.max())) and row.max() > 0 for row in sizes])
    shifts = np.linalg.qr(whole[alike].T)[0].T if np.any(alike) else whole[:0]
    rest = whole[~alike] - (whole[~alike] @ shifts.T) @ shifts
    _, singular, right = np.linalg.svd(rest)
    return np.vstack([shifts, right[: int(np.sum(singular > tolerance * SLACK))]])


def _without_the_whole(null: Any, whole: Any, tolerance: float) -> Any:
    """The null space less the motions of the whole: those are motions anyway."""
    if not whole.size:
        return null
    inside = np.linalg.qr((_own(whole, tolerance) @ null.T).T)[0] if len(null) else null.T
    kept = np.linalg.svd(np.eye(len(null)) - inside @ inside.T)
    count = int(np.sum(kept[1] > HALF))
    return kept[2][:count] @ null if count else null
