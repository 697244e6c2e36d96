"""The base class of all kinds of questions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import Annotated, NamedTuple, get_args

from pydantic import BeforeValidator, Field

from dofkit.base.documents import package_table
from dofkit.base.errors import Fault
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.judgement import Given, Judgement, Reading, Sentence, shown_text_of
from dofkit.homework.key.key import Key
from dofkit.homework.sentences import Said, say
from dofkit.scene.fields import Number, WrittenModel, exact, fault_error, suggestion

#: {kind of question: number that the student gave} for earlier questions of the same problem.
Earlier = Mapping[str, Fraction]
#: The fewest (other than 0) and most points of a question.
FEWEST_POINTS, MOST_POINTS = Fraction(1, 1000), 1_000_000


def _points(value: object) -> object:
    points = exact(value)
    if points < 0:
        raise fault_error(f"points are not negative, as {value} is", "write 0 or more")
    if points > MOST_POINTS or 0 < points < FEWEST_POINTS:
        hint = f"write 0, or {float(FEWEST_POINTS)} to {MOST_POINTS}"
        raise fault_error(f"a question cannot be worth {value} points", hint)
    return points


def identifier(value: object) -> object:
    """Return an id as text if it is a whole number, otherwise unchanged."""
    if isinstance(value, int) and not isinstance(value, bool):
        return str(value)
    if isinstance(value, Fraction) and value.denominator == 1:
        return str(value)
    return value


Points = Annotated[Number, BeforeValidator(_points)]
Identifier = Annotated[str, BeforeValidator(identifier), Field(min_length=1, max_length=200)]


class QuestionWords(NamedTuple):
    """What is asked, how an answer is written, and an example of one: a row of ``words.yaml``."""

    wanted: str
    how: str
    example: str = ""


class QuestionBase(WrittenModel):
    """One question: how an answer is read and judged, and the right answer."""

    id: Identifier = Field(description="its name, unique within the problem")
    text: str | None = Field(None, description="the question in your own words; by default as its kind is asked")
    points: Points = Field(Fraction(1), description="how many points it is worth")

    @classmethod
    def kind(cls) -> str:
        """Return the value of `ask`."""
        return _kind(cls)

    @classmethod
    def words(cls) -> QuestionWords:
        """Return how it is asked."""
        return QuestionWords(**package_table(__package__, "words.yaml")[cls.kind()])

    @property
    def about(self) -> tuple[str, ...]:
        """The names of the constraints or coordinates that the question is about."""
        names = getattr(self, "constraint", None) or getattr(self, "coordinate", None) or ()
        return (names,) if isinstance(names, str) else tuple(names)

    def asked(self, about: str) -> Said:
        """Return the question in words; ``about``: the names of `about` as they are shown."""
        return self._asked(about) if self.text is None else say("{text}", text=self.text)

    def _asked(self, about: str) -> Said:
        wanted = self.words().wanted
        return say(wanted, about=about) if "{about}" in wanted else say(wanted)

    @classmethod
    def called(cls) -> str:
        return f"a question that asks for '{cls.kind()}'"

    def faults(self, key: Key) -> Iterator[Fault]:
        """Yield the faults of the question for this scene, each at a path within the question."""
        of_coordinate = getattr(self, "constraint", None) is None
        what, available = ("coordinate", key.coordinates) if of_coordinate else ("constraint", [*key.constraints])
        for name in self.about:
            if name not in available:
                hint = suggestion(name, available, f"{what}s")
                yield Fault(f"the scene has no {what} '{name}'", (what,), hint=hint)

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        """Return all readings of an answer. Raises TextError, and DoubtError for an ambiguous answer."""
        raise NotImplementedError

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        """Return the judgement of one reading. Raises TextError if the scene cannot contain it."""
        raise NotImplementedError

    def read(self, answer: Given, names: DeclaredNames) -> str:
        """Return the plainest readings of an answer as text. Raises TextError if it cannot be read."""
        return shown_text_of(self.readings(answer, names))

    def solution(self, key: Key) -> Sentence:
        """Return the correct answer in words, or an empty text if it is unknown."""
        raise NotImplementedError


@cache
def _kind(cls: type[QuestionBase]) -> str:
    return str(get_args(cls.model_fields["ask"].annotation)[0])
