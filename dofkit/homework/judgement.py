"""The judgement of one answer, as a share of its points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, NamedTuple

from dofkit.base.errors import TextError
from dofkit.homework.result import Status
from dofkit.homework.sentences import Language, Said, meanings, say

#: The types of an answer in a submission.
Given = str | int | float | Fraction | Sequence["Given"]

#: A sentence of feedback, also with placeholders; an empty one is left out.
Sentence = str | Said

FULL, HALF, NOTHING = Fraction(1), Fraction(1, 2), Fraction(0)


class DoubtError(TextError):
    """An answer that is ambiguous, so that a person must review it."""


class JudgedReading(NamedTuple):
    """One reading of an undecided answer, and its share of the points, or None if that is undecided."""

    read_as: str
    share: Fraction | None


class Reading(NamedTuple):
    """One way to understand an answer, by its text, the question's kind and the declared names alone.

    ``value``: what the question judges; ``text``: the value in words or in the grammar of scenes. ``rank``: 0 for the
    plainest readings, larger for less usual ones. ``certain``: whether all its names are declared. ``rounded``: whether
    it contains rounded numbers, so that it is not wrong without a review.
    """

    value: Any
    text: str
    rank: int = 0
    certain: bool = True
    rounded: bool = False


@dataclass(frozen=True)
class Judgement:
    """``share``: of the question's points; None if undecided. ``said``: the feedback.

    ``readings``: of an undecided answer; ``certain``: whether there is one reading, in declared names.
    """

    status: Status
    share: Fraction | None
    read_as: str = ""
    codes: tuple[str, ...] = ()
    said: tuple[Said, ...] = ()
    column: int | None = None
    readings: tuple[JudgedReading, ...] = ()
    certain: bool = True

    def saying(self, *sentences: Sentence) -> Judgement:
        """Return the judgement with more feedback."""
        return replace(self, said=(*self.said, *_said(*sentences)))

    def feedback(self, language: Language = "en") -> str:
        """Return the feedback in a language."""
        return " ".join(sentence.translated(language) for sentence in self.said)


def _said(*sentences: Sentence) -> tuple[Said, ...]:
    return tuple(Said(sentence) if isinstance(sentence, str) else sentence for sentence in sentences if sentence)


def right(read_as: str, *feedback: Sentence) -> Judgement:
    """Return the judgement with full points."""
    return Judgement("right", FULL, read_as, (), _said(*feedback))


def wrong(read_as: str, *codes: str, why: Sentence = "") -> Judgement:
    """Return the judgement without points; ``why``: the feedback, by default the meaning of the first code."""
    return partly(NOTHING, read_as, *codes, why=why)


def partly(share: Fraction, read_as: str, *codes: str, why: Sentence = "") -> Judgement:
    """Return the judgement with a share of the points; its status is right for the full share, wrong for none."""
    feedback = _said(why or (meanings()[codes[0]] if codes else ""))
    status: Status = "right" if share >= FULL else "partly" if share > 0 else "wrong"
    return Judgement(status, min(max(share, NOTHING), FULL), read_as, codes, feedback)


def needs_review(read_as: str, reason: Sentence) -> Judgement:
    """Return the judgement that a person must review the answer, for the given reason."""
    (why,) = _said(reason)
    sentences = (Said("A person will review this answer:"), why)
    return Judgement("needs_review", None, read_as, (), sentences)


def unreadable(error: TextError) -> Judgement:
    """Return the judgement that an answer could not be read, with its column; undecided until a person reviews it."""
    said = say("{fault} ({hint})", fault=error.message, hint=error.hint) if error.hint else None
    sentence = say("{fault}", fault=error.message) if said is None else said
    return Judgement("unreadable", None, "", (), (sentence,), error.column or 1)


def verdict(readings: Sequence[Reading], judge: Callable[[Reading], Judgement]) -> Judgement:
    """Return one judgement of an answer for all its readings.

    It is right if one of the plainest readings is right and none of them is worth less; wrong only if all readings are
    wrong. Otherwise a person must review it, and sees the points of each reading. Readings for which ``judge`` raises
    TextError are ignored; if there are no others, the first error is raised.
    """
    judged: list[tuple[int, Judgement]] = []
    failure: TextError | None = None
    for reading in sorted(readings, key=lambda candidate: candidate.rank):
        try:
            judgement = judge(reading)
        except TextError as error:
            failure = failure or error
            continue
        if reading.rounded and judgement.status == "wrong":
            judgement = needs_review(reading.text, "it contains rounded numbers.")
        judged.append((reading.rank, judgement if judgement.read_as else replace(judgement, read_as=reading.text)))
        if reading.rank > judged[0][0] and judgement.share != judged[0][1].share:
            break
    if not judged:
        raise failure or TextError("there is nothing to judge", 1)
    first = judged[0][1]
    plausible = [judgement for rank, judgement in judged if rank == judged[0][0]]
    text = " or ".join(dict.fromkeys(candidate.read_as for candidate in plausible))
    agree = all((candidate.status, candidate.share) == (first.status, first.share) for candidate in plausible)
    if agree and (first.status == "right" or all(judgement.share == first.share for _, judgement in judged)):
        return replace(first, read_as=text)
    full = [candidate for candidate in plausible if candidate.status == "right"]
    if full and all(candidate.share in (FULL, None) for candidate in plausible):
        return replace(full[0], read_as=text)
    judged_readings = tuple(dict.fromkeys(JudgedReading(judgement.read_as, judgement.share) for _, judgement in judged))
    return replace(needs_review(text, "it can be read in more than one way."), readings=judged_readings)


def shown_text_of(readings: Sequence[Reading]) -> str:
    """Return the texts of the plainest readings of an answer, separated by "or"."""
    least = min((reading.rank for reading in readings), default=0)
    return " or ".join(dict.fromkeys(reading.text for reading in readings if reading.rank == least))
