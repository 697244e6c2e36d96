"""Branches of motion through a measured singular drawing: found beside it, and followed away from it."""

from __future__ import annotations

from typing import Any

from dofkit.base.libraries import np
from dofkit.configuration.drawing.measured_flexes import StressForms
from dofkit.configuration.drawing.measured_paths import HALF, ON, follow, stride_of
from dofkit.configuration.drawing.measured_relations import SLACK, MeasuredDrawing, Place, clear_rank
from dofkit.configuration.local.neighbourhood import damped
from dofkit.exact.errors import NoValueError

#: Attempts to find a common zero of the forms; directions in which a branch is followed.
ATTEMPTS, WAYS = 6, 3
#: A branch must be found at the first of these distances and at one of the others, by the least way of a motion.
NEAR, AWAY = 0.25, (1.0, 2.0)
#: Rounds of damped steps.
ROUNDS = 60
#: What the ways to a branch's points may differ in: their cosine is more.
ALONG = 0.8
#: Corrections less than this part of the tolerance are enough, and residuals that leave no larger ones at squares.
FINE = 1e-4
#: Directions with a larger cosine are one, in which so many searches begin.
ALIKE, AGAIN = 0.99, 2
#: A search begins so much beside a common zero: there dependent relations have no gradient where they are squares.
ASIDE = 0.03


def branch_dimension(forms: StressForms) -> int:
    """The largest dimension, across the motions of the whole, of the branches that are found; 0 where none is.

    A branch leaves along a common zero of the forms. Where its points are regular within the tolerance the rank there
    gives its dimension; where every one of them is singular, a path is one.
    """
    best, tried = 0, list[Any]()
    rng = np.random.default_rng(7)
    for _ in range(ATTEMPTS):
        v = _common_zero(forms, rng.standard_normal(forms.kernel.shape[1]))
        if v is None or sum(abs(float(v @ u)) > ALIKE for u in tried) >= AGAIN:
            continue
        tried.append(v)
        for sign in (1.0, -1.0):
            aside = ASIDE * rng.standard_normal(forms.ways)
            best = max(best, _along(forms.drawing, (sign * v + aside) @ forms.drawing.ways))
            if best >= forms.cone:
                return best
    return best


def _common_zero(forms: StressForms, start: Any) -> Any:
    """A unit vector near one of the kernel on which no form is seen not to be 0; None where none is near."""
    v = forms.kernel @ start
    v = v / np.linalg.norm(v)
    for _ in range(ROUNDS):
        slopes = forms.forms @ v
        if float(np.max(np.abs(slopes @ v))) <= forms.noise / 2:
            return v
        v = v + damped(np.vstack([2 * slopes, v]), np.append(slopes @ v, 0.0))
        v = v / np.linalg.norm(v)
    return None


def _along(drawing: MeasuredDrawing, direction: Any) -> int:
    """The dimension of the branch that leaves in a direction, across the motions of the whole; 0 for none."""
    stride = stride_of(drawing.tolerance)
    near = _beside(drawing, direction * (stride * NEAR))
    if near is None:
        return 0
    for part in AWAY:
        at = _beside(drawing, direction * (stride * part))
        rank = None if at is None else clear_rank(drawing.relations.system(at, drawing.norms)[1], drawing.tolerance)
        if at is None or rank is None:
            continue
        away = drawing.relations.between(near, at)
        if away @ direction < ALONG * np.linalg.norm(away) * np.linalg.norm(direction):
            return 0
        found = _from(drawing, at, rank, away)
        if found:
            return found
    return 0


def _from(drawing: MeasuredDrawing, at: Place, rank: int, away: Any) -> int:
    """The dimension of the set at a point beside the drawing, followed on from there."""
    relations, stride = drawing.relations, stride_of(drawing.tolerance)
    there = MeasuredDrawing(relations, at, relations.system(at)[1], rank, drawing.tolerance)
    if not follow(there, away, stride * HALF * ON).goes_on(stride * HALF):
        return 0
    rng = np.random.default_rng(3)
    directions = [rng.standard_normal(len(there.ways)) @ there.ways for _ in range(WAYS)]
    regular = rank == len(there.j) or all(follow(there, d, stride * HALF).goes_on(stride * HALF) for d in directions)
    return len(there.ways) if regular else 1


def _beside(drawing: MeasuredDrawing, step: Any) -> Place | None:
    """The point of the set nearest to a step away; None where none is near, or relations have no value on the way."""
    try:
        return _nearest(drawing, step)
    except NoValueError:
        return None


def _nearest(drawing: MeasuredDrawing, step: Any) -> Place | None:
    """By damped steps; None where relations stay beyond the tolerance."""
    relations = drawing.relations
    at: Place = relations.moved(drawing.at, step)
    size = float(np.linalg.norm(step))
    for _ in range(ROUNDS):
        f, j = relations.system(at, drawing.norms)
        if float(np.max(np.abs(f))) < min(FINE, drawing.tolerance) * FINE * drawing.tolerance:
            break
        correction = damped(j, f)
        at = relations.moved(at, correction)
        if float(np.linalg.norm(correction)) < drawing.tolerance * FINE:
            break
    residual = float(np.max(np.abs(relations.system(at, drawing.norms)[0])))
    moved = relations.between(drawing.at, at)
    near = float(moved @ step) > size * size * HALF and float(np.linalg.norm(moved)) < 2 * size
    return at if near and residual <= SLACK * drawing.tolerance else None
