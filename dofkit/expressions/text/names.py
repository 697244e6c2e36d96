"""Names: what a text may mention, what each word means, and which names may be declared."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from typing import Literal, NamedTuple

from dofkit.base.errors import TextError
from dofkit.base.wording import closest
from dofkit.expressions.text.characters import DOT, GREEK, LETTERS, MAX_NAME, TWO_DOTS, check_name_characters
from dofkit.expressions.tree import DT, FUNCTIONS, PI, TIME, E, Expr, coordinate, differential, sym, velocity


def spelled(name: str) -> str:
    """Return ``name`` with its Greek letters spelled out: θ_1 and theta_1 are one name."""
    if name.isascii():
        return name
    return "".join([GREEK.get(c, c) for c in (LETTERS.get(c, c) for c in name)])


SYNONYMS: dict[str, str] = {
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "ln": "log", "cosec": "csc",
}  # fmt: skip
ELEMENTARY: dict[str, str] = {**{name: name for name in FUNCTIONS}, "sqrt": "sqrt", **SYNONYMS}
OPERATORS = ("diff", "partial")
#: Before the name of a coordinate: a virtual displacement, read as its differential.
VARIATION = "δ"
_RESERVED: dict[str, str] = {
    "t": "time", "dt": "the differential of time", "ground": "the fixed world", "pi": "the number 3.14...",
}  # fmt: skip

MeaningKind = Literal["value", "motion", "function", "call", "operator"]


class Meaning(NamedTuple):
    """What a word stands for.

    ``value``: a number, coordinate, parameter or time. ``motion``: a velocity, acceleration or
    differential. ``function``: elementary, by name. ``call``: an unknown function, ``order``
    times differentiated by time where dots stand over it, or -1 for its differential.
    ``operator``: `diff` or `partial`.
    """

    kind: MeaningKind
    expr: Expr | None = None
    name: str = ""
    order: int = 0


@dataclass(frozen=True)
class Names:
    """The names that a text may use; the rest is an error.

    ``coordinates``: each q brings dq, qdot, q', qddot. ``parameters``: name -> its symbol or the
    exact value it was given. ``functions``: unknown functions -> number of arguments.
    ``arguments``: their declared argument names, so that ``h`` alone means ``h(s)``. The three
    switches refuse time, velocities (differentials too) and accelerations.
    """

    coordinates: frozenset[str] = frozenset()
    parameters: Mapping[str, Expr] = field(default_factory=dict)
    functions: Mapping[str, int] = field(default_factory=dict)
    arguments: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    allow_time: bool = True
    allow_velocities: bool = True
    allow_accelerations: bool = False

    def kind_refused(self, symbol: Expr) -> str | None:
        """Return the kind of the symbol, in words, if texts with these names may not use it; else None."""
        kind = symbol.args[0]
        if kind == "acceleration" and not self.allow_accelerations:
            return "an acceleration"
        if kind in ("velocity", "differential", "dt") and not self.allow_velocities:
            return "a velocity or differential"
        return "time" if kind in ("time", "dt") and not self.allow_time else None

    @cached_property
    def lookup(self) -> Lookup:
        """The words' meanings, worked out once and then remembered."""
        return Lookup(self)


class UnknownNameError(TextError):
    """A word that is not declared; its message shows it between backquotes."""

    @property
    def name(self) -> str:
        """The word as it was written."""
        return self.message.split("`")[1]


class AmbiguousError(TextError):
    """A text of which a part can be read in several ways.

    ``readings``: what may be written for that part, which stands in the columns ``span``, the last not included.
    """

    def __init__(
        self,
        message: str,
        column: int | None = None,
        hint: str | None = None,
        readings: tuple[str, ...] = (),
        span: tuple[int, int] = (1, 1),
    ) -> None:
        super().__init__(message, column, hint)
        self.readings = readings
        self.span = span


_PLAIN = re.compile(r"[A-Za-z0-9_]*")
_NUMBERED = re.compile(r"(.*[A-Za-z])(_?)(\d+)", re.ASCII)
_SUFFIXED = re.compile(r"(.+?)_?(d?dot)([_0-9].*)?", re.ASCII)
_MARKED = re.compile(f"([^{DOT}{TWO_DOTS}]+)([{DOT}{TWO_DOTS}]+)([_0-9][^{DOT}{TWO_DOTS}]*)?")
_DOTS = {1: "dot", 2: "ddot"}
#: How many words are remembered at most beside the declared ones; a word that fits nothing is remembered too.
_MEMORY = 20_000


def unmarked(name: str) -> str:
    """Return ``name`` spelled out, in small letters and without `_`."""
    return spelled(name).replace("_", "").lower()


