"""The dimension of the set of configurations at a measured pose, decided in floating point within the tolerance.

Columns of lengths are divided by the scene's size and rows by their gradients, so that a singular value says by what
fraction of the size an equation can be satisfied otherwise. Those below the tolerance (times `SLACK`) count as 0. What
is then dependent is taken to be exactly dependent in the geometry that was measured. An infinitesimal motion is finite
where it is continued within the tolerance; it is not where the second order of that geometry excludes it by more than
the tolerance can hide. Where that leaves it open, the geometry exactly as written may decide, as it is one of those
that the tolerance allows. All else is undecided.
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
from dofkit.exact.matrices.certified import dependency_pattern, greedy_pivots
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart

#: From so many sizes from the origin singular values are smaller by the square of that, since turns are about it; from
#: `FAR_AWAY` sizes on no motion is followed.
NEAR, FAR_AWAY = 2.0, 30.0
#: Directions in which motions are followed.
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
    """The freedom at a measured pose; ``instantaneous`` and ``dimension`` are None where they are undecided.

    ``dependencies``: a matrix over GF(2) with the pattern of dependent rows that the Jacobian has within the tolerance:
    independent rows are unit vectors, the others sums of those they depend on. ``columns`` are dependent coordinates.
    ``gap``: between the least singular value that counts and the largest that does not.
    """

    instantaneous: int | None
    dimension: int | None
    dependencies: list[list[int]]
    columns: tuple[int, ...]
    gap: float
    reason: str


def measured_freedom(chart: Chart, pose: Mapping[Expr, Expr]) -> MeasuredFreedom | None:
    """Return the freedom at a measured pose, or None if something has no value there."""
    at = float_point(chart, pose)
    if at is None:
        return None
    freedom = _within_tolerance(chart, at)
    if freedom.reason not in (OPEN, FOLLOWED) or chart.time is not None:
        return freedom
    exact = at_reference(chart, pose)
    return freedom if exact is None else _compared_with_exact(freedom, exact)


def _compared_with_exact(freedom: MeasuredFreedom, exact: AtReference) -> MeasuredFreedom:
    """Return what the geometry exactly as written says of a measured freedom, if its rank is the same.

    It decides a motion of as many dimensions as the tolerance allows; a motion that it does not have is undecided.
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
    least = tolerance * SLACK / (lever * lever if lever > NEAR else 1.0)
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
    """A measured pose whose local dimension is asked for; ``is_far``: too far from the origin to follow a motion."""

    def __init__(self, pose: MeasuredPose, is_far: bool) -> None:
        self.pose = pose
        self.is_far = is_far
        self.equations, columns = pose.j.shape
        self.first_order = int(columns) - pose.rank
        self.rigid = len(pose.rigid_motions)

    @cached_property
    def forms(self) -> StressForms:
        """The second order."""
        return StressForms(self.pose)

    @cached_property
    def paths(self) -> list[tuple[Path, Path]]:
        """The paths along some random motions, both ways."""
        reach = reach_of(self.pose.tolerance) * BEYOND
        return [(follow(self.pose, d, reach), follow(self.pose, -d, reach)) for d in _directions(self.pose.flexes)]


def _independent(problem: _Problem) -> Conclusion | None:
    """Independent equations cut out a manifold [ImplicitFunctions]."""
    if problem.pose.rank < problem.equations:
        return None
    return Conclusion(problem.first_order, "all equations are independent within the tolerance")


def _infinitesimally_rigid(problem: _Problem) -> Conclusion | None:
    """Nothing moves but the system as a rigid body [AsimowRoth1978]."""
    if problem.first_order > problem.rigid:
        return None
    return Conclusion(
        problem.first_order, "the only infinitesimal motions are rigid motions of the system", confined=True
    )


def _indistinct(problem: _Problem) -> Conclusion | None:
    """No motion can be followed: nothing is decided."""
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
    """One dependent equation whose second order takes both signs parts the manifold [HurewiczWallman1941]."""
    if not problem.forms.is_indefinite:
        return None
    why = "branches cross here: the second-order form is indefinite by more than the tolerance"
    return Conclusion(problem.first_order - 1, why)


def _definite_combination(problem: _Problem) -> Conclusion | None:
    """A stress whose form is definite leaves rigid motions alone [ConnellyWhiteley1996]."""
    if problem.forms.vanish or not problem.forms.definite:
        return None
    why = "a stress is definite to second order by more than the tolerance: no finite motion"
    return Conclusion(problem.rigid, why, confined=True)


def _continued(problem: _Problem) -> Conclusion | None:
    """Conclude that all infinitesimal motions are finite: random ones can be continued both ways, within the noise.

    No second-order form is known not to vanish.
    """
    reach = reach_of(problem.pose.tolerance)
    if not problem.forms.vanish or not all(is_motion(*paths, reach) for paths in problem.paths):
        return None
    return Conclusion(problem.first_order, FOLLOWED)


def _undecided(problem: _Problem) -> Conclusion:
    return Conclusion(None, OPEN)


#: The criteria in the order in which they are asked; the first that comes to a conclusion decides.
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
    """Return the motion, or some random ones if there are several."""
    if len(flexes) == 1:
        return [flexes[0]]
    rng = np.random.default_rng(13)
    return [rng.standard_normal(len(flexes)) @ flexes for _ in range(DIRECTIONS)]


def _at_fixed_time(pose: MeasuredPose, conclusion: Conclusion) -> Conclusion:
    """Return the dimension without that of time; undecided where time may be constant on the set."""
    if clear_rank(pose.j, pose.tolerance) != pose.rank or (conclusion.dimension is not None and conclusion.confined):
        return Conclusion(None, "whether a motion passes through this instant is not decided within the tolerance")
    return conclusion if conclusion.dimension is None else conclusion._replace(dimension=conclusion.dimension - 1)
