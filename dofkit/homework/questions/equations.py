"""The equation of a constraint, and the finite relation that a differential one integrates to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Annotated, Literal, NamedTuple, TypeVar

from pydantic import BeforeValidator, Field

from dofkit.base.errors import Fault, SceneError, TextError
from dofkit.classification.dependence.equivalence import Sameness, compare, is_integral
from dofkit.homework.answers.words import is_none, one_text
from dofkit.homework.judgement import HALF, NOTHING, Given, Judgement, needs_review, partly, right, wrong
from dofkit.homework.key.key import Key
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.scene.added_equations import Read, read_equations, with_equations
from dofkit.scene.fields import Listed, suggestion
from dofkit.scene.lowering import lower
from dofkit.system import System

_FEEDBACK = {
    Sameness.SAME: "",
    Sameness.IRREGULAR: "It has the right solutions, but its gradient vanishes on them, as that of a square does.",
    Sameness.BRANCH: "It holds on one branch only: taking a root has lost the others.",
    Sameness.DIFFERENTIATED: "This is the differentiated constraint: it leaves the constant open, so it says less.",
    Sameness.INTEGRATED: "It is the constraint in integrated form.",
    Sameness.WITHOUT_CONSTANT: "It is the integrated form without its constant, which the initial state sets.",
    Sameness.WEAKER: "It allows more than the constraint does: something is missing.",
    Sameness.STRONGER: "It allows less than the constraint does: it says more than was asked for.",
    Sameness.DIFFERENT: "It is another constraint.",
    Sameness.EMPTY: "Nothing satisfies it together with the other constraints.",
}
#: What an answer that is not quite the constraint is worth.
_HALVES = frozenset({Sameness.IRREGULAR, Sameness.BRANCH, Sameness.DIFFERENTIATED, Sameness.WITHOUT_CONSTANT})
_RIGHT = frozenset({Sameness.SAME, Sameness.INTEGRATED})
#: What the equations of an answer are called in the scene that holds them.
ANSWER = "the answer"
Found = TypeVar("Found")


class PosedAnswer(NamedTuple):
    """A scene's mathematics with an answer in it, and the numbers of the answer's constraints."""

    system: System
    own: range


def _names(value: object) -> object:
    return (value,) if isinstance(value, str) else value


class EquationQuestion(QuestionBase):
    """The same constraint(s), in the presence of the scene's others."""

    ask: Literal["equation"] = Field(description="the equation of one constraint, or the equations of several")
    constraint: Annotated[
        tuple[str, ...], Listed, Field(min_length=1), BeforeValidator(_names, json_schema_input_type=str | list[str])
    ] = Field(description="the name of the constraint, or several names")

    def faults(self, key: Key) -> Iterator[Fault]:
        yield from _unknown(self.constraint, key)

    def read(self, answer: Given, key: Key) -> str:
        return self._reading(answer, key).shown

    def _reading(self, answer: Given, key: Key) -> Read:
        texts = _texts(answer)
        constants = any(key.constraints[name].form == "pfaffian" for name in self.constraint)
        read = read_equations(texts, key.names, constants)
        return read_equations(texts, key.names, constants=False) if read.constants and read.moving else read

    def solution(self, key: Key) -> str:
        return f"For example: {'; '.join(key.constraints[name].text for name in self.constraint)}."

    def judge(self, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        read = self._reading(answer, key)
        found = _with_answer(
            key,
            read,
            lambda posed: compare(posed.system, posed.system.numbers_of(*self.constraint), posed.own, read.constants),
        )
        if found.sameness is Sameness.UNDECIDED:
            return needs_review(read.shown, "whether it is the same constraint was not decided in the time there is.")
        told, code = _FEEDBACK[found.sameness], found.sameness.value
        if found.sameness in _RIGHT:
            return right(read.shown, told)
        if found.sameness in _HALVES:
            return partly(HALF, read.shown, told, code)
        share = Fraction(sum(found.met), len(found.met)) if len(self.constraint) > 1 and found.met else NOTHING
        if 0 < share < 1:
            missing = [n for n, met in zip(self.constraint, found.met, strict=True) if not met]
            told = f"{told} {len(self.constraint) - len(missing)} of {len(self.constraint)} constraints follow from it."
            return partly(share, read.shown, told, code)
        return wrong(read.shown, told, code)


class IntegralQuestion(QuestionBase):
    """The finite relation; its constant is named by the student, or left out; ``none`` where there is none."""

    ask: Literal["integral"] = Field(description="the finite relation that a differential constraint integrates to")
    constraint: str = Field(description="the name of the constraint")

    def faults(self, key: Key) -> Iterator[Fault]:
        yield from _unknown((self.constraint,), key)
        entry = key.constraints.get(self.constraint)
        if entry is not None and entry.form not in ("pfaffian", "nonlinear"):
            hint = "ask for the integral of a differential constraint"
            yield Fault(f"'{self.constraint}' is not differential", ("constraint",), hint=hint)

    def read(self, answer: Given, key: Key) -> str:
        return "none" if is_none(answer) else self._reading(answer, key).shown

    def _reading(self, answer: Given, key: Key) -> Read:
        return read_equations(_texts(answer), key.names, constants=True)

    def solution(self, key: Key) -> str:
        entry = key.constraints[self.constraint]
        if entry.holonomic is False:
            return f"There is none: {entry.reason}"
        return "" if entry.integral is None else f"For example: {entry.integral}."

    def judge(self, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        entry = key.constraints[self.constraint]
        if is_none(answer):
            if entry.holonomic is None:
                return needs_review("none", "dofkit does not know whether the constraint integrates.")
            told = "The constraint does integrate to a finite relation."
            return wrong("none", told, "INTEGRABLE") if entry.holonomic else right("none")
        read = self._reading(answer, key)
        if entry.holonomic is False:
            return wrong(read.shown, "The constraint does not integrate to a finite relation.", "NOT_INTEGRABLE")
        found = _with_answer(
            key, read, lambda posed: is_integral(posed.system, posed.system.numbers_of(self.constraint), posed.own)
        )
        if found is None:
            return needs_review(read.shown, "whether it is an integral was not decided in the time there is.")
        if found:
            return right(read.shown)
        if read.moving:
            told = "This still holds velocities: the finite relation that it integrates to is asked for."
            return wrong(read.shown, told, "NOT_INTEGRATED")
        return wrong(read.shown, "Its differential is not the constraint.", "WRONG_INTEGRAL")


def _unknown(names: tuple[str, ...], key: Key) -> Iterator[Fault]:
    for name in names:
        if name not in key.constraints:
            hint = suggestion(name, list(key.constraints), "constraints")
            yield Fault(f"the scene has no constraint '{name}'", ("constraint",), hint=hint)


def _texts(answer: Given) -> str | list[str]:
    return [one_text(part) for part in answer] if isinstance(answer, (list, tuple)) else one_text(answer)


def _with_answer(key: Key, read: Read, question: Callable[[PosedAnswer], Found]) -> Found:
    """What is found of the scene with the answer. Raises TextError where the scene cannot hold it."""
    try:
        system = lower(with_equations(key.scene, read, ANSWER))
        return question(PosedAnswer(system, range(len(key.scene.constraints), len(system.constraints))))
    except SceneError as error:
        fault = error.faults[0]
        raise TextError(fault.message, fault.column or 1, fault.hint) from None
