"""Motions of measured drawings followed in floating point, within the tolerance.

As many combinations of relations as are independent, U^T f = 0, cut out a manifold; a path on it is followed in
short steps, each along its tangent and back by Newton's method. What is left of the relations says whether the path is
a motion: within the tolerance of it they hold, or they are broken, or nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from dofkit.configuration.drawing.measured_relations import GREY, SLACK, MeasuredDrawing, Place, clear_rank

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
#: Residuals beyond this part of the tolerance that grow by a higher power of the distance are those of a contact.
SEEN, CONTACT = 0.1, 2.5
#: A bend of the set less than this, by the size, is taken for none: that of a contact would have to be so small.
PLAUSIBLE = 3e-3


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

    def holds(self, reach: float) -> bool:
        """Do the relations hold within the tolerance up to ``reach``, and beyond it as far as such errors grow?"""
        tolerance = self.drawing.tolerance
        near = [s.residual for s in self.stages if s.distance <= reach * (1 + CLOSE)]
        return max(near) <= SLACK * tolerance and all(s.residual <= GREY * tolerance for s in self.stages)

    @property
    def touches(self) -> bool:
        """Do residuals look like those of a contact, of the second order or higher?"""
        return 2 * self.stages[-1].residual > PLAUSIBLE * self.distance**2 or self.flat

    @property
    def breaks(self) -> bool:
        """Do the relations fail by far more than the tolerance, and ever more with the distance?"""
        last = self.stages[-1]
        half = max((s.residual for s in self.stages if s.distance <= last.distance * HALF), default=0.0)
        return last.residual > BROKEN * self.drawing.tolerance and last.residual > STEEP * half

    def goes_on(self, reach: float) -> bool:
        """Is it a motion as far as ``reach``?"""
        long = self.distance >= reach * (1 - CLOSE)
        return long and self.holds(reach) and not self.touches and self.rank() == self.drawing.rank

    @property
    def flat(self) -> bool:
        """Do residuals grow by a high power of the distance, as where a path only touches the set?

        With what is measured they begin in proportion to it. Below `SEEN` of the tolerance nothing is said of them.
        """
        whole = self.stages[-1]
        half, quarter = (self._before(whole.distance * part) for part in (HALF, HALF * HALF))
        if whole.residual <= SEEN * self.drawing.tolerance or not quarter.distance > 0:
            return False
        return _power(quarter, half) > CONTACT and _power(half, whole) > CONTACT

    def _before(self, distance: float) -> Stage:
        return [s for s in self.stages if s.distance <= distance * (1 + CLOSE)][-1]

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
    """The power of the distance by which residuals grow from one stage to another."""
    if not far.distance > near.distance:
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
    ahead, step = direction / np.linalg.norm(direction), stride_of(tolerance) * STRIDE * HALF * HALF
    while distance < reach * (1 - CLOSE) and step > STEP * SHORTEST:
        tangent = _tangent(kept @ j, ahead)
        size = float(np.linalg.norm(tangent))
        moved = _corrected(drawing, kept, at, tangent * (step / size)) if size > STRAIGHT else None
        if moved is None:
            step /= 2
            continue
        at, f, j = moved
        distance, ahead = distance + step, tangent / size
        step = min(step * 2, stride_of(tolerance) * STRIDE, reach - distance) if distance < reach else step
        stages.append(Stage(distance, at, f))
        if stages[-1].residual > BROKEN * 10 * tolerance:
            break
        if stages[-1].residual <= SLACK * tolerance and clear_rank(j, tolerance) == drawing.rank:
            kept = np.linalg.svd(j)[0].T[: drawing.rank]
    return MeasuredPath(drawing, tuple(stages))


def _tangent(a: Any, ahead: Any) -> Any:
    """The part of a direction along which the combinations stay 0 to first order."""
    return ahead - np.linalg.lstsq(a, a @ ahead, rcond=None)[0] if len(a) else ahead


def _corrected(drawing: MeasuredDrawing, kept: Any, at: Place, step: Any) -> tuple[Place, Any, Any] | None:
    """The place a step ahead on the manifold of the combinations, with the relations and their derivatives there.

    None where Newton's method does not lead there, or by too far a way.
    """
    relations = drawing.relations
    start, last = relations.moved(at, step), float("inf")
    here, size = start, float(np.linalg.norm(step))
    for _ in range(ROUNDS):
        f, j = relations.system(here, drawing.norms)
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
