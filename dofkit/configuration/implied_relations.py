"""Is a relation implied by others near the reference configuration?

Let S be relations that are independent at the reference P, and M the manifold of their solutions near P
[ImplicitFunctions]. A relation f is implied by S near P if and only if it vanishes on M. It is not sufficient that its
row is a combination of the rows of S at P: for three points on a line two distances give the third instantaneously
only. So f is expanded along a random curve of M: if it is not 0 there, it is not implied; if it is 0 to an order above
its degree, and at a distance, it vanishes on M with high probability [SchwartzZippel]. For geometry with a tolerance
the freedom without f is compared (`measured`).

The relations g_k of S that f needs are those with nonzero multipliers: df = sum l_k dg_k at every point of M. With A(s)
the derivatives of the g_k by the dependent columns along a curve of M and b(s) those of f, the row l(s) solves l A = b;
its coefficients are computed one after another with A at the point. A multiplier that is 0 at the point need not be 0
along the curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import mul

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.configuration.at_reference import ball_point, float_point
from dofkit.configuration.local.criteria import vanish_near
from dofkit.configuration.local.germ import random_direction
from dofkit.configuration.local.manifold import Manifold
from dofkit.configuration.measured.dimension import measured_freedom
from dofkit.configuration.rigid_motions import rigid_motions
from dofkit.configuration.variety import chart_of_rows, field_jacobian, point_at, pose_point, smaller
from dofkit.exact.matrices.dense import length
from dofkit.exact.matrices.sparse import SparseRow, factored, sparse_frame, transposed
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.points.series import Series
from dofkit.exact.residues import modulus
from dofkit.exact.ring.program import none_without_value, values
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart

#: Number of searches for points near the reference, and size of the random displacements, in the columns' scales.
STARTS, PERTURBATION = 12, 0.05
#: A point differs from the reference beyond `MOVED`; it satisfies a relation up to `SATISFIED` (half the digits).
MOVED, SATISFIED, TINY = 1e-3, 1e-6, 1e-300


@dataclass(frozen=True)
class ImpliedRelations:
    """Implications between the relations of a chart near the reference at t = 0; results are remembered."""

    chart: Chart
    reference: Mapping[Expr, Expr]
    _answers: dict[tuple[int, ...], bool | None] = field(default_factory=dict)

    def follows(self, row: int, others: Sequence[int], afar: bool = True) -> bool | None:
        """Return whether relation ``row`` vanishes near the reference where ``others``, independent there, do; or None.

        Without ``afar``, True means only that it vanishes to some order along a curve.
        """
        key = (int(afar), row, *sorted(others))
        if key not in self._answers:
            subchart = chart_of_rows(self.chart, sorted(key[1:]))
            pose = {**self.reference, ex.TIME: ex.ZERO}
            if self.chart.setting.tolerance is None:
                self._answers[key] = _on_manifold(subchart, pose, len(others), afar)
            else:
                self._answers[key] = _within_tolerance(subchart, pose, len(others))
        return self._answers[key]

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Return the ``others`` with nonzero multipliers along a curve; all of them if these cannot be computed."""
        numbers = sorted((row, *others))
        subchart = chart_of_rows(self.chart, numbers)
        point = pose_point(subchart, {**self.reference, ex.TIME: ex.ZERO}, 3)
        if point is None or "field" not in subchart.setting.engines or self.chart.setting.tolerance is not None:
            return list(others)
        try:
            rows = [k for k, i in enumerate(numbers) if i != row]
            matrix = field_jacobian(subchart, point, [subchart.nodes[k] for k in rows])
            frame = sparse_frame(matrix, len(subchart.columns), point.p)
            frame = replace(frame, rows=tuple(rows[k] for k in frame.rows))
            field = Manifold(subchart.ring, subchart.nodes, subchart.columns, frame, point)
            return [numbers[k] for k in needed_along(field, subchart.nodes[numbers.index(row)])]
        except (ArithmeticError, NoValueError):
            return list(others)

    def rigid(self, rows: Sequence[int]) -> int:
        """Return the dimension of the rigid motions of these relations; 0 if unknown, or coordinates do not occur."""
        subchart = chart_of_rows(self.chart, rows)
        point = pose_point(subchart, {**self.reference, ex.TIME: ex.ZERO}, 3)
        return 0 if point is None or len(subchart.symbols) < len(self.chart.symbols) else rigid_motions(subchart, point)

    def seem_to_follow(self, rows: Sequence[int], others: Sequence[int]) -> bool:
        """Return whether ``rows`` are satisfied at points near the reference that satisfy ``others``.

        This is numerical evidence, from random starts, for sets that are singular throughout. False also if half of the
        searches end at the reference, which says nothing.
        """
        chart = self.chart
        start = float_point(chart, self.reference)
        if start is None or "balls" not in chart.setting.engines or chart.setting.tolerance is not None:
            return False
        search = RealSearch(chart.ring, [chart.nodes[i] for i in others], chart.unknowns, chart.setting.positive)
        moved = 0
        for seed in range(STARTS):
            check()
            there = search.start(seed, {})
            for s, scale in zip(chart.symbols, chart.scales, strict=True):
                there[s] = start[s] + PERTURBATION * scale * there.get(s, 0.0)
            there = {**start, **{s: there[s] for s in chart.symbols}}
            if search.descend(there, seed) is None:
                continue
            if self._distance(there, rows) > SATISFIED:
                return False
            moved += any(abs(there[s] - start[s]) > MOVED * k for s, k in zip(chart.symbols, chart.scales, strict=True))
        return moved >= STARTS // 2

    def _distance(self, symbols: Mapping[Expr, float], rows: Sequence[int]) -> float:
        """Return the linearised distance, in the columns' scales, from a point to the zeros of some relations."""
        chart, point = self.chart, FloatPoint(symbols)
        at = values(chart.ring, point)
        columns = [c for c in chart.columns if c >= 0]
        scales = [k for c, k in zip(chart.columns, chart.scales, strict=True) if c >= 0]
        nodes = [chart.nodes[i] for i in rows]
        slopes = jacobian(chart.ring, at, point, nodes, columns, 0.0)
        sizes = [length(list(map(mul, row, scales))) + TINY for row in slopes]
        return max(abs(float(at[n])) / size for n, size in zip(nodes, sizes, strict=True))


