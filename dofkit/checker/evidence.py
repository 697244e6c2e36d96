"""What a certificate puts forward at points: rows that hold, a minor of them that is not 0, and what follows there."""

from collections.abc import Collection, Iterable
from typing import Any, NamedTuple

from dofkit.checker.relations import CheckedRelations, total_derivative
from dofkit.checker.trees import ONE, ZERO, Tree, call, refuse, symbol
from dofkit.checker.values import CheckedPoint, derivative, evaluated, excludes_zero, linear_in, substituted, symbols_in

LARGEST_MINOR = 250


class CheckedMinor(NamedTuple):
    """A minor that is not 0 at a point: its rows hold there, follow from the relations, and are independent."""

    point: CheckedPoint
    rows: tuple[str, ...]
    columns: tuple[str, ...]


class CheckedEvidence(CheckedRelations):
    """The points and minors of a certificate, each looked at when it is used, and once."""

    def named(self, part: str, name: Any) -> dict[str, Any]:
        """A point, minor, field or cover by its id."""
        self.effort.spend(len(self.parts[part]))
        return {one["id"]: one for one in self.parts[part]}[name]

    def point(self, name: Any) -> CheckedPoint:
        """A point by its id: exact, or certified by interval Newton."""
        return self.once(("points", name), lambda: self._point(self.named("points", name)))

    def _point(self, given: dict[str, Any]) -> CheckedPoint:
        values, columns, rows = dict[str, Tree](), given.get("columns", []), given.get("rows", [])
        allowed = {*self.variables, *self.velocities, *self.chosen} - {"tdot"}
        square = len(columns) == len(rows) == len(set(columns)) == len(set(rows)) <= LARGEST_MINOR
        fits = square and allowed >= given["values"].keys() >= set(columns)
        refuse(not fits, "a point gives values to symbols, and a box has as many rows as columns, each once")
        for name, text in given["values"].items():
            values[name] = substituted(self.text(text), values)
        functions = dict[str, tuple[tuple[str, ...], Tree]]()
        for name, choice in given.get("functions", {}).items():
            arguments, text = tuple(choice["arguments"]), self.text(choice["text"], choice["arguments"])
            twice = len({*arguments}) != len(self.problem.functions[name])
            refuse(twice or not symbols_in(text) <= {*arguments}, f"`{name}` is no function of its arguments")
            functions[name] = arguments, text
        balls = {name: evaluated(tree, {}, self.effort) for name, tree in values.items()}
        exact = {name: tree for name, tree in values.items() if name not in columns}
        point = CheckedPoint(given["id"], exact, functions, self.effort, balls, frozenset(rows))
        if columns:
            radius = evaluated(self.text(given["radius"]), {}, self.effort)
            point.settle([self.relation(name).left for name in rows], columns, radius)
        for name, sign in self.problem.parameters.items():
            fits = name not in balls or balls[name] > 0 or (sign != "positive" and excludes_zero(balls[name]))
            refuse(sign != "real" and not fits, f"the parameter `{name}` is declared {sign}")
        return point

    def holds(self, name: str, point: CheckedPoint) -> bool:
        """Whether a relation is 0 at a point, exactly."""
        return self.once(("holds", name, point.name), lambda: self.is_zero(self.relation(name).left, point))

    def is_zero(self, left: Tree, point: CheckedPoint) -> bool:
        """Whether a tree is 0 at a point: of a row of its box, or in the ring; and its ball holds 0."""
        row = any(self.known[name].left == left for name in point.rows)
        return bool(point.value(left).contains(0)) and (row or self.ring.vanishes(point.prepared(left)))

    def on_set(self, point: CheckedPoint, names: Iterable[str], states: bool = False) -> None:
        """`CheckError` unless the relations hold at a point, but for integrals; forms are smooth there.

        A nonlinear relation speaks of a state, as all do where ``states``: velocity relations and rates hold there.
        """
        wanted = [self.relation(name) for name in names if not self.relation(name).leaf]
        finite = {one.name for one in wanted if one.kind == "finite"}
        self.follow(finite, {*point.rows, *(name for name in finite if self.holds(name, point))}, point, "what holds")
        states |= not all(self.is_linear(one.name) for one in wanted)
        for one in wanted:
            still = one.name in finite
            for velocity in self.met_by(one.left):
                point.value(self.slope(one.name, velocity[:-3]))
            wrong = still and excludes_zero(point.value(one.left))
            if states:
                wrong |= not self.is_zero(total_derivative(one.left, self.variables) if still else one.left, point)
            refuse(wrong, f"`{one.name}` does not hold at the point `{point.name}`, or not for its velocities")

    def minor(self, given: Any, allowed: Collection[str] | None = None) -> CheckedMinor:
        """A minor, by its id or itself: rows that follow from ``allowed`` (or all relations), and are independent."""
        if isinstance(given, str):
            key = ("minors", given, None if allowed is None else frozenset(allowed))
            return self.once(key, lambda: self.minor(self.named("minors", given), allowed))
        point, rows, columns = self.point(given["at"]), tuple(given["rows"]), tuple(given["columns"])
        square = len({*rows}) == len(rows) == len(columns) == len({*columns}) <= LARGEST_MINOR
        fits = square and set(columns) <= set(self.problem.coordinates)
        refuse(not fits, "a minor has as many rows as columns, which are coordinates, each once, and not too many")
        self.follow(rows, self.equations if allowed is None else allowed, point, "the relations")
        self.on_set(point, rows)
        point.is_regular([[self.slope(row, column) for column in columns] for row in rows])
        return CheckedMinor(point, rows, columns)

    def is_linear(self, name: str) -> bool:
        """Whether a relation is finite, or a linear form in the velocities (dt included)."""
        one = self.relation(name)
        parts = self.once(("linear", name), lambda: linear_in(one.left, self.velocities))
        return one.kind != "velocity" or (parts is not None and self.ring.vanishes(parts[1]))

    def slope(self, row: str, column: str) -> Tree:
        """The entry of a row: by a coordinate, or by its velocity."""
        one = self.relation(row)
        name = column if one.kind == "finite" else column + "dot"
        return self.once(("slope", row, column), lambda: derivative(one.left, name))

    def accounts(self, minor: CheckedMinor, wanted: Collection[str]) -> CheckedMinor:
        """The minor; `CheckError` unless relations hold at its point, and near it wherever its rows do."""
        self.on_set(minor.point, wanted)
        self.follow(wanted, minor.rows, minor.point, "the rows of the minor")
        return minor

    def settled(self, point: CheckedPoint, names: Iterable[str], given: dict[str, Any]) -> None:
        """`CheckError` where finite relations hold what the point chose, unless they hold near it for others, too.

        That is so where each has a generic symbol of its own, and where they follow from the rows of a minor.
        """
        finite = [name for name in names if self.relation(name).kind == "finite"]
        if any(self.is_open(self.relation(name).left) and not self.own_symbol(name) for name in finite):
            minor = self.accounts(self.minor(given["minor"]), finite)
            refuse(minor.point is not point, "the minor is not at the point")

    def own_symbol(self, name: str, letters: Iterable[str] | None = None) -> str:
        """A generic symbol (or one of ``letters``) of one relation alone, in which it is never stationary."""
        left = self.relation(name).left
        others = frozenset().union(*(symbols_in(one.left) for one in self.problem.relations if one.name != name))
        wanted = self.chosen.intersection(self.problem.generic if letters is None else letters) - others
        fit = (one for one in sorted(symbols_in(left) & wanted) if self.is_nowhere_zero(derivative(left, one)))
        return next(fit, "") if self.has_value_everywhere(left) else ""

    def at_reference(self, tree: Tree) -> Tree:
        """A tree at the scene's configuration, parameters and functions left open."""
        return substituted(tree, {**self.problem.reference, "t": ZERO, "tdot": ONE})

    def is_about(self, about: Any, point: CheckedPoint, beside: Collection[tuple[str, ...]] = ()) -> Any:
        """The point's name, or ``reference``; `CheckError` unless it is one of those that a claim is about.

        ``reference``: the scene's configuration, which meets the relations for all values that a point chooses;
        ``component``: any point, where no configuration is given; ``here``: whichever of both is so.
        Angles have to be a chart of poses there, but for those ``beside``.
        """
        fits = about in ("here", "reference" if self.problem.reference else "component")
        refuse(not fits, "the claim has to be about the scene's configuration, if it has one")
        for tilt in (angles[1] for angles in self.problem.turns if angles not in beside):
            upright = tilt in point.balls and not excludes_zero(point.value(call("sin", symbol(tilt))))
            refuse(upright, f"the angles are no chart of the poses around, as sin({tilt}) may be 0")
        if not self.problem.reference:
            return point.name
        for name, tree in {**self.problem.reference, **({"t": ZERO} if "t" in point.balls else {})}.items():
            told_here = name in point.exact and self.same(point.prepared(symbol(name)), point.prepared(tree))
            refuse(not told_here, f"`{name}` is not that of the scene's configuration")
        for left in (self.relation(name).left for name in self.finite):
            if self.is_open(left):
                self.identity(self.at_reference(left), ZERO, "a relation at the configuration")
        return "reference"
