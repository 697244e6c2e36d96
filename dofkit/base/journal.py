"""Results that outlive an interrupted run, in one SQLite file: the next run does not work out again what is there."""

from __future__ import annotations

import json
import sqlite3
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError

#: Seconds after which results are committed; a killed run loses those of as many seconds.
COMMITTING = 0.25


class BusyError(DofkitError):
    """Another run writes to the same file."""


def files_of(path: Path) -> list[Path]:
    """The files of a journal at a path: the second one is there while something is written."""
    return [path, path.with_name(path.name + "-journal")]


class Journal:
    """Results by their keys, at ``path``.

    ``mark``: the question that the results answer; results with another mark are forgotten, and so is a damaged file.
    A result is what json can write. Raises BusyError where another run has the file open, and OSError.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self.path = path
        self._committed = time.monotonic()
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            self._results = self._opened(mark)
        except sqlite3.OperationalError as error:
            if "locked" in str(error):
                raise BusyError(f"another run is writing to {path.with_suffix('')}") from None
            raise OSError(f"{path} cannot be written: {error}") from None
        except sqlite3.DatabaseError:
            path.unlink()
            self._results = self._opened(mark)

    def _opened(self, mark: str) -> sqlite3.Connection:
        opened = sqlite3.connect(self.path, timeout=0, isolation_level=None)
        try:
            # The operating system keeps what a killed process wrote; nothing has to survive a loss of power.
            opened.executescript("PRAGMA locking_mode = EXCLUSIVE; PRAGMA synchronous = OFF; BEGIN EXCLUSIVE; COMMIT;")
            opened.execute("CREATE TABLE IF NOT EXISTS mark (mark TEXT PRIMARY KEY)")
            opened.execute("CREATE TABLE IF NOT EXISTS results (key TEXT PRIMARY KEY, result TEXT, new INTEGER)")
            if opened.execute("SELECT mark FROM mark").fetchone() != (mark,):
                opened.executescript("DELETE FROM mark; DELETE FROM results")
                opened.execute("INSERT INTO mark VALUES (?)", (mark,))
            opened.execute("UPDATE results SET new = 0 WHERE new")
            opened.execute("BEGIN")
        except sqlite3.Error:
            opened.close()
            raise
        return opened

    def result(self, key: str) -> Any:
        """The result with a key; None where there is none."""
        row = self._results.execute("SELECT result FROM results WHERE key = ?", (key,)).fetchone()
        return None if row is None else json.loads(row[0])

    def write(self, key: str, result: Any) -> None:
        """Note a result."""
        self._results.execute("INSERT OR REPLACE INTO results VALUES (?, ?, 1)", (key, json.dumps(result)))
        if time.monotonic() > self._committed + COMMITTING:
            self._results.execute("COMMIT")
            self._results.execute("BEGIN")
            self._committed = time.monotonic()

    def keep_written(self) -> None:
        """Forget the results of earlier runs that this one did not write again."""
        self._results.execute("DELETE FROM results WHERE NOT new")

    def close(self) -> None:
        """Stop here; another run may go on."""
        with suppress(sqlite3.Error):
            self._results.execute("COMMIT")
        self._results.close()

    def remove(self) -> None:
        """Remove the file: the next run begins anew."""
        self.close()
        self.path.unlink(missing_ok=True)
