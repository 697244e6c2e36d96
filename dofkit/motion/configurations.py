"""Samples of a motion: configurations along it, for pictures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import accumulate

import numpy as np

from dofkit.base.deadline import DEFAULT_SECONDS, OutOfTimeError, limited
from dofkit.base.errors import DofkitError
from dofkit.base.wording import guess, no_such
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import prepared
from dofkit.exact.points.balls import precise_for
from dofkit.exact.points.real_search import RealSearch
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.motion.continuation import STILL, BothDirections, Follower, trail
from dofkit.motion.poses import Array, Pose, PoseRelations, number
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.scene.lowering import lower
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.system import System

#: Random starts of the search for a configuration if there is no reference.
STARTS = 24


class NoMotionError(DofkitError):
    """No motion can be sampled: nothing moves, or the scene is inconsistent or undecided; the message says which."""


def configurations(
    scene: SceneLike | System,
    steps: int = 100,
    step: float = 0.05,
    *,
    along: str | None = None,
    values: Mapping[str, float] | None = None,
) -> list[dict[str, float]]:
    """Return configurations along a finite motion of a scene, in order.

    The motion begins at the reference configuration, or at a generic one if there is none, and continues as straight as
    the constraints allow until it closes, ends, or violates an inequality that was satisfied at the start.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name, a mapping or a System.
    steps
        The number of steps forward, and backward.
    step
        The arc length sqrt(sum dq^2) of a step, with positions divided by the scene's size and angles in radians; where
        time occurs, the step in ``t``.
    along
        With several freedoms: the coordinate whose direction the motion starts in; by default the first that can move.
    values
        Numbers for parameters without a value (otherwise chosen at random), and for coordinates, near which the first
        configuration is sought, and for ``t`` (otherwise 0).

    Returns
    -------
    list of dict
        At most ``2 steps + 1`` mappings from the names of coordinates (and ``t``) to numbers: lengths in the scene's
        units, angles in radians. Each satisfies the holonomic equations g, hidden ones included, to 1e-12 |grad g|
        times the size; a differential constraint is satisfied at the midpoint of every chord, at most 1/100 long.

    Raises
    ------
    NoMotionError
        If nothing can move, the scene is inconsistent, or its motion is undecided.
    SceneError, ArgumentError
        As for `load`.

    Examples
    --------
    >>> import dofkit
    >>> circle = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 25"], "configuration": {"x": 3, "y": -4}}
    >>> path = dofkit.configurations(circle, steps=2, step=0.5)
    >>> [round(q["x"] ** 2 + q["y"] ** 2, 9) for q in path]
    [25.0, 25.0, 25.0, 25.0, 25.0]
    """
    if steps < 0 or not step > 0:
        raise NoMotionError("steps is at least 0, and the length of a step is more than 0")
    source = scene_or_system(scene)
    system = source if isinstance(source, System) else lower(source)
    try:
        with sampling(system):
            return MotionSampler(system, dict(values or {})).configurations(steps, step, along)
    except OutOfTimeError as error:
        raise NoMotionError(str(error)) from None


@contextmanager
def sampling(system: System) -> Iterator[None]:
    """Within the block, limit the time and set the precision that the system's numbers need. Raises OutOfTimeError."""
    with limited(DEFAULT_SECONDS), precise_for(system.longest):
        yield


