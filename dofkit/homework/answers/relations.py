"""Reads the relations of an answer in every possible way, with the names that the answer introduces itself."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.expressions.text import AmbiguousError, Comparison, Names, UnknownNameError, parse_relations
from dofkit.expressions.text.names import in_words
from dofkit.expressions.tree import PI, Expr, coordinate, nodes, num, parameter
from dofkit.homework.answers.declared import DeclaredNames, usual_name
from dofkit.homework.answers.notation import Script
from dofkit.homework.answers.pieces import Pieces, pieces_of, plainer
from dofkit.homework.answers.vocabulary import AnswerNames
from dofkit.homework.judgement import DoubtError
from dofkit.scene.added_equations import Read, as_text

#: Ways to read an answer.
MOST_READINGS = 8
_RELATION = re.compile(r"[=<>≤≥]")
#: `1/2(m v^2)` as (1/2)*(m v^2): the usual reading of a quotient of two numbers before a factor.
_HALF = re.compile(r"\(\d+/\d+\)\*\(")
#: Usual names of constants of integration.
_OF_INTEGRATION = re.compile(r"[CcKk](?:_?\d)?|[A-Za-z]+_?0|const\w*|konst\w*|c[st]t?e?")
_DEFINITION = re.compile(r"\s*(?P<name>\\?[A-Za-zα-ω]+(?:_\w+)?)\s*(?:\^\s*\{?2\}?|²)?\s*:?=(?!=)(?P<value>[^=]+)\Z")
_WORDS = re.compile(r"\\?[A-Za-zα-ωΑ-Ω]+(?:_\w+)?")
_FUNCTION_FIRST = re.compile(r"\s*\w+\((?P<inside>[^()]+)\)\*")
_SIGNS, _PLUS, _MINUS = re.compile("[±∓]"), re.compile("±"), re.compile("∓")


def is_constant_name(name: str) -> bool:
    """Return whether a name is usual for a constant of integration: C, k_1, x_0, const."""
    return _OF_INTEGRATION.fullmatch(name) is not None


class AnswerReading(NamedTuple):
    """One way to read an answer.

    ``bare``: for each relation whether it has no sign such as `=`; ``undeclared``: names that the answer introduces;
    ``moving``: undeclared names whose derivatives occur; ``derived``: whether arrows lead from each equation to the
    next; ``places``: the columns of undeclared names; ``rank``: the number of less usual interpretations; ``rounded``:
    whether it contains decimals that may be rounded.
    """

    relations: tuple[Comparison, ...]
    bare: tuple[bool, ...]
    undeclared: tuple[str, ...] = ()
    moving: frozenset[str] = frozenset()
    derived: bool = False
    places: Mapping[str, int] = {}
    rank: int = 0
    rounded: bool = False

    @property
    def text(self) -> str:
        """The relations as text in the grammar of scenes."""
        return "; ".join(as_text(c) for c in self.relations)

    @property
    def claim(self) -> AnswerReading:
        """The reading with only the last relation, to which arrows lead."""
        return self._replace(relations=self.relations[-1:], bare=self.bare[-1:], derived=False)

    @property
    def symbols(self) -> set[Expr]:
        """All symbols of the relations."""
        return {s for c in self.relations for e in (c.left, c.right) for s in e.symbols}

    @property
    def on_coordinates(self) -> bool:
        """Whether the relations contain coordinates of the scene."""
        return any(s.args[0] != "parameter" and s.args[-1] not in self.undeclared for s in self.symbols)

    def with_own(self, names: Iterable[str]) -> AnswerReading:
        """Return the reading with the given coordinates as undeclared names."""
        used = {n: {s.args[0] for s in self.symbols if s.args[-1] == n} for n in names}
        moving = frozenset(n for n, kinds in used.items() if kinds - {"coordinate"})
        still = {coordinate(n): parameter(n) for n, kinds in used.items() if kinds and n not in moving}
        relations = tuple(c.substituted(still) for c in self.relations)
        undeclared = (*self.undeclared, *(n for n, kinds in used.items() if kinds))
        return self._replace(relations=relations, undeclared=undeclared, moving=self.moving | moving)

    def read(self, constants: frozenset[str] = frozenset()) -> Read:
        """Return the reading as equations for a scene; ``constants``: names of constants of integration."""
        moving = any(s.args[0] not in ("coordinate", "parameter", "time") for s in self.symbols)
        return Read(tuple(as_text(c) for c in self.relations), constants, self.text, moving)


def with_explained_names(readings: Iterable[AnswerReading], names: DeclaredNames) -> list[AnswerReading]:
    """Return the readings whose undeclared names can be explained.

    They may be constants of integration, other names of declared constants that the answer does not mention, or names
    that several of its relations define. Raises UnknownNameError if there is no such reading.
    """
    kept, failure = [], None
    for reading in readings:
        strange = [name for name in reading.undeclared if name not in names.also and not is_constant_name(name)]
        sums = [c.left.symbols | c.right.symbols for c in reading.relations]
        used = {str(s.args[1]) for symbols in sums for s in symbols if len(s.args) > 1}
        counts = {name: sum(any(s.args[-1] == name for s in symbols) for symbols in sums) for name in strange}
        single = [name for name in strange if counts[name] < 2]
        free = [name for name in names.constants if name not in used]
        if not single or (len(strange) <= len(free) and not reading.moving):
            kept.append(reading)
        elif failure is None:
            every = [*sorted(names.with_also.coordinates), *names.names.parameters]
            hint = f"the declared names are {', '.join(every[:12])}"
            failure = UnknownNameError(f"`{single[0]}` is not declared", reading.places.get(single[0], 1), hint)
    if not kept and failure is not None:
        raise failure
    return kept


def readings_of(
    answer: object, vocabulary: AnswerNames, lead: Callable[[Script], Script] | None = None
) -> list[AnswerReading]:
    """Return all readings of an answer; ``lead`` removes a text before each of its equations.

    Raises TextError with its column in the original text.
    """
    pieces = pieces_of(answer, vocabulary.names)
    defined = {word for script in pieces.scripts for word in _defined_constants(script, vocabulary)}
    vocabulary = replace(vocabulary, undeclared=(*vocabulary.undeclared, *sorted(defined)))
    if lead is not None:
        pieces = replace(pieces, scripts=tuple(lead(piece) for piece in pieces.scripts))
    return list(_readings(pieces, vocabulary))


def _readings(pieces: Pieces, vocabulary: AnswerNames) -> Iterator[AnswerReading]:
    """Yield all combinations of readings of the equations. Raises DoubtError if there are too many."""
    readings: list[tuple[tuple[Comparison, ...], tuple[bool, ...], AnswerNames]] = [((), (), vocabulary)]
    for n, script in enumerate(pieces.scripts):
        more = []
        script = plainer(script, vocabulary.names)
        if pieces.derived and n + 1 < len(pieces.scripts) and not _readable(script, vocabulary):
            continue
        for relations, bare, extended in readings:
            for more_relations, grown in _spliced_readings(script, extended):
                alone = len(more_relations) == 1 and not _RELATION.search(script.text)
                more.append(((*relations, *more_relations), (*bare, *[alone] * len(more_relations)), grown))
        readings = more
        if len(readings) > MOST_READINGS:
            raise DoubtError("it can be read in many ways.", script.columns[0], "write parentheses")
    for relations, bare, extended in readings:
        informative = [c.left != c.right or not extended.usual for c in relations]
        if any(informative) and not all(informative):
            relations = tuple(c for c, kept in zip(relations, informative, strict=True) if kept)
            bare = tuple(b for b, kept in zip(bare, informative, strict=True) if kept)
        yield AnswerReading(
            relations,
            bare,
            extended.undeclared,
            extended.moving,
            pieces.derived,
            extended.places,
            extended.rank,
            _is_rounded(relations, vocabulary.names),
        )


def _is_rounded(relations: Iterable[Comparison], names: Names) -> bool:
    """Return whether decimals occur that may be rounded: 0.67 and 4.9, not 0.7, nor a declared value."""
    terms = [n for c in relations for e in (c.left, c.right) for n in nodes(e)]
    degrees = [num(180) * n.args[1] / PI for n in terms if n.op == "fn" and n.args[0] in ("sin", "cos", "tan")]
    exact = [e.args[0] for e in names.parameters.values() if e.op == "num"]
    numbers = [n for e in terms if e.op == "num" and (n := abs(e.args[0])) not in exact]
    decimals = [n for n in numbers if n.denominator % 5 == 0 and 10**6 % n.denominator == 0]
    angles = [d.args[0].denominator for d in degrees if d.op == "num"]
    return any(d > 1 for d in angles) or any(max(n.numerator, n.denominator) > 10 for n in decimals)


def _readable(script: Script, vocabulary: AnswerNames) -> bool:
    try:
        return bool(list(_spliced_readings(script, vocabulary)))
    except TextError:
        return False


def _spliced_readings(script: Script, vocabulary: AnswerNames) -> Iterator[tuple[tuple[Comparison, ...], AnswerNames]]:
    """Yield (relations, extended vocabulary) for every reading of one equation."""
    if vocabulary.signs_apart and _SIGNS.search(script.text):
        for up, down in ("+-", "-+"):
            yield from _spliced_readings(script.replaced(_PLUS, up).replaced(_MINUS, down), vocabulary)
        return
    script = _with_both_signs(script)
    while True:
        try:
            relations = parse_relations(script.text, vocabulary.as_names())
            if not (other := _of_other_meaning(script, vocabulary)):
                yield relations, vocabulary
                return
            usual = {word: e for word, e in vocabulary.usual.items() if word not in other}
            vocabulary = replace(vocabulary, usual=usual, undeclared=(*vocabulary.undeclared, *other))
        except AmbiguousError as error:
            if not error.readings:
                raise script.moved(error) from None
            start, end = error.span
            kind = error.message.rsplit("`", 1)[-1]
            for n, reading in enumerate(error.readings):
                if vocabulary.choice.get(kind, n) != n:
                    continue
                reading = f" {reading} "
                supposing = (n > 0 and _HALF.match(error.readings[0])) or _is_of_constants(reading, vocabulary.names)
                rank = vocabulary.rank + bool(supposing)
                chosen = replace(vocabulary, choice={**vocabulary.choice, kind: n}, rank=rank)
                yield from _spliced_readings(script.spliced(start - 1, end - 1, reading), chosen)
            return
        except UnknownNameError as error:
            grown = vocabulary.with_word(error.name)
            yield from _as_frequency(script, vocabulary, grown)
            if grown is None or grown == vocabulary:
                moved = script.moved(error)
                raise UnknownNameError(moved.message, moved.column, moved.hint) from None
            column = script.moved(error).column or 1
            places = {**dict.fromkeys(set(grown.undeclared) - set(vocabulary.undeclared), column), **vocabulary.places}
            vocabulary = replace(grown, places=places)
        except TextError as error:
            raise script.moved(error) from None


def _is_of_constants(reading: str, names: Names) -> bool:
    """Return whether a reading begins with a function of constants, as `sin(omega) t` for `sin omega t`."""
    function = _FUNCTION_FIRST.match(reading)
    moving = {"t", *names.coordinates}
    return function is not None and moving.isdisjoint(in_words(word) for word in _WORDS.findall(function["inside"]))


def _as_frequency(
    script: Script, vocabulary: AnswerNames, grown: AnswerNames | None
) -> Iterator[tuple[tuple[Comparison, ...], AnswerNames]]:
    """Yield the readings in which omega is a frequency, and not the velocity of the only angle."""
    if vocabulary.frequencies and grown is not None and "omega" in set(grown.usual) - set(vocabulary.usual):
        yield from _spliced_readings(
            script, replace(vocabulary, undeclared=(*vocabulary.undeclared, "omega"), rank=vocabulary.rank + 1)
        )


def _defined_constants(script: Script, vocabulary: AnswerNames) -> Iterator[str]:
    """Yield a usual name that an equation defines by constants alone, as in `omega^2 = g/l`."""
    match = _DEFINITION.match(script.text)
    words = set() if match is None else {in_words(w.strip("\\")) for w in _WORDS.findall(match["value"])}
    moving = {"t", *vocabulary.names.coordinates}
    if match is not None and words and not any(w in moving or "dot" in w for w in words):
        name = in_words(match["name"].strip("\\"))
        if usual_name(name, vocabulary.names) is not None:
            yield name


def _of_other_meaning(script: Script, vocabulary: AnswerNames) -> tuple[str, ...]:
    """Return the words that are not usual names here, because the quantity also occurs under its declared name."""
    if not vocabulary.usual:
        return ()
    plain_names = replace(vocabulary, usual={}, undeclared=(*vocabulary.undeclared, *vocabulary.usual))
    relations = parse_relations(script.text, plain_names.as_names())
    written = {s for c in relations for e in (c.left, c.right) for s in e.symbols}
    read = parse_relations(script.text, vocabulary.as_names())
    if all(c.left == c.right for c in read):
        return ()  # `v = xdot` says what the name means
    return tuple(word for word, quantity in vocabulary.usual.items() if quantity in written)


def _with_both_signs(script: Script) -> Script:
    """Return an equation with `±` as a product: `y = ± sqrt(a)` is (y - sqrt(a)) (y + sqrt(a)) = 0."""
    if not _SIGNS.search(script.text):
        return script
    sides = script.text.split("=")
    if len(sides) != 2:
        return script
    product = "*".join(f"(({upper}) - ({other}))" for upper, other in (_signed(sides, "+-"), _signed(sides, "-+")))
    return Script(f"{product} = 0", (script.columns[0],) * (len(product) + 5))


def _signed(sides: list[str], signs: str) -> list[str]:
    return [side.replace("±", signs[0]).replace("∓", signs[1]) for side in sides]
