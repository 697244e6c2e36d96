"""What the lecturer's page shows: gathered submission by submission, in memory that does not grow with their number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.html.pages import BADGES, percent, question_text
from dofkit.homework.formats.wording import number
from dofkit.homework.key.misconceptions import ERRORS
from dofkit.homework.result import Item, Result, Status

#: Rows of each list that are shown; how many more there are is said.
MOST_ROWS = 1000
#: Bars of the distribution.
BARS = 10


class Review(NamedTuple):
    """An answer for a person to look at."""

    student: str
    link: str
    item: Item


@dataclass
class Listed:
    """The first rows of a list, and how many there are in all."""

    rows: list[Any] = field(default_factory=list)
    count: int = 0

    def add(self, row: Any) -> None:
        self.count += 1
        if len(self.rows) < MOST_ROWS:
            self.rows.append(row)

    @property
    def more(self) -> int:
        return self.count - len(self.rows)


class Student(NamedTuple):
    """A submission in a list."""

    name: str
    link: str
    result: Result

    @property
    def points(self) -> str:
        return "–" if self.result.score is None else number(self.result.score)


class Bar(NamedTuple):
    """One bar of the distribution: ``height`` in percent of the highest."""

    label: str
    tally: int
    height: float


class Question(NamedTuple):
    """How one question went: ``counts`` of its statuses, and ``mean`` of what was decided, in points."""

    name: str
    asked: str
    counts: list[tuple[Status, int, float]]
    mean: float | None
    most: float


class Overview:
    """The page of a run: ``add`` every submission, then ``page``."""

    def __init__(self, prepared: Prepared) -> None:
        self.prepared = prepared
        self.most = float(sum(question.points for _, question in prepared.questions()))
        self.scores: Counter[float] = Counter()
        self.statuses: dict[tuple[str, str], Counter[Status]] = {
            (problem.id, question.id): Counter() for problem, question in prepared.questions()
        }
        self.gained = dict.fromkeys(self.statuses, 0.0)
        self.codes: Counter[str] = Counter()
        self.reviews, self.errors, self.students = Listed(), Listed(), Listed()
        self.unfinished = 0

    def add(self, result: Result, link: str) -> None:
        """One more submission; ``link``: where its page is."""
        self.students.add(Student(result.student, link, result))
        if result.error is not None:
            self.errors.add(Student(result.student, link, result))
            return
        if result.needs_review:
            self.unfinished += 1
        else:
            self.scores[round(result.score or 0.0, 2)] += 1
        for item in result.items:
            self._item(item, result.student, link)

    def _item(self, item: Item, student: str, link: str) -> None:
        place = item.problem, item.question
        if place in self.statuses:
            self.statuses[place][item.status] += 1
            self.gained[place] += item.score or 0.0
            self.codes.update(set(item.codes))
        if item.status == "needs_review":
            self.reviews.add(Review(student, link, item))

    def page(self) -> dict[str, Any]:
        """What the template shows."""
        hints = {error.code: error.hint for error in ERRORS}
        return {
            "title": self.prepared.assignment.title,
            "most": self.most,
            "graded": self.scores.total(),
            "unfinished": self.unfinished,
            "mean": _mean(self.scores),
            "median": _median(self.scores),
            "bars": _bars(self.scores, self.most),
            "questions": list(self._questions()),
            "codes": [(code, count, hints.get(code, "")) for code, count in self.codes.most_common()],
            "reviews": self.reviews,
            "errors": self.errors,
            "students": self.students,
        }

    def _questions(self) -> Iterator[Question]:
        for problem, question in self.prepared.questions():
            place = problem.id, question.id
            counts = self.statuses[place]
            total = counts.total()
            shares = [(status, counts[status], 100 * counts[status] / total) for status in BADGES if counts[status]]
            known = total - counts["needs_review"]
            mean = self.gained[place] / known if known else None
            yield Question(f"{problem.id}.{question.id}", question_text(question), shares, mean, float(question.points))


def _mean(scores: Counter[float]) -> float | None:
    return sum(score * count for score, count in scores.items()) / scores.total() if scores else None


def _median(scores: Counter[float]) -> float | None:
    """The middle score, or the mean of the two in the middle."""
    if not scores:
        return None
    total = scores.total()
    return (_ranked(scores, (total - 1) // 2) + _ranked(scores, total // 2)) / 2


def _ranked(scores: Counter[float], rank: int) -> float:
    """The score with ``rank`` lower or equal ones before it."""
    for score in sorted(scores):
        rank -= scores[score]
        if rank < 0:
            break
    return score


def _bars(scores: Counter[float], most: float) -> list[Bar]:
    """How many have how many points, in equal steps; each step without its upper end, the last one with it."""
    counts = [0] * BARS
    for score, count in scores.items():
        counts[min(int(percent(score, most) * BARS / 100 + 1e-9), BARS - 1)] += count
    highest = max(*counts, 1)
    step = most / BARS
    return [
        Bar(f"{number(i * step)}–{number((i + 1) * step)}", count, 100 * count / highest)
        for i, count in enumerate(counts)
    ]
