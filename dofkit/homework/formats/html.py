"""HTML pages of results: one for each student, and an overview for the lecturer.

``index.html`` is the overview, ``students/`` contains the others; the run adds ``review.html``, with the answers that
wait for a person. No page loads other files, and all that a student wrote is escaped.
Answers that need a review have no points, and the score says that it is not final.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import mean, median
from typing import Any, NamedTuple

from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, FormatError, Target
from dofkit.homework.formats.pages import MARKS, asked_text, percent, rendered, student_page
from dofkit.homework.formats.review import queue_of
from dofkit.homework.formats.wording import FileNames, number
from dofkit.homework.result import Item, Result, Status
from dofkit.homework.sentences import meanings

#: The number of bars of the distribution; the most errors and unreadable texts that are listed for a question.
BARS, MOST_LISTED = 10, 3


class Submitted(NamedTuple):
    """A submission in a list: the student's name, the link to the page, the result."""

    name: str
    link: str
    result: Result

    @property
    def points(self) -> str:
        return "–" if self.result.score is None else number(self.result.score)


class Question(NamedTuple):
    """Statistics of one question. ``counts``: (status, number, percent); ``mean``: of the decided answers, in points.

    ``most``: its points; ``right``: the share of the graded answers with full points; ``errors``: (number, text) of the
    commonest errors; ``unread_texts``: (number, text) of the commonest unreadable answers.
    """

    name: str
    asked: str
    counts: list[tuple[Status, int, float]]
    mean: float | None
    most: float
    right: float | None
    errors: list[tuple[int, str]]
    unread_texts: list[tuple[int, str]]


def overview(submitted: Sequence[Submitted], prepared: Prepared, roster: Roster | None = None) -> dict[str, Any]:
    """Return the values for the template of the lecturer's page; a ``roster`` tells who did not submit."""
    graded = [submission.result for submission in submitted if submission.result.error is None]
    final = [result for result in graded if not result.needs_review and result.doubt is None]
    scores = [result.score or 0.0 for result in final]
    answers: defaultdict[tuple[str, str], list[Item]] = defaultdict(list)
    for item in (item for result in graded for item in result.items):
        answers[item.problem, item.question].append(item)
    questions = list(_questions(prepared, answers))
    most = prepared.max_score
    queue = queue_of(
        graded, prepared, [submission.link for submission in submitted if submission.result.error is None]
    ).open_answers()
    present = {submission.name for submission in submitted}
    return {
        "title": prepared.assignment.title,
        "most": most,
        "graded": len(final),
        "unfinished": len(graded) - len(final),
        "mean": mean(scores) if scores else None,
        "median": median(scores) if scores else None,
        "bars": _bars(scores, most),
        "questions": questions,
        "reviews": queue,
        "open_count": sum(queued.count for queued in queue),
        "errors": [submission for submission in submitted if submission.result.error is not None],
        "doubts": [submission for submission in submitted if submission.result.doubt is not None],
        "students": submitted,
        "missing": [] if roster is None else [m.student for m in roster.members if m.student not in present],
    }


def _questions(prepared: Prepared, answers: dict[tuple[str, str], list[Item]]) -> Iterator[Question]:
    for problem, question in prepared.questions():
        items = answers[problem.id, question.id]
        counts = Counter(item.status for item in items)
        scores = [item.score for item in items if item.score is not None]
        errors = Counter(code for item in items for code in set(item.codes))
        unread = Counter(item.answer or "" for item in items if item.status == "unreadable")
        yield Question(
            f"{problem.id}.{question.id}",
            asked_text(question),
            [(status, counts[status], 100 * counts[status] / len(items)) for status in MARKS if counts[status]],
            mean(scores) if scores else None,
            float(question.points),
            mean(score >= question.points for score in scores) if scores else None,
            [(count, meanings().get(code, code)) for code, count in errors.most_common(MOST_LISTED)],
            [(count, text) for text, count in unread.most_common(MOST_LISTED)],
        )


def _bars(scores: Sequence[float], most: float) -> list[tuple[str, int, float]]:
    """Return (range of points, number of scores, percent of the highest bar) for each bar, without its upper end."""
    counts = Counter(min(int(percent(score, most) * BARS / 100 + 1e-9), BARS - 1) for score in scores)
    highest, step = max(counts.values(), default=1), most / BARS
    labels = [f"{number(i * step)}–{number((i + 1) * step)}" for i in range(BARS)]
    return [(label, counts[i], 100 * counts[i] / highest) for i, label in enumerate(labels)]


def write(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """Write a folder of pages. Raises FormatError if ``target`` cannot be a folder."""
    if not isinstance(target, Path) or (target.exists() and not target.is_dir()):
        raise FormatError("the format html writes a folder: give its name with --out")
    folder = target / "students"
    folder.mkdir(parents=True, exist_ok=True)
    names, submitted = FileNames(), list[Submitted]()
    for result in results:
        link = f"students/{names.of(result.student)}.html"
        (target / link).write_text(rendered("student.html", page=student_page(result, prepared)), encoding="utf-8")
        submitted.append(Submitted(result.student, link, result))
    page = overview(submitted, prepared, roster)
    (target / "index.html").write_text(rendered("overview.html", page=page), encoding="utf-8")


HTML = Format("html", write, endings=())
