"""The queue of a review: every different answer that waits for a person or was decided by one, and its identity.

The identity of an answer stands for the question and for what was answered, not for the student. Vowels and digits do
not occur in it, so that no spreadsheet takes it for a number, a date, a formula or a word; its last letter reveals a
mistyped one.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from dofkit.homework.result import Item, Result

#: The columns of the table, in order; those that a person fills in come last.
COLUMNS = (
    "id", "problem", "question", "variant", "text", "why", "readings", "would_earn", "max_points", "students",
    "given_by", "points", "remark", "decided_by",
)  # fmt: skip
#: Who decided, where the table does not say.
SOMEONE = "review"


class Decision(NamedTuple):
    """The points that a person gave an answer, what the person says to it, and who that is."""

    points: Fraction
    remark: str = ""
    by: str = SOMEONE


#: What a person decided, by the answer's identity.
Decisions = Mapping[str, Decision]


@dataclass(frozen=True)
class ReviewRow:
    """One row, every cell as text; ``decision`` is what its last columns say, None while it is open."""

    cells: Mapping[str, str]
    decision: Decision | None = None

    @property
    def id(self) -> str:
        """The answer's identity."""
        return self.cells["id"]

    @property
    def filled(self) -> bool:
        """Has a person written anything into it?"""
        return self.decision is not None or bool(self.cells.get("remark"))


_LETTERS = "bcdfghjkmnpqrstvwxz"
_OF_QUESTION, _OF_ANSWER = 5, 10
_SHAPE = re.compile(f"([{_LETTERS}]{{{_OF_QUESTION}}})-([{_LETTERS}]{{{_OF_ANSWER}}})-([{_LETTERS}])")


def question_mark(problem: str, question: str) -> str:
    """The part of an identity that stands for the question.

    >>> question_mark("p", "f") != question_mark("p", "g")
    True
    """
    return _letters(_OF_QUESTION, problem, question)


def answer_id(problem: str, question: str, text: str, variant: str = "") -> str:
    """The identity of an answer; blanks tell nothing. ``variant``: of the problem, where students have different ones.

    >>> answer_id("p", "f", "x  = 1") == answer_id("p", "f", " x = 1\\n") != answer_id("p", "f", "x = 2")
    True
    """
    said = " ".join(unicodedata.normalize("NFC", text).split())
    body = f"{question_mark(problem, question)}-{_letters(_OF_ANSWER, problem, question, variant, said)}"
    return f"{body}-{_letters(1, body)}"


def mark_of(identity: str) -> str | None:
    """The question's part of an identity; None of what is none.

    >>> mark_of(answer_id("p", "f", "1")) == question_mark("p", "f"), mark_of("bcdfg-bcdfghjkmn-x")
    (True, None)
    """
    found = _SHAPE.fullmatch(identity)
    if found is None or _letters(1, f"{found[1]}-{found[2]}") != found[3]:
        return None
    return found[1]


def _letters(count: int, *parts: str) -> str:
    data = "\0".join(parts).encode("utf-8", "surrogatepass")
    number = int.from_bytes(hashlib.blake2b(data, digest_size=16).digest(), "big")
    return "".join(_LETTERS[number // len(_LETTERS) ** i % len(_LETTERS)] for i in range(count))


#: Students of one answer who are named.
MOST_NAMED = 20


@dataclass
class QueuedAnswer:
    """A different answer: an ``item`` that it got, and how many gave it, of whom the first ones are named.

    ``variant``: of the problem, where students have different ones, and what it says as far as that is known.
    """

    id: str
    item: Item
    count: int = 0
    students: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    variant: str = ""

    @property
    def open(self) -> bool:
        """Does it wait for a person?"""
        return self.item.score is None

    def add(self, student: str, link: str) -> None:
        """One more student who gave it; ``link``: where the student's page is."""
        self.count += 1
        if len(self.students) < MOST_NAMED:
            self.students.append(student)
            self.links.append(link)


class Queue:
    """``add`` every result, then look at ``open_answers``; questions are in the order given."""

    def __init__(self, questions: Sequence[tuple[str, str]]) -> None:
        self._order = {place: i for i, place in enumerate(questions)}
        self.answers: dict[str, QueuedAnswer] = {}

    def add(self, result: Result, link: str = "") -> None:
        """One more submission."""
        for item in result.items:
            if item.score is None or item.decided_by is not None:
                identity = answer_id(item.problem, item.question, item.answer or "", item.variant or "")
                queued = self.answers.setdefault(identity, QueuedAnswer(identity, item, variant=item.variant or ""))
                queued.add(result.student, link)

    def open_answers(self) -> list[QueuedAnswer]:
        """What waits for a person: by question, what most students gave first."""
        return sorted(
            (queued for queued in self.answers.values() if queued.open),
            key=lambda queued: (self._order.get((queued.item.problem, queued.item.question), -1), -queued.count),
        )

    def rows(self, before: Mapping[str, ReviewRow]) -> Iterator[ReviewRow]:
        """The rows to write: what is open first, then what a person has written into before, whoever gave it now.

        ``before``: the rows that were there; none that a person has written into is lost.
        """
        for queued in self.open_answers():
            old = before.get(queued.id)
            kept = {} if old is None else {name: old.cells.get(name, "") for name in ("remark", "decided_by")}
            yield ReviewRow({**cells_of(queued), **kept}, None if old is None else old.decision)
        for identity, row in before.items():
            now = self.answers.get(identity)
            if row.filled and (now is None or not now.open):
                counted = {"students": "0"} if now is None else _who(now)
                yield ReviewRow({**row.cells, **counted}, row.decision)


def cells_of(queued: QueuedAnswer) -> dict[str, str]:
    """The cells of an open answer that dofkit fills in."""
    item = queued.item
    ways = [(way.read_as, way.score) for way in item.readings] or ([(item.read_as, None)] if item.read_as else [])
    place = f"column {item.column}: " if item.column is not None and item.status == "unreadable" else ""
    return {
        "id": queued.id,
        "problem": item.problem,
        "question": item.question,
        "variant": queued.variant,
        "text": item.answer or "",
        "why": place + item.feedback,
        "readings": " | ".join(read_as for read_as, _ in ways),
        "would_earn": " | ".join("open" if score is None else f"{score:g}" for _, score in ways),
        "max_points": f"{item.max_score:g}",
        **_who(queued),
    }


def _who(queued: QueuedAnswer) -> dict[str, str]:
    more = queued.count - len(queued.students)
    named = "; ".join(queued.students) + (f"; and {more} more" if more else "")
    return {"students": str(queued.count), "given_by": named}
