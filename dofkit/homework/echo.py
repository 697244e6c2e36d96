"""How answers are understood, without grading them."""

from __future__ import annotations

from typing import Literal

from dofkit.base.deadline import by_processor
from dofkit.base.errors import TextError
from dofkit.homework.answers.prose import says_nothing
from dofkit.homework.answers.submission import Submission
from dofkit.homework.assignment import Prepared
from dofkit.homework.grading import ANSWER_SECONDS, unasked
from dofkit.homework.judgement import Given
from dofkit.homework.key.key import Key
from dofkit.homework.own_sheets import NobodysSheetError, own
from dofkit.homework.questions import QuestionBase
from dofkit.report import ReportModel


class Reading(ReportModel):
    """One answer as it was understood; ``column`` is where one that is not understood could not be read further."""

    problem: str
    question: str
    status: Literal["read", "unreadable", "missing"]
    read_as: str
    feedback: str = ""
    column: int | None = None


class Echo(ReportModel):
    """One student's answers as they were understood. ``error``: why the submission could not be read."""

    student: str
    items: list[Reading]
    error: str | None = None


def echo(prepared: Prepared, submission: Submission) -> Echo:
    """Read every answer, in the assignment's order; then those that were not asked for."""
    if submission.error is not None:
        return Echo(student=submission.student, items=[], error=submission.error)
    try:
        prepared = own(prepared, submission.student)
    except NobodysSheetError as error:
        return Echo(student=submission.student, items=[], error=str(error))
    items = [
        _reading(
            problem.id, question, prepared.keys[problem.id], submission.answers.get(problem.id, {}).get(question.id)
        )
        for problem, question in prepared.questions()
    ]
    for item in unasked(prepared, submission):
        told = {"status": "unreadable", "read_as": "", "feedback": item.feedback}
        items.append(Reading.model_validate({"problem": item.problem, "question": item.question, **told}))
    return Echo(student=submission.student, items=items)


def _reading(problem: str, question: QuestionBase, key: Key, answer: Given | None) -> Reading:
    if answer is None or says_nothing(answer):
        return Reading(problem=problem, question=question.id, status="missing", read_as="")
    try:
        with by_processor(ANSWER_SECONDS):
            shown = question.read(answer, key)
    except MemoryError:
        raise
    except Exception as error:
        found = error if isinstance(error, TextError) else TextError(f"it could not be read ({type(error).__name__})")
        hint = f" ({found.hint})" if found.hint else ""
        return Reading(
            problem=problem, question=question.id, status="unreadable", read_as="",
            feedback=f"{found.message}{hint}", column=found.column or 1,
        )  # fmt: skip
    return Reading(problem=problem, question=question.id, status="read", read_as=shown)
