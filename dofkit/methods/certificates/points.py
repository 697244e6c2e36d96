"""Points of a scene: its own configuration, or one that is searched for; exact, or a box for interval Newton."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any

from dofkit.checker.trees import ONE, CheckError, derivative, number, substituted
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError, Pivot, echelon, least_step
from dofkit.methods.certificates.scenery import Scenery, floats_of, number_text, text_of

#: The radius of every box.
RADIUS = "1e-9"


@dataclass
class FoundPoint:
    """A point: ``values`` as texts, ``floats`` to look with, ``rows`` and ``columns`` of its box, ``name`` if any."""

    values: dict[str, str]
    floats: dict[str, float]
    rows: list[str] = field(default_factory=list)
    columns: list[str] = field(default_factory=list)
    rank: int = 0
    name: str = ""

    @cached_property
    def estimates(self) -> Estimates:
        """Values in floats at the point, at rest where it has no velocities."""
        return Estimates({**{f"{q}dot": 0.0 for q in self.floats}, **self.floats})

    def entry(self) -> dict[str, Any]:
        """The point as a certificate writes it."""
        entry_of_point: dict[str, Any] = {"values": self.values}
        if self.columns:
            entry_of_point |= {"rows": self.rows, "columns": self.columns, "radius": RADIUS}
        return entry_of_point


# From floats to a point that can be checked: short numbers, exact where they do, else a box for interval Newton.

NEAR, ITERATIONS = 1e-9, 40
_ROUNDINGS = (4, 32, 1024, 2**20)


def residual(scenery: Scenery, floats: Mapping[str, float], names: Sequence[str]) -> float:
    """How far relations are from 0."""
    estimates = Estimates(floats)
    return max((abs(estimates.value(scenery.tree(name))) for name in names), default=0.0)


ATTEMPTS = 5
#: Of a hundred attempts for an inequality so many start afar, those after them near the origin.
AFAR = 12


class PointSearch:
    """Looks for points of a scene."""

    def __init__(self, scenery: Scenery, witness: Mapping[str, str] | None) -> None:
        self.scenery, self.problem = scenery, scenery.problem
        self.witness = {name: _fraction(text) for name, text in (witness or {}).items()}

    def reference(self) -> FoundPoint | None:
        """The scene's own configuration, where it meets the geometric equations."""
        if not self.problem.reference:
            return None
        chosen = self.scenery.parameters
        values = {name: number_text(value) for name, value in chosen.items()}
        floats = floats_of(chosen)
        try:
            for name, tree in self.problem.reference.items():
                values[name], floats[name] = text_of(tree), Estimates(floats).value(tree)
            if self.scenery.timed:
                values["t"], floats["t"] = "0", 0.0
            point = FoundPoint(values, floats)
            return point if residual(self.scenery, floats, self.scenery.finite) < NEAR else None
        except NoEstimateError:
            return None

    def points(
        self, names: Sequence[str], unknowns: Sequence[str], seed: int = 0, attempts: int = ATTEMPTS
    ) -> Iterator[FoundPoint]:
        """Points of the relations ``names``, the ``unknowns`` free: one for each start from which one is reached."""
        for attempt in range(seed, seed + attempts):
            with suppress(NoEstimateError, CheckError):
                start, generic = floats_of(self._start(attempt, unknowns)), self.problem.world.generic
                lengths = [name for name in names if not self.scenery.tree(name).symbols.isdisjoint(generic)]
                start = self.approached(start, lengths, set(generic).intersection(unknowns)) or start
                reached = self.approached(start, names, set(unknowns))
                point = self.settled(reached, names, set(unknowns)) if reached is not None else None
                if point is not None:
                    yield point

    def meeting(self, inequalities: Sequence[str], names: Sequence[str], unknowns: Sequence[str]) -> FoundPoint | None:
        """Return a point that satisfies the relations ``names`` and all inequalities strictly; None without success."""
        trees = [self.scenery.tree(name) for name in inequalities]
        for point in self.points(names, unknowns, 100, AFAR + 6):
            if all(self.scenery.estimated(tree, point.estimates) > NEAR for tree in trees):
                return point
        return None

    def touching(self, name: str) -> Iterator[FoundPoint]:
        """Points at which a relation is 0, an inequality too, whatever the others say."""
        checked = self.scenery.evidence.relation(name)
        names = [name] if checked.kind == "inequality" else self.scenery.evidence.finite
        return self.points(names, self.problem.coordinates, 50)

    def _start(self, attempt: int, unknowns: Sequence[str]) -> dict[str, Fraction]:
        drawn = random.Random(1000 + attempt)
        values = dict(self.scenery.parameters)
        if self.scenery.timed:
            values["t"] = Fraction(drawn.randint(1, 8), 4)
        for name in (*self.problem.coordinates, *self.problem.world.generic, *unknowns):
            if name not in values:
                values[name] = Fraction(drawn.choice([-1, 1]) * drawn.randint(3, 24), 8)
        if attempt == 0:
            placed = values.keys() - self.scenery.evidence.velocities
            values |= {name: value for name, value in self.witness.items() if name in placed}
        elif attempt == 1:
            values |= {name: abs(values[name]) for name in self.problem.coordinates}
        elif attempt >= 100 and attempt % 100 >= AFAR:
            values |= {name: values[name] / 16 for name in self.problem.coordinates}
        return values | {tilt: Fraction(1) for _, tilt, _ in self.problem.turns if values.get(tilt) == 0}

    def approached(
        self, start: Mapping[str, float], names: Sequence[str], unknowns: set[str]
    ) -> dict[str, float] | None:
        """Gauss and Newton's method from a start."""
        floats = dict(start)
        for _ in range(ITERATIONS):
            self.scenery.effort.spend(40 * len(names) * (1 + len(names)))
            estimates = Estimates(floats)
            pairs = [(estimates.value(tree), estimates.gradient(tree)) for tree in map(self.scenery.tree, names)]
            if max((abs(value) for value, _ in pairs), default=0.0) < 1e-13:
                return floats
            rows = [{n: s for n, s in slope.items() if n in unknowns} for _, slope in pairs]
            step = least_step(rows, [value for value, _ in pairs])
            size = max(map(abs, step.values()), default=0.0)
            scale = 1.0 if size < 1 else 1.0 / size
            floats |= {name: floats[name] - scale * change for name, change in step.items()}
            if size < 1e-14:
                break
        return floats if residual(self.scenery, floats, names) < NEAR else None

    def pivots(self, floats: Mapping[str, float], names: Sequence[str], unknowns: set[str]) -> list[Pivot]:
        """Independent rows, with columns that are easily solved for."""
        estimates = Estimates(floats)
        lefts = [self.scenery.tree(name) for name in names]
        rows = [{n: s for n, s in estimates.gradient(tree).items() if n in unknowns} for tree in lefts]
        generic = set(self.problem.world.generic)

        def weight(place: int, column: str) -> float:
            if column in generic:
                return 1e6
            return 1e3 if derivative(lefts[place], column).head == "number" else 1.0

        return echelon(rows, weight)

    def settled(self, reached: dict[str, float], names: Sequence[str], unknowns: set[str]) -> FoundPoint | None:
        """All that is no column rounded to short numbers, the columns found again; or all, where that is exact."""
        chosen = self.scenery.parameters
        near = {name: Fraction(round(value * 32), 32) for name, value in reached.items()} | chosen
        if all(abs(near[name] - value) < 1e-4 for name, value in reached.items()) and self._holds(near, names):
            texts, floats = {name: number_text(near[name]) for name in reached}, floats_of(near)
            return FoundPoint(texts, floats, rank=len(self.pivots(floats, names, unknowns)))
        pivots = self.pivots(reached, names, unknowns)
        rows, columns = [names[p.row] for p in pivots], [p.column for p in pivots]
        for most in _ROUNDINGS:
            short = {name: Fraction(round(value * most), most) for name, value in reached.items()}
            exact = {name: value for name, value in (short | chosen).items() if name in short and name not in columns}
            floats = {**reached, **floats_of(exact)}
            try:
                floats_again = self.approached(floats, rows, set(columns))
            except NoEstimateError:
                continue
            if floats_again is None or residual(self.scenery, floats_again, names) > NEAR:
                continue
            if all(abs(floats_again[c] - reached[c]) < 1 + abs(reached[c]) for c in columns):
                return self._written(exact, floats_again, rows, columns)
        return None

    def _written(
        self, exact: Mapping[str, Fraction], floats: Mapping[str, float], rows: list[str], columns: list[str]
    ) -> FoundPoint | None:
        """The point with short numbers for the columns where these are exact, else as a box."""
        short = {name: Fraction(floats[name]).limit_denominator(2**21) for name in columns}
        if all(abs(float(short[name]) - floats[name]) < 1e-11 for name in columns):
            values = {**exact, **short}
            if self._holds(values, rows):
                texts = {name: number_text(value) for name, value in values.items()}
                return FoundPoint(texts, dict(floats), rank=len(rows))
        texts = {name: number_text(value) for name, value in exact.items()}
        centre = {name: number_text(Fraction(repr(floats[name]))) for name in columns}
        return FoundPoint(texts | centre, dict(floats), rows, columns, len(rows))

    def _holds(self, values: Mapping[str, Fraction], names: Sequence[str]) -> bool:
        """Whether the checker can show that relations are exactly 0 at rational values."""
        put = {name: number(value) for name, value in values.items()} | {"tdot": ONE}
        with suppress(CheckError):
            return all(self.scenery.evidence.ring.vanishes(substituted(self.scenery.tree(name), put)) for name in names)
        return False


def _fraction(text: str) -> Fraction:
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        return Fraction(0)
