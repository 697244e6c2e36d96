"""Questions whose answer is a whole number: degrees of freedom, and the number of constraints."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.homework.answers.counts import number
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.prose import CONSTRAINT_NOUNS, FREEDOM_NOUNS
from dofkit.homework.judgement import HALF, Given, Judgement, Reading, Sentence, needs_review, partly, right, wrong
from dofkit.homework.key.key import Key
from dofkit.homework.key.misconceptions import explain
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences import say
from dofkit.scene.fields import as_written

#: Codes: a number computed correctly from an earlier wrong one; the number in the other convention.
CARRIED, OTHER_CONVENTION = "CARRIED", "OTHER_CONVENTION"
_CONFIGURATION = "Count the coordinates and subtract the number of independent holonomic equations."
_VELOCITIES = (
    "Count the coordinates and subtract the number of independent constraint equations, holonomic and non-holonomic."
)
_CONVENTIONS = {
    "configuration": (
        "This is the number of independent generalized velocities. Here the number of degrees of freedom is "
        "the dimension of the configuration space, which non-holonomic constraints do not reduce."
    ),
    "velocity": (
        "This is the dimension of the configuration space. Here the number of degrees of freedom is the "
        "number of independent generalized velocities, which non-holonomic constraints reduce as well."
    ),
}


class NumberQuestion(QuestionBase):
    """A number in the report; ``letters``: names of the number in answers."""

    letters: ClassVar[frozenset[str]] = frozenset(
        {"f", "dof", "ndof", "df", "fg", "fhg", "ddl", "gdl", "s", "freiheitsgrade", "degrees of freedom"}
    )

    #: Nouns of other quantities: a number with one of them answers another question.
    foreign: ClassVar[frozenset[str]] = CONSTRAINT_NOUNS

    def truth(self, key: Key) -> int | None:
        """Return the correct number, or None if it is not known for certain."""
        raise NotImplementedError

    def other(self, key: Key) -> int | None:
        """Return the number in the other convention, or None if there is none."""
        del key
        return None

    def clash(self, key: Key) -> str:
        """Return the feedback on the number in the other convention."""
        return _CONVENTIONS[key.convention]

    def advice(self, key: Key) -> str:
        """Return how the number is counted: the feedback on a number that no known error explains."""
        raise NotImplementedError

    def consequences(self, key: Key, earlier: Earlier) -> Iterator[Fraction]:
        """Yield the numbers that would be right if earlier answers were right."""
        del key, earlier
        yield from ()

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        del names
        amount = number(answer, self.letters, self.foreign)
        return [Reading(amount, as_written(amount))]

    def solution(self, key: Key) -> Sentence:
        amount = self.truth(key)
        return "" if amount is None else say("The correct answer is {number}.", number=amount)

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        amount, truth, text = reading.value, self.truth(key), reading.text
        if truth is None:
            return needs_review(text, "the correct number is not known for certain.")
        if amount == truth:
            return right(text)
        codes = explain(amount, self.kind(), key)
        if amount in set(self.consequences(key, earlier)):
            return partly(HALF, text, CARRIED, *codes)
        if amount == self.other(key):
            return wrong(text, OTHER_CONVENTION, *codes, why=self.clash(key))
        return wrong(text, *codes, why="" if codes else self.advice(key))


class Dof(NumberQuestion):
    """f: the dimension of the configuration space, or of the velocity space in the velocity convention."""

    ask: Literal["dof"] = Field(description="the number of degrees of freedom")

    def advice(self, key: Key) -> str:
        return _VELOCITIES if key.convention == "velocity" else _CONFIGURATION

    def truth(self, key: Key) -> int | None:
        return key.report.velocity_dof if key.convention == "velocity" else key.report.dof

    def other(self, key: Key) -> int | None:
        return key.report.dof if key.convention == "velocity" else key.report.velocity_dof

    def consequences(self, key: Key, earlier: Earlier) -> Iterator[Fraction]:
        if "k" in earlier and key.convention == "configuration":
            yield len(key.coordinates) - earlier["k"]


class VelocityDof(NumberQuestion):
    """The number of independent velocities."""

    ask: Literal["velocity_dof"] = Field(description="the number of independent generalized velocities")

    def advice(self, key: Key) -> str:
        return _VELOCITIES

    def truth(self, key: Key) -> int | None:
        return key.report.velocity_dof

    def other(self, key: Key) -> int | None:
        return key.report.dof

    def clash(self, key: Key) -> str:
        return (
            "This is the dimension of the configuration space; the question asks for the number of "
            "independent generalized velocities."
        )

    def consequences(self, key: Key, earlier: Earlier) -> Iterator[Fraction]:
        dof, velocity_dof = key.report.dof, key.report.velocity_dof
        if "dof" in earlier and key.convention == "configuration" and dof is not None and velocity_dof is not None:
            yield earlier["dof"] - (dof - velocity_dof)


class CountQuestion(NumberQuestion):
    """k: the number of independent holonomic equations, which is the number of coordinates less f."""

    letters: ClassVar[frozenset[str]] = frozenset({"k", "r", "m", "nc", "constraints", "bindungen"})
    foreign: ClassVar[frozenset[str]] = FREEDOM_NOUNS
    ask: Literal["k"] = Field(description="the number of independent holonomic equations")

    def advice(self, key: Key) -> str:
        return "Count the independent holonomic equations; non-integrable equations in the velocities do not count."

    def truth(self, key: Key) -> int | None:
        return None if key.report.dof is None else len(key.coordinates) - key.report.dof

    def consequences(self, key: Key, earlier: Earlier) -> Iterator[Fraction]:
        if "dof" in earlier and key.convention == "configuration":
            yield len(key.coordinates) - earlier["dof"]
