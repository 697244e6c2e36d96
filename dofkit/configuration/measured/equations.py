"""Equations of geometry with a tolerance in floating point, scaled: numbers are fractions of the scene's size."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flint import arb

from dofkit.base.deadline import check
from dofkit.base.libraries import np, nx
from dofkit.configuration.local.quadratic_cone import definite_combination
from dofkit.configuration.rigid_motions import displacements_real
from dofkit.exact.matrices.dense import GRAM_SCHMIDT_PASSES
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Chart, coordinates_of
from dofkit.relations.setting import Setting
from dofkit.system import GROUND

#: A singular value counts as 0 below tolerance * SLACK; between that and tolerance * GREY the rank is undecided.
SLACK, GREY = 3.0, 30.0
#: Factor by which rounding errors of positions grow in residuals.
ROUNDING_GROWTH = 1e3
#: Flexes are directions of which at least this part is orthogonal to the rigid motions.
HALF = 0.5

Point = Mapping[Expr, float]


class ScaledEquations:
    """The equations of a chart, with lengths in units of the scene's size and rows divided by their gradients.

    A rotation about a distant origin moves everything by far more than a translation. So a body's position p is
    replaced by P = p + R (c - s), the position of its material point at the scene's centre c. Time, if it occurs, is
    the last column, in such a unit that no equation changes faster with it than with a translation.
    """

    def __init__(self, chart: Chart, at: Point) -> None:
        self.chart, setting = chart, chart.setting
        self.symbols = chart.symbols
        self.coordinates = chart.coordinates
        self._arms = _Arms(setting, chart.symbols)
        lengths = {c.name for c in setting.roles if c.role in ("x", "y", "z")}
        self.lengths = np.array([str(s.args[-1]) in lengths and s != ex.TIME for s in self.symbols], dtype=bool)
        self.scale = np.where(self.lengths, setting.size, 1.0)
        if chart.time is not None and chart.nodes:
            fastest = float(np.max(np.abs(self.system(at)[1][:, chart.time])))
            self.scale[chart.time] = 1 / fastest if fastest > 0 else 1.0

    def lever(self, j: Any) -> float:
        """Return the largest ratio, at least 1, of the derivatives of an equation by angles and by lengths."""
        turns = ~self.lengths & (np.arange(len(self.symbols)) < self.coordinates)
        shifted, turned = (np.abs(j[:, part]).max(axis=1, initial=0) for part in (self.lengths, turns))
        mixed = shifted > 0
        return float(np.max(turned[mixed] / shifted[mixed], initial=1.0))

    def rounding(self, at: Point) -> float:
        """Return a bound on the residuals caused by rounding of the positions, and of the bodies' arms."""
        numbers = np.maximum(np.abs(self._vector(at)), np.abs(self._arms.values(at)))
        positions = numbers[self.lengths] / self.scale[self.lengths]
        return ROUNDING_GROWTH * float(np.finfo(float).eps) * float(np.max(positions, initial=0.0))

    def rigid_motions(self, at: Point) -> Any:
        """Return velocities of rigid motions of the system that span them, as rows in scaled columns."""
        fields = np.array(displacements_real(self.chart, FloatPoint(at))).reshape(-1, len(self.symbols))
        return (fields + fields @ self._arms.slopes(at).T) / self.scale if fields.size else fields

    def system(self, at: Point, norms: Any = None) -> tuple[Any, Any]:
        """Return the residuals (m) and the Jacobian (m x n), rows divided by ``norms``, by default their gradients."""
        f, j = self._with_plain_rows(at)
        if norms is None:
            norms = self._gradients(j)
        return f / norms, j / norms[:, None]

    def norms(self, at: Point) -> Any:
        """Return the lengths of the gradients, 1 for a gradient that is 0."""
        return self._gradients(self._with_plain_rows(at)[1])

    def _with_plain_rows(self, at: Point) -> tuple[Any, Any]:
        """Return residuals and Jacobian in the scaled columns (positions are P), without scaling rows."""
        check()
        point = FloatPoint(at)
        out = values(self.chart.ring, point)
        f = np.array([out[n] for n in self.chart.nodes], dtype=float)
        j = np.array(jacobian(self.chart.ring, out, point, self.chart.nodes, self.chart.columns, 0.0), dtype=float)
        j = j.reshape(len(f), len(self.symbols))
        return f, (j - j @ self._arms.slopes(at)) * self.scale

    def _gradients(self, j: Any) -> Any:
        """Return the lengths of the rows' derivatives by the coordinates, 1 where they are 0."""
        norms = np.linalg.norm(j[:, : self.coordinates], axis=1)
        return np.where(norms > 0, norms, 1.0)

    def _vector(self, at: Point) -> Any:
        return np.array([at.get(s, 0.0) for s in self.symbols])

    def moved(self, at: Point, step: Any) -> dict[Expr, float]:
        """Return the point that is a step, in scaled columns, away."""
        end = self._vector(at) + step * self.scale
        turned = {**at, **dict(zip(self.symbols, end.tolist(), strict=True))}
        end += self._arms.values(at) - self._arms.values(turned)
        return {**at, **dict(zip(self.symbols, end.tolist(), strict=True))}

    def between(self, start: Point, end: Point) -> Any:
        """Return the step, in scaled columns, from one point to another."""
        first, last = (self._vector(at) + self._arms.values(at) for at in (start, end))
        return (last - first) / self.scale


