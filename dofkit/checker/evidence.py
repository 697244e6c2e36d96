"""What a certificate puts forward, looked at in the checker's reading of the scene: texts, steps, points, minors."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Any, NamedTuple

from dofkit.checker.balls import determinant, evaluated, excludes_zero, krawczyk
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.points import CheckedPoint, in_turn
from dofkit.checker.relations import FAULTS, CheckedRelations, told
from dofkit.checker.steps import DerivedRelation, total_derivative
from dofkit.checker.texts import has_value_everywhere
from dofkit.checker.trees import symbol

__all__ = ["FAULTS", "CheckedEvidence", "CheckedMinor", "has_own_symbol", "own_symbols", "told"]

LARGEST_MINOR = 250


class CheckedMinor(NamedTuple):
    """A minor that is not 0 at a point: its rows hold there, follow from the relations, and are independent."""

    point: CheckedPoint
    rows: tuple[str, ...]
    columns: tuple[str, ...]


class CheckedEvidence(CheckedRelations):
    """The points and minors of a certificate, each looked at when it is used, and once."""

    @cached_property
    def points(self) -> dict[str, CheckedPoint]:
        """The points that were looked at."""
        return {}

    @cached_property
    def minors(self) -> dict[str, CheckedMinor]:
        """The minors that were looked at."""
        return {}

    @cached_property
    def held(self) -> dict[tuple[str, str], bool]:
        """Which relation holds at which point."""
        return {}

    def point(self, name: Any) -> CheckedPoint:
        """A point by its id: exact, or certified by interval Newton."""
        if name not in self.points:
            self.points[name] = self._point(self.named("points", name))
        return self.points[name]

    def _point(self, given: dict[str, Any]) -> CheckedPoint:
        columns, rows = given.get("columns", []), given.get("rows", [])
        allowed = {*self.variables, *self.velocities, *self.problem.parameters, *self.problem.generic} - {"tdot"}
        if not allowed.issuperset(given["values"]) or not set(columns) <= set(given["values"]):
            raise CheckError("a point gives values to what the scene does not have, or none to a column")
        if len(columns) != len(rows) or len(set(columns)) != len(columns) or len(set(rows)) != len(rows):
            raise CheckError("a box has as many rows as columns, each once")
        refuse(len(columns) > LARGEST_MINOR, "a box has too many columns")
        values = in_turn({name: self.text(text) for name, text in given["values"].items()})
        functions = {
            name: (tuple(f["arguments"]), self.text(f["text"], f["arguments"]))
            for name, f in given.get("functions", {}).items()
        }
        for name, (arguments, text) in functions.items():
            if len(set(arguments)) != self.problem.functions.get(name) or not symbols_in(text) <= set(arguments):
                raise CheckError(f"the choice for `{name}` is no function of its arguments")
        exact = {name: tree for name, tree in values.items() if name not in columns}
        point = CheckedPoint(given["id"], exact, functions, self.effort)
        if columns:
            equations = [point.prepared(self.relation(name).left) for name in rows]
            centre = [evaluated(values[name], {}, self.effort) for name in columns]
            radius = evaluated(self.text(given["radius"]), {}, self.effort)
            inverse = given.get("inverse")
            balls = [[evaluated(self.text(x), {}, self.effort) for x in row] for row in inverse] if inverse else None
            if any(len(row) != len(columns) for row in balls or ()) or not radius > 0:
                raise CheckError("the matrix or the radius of a box is none")
            point.balls = krawczyk(equations, columns, centre, radius.mid(), balls, self.effort)
            point.rows = frozenset(rows)
        self._check_signs(point)
        return point

    def _check_signs(self, point: CheckedPoint) -> None:
        for name, sign in self.problem.parameters.items():
            if point.has(name) and sign in ("positive", "nonzero"):
                ball = point.value(symbol(name))
                if not excludes_zero(ball) or (sign == "positive" and not ball > 0):
                    raise CheckError(f"the parameter `{name}` is declared {sign}")

    def holds(self, name: str, point: CheckedPoint) -> bool:
        """Whether a relation is 0 at a point, exactly."""
        one, key = self.relation(name), (name, point.name)
        if key not in self.held:
            near = bool(point.value(one.left).contains(0))
            known = near and (name in point.rows or self.ring.vanishes(point.prepared(one.left)))
            self.held[key] = one.leaf or known
        return self.held[key]

    def on_set(self, point: CheckedPoint, names: Iterable[str]) -> None:
        """`CheckError` unless the relations hold at a point; those of velocities are to be smooth there."""
        wanted = tuple(names)
        start = {*point.rows, *(n for n in wanted if self.relation(n).kind == "finite" and self.holds(n, point))}
        held = start if start.issuperset(wanted) else self.closure(start, point)
        for name in wanted:
            one = self.relation(name)
            if one.kind == "finite" and name not in held:
                raise CheckError(f"`{name}` is not shown to hold at the point `{point.name}`")
            point.value(one.left) if one.kind == "finite" else self._smooth(one, point)
        if any(not self.is_linear(name) for name in wanted):
            self._is_state(point, wanted)

    def _smooth(self, one: DerivedRelation, point: CheckedPoint) -> None:
        for name in sorted(self.velocities & symbols_in(one.left)):
            point.value(derivative(one.left, name))

    def _is_state(self, point: CheckedPoint, names: Iterable[str]) -> None:
        """A nonlinear relation speaks of a state: all velocity relations and all rates hold at its velocities."""
        for name in names:
            one = self.relation(name)
            left = one.left if one.kind == "velocity" else total_derivative(one.left, self.variables)
            exact = self.ring.vanishes(point.prepared(left))
            if not exact and not any(self.known[row].left == left for row in point.rows):
                raise CheckError(f"`{name}` is not shown to hold for the velocities of `{point.name}`")

    def minor(self, given: Any, allowed: Iterable[str] | None = None) -> CheckedMinor:
        """A minor: rows that follow from ``allowed`` (or all relations), and a determinant that is not 0."""
        if isinstance(given, str) and allowed is None:
            if given not in self.minors:
                self.minors[given] = self._minor(self.named("minors", given), None)
            return self.minors[given]
        return self._minor(self.named("minors", given) if isinstance(given, str) else given, allowed)

    def _minor(self, given: dict[str, Any], allowed: Iterable[str] | None) -> CheckedMinor:
        point, rows, columns = self.point(given["at"]), tuple(given["rows"]), tuple(given["columns"])
        if len(rows) != len(columns) or len(rows) > LARGEST_MINOR or len({*rows}) + len({*columns}) != 2 * len(rows):
            raise CheckError("a minor has as many rows as columns, each once")
        refuse(not set(columns) <= set(self.problem.coordinates), "a column of a minor is no coordinate")
        start = (*self.finite, *self.moving) if allowed is None else tuple(allowed)
        followed = set(rows) if set(rows) <= set(start) else self.closure(start, point)
        for row in rows:
            if row not in followed:
                raise CheckError(f"the row `{row}` is not shown to follow from the relations near `{point.name}`")
        self.on_set(point, [row for row in rows if not self.relation(row).leaf])
        matrix = [[point.value(self.slope(row, column)) for column in columns] for row in rows]
        refuse(not excludes_zero(determinant(matrix, self.effort)), "the minor may be 0")
        return CheckedMinor(point, rows, columns)

    def covers(self, minor: CheckedMinor, wanted: Iterable[str]) -> None:
        """`CheckError` unless relations hold at the point, and near it wherever the rows of a minor do."""
        names = tuple(wanted)
        self.on_set(minor.point, names)
        held = self.closure(minor.rows, minor.point)
        for name in names:
            refuse(name not in held, f"`{name}` is not shown to follow from the rows")


def own_symbols(evidence: CheckedEvidence, generic: dict[str, Any]) -> None:
    """`CheckError` unless each relation has its own symbol, of no other, in which it is nowhere stationary."""
    for name, letter in generic.items():
        if letter not in evidence.problem.generic and letter not in evidence.problem.parameters:
            raise CheckError(f"`{str(letter)[:40]}` is no parameter and no generic length")
        left = evidence.relation(name).left
        others = (one.left for one in evidence.problem.relations if one.name != name)
        if any(letter in symbols_in(other) for other in others) or not has_value_everywhere(left):
            raise CheckError(f"`{letter}` is not the own symbol of `{name}`")
        refuse(not evidence.is_nonzero_product(derivative(left, letter)), f"`{name}` may be stationary in `{letter}`")


def has_own_symbol(evidence: CheckedEvidence, name: str) -> bool:
    """Whether a relation has a generic symbol of its own, in which it is nowhere stationary."""
    for letter in sorted(symbols_in(evidence.relation(name).left) & set(evidence.problem.generic)):
        try:
            own_symbols(evidence, {name: letter})
        except CheckError:
            continue
        return True
    return False
