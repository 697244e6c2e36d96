"""The review's table and its page, beside the results, whatever the format of those.

The table is in UTF-8 with the mark by which Excel knows that, and has semicolons where Excel of the assignment's
language expects them, or what the table had before. No cell in it begins as a formula does, and answers begin with a
letter or an apostrophe, so that no spreadsheet takes ``1/2`` for a date.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.cells import cell
from dofkit.homework.formats.wording import unmarked
from dofkit.homework.review.rows import COLUMNS, ReviewRow

#: Of languages whose Excel takes commas for decimal signs.
_SEMICOLONS = frozenset({"de", "fr", "es"})
_ANSWERS = frozenset({"text", "readings"})
_FILLED = frozenset({"remark", "decided_by"})


def write_table(rows: Iterable[ReviewRow], prepared: Prepared, path: Path, delimiter: str | None) -> None:
    """Write the table whole: it never stands there in part. ``delimiter``: the one it had before. Raises OSError."""
    chosen = delimiter or (";" if prepared.assignment.language in _SEMICOLONS else ",")
    beside = path.with_name(f".{path.name}.new")
    with beside.open("w", encoding="utf-8-sig", newline="") as stream:
        writer = csv.writer(stream, delimiter=chosen, lineterminator="\r\n")
        writer.writerow(COLUMNS)
        for row in rows:
            writer.writerow(_cells(row.cells, chosen))
    os.replace(beside, path)


def _cells(cells: Mapping[str, str], delimiter: str) -> list[str]:
    """The cells of a row; what a person wrote stays as it is."""
    found = []
    for name in COLUMNS:
        text = cells.get(name, "")
        if name in _ANSWERS:
            text = cell(text) if text[:1].isalpha() or not text else f"'{cell(text).removeprefix(chr(39))}"
        elif name == "would_earn" and delimiter == ";":
            text = text.replace(".", ",")
        elif name != "points":
            text = cell(text if name in _FILLED else unmarked(text))
        found.append(text)
    return found
