"""Points: the scene's own configuration, or one that is looked for; exact, or a box for interval Newton."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.elimination import least_step
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery, floats_of
from dofkit.methods.certificates.settling import ITERATIONS, NEAR, PointSettling, residual
from dofkit.methods.certificates.texts import number_text, text_of

ATTEMPTS = 5
#: Of a hundred attempts for an inequality so many start afar, those after them near the origin.
AFAR = 12


class PointSearch:
    """Looks for points of a scene."""

    def __init__(self, scenery: Scenery, witness: Mapping[str, str] | None) -> None:
        self.scenery, self.problem = scenery, scenery.problem
        self.settling = PointSettling(scenery)
        self.witness = {name: _fraction(text) for name, text in (witness or {}).items()}

    def reference(self) -> FoundPoint | None:
        """The scene's own configuration, where it meets the finite relations."""
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
            point = FoundPoint("P", values, floats, self.scenery.functions)
            return point if residual(self.scenery, floats, self.scenery.evidence.finite) < NEAR else None
        except NoEstimateError:
            return None

    def somewhere(
        self, names: Sequence[str], unknowns: Sequence[str], seed: int = 0, rank: int | None = None
    ) -> FoundPoint | None:
        """A point of the relations ``names``, the ``unknowns`` free; best where so many rows are independent."""
        wanted = len(names) if rank is None else rank
        best: FoundPoint | None = None
        for attempt in range(seed, seed + ATTEMPTS):
            try:
                start = self._start(attempt, unknowns)
                found = self.approached(start, names, set(unknowns))
                point = self.settling.settled(found, names, set(unknowns)) if found is not None else None
            except (NoEstimateError, CheckError):
                continue
            if point is not None and (best is None or point.rank == wanted):
                best = point
                if point.rank == wanted:
                    break
        if best is not None:
            best.name = "P" if seed == 0 else f"P{seed}"
        return best

    def meeting(self, name: str, seed: int = 100) -> FoundPoint | None:
        """A point at which an inequality holds, and the finite relations."""
        finite = self.scenery.evidence.finite
        for attempt in range(seed, seed + AFAR + 6):
            point = self.somewhere(finite, self.problem.coordinates, attempt)
            if point is None:
                return None
            if self._is_positive(point, name):
                point.name = f"P{attempt} {name}"
                return point
        return None

    def open_points(self, seed: int = 200) -> Iterator[FoundPoint]:
        """Points at which the finite relations and all inequalities hold."""
        names = [one.name for one in self.problem.relations if one.kind == "inequality"]
        for attempt in range(seed, seed + AFAR + 6):
            point = self.somewhere(self.scenery.evidence.finite, self.problem.coordinates, attempt)
            if point is not None and all(self._is_positive(point, name) for name in names):
                point.name = f"P{attempt}"
                yield point
                return

    def _is_positive(self, point: FoundPoint, name: str) -> bool:
        try:
            return Estimates(point.floats).value(self.scenery.left(name)) > NEAR
        except NoEstimateError:
            return False

    def touching(self, name: str, seed: int) -> FoundPoint | None:
        """A point at which a relation is 0, an inequality too, whatever the others say."""
        one = self.scenery.evidence.relation(name)
        names = [name] if one.kind == "inequality" else self.scenery.evidence.finite
        point = self.somewhere(names, self.problem.coordinates, seed)
        if point is not None:
            point.name = f"P{seed} {name}"
        return point

    def _start(self, attempt: int, unknowns: Sequence[str]) -> dict[str, Fraction]:
        drawn = random.Random(1000 + attempt)
        found = dict(self.scenery.parameters)
        if attempt == 0:
            found |= {name: self.witness[name].limit_denominator(64) for name in found if name in self.witness}
        if self.scenery.timed:
            known = attempt == 0 and "t" in self.witness
            found["t"] = self.witness["t"].limit_denominator(64) if known else Fraction(drawn.randint(1, 8), 8)
        for name in (*self.problem.coordinates, *self.problem.world.generic, *unknowns):
            if name not in found:
                found[name] = Fraction(drawn.choice([-1, 1]) * drawn.randint(3, 24), 8)
        if attempt == 0:
            found |= {name: self.witness[name] for name in self.problem.coordinates if name in self.witness}
        elif attempt == 1:
            found |= {name: abs(found[name]) for name in self.problem.coordinates}
        elif attempt >= 100 and attempt % 100 >= AFAR:
            found |= {name: found[name] / 16 for name in self.problem.coordinates}
        return found | {tilt: Fraction(1) for _, tilt, _ in self.problem.turns if found.get(tilt) == 0}

    def approached(
        self, start: Mapping[str, Fraction], names: Sequence[str], unknowns: set[str]
    ) -> dict[str, float] | None:
        """Gauss and Newton's method from a start."""
        floats = self._with_generic(floats_of(start), names)
        for _ in range(ITERATIONS):
            self.scenery.effort.spend(40 * len(names) * (1 + len(names)))
            estimates = Estimates(floats)
            pairs = [estimates.value_and_gradient(self.scenery.left(name)) for name in names]
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

    def _with_generic(self, floats: dict[str, float], names: Sequence[str]) -> dict[str, float]:
        """Generic lengths as they are at the start."""
        generic = set(self.problem.world.generic)
        estimates = Estimates(dict(floats))
        for name in names if generic else ():
            value, slope = estimates.value_and_gradient(self.scenery.left(name))
            own = [symbol for symbol in slope if symbol in generic]
            if len(own) == 1:
                floats[own[0]] -= value / slope[own[0]]
        return floats


def _fraction(text: str) -> Fraction:
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        return Fraction(0)
