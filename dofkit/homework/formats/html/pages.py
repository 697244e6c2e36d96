"""What a student's page shows, made ready for its template."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import number, open_points, plain
from dofkit.homework.own_sheets import NobodysSheetError, own
from dofkit.homework.problem import Problem
from dofkit.homework.questions import QuestionBase
from dofkit.homework.result import Item, Result, Status


class Badge(NamedTuple):
    """How a status looks: its ``mark`` and its ``label``, so that colour is never all there is."""

    mark: str
    label: str


BADGES: dict[Status, Badge] = {
    "right": Badge("✓", "right"),
    "partly": Badge("◐", "partly right"),
    "wrong": Badge("✗", "wrong"),
    "unreadable": Badge("?", "not readable"),
    "missing": Badge("–", "no answer"),
    "needs_review": Badge("…", "in review"),
}


@dataclass(frozen=True)
class AnswerRow:
    """One answer beside what was asked."""

    item: Item
    asked: str

    @property
    def points(self) -> str:
        given = "–" if self.item.score is None else number(self.item.score)
        return f"{given} / {number(self.item.max_score)}"


@dataclass(frozen=True)
class Section:
    """The answers to one problem."""

    title: str
    rows: list[AnswerRow]


@dataclass(frozen=True)
class StudentPage:
    """A student's page."""

    title: str
    result: Result
    sections: list[Section]

    @property
    def open_points(self) -> float:
        return open_points(self.result)

    @property
    def percent(self) -> float:
        return percent(self.result.score, self.result.max_score)

    @property
    def open_percent(self) -> float:
        return percent(self.open_points, self.result.max_score)


def percent(score: float | None, most: float) -> float:
    """A share in percent, from 0 to 100."""
    return min(max(100 * (score or 0.0) / most, 0.0), 100.0) if most else 0.0


def student_page(result: Result, prepared: Prepared) -> StudentPage:
    """The page of one submission: its answers by problem, those to nothing that was asked at the end."""
    if any(getattr(question, "coordinate", None) for _, question in prepared.questions()):
        with suppress(NobodysSheetError):  # each student's may have another name
            prepared = own(prepared, result.student)
    found = {(item.problem, item.question): item for item in result.items}
    sections = []
    for problem in prepared.assignment.problems:
        rows = [
            AnswerRow(found.pop((problem.id, q.id)), question_text(q))
            for q in problem.questions
            if (problem.id, q.id) in found
        ]
        if rows:
            sections.append(Section(problem_title(problem), rows))
    if found:
        sections.append(Section("Answers to questions that were not asked", [AnswerRow(i, "") for i in found.values()]))
    return StudentPage(prepared.assignment.title, result, sections)


def problem_title(problem: Problem) -> str:
    """What a problem is called."""
    return problem.id if problem.title is None else f"{problem.id}: {problem.title}"


def question_text(question: QuestionBase) -> str:
    """What a question asks for, in words."""
    told = type(question).model_fields["ask"].description or question.kind()
    about = getattr(question, "constraint", None) or getattr(question, "coordinate", None)
    if about:
        told += f" ({about if isinstance(about, str) else ', '.join(about)})"
    return plain(told)
