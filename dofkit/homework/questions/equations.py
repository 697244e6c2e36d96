"""Questions for the equations of constraints, and for the integral of a differential constraint."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from dofkit.base.errors import Fault
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.notation import Script
from dofkit.homework.answers.relations import is_constant_name, readings_of, with_explained_names
from dofkit.homework.answers.vocabulary import AnswerNames
from dofkit.homework.answers.words import is_none
from dofkit.homework.judgement import Given, Judgement, Reading, Sentence, needs_review, right, wrong
from dofkit.homework.key.compared_equations import EquationComparison, equations_of
from dofkit.homework.key.compared_integrals import integral_judgement
from dofkit.homework.key.key import Key
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences import say
from dofkit.scene.fields import Listed


def _names(value: object) -> object:
    return (value,) if isinstance(value, str) else value


class EquationQuestion(QuestionBase):
    """Equations that express the constraint(s), given the other constraints of the scene."""

    ask: Literal["equation"] = Field(description="the equation of one constraint, or the equations of several")
    constraint: Annotated[
        tuple[str, ...], Listed, Field(min_length=1), BeforeValidator(_names, json_schema_input_type=str | list[str])
    ] = Field(description="the name of the constraint, or several names")

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        readings = with_explained_names(readings_of(answer, AnswerNames(names.with_also, accelerations=True)), names)
        return [Reading(r.with_own(names.also), r.text, r.rank, not r.undeclared, r.rounded) for r in readings]

    def solution(self, key: Key) -> Sentence:
        return say("A correct answer is {text}.", text=equations_of(key, self.constraint))

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        return EquationComparison(key, self.constraint).judgement(reading.value)


class IntegralQuestion(QuestionBase):
    """The integral of a differential constraint, with a constant of any name or without; ``none`` if there is none."""

    ask: Literal["integral"] = Field(description="the integral of a differential constraint")
    constraint: str = Field(description="the name of the constraint")

    def faults(self, key: Key) -> Iterator[Fault]:
        yield from super().faults(key)
        entry = key.constraints.get(self.constraint)
        if entry is not None and entry.form not in ("pfaffian", "nonlinear"):
            hint = "`integral` asks about a differential constraint"
            yield Fault(f"'{self.constraint}' is not a differential constraint", ("constraint",), hint=hint)

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        if is_none(answer, _says_relation):
            return [Reading(None, "none")]
        readings = readings_of(answer, AnswerNames(names.names, signs_apart=True), _undifferentiated)
        return [Reading(r, r.text, r.rank, all(map(is_constant_name, r.undeclared)), r.rounded) for r in readings]

    def solution(self, key: Key) -> Sentence:
        entry = key.constraints[self.constraint]
        if entry.holonomic is False:
            return say("It is not integrable. {reason}", reason=entry.reason)
        return "" if entry.integral is None else say("A correct answer is {text}.", text=entry.integral)

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        entry = key.constraints[self.constraint]
        if reading.value is None:
            if entry.holonomic is None:
                return needs_review("none", "it is not known whether the constraint is integrable.")
            return wrong("none", "INTEGRABLE") if entry.holonomic else right("none")
        if entry.holonomic is False:
            return wrong(reading.text, "NOT_INTEGRABLE")
        return integral_judgement(reading.value, key, self.constraint)


#: `d(x y) = 0` says that x y is constant.
_STILL = re.compile(r"\A\s*diff\((?P<whole>.*), t\)\s*=\s*0\s*\Z")


def _undifferentiated(script: Script) -> Script:
    still = _STILL.match(script.text)
    return script if still is None else script.cut(*still.span("whole"))


#: Signs of a differential or velocity: an equation that contains one is a reason, not an integral.
_DIFFERENTIAL = re.compile(r"(?<![^\W\d_])[d∂](?=[^\W\d_]|\s?\\)|dot|∧|\\(?:wedge|partial|dot)")


def _says_relation(part: str) -> bool:
    """Return whether a part of an answer is a relation between coordinates."""
    return "=" in part and _DIFFERENTIAL.search(part) is None
