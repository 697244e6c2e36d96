"""Closed loops of two free coordinates: the displacement of the other coordinates, and its prediction by the bracket.

The admissible directions are spanned by fields X_k, each of which moves one chosen column (coordinate) with speed 1 and
no other chosen column. Around a small counterclockwise loop of area A of the columns i and j, the other columns are
displaced by A [X_i, X_j], evaluated at the centre of the loop, up to terms of third order. Integrable forms cause no
displacement, because their integral keeps its value.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from dofkit.base.deadline import OutOfTimeError
from dofkit.motion.configurations import MotionSampler, NoMotionError, sampling
from dofkit.motion.poses import FAULTS, Array, Pose
from dofkit.system import System

#: Corners of a loop, the most loops that are followed, and the steps of outer and inner difference quotients.
CORNERS, MOST_LOOPS, OUTER, INNER = 72, 2, 1e-3, 1e-4
#: The least velocity of a column that can be chosen to be moved.
LEAST = 1e-4
Field = Callable[[Array], Array]
ONE_FIELD = "a loop needs two free velocities: with one, every motion runs back along itself"
STOPS = "The loop of {} and {} with radius {} was not followed: {}."
NOT_APART = "at a configuration the free coordinates cannot be moved one by one"


@dataclass(frozen=True)
class Loop:
    """A circular loop of two ``coordinates`` with radius ``size``, and its effect on the other coordinates.

    ``configurations`` along the loop; ``displacement`` of the others at its end, and its ``prediction`` by the bracket.
    Lengths are in the scene's units; rotations of a spatial body are the components of a rotation vector, named
    ``BODY about x`` and so on.
    """

    coordinates: tuple[str, str]
    size: float
    configurations: tuple[dict[str, float], ...]
    displacement: Mapping[str, float]
    prediction: Mapping[str, float]


class LoopSampler:
    """The loops of a system about its first configuration. Raises NoMotionError if it has none."""

    def __init__(self, system: System, numbers: Mapping[str, float]) -> None:
        with sampling(system):
            self.sampler = MotionSampler(system, numbers)
        self.relations, self.follower, self.start = self.sampler.relations, self.sampler.follower, self.sampler.start
        if self.relations.timed:
            raise NoMotionError("a loop needs constraints without time")
        basis = self.follower.null_space(self.start)
        if len(basis) != self.follower.freedom:
            raise NoMotionError("a loop needs a regular configuration")
        plain, columns = len(self.relations.plain), range(self.relations.columns)
        order = [*by_size(basis, columns[:plain]), *by_size(basis, columns[plain:])]
        self.chosen = sorted(by_pivots(basis, order)[1])
        bodies = [f"{r.body} about {letter}" for r in self.relations.rotations for letter in "xyz"]
        self.columns, self.stopped = [*self.relations.names, *bodies], list[str]()
        pairs = combinations([c for c in self.chosen if c < len(self.relations.plain)], 2)
        try:
            size = {pair: float(np.linalg.norm(self.bracket(pair, self.start))) for pair in pairs}
        except FAULTS:
            raise NoMotionError(f"a loop needs regular configurations: {NOT_APART}") from None
        self.pairs = sorted(size, key=lambda pair: -round(size[pair], 6))[:MOST_LOOPS]
        if not self.pairs:
            raise NoMotionError(ONE_FIELD)

    def fields(self, pose: Pose) -> Array:
        """Return the fields X_k at a pose, as rows. Raises LinAlgError as `fields_of_pivots`."""
        return fields_of_pivots(self.follower.null_space(pose), self.chosen)

    def loops(self, size: float) -> list[Loop]:
        """Return the loops of radius ``size`` that can be followed; ``stopped`` gets the reasons for others."""
        loops = []
        with sampling(self.sampler.system):
            for pair in self.pairs:
                try:
                    loops.append(self._loop(pair, size))
                except (*FAULTS, OutOfTimeError) as error:
                    reason = error if isinstance(error, OutOfTimeError) else NOT_APART
                    self.stopped.append(STOPS.format(*(self.columns[column] for column in pair), size, reason))
        return loops

    def _loop(self, pair: tuple[int, int], size: float) -> Loop:
        angles = 2 * np.pi * np.arange(CORNERS + 1) / CORNERS
        poses = self._along(pair, size * np.column_stack([np.sin(angles), 1 - np.cos(angles)]))
        centre = self._along(pair, size * np.column_stack([np.zeros(CORNERS), np.linspace(0, 1, CORNERS)]))
        area = CORNERS / 2 * np.sin(2 * np.pi / CORNERS) * size**2
        configurations = self.sampler.values_along(poses)
        names = (self.columns[pair[0]], self.columns[pair[1]])
        displacement = self._named(self.relations.between(self.start, poses[-1]))
        prediction = self._named(area * self.bracket(pair, centre[-1]))
        return Loop(names, size, tuple(configurations), displacement, prediction)

    def _along(self, pair: tuple[int, int], corners: Array) -> list[Pose]:
        """Return the poses along a polygon of two coordinates. Raises one of `FAULTS` if it cannot be followed."""
        along = np.eye(self.relations.columns)[self.chosen]
        first, second = (self.chosen.index(column) for column in pair)
        poses = [self.start]
        for step in np.diff(corners, axis=0):
            rates = np.zeros(len(self.chosen))
            rates[first], rates[second] = step
            pose = self.follower.stepped(poses[-1], rates @ self.fields(poses[-1]), along)
            if pose is None:
                raise np.linalg.LinAlgError(NOT_APART)
            poses.append(pose)
        return poses

    def _named(self, step: Array) -> dict[str, float]:
        """Return {column: component of ``step``} for all columns but the chosen coordinates, in the scene's units."""
        plain = len(self.relations.plain)
        units = np.concatenate([self.relations.scales, np.ones(self.relations.columns - plain)])
        others = [c for c in range(len(units)) if c >= plain or c not in self.chosen]
        return {self.columns[c]: float(units[c] * step[c]) for c in others}

    def bracket(self, pair: tuple[int, int], pose: Pose) -> Array:
        """Return the bracket of the fields of two columns at ``pose``, in the coordinates of steps from the pose."""

        def field(number: int, at: Array) -> Array:
            moved = self.relations.moved(pose, at)
            vector = INNER * self.fields(moved)[number]
            ends = (self.relations.between(pose, self.relations.moved(moved, s * vector)) for s in (1, -1))
            return np.asarray(np.subtract(*ends) / (2 * INNER))

        first, second = (partial(field, self.chosen.index(column)) for column in pair)
        return bracket(first, second, OUTER)(np.zeros(self.relations.columns))


