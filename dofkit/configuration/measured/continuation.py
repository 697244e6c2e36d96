"""Continuation of a motion from a pose with a tolerance, in floating point.

The independent combinations of equations, U^T f = 0, define a manifold; a path on it is followed in short steps, each
along the tangent and back by Newton's method. It is a motion if the residuals of all equations stay within the
tolerance, it is none if they grow far beyond, and otherwise undecided.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.base.libraries import np
from dofkit.configuration.measured.equations import GREY, SLACK, MeasuredPose, Point, clear_rank

#: Least length of a motion, as a fraction of the size; it is so long that second-order effects exceed the tolerance by
#: `FAR`, or no path is followed if that is beyond `LONGEST`. Paths are `BEYOND` times as long, to show higher orders.
STEP, FAR, LONGEST, BEYOND = 0.12, 60.0, 0.4, 4.0
#: The largest and the least step as fractions of the length and of `STEP`; rounds of Newton's method.
STRIDE, SHORTEST, ROUNDS = 0.5, 2.0**-12, 12
#: The least cosine between successive steps, and the largest correction of a step relative to its length.
STRAIGHT, BENT = 0.9, 0.3
#: Newton's method ends if corrections are shorter.
CLOSE = 1e-11
#: A path ends where residuals exceed the tolerance times `VIOLATED`.
VIOLATED = 3000.0
#: Residuals beyond c s^k with this factor c, after the distance s, are not taken for errors of a motion.
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
        """Return whether the residuals are within the tolerance up to ``reach``, and within `GREY` times it beyond."""
        near = max(s.residual for s in self.stages if s.distance <= reach * (1 + CLOSE))
        far = max(s.residual for s in self.stages)
        return near <= SLACK * self.pose.tolerance and far <= GREY * self.pose.tolerance and not self.may_touch

    @property
    def may_touch(self) -> bool:
        """Whether the path may only be tangent to the set of solutions, to the second or a higher order.

        Residuals along a motion grow too, by errors within the tolerance, but hardly as much.
        """
        last = self.stages[-1]
        return last.residual > PLAUSIBLE * float(min(1.0, last.distance) ** max(2.0, self._order))

    @property
    def _order(self) -> float:
        """The power of the distance with which residuals grow, over the last half or the quarter before it."""
        last = self.stages[-1]
        ends = (last.distance * part * (1 + CLOSE) for part in (HALF, HALF * HALF))
        half, quarter = ([s for s in self.stages if s.distance <= end][-1] for end in ends)
        return min(_power(quarter, half), _power(half, last)) if quarter.distance > 0 else 0.0


def is_motion(forward: Path, backward: Path, reach: float) -> bool:
    """Return whether two paths in opposite directions form one motion of length ``reach`` with the rank of the pose.

    One path may be short, where motions branch: an analytic function that is 0 on one side is 0 on the other.
    """
    longer = max(forward, backward, key=lambda path: path.distance)
    is_long = forward.distance + backward.distance >= reach * (1 - CLOSE)
    satisfied = all(path.is_satisfied(reach) for path in (forward, backward))
    pose = longer.pose
    end = pose.equations.system(longer.stages[-1].at, pose.norms)[1]
    return is_long and satisfied and clear_rank(end, pose.tolerance) == pose.rank


def _power(near: Stage, far: Stage) -> float:
    """Return the power of the distance with which residuals grow between two stages; 0 for rounding errors."""
    if not far.distance > near.distance or far.residual < CLOSE:
        return 0.0
    return float(np.log(far.residual / max(near.residual, CLOSE**2)) / np.log(far.distance / near.distance))


def reach_of(tolerance: float) -> float:
    """Return the least length over which a motion is followed."""
    return max(STEP, float((FAR * tolerance) ** HALF))


def follow(pose: MeasuredPose, direction: Any, reach: float) -> Path:
    """Return the path that begins along ``direction``, of length ``reach`` or up to where equations are violated."""
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
    """Return the orthogonal projection of a direction to the kernel of the rows ``a``."""
    return ahead - np.linalg.lstsq(a, a @ ahead, rcond=None)[0] if len(a) else ahead


def _corrected(pose: MeasuredPose, combinations: Any, at: Point, step: Any) -> tuple[Point, Any, Any] | None:
    """Return the point a step ahead on the manifold of the combinations, with residuals and Jacobian there.

    None if Newton's method does not converge nearby, or an equation has no value.
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
