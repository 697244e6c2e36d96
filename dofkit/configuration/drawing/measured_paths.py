"""Motions of measured drawings followed in floating point, within the tolerance.

As many combinations of relations as are independent, U^T f = 0, cut out a manifold; a path on it is followed in
short steps, each along its tangent and back by Newton's method. What is left of the relations says whether the path is
a motion: within the tolerance of it they hold, or they are broken, or nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dofkit.base.libraries import np
from dofkit.configuration.drawing.measured_relations import GREY, SLACK, MeasuredDrawing, Place, clear_rank
from dofkit.exact.errors import NoValueError

#: A motion is followed so far, as a fraction of the size, or farther where second-order effects of that size would
#: not stand out from the tolerance by `FAR`; then `ON` so far, where what is flat at first shows.
STEP, FAR, LONGEST, ON = 0.12, 60.0, 0.4, 4.0
#: The steps of a path as a fraction of `STEP`, at the most and at the least; rounds of Newton's method.
STRIDE, SHORTEST, ROUNDS = 0.5, 2.0**-12, 12
#: The least cosine between steps, and what a correction may add to one.
STRAIGHT, BENT = 0.9, 0.3
#: What a correction comes down to.
CLOSE = 1e-11
#: Relations are broken that are met no better than the tolerance this many times, more so from half way by `STEEP`.
BROKEN, STEEP = 300.0, 3.0
HALF = 0.5
#: A contact is taken for one by chance only with a factor c of at least this.
PLAUSIBLE = 1.5e-3


@dataclass(frozen=True)
class Stage:
    """A place on a path, how far along it, and the relations ``f`` there."""

    distance: float
    at: Place
    f: Any

    @property
    def residual(self) -> float:
        """The largest relation."""
        return float(np.max(np.abs(self.f), initial=0.0))


@dataclass(frozen=True)
class MeasuredPath:
    """The ``stages`` of a path from the drawing on, as far as it could be followed."""

    drawing: MeasuredDrawing
    stages: tuple[Stage, ...]

    @property
    def distance(self) -> float:
        """How far it goes."""
        return self.stages[-1].distance

    def near(self, reach: float) -> bool:
        """Do the relations hold within the tolerance up to ``reach``?"""
        residuals = [s.residual for s in self.stages if s.distance <= reach * (1 + CLOSE)]
        return max(residuals) <= SLACK * self.drawing.tolerance

    def holds(self, reach: float) -> bool:
        """Do they also beyond it, as far as such errors grow?"""
        return self.near(reach) and all(s.residual <= GREY * self.drawing.tolerance for s in self.stages)

    @property
    def touches(self) -> bool:
        """May the path only touch the set, as c s^k at the distance s, to the second order or a higher one?

        What is measured wrongly is met by residuals that grow too, but a contact as slight would be no chance.
        """
        last = self.stages[-1]
        return last.residual > PLAUSIBLE * float(min(1.0, last.distance) ** max(2.0, self._power))

    @property
    def _power(self) -> float:
        """The power of the distance by which residuals grow, over the last half and the one before at the least."""
        last = self.stages[-1]
        half, quarter = (self._before(last.distance * part) for part in (HALF, HALF * HALF))
        return min(_power(quarter, half), _power(half, last)) if quarter.distance > 0 else 0.0

    def _before(self, distance: float) -> Stage:
        return [s for s in self.stages if s.distance <= distance * (1 + CLOSE)][-1]

    def goes_on(self, reach: float) -> bool:
        """Is it a motion as far as ``reach``?"""
        long = self.distance >= reach * (1 - CLOSE)
        return long and self.holds(reach) and not self.touches and self.rank() == self.drawing.rank

    @property
    def breaks(self) -> bool:
        """Do the relations fail by far more than the tolerance, and ever more with the distance?"""
        last = self.stages[-1]
        half = self._before(last.distance * HALF)
        return last.residual > max(BROKEN * self.drawing.tolerance, STEEP * half.residual)

    def side(self) -> float:
        """The value at the end of the first combination of relations that is dependent at the drawing."""
        return float(self.drawing.stresses[0] @ self.stages[-1].f)

    def rank(self) -> int | None:
        """The rank at the end."""
        relations = self.drawing.relations
        return clear_rank(relations.system(self.stages[-1].at, self.drawing.norms)[1], self.drawing.tolerance)


def runs_through(one: MeasuredPath, other: MeasuredPath, reach: float) -> bool:
    """Do two paths that leave the drawing in opposite directions make one motion, as long as ``reach`` in all?

    What is 0 on one side is so on the other, though a path may end where motions branch.
    """
    longer = max(one, other, key=lambda path: path.distance)
    long = one.distance + other.distance >= reach * (1 - CLOSE)
    held = all(path.holds(reach) and not path.touches for path in (one, other))
    return long and held and longer.rank() == longer.drawing.rank


def _power(near: Stage, far: Stage) -> float:
    """The power of the distance by which residuals grow from one stage to another; 0 for rounding errors."""
    if not far.distance > near.distance or far.residual < CLOSE:
        return 0.0
    return float(np.log(far.residual / max(near.residual, CLOSE**2)) / np.log(far.distance / near.distance))


def stride_of(tolerance: float) -> float:
    """How far a motion is followed at the least."""
    return max(STEP, float((FAR * tolerance) ** HALF))


def follow(drawing: MeasuredDrawing, direction: Any, reach: float) -> MeasuredPath:
    """The path that leaves along ``direction``, to the distance ``reach`` or until relations are broken."""
    relations, tolerance = drawing.relations, drawing.tolerance
    f, j = relations.system(drawing.at, drawing.norms)
    kept, at, distance = drawing.kept, drawing.at, 0.0
    stages = [Stage(0.0, at, f)]
    begun = stages[-1]
    ahead, step = direction / np.linalg.norm(direction), stride_of(tolerance) * STRIDE * HALF * HALF
    while distance < reach * (1 - CLOSE) and step > STEP * SHORTEST:
        tangent = _tangent(kept @ j, ahead)
        size = float(np.linalg.norm(tangent))
        moved = _corrected(drawing, kept, at, tangent * (step / size)) if size > STRAIGHT else None
        if moved is None:
            again = _combinations(drawing, f, j) if stages[-1] is not begun else None
            begun, step = stages[-1], step if again is not None else step / 2
            kept = kept if again is None else again
            continue
        at, f, j = moved
        distance, ahead = distance + step, tangent / size
        step = min(step * 2, stride_of(tolerance) * STRIDE, reach - distance) if distance < reach else step
        stages.append(Stage(distance, at, f))
        if stages[-1].residual > BROKEN * 10 * tolerance:
            break
    return MeasuredPath(drawing, tuple(stages))


def _combinations(drawing: MeasuredDrawing, f: Any, j: Any) -> Any:
    """As many independent combinations at another place of the same rank; None where it is none, or not on the set."""
    if float(np.max(np.abs(f), initial=0.0)) > SLACK * drawing.tolerance:
        return None
    if clear_rank(j, drawing.tolerance) != drawing.rank:
        return None
    return np.linalg.svd(j, full_matrices=False)[0].T[: drawing.rank]


def _tangent(a: Any, ahead: Any) -> Any:
    """The part of a direction along which the combinations stay 0 to first order."""
    return ahead - np.linalg.lstsq(a, a @ ahead, rcond=None)[0] if len(a) else ahead


def _corrected(drawing: MeasuredDrawing, kept: Any, at: Place, step: Any) -> tuple[Place, Any, Any] | None:
    """The place a step ahead on the manifold of the combinations, with the relations and their derivatives there.

    None where Newton's method does not lead there, by too far a way, or to where the relations have no value.
    """
    relations = drawing.relations
    start, last = relations.moved(at, step), float("inf")
    here, size = start, float(np.linalg.norm(step))
    for _ in range(ROUNDS):
        try:
            f, j = relations.system(here, drawing.norms)
        except NoValueError:
            return None
        if not len(kept):
            return here, f, j
        correction = np.linalg.lstsq(kept @ j, -(kept @ f), rcond=None)[0]
        length = float(np.linalg.norm(correction))
        if length < CLOSE or (length < CLOSE * ROUNDS**3 and length >= last * HALF):
            bent = float(np.linalg.norm(relations.between(start, here)))
            return (here, f, j) if bent <= BENT * size else None
        here = relations.moved(here, correction)
        if length > BENT * size * 2 or not np.isfinite(length):
            return None
        last = length
    return None
