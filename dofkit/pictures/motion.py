"""Motions of a scene, frame by frame: a sampled finite one, and each free one by itself to first order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import coordinate, parameter
from dofkit.motion.sampled.configurations import configurations
from dofkit.pictures.arrangement import poses_of
from dofkit.pictures.rates import swings
from dofkit.pictures.shapes import Clip, Poses, Sketch
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.states import can_hold
from dofkit.system import GROUND

#: Steps of a sampled motion to either side, their length, and the most frames that are kept.
STEPS, STEP, FRAMES = 160, 0.1, 96
#: How far from the picture a motion is shown, by the picture's size; what closes up comes back to this part of it.
FAR, BACK = 0.8, 0.03
#: Steps where there are several freedoms, and so many places of a sketch are compared.
SHORT, MOST_SEEN = 50, 60
#: Of many coordinates fewer steps are made: so many coordinates times steps, but not fewer steps than this.
MANY, LEAST = 3000, 10
#: So long a finite motion is looked for.
SECONDS = 12.0


def clips_of(stage: StagedScene, sketch: Sketch) -> list[Clip]:
    """All motions that are shown: a finite one where there is, and where there are several freedoms or none, each."""
    if not can_hold(stage.report):
        return []
    finite = _finite(stage, _Seen(sketch))
    several = len(stage.motions) > 1 or not finite
    if not several:
        return finite
    return [*finite, *swings(stage.arrangement, stage.motions, stage.size)]


class _Seen:
    """The places of a sketch that tell whether two poses look alike."""

    def __init__(self, sketch: Sketch) -> None:
        found = dict.fromkeys(v for s in sketch.shapes if s.kind != "words" for v in s.vertices if v.carrier != GROUND)
        vertices = list(found)
        self.sketch, self.vertices = sketch, vertices[:: max(1, len(vertices) // MOST_SEEN)]

    def far(self, first: Poses, last: Poses) -> float:
        """The largest distance between where two poses put a place."""
        pairs = ((self.sketch.at(v, first), self.sketch.at(v, last)) for v in self.vertices)
        return max((float(np.linalg.norm(a - b)) for a, b in pairs), default=0.0)


def _finite(stage: StagedScene, seen: _Seen) -> list[Clip]:
    """A sampled motion, cut where it leaves the picture; none where nothing moves or none was followed."""
    several = len(stage.motions) > 1
    steps = min(SHORT if several else STEPS, max(LEAST, MANY // max(1, len(stage.system.coordinates))))
    try:
        with limited(SECONDS):
            told = configurations(stage.system, steps=steps, step=STEP, values=_near_values(stage))
    except DofkitError:
        return []
    numbers = stage.arrangement.numbers
    frames = [
        poses_of(stage.system, {**numbers, **{coordinate(n): v for n, v in one.items()}}, gibbs=False) for one in told
    ]
    start = min(range(len(frames)), key=lambda k: seen.far(frames[k], stage.arrangement.poses))
    turn = _turn(seen, frames, start, stage.size)
    shown = turn or _near(seen, frames, start, FAR * stage.size)
    thinned = [shown[k] for k in np.unique(np.linspace(0, len(shown) - 1, FRAMES).astype(int))]
    name = "a finite motion that uses all freedoms" if several else "a finite motion"
    return [Clip(name, tuple(thinned[:-1] if turn else thinned), bool(turn))] if len(thinned) > 1 else []


def _near_values(stage: StagedScene) -> dict[str, float]:
    """The numbers of parameters, and where the drawing gives none of coordinates, for where the motion begins."""
    system, numbers = stage.system, stage.arrangement.numbers
    found = {p: numbers[parameter(p)] for p in system.parameters}
    if system.reference is None:
        turning = {n for r in system.rotations for n in r.names}
        own = [c.name for c in system.coordinates if c.name not in turning]
        found |= {n: numbers[coordinate(n)] for n in own if coordinate(n) in numbers}
    return found


def _turn(seen: _Seen, frames: Sequence[Poses], start: int, size: float) -> list[Poses]:
    """A motion that comes back to where it began, once around; nothing where it does not."""
    gone = False
    for k in range(start + 1, len(frames)):
        far = seen.far(frames[start], frames[k])
        gone = gone or far > 10 * BACK * size
        if gone and far < BACK * size and (k + 1 == len(frames) or seen.far(frames[start], frames[k + 1]) >= far):
            return list(frames[start : k + 1])
    whole = seen.far(frames[0], frames[-1]) < BACK * size and len(frames) > 8
    return list(frames) if whole else []


def _near(seen: _Seen, frames: Sequence[Poses], start: int, limit: float) -> list[Poses]:
    """The part of a motion about its beginning that stays near the picture."""
    here, low, high = frames[start], start, start
    while low > 0 and seen.far(here, frames[low - 1]) < limit:
        low -= 1
    while high < len(frames) - 1 and seen.far(here, frames[high + 1]) < limit:
        high += 1
    return list(frames[low : high + 1])