def in_words(name: str) -> str:
    """Return the name with its Greek letters spelled out and the dots above it as `dot` or `ddot`.

    >>> in_words("θ\u0307_A")
    'thetadot_A'
    """
    name = spelled(name)
    match = _MARKED.fullmatch(name)
    return name if match is None else f"{match[1]}{_DOTS.get(_order(match[2]), match[2])}{match[3] or ''}"


def _order(marks: str) -> int:
    return sum(1 if mark == DOT else 2 for mark in marks)


class Lookup:
    """Words -> meanings for one `Names`."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self._declared = _declared(names)
        self._words: dict[str, Meaning | None] = {}
        self.longest = 5 + max((len(name) for name in self._declared), default=0)

    def meaning(self, word: str) -> Meaning | None:
        """Return what the whole word stands for, or None.

        Greek letters and their spelled names are the same; ``δq`` is the differential of q unless δ is declared.
        """
        try:
            return self._words[word]
        except KeyError:
            meaning = self._find(spelled(word))
            if meaning is None and word[:1] == VARIATION and spelled(VARIATION) not in self._declared:
                meaning = self._time_derivative(spelled(word[1:]), -1)
            if len(self._words) < _MEMORY + len(self._declared):
                self._words[word] = meaning
            return meaning

    @cached_property
    def declared(self) -> list[str]:
        """All declared names, as declared."""
        names = self.names
        return [*sorted(names.coordinates), *names.parameters, *names.functions]

    @cached_property
    def unmarked(self) -> dict[str, str]:
        """Names without `_` and capitals -> the name: what people mistake for one another."""
        names_read = (*ELEMENTARY, *reversed(self.declared))
        return {unmarked(name): name for name in names_read}

    def _find(self, word: str) -> Meaning | None:
        meaning = self._declared.get(word)
        if meaning is None:
            meaning = _built_in(word)
        if meaning is None and (DOT in word or TWO_DOTS in word):
            return self._dotted(word)
        if meaning is None:
            meaning = self._marked_derivative(word)
        if meaning is None and word == "E":
            meaning = Meaning("value", E)
        return meaning

    def _dotted(self, word: str) -> Meaning | None:
        match = _MARKED.fullmatch(word)
        if match is None:
            return None
        return self._time_derivative(match[1] + (match[3] or ""), _order(match[2]))

    def _marked_derivative(self, word: str) -> Meaning | None:
        """`dq`, `qdot`, `q_dot`, `qdot_A`, `qdot1`, `qddot` of a declared q."""
        if word[0] == "d":
            differential = self._time_derivative(word[1:], -1)
            if differential is not None:
                return differential
        match = _SUFFIXED.fullmatch(word) if "dot" in word else None
        if match is None:
            return None
        return self._time_derivative(match[1] + (match[3] or ""), 1 if match[2] == "dot" else 2)

    def _time_derivative(self, word: str, order: int) -> Meaning | None:
        """Return the ``order``-th derivative by time of the declared ``word``; -1 for its differential."""
        base = self._declared.get(word)
        if base is None:
            return None
        if base.kind == "call" and order < 3:
            return base._replace(order=order)
        expr = base.expr
        if base.kind != "value" or expr is None or expr.op != "sym" or expr.args[0] != "coordinate":
            return None
        moved = derivative(expr.args[1], order)
        return None if moved is None else Meaning("motion", moved)


def derivative(name: str, order: int) -> Expr | None:
    """Return the coordinate ``name``, its velocity or acceleration, or (-1) its differential."""
    if order == -1:
        return differential(name)
    if order == 0:
        return coordinate(name)
    if order == 1:
        return velocity(name)
    return sym("acceleration", name) if order == 2 else None


def _built_in(word: str) -> Meaning | None:
    if word in ELEMENTARY:
        return Meaning("function", name=ELEMENTARY[word])
    if word == "t":
        return Meaning("value", TIME)
    if word == "dt":
        return Meaning("motion", DT)
    if word == "pi":
        return Meaning("value", PI)
    return Meaning("operator", name=word) if word in OPERATORS else None


def _declared(names: Names) -> dict[str, Meaning]:
    """Spelled name -> meaning; `x1` and `x_1` are one name unless both are declared."""
    meanings: dict[str, Meaning] = {}
    for name in names.functions:
        meanings[spelled(name)] = Meaning("call", name=name)
    for name, expr in names.parameters.items():
        meanings[spelled(name)] = Meaning("value", expr)
    for name in sorted(names.coordinates):
        meanings[spelled(name)] = Meaning("value", coordinate(name))
    twins: dict[str, Meaning] = {}
    for word, meaning in meanings.items():
        match = _NUMBERED.fullmatch(word)
        if match is not None:
            twin = f"{match[1]}{'' if match[2] else '_'}{match[3]}"
            if twin not in meanings and _built_in(twin) is None:
                twins[twin] = meaning
    return {**twins, **meanings}


def why_invalid(name: str) -> str | None:
    """Return why ``name`` may not be declared as a coordinate, parameter or function; None if it may."""
    if not isinstance(name, str):
        return f"a name is text, not {type(name).__name__}"
    if not name:
        return "the name is empty"
    if len(name) > MAX_NAME:
        return f"the name has {len(name)} letters; at most {MAX_NAME} are read"
    odd = None if _PLAIN.fullmatch(name) else check_name_characters(name)
    if odd is not None:
        return odd
    if name[0].isdigit() or name[0] == "_":
        return f"the name `{name}` begins with `{name[0]}`; a name begins with a letter"
    word = spelled(name)
    if word in _RESERVED:
        return f"`{name}` is reserved: it means {_RESERVED[word]}"
    if word in ELEMENTARY or word in OPERATORS:
        return f"`{name}` is reserved: it is the name of a function"
    return None


_CONSTANT = "give the constant a name: `parameters: {C: real}`, and `... = C`"
#: Words of programs and of prose; each gets its own advice unless it is declared.
FOREIGN: dict[str, str] = {
    **dict.fromkeys(("const", "constant", "konst", "cst", "cte"), _CONSTANT),
    **dict.fromkeys(("and", "or", "if", "else"), "give each relation its own text"),
    "not": "write `=`, `<=`, `>=`, `<` or `>`", "in": "write a chain `0 <= x <= L`", "is": "write `=`",
    "lambda": "a text is mathematics, not code", "True": "write an equation", "False": "write an equation",
    "None": "write an equation, or leave the field out", "nan": "write a number", "NaN": "write a number",
    "inf": "leave that bound out", "oo": "leave that bound out", "tg": "write `tan`, or `t g` for the product",
    **dict.fromkeys(("distance", "dist", "norm"), "a distance is a link: `{type: link, between: [A, B], length: 2}`"),
}  # fmt: skip
#: What is written in place of a letter that people use for something else.
_ADVICE = {"e": "write `E` for Euler's number, or `exp(x)` for its powers",
           "d": "write the differential of `x` as `dx`, its velocity as `xdot`, and d/dt (x y) as `diff(x y, t)`",
           **dict.fromkeys(("dot", "ddot"), "write the velocity of `x` as `xdot`")}  # fmt: skip
#: Names of units: a number has none here.
UNITS = frozenset({
    "km", "m", "dm", "cm", "mm", "um", "nm", "in", "inch", "ft", "kg", "g", "mg", "lb", "s", "ms", "min", "h", "Hz",
    "N", "kN", "Nm", "J", "kJ", "W", "rad", "rpm", "Pa", "K", "mol",
})  # fmt: skip
_NEAR = 200


def unknown_name(word: str, lookup: Lookup, column: int, called: bool) -> UnknownNameError:
    """Return why a word is not known, with the nearest name or advice."""
    what = f"there is no function `{word}`" if called else f"`{word}` is not declared"
    near = None if word in FOREIGN or word in _ADVICE else _nearest(word, lookup, called)
    if word in FOREIGN:
        hint = FOREIGN[word]
        what = f"`{word}` is not declared" if hint is _CONSTANT else f"`{word}` has no meaning in a text"
    elif word in _ADVICE or near:
        hint = _ADVICE.get(word, f"did you mean `{near}`?")
    elif called:
        functions = [*list(lookup.names.functions)[:8], *(f for f in ELEMENTARY if f not in SYNONYMS)]
        hint = f"the functions are {', '.join(functions)}"
    else:
        listed = ", ".join(lookup.declared[:8]) + (", ..." if len(lookup.declared) > 8 else "")
        hint = f"the declared names are {listed}" if listed else "no names are declared"
    return UnknownNameError(what, column, hint)


def _nearest(word: str, lookup: Lookup, called: bool) -> str | None:
    """Return the known name that looks most like ``word``."""
    target, declared, coordinates = spelled(word), lookup.declared, lookup.names.coordinates
    same = lookup.unmarked.get(unmarked(word))
    if same is not None:
        return same
    pool = [*lookup.names.functions, *ELEMENTARY] if called else [*declared, "pi"]
    pool += ["d" + name for name in coordinates] if target.startswith("d") else []
    pool += [name + "dot" for name in coordinates] if target.endswith("dot") else []
    if len(pool) > _NEAR:  # keep the comparison short in a scene of thousands of names
        alike = (n for n in pool if abs(len(n) - len(target)) < 2 and (n[:1] == target[:1] or n[1:] == target[1:]))
        pool = list(islice(alike, _NEAR))
    return closest(target, pool, 0.6 if called else 0.5) or closest(target, [*declared[:_NEAR], *ELEMENTARY], 0.7)
