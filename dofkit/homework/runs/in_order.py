"""Grading many submissions: in batches, by workers here or in a cluster, with the results in the order given."""

from __future__ import annotations

import sqlite3
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future

from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders, ResultLine
from dofkit.homework.runs.crew import GradingCrew
from dofkit.homework.runs.keeper import Graded

#: Seconds that a batch should take, and the most submissions and bytes in one.
BATCH_SECONDS, MOST_IN_BATCH, MOST_BYTES = 0.5, 256, 1_000_000
#: Batches under way for each worker.
AHEAD = 3


def in_order(crew: GradingCrew, handed: Iterable[Handed]) -> Iterator[tuple[Handed, list[ResultLine]]]:
    """Everything handed in with its lines, in order; no more of it is taken than the workers can use soon.

    Batches are so large that each takes about half a second: what is in one makes no difference to its results.
    """
    stream = iter(handed)
    under_way: deque[tuple[list[Handed], Future[Graded]]] = deque()
    size = 1
    while True:
        while len(under_way) < AHEAD * crew.width and (batch := _batch(stream, size)):
            under_way.append((batch, crew.submit(batch)))
        if not under_way:
            return
        batch, future = under_way.popleft()
        found = future.result()
        yield from zip(batch, found.lines, strict=True)
        wanted = int(len(batch) * BATCH_SECONDS / max(found.seconds, 1e-3))
        size = max(1, min(MOST_IN_BATCH, 2 * size, wanted))


def _batch(stream: Iterator[Handed], size: int) -> list[Handed]:
    found: list[Handed] = []
    held = 0
    while len(found) < size and held < MOST_BYTES:
        one = next(stream, None)
        if one is None:
            break
        found.append(one)
        held += one.size
    return found


def without_repeats(
    orders: Orders, graded: Iterable[tuple[Handed, list[ResultLine]]], seen: HandedIn
) -> Iterator[tuple[Handed, list[ResultLine]]]:
    """The same, but a student's second submission is refused, and both places are named.

    One of which a person has to say whose it is takes nobody's place.
    """
    for one, lines in graded:
        told = []
        for line in lines:
            before = None if line.failed or line.doubted else seen.first(line.student, str(one.place))
            if before is not None:
                why = f"{one.place}: '{line.student}' has handed in before, at {before}: only the first is graded"
                line = orders.refused(line.student, why)
            told.append(line)
        yield one, told


class HandedIn:
    """Who has handed in, and where; kept in a file that the system takes away, not in memory."""

    def __init__(self) -> None:
        self._known = sqlite3.connect("", isolation_level=None)
        self._known.execute("PRAGMA journal_mode = OFF")
        self._known.execute("PRAGMA synchronous = OFF")
        self._known.execute("CREATE TABLE seen (student TEXT PRIMARY KEY, place TEXT) WITHOUT ROWID")
        self._known.execute("BEGIN")

    def first(self, student: str, place: str) -> str | None:
        """Note a submission; where the student has handed in before, that place."""
        known = self._known.execute("INSERT OR IGNORE INTO seen VALUES (?, ?)", (student, place))
        if known.rowcount:
            return None
        found = self._known.execute("SELECT place FROM seen WHERE student = ?", (student,)).fetchone()
        return str(found[0])

    def close(self) -> None:
        """Forget everything."""
        self._known.close()
