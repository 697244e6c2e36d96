"""Coordinates that the scene does not contain: those that an assignment offers, or an answer defines."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from dofkit.base.errors import Fault, TextError
from dofkit.classification.dependence.implication import follows
from dofkit.classification.freedom.preparation import prepared
from dofkit.expressions.text import Comparison, parse_expression, to_text, why_invalid
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.relations import readings_of
from dofkit.homework.answers.vocabulary import AnswerNames
from dofkit.homework.answers.words import is_none, lists_only, names_of
from dofkit.homework.judgement import DoubtError, Given
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_names import restrictions
from dofkit.scene.added_equations import Read, as_text, with_equations
from dofkit.scene.lowering import lower

_TITLE = re.compile(r"\bq(?:_?\{?\w?\}?)?\s*=(?=\s*\\?\w+\s*\$?(?:[,;.]|\Z))")
_WITH = r"(?:with|where|mit|wobei|avec|où|con|donde|dove|such that|sodass|so that)\b"
_BEGINS = (re.compile(rf"[,;:(]?\s*\b{_WITH}"), re.compile(r"[,;:(]"))


class ChosenCoordinates(NamedTuple):
    """The coordinates that an answer names, and the undeclared ones that it defines by relations."""

    names: tuple[str, ...]
    undeclared: tuple[str, ...] = ()
    relations: tuple[Comparison, ...] = ()


def chosen_coordinates(answer: Given, names: DeclaredNames) -> ChosenCoordinates:
    """Return the coordinates that an answer names, or names and defines. Raises TextError for undefined names."""
    every = [*names.coordinates, *names.also]
    if is_none(answer, lambda part: lists_only(part, every), every):
        return ChosenCoordinates(())
    try:
        return ChosenCoordinates(tuple(names_of(answer, every, "coordinate")))
    except TextError:
        if not isinstance(answer, str) or (defined := _defined(answer, names)) is None:
            raise
        return defined


def _defined(answer: str, names: DeclaredNames) -> ChosenCoordinates | None:
    """Return the coordinates of `theta, where x = l sin(theta), y = -l cos(theta)`, or None for anything else."""
    answer = _TITLE.sub(lambda m: " " * len(m[0]), answer)
    cut = _BEGINS[0].search(answer) or _BEGINS[1].search(answer)
    if "=" not in answer or cut is None or "=" in answer[: cut.start()]:
        return None
    definitions = answer[cut.end() :].rstrip().removesuffix(")") if cut[0][0] == "(" else answer[cut.end() :]
    reading = readings_of(definitions, AnswerNames(names.names))[0]
    if reading.moving or not reading.undeclared or any(reading.bare):
        return None
    chosen = names_of(answer[: cut.start()], [*names.coordinates, *reading.undeclared], "coordinate")
    return ChosenCoordinates(tuple(chosen), reading.undeclared, reading.relations)


def with_chosen(key: Key, chosen: ChosenCoordinates) -> Key:
    """Return the key with the coordinates that an answer defines, or names and the assignment offers."""
    if chosen.undeclared:
        return extended(key, chosen.undeclared, chosen.relations)
    offers = [name for name in chosen.names if name in key.also]
    return offered(key, offers) if offers else key


def extended(key: Key, names: Sequence[str], relations: Sequence[Comparison]) -> Key:
    """Return the key with coordinates that an answer defines. Raises DoubtError if they may miss configurations."""
    consequences = restrictions(relations, names, key.scene)
    if consequences is None or not all(implied(key, f"{to_text(e)} = 0") for e in consequences):
        raise DoubtError("the coordinates defined in the answer may not cover all configurations.", 1, None)
    return key.with_own(tuple(names), tuple(as_text(c) for c in relations))


def offered(key: Key, names: Sequence[str]) -> Key:
    """Return the key with coordinates that the assignment offers.

    An angle atan2(a, b) is defined by a = r sin(angle), b = r cos(angle) if the scene implies a^2 + b^2 = r^2.
    """
    texts = [text for name in names for text in _equations(key, name)]
    return key.with_own(tuple(names), tuple(texts))


def _equations(key: Key, name: str) -> list[str]:
    e = parse_expression(key.also[name], key.declared.names)
    if e.op == "fn" and e.args[0] == "atan2":
        a, b = (to_text(part) for part in e.args[1:])
        for radius, value in key.declared.names.parameters.items():
            positive = value.args[0] > 0 if value.op == "num" else key.scene.parameters.get(radius) == "positive"
            if positive and implied(key, f"({a})^2 + ({b})^2 = {radius}^2"):
                return [f"{a} = {radius}*sin({name})", f"{b} = {radius}*cos({name})"]
    return [f"{name} = {to_text(e)}"]


def implied(key: Key, text: str) -> bool:
    """Return whether the scene's constraints imply a relation (False if undecided)."""
    return key.once(("implied", text), lambda: _follows(key, text))


def _follows(key: Key, text: str) -> bool:
    posed = with_equations(key.scene, Read((text,), frozenset(), text, False), "offered")
    reduced, setting = prepared(lower(posed))
    *others, answer_relation = reduced
    conditions = [n for r in others for n in r.normals]
    return all(follows(n, conditions, setting) is True for n in answer_relation.normals)


def faults_of_own(key: Key) -> Iterator[Fault]:
    """Yield the faults of the additional coordinates (``also``) that an assignment offers."""
    for name, text in key.also.items():
        odd = why_invalid(name)
        if odd is not None:
            yield Fault(odd, (name,), hint="choose another name")
        elif key.declared.names.lookup.meaning(name) is not None:
            yield Fault(f"`{name}` is a name of the scene already", (name,), hint="choose another name")
        else:
            try:
                parse_expression(text, key.declared.names)
            except TextError as error:
                yield Fault(error.message, (name,), column=error.column, hint=error.hint)
