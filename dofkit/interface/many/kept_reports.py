"""Reports in a folder, a line each in the order of the files: what was answered before is not asked again.

Every line is written when all before it are. The ledger beside them stays: a later run asks only about files that
changed or came. Where an order changed, what was known is kept apart until all is done.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.line_journal import LineJournal
from dofkit.base.version import __version__
from dofkit.interface.supervised import Given

REPORTS, BEFORE, LEDGER = "reports.jsonl", "reports.before.jsonl", ".ledger"


class KeptReport(NamedTuple):
    """The line of a scene, and of a report what a summary counts (None: it could not be read)."""

    line: str
    outcome: Mapping[str, Any] | None


def mark_of(asked: Given) -> str:
    """What tells a run from others: who answers, and what is asked of every scene."""
    telling = asked.telling
    parts = (asked.budget, asked.method, telling.only, telling.without, telling.limits, asked.certificate)
    return hashlib.blake2b(repr((__version__, *parts)).encode(), digest_size=16).hexdigest()


class KeptReports:
    """The reports in a folder; ``path`` is their file. Raises OSError, and BusyError where another run writes there."""

    def __init__(self, folder: Path, mark: str) -> None:
        self.path = folder / REPORTS
        self._kept = LineJournal(self.path, mark, LEDGER)
        self._mark = mark
        self._before: _KnownBefore | None = None

    def next_known(self, key: str) -> KeptReport | None:
        """What was answered of a file that has not changed since, where its line stands next."""
        found = self._kept.next_known(key)
        return None if found is None else _report(found.texts[0], found.note)

    def write_from_here(self) -> None:
        """Drop all lines from here on; what they say stays known."""
        self._before = _KnownBefore(self.path.with_name(BEFORE), self._mark, self._kept)
        self._kept.cut()

    def knows(self, key: str) -> bool:
        """Was a file answered, as it is now, in a line that was dropped?"""
        return self._before is not None and self._before.place(key) is not None

    def write_known(self, key: str) -> KeptReport:
        """Write the line of a file that it `knows`."""
        found = None if self._before is None else self._before.report(key)
        if found is None:
            raise KeyError(key)
        self.write(key, found)
        return found

    def write(self, key: str, report: KeptReport) -> None:
        """Write the next line."""
        line = report.line if report.line.endswith("\n") else report.line + "\n"
        self._kept.write(key, [line.encode("utf-8", "surrogateescape")], json.dumps(report.outcome))

    def finish(self) -> None:
        """All stands in the folder."""
        if self._before is not None:
            self._before.finish()
            self._before = None

    def close(self) -> None:
        """Stop here; another run may go on."""
        self._kept.close()
        if self._before is not None:
            self._before.close()


class _KnownBefore:
    """What a journal held beyond its place, kept in a file of its own, found by its key."""

    def __init__(self, path: Path, mark: str, beyond: LineJournal) -> None:
        self._kept = LineJournal(path, mark, LEDGER)
        self._places = sqlite3.connect("", isolation_level=None)
        self._places.execute("PRAGMA journal_mode = OFF")
        self._places.execute("CREATE TABLE known (key TEXT PRIMARY KEY, place INTEGER, note TEXT) WITHOUT ROWID")
        self._places.execute("BEGIN")
        for noted in self._kept.following():
            self._note(noted.key, noted.place, noted.note)
        self._kept.to_end()
        for noted in beyond.following():
            place = self._kept.write(noted.key, noted.texts, noted.note)
            self._note(noted.key, place, noted.note)

    def _note(self, key: str, place: int, note: str) -> None:
        self._places.execute("INSERT OR REPLACE INTO known VALUES (?, ?, ?)", (key, place, note))

    def place(self, key: str) -> tuple[int, str] | None:
        """Where it stands, and its note."""
        found = self._places.execute("SELECT place, note FROM known WHERE key = ?", (key,)).fetchone()
        return None if found is None else (int(found[0]), str(found[1]))

    def report(self, key: str) -> KeptReport | None:
        """What was answered before."""
        found = self.place(key)
        return None if found is None else _report(self._kept.text_at(found[0]), found[1])

    def close(self) -> None:
        """Keep it for the next run."""
        self._places.close()
        self._kept.close()

    def finish(self) -> None:
        """It is no longer needed."""
        self._places.close()
        self._kept.finish()
        self._kept.path.unlink(missing_ok=True)


def _report(text: bytes, note: str) -> KeptReport:
    return KeptReport(text.decode("utf-8", "surrogateescape"), json.loads(note))
