"""A list for the lecturer of answers that count by a stand-in, where a platform takes nothing but a number.

An answer that could not be decided counts half there, one that could not be read nothing. Each has a row in a table, by
default ``dofkit-open.csv`` in the working folder (nbgrader's is ``autograded/STUDENT/SHEET``); the variable
``DOFKIT_OPEN`` names another. An answer that is decided later leaves the table.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from dofkit.homework.formats.cells import cell
from dofkit.homework.formats.wording import line, number, stand_in
from dofkit.homework.result import Item

VARIABLE, NAME = "DOFKIT_OPEN", "dofkit-open.csv"
COLUMNS = ("where", "problem", "question", "status", "points", "of", "answer", "why", "would be read as")
#: A longer table is begun anew.
MOST_BYTES = 20_000_000


def list_open(items: Iterable[Item], path: Path | None = None, where: str | None = None) -> None:
    """Put those of the answers that count by a stand-in into the table, and take the others out of it.

    A table that cannot be written is no reason to fail: what an answer is worth does not depend on it.
    """
    file = path or Path(os.environ.get(VARIABLE) or NAME)
    place = cell(line(str(Path.cwd()) if where is None else where))
    told = {_row(place, item)[:3]: _row(place, item) for item in items if _is_open(item)}
    gone = {_row(place, item)[:3] for item in items}
    with suppress(OSError, UnicodeError, csv.Error):
        before = _rows(file)
        rows = [row for row in before if tuple(row[:3]) not in gone]
        if not told and len(rows) == len(before):
            return
        beside = file.with_name(f".{file.name}.new")
        with beside.open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream).writerows([COLUMNS, *rows, *told.values()])
        os.replace(beside, file)


def _is_open(item: Item) -> bool:
    return item.score is None or item.status == "unreadable"


def _row(where: str, item: Item) -> tuple[str, ...]:
    texts = (item.answer or "", item.feedback, item.would_read or "")
    answer, why, nearest = (cell(line(text)) for text in texts)
    named = (where, cell(line(item.problem)), cell(line(item.question)))
    return (*named, item.status, number(stand_in(item)), number(item.max_score), answer, why, nearest)


def _rows(file: Path) -> list[list[str]]:
    """The rows that are there; none where it is another table."""
    if not file.exists() or file.stat().st_size > MOST_BYTES:
        return []
    with file.open(encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.reader(stream) if row]
    return rows[1:] if rows and tuple(rows[0]) == COLUMNS else []
