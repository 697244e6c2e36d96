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
#: Steps of Gauss and Newton, each of which about halves the distance to a singular point; then of Newton's for the
#: equations of a singular point, each of which squares it.
STEPS, SINGULAR_STEPS = 14, 9
#: Added to the diagonal of a Gram matrix, so that it has an inverse.
SHIFT = arb(2) ** (-BITS // 2)
#: Second derivatives are differences over so short a way.
WAY = arb(2) ** -450
#: Relations are smaller than this at a singular point that was reached; a gap of 10^-64 and its square are not.
RESIDUAL_BITS = 450
MAX_ROWS = 40
#: A gradient shorter than this at the converged point is taken for 0.
TINY = 1e-12


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
    """A point with f = 0, J^T l = 0 for as many independent l as rows are dependent, in high precision.

    These equations are regular where the dependent relations are Morse-Bott (deflation [LeykinVerscheldeZhao2006]).
    None where they are not, and where the point is a regular one, on something very small.
    """
    symbols: dict[Any, arb] = {s: arb(v.mid()) if isinstance(v, arb) else arb(v) for s, v in real.point.symbols.items()}
    moved = [s for s in chart.unknowns if chart.ring.var_index(s) is not None]
    for _ in range(STEPS):
        f, j = _system(chart, symbols, moved)
        _move(symbols, moved, _minimal_step(j, f))
    multipliers = _left_kernel(_system(chart, symbols, moved)[1])
    if not multipliers:
        return None
    for _ in range(SINGULAR_STEPS):
        size = _singular_step(chart, symbols, moved, multipliers)
        if size < arb(2) ** (-2 * RADIUS_BITS):
            break
    else:
        return None
    if not _on_the_set(chart, symbols, moved, multipliers):
        return None
    radius = arb(0, arb(2) ** -RADIUS_BITS)
    return BallPoint({s: v + radius if s in set(moved) else v for s, v in symbols.items()}, 0)


def _system(chart: Chart, symbols: Mapping[Any, arb], moved: Sequence[Expr]) -> tuple[list[arb], list[list[arb]]]:
    """The relations and their Jacobian, as numbers."""
    check()
    point = BallPoint(symbols, 0)
    at = values(chart.ring, point)
    indices = [chart.ring.var_index(s) or 0 for s in moved]
    j = jacobian(chart.ring, at, point, chart.nodes, indices, arb(0))
    return [arb(at[n].mid()) for n in chart.nodes], [[v.mid() for v in row] for row in j]


def _move(symbols: dict[Any, arb], moved: Sequence[Expr], step: Sequence[arb]) -> None:
    for s, d in zip(moved, step, strict=True):
        symbols[s] = (symbols[s] - d).mid()


def _left_kernel(j: Sequence[Sequence[arb]]) -> list[list[arb]]:
    """Vectors l with J^T l = 0, as far as floating point tells."""
    matrix = np.array([[float(v) for v in row] for row in j])
    if not np.isfinite(matrix).all():
        return []
    norms = np.linalg.norm(matrix, axis=1)
    norms[norms < TINY] = 1.0
    rank, _, _, _ = independent_part(np.where(abs(matrix) < TINY, 0.0, matrix))
    left = np.linalg.svd(matrix / norms[:, None])[0]
    return [[arb(float(v / n)) for v, n in zip(column, norms, strict=True)] for column in left.T[rank:]]


def _singular_step(chart: Chart, symbols: dict[Any, arb], moved: Sequence[Expr], multipliers: list[list[arb]]) -> arb:
    """A step of Newton's for f = 0, J^T l = 0, with every l moved at right angles to all of them; its size."""
    f, j = _system(chart, symbols, moved)
    beside = [_system(chart, {**symbols, s: symbols[s] + WAY}, moved)[1] for s in moved]
    m, n, k = len(f), len(moved), len(multipliers)
    rows = [[*row, *([arb(0)] * (m * k))] for row in j]
    wrong = list(f)
    for a, weights in enumerate(multipliers):
        wrong += _combined(j, weights)
        ahead = [_combined(other, weights) for other in beside]
        for c in range(n):
            row = [(ahead[b][c] - wrong[m + a * n + c]) / WAY for b in range(n)] + [arb(0)] * (m * k)
            row[n + a * m : n + (a + 1) * m] = [j[i][c] for i in range(m)]
            rows.append(row)
        for fixed in multipliers:
            row = [arb(0)] * (n + m * k)
            row[n + a * m : n + (a + 1) * m] = fixed
            rows.append(row)
    for a in reversed(range(k)):
        wrong[m + (a + 1) * n : m + (a + 1) * n] = [arb(0)] * k
    step = _least_squares(rows, wrong)
    _move(symbols, moved, step[:n])
    for a, weights in enumerate(multipliers):
        multipliers[a] = [(w - d).mid() for w, d in zip(weights, step[n + a * m :], strict=False)]
    return max((abs(d) for d in step), default=arb(0))


def _combined(j: Sequence[Sequence[arb]], weights: Sequence[arb]) -> list[arb]:
    """J^T l."""
    product = arb_mat([list(weights)]) * arb_mat([list(row) for row in j])
    return [product[0, c].mid() for c in range(product.ncols())]


def _least_squares(rows: Sequence[Sequence[arb]], wrong: Sequence[arb]) -> list[arb]:
    """(A^T A + |f|)^-1 A^T f: it squares the error also where solutions are not alone (Levenberg and Marquardt)."""
    matrix = arb_mat([[v.mid() for v in row] for row in rows])
    gram = matrix.transpose() * matrix
    shift = SHIFT + max(abs(v) for v in wrong).mid()
    for i in range(gram.nrows()):
        gram[i, i] = gram[i, i] + shift
    step = arb_mat([[v.mid() for v in gram.solve(matrix.transpose() * arb_mat([[v] for v in wrong])).entries()]])
    return [step[0, i] for i in range(step.ncols())]


def _on_the_set(
    chart: Chart, symbols: Mapping[Any, arb], moved: Sequence[Expr], multipliers: Sequence[Sequence[arb]]
) -> bool:
    """Do the relations hold there, and are they dependent? Least squares stop elsewhere too."""
    f, j = _system(chart, symbols, moved)
    left = [v for weights in multipliers for v in _combined(j, weights)]
    return all(abs(v) < arb(2) ** -RESIDUAL_BITS for v in (*f, *left))


def _minimal_step(j: Sequence[Sequence[arb]], f: Sequence[arb]) -> list[arb]:
    """J^T (J J^T)^-1 f."""
    matrix = arb_mat([[v.mid() for v in row] for row in j])
    gram = matrix * matrix.transpose()
    n = gram.nrows()
    for i in range(n):
        gram[i, i] = gram[i, i] + SHIFT
    weights = gram.solve(arb_mat([[v] for v in f]))
    step = matrix.transpose() * weights
    return [step[i, 0].mid() for i in range(step.nrows())]
