"""Cells of tables that spreadsheets open: nothing in them is a formula, and numbers stay numbers."""

from __future__ import annotations

import csv
import hashlib
import re
from collections.abc import Iterable, Iterator
from typing import Any, TextIO

from dofkit.homework.formats.wording import plain
from dofkit.homework.result import Result

#: What spreadsheets take for the beginning of a formula, also behind spaces, and in its full-width forms.
_FORMULA = re.compile("\\s*[=+\\-@|\uff1d\uff0b\uff0d\uff20\u2212]|[\t\r\n]")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")
#: More than a spreadsheet holds in a cell.
MOST_CHARACTERS = 32_000


def cell(text: str) -> str:
    """A text as a cell: an apostrophe stands before what a spreadsheet would take for a formula.

    >>> cell("=cmd|'/C calc'!A0"), cell("-2"), cell("-2+3"), cell("Ada")
    ("'=cmd|'/C calc'!A0", '-2', "'-2+3", 'Ada')
    """
    shown = plain(text)
    if len(shown) > MOST_CHARACTERS:
        shown = shown[: MOST_CHARACTERS - 3] + "..."
    return f"'{shown}" if _FORMULA.match(shown) and not _NUMBER.fullmatch(shown) else shown


def table(stream: TextIO) -> Any:
    """A writer of comma-separated rows, as RFC 4180 has them."""
    return csv.writer(stream, lineterminator="\r\n")


def one_each(results: Iterable[Result]) -> Iterator[Result]:
    """One result a student, for a gradebook takes one row of each, and a second one could wipe the grade of the first.

    What could not be graded comes last, and only of students of whom nothing else is there.
    """
    seen: set[bytes] = set()
    refused: list[Result] = []
    for result in results:
        if result.error is not None:
            refused.append(result)
        elif _new(result.student, seen):
            yield result
    yield from (result for result in refused if _new(result.student, seen))


def _new(student: str, seen: set[bytes]) -> bool:
    """Was the student not there before? Kept as a short mark."""
    mark = hashlib.blake2b(student.encode("utf-8", "surrogatepass"), digest_size=12).digest()
    if mark in seen:
        return False
    seen.add(mark)
    return True
