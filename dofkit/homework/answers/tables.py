"""Tables of answers, as spreadsheets and forms write them: a header ``student,PROBLEM.QUESTION,...``, then rows.

The column that identifies the student may have any name that rosters know, such as ``Email Address``; the header of an
answer's column may go on after the question's name, as ``disc.f How many degrees of freedom?``. In a table with times
(``Timestamp``) a later row of the same student replaces an earlier one.

A broken row is reported with its line, and the rows after it are read. A table without a column for students, whose
every column is a question, is one person's: that of its only row. A table whose header names no question is an error,
because every row would be worth nothing.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from io import StringIO
from itertools import chain, islice

from dofkit.base.wording import nearest
from dofkit.homework.answers.roster import DELIMITERS, identity_column
from dofkit.homework.answers.submission import clean

STUDENT = "student"
#: Headers of the column with the time of a submission, and how an answer's column begins.
_TIMES = frozenset({"timestamp", "time", "submitted", "submitted at", "completion time", "zeitstempel", "horodateur"})
_QUESTION = re.compile(r"\s*\[?(?P<name>[^\s:()\[\]]+)(?=$|[\s:()\]])")
#: Names that a message lists.
MOST_LISTED = 12
#: Lines that one row may run over, and characters that it may hold.
MOST_LINES, MOST_CHARACTERS = 200, 1_000_000
csv.field_size_limit(MOST_CHARACTERS)

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
    """A row that cannot be taken apart."""


@dataclass(frozen=True)
class Header:
    """How a table is written: its delimiter, which column names the student, and what the others answer.

    ``student``: -1 if there is no such column. ``fault``: why no row of it can be graded.
    """

    delimiter: str
    student: int
    asked: tuple[tuple[str, str] | None, ...]
    fault: str | None = None


def rows(lines: Iterable[str], known: Columns) -> Iterator[TableRow]:
    """The rows of a table, blank ones apart; ``student`` is empty where it has no such column. Raises TableError.

    ``lines`` keep their ends; bytes that are not UTF-8 are lone surrogates in them. ``known``: the columns of the
    assignment, which tell where a name with several dots is to be cut.
    """
    numbered = NumberedLines(lines)
    header = _header(numbered, known)
    found = (
        _row(header, number, cells, error or header.fault)
        for number, cells, error in records(numbered, header.delimiter)
        if error is not None or any(cell.strip() for cell in cells)
    )
    yield from found if header.student >= 0 else _only(found)


def _only(found: Iterator[TableRow]) -> Iterator[TableRow]:
    """The one row of a table that does not say whose it is."""
    first, second = next(found, None), next(found, None)
    if second is not None:
        raise TableError(f"its header has no column '{STUDENT}', and there is more than one row")
    if first is not None:
        yield first


class NumberedLines:
    """Lines with their numbers, of which some can be given back."""

    def __init__(self, lines: Iterable[str]) -> None:
        self._lines = iter(lines)
        self.number = 0

    def take(self) -> str | None:
        """The next line; None at the end."""
        found = next(self._lines, None)
        self.number += found is not None
        return found

    def give_back(self, lines: list[str]) -> None:
        """Take these lines again."""
        self._lines = chain(lines, self._lines)
        self.number -= len(lines)


def records(lines: NumberedLines, delimiter: str) -> Iterator[tuple[int, list[str], str | None]]:
    """(line, cells, what is wrong) of every record; of a broken one only its first line is taken."""
    while (line := lines.take()) is not None:
        start = lines.number
        if '"' not in line:
            yield start, line.rstrip("\r\n").split(delimiter), _too_long(line)
            continue
        taken = [line]
        while True:
            cells, error = _cells("".join(taken), delimiter)
            if error != _OPEN or len(taken) == MOST_LINES or (more := lines.take()) is None:
                break
            taken.append(more)
        if error is not None:
            lines.give_back(taken[1:])
            cells = line.rstrip("\r\n").replace('"', "").split(delimiter)
        yield start, cells, error


_OPEN = "a quotation mark is never closed"


def _cells(text: str, delimiter: str) -> tuple[list[str], str | None]:
    try:
        found = list(islice(csv.reader(StringIO(text, newline=""), delimiter=delimiter, strict=True), 2))
    except csv.Error as error:
        said = str(error)
        if "unexpected end" in said:
            return [], _OPEN
        return [], "a quote stands inside a cell" if "expected after" in said else said
    return (found[0] if found else []), _too_long(text)


def _too_long(text: str) -> str | None:
    return f"the row has {len(text)} characters" if len(text) > MOST_CHARACTERS else None


def _header(lines: NumberedLines, known: Columns) -> Header:
    line = lines.take()
    delimiter = ""
    if line is not None and line.strip().lower().startswith("sep=") and len(line.strip()) == 5:
        delimiter, line = line.strip()[4], lines.take()
    while line is not None and not line.strip(" \t\r\n,;|"):
        line = lines.take()
    if line is None:
        raise TableError("it is empty")
    lines.give_back([line])
    delimiter = delimiter or max(DELIMITERS, key=lambda d: (identity_column(_names(line, d)) >= 0, line.count(d)))
    _, cells, error = next(records(lines, delimiter))
    names = [cell.strip() for cell in cells]
    while names and not names[-1]:
        names.pop()
    student = identity_column(names)
    if error is not None or (student < 0 and not all(_asked(name, known) for name in names)):
        shown = clean(", ".join(names))[:80]
        raise TableError(error or f"its header has no column '{STUDENT}' but {shown}")
    return _header_of(delimiter, names, student, known, lines.number)


def is_header(line: str) -> bool:
    """Return whether a line begins a table: it has several cells, and one that identifies the student."""
    return any(delimiter in line and identity_column(_names(line, delimiter)) >= 0 for delimiter in DELIMITERS)


def _names(line: str, delimiter: str) -> list[str]:
    return [cell.strip(' "\r\n').lower() for cell in line.split(delimiter)]


def _asked(name: str, known: Columns) -> tuple[str, str] | None:
    """Return the question that a column answers: its header begins with the question's name."""
    match = _QUESTION.match(name)
    return known.get(name) or (None if match is None else known.get(match["name"]))


