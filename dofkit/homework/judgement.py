"""What is found of one answer, before points are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from dofkit.base.errors import TextError
from dofkit.homework.result import Status
from dofkit.homework.sentences.said import Language, Said

#: What stands in a submission as an answer.
Given = str | int | float | Fraction | Sequence["Given"]

#: What is told: a whole sentence, or one with places; nothing where it is empty.
Sentence = str | Said

FULL, HALF, NOTHING = Fraction(1), Fraction(1, 2), Fraction(0)


class DoubtError(TextError):
    """An answer that can be read, in more than one way: a person has to look."""


@dataclass(frozen=True)
class Judgement:
    """``share``: of the question's points; None where it could not be decided. ``said``: the feedback."""

    status: Status
    share: Fraction | None
    read_as: str = ""
    codes: tuple[str, ...] = ()
    said: tuple[Said, ...] = ()
    column: int | None = None

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
    told = (Said("This could not be decided and will be looked at:"), why)
    return Judgement("needs_review", None, read_as, (), told)


def unreadable(error: TextError) -> Judgement:
    """What could not be read, and where."""
    hint = f" ({error.hint})" if error.hint else ""
    return Judgement("unreadable", NOTHING, "", (), (Said(f"{error.message}{hint}"),), error.column or 1)


def agreed(found: Sequence[Judgement]) -> Judgement:
    """What all readings of an answer come to; where they are judged differently a person has to look."""
    first = found[0]
    shown = " or ".join(dict.fromkeys(one.read_as for one in found))
    if all((one.status, one.share) == (first.status, first.share) for one in found):
        return replace(first, read_as=shown)
    return needs_review(shown, "it can be read in more than one way.")
