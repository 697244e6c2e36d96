"""Texts of a scene read with their faults: what cannot be read is recorded with its path and column."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from fractions import Fraction

from dofkit.base.errors import Fault, TextError
from dofkit.expressions.calculus import in_velocities, linear_in_accelerations
from dofkit.expressions.renaming import Template
from dofkit.expressions.text import Names, parse_expression, parse_relations
from dofkit.expressions.text.names import pattern_of
from dofkit.expressions.tree import Expr, num, parameter
from dofkit.expressions.vectors import Vec
from dofkit.scene.fields import Vector, as_written, suggestion
from dofkit.system import Relation, Sense

#: The nearest name is looked for while there are fewer faults than this.
MOST_HINTS = 100

#: What may be mentioned: in a fixed value, in a law of positions, in an equation.
FIXED = frozenset({"parameter"})
LAW = frozenset({"parameter", "time"})
FINITE = frozenset({"parameter", "coordinate", "time"})
MOVING = FINITE | {"velocity"}
ANYTHING = MOVING | {"acceleration", "differential", "dt"}

_ONLY = {
    FIXED: "numbers and parameters",
    LAW: "parameters and time",
    FINITE: "positions, parameters and time",
    MOVING: "positions, velocities, parameters and time",
}
_SENSES: dict[str, tuple[Sense, bool]] = {
    "=": ("=", False), ">=": (">=", False), ">": (">", False), "<=": (">=", True), "<": (">", True),
}  # fmt: skip
_CALLED = {
    "coordinate": "the coordinate {}", "time": "time", "velocity": "the velocity of {}",
    "acceleration": "the acceleration of {}", "differential": "the differential of {}", "dt": "dt",
}  # fmt: skip


class Ledger:
    """The faults and warnings of one entry of a scene, which stands at the path ``here``.

    ``before``: how many faults were found in what was read earlier.
    """

    def __init__(self, here: tuple[str | int, ...] = (), before: int = 0) -> None:
        self.here = here
        self.faults: list[Fault] = []
        self.warnings: list[str] = []
        self._hints = MOST_HINTS - before

    def fault(self, message: str, *where: str | int, hint: str | None = None, column: int | None = None) -> None:
        """Record a fault at ``where`` within the entry that is being read."""
        self.faults.append(Fault(message, (*self.here, *where), column=column, hint=hint))

    def unknown(self, what: str, name: str, known: Iterable[str], *where: str | int, plural: str = "") -> None:
        """Record that ``name`` is not declared, with the nearest name that is (for the first faults: it takes time)."""
        hint = suggestion(name, tuple(known), plural or f"{what}s") if len(self.faults) < self._hints else None
        self.fault(f"there is no {what} '{name}'", *where, hint=hint)


class _RelationTemplate:
    """A relation, to be written in other names many times over."""

    def __init__(self, relation: Relation) -> None:
        self._expr, self._sense = Template(relation.expr), relation.sense
        self._domain = [(Template(e), sense) for e, sense in relation.domain]

    def of(self, names: Mapping[str, str]) -> Relation:
        """Return the relation with each name replaced."""
        domain = tuple([(_renamed(template, names), sense) for template, sense in self._domain])
        return Relation(_renamed(self._expr, names), self._sense, domain=domain)


def _renamed(template: Template, names: Mapping[str, str]) -> Expr:
    return template.of([names[n] for n in template.names])


class ParsedTexts:
    """Expressions of texts that are read with some names, each parsed once however often it occurs."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self._parsed: dict[str, Expr | TextError] = {}
        self._patterns: dict[Hashable, tuple[tuple[str, ...], list[_RelationTemplate]]] = {}
        self._made: dict[Hashable, tuple[list[int], Template]] = {}

    def equations(self, text: str) -> list[Relation]:
        """The relations of a text that may mention anything.

        A text that is one read before up to the names of coordinates is that one in other names. Raises TextError for
        what cannot be read, and for second derivatives and differentials that say nothing where they stand.
        """
        pattern = pattern_of(text, self.names.lookup)
        known = None if pattern is None else self._patterns.get(pattern.key)
        if pattern is not None and known is not None:
            names = dict(zip(known[0], pattern.names, strict=True))
            return [template.of(names) for template in known[1]]
        found = _equations(text, self.names)
        for relation in found:
            linear_in_accelerations(relation.expr, relation.sense)
            in_velocities(relation.expr)
        if pattern is not None:
            self._patterns[pattern.key] = pattern.names, [_RelationTemplate(relation) for relation in found]
        return found

    def in_names(self, kind: Hashable, symbols: Sequence[Expr], make: Callable[[], Expr]) -> Expr:
        """What ``make`` makes of some symbols of different names: the same for one ``kind`` but for these; made once.

        What holds others that have names, as that of a text which could not be read, is made each time.
        """
        known = self._made.get(kind)
        if known is not None:
            places, template = known
            return template.with_symbols([symbols[k] for k in places])
        found = make()
        template = Template(found)
        if set(template.symbols) <= set(symbols):
            self._made[kind] = [symbols.index(s) for s in template.symbols], template
        return found

    def expression(self, text: str) -> Expr | TextError:
        """The expression of a text, or why it is none."""
        found = self._parsed.get(text)
        if found is None:
            try:
                found = parse_expression(text, self.names)
            except TextError as error:
                found = error
            self._parsed[text] = found
        return found


