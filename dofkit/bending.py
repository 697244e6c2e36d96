"""Relations nonlinear in the velocities: the velocity freedom, and whether the allowed velocities bend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb

from dofkit import expr as ex
from dofkit.answers import Answer, Setting
from dofkit.blocks import Block
from dofkit.charting import aliases
from dofkit.differential import Codistribution
from dofkit.exact.balls import (
    BallPoint,
    OutsideDomainError,
    RealSearch,
)
from dofkit.exact.field import FieldPoint
from dofkit.exact.points import Solver
from dofkit.exact.program import gradient, values
from dofkit.exact.ranks import ball_part
from dofkit.exact.ring import Ring
from dofkit.exact.sparse import sparse
from dofkit.exact.trust import independent_generators
from dofkit.forms import Frame, certified_rank, kernel
from dofkit.normal import Finite, Nonlinear, Pfaffian
from dofkit.rank import rank_of
from dofkit.report import weakest
from dofkit.velocities import form_rate, rate


def bend(block: Block, forms: Codistribution, setting: Setting, result: Answer) -> None:
    """The velocity freedom: a Jacobian's rank by the velocities, at points of the whole set."""
    if not block.nonlinear or result.velocity_dof is None:
        return
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + result.hidden
    symbols = [ex.coordinate(c) for c in block.coordinates]
    rates = [ex.velocity(c) for c in block.coordinates]
    linear = [rate(g) for g in finite]
    linear += [form_rate(r.piece) for r in block.forms if isinstance(r.piece, Pfaffian)]
    nonlinear = [r.piece.expr for r in block.nonlinear if isinstance(r.piece, Nonlinear)]
    everything = [*finite, *linear, *nonlinear]
    hessians = [[[ex.diff(ex.diff(f, v), w) for w in rates] for v in rates] for f in nonlinear]
    ring = Ring(
        [*everything, *(e for h in hessians for row in h for e in row)], setting.positive, aliases(block, finite)
    )
    nodes = [ring.node(e) for e in everything]
    curvature = [[[ring.node(e) for e in row] for row in h] for h in hessians]
    columns = [ring.var_index(v) for v in rates]
    solver = Solver(ring, [n for n in nodes if ring.code[n] != (0, 0)], seed=5)
    point = solver.draw(7) if "field" in setting.engines else None
    if "balls" not in setting.engines:
        _by_field_alone(ring, nodes[len(finite) :], columns, point, result, len(linear))
        return
    real = RealSearch(ring, nodes, [*symbols, *rates, *setting.generic], setting.positive).search(3)
    sample: Any = point if point is not None else (real.point if real is not None and real.certified else None)
    if real is None or sample is None:
        result.velocity_dof, result.consistent, result.verdict = None, None, "undecided"
        result.reasons.append("no velocities were found that satisfy the constraints")
        return
    _nonlinear_rank(ring, nodes[len(finite) :], columns, sample, result, len(linear))
    if not real.certified:
        result.verdict, result.velocity_dof, result.dof = "undecided", None, None
        result.reasons.append("the velocities that satisfy the constraints are singular")
        return
    if not _curved(ring, nodes[len(finite) :], columns, curvature, real.point):
        result.verdict, result.velocity_dof, result.dof = "undecided", None, None
        result.reasons.append(
            "the velocities that are allowed form flat pieces, which were not written as linear forms"
        )
        return
    result.curved = True
    if len(nonlinear) > 1:
        result.verdict = weakest(result.verdict, "probable")


def _by_field_alone(
    ring: Ring,
    nodes: Sequence[int],
    columns: Sequence[int | None],
    point: FieldPoint | None,
    result: Answer,
    linear: int,
) -> None:
    """The velocity freedom over the complex numbers; whether the allowed velocities bend is left open."""
    result.dof = None
    if point is None or not independent_generators(ring):
        result.velocity_dof, result.verdict = None, "undecided"
        return
    _nonlinear_rank(ring, nodes, columns, point, result, linear)


def _nonlinear_rank(
    ring: Ring, nodes: Sequence[int], columns: Sequence[int | None], point: Any, result: Answer, linear: int
) -> None:
    at = values(ring, point)
    zero = at[0] * 0
    rows = []
    for node in nodes:
        g = gradient(ring, at, point, [(node, zero + 1)])
        rows.append([g.get(c, zero) if c is not None else zero for c in columns])
    if isinstance(point, FieldPoint):
        rank = rank_of(rows, point.p)
        result.matrix += sparse(rows[linear:])
        result.verdict = weakest(result.verdict, "proved" if rank == len(rows) else "probable")
    else:
        rank = certified_rank(rows)
        result.verdict = weakest(result.verdict, "numeric")
    result.velocity_dof = len(columns) - rank


def _curved(
    ring: Ring,
    nodes: Sequence[int],
    columns: Sequence[int | None],
    hessians: Sequence[list[list[int]]],
    point: BallPoint,
) -> bool:
    """Is the set of allowed velocities curved at the point: a second fundamental form that a ball proves not to be 0?

    A curved set is no union of hyperplanes, so the relation is no Pfaffian form in disguise.
    """
    try:
        at = values(ring, point)
        rows = []
        for node in nodes:
            g = gradient(ring, at, point, [(node, arb(1))])
            rows.append([g.get(c, arb(0)) if c is not None else arb(0) for c in columns])
        part = ball_part(rows)
        free = tuple(c for c in range(len(columns)) if c not in set(part.columns))
        tangent = kernel(rows, Frame(tuple(part.rows), tuple(part.columns), free), arb(0))
        return any(_bends(at, h, u, v) for h in hessians for i, u in enumerate(tangent) for v in tangent[: i + 1])
    except (OutsideDomainError, ZeroDivisionError):
        return False


def _bends(at: Sequence[arb], hessian: list[list[int]], u: Sequence[arb], v: Sequence[arb]) -> bool:
    total = arb(0)
    for a, row in zip(u, hessian, strict=True):
        for node, b in zip(row, v, strict=True):
            total = total + a * at[node] * b
    return not total.contains(0)
