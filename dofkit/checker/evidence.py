"""What a certificate puts forward: points, minors of rows that hold there, velocity fields; what these show.

The points that can be reached along fields form an immersed manifold, whose tangent space holds all their brackets
there (Hermann 1960, Nagano 1966, Sussmann 1973). Fields that are tangent to relations never leave them.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain, product
from typing import Any, NamedTuple

from dofkit.checker.point import CheckedPoint, evaluated, not_zero
from dofkit.checker.relations import CheckedRelations, Consequence, total_derivative
from dofkit.checker.trees import ONE, ZERO, Tree, along, call, derivative, linear_in, refuse, substituted, symbol

LARGEST_MINOR, LONGEST_WORD, LARGEST_FIELD = 250, 12, 100_000
Told = dict[str, Any]
VelocityField = dict[str, Tree]


class CheckedMinor(NamedTuple):
    """A minor that is not 0 at a point: its rows hold there, follow from the relations, and are independent."""

    point: CheckedPoint
    rows: tuple[str, ...]
    columns: tuple[str, ...]


class CheckedEvidence(CheckedRelations):
    """The points and minors of a certificate, each looked at when it is used, and once."""

    def named(self, part: str, name: Any) -> dict[str, Any]:
        """A point, minor, field or cover by its id."""
        self.effort.spend(len(self.entries[part]))
        return {entry["id"]: entry for entry in self.entries[part]}[name]

    def point(self, name: Any) -> CheckedPoint:
        """A point by its id: exact, or certified by interval Newton."""
        return self.once(("points", name), lambda: self._point(self.named("points", name)))

    def _point(self, entry: dict[str, Any]) -> CheckedPoint:
        values, columns, rows = dict[str, Tree](), entry.get("columns", []), entry.get("rows", [])
        allowed = {*self.variables, *self.velocities, *self.chosen} - {"tdot"}
        square = len(columns) == len(rows) == len(set(columns)) == len(set(rows)) <= LARGEST_MINOR
        fits = square and allowed >= entry["values"].keys() >= set(columns)
        refuse(not fits, "a point gives values to symbols, and a box has as many rows as columns, each once")
        for name, text in entry["values"].items():
            values[name] = substituted(self.text(text), values)
        functions = dict[str, tuple[tuple[str, ...], Tree]]()
        for name, choice in entry.get("functions", {}).items():
            arguments, text = tuple(choice["arguments"]), self.text(choice["text"], choice["arguments"])
            twice = len({*arguments}) != len(self.problem.world.names.functions[name])
            refuse(twice or not text.symbols <= {*arguments}, f"`{name}` is no function of its arguments")
            functions[name] = arguments, text
        balls = {name: evaluated(tree, {}, self.effort) for name, tree in values.items()}
        exact = {name: tree for name, tree in values.items() if name not in columns}
        point = CheckedPoint(entry["id"], exact, functions, self.effort, balls, frozenset(rows))
        if columns:
            radius = evaluated(self.text(entry["radius"]), {}, self.effort)
            point.settle([self.relation(name).tree for name in rows], columns, radius)
        for name, sign in self.problem.world.signs.items():
            fits = name not in balls or balls[name] > 0 or (sign != "positive" and not_zero(balls[name]))
            refuse(sign != "real" and not fits, f"the parameter `{name}` is declared {sign}")
        return point

    def holds(self, name: str, point: CheckedPoint) -> bool:
        """Whether a relation is 0 at a point, exactly."""
        return self.once(("holds", name, point.name), lambda: self.is_zero(self.relation(name).tree, point))

    def is_zero(self, tree: Tree, point: CheckedPoint) -> bool:
        """Whether a tree is 0 at a point: of a row of its box, or in the ring; and its ball holds 0."""
        row = any(self.by_name[name].tree == tree for name in point.rows)
        return bool(point.value(tree).contains(0)) and (row or self.ring.vanishes(point.prepared(tree)))

    def on_set(self, point: CheckedPoint, names: Iterable[str], states: bool = False) -> None:
        """`CheckError` unless a point satisfies the relations, but for integrals; forms are smooth there.

        A nonlinear relation speaks of a state, as all do where ``states``: velocity relations and rates hold there.
        """
        wanted = [self.relation(name) for name in names if not self.relation(name).leaf]
        states |= not all(self.is_linear(relation.name) for relation in wanted)
        met = {relation.name for relation in wanted if states or relation.kind == "finite"}
        start = {*point.rows, *(name for name in met if self.holds(name, point))}
        implied = self.closure(start, point, rates=False)
        refuse(met - implied, f"`{min(met - implied, default='')}` is not shown to follow from what holds")
        for relation in wanted:
            for velocity in self.met_by(relation.tree):
                point.value(self.slope(relation.name, velocity[:-3]))
            wrong = relation.name in met and not_zero(point.value(relation.tree))
            if states and relation.kind == "finite":
                wrong |= not self.is_zero(total_derivative(relation.tree, self.variables), point)
            refuse(wrong, f"`{relation.name}` is not satisfied at the point `{point.name}`, or not by its velocities")

    def applies(self, number: int, point: CheckedPoint | None) -> bool:
        """The same; where what must not be 0 holds velocities, near a state that meets all equations and the rates."""
        fits = super().applies(number, point)
        if not fits or point is None or not any(map(self.met_by, self.consequences[number].nonzero)):
            return fits
        return self.once(("state", point.name), lambda: self._is_state(point))

    def _is_state(self, point: CheckedPoint) -> bool:
        rates = (total_derivative(self.relation(name).tree, self.variables) for name in self.finite)
        met = {*point.rows, *(name for name in self.equations if self.holds(name, point))}
        moves = all(self.is_zero(rate, point) for rate in rates)
        # what follows near the state is not used to show that it is one
        self.seen["state", point.name] = False
        return moves and self.closure(met, point, rates=False).issuperset(self.equations)

    def minor(self, entry: Any, allowed: Collection[str] | None = None) -> CheckedMinor:
        """A minor, by its id or itself: rows that follow from ``allowed`` (or all relations), and are independent."""
        if isinstance(entry, str):
            key = ("minors", entry, None if allowed is None else frozenset(allowed))
            return self.once(key, lambda: self.minor(self.named("minors", entry), allowed))
        point, rows, columns = self.point(entry["at"]), tuple(entry["rows"]), tuple(entry["columns"])
        square = len({*rows}) == len(rows) == len(columns) == len({*columns}) <= LARGEST_MINOR
        fits = square and set(columns) <= set(self.problem.coordinates)
        refuse(not fits, "a minor has as many rows as columns, which are coordinates, each once, and not too many")
        self.follow(rows, self.equations if allowed is None else allowed, point, "the relations")
        self.on_set(point, rows)
        point.is_regular([[self.slope(row, column) for column in columns] for row in rows])
        return CheckedMinor(point, rows, columns)

    def is_linear(self, name: str) -> bool:
        """Whether a relation is finite, or a linear form in the velocities (dt included)."""
        checked = self.relation(name)
        linear = self.once(("linear", name), lambda: linear_in(checked.tree, self.velocities))
        return checked.kind != "velocity" or (linear is not None and self.ring.vanishes(linear[1]))

    def slope(self, row: str, column: str) -> Tree:
        """The entry of a row: by a coordinate, or by its velocity."""
        checked = self.relation(row)
        name = column if checked.kind == "finite" else column + "dot"
        return self.once(("slope", row, column), lambda: derivative(checked.tree, name))

    def accounts(self, minor: CheckedMinor, wanted: Collection[str]) -> CheckedMinor:
        """The minor; `CheckError` unless its point satisfies relations, as do points near it where its rows are 0."""
        self.on_set(minor.point, wanted)
        self.follow(wanted, minor.rows, minor.point, "the rows of the minor")
        return minor

    def settled(self, point: CheckedPoint, names: Iterable[str], claim: dict[str, Any]) -> None:
        """`CheckError` where geometric equations hold what the point chose, unless they hold near it for others, too.

        That is so where each has a generic symbol of its own, and where they follow from the rows of a minor.
        """
        finite = [name for name in names if self.relation(name).kind == "finite"]
        if any(self.is_open(self.relation(name).tree) and not self.own_symbol(name) for name in finite):
            minor = self.accounts(self.minor(claim["minor"]), finite)
            refuse(minor.point is not point, "the minor is not at the point")

    def own_symbol(self, name: str, letters: Iterable[str] | None = None) -> str:
        """A generic symbol (or one of ``letters``) of one relation alone, in which it is never stationary."""
        tree = self.relation(name).tree
        others = frozenset().union(*(other.tree.symbols for other in self.problem.relations if other.name != name))
        wanted = self.chosen.intersection(self.problem.world.generic if letters is None else letters) - others
        fit = (other for other in sorted(tree.symbols & wanted) if self.is_nowhere_zero(derivative(tree, other)))
        return next(fit, "") if self.has_value_everywhere(tree) else ""

    def at_reference(self, tree: Tree) -> Tree:
        """A tree at the scene's configuration, parameters and functions without values."""
        return substituted(tree, {**self.problem.reference, "t": ZERO, "tdot": ONE})

    @cached_property
    def reference(self) -> Mapping[str, Tree]:
        """The scene's configuration; nothing where a relation of numbers is certainly not 0 there."""
        values = (self.at_reference(self.relation(name).tree) for name in self.finite) if self.problem.reference else ()
        plain = (tree for tree in values if not tree.symbols and not tree.applied)
        missed = any(not_zero(evaluated(tree, {}, self.effort)) for tree in plain)
        return {} if missed else self.problem.reference

    def is_about(self, about: Any, point: CheckedPoint) -> Any:
        """The point's name, or ``reference``; `CheckError` unless it is one of those that a claim is about.

        ``reference``: the scene's configuration, which meets the relations for all values that a point chooses;
        ``component``: any point, where no configuration is given; ``here``: whichever of both is so.
        Angles have to be a chart of poses there.
        """
        fits = about in ("here", "reference" if self.reference else "component")
        refuse(not fits, "the claim has to be about the scene's configuration, if it has one")
        return self.once(("place", point.name), lambda: self._place(point))

    def _place(self, point: CheckedPoint) -> str:
        for _, tilt, _ in self.problem.turns:
            upright = tilt in point.balls and not not_zero(point.value(call("sin", symbol(tilt))))
            refuse(upright, f"the angles are no chart of the poses around, as sin({tilt}) may be 0")
        if not self.reference:
            return point.name
        for name, tree in {**self.reference, **({"t": ZERO} if "t" in point.balls else {})}.items():
            told_here = name in point.exact and self.ring.vanishes(point.prepared(symbol(name) - tree))
            refuse(not told_here, f"`{name}` is not that of the scene's configuration")
        for equation in (self.relation(name).tree for name in self.finite):
            if self.is_open(equation):
                self.identity(self.at_reference(equation), ZERO, "a relation at the configuration")
        return "reference"


