"""The page of a review: every answer that waits for a person, by question, and those that were decided."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.html.pages import problem_title, question_text
from dofkit.homework.formats.html.rendering import rendered
from dofkit.homework.review.queue import Queue, QueuedAnswer
from dofkit.homework.review.rows import ReviewRow

#: Answers of each list that are shown; how many more there are is said.
MOST_SHOWN = 1000


class ReviewedQuestion(NamedTuple):
    """The open answers to one question."""

    name: str
    problem: str
    asked: str
    most: float
    answers: list[QueuedAnswer]


class ReviewPage(NamedTuple):
    """``more``: answers that are not shown; ``decided``: rows that a person filled in."""

    title: str
    questions: list[ReviewedQuestion]
    waiting: int
    students: int
    more: int
    decided: list[ReviewRow]
    table: str


def write_page(queue: Queue, rows: Iterable[ReviewRow], prepared: Prepared, path: Path, table: str) -> None:
    """Write the page whole. ``table``: what the file is called in which points are filled in. Raises OSError."""
    waiting = queue.open_answers()
    decided = [row for row in rows if row.decision is not None]
    page = ReviewPage(
        prepared.assignment.title,
        list(_questions(waiting[:MOST_SHOWN], prepared)),
        len(waiting),
        sum(queued.count for queued in waiting),
        max(0, len(waiting) - MOST_SHOWN),
        decided[:MOST_SHOWN],
        table,
    )
    beside = path.with_name(f".{path.name}.new")
    beside.write_text(rendered("review.html", page=page), encoding="utf-8")
    os.replace(beside, path)


def _questions(waiting: Sequence[QueuedAnswer], prepared: Prepared) -> Iterator[ReviewedQuestion]:
    known = {(problem.id, question.id): (problem, question) for problem, question in prepared.questions()}
    for place, answers in groupby(waiting, key=lambda queued: (queued.item.problem, queued.item.question)):
        if place in known:
            problem, question = known[place]
            name = f"{problem.id}.{question.id}"
            shown = list(answers)
            yield ReviewedQuestion(name, problem_title(problem), question_text(question), float(question.points), shown)
