"""Singular real configurations without exact coordinates: brought to high precision, then looked at to second order."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from flint import arb, arb_mat, ctx

from dofkit.deadline import check
from dofkit.exact.balls import BallPoint, OutsideDomainError, RealPoint, jacobian
from dofkit.exact.floats import independent_part
from dofkit.exact.program import values
from dofkit.expr import Expr
from dofkit.forms import Frame
from dofkit.local_chart import Chart
from dofkit.manifold import Local, Manifold
from dofkit.motion import numeric_dimension
from dofkit.rigid import rigid_motions_real

#: Working precision, steps, and the radius given to the result.
BITS, STEPS, RADIUS_BITS = 2800, 60, 250
#: Each step halves the distance to a singular point; from here on every third is taken twice, which squares it.
SETTLED = 8
#: Relations are smaller than this at a singular point that was reached; a gap of 10^-64 and its square are not.
RESIDUAL_BITS = 1000
#: So far from the point two more steps show whether each halves the distance, or goes to a regular point at once.
ASIDE_BITS = 450
MAX_ROWS = 40
#: A gradient shorter than this at the converged point is taken for 0.
TINY = 1e-12


def numeric_local(chart: Chart, real: RealPoint) -> Local | None:
    """The local dimension near a singular point that a real search ran into; None where it cannot be told."""
    if len(chart.nodes) > MAX_ROWS:
        return None
    old = ctx.prec
    ctx.prec = BITS
    try:
        return _look(chart, real)
    except (ZeroDivisionError, OutsideDomainError):
        return None
    finally:
        ctx.prec = old


def _look(chart: Chart, real: RealPoint) -> Local | None:
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
    frame = Frame(tuple(rows), dependent, free)
    manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, point, chart.scales)
    rigid = rigid_motions_real(chart, lambda i: float(at[chart.ring.var_node[i]].mid()))
    return numeric_dimension(manifold, rigid, chart.time)


def _converge(chart: Chart, real: RealPoint) -> BallPoint | None:
    """Gauss-Newton with minimal steps in high precision; where each halves the error, two at once leave its square.

    None where the steps do better: the point is a regular one, on something very small.
    """
    symbols: dict[Any, arb] = {s: arb(v.mid()) if isinstance(v, arb) else arb(v) for s, v in real.point.symbols.items()}
    moved = [s for s in chart.unknowns if chart.ring.var_index(s) is not None]
    for number in range(STEPS):
        times = 2 if number >= SETTLED and number % 3 == 2 else 1
        size = _stepped(chart, symbols, moved, times)
        if size < arb(2) ** (-2 * RADIUS_BITS):
            break
    else:
        return None
    if not _on_the_set(chart, BallPoint(symbols, 0)) or not _halving(chart, symbols, moved):
        return None
    radius = arb(0, arb(2) ** -RADIUS_BITS)
    return BallPoint({s: v + radius if s in set(moved) else v for s, v in symbols.items()}, 0)


def _stepped(chart: Chart, symbols: dict[Any, arb], moved: Sequence[Expr], times: int = 1) -> arb:
    """Move by so many times the step of Gauss and Newton; its size."""
    check()
    point = BallPoint(symbols, 0)
    at = values(chart.ring, point)
    f = [arb(at[n].mid()) for n in chart.nodes]
    indices = [chart.ring.var_index(s) or 0 for s in moved]
    step = _minimal_step(jacobian(chart.ring, at, point, chart.nodes, indices, arb(0)), f)
    for s, d in zip(moved, step, strict=True):
        symbols[s] = (symbols[s] - times * d).mid()
    return max((abs(d) for d in step), default=arb(0))


def _halving(chart: Chart, symbols: Mapping[Any, arb], moved: Sequence[Expr]) -> bool:
    """Is the point singular: from beside it, does each step only halve the distance?"""
    rng = random.Random("dofkit beside")
    beside = dict(symbols)
    for s in moved:
        beside[s] = beside[s] + arb(rng.randrange(-999, 1000)) * arb(2) ** (-ASIDE_BITS - 10)
    _stepped(chart, beside, moved)
    before = _stepped(chart, beside, moved)
    return not 16 * _stepped(chart, beside, moved) < before


def _on_the_set(chart: Chart, point: BallPoint) -> bool:
    """Do the relations hold to the precision that a singular point lets them? Least squares stop elsewhere too."""
    at = values(chart.ring, point)
    return all(abs(at[n].mid()) < arb(2) ** -RESIDUAL_BITS for n in chart.nodes)


def _minimal_step(j: Sequence[Sequence[arb]], f: Sequence[arb]) -> list[arb]:
    """J^T (J J^T)^-1 f."""
    matrix = arb_mat([[v.mid() for v in row] for row in j])
    gram = matrix * matrix.transpose()
    n = gram.nrows()
    shift = arb(2) ** (-BITS // 2)
    for i in range(n):
        gram[i, i] = gram[i, i] + shift
    weights = gram.solve(arb_mat([[v] for v in f]))
    step = matrix.transpose() * weights
    return [step[i, 0].mid() for i in range(step.nrows())]
