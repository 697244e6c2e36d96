"""Of a student's submissions in one run only the first is graded."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator

from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders, ResultLine


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
                why = f"{one.place}: '{line.student}' already submitted in {before}: only the first is graded"
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