def _header_of(delimiter: str, names: list[str], student: int, known: Columns, line: int) -> Header:
    folded = [name.casefold() for name in names]
    twice = next(
        (n for i, n in enumerate(names) if n and (n in names[:i] or (i > student and folded[i] == STUDENT))), ""
    )
    questions = [None if i == student else _asked(name, known) for i, name in enumerate(names)]
    fault = None
    if twice:
        fault = f"the header (line {line}) has the column '{clean(twice)[:60]}' twice"
    elif "" in names:
        fault = f"column {names.index('') + 1} of the header (line {line}) has no name"
    elif not any(questions):
        fault = f"the header (line {line}) names no question: {_meant(names, student, known)}"
    elif (repeated := next((q for i, q in enumerate(questions) if q and q in questions[:i]), None)) is not None:
        fault = f"the header (line {line}) has two columns for {'.'.join(repeated)}"
    timed = not _TIMES.isdisjoint(folded)
    form = student >= 0 and folded[student] != STUDENT
    strange = [None if i == student or form or timed else _split(name) for i, name in enumerate(names)]
    asked = tuple(one or other for one, other in zip(questions, strange, strict=True))
    return Header(delimiter, student, asked, fault)


def _meant(names: list[str], student: int, known: Columns) -> str:
    """Return what the columns could have been called."""
    others = [name for i, name in enumerate(names) if i != student]
    near = next((f"'{near}' for '{clean(name)[:60]}'" for name in others if (near := nearest(name, known))), None)
    shown = ", ".join(list(known)[:MOST_LISTED]) + (", ..." if len(known) > MOST_LISTED else "")
    return f"write {near or shown}" if near or shown else "no question of the assignment has this name"


def _split(name: str) -> tuple[str, str]:
    problem, _, question = clean(name).partition(".")
    return problem.strip(), question.strip()


def _row(header: Header, line: int, cells: list[str], error: str | None) -> TableRow:
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
    return TableRow(student, line, answers, error)


def _undecoded(cell: str) -> bool:
    return not cell.isascii() and clean(cell) != cell
