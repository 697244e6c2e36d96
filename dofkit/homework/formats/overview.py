"""What the lecturer's page shows: gathered submission by submission, in memory that does not grow with their number."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.pages import BADGES, percent, question_text
from dofkit.homework.formats.wording import number
from dofkit.homework.key.misconceptions import CODES
from dofkit.homework.result import Item, Result, Status
from dofkit.homework.review import Queue, QueuedAnswer

#: Rows of each list that are shown; how many more there are is said.
MOST_ROWS = 1000
#: Bars of the distribution; open answers that are listed, each with so many students.
BARS, MOST_OPEN, MOST_STUDENTS = 10, 100, 8
#: Errors and unreadable texts that are listed for a question.
MOST_LISTED = 3
#: So many answers, and such a part of all, that could not be read make a question doubtful.
FEWEST_UNREAD, LEAST_UNREAD = 2, 0.2


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


class OpenAnswer(NamedTuple):
    """A different answer that waits for a person; ``given_by``: the first students and their pages."""

    item: Item
    given_by: list[tuple[str, str]]
    unnamed: int


def _listed(queued: QueuedAnswer) -> OpenAnswer:
    given_by = list(zip(queued.students, queued.links, strict=True))[:MOST_STUDENTS]
    return OpenAnswer(queued.item, given_by, queued.count - len(given_by))


class Question(NamedTuple):
    """How one question went: ``counts`` of its statuses, and ``mean`` of what was decided, in points.

    ``unread`` of so many ``given`` answers could not be read, the commonest of which are ``unread_texts``; ``right``:
    the share of the graded answers with full points; ``errors``: the commonest errors.
    """

    name: str
    asked: str
    counts: list[tuple[Status, int, float]]
    mean: float | None
    most: float
    unread: int
    given: int
    right: float | None
    errors: list[tuple[int, str]]
    unread_texts: list[tuple[int, str]]

    @property
    def doubt(self) -> str:
        """What to ask of a question whose answers often could not be read; empty where they could."""
        if self.unread < FEWEST_UNREAD or self.unread < LEAST_UNREAD * self.given:
            return ""
        return f"{self.unread} of {self.given} answers could not be read: is the question clear?"


class Overview:
    """The page of a run: ``add`` every submission, then ``page``. A ``roster`` tells who did not submit."""

    def __init__(self, prepared: Prepared, roster: Roster | None = None) -> None:
        self.prepared = prepared
        self.right: Counter[tuple[str, str]] = Counter()
        self.errors_of: defaultdict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        self.unread: defaultdict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        self.missing = {} if roster is None else {member.student: None for member in roster.members}
        self.most = float(sum(question.points for _, question in prepared.questions()))
        self.scores: Counter[float] = Counter()
        self.statuses: dict[tuple[str, str], Counter[Status]] = {
            (problem.id, question.id): Counter() for problem, question in prepared.questions()
        }
        self.gained = dict.fromkeys(self.statuses, 0.0)
        self.decided: Counter[tuple[str, str]] = Counter()
        self.codes: Counter[str] = Counter()
        self.queue = Queue(list(self.statuses))
        self.errors, self.doubts, self.students = Listed(), Listed(), Listed()
        self.unfinished = 0

    def add(self, result: Result, link: str) -> None:
        """One more submission; ``link``: where its page is."""
        self.students.add(Student(result.student, link, result))
        self.missing.pop(result.student, None)
        if result.doubt is not None:
            self.doubts.add(Student(result.student, link, result))
        if result.error is not None:
            self.errors.add(Student(result.student, link, result))
            return
        if result.needs_review or result.doubt is not None:
            self.unfinished += 1
        else:
            self.scores[round(result.score or 0.0, 2)] += 1
        self.queue.add(result, link)
        for item in result.items:
            self._item(item)

    def _item(self, item: Item) -> None:
        place = item.problem, item.question
        if place in self.statuses:
            self.statuses[place][item.status] += 1
            self.gained[place] += item.score or 0.0
            self.decided[place] += item.score is not None
            self.codes.update(set(item.codes))
            self.errors_of[place].update(set(item.codes))
            self.right[place] += item.score is not None and item.score >= item.max_score
            texts, text = self.unread[place], item.answer or ""
            if item.status == "unreadable" and (text in texts or len(texts) < MOST_ROWS):
                texts[text] += 1

    def page(self) -> dict[str, Any]:
        """What the template shows."""
        waiting, questions = self.queue.open_answers(), list(self._questions())
        return {
            "title": self.prepared.assignment.title,
            "most": self.most,
            "graded": self.scores.total(),
            "unfinished": self.unfinished,
            "mean": _mean(self.scores),
            "median": _median(self.scores),
            "bars": _bars(self.scores, self.most),
            "questions": questions,
            "unclear": max((q for q in questions if q.doubt), key=lambda q: q.unread / q.given, default=None),
            "codes": [(code, count, CODES.get(code, "")) for code, count in self.codes.most_common()],
            "reviews": [_listed(queued) for queued in waiting[:MOST_OPEN]],
            "different": len(waiting),
            "open_count": sum(queued.count for queued in waiting),
            "errors": self.errors,
            "doubts": self.doubts,
            "students": self.students,
            "missing": list(self.missing)[:MOST_ROWS],
        }

    def _questions(self) -> Iterator[Question]:
        for problem, question in self.prepared.questions():
            place = problem.id, question.id
            counts = self.statuses[place]
            total = counts.total()
            shares = [(status, counts[status], 100 * counts[status] / total) for status in BADGES if counts[status]]
            known, given = self.decided[place], total - counts["missing"]
            mean = self.gained[place] / known if known else None
            yield Question(
                f"{problem.id}.{question.id}", question_text(question), shares, mean, float(question.points),
                counts["unreadable"], given, self.right[place] / known if known else None,
                [(count, CODES.get(code, code)) for code, count in self.errors_of[place].most_common(MOST_LISTED)],
                [(count, text) for text, count in self.unread[place].most_common(MOST_LISTED)],
            )  # fmt: skip


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
