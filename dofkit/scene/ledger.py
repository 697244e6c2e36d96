"""Formulas of a scene, parsed with its names; errors are recorded as faults with path and column."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.errors import Fault, TextError
from dofkit.expressions.calculus import in_velocities, refuse_accelerations
from dofkit.expressions.renaming import OF_COORDINATES, Renaming, shape_of
from dofkit.expressions.text import Names, UnknownNameError, parse_expression, parse_relations
from dofkit.expressions.text.names import Lookup, Meaning, unknown_name
from dofkit.expressions.tree import Expr, num, parameter
from dofkit.expressions.vectors import Vec
from dofkit.scene.fields import Vector, as_written, suggestion
from dofkit.system import Relation, Sense

#: Hints with the nearest name are given to this many faults only, because the search takes time.
MOST_HINTS = 100

#: The kinds of symbols that are allowed in a fixed value, in a law of time, in an equation of positions, and so on.
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
_NAMES_OF_KINDS = {
    "coordinate": "the coordinate {}", "time": "time", "velocity": "the velocity of {}",
    "acceleration": "the acceleration of {}", "differential": "the differential of {}", "dt": "dt",
}  # fmt: skip


class Ledger:
    """Collects the faults of a scene; ``here`` is the path of the entry that is being read."""

    def __init__(self, here: tuple[str | int, ...] = (), faults: list[Fault] | None = None) -> None:
        self.here = here
        self.faults: list[Fault] = [] if faults is None else faults

    def fault(self, message: str, *where: str | int, hint: str | None = None, column: int | None = None) -> None:
        """Record a fault at ``where`` within the entry that is being read."""
        self.faults.append(Fault(message, (*self.here, *where), column=column, hint=hint))

    def unknown(self, what: str, name: str, declared: Iterable[str], *where: str | int, plural: str = "") -> None:
        """Record that no ``what`` called ``name`` is declared, with the nearest of the names ``declared`` as a hint."""
        hint = suggestion(name, tuple(declared), plural or f"{what}s") if len(self.faults) < MOST_HINTS else None
        self.fault(f"there is no {what} '{name}'", *where, hint=hint)


#: Longer texts are parsed by themselves: they may be too long.
_LONGEST = 1000
_WORDS = re.compile(r"([A-Za-z][A-Za-z0-9_]*)", re.ASCII)
_UNUSUAL = re.compile(r"[\\{}$]|[^\x20-\x7e]")
#: Where a word goes on with a number: ``2e5``, ``0x1``.
_IN_A_NUMBER = re.compile(r"[0-9.]$", re.ASCII)


class Pattern(NamedTuple):
    """A text without the names of its coordinates, and these, in the order in which they first occur."""

    key: Hashable
    names: tuple[str, ...]


def pattern_of(text: str, lookup: Lookup) -> Pattern | None:
    """Return the pattern of a text; None where it has to be read by itself."""
    if len(text) > _LONGEST or _UNUSUAL.search(text):
        return None
    pieces: list[Hashable] = list(_WORDS.split(text))
    places: dict[str, int] = {}
    for i in range(1, len(pieces), 2):
        word = str(pieces[i])
        meaning = lookup.meaning(word)
        if meaning is None or meaning.kind not in ("value", "motion", "function") or word == "d":
            return None
        if word[0] in "eExXoObB" and _IN_A_NUMBER.search(str(pieces[i - 1])):
            return None
        moving = _moving(meaning)
        if moving is not None:
            kind, name = moving
            pieces[i] = (kind, places.setdefault(name, len(places)))
    return Pattern(tuple(pieces), tuple(places))


def _moving(meaning: Meaning) -> tuple[str, str] | None:
    """Return (kind, coordinate) of a symbol that belongs to a coordinate, such as a velocity; None for others."""
    e = meaning.expr
    if e is None or e.op != "sym" or e.args[0] not in OF_COORDINATES:
        return None
    kind, name = e.args
    return kind, name


class ParsedTexts:
    """Parses texts with the given names, each different text once.

    A text that equals an earlier one up to the names of coordinates is not parsed either, which is three times as fast
    for 20 000 equations of seven forms.
    """

    def __init__(self, names: Names) -> None:
        self.names = names
        self._parsed: dict[str, Expr | TextError] = {}
        self._patterns: dict[Hashable, tuple[tuple[str, ...], list[Relation]]] = {}

    def equations(self, text: str) -> list[Relation]:
        """Return the relations in a text, which may mention symbols of every kind.

        A text that differs from an earlier one only in names is not parsed again. Raises TextError for a text that
        cannot be read, for second derivatives, and for inhomogeneous differentials.
        """
        pattern = pattern_of(text, self.names.lookup)
        earlier = None if pattern is None else self._patterns.get(pattern.key)
        if pattern is not None and earlier is not None:
            renamed = Renaming(dict(zip(earlier[0], pattern.names, strict=True))).of
            return [
                r._replace(expr=renamed(r.expr), domain=tuple([(renamed(e), sense) for e, sense in r.domain]))
                for r in earlier[1]
            ]
        relations = _equations(text, self.names)
        for relation in relations:  # raise for what a constraint cannot contain
            refuse_accelerations(relation.expr)
            in_velocities(relation.expr)
        if pattern is not None:
            for relation in relations:
                shape_of(relation.expr)  # renamed copies take it over
            self._patterns[pattern.key] = pattern.names, relations
        return relations

    def expression(self, text: str) -> Expr | TextError:
        """Return the expression in a text, or the TextError if it cannot be read."""
        if text not in self._parsed:
            try:
                self._parsed[text] = parse_expression(text, self.names)
            except TextError as error:
                self._parsed[text] = error
        return self._parsed[text]


def symbols_of(text: str, names: Names) -> frozenset[Expr]:
    """Return the symbols that a text mentions; none if it cannot be read, which is recorded as a fault elsewhere."""
    try:
        comparisons = parse_relations(text, names)
    except TextError:
        return frozenset()
    return frozenset().union(*(side.symbols for c in comparisons for side in (c.left, c.right)))


class Texts(Ledger):
    """A ledger that parses texts with the scene's names, and records the errors as faults."""

    def __init__(
        self, reader: ParsedTexts, here: tuple[str | int, ...] = (), faults: list[Fault] | None = None
    ) -> None:
        super().__init__(here, faults)
        self._reader = reader
        self.names = reader.names

    def expression(self, value: Fraction | str, *where: str | int, allow: frozenset[str] = FINITE) -> Expr:
        """Return a number or text as an expression, a parameter after a fault. Only kinds in ``allow`` may occur."""
        if isinstance(value, Fraction):
            return num(value)
        expression = self._reader.expression(value)
        if isinstance(expression, TextError):
            self._unread(expression, value, *where)
            return parameter("_fault")
        self.only(expression, allow, *where)
        return expression

    def _unread(self, error: TextError, text: str, *where: str | int, names: Names | None = None) -> None:
        """Record the error of a text, and the errors that remain once its unknown names are declared."""
        declared = names = names or self.names
        while True:
            self.fault(error.message, *where, hint=self.advice(error, text), column=error.column)
            name = error.name if isinstance(error, UnknownNameError) and "is not declared" in error.message else ""
            if not name or name in names.coordinates or len(self.faults) >= MOST_HINTS:
                return
            names = replace(names, coordinates=names.coordinates | {name})
            try:
                parse_relations(text, names)
            except UnknownNameError as other:
                nearest = unknown_name(other.name, declared.lookup, other.column or 1, called=False)
                unit = "without units" in other.message
                error = UnknownNameError(other.message, other.column, other.hint if unit else nearest.hint)
            except TextError as other:
                if 0 <= (other.column or 0) - (error.column or 0) <= len(name):
                    return  # about the unknown name again, such as its argument
                error = other
            else:
                return

    def advice(self, error: TextError, text: str) -> str | None:
        """Return the hint for a text that cannot be read; subclasses may give a better one than the error's."""
        del text
        return error.hint

    def fixed(self, value: Fraction | str, *where: str | int) -> Expr:
        """Return a number or text as an expression; only numbers and parameters may occur."""
        return self.expression(value, *where, allow=FIXED)

    def vector(self, values: Vector, dimension: int, *where: str | int) -> Vec | None:
        """Return the components as expressions; None, with a fault, if there are not ``dimension`` of them."""
        if len(values) != dimension:
            message = f"{len(values)} component{'s' * (len(values) != 1)} given where the dimension is {dimension}"
            line = "[" + ", ".join([*map(as_written, values), *["0"] * dimension][:dimension]) + "]"
            line = f"{where[-1]}: {line}" if where and isinstance(where[-1], str) else line
            other = f", or `dimension: {len(values)}`" if len(values) in (1, 2, 3) else ""
            self.fault(message, *where, hint=f"write `{line}`{other}")
            return None
        return tuple(self.fixed(value, *where, i) for i, value in enumerate(values))

    def only(self, e: Expr, allow: frozenset[str], *where: str | int) -> None:
        """Record a fault if a symbol occurs in ``e`` whose kind is not in ``allow``."""
        if allow is ANYTHING:
            return
        for kind, name in sorted(symbol.args for symbol in e.symbols):
            if kind not in allow:
                hint = f"only {_ONLY[allow]} may be used"
                if allow is FIXED:
                    law = "x_A = cos(t)" if kind == "time" else "x_A = s"
                    hint += f"; what moves is written as an equation, such as `{law}`"
                self.fault(f"{_NAMES_OF_KINDS[kind].format(name)} cannot stand here", *where, hint=hint)
                return

    def equations(self, text: str, *where: str | int) -> list[Relation]:
        """Return the relations in a text, which may mention symbols of every kind; none after a fault."""
        try:
            return self._reader.equations(text)
        except TextError as error:
            self._unread(error, text, *where)
            return []

    def relations(self, text: str, *where: str | int, names: Names, allow: frozenset[str]) -> list[Relation]:
        """Return the relations in a text, with the given ``names``; empty after a fault, which is recorded."""
        try:
            relations = _equations(text, names)
        except TextError as error:
            self._unread(error, text, *where, names=names)
            return []
        for relation in relations:
            self.only(relation.expr, allow, *where)
        return relations


def _equations(text: str, names: Names) -> list[Relation]:
    """Return the relations in a text, with `<=` and `<` turned into `>=` and `>`."""
    relations: list[Relation] = []
    for comparison in parse_relations(text, names):
        sense, swap = _SENSES[comparison.relation]
        e = comparison.right - comparison.left if swap else comparison.left - comparison.right
        relations.append(Relation(e, sense, domain=comparison.domain))
    return relations
