"""The queue of a review, gathered from results: every different answer that is open or was decided by a person."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from dofkit.homework.result import Item, Result
from dofkit.homework.review.identity import answer_id
from dofkit.homework.review.rows import ReviewRow

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
