"""What is found of one answer, before points are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.homework.result import Status
from dofkit.homework.sentences.translations import Language, Said, say

#: What stands in a submission as an answer.
Given = str | int | float | Fraction | Sequence["Given"]

#: What is told: a whole sentence, or one with places; nothing where it is empty.
Sentence = str | Said

FULL, HALF, NOTHING = Fraction(1), Fraction(1, 2), Fraction(0)


class DoubtError(TextError):
    """An answer that can be read, in more than one way: a person has to look."""


class JudgedReading(NamedTuple):
    """One way to read an answer that is open, and its share of the points; None where that is open too."""

    read_as: str
    share: Fraction | None


@dataclass(frozen=True)
class Judgement:
    """``share``: of the question's points; None where it could not be decided. ``said``: the feedback.

    ``ways``: of what is open the readings that it may have; of what is unreadable the nearest one.
    """

    status: Status
    share: Fraction | None
    read_as: str = ""
    codes: tuple[str, ...] = ()
    said: tuple[Said, ...] = ()
    column: int | None = None
    ways: tuple[JudgedReading, ...] = ()

    def saying(self, *sentences: Sentence) -> Judgement:
        """The same with more feedback."""
        return replace(self, said=(*self.said, *_said(*sentences)))

    def feedback(self, language: Language = "en") -> str:
        """What is said, in a language."""
        return " ".join(one.told(language) for one in self.said)


def _said(*sentences: Sentence) -> tuple[Said, ...]:
    return tuple(Said(one) if isinstance(one, str) else one for one in sentences if one)


def right(read_as: str, *feedback: Sentence) -> Judgement:
    """Full points."""
    return Judgement("right", FULL, read_as, (), _said(*feedback))


def wrong(read_as: str, feedback: Sentence = "", *codes: str) -> Judgement:
    """No points."""
    return Judgement("wrong", NOTHING, read_as, codes, _said(feedback))


def partly(share: Fraction, read_as: str, feedback: Sentence = "", *codes: str) -> Judgement:
    """A part of the points; all of them is right, none is wrong."""
    if share >= FULL:
        return Judgement("right", FULL, read_as, codes, _said(feedback))
    return Judgement("partly" if share > 0 else "wrong", max(share, NOTHING), read_as, codes, _said(feedback))


def needs_review(read_as: str, reason: Sentence) -> Judgement:
    """Not decided: a person has to look."""
    (why,) = _said(reason)
    told = (Said("A person will review this answer:"), why)
    return Judgement("needs_review", None, read_as, (), told)


def unreadable(error: TextError, ways: tuple[JudgedReading, ...] = ()) -> Judgement:
    """What could not be read, and where: open until a person decides. ``ways``: what it may mean."""
    said = say("{fault} ({hint})", fault=error.message, hint=error.hint) if error.hint else None
    told = say("{fault}", fault=error.message) if said is None else said
    return Judgement("unreadable", None, "", (), (told,), error.column or 1, ways)


def agreed(found: Sequence[Judgement]) -> Judgement:
    """What all readings of an answer come to; where they are judged differently a person has to look."""
    first = found[0]
    shown = " or ".join(dict.fromkeys(one.read_as for one in found))
    if all((one.status, one.share) == (first.status, first.share) for one in found):
        return replace(first, read_as=shown)
    ways = tuple(dict.fromkeys(JudgedReading(one.read_as, one.share) for one in found))
    return replace(needs_review(shown, "it can be read in more than one way."), ways=ways)
