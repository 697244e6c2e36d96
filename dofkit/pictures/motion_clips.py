"""The motions of a scene as clips: sampled finite motions, infinitesimal ones, and those without some constraint."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from dofkit.base.deadline import by_processor
from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import TIME, Expr
from dofkit.motion.configurations import MotionSampler, sampling
from dofkit.motion.loops import by_pivots
from dofkit.pictures.arrangement import MOVES, FreeMotion, displaced, free_motions, moved_numbers
from dofkit.pictures.evaluation import exemplified, kernel
from dofkit.pictures.shapes import Array, Clip, Poses, Sketch, Switch, place
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.words import can_hold, sure
from dofkit.scene.lowering import lower
from dofkit.scene.scene import without
from dofkit.system import GROUND

#: Steps of a sampled motion in each direction, their length, and the most frames that are kept.
STEPS, STEP, FRAMES = 160, 0.1, 96
#: If there are several motions: steps and frames of each, and the most frames of all.
SHORT, FEW, MOST_FRAMES = 25, 28, 84
#: By the picture's size: how far beyond the picture a motion is shown, and how close a closed motion returns.
FAR, BACK = 0.5, 0.05
#: The number of points of a sketch by which two poses are compared.
MOST_SEEN = 60
#: The most steps times coordinates, and the least number of steps.
MANY, LEAST = 3000, 10
#: The limit of processor time for finite motions, in seconds.
SECONDS = 12.0
#: An infinitesimal motion: its frames, its extent by the picture's size, its largest rotation in radians.
SWING, REACH, TURN = 9, 0.22, 0.6
#: The number of motions, and of constraints with a switch, that are shown.
MOST_MOTIONS, MOST_SWITCHES = 12, 8
FINITE, IN_TIME = "a finite motion", "motion in time"
GOES_ON = "This infinitesimal motion goes on: it was followed as a finite motion."
ENDS = "This infinitesimal motion does not go on: "
NONE_FOUND, NO_MOTION = "no finite motion in its direction was found.", "no finite motion is possible{}."
NOT_SAMPLED = "No finite motion was sampled: {}"
AT_REST_TEXT = "Time goes on, and the coordinates rest."
UNCHANGED = "{} is redundant{}: without it the motion goes on unchanged."
IMPLIED = "{} is implied by the others as long as {} in use: without it the motion goes on unchanged."
NEEDED = "{} is needed: without it this motion is possible too (what it moves is outlined in dashes and dots)."


class ClipMaker:
    """Makes the clips of a scene; motions are compared by the positions of a sketch's vertices."""

    def __init__(self, stage: StagedScene, sketch: Sketch) -> None:
        every = dict.fromkeys(v for s in sketch.shapes if s.kind != "words" for v in s.vertices if v.carrier != GROUND)
        vertices = list(every)
        self.stage, self.sketch, self.motions = stage, sketch, stage.motions[:MOST_MOTIONS]
        self.few = min(FEW, MOST_FRAMES // max(1, len(self.motions)))
        self.vertices = vertices[:: max(1, len(vertices) // MOST_SEEN)]
        self.moves = can_hold(stage.report) and bool(vertices)

    def clips(self) -> list[Clip]:
        """Return the clips of finite motions, infinitesimal ones where they could not be followed, and of `_time`."""
        if not self.moves:
            return []
        return [*self._motions(), *self._time()]

    def _time(self) -> Iterator[Clip]:
        """Yield a clip of shapes that depend on time, with all coordinates at rest, if no constraint mentions time."""
        arrangement = self.stage.arrangement
        written = {s for c in self.stage.system.constraints for r in c.relations for s in r.expr.symbols}
        if TIME not in written and any(p.depends_on("time") for p in arrangement.placements.values()):
            path = [{**arrangement.numbers, TIME: t} for t in np.linspace(0.0, 2 * math.pi, self.few)]
            frames = tuple(arrangement.poses_at(numbers, gibbs=True) for numbers in path)
            yield Clip("time", frames, tuple(path), text=AT_REST_TEXT)

    def _motions(self) -> list[Clip]:
        """Return the clips of finite motions, or of infinitesimal ones if none could be sampled."""
        with by_processor(SECONDS), sampling(self.stage.system):
            try:
                sampler = MotionSampler(self.stage.system, self.stage.arrangement.first_values)
                if self.stage.report.singular:
                    return list(self._at_singularity(sampler))
                if len(self.motions) > 1 or (self.motions and sampler.relations.forms):
                    return list(self._in_turn(sampler))
                path = sampler.configurations(self._steps(STEPS), STEP)
                return [*self._sampled(FINITE, path)] or self._swings(self.motions)
            except DofkitError as error:
                return self._swings(self.motions, NOT_SAMPLED.format(error))

    def _steps(self, most: int) -> int:
        return min(most, max(LEAST, MANY // max(1, len(self.stage.system.coordinates))))

    def _in_turn(self, sampler: MotionSampler) -> Iterator[Clip]:
        """Yield a clip for each free velocity, with the others held at 0."""
        names = _names_in_turn(self.stage.motions)
        for name, motion in zip(names, self.motions, strict=False):
            held = [other.symbol for other in self.stage.motions if other is not motion]
            clips, reason = list[Clip](), ""
            try:
                clips += self._sampled(name, self._free_motion(sampler, motion, held), self.few)
            except DofkitError as error:
                reason = NOT_SAMPLED.format(error)
            yield from clips or self._swings([motion], reason)

    def _free_motion(self, sampler: MotionSampler, motion: FreeMotion, held: Sequence[Expr]) -> list[dict[str, float]]:
        """Return a motion with such steps that it reaches the edge of the picture in half of `SHORT` steps."""
        speed = float(np.linalg.norm(sampler.relations.step_of(motion.rates)))
        step = float(np.clip(2 * FAR / REACH * self._reach(motion) * speed / SHORT, STEP / 10, 2 * STEP))
        steps = self._steps(SHORT if sampler.relations.forms else 2 * SHORT)
        return sampler.free_motion(motion.rates, held, steps, step)

    def _at_singularity(self, sampler: MotionSampler) -> Iterator[Clip]:
        """Yield the finite motions that leave a singular configuration, and the other infinitesimal motions."""
        rows = np.array([sampler.relations.step_of({m.symbol: 1.0}) for m in self.motions])
        coefficients: list[Array] = []
        for direction, path in sampler.branches(self._steps(SHORT), STEP):
            coefficients.append(rows @ direction / np.sum(rows**2, axis=1))
            arrows = self._arrows(_combined(self.motions, coefficients[-1]))
            for clip in self._sampled(f"finite motion {len(coefficients)}", path, self.few):
                yield clip._replace(text=GOES_ON, arrows=arrows)
        others, pivots = by_pivots(kernel(np.array(coefficients), len(self.motions)), range(len(self.motions)))
        yield from self._swings([
            _combined(self.motions, part)._replace(name=self.motions[k].name)
            for part, k in zip(others, pivots, strict=False)
        ])  # fmt: skip

    def _sampled(self, name: str, path: Iterable[Mapping[str, float]], most: int = FRAMES) -> Iterator[Clip]:
        """Yield the clip of a sampled motion, cut where it leaves the picture; nothing if one frame is left."""
        numbers = [*self.stage.arrangement.along(path)]
        frames = [self.stage.arrangement.poses_at(n, gibbs=False) for n in numbers]
        size = self.stage.size
        start = min(range(len(frames)), key=lambda k: self._gap(frames[k], self.stage.arrangement.poses))
        turn = self._turn(frames, start)
        low, high = turn or self._near(frames, start, FAR * size)
        kept = np.unique(np.linspace(low, high, most).astype(int))[: -1 if turn else None]
        if len(kept) > 1:
            yield Clip(name, tuple(frames[k] for k in kept), tuple(numbers[k] for k in kept), bool(turn))

    def _gap(self, first: Poses, last: Poses) -> float:
        """Return the largest distance between the positions of a point in two poses."""
        pairs = ((self.sketch.at(v, first), self.sketch.at(v, last)) for v in self.vertices)
        return max((float(np.linalg.norm(a - b)) for a, b in pairs), default=0.0)

    def _turn(self, frames: Sequence[Poses], start: int) -> tuple[int, int] | None:
        """Return (first, last) frame of one turn of a motion that returns to its beginning, or None."""
        gone, back = False, BACK * self.stage.size
        for k in range(start + 1, len(frames)):
            far = self._gap(frames[start], frames[k])
            gone = gone or far > 10 * back
            if gone and far < back and (k + 1 == len(frames) or self._gap(frames[start], frames[k + 1]) >= far):
                return start, k
        whole = self._gap(frames[0], frames[-1]) < back and len(frames) > 8
        return (0, len(frames) - 1) if whole else None

    def _near(self, frames: Sequence[Poses], start: int, far: float) -> tuple[int, int]:
        """Return (first, last) frame of the part of a motion around frame ``start`` that stays near the picture."""
        places = np.array([[self.sketch.at(v, frame) for v in self.vertices] for frame in frames])
        low, high = np.min(places[start], axis=0) - far, np.max(places[start], axis=0) + far
        outside = np.flatnonzero(np.any((places < low) | (places > high), axis=(1, 2)))
        before, after = outside[outside < start], outside[outside > start]
        return int(before[-1]) + 1 if len(before) else 0, int(after[0]) - 1 if len(after) else len(frames) - 1

    # Infinitesimal motions

    def _swings(self, motions: Sequence[FreeMotion], reason: str = "") -> list[Clip]:
        """Return a clip of each infinitesimal motion, from one side to the other.

        ``reason``: why no finite motion is shown instead.
        """
        clips, report = [], self.stage.report
        end = NO_MOTION.format(sure(report, "velocity_dof")) if report.velocity_dof == 0 else NONE_FOUND
        for motion in motions:
            far = self._reach(motion)
            steps = np.linspace(-far, far, SWING)
            numbers = tuple(moved_numbers(self.stage.arrangement, motion, float(step)) for step in steps)
            frames = tuple(self.stage.arrangement.poses_at(n, gibbs=True) for n in numbers)
            text, arrows = (ENDS + end, self._arrows(motion)) if report.singular else (reason, ())
            name = f"infinitesimal motion: {motion.name}"
            clips.append(Clip(name, frames, numbers, text=text, arrows=arrows))
        return clips

    def _arrows(self, motion: FreeMotion) -> tuple[tuple[Array, Array], ...]:
        """Return (start, end) of the arrows that show the velocities of traced points."""
        step = 1e-4
        moved, scale = displaced(self.stage.arrangement, motion, step), self._reach(motion) / step
        points = [(self.sketch.at(v), self.sketch.at(v, moved)) for v in self.sketch.traced]
        pairs = {place(np.round(a, 9)): (a, a + scale * (b - a)) for a, b in points}.values()
        return tuple((a, b) for a, b in pairs if np.linalg.norm(b - a) > MOVES * self.stage.size)

    def _reach(self, motion: FreeMotion) -> float:
        """Return the extent of an infinitesimal motion: `REACH` of the picture size, less if a body turns by `TURN`."""
        step = 1e-3
        far, turned = 0.0, 0.0
        for name, pose in displaced(self.stage.arrangement, motion, step).items():
            here = self.stage.arrangement.poses[name]
            middle = here.turn.T @ (np.zeros(3) - here.shift)
            far = max(far, float(np.linalg.norm(pose.moved(middle) - here.moved(middle))) / step)
            turned = max(turned, float(np.linalg.norm(pose.turn - here.turn)) / step / math.sqrt(2))
        bounds = [
            REACH * self.stage.size / far if far > MOVES else math.inf,
            TURN / turned if turned > MOVES else math.inf,
        ]
        return min((b for b in bounds if math.isfinite(b)), default=0.0)

    # Constraints left out

    def switches(self) -> Iterator[tuple[Switch, list[Clip]]]:
        """Yield (switch, clips that are new without the constraint) for the constraints of a redundant scene.

        If there are many constraints, the redundant ones come first.
        """
        report = self.stage.report
        redundant = report.redundant or []
        if not self.moves or not report.redundant_equations:
            return
        first = sorted(report.constraints, key=lambda entry: entry.name not in redundant)[:MOST_SWITCHES]
        for entry in (entry for entry in report.constraints if entry in first):
            if entry.name in redundant:
                yield Switch(entry.name, UNCHANGED.format(entry.name, sure(report, "redundant")), True), []
                continue
            try:
                clips = self._without(entry.name)
            except DofkitError:
                continue
            others = f"{', '.join(redundant)} {'is' if len(redundant) == 1 else 'are'}"
            text = NEEDED.format(entry.name) if clips is not None else IMPLIED.format(entry.name, others)
            yield Switch(entry.name, text), clips or []

    def _without(self, name: str) -> list[Clip] | None:
        """Return the clip of the names motion that is possible only without a constraint; None if there is none."""
        stage = self.stage
        scene = without(stage.scene, [name])
        arrangement = replace(stage.arrangement, system=exemplified(lower(scene)))
        names = [str(m.symbol.args[1]) for m in stage.motions]
        motions = free_motions(arrangement, names)
        extra = [m for m in motions if m.symbol not in {m.symbol for m in stage.motions}]
        if not extra:
            return None
        held = [m.symbol for m in motions if m is not extra[0]]
        with by_processor(SECONDS), sampling(arrangement.system):
            sampler = MotionSampler(arrangement.system, arrangement.first_values)
            path = self._free_motion(sampler, extra[0], held)
        clips = self._sampled(f"without {name}: {extra[0].name}", path, self.few // 2)
        return [clip._replace(text=NEEDED.format(name), dropped=name) for clip in clips]


def _names_in_turn(motions: Sequence[FreeMotion]) -> list[str]:
    """Return a name for the finite motion of each free velocity, and for the motion in time."""
    free = [motion for motion in motions if motion.symbol != TIME]
    if len(motions) == 1:
        return [FINITE]
    numbered = [f"free velocity {k} of {len(free)}: {motion.name}" for k, motion in enumerate(free, 1)]
    return [IN_TIME] * (len(motions) - len(free)) + numbered


def _combined(motions: Sequence[FreeMotion], weights: Sequence[float] | Array) -> FreeMotion:
    """Return a linear combination of motions."""
    rates = {s: float(sum(w * m.rates[s] for w, m in zip(weights, motions, strict=True))) for s in motions[0].rates}
    return motions[0]._replace(rates=rates)
