"""An answer about equations of motion, read: a value or equations, in the scene's coordinates or the student's own.

`x = l sin(theta), y = -l cos(theta)` in an answer defines theta: then the right motion is that of the scene with theta
as one more coordinate and these relations as constraints, from which x and y are eliminated.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from dofkit.base.errors import TextError
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import Comparison, spelled, to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.notation import Script
from dofkit.homework.answers.pieces import with_energies
from dofkit.homework.answers.relations import AnswerNames, AnswerReading, readings_of, with_explained_names
from dofkit.homework.judgement import Given, Reading
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import extended, offered
from dofkit.homework.key.own_names import renamed, with_constants

#: Names of an answer's own for multipliers.
_MULTIPLIER = re.compile(r"(lambda|lam|mu|Lambda)_?\w{0,3}|(multiplier|mult)_?\d{0,2}")
#: What a value is called: `L =`, `p_theta =`, `L = T - V =`.
_LEADING = re.compile(
    r"\s*(?:(?:L|T|V|U|E|H|ℒ|\\mathcal\s*\{?L\}?|\\mathscr\s*\{?L\}?|Lagrangian|Lagrangefunktion|p|P|Q|F)(?:_?\{?\\?\w{0,12}\}?)?"
    r"(?:\s*\([^()=]*\))?(?:\s*[-+]\s*[TVUE](?:_\w+)?)*"
    r"|(?:d|∂)\s*L\s*/\s*(?:d|∂)\s*[^\s=]{1,20}|\\frac\s*\{\\?[a-z]*\s*L\s*\}\s*\{[^=]{1,40}\})\s*=(?!=)\s*"
)


#: That a value is constant, said after it; nothing in words.
_CONSTANT = re.compile(r"(?<!=)=(?!=)\s*(?:const|konst|cte|cst)\w*\.?\s*\Z", re.IGNORECASE)
_ZERO = re.compile(r"\A\s*(?:zero|null|zéro|cero)\s*\.?\s*\Z", re.IGNORECASE)


@dataclass(frozen=True)
class PosedMotion:
    """A reading beside the scene: ``key`` has the coordinates that the answer defines.

    ``multipliers``: the answer's names for them; ``guesses``: what undeclared names may mean; ``strange``: one of them.
    """

    key: Key
    relations: tuple[Comparison, ...]
    multipliers: tuple[Expr, ...] = ()
    guesses: tuple[PosedMotion, ...] = ()
    strange: str = ""

    @property
    def value(self) -> Expr:
        """The expression, where one is asked for."""
        return self.relations[0].left


def motion_readings(answer: Given, names: DeclaredNames, value: bool) -> list[Reading]:
    """Return every way to read an answer, as a value or as equations. Raises TextError."""
    vocabulary = AnswerNames(names.with_also, accelerations=True, frequencies=not value)
    answer = with_energies(answer, names.with_also) if value else answer
    ways = readings_of(answer, vocabulary, _without_lead if value else None)
    claims = [way.claim if way.derived else way for way in ways]
    sides = [side for way in claims for side in (_sides(way) if value else [way])]
    for side in sides if value else ():
        if sum(side.bare) != 1:
            raise TextError("one expression is needed here", 1, "write the expression alone, such as L = ...")
    sides = with_explained_names([s._replace(undeclared=tuple(_strange(s, value))) for s in sides], names) and sides
    return [Reading(side, _shown_reading(side, value), side.rank, not _strange(side, value)) for side in sides]


def _strange(way: AnswerReading, value: bool) -> list[str]:
    """Return the names of a reading that are not declared and no multipliers."""
    return [n for n in way.undeclared if value or n in way.moving or not _MULTIPLIER.fullmatch(spelled(n))]


def _shown_reading(way: AnswerReading, value: bool) -> str:
    if value and len(way.relations) == 1:
        return to_text(way.relations[0].left)
    return way.text


def _sides(way: AnswerReading) -> list[AnswerReading]:
    """Every side of a value told as `A = B`: they should be the same; else the reading itself."""
    way = _named_value(way)
    pairs = zip(way.relations, way.relations[1:], strict=False)
    if any(way.bare) or any(c.relation != "=" for c in way.relations) or any(c.right != d.left for c, d in pairs):
        return [way]
    sides = [way.relations[0].left, *(c.right for c in way.relations)]
    return [way._replace(relations=(Comparison(side, "=", ZERO, 1),), bare=(True,)) for side in sides]


def _without_lead(script: Script) -> Script:
    """A value without its name; each of several names, as in `L = T - V = ...`."""
    while (match := _LEADING.match(script.text)) is not None and match.end() < len(script.text):
        script = script.cut(match.end())
    return script.replaced(_CONSTANT, "").replaced(_ZERO, "0")


def posed_motion(way: AnswerReading, key: Key, value: bool) -> PosedMotion:
    """Return a reading beside the scene. Raises TextError if it defines coordinates that leave configurations out."""
    way = _defining_constants(way, key)
    strange = _strange(way, value)
    multipliers = tuple(ex.parameter(n) for n in way.undeclared if n not in strange)
    used = {n for c in way.relations for n in _names(c)} & key.also.keys()
    other = (*strange, *sorted(used))
    defining = [c for c in way.relations if c.relation == "=" and _defines(c, other)]
    claims = [c for c in way.relations if c not in defining]
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
        return PosedMotion(key, tuple(_substituted(c, table) for c in claims), multipliers)
    guesses = tuple(
        PosedMotion(key, guess.relations, multipliers)
        for guess, _ in renamed(way._replace(undeclared=other), key.scene, key.declared.constants)
    )
    return PosedMotion(key, way.relations, multipliers, guesses, other[0])


def _defining_constants(way: AnswerReading, key: Key) -> AnswerReading:
    """Without constants of its own that it defines, `omega^2 = g/l`."""
    still = [n for n in way.undeclared if n not in way.moving]
    whole = len(way.relations) > 1 and not any(map(_of_constants, way.relations, way.bare))
    kept = with_constants(way.relations, still, key.scene) if whole else list(way.relations)
    if len(kept) == len(way.relations):
        return way
    named = {n for c in kept for n in _names(c)}
    bare = [b for c, b in zip(way.relations, way.bare, strict=True) if b]
    return way._replace(
        relations=tuple(kept),
        bare=tuple(bare + [False] * (len(kept) - len(bare))),
        undeclared=tuple(n for n in way.undeclared if n in named),
    )


def _of_constants(c: Comparison, bare: bool) -> bool:
    """Return whether it is a value of constants alone, which defines none."""
    return bare and all(s.args[0] == "parameter" for s in c.left.symbols)


def _named_value(way: AnswerReading) -> AnswerReading:
    """`l = m r^2 phidot`: a value under a name that nobody declared."""
    first = way.relations[0]
    name = str(first.left.args[1]) if first.left.op == "sym" and first.relation == "=" else ""
    if len(way.relations) > 1 or name not in way.undeclared or name in way.moving or first.left in first.right.symbols:
        return way
    undeclared = tuple(n for n in way.undeclared if n != name)
    return way._replace(
        relations=(Comparison(first.right, "=", ZERO, first.column),), bare=(True,), undeclared=undeclared
    )


def _names(c: Comparison) -> set[str]:
    return {str(s.args[1]) for e in (c.left, c.right) for s in e.symbols if len(s.args) > 1}


def _defines(c: Comparison, undeclared: Sequence[str]) -> bool:
    """Return whether it relates names of the answer's own and coordinates, without velocities."""
    symbols = c.left.symbols | c.right.symbols
    return (
        bool(_names(c) & set(undeclared))
        and all(s.args[0] in ("coordinate", "parameter", "time") for s in symbols)
        and any(s.args[0] == "coordinate" and s.args[1] not in undeclared for s in symbols)
    )


def _substituted(c: Comparison, table: Mapping[Expr, Expr]) -> Comparison:
    return Comparison(substitute(c.left, table), c.relation, substitute(c.right, table), c.column)
