"""From floats to a point that can be checked: short numbers, exact where they do, else a box for interval Newton."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from flint import arb, ctx, fmpq

from dofkit.checker.trees import PRECISION, CheckedPoint, Tree, derivative, evaluated, number
from dofkit.methods.certificates.elimination import Pivot, echelon, solved
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery, floats_of
from dofkit.methods.certificates.texts import number_text

NEAR, DIGITS, ITERATIONS = 1e-9, 42, 40
_ROUNDINGS = (4, 32, 1024, 2**20)


def residual(scenery: Scenery, floats: Mapping[str, float], names: Sequence[str]) -> float:
    """How far relations are from 0."""
    estimates = Estimates(floats)
    return max((abs(estimates.value(scenery.left(name))) for name in names), default=0.0)


class PointSettling:
    """Makes points of a scene that can be checked."""

    def __init__(self, scenery: Scenery) -> None:
        self.scenery, self.problem = scenery, scenery.problem

    def pivots(self, floats: Mapping[str, float], names: Sequence[str], unknowns: set[str]) -> list[Pivot]:
        """Independent rows, with columns that are easily solved for."""
        estimates = Estimates(floats)
        lefts = [self.scenery.left(name) for name in names]
        rows = [{n: s for n, s in estimates.gradient(left).items() if n in unknowns} for left in lefts]
        generic = set(self.problem.world.generic)

        def weight(place: int, column: str) -> float:
            if column in generic:
                return 1e6
            return 1e3 if derivative(lefts[place], column).head == "number" else 1.0

        return echelon(rows, weight).pivots

    def settled(self, found: dict[str, float], names: Sequence[str], unknowns: set[str]) -> FoundPoint | None:
        """All that is no column rounded to short numbers, the columns found again."""
        pivots = self.pivots(found, names, unknowns)
        rows, columns = [names[p.row] for p in pivots], [p.column for p in pivots]
        for most in _ROUNDINGS:
            exact = {name: Fraction(round(value * most), most) for name, value in found.items() if name not in columns}
            exact |= {name: value for name, value in self.scenery.parameters.items() if name in exact}
            if any(s != "real" and exact.get(n, 1) <= 0 for n, s in self.problem.world.signs.items()):
                continue
            floats = {**found, **floats_of(exact)}
            try:
                floats_again = self._square(floats, rows, columns)
            except NoEstimateError:
                continue
            if floats_again is None or residual(self.scenery, floats_again, names) > NEAR:
                continue
            if all(abs(floats_again[c] - found[c]) < 1 + abs(found[c]) for c in columns):
                return self._written(exact, floats_again, rows, columns)
        return None

    def _square(
        self, floats: Mapping[str, float], rows: Sequence[str], columns: Sequence[str]
    ) -> dict[str, float] | None:
        found, wanted = dict(floats), set(columns)
        for _ in range(ITERATIONS):
            estimates = Estimates(found)
            pairs = [estimates.value_and_gradient(self.scenery.left(name)) for name in rows]
            matrix = [{n: s for n, s in slope.items() if n in wanted} for _, slope in pairs]
            step = solved(matrix, [value for value, _ in pairs], columns)
            if step is None or any(abs(change) > 1e6 for change in step.values()):
                return None
            found |= {name: found[name] - change for name, change in step.items()}
            if max(map(abs, step.values()), default=0.0) < 1e-13:
                return found
        return None

    def _written(
        self, exact: Mapping[str, Fraction], floats: Mapping[str, float], rows: list[str], columns: list[str]
    ) -> FoundPoint | None:
        """The point with short numbers for the columns where these are exact, else as a box."""
        short = {name: Fraction(floats[name]).limit_denominator(2**21) for name in columns}
        if all(abs(float(short[name]) - floats[name]) < 1e-11 for name in columns):
            values = {**exact, **short}
            if self._holds(values, rows):
                texts = {name: number_text(value) for name, value in self._ordered(values).items()}
                return FoundPoint("P", texts, dict(floats), self.scenery.functions, rank=len(rows))
        texts = {name: number_text(value) for name, value in self._ordered(exact).items()}
        centre = self._refined(exact, floats, rows, columns)
        return FoundPoint("P", texts | centre, dict(floats), self.scenery.functions, rows, columns, len(rows))

    def _ordered(self, values: Mapping[str, Fraction]) -> dict[str, Fraction]:
        first = [name for name in self.scenery.parameters if name in values]
        return {name: values[name] for name in (*first, *(n for n in values if n not in first))}

    def _holds(self, values: Mapping[str, Fraction], names: Sequence[str]) -> bool:
        point = CheckedPoint("", {n: number(v) for n, v in values.items()}, {}, self.scenery.effort)
        return all(self.scenery.evidence.ring.vanishes(point.prepared(self.scenery.left(name))) for name in names)

    def _refined(
        self, exact: Mapping[str, Fraction], floats: Mapping[str, float], rows: list[str], columns: list[str]
    ) -> dict[str, str]:
        """Decimals of the columns, by Newton's method with a fixed matrix in balls."""
        estimates = Estimates(floats)
        wanted = set(columns)
        lefts: list[Tree] = [self.scenery.left(name) for name in rows]
        matrix = [{n: s for n, s in estimates.gradient(left).items() if n in wanted} for left in lefts]
        with ctx.workprec(PRECISION):
            balls = {n: arb(fmpq(v.numerator, v.denominator)) for n, v in exact.items()}
            balls |= {name: arb(floats[name]) for name in columns}
            balls["tdot"] = arb(1)
            for _ in range(6):
                values = [evaluated(left, balls, self.scenery.effort).mid() for left in lefts]
                size = max((abs(float(v)) for v in values), default=0.0)
                if size < 1e-60:
                    break
                scaled = solved(matrix, [float(v / size) for v in values], columns) or {}
                balls |= {name: (balls[name] - arb(scaled.get(name, 0.0)) * arb(size)).mid() for name in columns}
            return {name: balls[name].str(DIGITS, radius=False) for name in columns}
