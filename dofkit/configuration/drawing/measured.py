"""Measured geometry: ranks with a tolerance, in floating point, and the gap they rest on.

The columns of positions are scaled by the scene's size and every row to length 1, so that a singular value
says by what fraction of the size a relation can be met otherwise. Those below the tolerance (times `SLACK`) count as 0.
What is then dependent is taken for exactly so in the geometry that was measured. A motion to first order is a finite
one where it is followed within the tolerance; it is none where the second order of that geometry, or what is left of
the relations along it, excludes it beyond what the tolerance may hide. All else is open.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from dofkit.base.deadline import check
from dofkit.base.libraries import np
from dofkit.configuration.drawing.measured_branches import branch_dimension
from dofkit.configuration.drawing.measured_flexes import StressForms
from dofkit.configuration.drawing.measured_paths import LONGEST, ON, follow, runs_through, stride_of
from dofkit.configuration.drawing.measured_relations import (
    GREY,
    SLACK,
    MeasuredDrawing,
    MeasuredRelations,
    clear_rank,
    own_motions,
)
from dofkit.exact.matrices.singular_values import dependency_pattern, greedy_pivots
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart
from dofkit.relations.setting import Setting

#: From so many sizes from the origin singular values are smaller by the square of that, since turns are told about it;
#: from `LEVER` sizes on no motion is followed.
CLOSE, LEVER = 2.0, 30.0
#: Directions in which motions are followed; how much farther one is that is nearly straight.
WAYS, FARTHER = 3, 3.0

FOLLOWED = "the motion was continued for a finite step within the tolerance"
MISSED = (
    "the measured reference configuration does not satisfy the equations within the tolerance, and the "
    "tolerance is meaningful only near it"
)
FIXED = "within the tolerance the equations allow neither a motion nor another instant: they fix the time"
OPEN = "some infinitesimal motions are not finite motions; which ones was not decided"


class Decided(NamedTuple):
    """A dimension, None where it is open, and why; ``confined``: time, if it is a column, may be constant.

    ``still``: time does stand still. ``seen``, where it is open: of what was followed within the tolerance.
    """

    dimension: int | None
    reason: str
    confined: bool = False
    still: bool = False
    seen: int = 0
    forms: StressForms | None = None


@dataclass(frozen=True)
class Measured:
    """``dimension`` None where the tolerance does not decide.

    ``dependencies``: a matrix over GF(2) with the pattern of dependent rows that the Jacobian has within the
    tolerance: independent rows are unit vectors, the others sums of those they depend on. ``columns`` are
    dependent coordinates. ``still``: the relations fix the time. ``seen``: of what was followed where it is open;
    ``forms``: along which more may be.
    """

    instantaneous: int | None
    dimension: int | None
    dependencies: list[list[int]]
    columns: tuple[int, ...]
    gap: float
    reason: str
    still: bool = False
    seen: int = 0
    forms: StressForms | None = None


def measure(chart: Chart, at: Mapping[Expr, float], setting: Setting, rigid: int) -> Measured:
    """The freedom at a measured configuration; ``rigid`` counts the motions of the whole."""
    relations, tolerance = MeasuredRelations(chart, setting, at), float(setting.tolerance or 0)
    n = chart.coordinates
    if not chart.nodes:
        return Measured(n, n, [], (), float("inf"), "")
    f, timed = relations.system(at)
    if float(np.max(np.abs(f))) > tolerance * SLACK:
        return Measured(None, None, [], (), float("inf"), MISSED)
    j = timed[:, :n]
    singular = np.linalg.svd(j, compute_uv=False)
    rank = int(np.sum(singular > tolerance * SLACK))
    below = float(singular[rank]) if rank < len(singular) else 0.0
    gap = float(singular[rank - 1]) / below if rank and below > 0 else float("inf")
    lever = relations.lever(timed)
    least = tolerance * SLACK / (lever * lever if lever > CLOSE else 1.0)
    if np.any((singular > least) & (singular < tolerance * GREY)):
        return Measured(None, None, [], (), gap, "a singular value near the tolerance leaves the rank undecided")
    pattern = dependency_pattern(j, independent_rows(j, rank, tolerance))
    columns = tuple(greedy_pivots(j.T, rank))
    drawing = MeasuredDrawing(relations, at, timed, rank, tolerance)
    rigid = min(rigid, len(own_motions(relations.whole(at), tolerance)))
    found = _finite(drawing, rigid, lever > LEVER or relations.blurs(at) > tolerance)
    if chart.time is not None:
        found = _at_fixed_time(drawing, found)
    return Measured(
        n - rank, found.dimension, pattern, columns, gap, found.reason, found.still, found.seen, found.forms
    )


def _at_fixed_time(drawing: MeasuredDrawing, found: Decided) -> Decided:
    """The dimension without that of time; open where time may stand still on the set, as far as the tolerance tells."""
    rank, (full, columns) = clear_rank(drawing.j, drawing.tolerance), drawing.j.shape
    if rank == columns:
        return Decided(None, FIXED, still=True)
    if rank is not None and rank == full > drawing.rank and _time_moves(replace(drawing, rank=rank)):
        return Decided(
            columns - full - 1, "all equations are independent within the tolerance, with time as a variable"
        )
    if rank != drawing.rank or (found.dimension is not None and found.confined):
        return Decided(None, "whether a motion passes through this instant is not decided within the tolerance")
    return found if found.dimension is None else found._replace(dimension=found.dimension - 1)


def _time_moves(drawing: MeasuredDrawing) -> bool:
    """Does time change beyond the tolerance along a random path of the manifold that all relations cut out?"""
    if not len(drawing.ways):
        return False
    path = follow(drawing, _directions(drawing.ways)[-1], stride_of(drawing.tolerance))
    ahead = drawing.relations.between(drawing.at, path.stages[-1].at)[-1]
    return abs(float(ahead)) > GREY * drawing.tolerance


def _finite(drawing: MeasuredDrawing, rigid: int, far: bool) -> Decided:
    """The dimension of the set, time counted; nothing is followed where that is ``far`` from the origin."""
    full, columns = drawing.j.shape
    first = columns - drawing.rank
    if drawing.rank == full:
        return Decided(first, "all equations are independent within the tolerance")
    if first == rigid:
        return Decided(first, "the only infinitesimal motions are rigid motions of the system", confined=True)
    if far:
        return Decided(
            None,
            "the reference configuration is too far from the origin, relative to its size, to continue a motion "
            "in floating point",
        )
    if stride_of(drawing.tolerance) > LONGEST:
        return Decided(None, "the tolerance is too coarse to distinguish a finite motion from an infinitesimal one")
    if len(drawing.ways) != first - rigid:
        return Decided(
            None, "rigid motions of the system cannot be distinguished from other motions within the tolerance"
        )
    forms = StressForms(drawing)
    if forms.vanish:
        found = _by_paths(drawing, first, rigid)
        return found._replace(forms=forms)
    return _by_second_order(forms, first, rigid)


def _by_second_order(forms: StressForms, first: int, rigid: int) -> Decided:
    """What stress forms say that are not 0 for all geometries within the tolerance.

    One that changes sign parts the manifold [HurewiczWallman1941]; a definite one, of any stress, leaves the motions of
    the whole alone [ConnellyWhiteley1996], as does a cone of nothing but 0. Beside those of a branch that was followed
    there are none where the branch has the dimension of the cone [TangentCone].
    """
    if forms.change_sign:
        return Decided(first - 1, "branches cross here: the second-order form is indefinite by more than the tolerance")
    if forms.definite:
        return Decided(
            rigid, "a stress is definite to second order by more than the tolerance: no finite motion", confined=True
        )
    if forms.cone == 0:
        why = "no infinitesimal motion satisfies the second-order condition within the tolerance: no finite motion"
        return Decided(rigid, why, confined=True)
    branch = branch_dimension(forms)
    if branch == forms.cone:
        why = (
            "a finite motion was continued from here within the tolerance, and the second-order condition allows "
            "no more"
        )
        return Decided(rigid + forms.cone, why, confined=True)
    return Decided(None, OPEN, seen=rigid + branch)


def _by_paths(drawing: MeasuredDrawing, first: int, rigid: int) -> Decided:
    """What paths say where the second order says nothing.

    Where the one dependent equation has both signs it parts the manifold [HurewiczWallman1941]; where one motion is
    left and the relations break along it, both ways, it is none [IsolatedZeros].
    """
    reach = stride_of(drawing.tolerance)
    both = [(follow(drawing, d, reach * ON), follow(drawing, -d, reach * ON)) for d in _directions(drawing.ways)]
    paths = [path for pair in both for path in pair]
    if all(runs_through(*pair, reach) for pair in both):
        return Decided(first, FOLLOWED)
    broken = [path.side() for path in paths if path.breaks]
    if len(drawing.stresses) == 1 and min(broken, default=0.0) < 0 < max(broken, default=0.0):
        return Decided(
            first - 1,
            "the one dependent equation changes sign by more than the tolerance, so it is satisfied in between",
        )
    if first - rigid == 1 and (all(path.breaks for path in paths) or _breaks_farther(drawing, reach)):
        why = "the one infinitesimal motion violates the equations by more than the tolerance"
        return Decided(rigid, why, confined=True)
    return Decided(None, OPEN, seen=rigid + any(path.near(reach) for path in paths))


def _breaks_farther(drawing: MeasuredDrawing, reach: float) -> bool:
    """Does the one motion break the relations both ways, if it is followed on?"""
    (d,) = _directions(drawing.ways)
    return all(follow(drawing, sign * d, reach * ON * FARTHER).breaks for sign in (1, -1))


def _directions(ways: Any) -> list[Any]:
    """Some motions at random, of one that one."""
    if len(ways) == 1:
        return [ways[0]]
    rng = np.random.default_rng(13)
    return [rng.standard_normal(len(ways)) @ ways for _ in range(WAYS)]


def independent_rows(j: Any, rank: int, tolerance: float) -> list[int]:
    """The first rows, in order, independent of those before them within the tolerance.

    Rows are so as long as their least singular value is above it, which no row that is left out makes smaller. A row
    that others come nearer to than that is none. So one look at those that stand apart from others is enough, unless
    they are dependent together.
    """
    kept = _rows_apart(j, rank, tolerance)
    if _are_independent(j[kept], tolerance):
        return kept
    kept = []
    for r in range(len(j)):
        if len(kept) == rank:
            break
        check()
        if _are_independent(j[[*kept, r]], tolerance):
            kept.append(r)
    return kept


def _are_independent(rows: Any, tolerance: float) -> bool:
    return not len(rows) or float(np.linalg.svd(rows, compute_uv=False)[-1]) > tolerance * SLACK


def _rows_apart(j: Any, rank: int, tolerance: float) -> list[int]:
    """The first rows that are apart from the span of those before them, by more than the tolerance."""
    kept, basis = list[int](), np.zeros((0, j.shape[1]))
    for r, row in enumerate(j):
        if len(kept) == rank:
            break
        for _ in range(2):
            row = row - basis.T @ (basis @ row)
        apart = float(np.linalg.norm(row))
        if apart > tolerance * SLACK:
            kept.append(r)
            basis = np.vstack([basis, row / apart])
    return kept
