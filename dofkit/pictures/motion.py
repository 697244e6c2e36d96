"""Motions of a scene, frame by frame: a sampled finite one, and each free one by itself to first order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import coordinate
from dofkit.motion.sampled.configurations import configurations
from dofkit.pictures.arrangement import poses_of
from dofkit.pictures.rates import swings
from dofkit.pictures.shapes import Array, Clip, Poses
from dofkit.pictures.stage import Stage

#: Steps of a sampled motion to either side, their length, and the most frames that are kept.
STEPS, STEP, FRAMES = 260, 0.06, 96
#: How far from the picture a motion is shown, by the picture's size; what closes up comes back to this part of it.
FAR, BACK = 1.1, 0.02


def clips_of(stage: Stage) -> list[Clip]:
    """All motions that are shown: a finite one where there is, and where there are several freedoms or none, each."""
    finite = _finite(stage)
    report = stage.report
    several = len(stage.motions) > 1 or not finite
    if report.consistent is False or not several:
        return finite
    return [*finite, *swings(stage.arrangement, stage.motions, stage.size)]


def _finite(stage: Stage) -> list[Clip]:
    """A sampled motion, cut where it leaves the picture; none where nothing moves or none was followed."""
    system, numbers = stage.system, stage.arrangement.numbers
    turning = {n for r in system.rotations for n in r.names}
    near = {p: numbers[s] for s in numbers if (p := str(s.args[1])) in system.parameters}
    if system.reference is None:
        near |= {c.name: numbers[coordinate(c.name)] for c in system.coordinates
                 if c.name not in turning and coordinate(c.name) in numbers}  # fmt: skip
    several = len(stage.motions) > 1
    try:
        told = configurations(system, steps=80 if several else STEPS, step=STEP, values=near)
    except DofkitError:
        return []
    frames = [poses_of(system, {**numbers, **{coordinate(n): v for n, v in one.items()}}, gibbs=False) for one in told]
    start = min(range(len(frames)), key=lambda k: _far(stage, frames[k], stage.arrangement.poses))
    closed = len(frames) > 8 and _far(stage, frames[0], frames[-1]) < BACK * stage.size
    if not closed:
        frames = _near(stage, frames, start)
    thinned = [frames[k] for k in np.unique(np.linspace(0, len(frames) - 1, FRAMES).astype(int))]
    if closed:
        thinned = thinned[:-1]
    name = "a finite motion" if not several else "a finite motion, with all freedoms"
    return [Clip(name, tuple(thinned), closed)] if len(thinned) > 1 else []


def _far(stage: Stage, first: Poses, last: Poses) -> float:
    """The largest distance between where two poses put the picture."""
    pairs = zip(_seen(stage, first), _seen(stage, last), strict=True)
    return max((float(np.max(np.abs(a - b))) for a, b in pairs), default=0.0)


def _seen(stage: Stage, poses: Poses) -> list[Array]:
    """Two points of everything that moves."""
    arms = (np.zeros(3), np.array([stage.size, 0.0, 0.0]), np.array([0.0, stage.size, 0.0]))
    found = []
    for name, pose in poses.items():
        middle = stage.arrangement.poses[name].turn.T @ (np.array(stage.centre) - stage.arrangement.poses[name].shift)
        found += [pose.moved(middle + arm) for arm in arms]
    return found


def _near(stage: Stage, frames: Sequence[Poses], start: int) -> list[Poses]:
    """The part of a motion about its beginning that stays near the picture."""
    here = frames[start]
    low, high = start, start
    while low > 0 and _far(stage, here, frames[low - 1]) < FAR * stage.size:
        low -= 1
    while high < len(frames) - 1 and _far(stage, here, frames[high + 1]) < FAR * stage.size:
        high += 1
    return list(frames[low : high + 1])