def by_pivots(basis: Array, order: Sequence[int]) -> tuple[Array, list[int]]:
    """Return (reduced basis, pivots): each row alone moves its pivot, the first possible columns in ``order``."""
    rows = basis.copy()
    pivots: list[int] = []
    for column in order:
        k = len(pivots)
        if k == len(rows):
            break
        best = k + int(np.argmax(np.abs(rows[k:, column])))
        if abs(rows[best, column]) < LEAST:
            continue
        rows[[k, best]] = rows[[best, k]]
        rows[k] /= rows[k, column]
        factors = rows[:, column].copy()
        factors[k] = 0.0
        rows -= np.outer(factors, rows[k])
        pivots.append(column)
    return rows, pivots


def fields_of_pivots(basis: Array, pivots: Sequence[int]) -> Array:
    """Return the basis reduced so that each row moves one of the pivots, at unit speed, and no other pivot.

    Raises LinAlgError if there is no such basis, because there are more or fewer rows or a pivot cannot move alone.
    """
    fields, moved = by_pivots(basis, pivots)
    if len(basis) != len(pivots) or moved != list(pivots):
        raise np.linalg.LinAlgError(NOT_APART)
    return fields


def by_size(basis: Array, columns: Sequence[int]) -> list[int]:
    """Return ``columns`` sorted by their norm in the basis, the largest first."""
    sizes = np.round(np.linalg.norm(basis, axis=0), 6)
    return sorted(columns, key=lambda column: -sizes[column])


def bracket(x: Field, y: Field, step: float) -> Field:
    """Return the field [X, Y] = DY X - DX Y, by difference quotients."""

    def along(f: Field, q: Array, v: Array) -> Array:
        return np.asarray((f(q + step * v) - f(q - step * v)) / (2 * step))

    return lambda q: along(y, q, x(q)) - along(x, q, y(q))
