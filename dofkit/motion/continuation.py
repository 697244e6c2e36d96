"""Following a motion by arclength continuation: a step along the null space of the constraints, then a correction.

Let A be the matrix of the derivatives of the geometric equations g and of the one-forms omega. A direction d with
A d = 0 is continued as straight as the constraints allow: reflected at each chord, and projected. A step of length h
from z0 solves g(z) = 0, (z - z0 - h d).d = 0 and omega(midpoint)(z - z0) = 0, so that forms are satisfied to the third
order in h. If time occurs, steps are in time instead of arclength.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from dofkit.exact.matrices.dense import array_step
from dofkit.motion.poses import FAULTS, Array, Pose, PoseRelations

#: The largest relative residual, rounds of Newton's method, and rounds at its beginning with stronger damping.
HELD, ROUNDS, EASY = 1e-12, 60, 8
#: Singular values of a matrix with rows of length 1 count as 0 below this.
SMALL = 1e-7
#: The largest correction relative to a step, the least cosine between steps, the smallest fraction of a step.
SLACK, STRAIGHT, LEAST = 0.3, 0.9, 2.0**-12
#: A value above minus this counts as not negative, and a velocity below it as 0.
STILL = 1e-6
#: The longest chord on which forms are integrated.
CHORD = 1 / 100
#: Random directions in which a singular configuration is left, and lengths of the first step, in steps.
TRIES, AWAY = 32, (1.0, 0.25, 0.0625, 0.015625)


@dataclass(frozen=True)
class Reached:
    """A pose, and the direction in which it was reached (of length 1, or with unit speed in time)."""

    pose: Pose
    direction: Array


#: The first poses of a motion (forward, backward), None where there is none.
BothDirections = tuple[Reached | None, Reached | None]


class Follower:
    """Follows motions under relations; ``freedom``: the dimension of the admissible directions at a regular pose.

    ``held``: rows r of further conditions r.velocity = 0, which ``freedom`` takes into account.
    """

    def __init__(self, relations: PoseRelations, freedom: int, held: Array | None = None) -> None:
        self.relations, self.freedom = relations, freedom
        self.held = np.zeros((0, relations.columns)) if held is None else held
        runs = relations.timed and not np.any(self.held[:, relations.time])
        self.clock = relations.time if runs else None

    def holds(self, pose: Pose) -> bool:
        """Return whether the geometric equations are satisfied."""
        return self._is_met(pose, self.relations.at(pose)[0])

    def _is_met(self, pose: Pose, f: Array) -> bool:
        reach = 1 + float(np.max(np.abs(pose.plain / self.relations.scales), initial=0.0))
        return f.size == 0 or float(np.max(np.abs(f))) < HELD * reach

    def onto(self, pose: Pose, any_time: bool = False) -> Pose | None:
        """Return a near pose on the geometric equations, at the same time unless ``any_time``, or None."""
        start = pose
        try:
            for k in range(4 * ROUNDS):
                f, j = self.relations.at(pose)
                if f.size == 0 or float(np.max(np.abs(f))) < HELD / 100:
                    break
                if self.clock is not None and not any_time:
                    j[:, self.clock] = 0.0
                pose = self.relations.moved(pose, array_step(j, f, 1, float(np.linalg.norm(f)) ** (1 + (k > EASY))))
        except FAULTS:
            return None
        return pose if np.all(np.isfinite(self.relations.between(start, pose))) and self.holds(pose) else None

    def null_space(self, pose: Pose) -> Array:
        """Return an orthonormal basis of the admissible velocities, as rows."""
        _, j = self.relations.at(pose)
        rows = np.vstack([j, self.relations.forms_at(pose), self.held])
        if not rows.size:
            return np.eye(self.relations.columns)
        _, singular, right = np.linalg.svd(rows)
        return np.asarray(right[int(np.sum(singular > SMALL)) :])

    def ahead(self, pose: Pose, direction: Array) -> Array | None:
        """Return the admissible direction nearest to ``direction``, of length 1 or unit speed in time, or None."""
        basis = self.null_space(pose)
        tangent = np.asarray(basis.T @ (basis @ direction))
        if self.clock is None:
            size = float(np.linalg.norm(tangent))
            return tangent / size if size > 0.1 * float(np.linalg.norm(direction)) > 0 else None
        speeds = basis[:, self.clock]
        if float(speeds @ speeds) < SMALL:
            return None
        pace = 1.0 if direction[self.clock] >= 0 else -1.0
        tangent = tangent + basis.T @ (speeds * ((pace - tangent[self.clock]) / float(speeds @ speeds)))
        return np.asarray(tangent)

    def path(self, start: Reached, step: float) -> Iterator[Reached]:
        """Yield the poses after each step, until the motion cannot be continued."""
        current = start
        while True:
            remaining, part = step, min(step, CHORD) if self.relations.forms else step
            if self.clock is not None:
                remaining -= abs(float(current.pose.plain[-1])) % step if current is start else 0.0
            while remaining > step * LEAST / 2:
                part = min(part, remaining)
                reached = self._step(current, part)
                if reached is None:
                    part /= 2
                    if part < step * LEAST:
                        return
                    continue
                current, remaining, part = reached, remaining - part, part * (1.0 if self.relations.forms else 2.0)
            yield current

    def _step(self, current: Reached, length: float) -> Reached | None:
        """Return the pose at a distance ahead; None if the step is too long to be reliable, or the motion ends."""
        try:
            wanted = length * current.direction
            along = np.zeros((1, self.relations.columns))
            if self.clock is None:
                along[0] = wanted / np.linalg.norm(wanted)
            else:
                along[0, self.clock] = 1.0
            pose = self.stepped(current.pose, wanted, np.vstack([along, self.held]))
            if pose is None:
                return None
            displacement = self.relations.between(current.pose, pose)
            if float(np.linalg.norm(displacement - wanted)) > SLACK * float(np.linalg.norm(wanted)):
                return None
            direction = self.ahead(pose, 2 * displacement / length - current.direction)
        except FAULTS:
            return None
        if direction is None:
            return None
        cosine = direction @ current.direction / (np.linalg.norm(direction) * np.linalg.norm(current.direction))
        return Reached(pose, direction) if cosine > STRAIGHT else None

    def stepped(self, start: Pose, wanted: Array, along: Array) -> Pose | None:
        """Return the pose after a step that satisfies all relations, and equals ``wanted`` along the rows ``along``."""
        relations = self.relations
        pose, rounds, rests = relations.moved(start, wanted), 0, False
        while True:
            displacement = relations.between(start, pose)
            f, j = relations.at(pose)
            forms = relations.forms_at(relations.moved(start, displacement / 2))
            wrong = np.concatenate([f, forms @ displacement, along @ (displacement - wanted)])
            if rests or rounds == ROUNDS or float(np.max(np.abs(wrong))) < HELD / 100:
                break
            shift = float(np.linalg.norm(wrong)) ** (1 + (rounds > EASY))
            step = array_step(np.vstack([j, forms, along]), wrong, 1, shift)
            pose, rounds, rests = relations.moved(pose, step), rounds + 1, float(np.linalg.norm(step)) < 1e-16
        slip = float(np.max(np.abs(forms @ displacement), initial=0.0))
        return pose if self._is_met(pose, f) and slip < HELD else None

    def begin(self, pose: Pose, target: Array | None, step: float) -> BothDirections:
        """Return the first poses of a motion, forward and backward, near the direction ``target`` if given."""
        basis = self.null_space(pose)
        stopped = self.clock is not None and float(np.sum(basis[:, self.clock] ** 2)) < SMALL
        if stopped or len(basis) != self.freedom:
            return self._both_ways(pose, self._departures(pose, step, basis), target)
        goal = self._first_direction(basis) if target is None else target
        direction = basis.T @ (basis @ goal)
        if self.clock is not None:
            direction[self.clock] = 1.0
        ahead, back = self.ahead(pose, direction), self.ahead(pose, -direction)
        return None if ahead is None else Reached(pose, ahead), None if back is None else Reached(pose, back)

    def _first_direction(self, basis: Array) -> Array:
        """Return the direction of the first column that moves, or of time."""
        weights = np.zeros(basis.shape[1])
        sizes = np.linalg.norm(basis, axis=0)
        column = int(np.argmax(sizes > 0.1 * np.max(sizes))) if self.clock is None else self.clock
        weights[column] = 1.0
        return weights

    def _departures(self, pose: Pose, step: float, basis: Array) -> list[Reached]:
        """Return regular poses near a singular one, reached in random directions; if there are none, singular ones."""
        rng = np.random.default_rng(3)
        singular: list[Reached] = []
        for part in AWAY:
            regular: list[Reached] = []
            for _ in range(TRIES):
                v = basis.T @ rng.standard_normal(len(basis))
                reached = self._reached(pose, part * step * v / np.linalg.norm(v))
                if reached is None:
                    continue
                (regular if len(self.null_space(reached.pose)) == self.freedom else singular).append(reached)
            if regular:
                return regular
        return singular

    def branches(self, pose: Pose, step: float) -> list[BothDirections]:
        """Return the first poses, (forward, backward), of each motion that was found to leave a singular pose."""
        departures = self._departures(pose, step, self.null_space(pose))
        branches: list[Reached] = []
        for reached in departures:
            if all(abs(float(reached.direction @ other.direction)) < STRAIGHT for other in branches):
                branches.append(reached)
        return [self._both_ways(pose, [reached], reached.direction) for reached in branches]

    def _reached(self, pose: Pose, step: Array) -> Reached | None:
        """Return the pose near ``pose`` + ``step`` on the configuration space; None if the way there differs much."""
        length = float(np.linalg.norm(step))
        moved = self.onto(self.relations.moved(pose, step), any_time=True)
        if moved is None:
            return None
        displacement = self.relations.between(pose, moved)
        size = float(np.linalg.norm(displacement))
        if not length / 4 < size < 4 * length:
            return None
        try:
            direction = self.ahead(moved, displacement / size)
        except FAULTS:
            return None
        return None if direction is None else Reached(moved, direction)

    def _both_ways(self, pose: Pose, poses: list[Reached], target: Array | None) -> BothDirections:
        """Return the poses reached furthest along and against the direction ``target``; None where there is none."""
        if not poses:
            return None, None
        if self.clock is not None:
            target = np.eye(self.relations.columns)[self.clock]
        goal = poses[0].direction if target is None else target
        first = max(poses, key=lambda r: float(r.direction @ goal))
        opposite = self._reached(pose, -self.relations.between(pose, first.pose))
        last = min([*poses, *([opposite] if opposite else [])], key=lambda r: float(r.direction @ goal))
        return first if first.direction @ goal >= 0 else None, last if last.direction @ goal < 0 else None


def trail(follower: Follower, start: Pose, first: Reached | None, steps: int, step: float) -> tuple[list[Pose], bool]:
    """Return (poses of a motion from ``start`` over ``first``, whether the motion closes).

    The motion ends before an inequality is violated that was satisfied at the start.
    """
    poses: list[Pose] = []
    if first is None:
        return poses, False
    closing = follower.freedom == 1 and follower.clock is None and not follower.relations.forms
    margins = follower.relations.margins(start)
    for reached in islice(follower.path(first, step), steps):
        pairs = zip(margins, follower.relations.margins(reached.pose), strict=False)
        if any(now < -STILL <= before for before, now in pairs):
            break
        poses.append(reached.pose)
        if closing and len(poses) > 2 and float(reached.direction @ first.direction) > STRAIGHT:
            back = follower.relations.same(start, reached.pose)
            if float(np.linalg.norm(follower.relations.between(reached.pose, back))) < 0.75 * step:
                return [*poses[:-1], back], True
    return poses, False
