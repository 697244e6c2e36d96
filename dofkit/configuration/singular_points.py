"""Singular real configurations without exact coordinates: brought to high precision, then looked at to second order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.base.deadline import check
from dofkit.base.libraries import np
from dofkit.configuration.local.criteria import numeric_dimension
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.configuration.rigid_motions import rigid_motions_real
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.matrices.certified import independent_part
from dofkit.exact.points.balls import BallPoint, jacobian
from dofkit.exact.points.frames import Pivots
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.program import values
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart

#: Working precision, and the radius given to the result.
BITS, RADIUS_BITS = 1400, 200
#: Steps at the most; relations are smaller than this at a singular point that was reached, and not near a small gap.
STEPS, RESIDUAL_BITS = 800, 600
#: A combination of dependent rows is smaller than this there: surfaces that meet by 10^-64 are no longer tangent.
DEPENDENT_BITS = 280
#: Added to the diagonal of a Gram matrix, so that it has an inverse.
SHIFT = arb(2) ** (-BITS // 2)
#: Relations that are brought to high precision at the most; an entry of a Jacobian that is taken for 0.
MAX_ROWS, TINY = 20, 1e-12


def numeric_local(chart: Chart, real: RealPoint) -> LocalDimension | None:
    """The local dimension near a singular point that a real search ran into; None where it cannot be told."""
    if len(chart.nodes) > MAX_ROWS:
        return None
    with ctx.workprec(BITS):
        try:
            return _dimension_near(chart, real)
        except NoValueError:
            return None


@raising_no_value
def _dimension_near(chart: Chart, real: RealPoint) -> LocalDimension | None:
    point = _converge(chart, real)
    if point is None:
        return None
    at = values(chart.ring, point)
    columns = [c for c in chart.columns if c >= 0]
    place = [i for i, c in enumerate(chart.columns) if c >= 0]
    exact = jacobian(chart.ring, at, point, chart.nodes, columns, arb(0))
    j = np.array([[float(v.mid()) for v in row] for row in exact])
    j[np.linalg.norm(j, axis=1) < TINY] = 0.0
    _, gap, rows, pivots = independent_part(j)
    if gap < 1e6:
        return None
    dependent = tuple(place[c] for c in pivots)
    free = tuple(i for i in range(len(chart.columns)) if i not in set(dependent))
    frame = Pivots(tuple(rows), dependent, free)
    manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, point, chart.scales)
    rigid = rigid_motions_real(chart, lambda i: float(at[chart.ring.var_node[i]].mid()))
    return numeric_dimension(manifold, rigid, chart.time)


def _converge(chart: Chart, real: RealPoint) -> BallPoint | None:
    """Return the point to which minimal steps of Newton's method lead, with balls; None if it is regular, or not found.

    Each step about halves the distance to a point where the dependent relations are Morse-Bott, so that it reaches high
    precision in as many steps as that has bits.
    """
    symbols: dict[Any, arb] = {s: arb(v.mid()) if isinstance(v, arb) else arb(v) for s, v in real.point.symbols.items()}
    moved = [s for s in chart.unknowns if chart.ring.var_index(s) is not None]
    for _ in range(STEPS):
        f, j = _system(chart, symbols, moved)
        if all(abs(v) < arb(2) ** -RESIDUAL_BITS for v in f):
            break
        for s, d in zip(moved, _minimal_step(j, f), strict=True):
            symbols[s] = (symbols[s] - d).mid()
    else:
        return None
    if not _is_singular(_system(chart, symbols, moved)[1]):
        return None
    radius = arb(0, arb(2) ** -RADIUS_BITS)
    return BallPoint({s: v + radius if s in set(moved) else v for s, v in symbols.items()}, 0)


def _system(chart: Chart, symbols: Mapping[Any, arb], moved: Sequence[Expr]) -> tuple[list[arb], list[list[arb]]]:
    """Return the relations and their Jacobian, as numbers."""
    check()
    point = BallPoint(symbols, 0)
    at = values(chart.ring, point)
    indices = [chart.ring.var_index(s) or 0 for s in moved]
    j = jacobian(chart.ring, at, point, chart.nodes, indices, arb(0))
    return [arb(at[n].mid()) for n in chart.nodes], [[v.mid() for v in row] for row in j]


def _is_singular(j: Sequence[Sequence[arb]]) -> bool:
    """Return whether rows are dependent: in floating point, and then to high precision."""
    matrix = np.array([[float(v) for v in row] for row in j])
    if not np.isfinite(matrix).all():
        return False
    rank, _, rows, pivots = independent_part(np.where(abs(matrix) < TINY, 0.0, matrix))
    others = [list(row) for r, row in enumerate(j) if r not in rows]
    if rank == 0 or not others:
        sums = others
    else:
        basis = arb_mat([[j[r][c] for c in pivots] for r in rows])
        weights = arb_mat([[row[c] for c in pivots] for row in others]) * basis.inv()
        sums = (arb_mat(others) - weights * arb_mat([list(j[r]) for r in rows])).tolist()
    return bool(others) and all(abs(v.mid()) < arb(2) ** -DEPENDENT_BITS for row in sums for v in row)


def _minimal_step(j: Sequence[Sequence[arb]], f: Sequence[arb]) -> list[arb]:
    """Return J^T (J J^T)^-1 f."""
    matrix = arb_mat(j)
    gram = matrix * matrix.transpose()
    n = gram.nrows()
    for i in range(n):
        gram[i, i] = gram[i, i].mid() + SHIFT
    step = matrix.transpose() * gram.solve(arb_mat([[v] for v in f]))
    return [step[i, 0].mid() for i in range(step.nrows())]
