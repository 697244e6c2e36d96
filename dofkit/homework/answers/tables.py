"""Tables of answers, as spreadsheets and forms write them: a header ``student,PROBLEM.QUESTION,...``, then rows.

The column that identifies the student may have any name that rosters know, such as ``Email Address``; the header of an
answer's column may go on after the question's name, as ``disc.f How many degrees of freedom?``. In a table with times
(``Timestamp``) a later row of the same student replaces an earlier one.

A broken row is reported with its line, and the rows after it are read. A table without a column for students, whose
every column is a question, is one person's: that of its only row. A table whose header names no question is an error,
because every row would be worth nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from dofkit.base.wording import nearest
from dofkit.homework.answers.roster import identity_column
from dofkit.homework.answers.spreadsheet import DELIMITERS, SpreadsheetRow, cells_of, spreadsheet
from dofkit.homework.answers.submission import clean

STUDENT = "student"
#: Headers of the column with the time of a submission, and how an answer's column begins.
_TIMES = frozenset({"timestamp", "time", "submitted", "submitted at", "completion time", "zeitstempel", "horodateur"})
_QUESTION = re.compile(r"\s*\[?(?P<name>[^\s:()\[\]]+)(?=$|[\s:()\]])")
#: Names that a message lists.
MOST_LISTED = 12

#: The problem and the question of a column ``PROBLEM.QUESTION``.
Columns = Mapping[str, tuple[str, str]]


@dataclass(frozen=True)
class TableRow:
    """A row of a table: its answers, or why there are none."""

    student: str
    line: int
    answers: Mapping[str, Mapping[str, str]]
    error: str | None = None


class TableError(ValueError):
    """A table that cannot be read."""


@dataclass(frozen=True)
class Header:
    """Which column of a table identifies the student, and what the others answer.

    ``student``: -1 if there is no such column. ``fault``: why no row of it can be graded.
    """

    student: int
    asked: tuple[tuple[str, str] | None, ...]
    fault: str | None = None


def rows(text: str, columns: Columns) -> Iterator[TableRow]:
    """Yield the rows of a table; ``student`` is empty where it has no such column. Raises TableError.

    Bytes that are not UTF-8 are lone surrogates in ``text``. ``columns``: those of the assignment, which say where a
    name with several dots is to be cut.
    """
    table = spreadsheet(text, lambda cells: identity_column(cells) >= 0).rows
    header = _header(next(table, None), columns)
    answered = [_row(header, row) for row in table]
    if header.student < 0 and len(answered) > 1:
        raise TableError(f"its header has no column '{STUDENT}', and there is more than one row")
    yield from answered


def _header(row: SpreadsheetRow | None, columns: Columns) -> Header:
    if row is None:
        raise TableError("it is empty")
    names = [cell.strip() for cell in row.cells]
    while names and not names[-1]:
        names.pop()
    student = identity_column(names)
    if row.error is not None or (student < 0 and not all(_asked(name, columns) for name in names)):
        listing = clean(", ".join(names))[:80]
        raise TableError(row.error or f"its header has no column '{STUDENT}' but {listing}")
    return _header_of(names, student, columns, row.line)


def is_header(line: str) -> bool:
    """Return whether a line begins a table: it has several cells, and one that identifies the student."""
    return any(delimiter in line and identity_column(cells_of(line, delimiter)) >= 0 for delimiter in DELIMITERS)


def _asked(name: str, columns: Columns) -> tuple[str, str] | None:
    """Return the question that a column answers: its header begins with the question's name."""
    match = _QUESTION.match(name)
    return columns.get(name) or (None if match is None else columns.get(match["name"]))


def _header_of(names: list[str], student: int, columns: Columns, line: int) -> Header:
    folded = [name.casefold() for name in names]
    twice = next(
        (n for i, n in enumerate(names) if n and (n in names[:i] or (i > student and folded[i] == STUDENT))), ""
    )
    questions = [None if i == student else _asked(name, columns) for i, name in enumerate(names)]
    fault = None
    if twice:
        fault = f"the header (line {line}) has the column '{clean(twice)[:60]}' twice"
    elif "" in names:
        fault = f"column {names.index('') + 1} of the header (line {line}) has no name"
    elif not any(questions):
        fault = f"the header (line {line}) names no question: {_meant(names, student, columns)}"
    elif (repeated := next((q for i, q in enumerate(questions) if q and q in questions[:i]), None)) is not None:
        fault = f"the header (line {line}) has two columns for {'.'.join(repeated)}"
    timed = not _TIMES.isdisjoint(folded)
    form = student >= 0 and folded[student] != STUDENT
    strange = [None if i == student or form or timed else _split(name) for i, name in enumerate(names)]
    asked = tuple(question or other for question, other in zip(questions, strange, strict=True))
    return Header(student, asked, fault)


def _meant(names: list[str], student: int, columns: Columns) -> str:
    """Return what the columns could have been called."""
    others = [name for i, name in enumerate(names) if i != student]
    near = next((f"'{near}' for '{clean(name)[:60]}'" for name in others if (near := nearest(name, columns))), None)
    listing = ", ".join(list(columns)[:MOST_LISTED]) + (", ..." if len(columns) > MOST_LISTED else "")
    return f"write {near or listing}" if near or listing else "no question of the assignment has this name"


def _split(name: str) -> tuple[str, str]:
    problem, _, question = clean(name).partition(".")
    return problem.strip(), question.strip()


def _row(header: Header, row: SpreadsheetRow) -> TableRow:
    cells, error = row.cells, row.error or header.fault
    width = len(header.asked)
    named = header.student >= 0
    student = clean(cells[header.student]).strip() if named and len(cells) > header.student else ""
    if error is None and (len(cells) < width or any(cell.strip() for cell in cells[width:])):
        error = f"the row has {len(cells)} cells, the header {width}"
    if error is None and named and not student:
        error = "the row has no student"
    if error is None and any(map(_undecoded, cells)):
        error = "the row is not in UTF-8 (save the table as UTF-8)"
    answers: dict[str, dict[str, str]] = {}
    for asked, cell in zip(header.asked, cells, strict=False) if error is None else ():
        if asked is not None and cell.strip():
            answers.setdefault(asked[0], {})[asked[1]] = cell
    return TableRow(student, row.line, answers, error)


def _undecoded(cell: str) -> bool:
    return not cell.isascii() and clean(cell) != cell
