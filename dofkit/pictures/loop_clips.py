"""Clips of loops: two coordinates move around a closed curve, and the others return or end displaced."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from dofkit.base.wording import many, series, verb
from dofkit.motion.configurations import NoMotionError
from dofkit.motion.loops import Loop, LoopSampler
from dofkit.pictures.shapes import Clip, Shape, Sketch, fixed
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.words import sure
from dofkit.report import Report

#: Radii of loops, in radians or scene sizes; one of `EVERY` frames is kept; displacements below `CLOSED` count as 0.
SIZES, EVERY, CLOSED = (0.25, 0.5, 0.8), 3, 1e-9


def loop_clips(stage: StagedScene) -> tuple[list[Clip], list[str]]:
    """Return (clips of loops of pairs of free coordinates in several sizes, why others could not be followed).

    Raises NoMotionError if there are none.
    """
    sampler = LoopSampler(stage.system, stage.arrangement.first_values)
    clips = [_clip(stage, loop) for size in SIZES for loop in sampler.loops(size)]
    if not clips:
        raise NoMotionError(" ".join(sampler.stopped))
    names = list(dict.fromkeys(clip.name for clip in clips))
    return sorted(clips, key=lambda clip: names.index(clip.name)), sampler.stopped


def _clip(stage: StagedScene, loop: Loop) -> Clip:
    path = tuple(stage.arrangement.along(loop.configurations[::EVERY]))
    frames = tuple(stage.arrangement.poses_at(numbers, gibbs=False) for numbers in path)
    return Clip(f"loop of {' and '.join(loop.coordinates)}", frames, path, size=loop.size, text=_words(loop), loop=True)


def _words(loop: Loop) -> str:
    """Return a sentence on the displacement at the end of a loop, with the prediction of the bracket."""
    round_again = f"{' and '.join(loop.coordinates)} return"
    moved = {n: v for n, v in loop.displacement.items() if abs(v) > CLOSED}
    if not moved:
        return f"{round_again}, and so does everything else: the loop closes."
    least = 1e-3 * max(map(abs, moved.values()))
    predicted = {n: v if abs(v) > CLOSED else 0.0 for n, v in loop.prediction.items()}
    listed = [f"{n} by {v:.3g} (bracket: {predicted[n]:.3g})" for n, v in moved.items() if abs(v) > least]
    return f"{round_again}; displaced are {series(listed)}."


def loop_notes(report: Report) -> Iterator[str]:
    """Yield sentences on the growth vector, bracket by bracket, and on the integrals, which are constant."""
    vector = report.growth_vector or []
    if vector:
        added = [
            f"brackets of {order} fields add {many(more - fewer, 'direction')}"
            for order, (fewer, more) in enumerate(pairwise(vector), 2)
        ]
        words = series(added) or "no bracket adds a direction"
        yield f"Growth vector ({', '.join(map(str, vector))}){sure(report, 'growth_vector')}: {words}."
    integrals = [f"{entry.name}: {entry.integral}" for entry in report.constraints if entry.integral]
    if integrals:
        keeps = verb(len(integrals), "An integral keeps its value", "Integrals keep their values")
        yield f"{keeps}: {'; '.join(integrals)}."


def traces(sketch: Sketch, clip: Clip, frame: int) -> Iterator[Shape]:
    """Yield the paths of traced vertices up to a frame; for a loop also its start, and at its end the displacement."""
    bodies = [s for s in sketch.shapes if clip.loop and frame and s.role in ("body", "bar") and s.state == "moving"]
    for shape in bodies:
        corners = fixed(*(sketch.at(v, clip.frames[0]) for v in shape.vertices))
        yield shape._replace(vertices=corners, role="ghost", state="plain")
    for vertex in sketch.traced:
        path = [sketch.at(vertex, poses) for poses in clip.frames[: frame + 1]]
        whole = clip.closed and frame == len(clip.frames) - 1
        yield Shape("line", fixed(*path, *path[:whole]), "trace")
        gap = float(np.linalg.norm(path[-1] - path[0]))
        if clip.loop and frame == len(clip.frames) - 1 and gap > 1e-6 * sketch.size:
            yield Shape("arrow", fixed(path[0], path[-1]), "arrow", size=0.04 * sketch.size)