class MotionSampler:
    """A system with its relations in floating point, a `Follower` of motions, and the first pose."""

    def __init__(self, system: System, numbers: Mapping[str, float]) -> None:
        reduced, setting = prepared(system)
        outcome = solve(reduced, setting)
        self.system, self.setting, self.names = system, setting, [c.name for c in system.coordinates]
        self.numbers = _known_symbols(system, numbers)
        self.relations = _relations(system, outcome, setting, _limits(reduced, outcome))
        self.relations.constants |= {s: v for s, v in self.numbers.items() if s.args[0] == "parameter"}
        self.follower = Follower(self.relations, _freedom(outcome, self.relations.timed))
        self.start = self._first()

    def _first(self) -> Pose:
        """Return the reference pose with the given numbers, else a generic pose. Raises NoMotionError."""
        places = [ex.coordinate(c) for c in self.names]
        search = RealSearch(
            self.relations.ring, self.relations.finite, [*places, *self.setting.generic], self.setting.positive
        )
        if self.system.reference is not None:
            parameters = {p: v for p, v in search.start(0, self.numbers).items() if p.args[0] == "parameter"}
            parameters |= {p: self.numbers.get(p, 1.0) for e in self.system.reference.values() for p in e.symbols}
            self.relations.constants |= parameters
            placed = {s: number(e, parameters) for s, e in self.system.reference.items()}
            first_pose = self.follower.onto(self.relations.pose({**placed, **self.numbers}))
            if first_pose is None:
                raise NoMotionError("Newton's method finds no exact solution near the reference configuration")
            return first_pose
        near = {s: number(e) for s, e in self.setting.pose.items() if not e.symbols} | self.numbers
        for seed in range(STARTS):
            symbols = search.start(seed, {ex.TIME: 0.0, **near})
            if search.descend(symbols, seed) is None or any(symbols.get(p, 1.0) <= 0 for p in self.setting.positive):
                continue
            self.relations.constants |= {s: v for s, v in symbols.items() if s.args[0] == "parameter"}
            first_pose = self.follower.onto(self.relations.pose(near | symbols))
            if first_pose is not None and len(self.follower.null_space(first_pose)) == self.follower.freedom:
                return first_pose
        raise NoMotionError("no regular configuration was found that satisfies the constraints")

    def configurations(self, steps: int, step: float, along: str | None = None) -> list[dict[str, float]]:
        """Return the configurations in order: backward, the first, forward. Raises NoMotionError."""
        if along is not None and along not in self.names:
            raise NoMotionError(no_such(along, self.names, "coordinate"))
        target = None if along is None else self.relations.axis(along, self.start)
        both_directions = self.follower.begin(self.start, target, step)
        if target is None and not any(both_directions):
            raise NoMotionError("no motion was found that leaves the first configuration")
        if target is not None and not any(w and abs(float(w.direction @ target)) > STILL for w in both_directions):
            raise NoMotionError(f"'{along}' cannot move at the first configuration")
        return self._followed(self.follower, both_directions, steps, step)

    def free_motion(
        self, rates: Mapping[Expr, float], held: Sequence[Expr], steps: int, step: float
    ) -> list[dict[str, float]]:
        """Return configurations along a motion that begins with some velocities, while the ``held`` symbols rest."""
        rows = np.array([self.relations.step_of({symbol: 1.0}) for symbol in held])
        follower = Follower(self.relations, 1, rows.reshape(-1, self.relations.columns))
        both_directions = follower.begin(self.start, self.relations.step_of(rates), step)
        return self._followed(follower, both_directions, steps, step)

    def branches(self, steps: int, step: float) -> Iterator[tuple[Array, list[dict[str, float]]]]:
        """Yield (direction, configurations) for each motion that was found to leave a singular first configuration."""
        for both_directions in self.follower.branches(self.start, step):
            direction = next(reached.direction for reached in both_directions if reached)
            yield direction, self._followed(self.follower, both_directions, steps, step)

    def _followed(
        self, follower: Follower, both_directions: BothDirections, steps: int, step: float
    ) -> list[dict[str, float]]:
        ahead, back = both_directions
        forward, closed = trail(follower, self.start, ahead, steps, step)
        backward = trail(follower, self.start, back, steps, step)[0] if not closed else []
        if steps and not forward and not backward:
            raise NoMotionError("no motion was followed that leaves the first configuration")
        return [*self.values_along([self.start, *backward])[:0:-1], *self.values_along([self.start, *forward])]

    def values_along(self, poses: Iterable[Pose]) -> list[dict[str, float]]:
        """Return the `values` at poses in order, with Euler angles near those of the previous pose."""
        return list(accumulate(poses, lambda last, pose: self.values(pose, last), initial=dict[str, float]()))[1:]

    def values(self, pose: Pose, last: Mapping[str, float]) -> dict[str, float]:
        """Return {name: value} of coordinates (Euler angles near ``last``), t and all but internal parameters."""
        coordinates = self.relations.coordinate_values(pose, last)
        constants = {str(s.args[1]): v for s, v in self.relations.constants.items() if s.args[1][0] != "_"}
        timed = {"t": coordinates["t"]} if self.relations.timed else {}
        return {**{n: coordinates[n] for n in self.names}, **timed, **constants}


def _known_symbols(system: System, numbers: Mapping[str, float]) -> dict[Expr, float]:
    """Return {symbol: number} for parameters, coordinates and t. Raises NoMotionError for other names."""
    places = {c.name for c in system.coordinates}
    symbols = {n: ex.parameter(n) for n in (*system.parameters, *system.generic)} | {"t": ex.TIME}
    symbols |= {n: ex.coordinate(n) for n in places}
    wrong = sorted(set(numbers) - set(symbols))
    if wrong:
        message = f"'{wrong[0]}' is neither a coordinate nor a parameter without a value"
        raise NoMotionError(message + guess(wrong[0], set(symbols)))
    return {symbols[n]: float(v) for n, v in numbers.items()}


def _limits(reduced: Sequence[Reduced], outcome: Outcome) -> list[Expr]:
    """Return expressions that must stay >= 0: inequalities of coordinates, and conditions of the relations."""
    limits = [q.expr for r in reduced for q in r.inequalities]
    pieces = [p for row in outcome.rows if isinstance(p := row.piece, DomainCondition)]
    limits += [p.expr for p in pieces if p.sense != "!="]
    return [e for e in limits if all(s.args[0] in ("coordinate", "time", "parameter") for s in e.symbols)]


def _relations(system: System, outcome: Outcome, setting: Setting, limits: Sequence[Expr]) -> PoseRelations:
    """Return the relations that a motion satisfies. Raises NoMotionError if it cannot be followed."""
    if any("call" in r.expr.functions for c in system.constraints for r in c.relations):
        raise NoMotionError(f"'{next(iter(system.functions))}' is a function without a formula")
    if outcome.consistent is False:
        raise NoMotionError("nothing satisfies the constraints, or nothing through an interval of time")
    if outcome.consistent is None or outcome.velocity_dof is None:
        why = [r for a in outcome.answers for r in a.reasons]
        raise NoMotionError("; ".join(["whether and how it moves is undecided", *why]))
    pieces = [row.piece for row in outcome.rows]
    if any(isinstance(p, Nonlinear) for p in pieces):
        raise NoMotionError("motions under relations that are nonlinear in the velocities are not followed")
    finite = [*(p.expr for p in pieces if isinstance(p, Finite)), *(g for a in outcome.answers for g in a.hidden)]
    forms = [p for p in pieces if isinstance(p, Pfaffian)]
    return PoseRelations(system, finite, forms, setting.positive, limits)


def _freedom(outcome: Outcome, timed: bool) -> int:
    """Return the dimension of the admissible directions, which include time if that occurs. Raises if it is 0."""
    dimension = (outcome.velocity_dof or 0) + timed
    if not dimension:
        raise NoMotionError("nothing moves: the scene has no freedom of velocity")
    return dimension
