"""The dimension of the set of configurations at a pose with a tolerance, decided in floating point.

Lengths are in units of the scene's size and rows are divided by their gradients. Singular values below the tolerance
(times `SLACK`) count as 0: equations that are dependent then are assumed to be exactly dependent in the true geometry.
An infinitesimal motion extends to a finite one if it can be continued within the tolerance; it does not if the second
order of the equations excludes it by more than errors within the tolerance. Otherwise the geometry exactly as written
may decide, because it is one of those that the tolerance allows; if not, the dimension is undecided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from dofkit.base.libraries import np
from dofkit.configuration.at_reference import AtReference, at_reference, float_point
from dofkit.configuration.local.germ import Conclusion
from dofkit.configuration.measured.continuation import BEYOND, LONGEST, Path, follow, is_motion, reach_of
from dofkit.configuration.measured.equations import (
    GREY,
    SLACK,
    MeasuredPose,
    ScaledEquations,
    StressForms,
    clear_rank,
    independent_rows,
)
from dofkit.configuration.variety import is_parametric
from dofkit.exact.matrices.certified import dependency_pattern, greedy_pivots
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart

#: At a distance d >= NEAR sizes from the origin, singular values may be smaller by d^2, because rotations are about the
#: origin; beyond FAR_AWAY sizes no motion is followed.
NEAR, FAR_AWAY = 2.0, 30.0
#: Number of random directions in which motions are followed.
DIRECTIONS = 3

FOLLOWED = "the motion was continued for a finite step within the tolerance"
ROUNDED = "so far from the origin the rounding of floating-point numbers exceeds the tolerance"
MISSED = (
    "the measured reference configuration does not satisfy the equations within the tolerance, and the "
    "tolerance is meaningful only near it"
)
OPEN = "some infinitesimal motions are not finite motions; which ones was not decided"
AS_WRITTEN = "with the numbers exactly as written the equations are dependent, which decides: {}"
STOPPED = (
    "the infinitesimal motion extends to a finite motion within the tolerance but not for the geometry "
    "as written, so the tolerance leaves it open"
)


@dataclass(frozen=True)
class MeasuredFreedom:
    """The freedom at a pose with a tolerance; ``instantaneous`` and ``dimension`` are None if undecided.

    ``dependencies``: a matrix over GF(2) with the pattern of dependent rows that the Jacobian has within the tolerance:
    independent rows are unit vectors, the others sums of those on which they depend. ``columns``: dependent
    coordinates. ``gap``: ratio of the least singular value that counts to the largest that does not.
    """

    instantaneous: int | None
    dimension: int | None
    dependencies: list[list[int]]
    columns: tuple[int, ...]
    gap: float
    reason: str


def measured_freedom(chart: Chart, pose: Mapping[Expr, Expr]) -> MeasuredFreedom | None:
    """Return the freedom at a pose within the tolerance; None if a value there is undefined."""
    at = float_point(chart, pose)
    if at is None:
        return None
    freedom = _within_tolerance(chart, at)
    if freedom.reason not in (OPEN, FOLLOWED) or chart.time is not None:
        return freedom
    exact = at_reference(chart, pose)
    return freedom if exact is None else _compared_with_exact(freedom, exact)


def _compared_with_exact(freedom: MeasuredFreedom, exact: AtReference) -> MeasuredFreedom:
    """Return the freedom, corrected by that of the geometry exactly as written, if the instantaneous freedoms agree.

    A dimension that is undecided within the tolerance is taken from there if it is at least the instantaneous freedom
    minus 1; one that is decided becomes undecided if it differs.
    """
    dimension = exact.local.dimension
    if exact.instantaneous != freedom.instantaneous or dimension in (None, freedom.dimension):
        return freedom
    if freedom.dimension is not None:
        return replace(freedom, dimension=None, reason=STOPPED)
    if dimension is None or dimension <= exact.rigid or dimension < exact.instantaneous - 1:
        return freedom
    return replace(freedom, dimension=dimension, reason=AS_WRITTEN.format(exact.local.reason))


def _within_tolerance(chart: Chart, at: Mapping[Expr, float]) -> MeasuredFreedom:
    """Return the freedom by singular values and `CRITERIA`; unlike `measured_freedom` without the exact geometry."""
    equations, tolerance = ScaledEquations(chart, at), float(chart.setting.tolerance or 0)
    n = chart.coordinates
    if not chart.nodes:
        return MeasuredFreedom(n, n, [], (), float("inf"), "")
    if equations.rounding(at) > tolerance:
        return MeasuredFreedom(None, None, [], (), float("inf"), ROUNDED)
    f, timed = equations.system(at)
    if float(np.max(np.abs(f))) > tolerance * SLACK:
        return MeasuredFreedom(None, None, [], (), float("inf"), MISSED)
    j = timed[:, :n]
    singular = np.linalg.svd(j, compute_uv=False)
    rank = int(np.sum(singular > tolerance * SLACK))
    below = float(singular[rank]) if rank < len(singular) else 0.0
    gap = float(singular[rank - 1]) / below if rank and below > 0 else float("inf")
    lever = equations.lever(timed)
    least = tolerance * SLACK / (lever * lever if lever > NEAR else 1.0)  # smaller by distance^2, see NEAR
    if np.any((singular > least) & (singular < tolerance * GREY)):
        return MeasuredFreedom(None, None, [], (), gap, "a singular value near the tolerance leaves the rank undecided")
    problem = _Problem(MeasuredPose(equations, at, timed, rank, tolerance), lever > FAR_AWAY)
    conclusion = next(c for criterion in CRITERIA if (c := criterion(problem)) is not None)
    if chart.time is not None:
        conclusion = _at_fixed_time(problem.pose, conclusion)
    return MeasuredFreedom(
        n - rank,
        conclusion.dimension,
        dependency_pattern(j, independent_rows(j, rank, tolerance)),
        tuple(greedy_pivots(j.T.tolist(), rank)),
        gap,
        conclusion.reason,
    )


class _Problem:
    """A pose and what the criteria use; ``is_far``: it is too far from the origin to follow a motion."""

    def __init__(self, pose: MeasuredPose, is_far: bool) -> None:
        self.pose = pose
        self.is_far = is_far
        self.equations, columns = pose.j.shape
        self.first_order = int(columns) - pose.rank
        self.rigid = len(pose.rigid_motions)

    @cached_property
    def forms(self) -> StressForms:
        """The second order of the dependent equations."""
        return StressForms(self.pose)

    @cached_property
    def paths(self) -> list[tuple[Path, Path]]:
        """The paths along some random motions, in both directions."""
        reach = reach_of(self.pose.tolerance) * BEYOND
        return [(follow(self.pose, d, reach), follow(self.pose, -d, reach)) for d in _directions(self.pose.flexes)]


def _independent(problem: _Problem) -> Conclusion | None:
    """Conclude the instantaneous freedom if all equations are independent [ImplicitFunctions]."""
    if problem.pose.rank < problem.equations:
        return None
    return Conclusion(problem.first_order, "all equations are independent within the tolerance")


def _infinitesimally_rigid(problem: _Problem) -> Conclusion | None:
    """Conclude the instantaneous freedom if all infinitesimal motions are rigid motions [AsimowRoth1978]."""
    if problem.first_order > problem.rigid:
        return None
    return Conclusion(
        problem.first_order, "the only infinitesimal motions are rigid motions of the system", confined=True
    )


def _indistinct(problem: _Problem) -> Conclusion | None:
    """Conclude that the dimension is undecided if no motion can be followed, or signs may depend on parameters."""
    chart = problem.pose.equations.chart
    if is_parametric(chart, (*chart.unknowns, ex.TIME)):
        return Conclusion(None, OPEN)
    if problem.is_far:
        return Conclusion(
            None,
            "the reference configuration is too far from the origin, relative to its size, to continue a motion "
            "in floating point",
        )
    if reach_of(problem.pose.tolerance) > LONGEST:
        return Conclusion(None, "the tolerance is too coarse to distinguish a finite motion from an infinitesimal one")
    if len(problem.pose.flexes) != problem.first_order - problem.rigid:
        return Conclusion(
            None, "rigid motions of the system cannot be distinguished from other motions within the tolerance"
        )
    return None


def _indefinite_form(problem: _Problem) -> Conclusion | None:
    """Conclude one dimension less if the second order of one dependent equation is indefinite [HurewiczWallman1941]."""
    if not problem.forms.is_indefinite:
        return None
    why = "branches cross here: the second-order form is indefinite by more than the tolerance"
    return Conclusion(problem.first_order - 1, why)


def _definite_combination(problem: _Problem) -> Conclusion | None:
    """Conclude that only rigid motions are finite if the form of a stress is definite [ConnellyWhiteley1996]."""
    if problem.forms.vanish or not problem.forms.definite:
        return None
    why = "a stress is definite to second order by more than the tolerance: no finite motion"
    return Conclusion(problem.rigid, why, confined=True)


def _continued(problem: _Problem) -> Conclusion | None:
    """Conclude the instantaneous freedom if second-order forms are 0 and random motions continue in both directions."""
    reach = reach_of(problem.pose.tolerance)
    if not problem.forms.vanish or not all(is_motion(*paths, reach) for paths in problem.paths):
        return None
    return Conclusion(problem.first_order, FOLLOWED)


def _undecided(problem: _Problem) -> Conclusion:
    return Conclusion(None, OPEN)


#: The criteria in the order in which they are tried; the first that returns a conclusion decides.
CRITERIA: tuple[Callable[[_Problem], Conclusion | None], ...] = (
    _independent,
    _infinitesimally_rigid,
    _indistinct,
    _indefinite_form,
    _definite_combination,
    _continued,
    _undecided,
)


def _directions(flexes: Any) -> list[Any]:
    """Return the flex, or some random combinations if there are several."""
    if len(flexes) == 1:
        return [flexes[0]]
    rng = np.random.default_rng(13)
    return [rng.standard_normal(len(flexes)) @ flexes for _ in range(DIRECTIONS)]


def _at_fixed_time(pose: MeasuredPose, conclusion: Conclusion) -> Conclusion:
    """Return the conclusion at fixed time, one dimension less; undecided if time may be constant on the set."""
    if clear_rank(pose.j, pose.tolerance) != pose.rank or (conclusion.dimension is not None and conclusion.confined):
        return Conclusion(None, "whether a motion passes through this instant is not decided within the tolerance")
    return conclusion if conclusion.dimension is None else conclusion._replace(dimension=conclusion.dimension - 1)