def symbols_of(text: str, names: Names) -> frozenset[Expr]:
    """What a text mentions; nothing if it cannot be read, which is told elsewhere."""
    try:
        found = parse_relations(text, names)
    except TextError:
        return frozenset()
    return frozenset().union(*(side.symbols for c in found for side in (c.left, c.right)))


def _instead(kind: str, allow: frozenset[str]) -> str:
    """What to write where a kind of symbol cannot stand."""
    told = f"only {_ONLY[allow]} may be used"
    if allow is FIXED:
        law = "x_A = cos(t)" if kind == "time" else "x_A = s"
        told += f"; what moves is written as an equation, such as `{law}`"
    return told


class Texts(Ledger):
    """The texts of one entry, read with the scene's names."""

    def __init__(self, reader: ParsedTexts, here: tuple[str | int, ...] = (), before: int = 0) -> None:
        super().__init__(here, before)
        self._reader = reader
        self.names = reader.names

    def expression(self, value: Fraction | str, *where: str | int, allow: frozenset[str] = FINITE) -> Expr:
        """A number or text as an expression that mentions only what ``allow`` names."""
        if isinstance(value, Fraction):
            return num(value)
        found = self._reader.expression(value)
        if isinstance(found, TextError):
            self.fault(found.message, *where, hint=self.advice(found, value), column=found.column)
            return parameter("_fault")
        self.only(found, allow, *where)
        return found

    def advice(self, error: TextError, text: str) -> str | None:
        """What to do about a text that cannot be read; a class that knows more than names may say more."""
        del text
        return error.hint

    def fixed(self, value: Fraction | str, *where: str | int) -> Expr:
        """A number or text that holds numbers and parameters only."""
        return self.expression(value, *where, allow=FIXED)

    def vector(self, values: Vector, dimension: int, *where: str | int) -> Vec | None:
        """The components as expressions; None after a fault in their number."""
        if len(values) != dimension:
            message = f"{len(values)} component{'s' * (len(values) != 1)} given where the dimension is {dimension}"
            line = "[" + ", ".join([*map(as_written, values), *["0"] * dimension][:dimension]) + "]"
            line = f"{where[-1]}: {line}" if where and isinstance(where[-1], str) else line
            other = f", or `dimension: {len(values)}`" if len(values) in (1, 2, 3) else ""
            self.fault(message, *where, hint=f"write `{line}`{other}")
            return None
        return tuple(self.fixed(value, *where, i) for i, value in enumerate(values))

    def only(self, e: Expr, allow: frozenset[str], *where: str | int) -> None:
        """Record a fault if ``e`` mentions anything that ``allow`` does not name."""
        if allow is ANYTHING:
            return
        for kind, name in sorted(symbol.args for symbol in e.symbols):
            if kind not in allow:
                message = f"{_CALLED[kind].format(name)} cannot stand here"
                self.fault(message, *where, hint=_instead(kind, allow))
                return

    def in_names(self, kind: Hashable, symbols: Sequence[Expr], make: Callable[[], Expr]) -> Expr:
        """What ``make`` makes of some symbols; see `ParsedTexts`."""
        return self._reader.in_names(kind, symbols, make)

    def equations(self, text: str, *where: str | int) -> list[Relation]:
        """The relations of a text that may mention anything, and what says nothing is a fault; see `ParsedTexts`."""
        try:
            return self._reader.equations(text)
        except TextError as error:
            self.fault(error.message, *where, hint=self.advice(error, text), column=error.column)
            return []

    def relations(self, text: str, *where: str | int, names: Names, allow: frozenset[str]) -> list[Relation]:
        """The relations of a text in other names."""
        try:
            found = _equations(text, names)
        except TextError as error:
            self.fault(error.message, *where, hint=self.advice(error, text), column=error.column)
            return []
        for relation in found:
            self.only(relation.expr, allow, *where)
        return found


def _equations(text: str, names: Names) -> list[Relation]:
    told: list[Relation] = []
    for comparison in parse_relations(text, names):
        sense, swap = _SENSES[comparison.relation]
        e = comparison.right - comparison.left if swap else comparison.left - comparison.right
        told.append(Relation(e, sense, domain=comparison.domain))
    return told
