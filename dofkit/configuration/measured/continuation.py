"""Continuation of a motion from a measured pose, in floating point and within the tolerance.

As many combinations of equations as are independent, U^T f = 0, cut out a manifold; a path on it is followed in short
steps, each along its tangent and back by Newton's method. The residuals of all equations along it tell whether it is a
motion: they stay within the tolerance, or they grow far beyond it, or neither.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.base.libraries import np
from dofkit.configuration.measured.equations import GREY, SLACK, MeasuredPose, Point, clear_rank

#: A motion is followed over `STEP`, as a fraction of the size, or farther where second-order effects of that length
#: would not exceed the tolerance by `FAR`; then over `BEYOND` times as much, where what is flat at first shows.
STEP, FAR, LONGEST, BEYOND = 0.12, 60.0, 0.4, 4.0
#: The largest and the least step as fractions of `STEP`; rounds of Newton's method.
STRIDE, SHORTEST, ROUNDS = 0.5, 2.0**-12, 12
#: The least cosine between successive steps, and by what part of a step a correction may lengthen it.
STRAIGHT, BENT = 0.9, 0.3
#: To what length corrections come down.
CLOSE = 1e-11
#: A path ends where residuals exceed the tolerance times `VIOLATED`.
VIOLATED = 3000.0
#: The least factor c of a contact c s^k that would not be chance.
PLAUSIBLE = 1.5e-3
HALF = 0.5


@dataclass(frozen=True)
class Stage:
    """A point of a path at ``distance`` from its beginning, and the largest ``residual`` of the equations there."""

    distance: float
    at: Point
    residual: float


@dataclass(frozen=True)
class Path:
    """The ``stages`` of a path from a pose, as far as it could be followed."""

    pose: MeasuredPose
    stages: tuple[Stage, ...]

    @property
    def distance(self) -> float:
        """The length of the path."""
        return self.stages[-1].distance

    def is_satisfied(self, reach: float) -> bool:
        """Return whether the equations are satisfied up to ``reach``, and beyond it as far as such errors grow."""
        near = max(s.residual for s in self.stages if s.distance <= reach * (1 + CLOSE))
        far = max(s.residual for s in self.stages)
        return near <= SLACK * self.pose.tolerance and far <= GREY * self.pose.tolerance and not self.may_touch

    @property
    def may_touch(self) -> bool:
        """Whether the path may only touch the set of solutions, to the second order or a higher one.

        Residuals along a motion grow too, by errors of measurement, but a contact as slight would be chance.
        """
        last = self.stages[-1]
        return last.residual > PLAUSIBLE * float(min(1.0, last.distance) ** max(2.0, self._order))

    @property
    def _order(self) -> float:
        """The power of the distance by which residuals grow: the least of the last half and the quarter before."""
        last = self.stages[-1]
        ends = (last.distance * part * (1 + CLOSE) for part in (HALF, HALF * HALF))
        half, quarter = ([s for s in self.stages if s.distance <= end][-1] for end in ends)
        return min(_power(quarter, half), _power(half, last)) if quarter.distance > 0 else 0.0

    @property
    def end_rank(self) -> int | None:
        """The rank at the end of the path, None if it is undecided."""
        return clear_rank(self.pose.equations.system(self.stages[-1].at, self.pose.norms)[1], self.pose.tolerance)


def is_motion(forward: Path, backward: Path, reach: float) -> bool:
    """Return whether two paths in opposite directions make one motion of length ``reach`` of the rank of the pose.

    An analytic function that is 0 on one side is 0 on the other, though a path may end where motions branch.
    """
    longer = max(forward, backward, key=lambda path: path.distance)
    is_long = forward.distance + backward.distance >= reach * (1 - CLOSE)
    satisfied = all(path.is_satisfied(reach) for path in (forward, backward))
    return is_long and satisfied and longer.end_rank == longer.pose.rank


def _power(near: Stage, far: Stage) -> float:
    """Return the power of the distance by which residuals grow between two stages, 0 for rounding errors."""
    if not far.distance > near.distance or far.residual < CLOSE:
        return 0.0
    return float(np.log(far.residual / max(near.residual, CLOSE**2)) / np.log(far.distance / near.distance))


def reach_of(tolerance: float) -> float:
    """Return the least length over which a motion is followed."""
    return max(STEP, float((FAR * tolerance) ** HALF))


def follow(pose: MeasuredPose, direction: Any, reach: float) -> Path:
    """Return the path that leaves along ``direction``, of length ``reach`` or up to where equations are violated."""
    equations, tolerance = pose.equations, pose.tolerance
    f, j = equations.system(pose.at, pose.norms)
    combinations, at, distance = pose.independent, pose.at, 0.0
    stages = [Stage(0.0, at, _largest(f))]
    ahead, step = direction / np.linalg.norm(direction), reach_of(tolerance) * STRIDE * HALF * HALF
    while distance < reach * (1 - CLOSE) and step > STEP * SHORTEST:
        tangent = _tangent(combinations @ j, ahead)
        size = float(np.linalg.norm(tangent))
        moved = _corrected(pose, combinations, at, tangent * (step / size)) if size > STRAIGHT else None
        if moved is None:
            step /= 2
            continue
        at, f, j = moved
        distance, ahead = distance + step, tangent / size
        step = min(step * 2, reach_of(tolerance) * STRIDE, reach - distance) if distance < reach else step
        stages.append(Stage(distance, at, _largest(f)))
        if stages[-1].residual > VIOLATED * tolerance:
            break
    return Path(pose, tuple(stages))


def _largest(f: Any) -> float:
    return float(np.max(np.abs(f), initial=0.0))


def _tangent(a: Any, ahead: Any) -> Any:
    """Return the part of a direction along which the derivatives of the combinations are 0."""
    return ahead - np.linalg.lstsq(a, a @ ahead, rcond=None)[0] if len(a) else ahead


def _corrected(pose: MeasuredPose, combinations: Any, at: Point, step: Any) -> tuple[Point, Any, Any] | None:
    """Return the point a step ahead on the manifold of the combinations, with residuals and Jacobian there.

    None if Newton's method does not converge near it, or leads to where an equation has no value.
    """
    equations = pose.equations
    start, last = equations.moved(at, step), float("inf")
    here, size = start, float(np.linalg.norm(step))
    for _ in range(ROUNDS):
        try:
            f, j = equations.system(here, pose.norms)
        except NoValueError:
            return None
        if not len(combinations):
            return here, f, j
        correction = np.linalg.lstsq(combinations @ j, -(combinations @ f), rcond=None)[0]
        length = float(np.linalg.norm(correction))
        if length < CLOSE or (length < CLOSE * ROUNDS**3 and length >= last * HALF):
            bent = float(np.linalg.norm(equations.between(start, here)))
            return (here, f, j) if bent <= BENT * size else None
        here = equations.moved(here, correction)
        if length > BENT * size * 2 or not np.isfinite(length):
            return None
        last = length
    return None
