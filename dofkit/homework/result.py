"""The result of a submission: points, how every answer was read, stable codes and feedback."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import BaseModel, Field

from dofkit.base.display import Displayed
from dofkit.report import ReportModel

#: The status of an answer; ``read``: it was only read, not graded.
Status = Literal["right", "partly", "wrong", "unreadable", "missing", "needs_review", "read"]


def json_line(model: BaseModel) -> str:
    """Return a model as one line of JSON, also for readers that end a line at U+2028."""
    text = model.model_dump_json()
    return text.replace("\u2028", "\\u2028").replace("\u2029", "\\u2029").replace("\x85", "\\u0085")


class PossibleReading(ReportModel):
    """A reading of an undecided answer, and the points that it would earn, or None if these are undecided."""

    read_as: str
    score: float | None


class Item(ReportModel):
    """One answer. ``score`` is None (neither zero nor full marks) if a person must review it.

    ``codes`` are stable names of what went wrong, the most likely first; ``answer`` is the answer as typed (at
    most 2000 characters), and ``read_as`` the answer as it was understood. ``column`` (from 1) is where reading of an
    unreadable answer stopped. ``readings``: the readings of an undecided answer, and their points. ``certain``: whether
    there is one reading, in declared names, which does not depend on the key. ``decided_by``: the person who gave the
    points. ``variant``: the values on which the right answer depends, if the problem varies.
    """

    problem: str
    question: str
    score: float | None
    max_score: float
    status: Status
    codes: list[str]
    read_as: str
    feedback: str
    column: int | None = None
    answer: str | None = None
    readings: list[PossibleReading] = Field(default_factory=list)
    certain: bool = True
    decided_by: str | None = None
    variant: str | None = None


class Result(Displayed, ReportModel):
    """The result of one submission. ``score``: the sum of the decided points; ``needs_review``: the number of undecided
    answers, also of unreadable ones unless the assignment gives them zero points.

    ``error``: why the submission could not be graded; then there are no items and ``score`` is None. ``doubt``: why a
    person must decide who submitted it, because the file, the ``student`` in it or the platform's user disagree.
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("student", "score", "max_score", "error")

    student: str
    score: float | None
    max_score: float
    items: list[Item]
    needs_review: int = 0
    error: str | None = None
    doubt: str | None = None

    @classmethod
    def refused(cls, student: str, max_score: float, error: str) -> Result:
        """Return the result of a submission that cannot be graded."""
        return cls(student=student, score=None, max_score=max_score, items=[], error=error)
