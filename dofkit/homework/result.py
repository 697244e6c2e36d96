"""What a graded submission says: points, how every answer was read, stable codes and feedback."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import BaseModel, Field

from dofkit.base.display import Displayed
from dofkit.report import ReportModel

#: ``read``: of an answer that was only read.
Status = Literal["right", "partly", "wrong", "unreadable", "missing", "needs_review", "read"]


def json_line(model: BaseModel) -> str:
    """Return a model as one line of JSON, also for readers that end a line at U+2028."""
    text = model.model_dump_json()
    return text.replace("\u2028", "\\u2028").replace("\u2029", "\\u2029").replace("\x85", "\\u0085")


class PossibleReading(ReportModel):
    """A way to read an answer that is open, and what it would earn; None where that is open too."""

    read_as: str
    score: float | None


class Item(ReportModel):
    """One answer. ``score`` is None where it waits for a person: never zero then, never full marks.

    ``codes`` are stable names of what went wrong, the most likely first; ``answer`` is the answer as typed, at most
    2 000 characters of it, and ``read_as`` the answer as it was understood. ``column`` is where an unreadable answer
    could not be read further, from 1. ``readings``: the
    ways to read an open answer, and what each would earn. ``certain``: its text reads in one way, in declared names
    alone; that does not depend on the key. ``decided_by``: the person who gave the points.
    ``variant``: of the problem, where every student has another: its structure and a mark.
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
    """One student's submission. ``score`` is the sum of what is decided; ``needs_review`` answers are open beside it:
    those that could not be decided, and those that could not be read unless the assignment gives them zero points.

    ``error``: why the submission could not be graded; then there are no items and ``score`` is None. ``doubt``: why a
    person has to say whose it is, where its file and the ``student`` in it, or the platform's user, are not the same.
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
