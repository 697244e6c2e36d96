"""Reads tables saved by spreadsheets and forms: encoding, delimiter, and rows with line numbers."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from io import StringIO
from itertools import islice
from typing import NamedTuple

#: Separators of columns, the most usual first.
DELIMITERS = ",;\t|"
#: The most lines and characters of one row.
MOST_LINES, MOST_CHARACTERS = 200, 1_000_000
csv.field_size_limit(MOST_CHARACTERS)
_OPEN = "a quotation mark is never closed"


class SpreadsheetRow(NamedTuple):
    """The number of the first line of a row, its cells, and why they cannot be separated, or None."""

    line: int
    cells: list[str]
    error: str | None = None


class Spreadsheet(NamedTuple):
    """A table: its delimiter, and the rows that are not blank, the header first."""

    delimiter: str
    rows: Iterator[SpreadsheetRow]


def decoded(data: bytes) -> str:
    """Return data as text, in UTF-16 by its first bytes, else in UTF-8; other bytes become lone surrogates."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    return data.decode("utf-8-sig", "surrogateescape")


def cells_of(line: str, delimiter: str) -> list[str]:
    """Return the cells of a header in lower case."""
    return [cell.strip(' "\r\n').lower() for cell in line.split(delimiter)]


def spreadsheet(text: str, is_header: Callable[[list[str]], bool]) -> Spreadsheet:
    """Return the table in a text; a first line such as ``sep=;`` gives its delimiter.

    ``is_header``: whether cells in lower case are a header, for choosing the delimiter. A row that cannot be separated
    into cells is one line with its error; the rows after it are read.
    """
    lines = list(StringIO(text, newline=""))
    start = _first(lines, 0)
    first = lines[start].strip() if start < len(lines) else ""
    if first[:4].lower() == "sep=" and len(first) == len("sep=,"):
        start = _first(lines, start + 1)
        return Spreadsheet(first[4], _rows(lines, start, first[4]))
    header = lines[start] if start < len(lines) else ""
    delimiter = max(DELIMITERS, key=lambda d: (is_header(cells_of(header, d)), header.count(d)))
    return Spreadsheet(delimiter, _rows(lines, start, delimiter))


def _first(lines: list[str], start: int) -> int:
    """Return the index of the first line that is not blank."""
    return next((n for n in range(start, len(lines)) if lines[n].strip(" \t\r\n,;|")), len(lines))


def _rows(lines: list[str], start: int, delimiter: str) -> Iterator[SpreadsheetRow]:
    while start < len(lines):
        end, cells, error = start, list[str](), None
        while end == start or (error == _OPEN and end < min(len(lines), start + MOST_LINES)):
            end += 1
            cells, error = _cells("".join(lines[start:end]), delimiter)
        if error is not None:
            end, cells = start + 1, lines[start].rstrip("\r\n").replace('"', "").split(delimiter)
        if any(cell.strip() for cell in cells):
            yield SpreadsheetRow(start + 1, cells, error)
        start = end


def _cells(text: str, delimiter: str) -> tuple[list[str], str | None]:
    if len(text) > MOST_CHARACTERS:
        return [], f"the row has {len(text)} characters"
    try:
        rows = list(islice(csv.reader(StringIO(text, newline=""), delimiter=delimiter, strict=True), 1))
    except csv.Error as error:
        said = str(error)
        if "unexpected end" in said:
            return [], _OPEN
        return [], "a quote stands inside a cell" if "expected after" in said else said
    return (rows[0] if rows else []), None
