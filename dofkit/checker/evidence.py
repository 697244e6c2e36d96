"""What a certificate puts forward, looked at in the checker's reading of the scene: texts, steps, points, minors."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from typing import Any, NamedTuple

from flint import arb

from dofkit.checker.balls import determinant, evaluated, excludes_zero, krawczyk
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.points import CheckedPoint, in_turn
from dofkit.checker.problem import Problem
from dofkit.checker.steps import Consequence, DerivedRelation, made_by, total_derivative
from dofkit.checker.texts import CheckedTexts, has_value_everywhere
from dofkit.checker.trees import Tree, add, negative, symbol, times

LARGEST_MINOR = 250
#: What a certificate of another form, or a hostile one, may raise.
FAULTS = (CheckError, KeyError, TypeError, ValueError, AttributeError, IndexError, ArithmeticError, RecursionError)


class CheckedMinor(NamedTuple):
    """A minor that is not 0 at a point: its rows hold there, follow from the relations, and are independent."""

    point: CheckedPoint
    rows: tuple[str, ...]
    columns: tuple[str, ...]


class CheckedEvidence(CheckedTexts):
    """The steps, points, minors and fields of a certificate, each looked at when it is used, and once."""

    def __init__(self, problem: Problem, parts: Mapping[str, list[dict[str, Any]]], effort: Effort) -> None:
        super().__init__(problem, effort)
        self.parts = parts
        self.known = {one.name: DerivedRelation(one.name, one.kind, one.left) for one in problem.relations}
        if len(self.known) < len(problem.relations):
            raise CheckError("two relations of the scene have one name")
        self.consequences: list[Consequence] = []
        self.faults: dict[str, str] = {}
        self.met: dict[tuple[int, str], bool] = {}
        self.points: dict[str, CheckedPoint] = {}
        self._take_steps()

    def _take_steps(self) -> None:
        for step in self.parts["relations"]:
            name = str(step.get("id"))
            try:
                if not isinstance(step.get("id"), str) or name in self.known:
                    raise CheckError(f"a step has no name of its own: {name[:40]!r}")
                relations, consequences = made_by(step, self)
                if clash := [one.name for one in relations if one.name in self.known]:
                    raise CheckError(f"the name `{clash[0]}` is taken")
                self.known.update({one.name: one for one in relations})
                self.consequences += consequences
            except FAULTS as error:
                self.faults[name] = f"step `{name[:60]}`: {told(error)}"

    @cached_property
    def finite(self) -> tuple[str, ...]:
        """The finite relations of the scene."""
        return tuple(one.name for one in self.problem.relations if one.kind == "finite")

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The velocity relations of the scene."""
        return tuple(one.name for one in self.problem.relations if one.kind == "velocity")

    @cached_property
    def timed(self) -> bool:
        """Whether time or dt occurs in an equation."""
        return any(not {"t", "tdot"}.isdisjoint(symbols_in(self.known[n].left)) for n in (*self.finite, *self.moving))

    def owned(self, owner: str, kinds: Collection[str] = ("finite", "velocity")) -> tuple[str, ...]:
        """The relations of a constraint."""
        return tuple(one.name for one in self.problem.relations if one.owner == owner and one.kind in kinds)

    def relation(self, name: Any) -> DerivedRelation:
        """A relation by its id."""
        if not isinstance(name, str) or name not in self.known:
            raise CheckError(self.faults.get(str(name).partition(".")[0], f"no relation `{str(name)[:60]}`"))
        return self.known[name]

    def named(self, part: str, name: Any) -> dict[str, Any]:
        """A point, minor or field by its id."""
        if isinstance(name, str):
            for one in self.parts[part]:
                if one.get("id") == name:
                    return one
        raise CheckError(f"no such entry of `{part}`: {str(name)[:60]!r}")

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

    def closure(self, start: Iterable[str], point: CheckedPoint | None) -> set[str]:
        """All that holds near a point (or, without one, everywhere) where ``start`` does, by the steps."""
        found, grew = set(start), True
        while grew:
            grew = False
            for i, one in enumerate(self.consequences):
                if one.target not in found and found.issuperset(one.sources) and self._met(i, point):
                    found.add(one.target)
                    grew = True
            self.effort.spend(len(self.consequences) + 1)
        return found

    def _met(self, place: int, point: CheckedPoint | None) -> bool:
        if point is None:
            one = self.consequences[place]
            return not one.nonzero and all(has_value_everywhere(tree) for tree in one.defined)
        key = (place, point.name)
        if key not in self.met:
            one = self.consequences[place]
            try:
                self.met[key] = all(excludes_zero(point.value(tree)) for tree in one.nonzero) and all(
                    self._has_value(tree, point) for tree in one.defined
                )
            except CheckError:
                if self.effort.left < 0:
                    raise
                self.met[key] = False
        return self.met[key]

    def _has_value(self, tree: Tree, point: CheckedPoint) -> bool:
        """Whether a tree is defined at the point, and with whatever velocities, where it has none."""
        wide = {name: arb(0, 10**30) for name in self.velocities if not point.has(name)}
        evaluated(point.prepared(tree), {**wide, **point.balls}, self.effort)
        return True

    def holds(self, name: str, point: CheckedPoint) -> bool:
        """Whether a relation is 0 at a point, exactly."""
        one = self.relation(name)
        if not point.value(one.left).contains(0) and not one.leaf:
            return False
        return one.leaf or name in point.rows or self.ring.vanishes(point.prepared(one.left))

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

    def is_linear(self, name: str) -> bool:
        """Whether a relation is finite, or a linear form in the velocities (dt included)."""
        left = self.relation(name).left
        if self.relation(name).kind != "velocity":
            return True
        slopes = [(v, derivative(left, v)) for v in sorted(self.velocities & symbols_in(left))]
        if any(self.has_velocities(slope) for _, slope in slopes):
            return False
        return self.ring.vanishes(add(left, *(negative(times(symbol(v), slope)) for v, slope in slopes)))

    def _is_state(self, point: CheckedPoint, names: Iterable[str]) -> None:
        """A nonlinear relation speaks of a state: all velocity relations and all rates hold at its velocities."""
        for name in names:
            one = self.relation(name)
            left = one.left if one.kind == "velocity" else total_derivative(one.left, self.variables)
            exact = self.ring.vanishes(point.prepared(left))
            if not exact and not any(self.known[row].left == left for row in point.rows):
                raise CheckError(f"`{name}` is not shown to hold for the velocities of `{point.name}`")

    def slope(self, row: str, column: str) -> Tree:
        """The entry of a row: by a coordinate, or by its velocity."""
        one = self.relation(row)
        return derivative(one.left, column if one.kind == "finite" else column + "dot")

    def minor(self, given: Any, allowed: Iterable[str] | None = None) -> CheckedMinor:
        """A minor: rows that follow from ``allowed`` (or all relations), and a determinant that is not 0."""
        given = self.named("minors", given) if isinstance(given, str) else given
        point, rows, columns = self.point(given["at"]), tuple(given["rows"]), tuple(given["columns"])
        if len(rows) != len(columns) or len(rows) > LARGEST_MINOR or len({*rows}) + len({*columns}) != 2 * len(rows):
            raise CheckError("a minor has as many rows as columns, each once")
        if not set(columns) <= set(self.problem.coordinates):
            raise CheckError("a column of a minor is no coordinate")
        start = (*self.finite, *self.moving) if allowed is None else tuple(allowed)
        followed = set(rows) if set(rows) <= set(start) else self.closure(start, point)
        for row in rows:
            if row not in followed:
                raise CheckError(f"the row `{row}` is not shown to follow from the relations near `{point.name}`")
        self.on_set(point, [row for row in rows if not self.relation(row).leaf])
        matrix = [[point.value(self.slope(row, column)) for column in columns] for row in rows]
        if not excludes_zero(determinant(matrix, self.effort)):
            raise CheckError("the minor may be 0")
        return CheckedMinor(point, rows, columns)

    def covers(self, minor: CheckedMinor, wanted: Iterable[str]) -> None:
        """`CheckError` unless relations hold at the point, and near it wherever the rows of a minor do."""
        names = tuple(wanted)
        self.on_set(minor.point, names)
        held = self.closure(minor.rows, minor.point)
        for name in names:
            if name not in held:
                raise CheckError(f"`{name}` is not shown to follow from the rows")


def told(error: Exception) -> str:
    """A fault in one line."""
    return (
        str(error)[:200] if isinstance(error, CheckError) else f"a field is missing or of another kind ({error!s:.80})"
    )
