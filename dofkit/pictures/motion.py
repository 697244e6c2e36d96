"""Motions of a scene, frame by frame: a sampled finite one, and each instantaneous freedom on its own."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import TIME, coordinate, parameter
from dofkit.motion.configurations import configurations
from dofkit.pictures.arrangement import MOVES, Arrangement, FreeMotion, displaced, poses_of
from dofkit.pictures.shapes import Clip, Poses, Sketch
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.words import can_hold
from dofkit.system import GROUND

#: Steps of a sampled motion to either side, their length, and the most frames that are kept.
STEPS, STEP, FRAMES = 160, 0.1, 96
#: How far from the picture a motion is shown, by the picture's size; a closed one returns to within this part of it.
FAR, BACK = 0.8, 0.03
#: Steps if there are several freedoms, and the number of points of a sketch that are compared.
SHORT, MOST_SEEN = 50, 60
#: With many coordinates fewer steps are made: this many coordinates times steps, but not fewer steps than this.
MANY, LEAST = 3000, 10
#: The time limit of a finite motion.
SECONDS = 12.0
#: Frames of an infinitesimal motion to both sides, its extent by the picture's size, and its largest rotation.
SWING, REACH, TURN = 32, 0.22, 0.6
#: The number of infinitesimal motions that are shown.
MOST_MOTIONS = 12


def clips_of(stage: StagedScene, sketch: Sketch) -> list[Clip]:
    """Return all motions that are shown: a finite one, and each freedom if there are several or no finite one."""
    if not can_hold(stage.report):
        return []
    finite = _finite(stage, _Seen(sketch))
    if finite and len(stage.motions) <= 1:
        return finite
    return [*finite, *_swings(stage.arrangement, stage.motions, stage.size)]


class _Seen:
    """The points of a sketch by which two poses are compared."""

    def __init__(self, sketch: Sketch) -> None:
        every = dict.fromkeys(v for s in sketch.shapes if s.kind != "words" for v in s.vertices if v.carrier != GROUND)
        vertices = list(every)
        self.sketch, self.vertices = sketch, vertices[:: max(1, len(vertices) // MOST_SEEN)]

    def far(self, first: Poses, last: Poses) -> float:
        """Return the largest distance between the positions of a point in two poses."""
        pairs = ((self.sketch.at(v, first), self.sketch.at(v, last)) for v in self.vertices)
        return max((float(np.linalg.norm(a - b)) for a, b in pairs), default=0.0)


def _finite(stage: StagedScene, seen: _Seen) -> list[Clip]:
    """Return a sampled motion, cut where it leaves the picture; none if nothing moves or none was followed."""
    several = len(stage.motions) > 1
    steps = min(SHORT if several else STEPS, max(LEAST, MANY // max(1, len(stage.system.coordinates))))
    try:
        with limited(SECONDS):
            path = configurations(stage.system, steps=steps, step=STEP, values=_near_values(stage))
    except DofkitError:
        return []
    numbers = stage.arrangement.numbers
    symbols = [{**numbers, **{coordinate(n): v for n, v in configuration.items()}} for configuration in path]
    frames: list[Poses] = [poses_of(stage.system, values, gibbs=False) for values in symbols]
    start = min(range(len(frames)), key=lambda k: seen.far(frames[k], stage.arrangement.poses))
    turn = _turn(seen, frames, start, stage.size)
    frames = turn or _near(seen, frames, start, FAR * stage.size)
    thinned = [frames[k] for k in np.unique(np.linspace(0, len(frames) - 1, FRAMES).astype(int))]
    name = "a finite motion that uses all freedoms" if several else "a finite motion"
    return [Clip(name, tuple(thinned[:-1] if turn else thinned), bool(turn))] if len(thinned) > 1 else []


def _near_values(stage: StagedScene) -> dict[str, float]:
    """Return the values of parameters, and of coordinates without a reference, at which the motion begins."""
    system, numbers = stage.system, stage.arrangement.numbers
    values = {p: numbers[parameter(p)] for p in system.parameters}
    if system.reference is None:
        turning = {n for r in system.rotations for n in r.names}
        names = [c.name for c in system.coordinates if c.name not in turning]
        values |= {n: numbers[coordinate(n)] for n in names if coordinate(n) in numbers}
    return values


def _turn(seen: _Seen, frames: Sequence[Poses], start: int, size: float) -> list[Poses]:
    """Return a motion that comes back to where it began, once around; nothing if it does not."""
    gone = False
    for k in range(start + 1, len(frames)):
        far = seen.far(frames[start], frames[k])
        gone = gone or far > 10 * BACK * size
        if gone and far < BACK * size and (k + 1 == len(frames) or seen.far(frames[start], frames[k + 1]) >= far):
            return list(frames[start : k + 1])
    whole = seen.far(frames[0], frames[-1]) < BACK * size and len(frames) > 8
    return list(frames) if whole else []


def _near(seen: _Seen, frames: Sequence[Poses], start: int, limit: float) -> list[Poses]:
    """Return the part of a motion about its beginning that stays near the picture."""
    here, low, high = frames[start], start, start
    while low > 0 and seen.far(here, frames[low - 1]) < limit:
        low -= 1
    while high < len(frames) - 1 and seen.far(here, frames[high + 1]) < limit:
        high += 1
    return list(frames[low : high + 1])


def _swings(arrangement: Arrangement, motions: Sequence[FreeMotion], size: float) -> list[Clip]:
    """Return each infinitesimal motion on its own, to one side and back to the other."""
    clips = []
    for k, motion in enumerate(motions[:MOST_MOTIONS]):
        of = f" {k + 1} of {len(motions)}" if len(motions) > 1 else ""
        name = f"infinitesimal motion{of}: {'time' if motion.name == str(TIME.args[1]) else motion.name}"
        far = _reach(arrangement, motion, size)
        steps = (far * math.sin(2 * math.pi * j / SWING) for j in range(SWING))
        clips.append(Clip(name, tuple(displaced(arrangement, motion, step) for step in steps), closed=True))
    return clips


def _reach(arrangement: Arrangement, motion: FreeMotion, size: float) -> float:
    """Return how far a motion is followed: a part of the picture's size, or a rotation that is still small."""
    step = 1e-3
    far, turned = 0.0, 0.0
    for name, pose in displaced(arrangement, motion, step).items():
        here = arrangement.poses[name]
        middle = here.turn.T @ (np.zeros(3) - here.shift)
        far = max(far, float(np.linalg.norm(pose.moved(middle) - here.moved(middle))) / step)
        turned = max(turned, float(np.linalg.norm(pose.turn - here.turn)) / step / math.sqrt(2))
    bounds = [REACH * size / far if far > MOVES else math.inf, TURN / turned if turned > MOVES else math.inf]
    return min((b for b in bounds if math.isfinite(b)), default=0.0)
