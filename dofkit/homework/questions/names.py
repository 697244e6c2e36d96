"""Questions whose answer is a set of names: generalized coordinates, and redundant constraints."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.words import alternatives, is_none, lists_only, names_of
from dofkit.homework.judgement import Given, Judgement, Reading, Sentence, needs_review, right, wrong
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import chosen_coordinates, with_chosen
from dofkit.homework.key.selection import determine, is_redundant_set
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences import say


class Coordinates(QuestionBase):
    """The names of a complete set of independent generalized coordinates."""

    ask: Literal["coordinates"] = Field(description="an independent and complete set of generalized coordinates")

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        offered = [*names.coordinates, *names.also]
        chosen = [chosen_coordinates(part, names) for part in alternatives(answer, offered, "coordinate")]
        return [Reading(choice, ", ".join(choice.names) or "none", certain=not choice.undeclared) for choice in chosen]

    def solution(self, key: Key) -> Sentence:
        names = key.report.generalized_coordinates
        return "" if names is None else say("A correct answer is {text}.", text=", ".join(names) or "none")

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        dof, text, names = key.report.dof, reading.text, list(reading.value.names)
        key = with_chosen(key, reading.value)
        if dof is None:
            return needs_review(text, "the number of degrees of freedom is not known for certain.")
        if len(names) < dof:
            return wrong(text, "INCOMPLETE")
        independent = len(names) == dof and key.decided(determine, names)
        if independent is None:
            return needs_review(text, "it could not be decided whether these coordinates are independent.")
        if not independent:
            return wrong(text, "DEPENDENT")
        return right(text)


class Redundant(QuestionBase):
    """A maximal redundant set of constraints: without the whole set the motion is the same."""

    ask: Literal["redundant"] = Field(description="a largest set of redundant constraints")

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        constraint_names = list(names.constraints)
        return [
            self._reading(part, constraint_names, names)
            for part in alternatives(answer, constraint_names, "constraint")
        ]

    def _reading(self, answer: Given, constraint_names: list[str], names: DeclaredNames) -> Reading:
        none = is_none(answer, lambda part: lists_only(part, constraint_names), constraint_names, every=True)
        chosen = [] if none else names_of(answer, constraint_names, "constraint")
        return Reading(chosen, ", ".join(chosen) or "none")

    def solution(self, key: Key) -> Sentence:
        redundant = key.report.redundant
        return "" if redundant is None else say("A correct answer is {text}.", text=", ".join(redundant) or "none")

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        names, report, text = reading.value, key.report, reading.text
        if report.dof is None or report.redundant is None:
            return needs_review(text, "it is not known for certain which constraints are redundant.")
        if set(names) == set(report.redundant):
            return right(text)
        if not names:
            return wrong(text, "REDUNDANT_MISSED")
        dropped = key.decided(is_redundant_set, names)
        if dropped is None:
            return needs_review(text, "it could not be decided whether these constraints may be removed together.")
        if not dropped:
            return wrong(text, "NOT_REDUNDANT")
        if len(names) < len(report.redundant):
            why = "These constraints may be removed, but more can be removed with them."
            return wrong(text, "REDUNDANT_MISSED", why=why)
        return right(text)
