"""Reads answers about equations of motion: a value or equations, in declared or newly defined coordinates.

If an answer contains `x = l sin(theta), y = -l cos(theta)`, which defines theta, the right motion is that of the scene
with theta as a further coordinate and these relations as constraints, from which x and y are eliminated.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from dofkit.base.errors import TextError
from dofkit.expressions import tree as ex
from dofkit.expressions.text import Comparison, spelled, to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.notation import Script
from dofkit.homework.answers.pieces import with_energies
from dofkit.homework.answers.prose import pattern
from dofkit.homework.answers.relations import AnswerReading, readings_of, with_explained_names
from dofkit.homework.answers.vocabulary import AnswerNames
from dofkit.homework.judgement import Given, Reading
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import extended, offered
from dofkit.homework.key.own_names import renamed, with_constants

#: Names that an answer may use for multipliers.
_MULTIPLIER = re.compile(r"(lambda|lam|mu|Lambda)_?\w{0,3}|(multiplier|mult)_?\d{0,2}")
#: The name before a value: `L =`, `p_theta =`, `L = T - V =`.
_LEADING = pattern("motion: leading")


#: `= const.` after a value; the words for 0.
_CONSTANT = re.compile(r"(?<!=)=(?!=)\s*(?:const|konst|cte|cst)\w*\.?\s*\Z", re.IGNORECASE)
_ZERO = re.compile(r"\A\s*(?:zero|null|zéro|cero)\s*\.?\s*\Z", re.IGNORECASE)


@dataclass(frozen=True)
class PosedMotion:
    """A reading with the ``key`` of the scene, to which the coordinates that the answer defines are added.

    ``multipliers``: symbols of the answer's names for them; ``guesses``: readings with declared constants in place of
    undeclared names; ``strange``: an undeclared name, or an empty text.
    """

    key: Key
    relations: tuple[Comparison, ...]
    multipliers: tuple[Expr, ...] = ()
    guesses: tuple[PosedMotion, ...] = ()
    strange: str = ""

    @property
    def value(self) -> Expr:
        """The expression of an answer that is a value."""
        return self.relations[0].left


def motion_readings(answer: Given, names: DeclaredNames, value: bool) -> list[Reading]:
    """Return every reading of an answer, as a value if ``value``, else as equations. Raises TextError."""
    vocabulary = AnswerNames(names.with_also, accelerations=True, frequencies=not value)
    answer = with_energies(answer, names.with_also) if value else answer
    readings = readings_of(answer, vocabulary, _without_lead if value else None)
    claims = [reading.claim if reading.derived else reading for reading in readings]
    sides = [side for reading in claims for side in (_sides(reading) if value else [reading])]
    for side in sides if value else ():
        if sum(side.bare) != 1:
            raise TextError("one expression is needed here", 1, "write the expression alone, such as L = ...")
    sides = with_explained_names([s._replace(undeclared=tuple(_strange(s, value))) for s in sides], names) and sides
    return [Reading(s, _shown_reading(s, value), s.rank, not _strange(s, value), s.rounded) for s in sides]


def _strange(reading: AnswerReading, value: bool) -> list[str]:
    """Return the undeclared names of a reading that are not multipliers."""
    return [n for n in reading.undeclared if value or n in reading.moving or not _MULTIPLIER.fullmatch(spelled(n))]


def _shown_reading(reading: AnswerReading, value: bool) -> str:
    if value and len(reading.relations) == 1:
        return to_text(reading.relations[0].left)
    return reading.text


def _sides(reading: AnswerReading) -> list[AnswerReading]:
    """Return each side of a value `A = B` as a separate reading, for each must be right; else the reading alone."""
    reading = _named_value(reading)
    are_joined = all(c.right == d.left for c, d in pairwise(reading.relations))
    if any(reading.bare) or not are_joined or any(c.relation != "=" for c in reading.relations):
        return [reading]
    sides = [reading.relations[0].left, *(c.right for c in reading.relations)]
    return [reading._replace(relations=(Comparison(side, "=", ZERO, 1),), bare=(True,)) for side in sides]


def _without_lead(script: Script) -> Script:
    """Return a value without the names before it, as in `L = T - V = ...`."""
    while (match := _LEADING.match(script.text)) is not None and match.end() < len(script.text):
        script = script.cut(match.end())
    return script.replaced(_CONSTANT, "").replaced(_ZERO, "0")


def posed_motion(reading: AnswerReading, key: Key, value: bool) -> PosedMotion:
    """Return a reading with its key. Raises DoubtError if it defines coordinates that miss configurations."""
    reading = _defining_constants(reading, key)
    strange = _strange(reading, value)
    multipliers = tuple(ex.parameter(n) for n in reading.undeclared if n not in strange)
    used = {n for c in reading.relations for n in _names(c)} & key.also.keys()
    other = (*strange, *sorted(used))
    defining = [c for c in reading.relations if c.relation == "=" and _defines(c, other)]
    claims = [c for c in reading.relations if c not in defining]
    defined = {n for c in defining for n in other if n in _names(c)}
    if value and len(claims) != 1:
        raise TextError("one expression is needed here", 1, "write the expression alone, such as L = ...")
    if used - defined:
        key = offered(key, sorted(used - defined))
        other = tuple(name for name in other if name not in used - defined)
    if defined and defined == set(other):
        key = extended(key, other, defining)
    if defined == set(other) and claims:
        table = {ex.parameter(n): ex.coordinate(n) for n in other}
        return PosedMotion(key, tuple(c.substituted(table) for c in claims), multipliers)
    guesses = tuple(
        PosedMotion(key, guess.relations, multipliers)
        for guess, _ in renamed(reading._replace(undeclared=other), key.scene, key.declared.constants)
    )
    return PosedMotion(key, reading.relations, multipliers, guesses, other[0])


def _defining_constants(reading: AnswerReading, key: Key) -> AnswerReading:
    """Return a reading without undeclared constants that it defines, as in `omega^2 = g/l`."""
    still = [n for n in reading.undeclared if n not in reading.moving]
    alone = [
        b and all(s.args[0] == "parameter" for s in c.left.symbols)
        for c, b in zip(reading.relations, reading.bare, strict=True)
    ]
    whole = len(reading.relations) > 1 and not any(alone)
    kept = with_constants(reading.relations, still, key.scene) if whole else list(reading.relations)
    if len(kept) == len(reading.relations):
        return reading
    named = {n for c in kept for n in _names(c)}
    bare = [b for c, b in zip(reading.relations, reading.bare, strict=True) if b]
    return reading._replace(
        relations=tuple(kept),
        bare=tuple(bare + [False] * (len(kept) - len(bare))),
        undeclared=tuple(n for n in reading.undeclared if n in named),
    )


def _named_value(reading: AnswerReading) -> AnswerReading:
    """Return a reading with the value alone if an undeclared name is before it: `l = m r^2 phidot`."""
    first = reading.relations[0]
    name = str(first.left.args[1]) if first.left.op == "sym" and first.relation == "=" else ""
    is_single = len(reading.relations) == 1 and first.left not in first.right.symbols
    if not is_single or name not in reading.undeclared or name in reading.moving:
        return reading
    undeclared = tuple(n for n in reading.undeclared if n != name)
    value = Comparison(first.right, "=", ZERO, first.column)
    return reading._replace(relations=(value,), bare=(True,), undeclared=undeclared)


def _names(c: Comparison) -> set[str]:
    return {str(s.args[1]) for e in (c.left, c.right) for s in e.symbols if len(s.args) > 1}


def _defines(c: Comparison, undeclared: Sequence[str]) -> bool:
    """Return whether a relation defines undeclared names by coordinates, without velocities."""
    symbols = c.left.symbols | c.right.symbols
    return (
        bool(_names(c) & set(undeclared))
        and all(s.args[0] in ("coordinate", "parameter", "time") for s in symbols)
        and any(s.args[0] == "coordinate" and s.args[1] not in undeclared for s in symbols)
    )
