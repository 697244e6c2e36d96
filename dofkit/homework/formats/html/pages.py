"""What a student's page shows, made ready for its template."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import STATUSES, number, open_points, plain
from dofkit.homework.own_sheets import NobodysSheetError, own
from dofkit.homework.problem import Problem
from dofkit.homework.questions import QuestionBase
from dofkit.homework.result import Item, Result, Status
from dofkit.homework.sentences.translations import Language, in_language


class Badge(NamedTuple):
    """How a status looks: its ``mark`` and its ``label``, so that colour is never all there is."""

    mark: str
    label: str


BADGES: dict[Status, Badge] = {
    "right": Badge("✓", STATUSES["right"]),
    "partly": Badge("◐", STATUSES["partly"]),
    "wrong": Badge("✗", STATUSES["wrong"]),
    "unreadable": Badge("?", STATUSES["unreadable"]),
    "missing": Badge("–", STATUSES["missing"]),
    "needs_review": Badge("…", STATUSES["needs_review"]),
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
    language: Language

    def told(self, sentence: str, **values: object) -> str:
        """Return a sentence in the page's language."""
        return in_language(self.language, sentence, **values)

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
    sections, language = [], prepared.assignment.language
    for problem in prepared.assignment.problems:
        rows = [
            AnswerRow(found.pop((problem.id, q.id)), plain(q.asked(", ".join(q.about)).told(language)))
            for q in problem.questions
            if (problem.id, q.id) in found
        ]
        if rows:
            sections.append(Section(problem_title(problem), rows))
    if found:
        unasked = in_language(language, "Answers to questions that were not asked")
        sections.append(Section(unasked, [AnswerRow(item, "") for item in found.values()]))
    return StudentPage(prepared.assignment.title, result, sections, language)


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