class _Arms:
    """R (c - s) of every body, from its origin to its material point at the scene's centre, over the columns."""

    def __init__(self, setting: Setting, symbols: Sequence[Expr]) -> None:
        self.symbols = symbols
        columns = {s: i for i, s in enumerate(symbols)}
        self.rows: list[int] = []
        arms: list[Expr] = []
        for body, arm in setting.arms.items():
            positions = [ex.coordinate(c.name) for c in setting.roles if c.owner == body and c.role in ("x", "y", "z")]
            if all(s in columns for s in positions) and all(e.symbols <= columns.keys() for e in arm):
                self.rows += [columns[s] for s in positions]
                arms += arm
        self.ring = Ring(arms)
        self.nodes = [self.ring.node(e) for e in arms]
        indices = [self.ring.var_index(s) for s in symbols]
        self.columns = [-1 if i is None else i for i in indices]

    def values(self, at: Point) -> Any:
        """Return the arms as one vector over the columns, 0 where a column is no position of a body."""
        return self._evaluated(at)[0]

    def slopes(self, at: Point) -> Any:
        """Return the derivatives of the arms, n x n over the columns."""
        return self._evaluated(at)[1]

    def _evaluated(self, at: Point) -> tuple[Any, Any]:
        """Return the arms as a vector over the columns, and their derivatives by all columns; 0 in other columns."""
        n = len(self.symbols)
        arms, slopes = np.zeros(n), np.zeros((n, n))
        if self.rows:
            point = FloatPoint({**dict.fromkeys(self.symbols, 0.0), **at})
            out = values(self.ring, point)
            arms[self.rows] = [out[node] for node in self.nodes]
            slopes[self.rows] = jacobian(self.ring, out, point, self.nodes, self.columns, 0.0)
        return arms, slopes


@dataclass(frozen=True)
class MeasuredPose:
    """Equations at a point: their Jacobian ``j`` (m x n) at ``at``, and its ``rank`` r within the tolerance."""

    equations: ScaledEquations
    at: Point
    j: Any
    rank: int
    tolerance: float

    @cached_property
    def norms(self) -> Any:
        """The numbers by which rows are divided, at this point and nearby."""
        return self.equations.norms(self.at)

    @cached_property
    def _svd(self) -> tuple[Any, Any, Any]:
        return np.linalg.svd(self.j)

    @property
    def independent(self) -> Any:
        """Orthonormal combinations of the equations that are independent, r x m."""
        return self._svd[0].T[: self.rank]

    @property
    def stresses(self) -> Any:
        """Orthonormal combinations of the equations with gradient 0 within the tolerance, (m - r) x m."""
        return self._svd[0].T[self.rank :]

    @property
    def least(self) -> float:
        """The least singular value that counts."""
        return float(self._svd[1][self.rank - 1]) if self.rank else 1.0

    @cached_property
    def rigid_motions(self) -> Any:
        """An orthonormal basis of the rigid motions of the system, without rotations that are 0 within the tolerance.

        The size of a rotation is that of its part orthogonal to translations: 0 for a rod's rotation about its axis.
        """
        motions = self.equations.rigid_motions(self.at)
        if not motions.size:
            return motions
        sizes = np.abs(motions)
        shift = np.array([bool(np.all(row[row > 0] == row.max())) and row.max() > 0 for row in sizes])
        shifts = np.linalg.qr(motions[shift].T)[0].T if np.any(shift) else motions[:0]
        turns = motions[~shift] - (motions[~shift] @ shifts.T) @ shifts
        _, singular, right = np.linalg.svd(turns)
        return np.vstack([shifts, right[: int(np.sum(singular > self.tolerance * SLACK))]])

    @cached_property
    def flexes(self) -> Any:
        """An orthonormal basis of the infinitesimal motions modulo rigid motions of the system, w x n."""
        null = self._svd[2][self.rank :]
        if not self.rigid_motions.size or not len(null):
            return null
        inside = np.linalg.qr((self.rigid_motions @ null.T).T)[0]
        _, part, right = np.linalg.svd(np.eye(len(null)) - inside @ inside.T)
        return right[: int(np.sum(part > HALF))] @ null


def clear_rank(j: Any, tolerance: float) -> int | None:
    """Return the number of singular values above the tolerance, or None if one is near it."""
    singular = np.linalg.svd(j, compute_uv=False)
    if np.any((singular > tolerance * SLACK) & (singular < tolerance * GREY)):
        return None
    return int(np.sum(singular > tolerance * SLACK))


def independent_rows(j: Any, rank: int, tolerance: float) -> list[int]:
    """Return the first rows, in order, that are independent within the tolerance: by their least singular value."""
    rows = _distant_rows(j, rank, tolerance)  # a quick choice, which need not be independent together
    if _are_independent(j[rows], tolerance):
        return rows
    rows = []
    for r in range(len(j)):
        if len(rows) == rank:
            break
        check()
        if _are_independent(j[[*rows, r]], tolerance):
            rows.append(r)
    return rows


