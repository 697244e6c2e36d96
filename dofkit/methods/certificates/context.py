"""What one certificate is made of while it is made: a reading of the scene, its main point, rows and columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import sha256_of
from dofkit.checker.trees import CheckError
from dofkit.checker.verification import PARTS
from dofkit.methods.certificates.numerics import NoEstimateError, echelon
from dofkit.methods.certificates.points import FoundPoint, PointSearch
from dofkit.methods.certificates.scenery import MOST_ROWS, Scenery
from dofkit.methods.certificates.steps import accounted, rates_of
from dofkit.report import Report


def empty_certificate(name: str, document: Mapping[str, Any], readings: Mapping[str, str]) -> dict[str, Any]:
    """Return a certificate of a scene without parts, claims, or what is uncovered."""
    scene = {"name": name, "sha256": sha256_of(document), "document": dict(document)}
    scene |= {"readings": dict(readings)} if readings else {}
    lists: dict[str, list[dict[str, Any]]] = {part: [] for part in PARTS}
    return {"certificate": 1, "scene": scene, "cayley": [], **lists, "claims": [], "uncovered": []}


Told = dict[str, Any]


@dataclass
class Standing:
    """A point with independent rows in columns; ``dependent`` are the other rows, ``accounted`` where steps say so."""

    point: FoundPoint
    rows: list[str]
    columns: list[str]
    dependent: list[str]
    accounted: bool = True


@dataclass
class Context:
    """The context of a certificate: a report, a reading of its scene, the main point, and rows independent there."""

    report: Report
    scenery: Scenery

    @property
    def problem(self) -> Problem:
        """The reading."""
        return self.scenery.problem

    def add_point(self, point: FoundPoint) -> str:
        """The id of a point, written into the certificate where it is new."""
        functions = {"functions": self.scenery.functions} if self.scenery.functions else {}
        point.name = point.name or self.scenery.entry_id("points", point.entry() | functions)
        return point.name

    def minor(self, standing: Standing) -> str:
        """Return the id of the minor of the rows and columns."""
        entry = {"at": self.add_point(standing.point), "rows": standing.rows, "columns": standing.columns}
        return self.scenery.entry_id("minors", entry)

    @property
    def small(self) -> bool:
        """Whether numbers are worked with at all."""
        return len(self.problem.relations) <= MOST_ROWS and len(self.problem.coordinates) <= MOST_ROWS

    @cached_property
    def search(self) -> PointSearch:
        """The search for points."""
        return PointSearch(self.scenery, self.report.witness)

    @cached_property
    def nonlinear(self) -> bool:
        """Whether a velocity relation is not linear."""
        return not all(map(self.scenery.linear, self.scenery.equations))

    @cached_property
    def at_reference(self) -> bool:
        """Whether the main point is the scene's own configuration."""
        return self._reference is not None

    @cached_property
    def _reference(self) -> FoundPoint | None:
        return self.search.reference() if self.small and not self.nonlinear else None

    @cached_property
    def about(self) -> str:
        """Of which points the main point speaks."""
        return "reference" if self.at_reference else "component"

    @cached_property
    def point(self) -> FoundPoint | None:
        """The main point, written into the certificate when it is first asked for."""
        if not self.small:
            return None
        place = self._reference or self._searched()
        if place is not None:
            self.add_point(place)
        return place

    def _searched(self) -> FoundPoint | None:
        resting = [*self.scenery.finite], [*self.problem.coordinates, *self.problem.world.generic]
        names, unknowns = states_of(self) if self.nonlinear else resting
        finite = not self.scenery.moving and self.report.dof is not None
        rank = len(self.problem.coordinates) - (self.report.dof or 0) if finite else len(names)
        points: list[FoundPoint] = []
        for point in self.search.points(names, unknowns):
            if point.rank == rank and self._is_fit(point):
                return point
            points.append(point)
        return max(points, key=lambda point: point.rank == rank, default=None)

    def _is_fit(self, point: FoundPoint) -> bool:
        """Whether the checker accepts a point for claims, where velocities and integrals are as the report tells."""
        integrals = (entry.integral or "" for entry in self.report.constraints)
        texts = (text.rpartition("=")[0].strip() for text in integrals if text.count("=") == 1)
        free = self.report.velocity_dof if self.scenery.moving else None
        with suppress(CheckError, NoEstimateError):
            self.scenery.evidence.is_about("here", self.scenery.evidence.point(self.add_point(point)))
            for text in texts:
                point.estimates.value(self.scenery.chosen(self.scenery.evidence.text(text)))
            standing = self.standing_of(self.scenery.equations, point=point)
            return free in (None, standing and len(self.problem.coordinates) - len(standing.rows))
        return False

    def standing_of(
        self, names: Sequence[str], columns: Sequence[str] | None = None, point: FoundPoint | None = None
    ) -> Standing | None:
        """Return which rows of ``names`` are independent at ``point`` (default: main) in ``columns``, or None."""
        point = point or self.point
        if point is None:
            return None
        try:
            matrix = [self.row(name, point) for name in names]
            if columns is not None:
                matrix = [{q: value for q, value in row.items() if q in columns} for row in matrix]
        except (NoEstimateError, CheckError):
            return None
        pivots = echelon(matrix)
        rows = [names[p.row] for p in pivots]
        dependent = [name for name in names if name not in rows]
        return Standing(point, rows, [p.column for p in pivots], dependent)

    def row(self, name: str, point: FoundPoint) -> dict[str, float]:
        """The entries of a row in floats: by coordinates, or by their velocities."""
        dot = "" if self.scenery.evidence.relation(name).kind == "finite" else "dot"
        gradient = point.estimates.gradient(self.scenery.tree(name))
        return {q: gradient[q + dot] for q in self.problem.coordinates if q + dot in gradient}

    @cached_property
    def standing(self) -> Standing | None:
        """The main point with rows among all equations, the finite ones first; the others by steps if possible."""
        return self.accounted(self.scenery.equations)

    @cached_property
    def finite_standing(self) -> Standing | None:
        """The same for the geometric equations."""
        return self.accounted(self.scenery.finite) if self.scenery.moving else self.standing

    def accounted(self, names: Sequence[str]) -> Standing | None:
        """Independent rows in an order of their own, the others by steps where that is possible."""
        standing = self.standing_of(names)
        if standing is not None and standing.dependent:
            place = standing.rows, standing.point
            standing.accounted = all(accounted(self.scenery, name, *place) for name in standing.dependent)
        return standing


def states_of(context: Context) -> tuple[list[str], list[str]]:
    """The relations that hold of a configuration with its velocities, and the symbols of both."""
    scenery, symbols = context.scenery, [*context.problem.coordinates, *context.problem.world.generic]
    follows = {name for name in scenery.moving if f"{scenery.label}{name} from others" in scenery.steps}
    names = [name for name in scenery.equations if scenery.linear(name) or name not in follows]
    rates = rates_of(scenery, scenery.finite)
    return [*names, *rates], [*symbols, *(f"{q}dot" for q in context.problem.coordinates)]
