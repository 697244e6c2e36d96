"""Relations between measured places in floating point, scaled so that numbers are fractions of the scene's size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dofkit.base.deadline import check
from dofkit.base.libraries import np
from dofkit.configuration.drawing.measured_frames import BodyFrame, frames_of, of_points, shifts, to_points
from dofkit.configuration.rigid_motions import displacements_real
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart
from dofkit.relations.setting import Setting

#: A singular value counts as 0 below tolerance * SLACK; between that and tolerance * GREY nothing is decided.
SLACK, GREY = 3.0, 30.0
#: How much rounding errors of places grow until they are residuals.
ROOM = 1e3
HALF = 0.5

Place = Mapping[Expr, float]


class MeasuredRelations:
    """The relations of a chart: columns of positions by the size, every row by its gradient in the coordinates.

    Time, where it is a column, is the last, in such a unit that no relation changes faster by it than by a shift.
    """

    def __init__(self, chart: Chart, setting: Setting, at: Place) -> None:
        self.chart = chart
        lengths = {c.name for c in setting.roles if c.role in ("x", "y", "z")}
        self.symbols = list(chart.symbols)
        self.frames = frames_of(setting.bodies, setting.centre, self.symbols)
        self.coordinates = chart.coordinates
        self.lengths = np.array([str(s.args[-1]) in lengths and s != ex.TIME for s in self.symbols], dtype=bool)
        self.scale = np.where(self.lengths, setting.size, 1.0)
        if chart.time is not None and chart.nodes:
            fastest = float(np.max(np.abs(self.system(at)[1][:, chart.time])))
            self.scale[chart.time] = 1 / fastest if fastest > 0 else 1.0

    def lever(self, j: Any) -> float:
        """How many sizes from the origin the relations act: the largest effect of a turn by that of a shift."""
        shifts = self.lengths
        turns = ~shifts & (np.arange(len(shifts)) < self.coordinates)
        both = np.abs(j[:, shifts]).max(axis=1, initial=0), np.abs(j[:, turns]).max(axis=1, initial=0)
        mixed = both[0] > 0
        return float(np.max(both[1][mixed] / both[0][mixed], initial=1.0))

    def blurs(self, at: Place) -> float:
        """What rounding to floating point does to places, by the size, with room for what cancels."""
        places = np.array([abs(at.get(s, 0.0)) for s in self.symbols])[self.lengths] / self.scale[self.lengths]
        return ROOM * float(np.finfo(float).eps) * float(np.max(places, initial=0.0))

    def whole(self, at: Place) -> Any:
        """Displacements of everything as one body, in scaled coordinates."""
        variables = self.chart.ring.vars
        fields = displacements_real(self.chart, lambda i: at.get(variables[i].key, 0.0) if i >= 0 else 0.0)
        return to_points(self.frames, fields, at, self.symbols) / self.scale if fields.size else fields

    def system(self, at: Place, norms: Any = None) -> tuple[Any, Any]:
        """(residuals as fractions of the size, Jacobian), rows by ``norms`` or by their own gradients."""
        f, j = self._unscaled(at)
        if norms is None:
            norms = self._lengths(j)
        return f / norms, j / norms[:, None]

    def norms(self, at: Place) -> Any:
        """The lengths of gradients, 1 for those that are 0."""
        return self._lengths(self._unscaled(at)[1])

    def _unscaled(self, at: Place) -> tuple[Any, Any]:
        """The relations, and their derivatives by scaled columns."""
        check()
        point = FloatPoint(at, 0)
        out = values(self.chart.ring, point)
        f = np.array([out[n] for n in self.chart.nodes], dtype=float)
        j = np.array(jacobian(self.chart.ring, out, point, self.chart.nodes, self.chart.columns, 0.0), dtype=float)
        j = j.reshape(len(f), len(self.symbols))
        return f, of_points(self.frames, j, at, self.symbols) * self.scale

    def _lengths(self, j: Any) -> Any:
        norms = np.linalg.norm(j[:, : self.coordinates], axis=1)
        return np.where(norms > 0, norms, 1.0)

    def moved(self, at: Place, step: Any) -> dict[Expr, float]:
        """The place a step away, in scaled coordinates."""
        found = dict(at)
        for s, d, scale in zip(self.symbols, step, self.scale, strict=True):
            found[s] = found.get(s, 0.0) + float(d) * float(scale)
        for frame in self.frames:
            for i, d in zip(frame.places, self._arm(frame, at) - self._arm(frame, found), strict=True):
                found[self.symbols[i]] += float(d)
        return found

    def _arm(self, frame: BodyFrame, at: Place) -> Any:
        """From the body's origin to the point that it is told by."""
        return shifts(frame, [at.get(self.symbols[i], 0.0) for i in frame.angles])[0]

    def between(self, start: Place, end: Place) -> Any:
        """The way from one place to another, in scaled coordinates."""
        ways = [end.get(s, 0.0) - start.get(s, 0.0) for s in self.symbols]
        found = np.array(ways)
        for frame in self.frames:
            found[frame.places] += self._arm(frame, end) - self._arm(frame, start)
        return found / self.scale


@dataclass(frozen=True)
class MeasuredDrawing:
    """The relations as drawn: the Jacobian ``j`` at ``at`` (m x n), and its ``rank`` r within the tolerance."""

    relations: MeasuredRelations
    at: Place
    j: Any
    rank: int
    tolerance: float

    @cached_property
    def norms(self) -> Any:
        """By what the rows are divided, here and nearby."""
        return self.relations.norms(self.at)

    @cached_property
    def parts(self) -> tuple[Any, Any, Any]:
        """The singular value decomposition of J."""
        left, singular, right = np.linalg.svd(self.j)
        return left, singular, right

    @property
    def kept(self) -> Any:
        """r orthonormal combinations of rows that are independent, r x m."""
        return self.parts[0].T[: self.rank]

    @property
    def stresses(self) -> Any:
        """Orthonormal combinations of rows that are 0 within the tolerance, (m - r) x m."""
        return self.parts[0].T[self.rank :]

    @property
    def least(self) -> float:
        """The least singular value that counts."""
        return float(self.parts[1][self.rank - 1]) if self.rank else 1.0

    @cached_property
    def ways(self) -> Any:
        """An orthonormal basis of the first-order motions across those of the whole, w x n."""
        return without_the_whole(self.parts[2][self.rank :], self.relations.whole(self.at), self.tolerance)


def clear_rank(j: Any, tolerance: float) -> int | None:
    """Singular values above the tolerance; None where one is near it."""
    singular = np.linalg.svd(j, compute_uv=False)
    if np.any((singular > tolerance * SLACK) & (singular < tolerance * GREY)):
        return None
    return int(np.sum(singular > tolerance * SLACK))


def own_motions(whole: Any, tolerance: float) -> Any:
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


def without_the_whole(null: Any, whole: Any, tolerance: float) -> Any:
    """The null space less the motions of the whole: those are motions anyway."""
    if not whole.size or not len(null):
        return null
    inside = np.linalg.qr((own_motions(whole, tolerance) @ null.T).T)[0]
    kept = np.linalg.svd(np.eye(len(null)) - inside @ inside.T)
    count = int(np.sum(kept[1] > HALF))
    return kept[2][:count] @ null