def field_named(evidence: CheckedEvidence, name: Any) -> VelocityField:
    """A field by its id: its components; what is left out is 0."""
    components = evidence.named("fields", name)["components"]
    refuse(not components.keys() <= set(evidence.variables), "a field has a component of no coordinate")
    return {name: evidence.text(text) for name, text in components.items()}


def of_word(evidence: CheckedEvidence, word: Any, allowed: Iterable[str], longest: int = LONGEST_WORD) -> VelocityField:
    """The left-normed bracket of a word of the fields that are allowed: [A, B, C] is [[A, B], C]."""
    short = isinstance(word, list) and 1 <= len(word) <= longest and set(word) <= set(allowed)
    refuse(not short, "a word is a list of the fields, not too long")
    start, last = word[:-1], field_named(evidence, word[-1])
    if not start:
        return last
    return evidence.once(("word", *word), lambda: bracket(evidence, of_word(evidence, start, allowed), last))


def bracket(evidence: CheckedEvidence, x: VelocityField, y: VelocityField) -> VelocityField:
    """[X, Y] = (DY) X - (DX) Y, spending effort by the size of the fields; large ones are refused."""
    sizes = [sum(tree.size for tree in field.values()) for field in (x, y)]
    evidence.effort.spend(sizes[0] * len(y) + sizes[1] * len(x) + 1)
    refuse(max(sizes) > LARGEST_FIELD, "a bracket is too large")
    return {q: along(x, y.get(q, ZERO)) - along(y, x.get(q, ZERO)) for q in {**x, **y}}


