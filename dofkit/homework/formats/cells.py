"""Cells of tables that spreadsheets open: nothing in them is a formula, and numbers stay numbers."""

from __future__ import annotations

import csv
import hashlib
import re
from typing import Any, TextIO

from dofkit.homework.formats.wording import identity, plain

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


def is_cell(student: str) -> bool:
    """Can a name stand in a cell as it is, so that it is found again?

    >>> is_cell("Ada B"), is_cell("=1"), is_cell("ada\u200e"), is_cell(" ")
    (True, False, False, False)
    """
    return bool(student.strip()) and cell(identity(student)) == student


def mark_of(student: str) -> bytes:
    """What tells a student from others, short."""
    return hashlib.blake2b(student.encode("utf-8", "surrogatepass"), digest_size=12).digest()
