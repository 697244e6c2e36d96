"""What a graded submission says: points, how every answer was read, stable codes and feedback."""

from __future__ import annotations

from typing import Literal

from dofkit.base.display import Displayed
from dofkit.report import ToldModel

Status = Literal["right", "partly", "wrong", "unreadable", "missing", "needs_review"]


class Item(ToldModel):
    """One answer. ``score`` is None where it needs a person's review: never zero then, never full marks.

    ``codes`` are stable names of what went wrong, the most likely first; ``read_as`` is the answer as it was
    understood; ``column`` is where an unreadable answer could not be read further, from 1.
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


class Result(Displayed, ToldModel):
    """One student's submission. ``score`` is the sum of what is decided; ``needs_review`` answers are open beside it.

    ``error``: why the submission could not be graded; then there are no items and ``score`` is None. ``doubt``: why a
    person has to say whose it is, where its file and the ``student`` in it, or the platform's user, are not the same.
    """

    student: str
    score: float | None
    max_score: float
    items: list[Item]
    needs_review: int = 0
    error: str | None = None
    doubt: str | None = None