def on_row(evidence: CheckedEvidence, row: str, field: VelocityField) -> Tree:
    """What a row says of a field: 0 where the field is tangent to it."""
    checked = evidence.relation(row)
    if checked.kind == "finite":
        return along(field, checked.tree)
    refuse(not evidence.is_linear(row), f"`{row}` is not linear in velocities")
    return substituted(checked.tree, {name + "dot": field.get(name, ZERO) for name in evidence.variables})


def tangent(evidence: CheckedEvidence, words: Iterable[Sequence[str]], rows: Iterable[str]) -> None:
    """`CheckError` unless the fields of words are tangent to rows, identically."""

    def examine(word: Sequence[str], row: str) -> None:
        evidence.identity(on_row(evidence, row, of_word(evidence, [*word], word)), ZERO, f"a field along `{row}`")

    for word, row in product(words, rows):
        evidence.once(("tangent", *word, "", row), partial(examine, word, row))


def independent(evidence: CheckedEvidence, fields: Sequence[VelocityField], columns: Any, point: CheckedPoint) -> None:
    """`CheckError` unless the fields have a minor at the point that is not 0."""
    square = len(fields) == len(columns) == len(set(columns)) and set(columns) <= set(evidence.variables)
    refuse(not square, "as many columns as fields are needed, each once")
    point.is_regular([[field.get(column, ZERO) for column in columns] for field in fields])