def _are_independent(rows: Any, tolerance: float) -> bool:
    """Return whether the least singular value of some rows counts as nonzero."""
    return not len(rows) or float(np.linalg.svd(rows, compute_uv=False)[-1]) > tolerance * SLACK


def _distant_rows(j: Any, rank: int, tolerance: float) -> list[int]:
    """Return the first ``rank`` rows whose distance from the span of those before them is above SLACK * tolerance."""
    rows, basis = list[int](), np.zeros((0, j.shape[1]))
    for r, row in enumerate(j):
        if len(rows) == rank:
            break
        for _ in range(GRAM_SCHMIDT_PASSES):
            row = row - basis.T @ (basis @ row)
        distance = float(np.linalg.norm(row))
        if distance > tolerance * SLACK:
            rows.append(r)
            basis = np.vstack([basis, row / distance])
    return rows


def is_tree(block: Block, setting: Setting) -> bool:
    """Return whether all rows are of geometric constraints that join particles, bodies and the ground without a loop.

    Their equations are then independent for all numbers, wherever they are satisfied.
    """
    owners = {c.name: c.owner for c in setting.roles}
    ends = {(row.constraint, owners[name]) for row in block.rows for name in coordinates_of(row.piece)}
    grounded = [(i, GROUND) for i, k in Counter(i for i, _ in ends).items() if k == 1]
    geometric = all(i in setting.geometric and end is not None for i, end in ends)
    return geometric and bool(nx.is_forest(nx.Graph([*ends, *grounded])))


def pose_of_block(chart: Chart) -> Mapping[Expr, Expr] | None:
    """Return the reference configuration; without one, the given initial values if these are enough, or None."""
    setting = chart.setting
    if setting.reference is not None:
        return setting.reference
    mentioned = {v.key for v in chart.ring.vars if v.kind == "symbol"} - {ex.TIME}
    return setting.pose if mentioned <= setting.pose.keys() else None


# The second order, with bounds on its change within the tolerance

#: Step of the differences for second derivatives, and their relative accuracy.
DELTA, ROUGH = 1e-5, 1e-6
#: The number of factors of a form that are perturbed by |J - J_0| / s: its stress and both motions.
PERTURBATIONS = 3.0


class StressForms:
    """The quadratic ``forms`` (k x w x w) of k stresses on a pose's w flexes; ``noise`` bounds the error of each entry.

    Let J be the Jacobian, of rank r within the tolerance, and J_0 that of an exact geometry of rank r within it. A
    stress l, with l J_0 = 0, and a motion v, with J_0 v = 0, give Q_l(v) = sum l_i (d^2 f_i)(v, v), the second order of
    the dependent equation l f on the manifold of the others. The null spaces of J and J_0 differ by |J - J_0| / s, s
    the least singular value that counts [Wedin1972]. This changes the forms for the stress and for both motions, times
    the second derivatives, which change as well. A proof with balls of this radius is valid for all such J_0.
    """

    def __init__(self, pose: MeasuredPose) -> None:
        equations, flexes = pose.equations, pose.flexes
        forms = np.zeros((len(pose.stresses), len(flexes), len(flexes)))
        slopes = []
        for a, v in enumerate(flexes):
            ahead = equations.system(equations.moved(pose.at, DELTA * v), pose.norms)[1]
            back = equations.system(equations.moved(pose.at, -DELTA * v), pose.norms)[1]
            slope = (ahead - back) / (2 * DELTA)
            slopes.append(slope)
            forms[:, a, :] = pose.stresses @ slope @ flexes.T
        self.forms = (forms + forms.transpose(0, 2, 1)) / 2
        bend = float(np.linalg.norm(np.hstack(slopes), 2))
        turned = SLACK * pose.tolerance / pose.least
        perturbation = PERTURBATIONS * turned * (1 + turned) * bend + SLACK * pose.tolerance
        self.noise = perturbation + ROUGH * (1 + bend)
        self.flexes = len(flexes)

    @cached_property
    def balls(self) -> list[list[list[arb]]]:
        """The forms as balls, with ``noise`` as radius."""
        return [[[arb(v, self.noise) for v in row] for row in form.tolist()] for form in self.forms]

    @cached_property
    def vanish(self) -> bool:
        """Whether all forms may be 0."""
        return all(v.contains(0) for form in self.balls for row in form for v in row)

    @property
    def is_indefinite(self) -> bool:
        """Whether there is exactly one form, and it has eigenvalues of both signs beyond their error ``noise``."""
        if len(self.forms) != 1:
            return False
        values = np.linalg.eigvalsh(self.forms[0])
        return bool(values[0] < -self.noise and values[-1] > self.noise)

    @property
    def definite(self) -> bool:
        """Whether a linear combination of the forms is definite."""
        for spectrum in np.linalg.eigvalsh(self.forms):
            if np.all(spectrum > self.noise) or np.all(spectrum < -self.noise):
                return True
        return definite_combination(self.balls, self.flexes)
