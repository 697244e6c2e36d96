"""Tables of answers from spreadsheets and forms: a header ``student,PROBLEM.QUESTION,...``, then rows.

The column that identifies the student may have any name known to rosters, such as ``Email Address``; the header of a
column of answers may continue after the question's name, as in ``disc.f How many degrees of freedom?``.

A broken row is reported with its line, and the rows after it are read. A table without a column for students must have
only columns of questions and one row. A table whose header names no question is an error, because every row would be
worth nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from dofkit.base.wording import nearest
from dofkit.homework.answers.roster import identity_column
from dofkit.homework.answers.spreadsheet import SpreadsheetRow, spreadsheet
from dofkit.homework.answers.submission import clean

STUDENT = "student"
#: Headers of the column with the time of a submission, and the beginning of the header of a question.
_TIMES = frozenset({"timestamp", "time", "submitted", "submitted at", "completion time", "zeitstempel", "horodateur"})
_QUESTION = re.compile(r"\s*\[?(?P<name>[^\s:()\[\]]+)(?=$|[\s:()\]])")
#: The most names in a message.
MOST_LISTED = 12

#: {PROBLEM.QUESTION: (problem, question)}.
Columns = Mapping[str, tuple[str, str]]
#: The (problem, question) of a column of a table; None for other columns.
Asked = tuple[str, str] | None


class TableRow(NamedTuple):
    """A row of a table: {problem: {question: answer}}, or the error for which there are none."""

    student: str
    line: int
    answers: Mapping[str, Mapping[str, str]]
    error: str | None = None


class TableError(ValueError):
    """A table that cannot be read."""


def rows(text: str, columns: Columns) -> Iterator[TableRow]:
    """Yield the rows of a table; ``student`` is empty if there is no such column. Raises TableError.

    Bytes that are not UTF-8 are lone surrogates in ``text``. ``columns``: the assignment's, by which names with several
    dots are split.
    """
    table = spreadsheet(text, lambda cells: identity_column(cells) >= 0).rows
    header = next(table, SpreadsheetRow(1, [], "it is empty"))
    names = [clean(cell.strip()) for cell in header.cells]
    while names and not names[-1]:
        names.pop()
    student, answered = identity_column(names), list(table)
    asked = [None if i == student else _asked(name, columns) for i, name in enumerate(names)]
    if header.error is not None or (student < 0 and (None in asked or len(answered) > 1)):
        raise TableError(header.error or f"its header has no column '{STUDENT}' but {', '.join(names)[:80]}")
    fault = _header_fault(names, student, asked, columns)
    if student >= 0 and names[student].casefold() == STUDENT and _TIMES.isdisjoint(map(str.casefold, names)):
        asked = [None if i == student else asked[i] or _split(name) for i, name in enumerate(names)]
    for row in answered:
        yield _row(row, student, asked, fault and f"the header (line {header.line}) {fault}")


def _header_fault(names: list[str], student: int, asked: Sequence[Asked], columns: Columns) -> str | None:
    """Return the fault of a header for which no row can be graded, or None."""
    repeats = [n for i, n in enumerate(names) if n and (n in names[:i] or (i > student and n.casefold() == STUDENT))]
    repeated = next((question for question in asked if question and asked.count(question) > 1), None)
    if repeats:
        return f"has the column '{repeats[0][:60]}' twice"
    if "" in names:
        return f"has no name for column {names.index('') + 1}"
    if repeated is not None:
        return f"has two columns for {'.'.join(repeated)}"
    return None if any(asked) else f"names no question: {_meant(names, student, columns)}"


def _asked(name: str, columns: Columns) -> Asked:
    """Return the (problem, question) with whose name a header begins, or None."""
    match = _QUESTION.match(name)
    return columns.get(name) or (None if match is None else columns.get(match["name"]))


def _meant(names: list[str], student: int, columns: Columns) -> str:
    """Return the hint on names of columns: the nearest one, or a list."""
    others = [name for i, name in enumerate(names) if i != student]
    near = next((f"'{near}' for '{name[:60]}'" for name in others if (near := nearest(name, columns))), None)
    listing = ", ".join(list(columns)[:MOST_LISTED]) + (", ..." if len(columns) > MOST_LISTED else "")
    return f"write {near or listing}" if near or listing else "no question of the assignment has this name"


def _split(name: str) -> tuple[str, str]:
    problem, _, question = name.partition(".")
    return problem.strip(), question.strip()


def _row(row: SpreadsheetRow, student_column: int, asked: Sequence[Asked], fault: str | None) -> TableRow:
    cells, error, width = row.cells, row.error or fault, len(asked)
    name = clean(cells[student_column]).strip() if 0 <= student_column < len(cells) else ""
    if error is None and (len(cells) < width or any(cell.strip() for cell in cells[width:])):
        error = f"the row has {len(cells)} cells, the header {width}"
    if error is None and student_column >= 0 and not name:
        error = "the row has no student"
    if error is None and any(clean(cell) != cell for cell in cells):
        error = "the row is not in UTF-8 (save the table as UTF-8)"
    answers: dict[str, dict[str, str]] = {}
    for question, cell in zip(asked, cells, strict=False) if error is None else ():
        if question is not None and cell.strip():
            answers.setdefault(question[0], {})[question[1]] = cell
    return TableRow(name, row.line, answers, error)
