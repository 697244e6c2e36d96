"""What is found of one answer, before points are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from dofkit.base.errors import TextError
from dofkit.homework.result import Status

#: What stands in a submission as an answer.
Given = str | int | float | Fraction | Sequence["Given"]

FULL, HALF, NOTHING = Fraction(1), Fraction(1, 2), Fraction(0)


class DoubtError(TextError):
    """An answer that can be read, in more than one way: a person has to look."""


@dataclass(frozen=True)
class Judgement:
    """``share``: of the question's points; None where it could not be decided."""

    status: Status
    share: Fraction | None
    read_as: str = ""
    codes: tuple[str, ...] = ()
    feedback: str = ""
    column: int | None = None

    def saying(self, *sentences: str) -> Judgement:
        """The same with more feedback."""
        told = " ".join(s for s in (self.feedback, *sentences) if s)
        return replace(self, feedback=told)


def right(read_as: str, feedback: str = "") -> Judgement:
    """Full points."""
    return Judgement("right", FULL, read_as, (), feedback)


def wrong(read_as: str, feedback: str = "", *codes: str) -> Judgement:
    """No points."""
    return Judgement("wrong", NOTHING, read_as, codes, feedback)


def partly(share: Fraction, read_as: str, feedback: str = "", *codes: str) -> Judgement:
    """A part of the points; all of them is right, none is wrong."""
    if share >= FULL:
        return Judgement("right", FULL, read_as, codes, feedback)
    return Judgement("partly" if share > 0 else "wrong", max(share, NOTHING), read_as, codes, feedback)


def needs_review(read_as: str, reason: str) -> Judgement:
    """Not decided: a person has to look."""
    return Judgement("needs_review", None, read_as, (), f"This could not be decided and will be looked at: {reason}")


def agreed(found: Sequence[Judgement]) -> Judgement:
    """What all readings of an answer come to; where they are judged differently a person has to look."""
    first = found[0]
    shown = " or ".join(dict.fromkeys(one.read_as for one in found))
    if all((one.status, one.share) == (first.status, first.share) for one in found):
        return replace(first, read_as=shown)
    return needs_review(shown, "it can be read in more than one way.")