def _on_manifold(chart: Chart, pose: Mapping[Expr, Expr], rank: int, afar: bool) -> bool | None:
    """Return whether the set of a chart is a manifold of codimension ``rank`` near the reference; None if undecided.

    ``rank`` is that of the relations without the one that is tested; if True, this one is implied. With ``afar`` they
    are also evaluated at a distance, in interval arithmetic.
    """
    if "field" not in chart.setting.engines:
        return None
    small, free = smaller(chart)
    eliminated = len(chart.columns) - len(small.columns) - free
    if not small.nodes:
        return eliminated == rank
    point = point_at(small, pose, 3)
    if point is None:
        return None
    rigid = rigid_motions(small, point)
    ball = ball_point(small, pose) if afar and "balls" in chart.setting.engines else None
    return vanish_near(small, point, ball, rigid, rank - eliminated)


@none_without_value
def _within_tolerance(chart: Chart, pose: Mapping[Expr, Expr], rank: int) -> bool | None:
    """Return whether the set of a chart has codimension ``rank`` within the tolerance; None if undecided."""
    if "balls" not in chart.setting.engines:
        return None
    freedom = measured_freedom(chart, pose)
    return None if freedom is None or freedom.dimension is None else freedom.dimension == chart.coordinates - rank


# Multipliers along a curve

#: Order to which multipliers are expanded.
ORDER = 4


def needed_along(field: Manifold, other: int) -> list[int]:
    """Return the numbers of the manifold's relations with nonzero multipliers in the dependent relation ``other``.

    They are computed over GF(p) along a random curve, to `ORDER`. Raises NoValueError.
    """
    curve = field.line(random_direction(field), ORDER)
    columns = [field.columns[c] for c in field.frame.dependent]
    *slopes, last = curve.slopes([*field.rows, other], columns)
    p = modulus(field.sample)
    orders = [[_sparse(row, k) for row in slopes] for k in range(ORDER)]
    turned = factored(transposed(orders[0], len(columns)), p)
    multipliers: list[list[int]] = []
    for k in range(ORDER):
        right = [int(v.coefficient(k)) for v in last]
        for j in range(1, k + 1):
            for row, factor in zip(orders[j], multipliers[k - j], strict=True):
                for c, v in row.items():
                    right[c] = (right[c] - factor * v) % p
        multipliers.append([int(v) for v in turned.solved(right)])
    return [field.frame.rows[i] for i in range(len(field.rows)) if any(row[i] for row in multipliers)]


def _sparse(row: Sequence[Series], k: int) -> SparseRow:
    """Return the coefficients of s^k of a row, without zeros."""
    return {c: v for c, series in enumerate(row) if (v := int(series.coefficient(k)))}