def admissible(
    evidence: CheckedEvidence, claim: Told, wanted: Sequence[str]
) -> tuple[CheckedPoint, list[VelocityField]]:
    """Fields whose curves through a point are motions: tangent to rows that account for ``wanted``, smooth there."""
    point, rows = evidence.point(claim["at"]), claim["rows"]
    fields = [field_named(evidence, name) for name in claim["fields"]]
    tangent(evidence, ([name] for name in claim["fields"]), rows)
    evidence.on_set(point, [*rows, *wanted])
    evidence.follow(rows, wanted, point, "the relations")
    evidence.follow(wanted, rows, point, "the rows of the fields")
    evidence.settled(point, wanted, claim)
    for value in (value for field in fields for value in field.values()):
        point.value(value)
    return point, fields


def span(evidence: CheckedEvidence, claim: Told, longest: int = LONGEST_WORD) -> tuple[CheckedPoint, int]:
    """A lower bound of the dimension of the orbit through a point, at a fixed time."""
    point, fields = admissible(evidence, claim, evidence.equations)
    words = [of_word(evidence, word, claim["fields"], longest) for word in claim["words"]]
    independent(evidence, words, claim["columns"], point)
    times_of = [field["t"] for field in fields if field.get("t", ZERO) != ZERO]
    goes_on = any(not_zero(point.value(tree)) for tree in times_of)
    refuse((evidence.timed or times_of) and not goes_on, "no field is shown to have time go by")
    return point, len(words) - bool(times_of)


def involutive(evidence: CheckedEvidence, claim: Told, allowed: Collection[str] | None = None) -> CheckedMinor:
    """Rows whose kernel is spanned by fields that are closed under brackets: they integrate (Frobenius 1877)."""
    minor, fields = evidence.minor(claim["minor"], allowed), [field_named(evidence, name) for name in claim["fields"]]
    timed = evidence.holds_time(minor.rows)
    missing = len(evidence.problem.coordinates) + timed - len(minor.rows)
    fits = len(fields) == missing and (timed or all("t" not in field for field in fields))
    refuse(not fits or not all(map(evidence.is_linear, minor.rows)), f"the kernel has {missing} fields")
    independent(evidence, fields, claim["columns"], minor.point)
    names: list[str] = claim["fields"]
    brackets = ([first, second] for i, first in enumerate(names) for second in names[:i])
    tangent(evidence, chain(([name] for name in names), brackets), minor.rows)
    return minor


def take_cover(evidence: CheckedEvidence, name: Any) -> list[str]:
    """Check a cover, and return its rows: near a minor's point they follow from the minor's (constant rank theorem).

    The fields of a block are tangent to it identically, so that its rank is at most its variables less its fields; the
    minor shows that the sum is reached. A row with t, or a number that the point chose, may hold by this choice alone.
    """
    cover, total = evidence.named("covers", name), 0
    minor, rows = evidence.minor(cover["minor"]), [row for block in cover["blocks"] for row in block["rows"]]
    each_row_once = len(rows) == len(set(rows)) and set(minor.rows) <= set(rows) <= set(evidence.finite)
    for row in rows:
        tree = evidence.relation(row).tree
        chosen = "t" in tree.symbols or (evidence.is_open(tree) and not evidence.own_symbol(row))
        refuse(chosen, f"`{row}` holds time, or what the point chose: it may be met for that alone")
    evidence.on_set(minor.point, rows)
    for block in cover["blocks"]:
        fields = [field_named(evidence, field) for field in block["fields"]]
        held = frozenset().union(*(evidence.relation(row).tree.symbols for row in block["rows"]))
        variables = held & set(evidence.problem.coordinates)
        unmoved = set(block["columns"]) <= variables and not any("t" in field for field in fields)
        refuse(not unmoved, "a column of no coordinate, or a field that moves t")
        tangent(evidence, ([name] for name in block["fields"]), block["rows"])
        independent(evidence, fields, block["columns"], minor.point)
        total += min(len(variables) - len(fields), len(block["rows"]))
    refuse(not each_row_once or total != len(minor.rows), "each equation once, and the minor's rank are needed")
    evidence.consequences += (Consequence(row, minor.rows, at=minor.point.name) for row in {*rows} - {*minor.rows})
    return rows
