"""The queue of a review: the different answers that a person must decide or has decided, each with its identity.

The identity of an answer depends on the question and the text of the answer, not on the student. It begins with a
letter, so that no spreadsheet reads it as a number, a date or a formula.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from dofkit.base.errors import Fault, FaultsError
from dofkit.base.wording import nearest
from dofkit.homework.answers.spreadsheet import SpreadsheetRow, decoded, spreadsheet
from dofkit.homework.answers.submission import clean
from dofkit.homework.result import Item, Result

#: The columns of the table, in order; a person fills in the last three.
COLUMNS = (
    "id", "problem", "question", "variant", "text", "why", "readings", "would_earn", "max_points", "students",
    "given_by", "points", "remark", "decided_by",
)  # fmt: skip
#: The name of the person who decided, if the table does not give one.
SOMEONE = "review"


class Decision(NamedTuple):
    """The points that a person gave to an answer, a remark, and the name of the person."""

    points: Fraction
    remark: str = ""
    by: str = SOMEONE


#: {identity of an answer: decision of a person}.
Decisions = Mapping[str, Decision]


@dataclass(frozen=True)
class ReviewRow:
    """One row as {column: text}; ``decision``: that of its last columns, or None if there is none."""

    cells: Mapping[str, str]
    decision: Decision | None = None

    @property
    def filled(self) -> bool:
        """Whether a person has written points or a remark into the row."""
        return self.decision is not None or bool(self.cells.get("remark") or self.cells.get("points"))


def question_mark(problem: str, question: str) -> str:
    """Return the part of an identity that depends on the question only.

    >>> question_mark("p", "f") != question_mark("p", "g")
    True
    """
    return f"q{_digest(problem, question)[:8]}"


def answer_id(problem: str, question: str, text: str, variant: str = "") -> str:
    """Return the identity of an answer, regardless of blanks. ``variant``: that of the problem, if it varies.

    >>> answer_id("p", "f", "x  = 1") == answer_id("p", "f", " x = 1\\n") != answer_id("p", "f", "x = 2")
    True
    """
    said = " ".join(unicodedata.normalize("NFC", text).split())
    return f"{question_mark(problem, question)}-{_digest(problem, question, variant, said)}"


def _digest(*texts: str) -> str:
    return hashlib.blake2b("\0".join(texts).encode("utf-8", "surrogatepass"), digest_size=8).hexdigest()


#: The most students of one answer who are named.
MOST_NAMED = 20


@dataclass
class QueuedAnswer:
    """An answer: one of its items, the number of students who gave it, and (name, link) of the first of them."""

    id: str
    item: Item
    count: int = 0
    given_by: list[tuple[str, str]] = field(default_factory=list)

    @property
    def open(self) -> bool:
        """Whether the answer is undecided."""
        return self.item.score is None

    def add(self, student: str, link: str) -> None:
        """Count one more student who gave the answer; ``link``: to the student's page."""
        self.count += 1
        if len(self.given_by) < MOST_NAMED:
            self.given_by.append((student, link))


class Queue:
    """Collects the answers of results: ``add`` every result, then use ``open_answers`` or ``rows``."""

    def __init__(self, questions: Sequence[tuple[str, str]]) -> None:
        self._order = {place: i for i, place in enumerate(questions)}
        self.answers: dict[str, QueuedAnswer] = {}

    def add(self, result: Result, link: str = "") -> None:
        """Add the undecided answers of a result, and those that a person has decided."""
        for item in result.items:
            if item.score is None or item.decided_by is not None:
                identity = answer_id(item.problem, item.question, item.answer or "", item.variant or "")
                queued = self.answers.setdefault(identity, QueuedAnswer(identity, item))
                queued.add(result.student, link)

    def open_answers(self) -> list[QueuedAnswer]:
        """Return the undecided answers, by question, the most frequent first."""
        return sorted(
            (queued for queued in self.answers.values() if queued.open),
            key=lambda queued: (self._order.get((queued.item.problem, queued.item.question), -1), -queued.count),
        )

    def rows(self, before: Mapping[str, ReviewRow]) -> Iterator[ReviewRow]:
        """Yield the rows to write: undecided answers first, then rows that a person has filled in.

        ``before``: the earlier rows; those that a person has filled in are kept, even if no student gives the answer.
        """
        for queued in self.open_answers():
            old = before.get(queued.id)
            kept = {} if old is None else {name: old.cells.get(name, "") for name in ("remark", "decided_by")}
            yield ReviewRow({**cells_of(queued), **kept}, None if old is None else old.decision)
        for identity, row in before.items():
            now = self.answers.get(identity)
            if row.filled and (now is None or not now.open):
                counted = {"students": "0"} if now is None else _who(now)
                yield ReviewRow({**row.cells, **counted}, row.decision)


def cells_of(queued: QueuedAnswer) -> dict[str, str]:
    """Return the cells of an undecided answer that dofkit fills in."""
    item = queued.item
    readings = [(r.read_as, r.score) for r in item.readings] or ([(item.read_as, None)] if item.read_as else [])
    place = f"column {item.column}: " if item.column is not None and item.status == "unreadable" else ""
    return {
        "id": queued.id,
        "problem": item.problem,
        "question": item.question,
        "variant": item.variant or "",
        "text": item.answer or "",
        "why": place + item.feedback,
        "readings": " | ".join(read_as for read_as, _ in readings),
        "would_earn": " | ".join("open" if score is None else f"{score:g}" for _, score in readings),
        "max_points": f"{item.max_score:g}",
        **_who(queued),
    }


def _who(queued: QueuedAnswer) -> dict[str, str]:
    more = queued.count - len(queued.given_by)
    named = "; ".join(student for student, _ in queued.given_by) + (f"; and {more} more" if more else "")
    return {"students": str(queued.count), "given_by": named}


#: The most characters of a remark; the most faults of a table that are listed; the most bytes that are read.
MOST_REMARKED, MOST_FAULTS, MOST_BYTES = 2000, 50, 200_000_000
_NEEDED = ("id", "points")
_ID = re.compile(r"q[0-9a-f]{8}-[0-9a-f]{16}")
_POINTS = re.compile(r"[+-]?(?:\d{1,9}(?:[.,]\d{1,9})?|\d{1,9}/[1-9]\d{0,8})")

#: {(problem, question): points} of an assignment.
Asked = Mapping[tuple[str, str], Fraction]


class ReviewError(FaultsError):
    """An unusable table of a review, with all its faults and their lines and columns."""

    @property
    def file(self) -> str | None:
        """The table, which messages name."""
        return self.source

    def __str__(self) -> str:
        return "\n".join(f"{self.file}: {fault}" for fault in self.faults)


@dataclass(frozen=True)
class FilledTable:
    """``rows``: {identity: row} in the order of the file; ``delimiter``: the separator of its cells."""

    rows: Mapping[str, ReviewRow] = field(default_factory=dict)
    delimiter: str | None = None

    @property
    def decisions(self) -> dict[str, Decision]:
        """{identity: decision} of the rows with decisions."""
        return {identity: row.decision for identity, row in self.rows.items() if row.decision is not None}


def read_table(path: Path, asked: Asked) -> FilledTable:
    """Return the rows of a table. Raises ReviewError with all faults, and OSError."""
    with path.open("rb") as file:
        data = file.read(MOST_BYTES)
    text = decoded(data)
    if clean(text) != text:  # what Excel saves in western Europe
        text = data.decode("cp1252", "replace")
    return _TableReader(str(path), asked).table(text)


class _TableReader:
    """Reads one table and collects its faults.

    A row of a question that no longer exists is kept and decides nothing; a table of such rows alone belongs to another
    assignment.
    """

    def __init__(self, source: str, asked: Asked) -> None:
        self.source = source
        self.most_points = {question_mark(*place): most for place, most in asked.items()}
        self.faults: list[Fault] = []
        self.rows: dict[str, ReviewRow] = {}
        self.unasked: list[tuple[int, int, str]] = []
        self.has_known_question = False

    def table(self, text: str) -> FilledTable:
        """Return all rows. Raises ReviewError."""
        delimiter, rows = spreadsheet(text, lambda cells: any(name in COLUMNS for name in cells))
        columns = self._header(next(rows, SpreadsheetRow(1, [])))
        for row in rows if columns else ():
            if row.error is None:
                self._row(row.line, columns, row.cells)
            else:
                self._fault(row.error, row.line, 1, "save the table as CSV again")
        for line, column, identity in () if self.has_known_question else self.unasked:
            self._no_answer(identity, line, column)
        if self.faults:
            raise ReviewError(tuple(self.faults[:MOST_FAULTS]), self.source)
        return FilledTable(self.rows, delimiter)

    def _fault(self, message: str, line: int, column: int, hint: str | None = None) -> None:
        self.faults.append(Fault(message, (), line, column, hint))

    def _header(self, row: SpreadsheetRow) -> dict[str, int]:
        """Return {name: number of the column}; empty if a column is missing."""
        line, cells, _ = row
        names = [cell.strip().lower() for cell in cells]
        for name in _NEEDED:
            if name not in names:
                near = nearest(name, [other for other in names if other not in COLUMNS])
                hint = f"is it '{near}'?" if near else f"the columns are {', '.join(COLUMNS)}"
                self._fault(f"there is no column '{name}'", line, 1, hint)
        for i, name in enumerate(names):
            if name in COLUMNS and name in names[:i]:
                self._fault(f"the column '{name}' is there twice", line, i + 1, "delete one of the two")
        return {} if self.faults else {name: i for i, name in enumerate(names) if name in COLUMNS}

    def _row(self, line: int, columns: Mapping[str, int], values: Sequence[str]) -> None:
        """Add a row to ``rows``, or record its faults."""
        cells = {name: _bare(values[i]) if i < len(values) else "" for name, i in columns.items()}
        identity, before = cells["id"], len(self.faults)
        is_id = _ID.fullmatch(identity) is not None
        most = self.most_points.get(identity.partition("-")[0]) if is_id else None
        self.has_known_question |= most is not None
        if not is_id:
            self._no_answer(identity, line, columns["id"] + 1)
        elif most is None:
            self.unasked.append((line, columns["id"] + 1, identity))
        decision = None if is_id and most is None else self._decision(line, columns, cells, most)
        if len(self.faults) > before:
            return
        row, first = ReviewRow(cells, decision), self.rows.get(identity, ReviewRow({}))
        if first.decision is not None and decision is not None and first.decision != decision:
            message = "this answer is decided differently in another row"
            self._fault(message, line, columns["points"] + 1, "keep one of the two rows")
        elif not first.cells or (first.decision is None and row.filled):
            self.rows[identity] = row

    def _no_answer(self, identity: str, line: int, column: int) -> None:
        message = f"'{identity[:40]}' is not the id of an answer to this assignment"
        self._fault(message, line, column, "copy it from the review.csv that dofkit wrote")

    def _decision(
        self, line: int, columns: Mapping[str, int], cells: Mapping[str, str], most: Fraction | None
    ) -> Decision | None:
        """Return the decision in a row; None without points, and after a fault, which is recorded."""
        text, remark = cells["points"], cells.get("remark", "")
        if len(remark) > MOST_REMARKED:
            message = f"the remark has {len(remark)} characters"
            self._fault(message, line, columns["remark"] + 1, f"at most {MOST_REMARKED}")
        if not text:
            return None
        points = Fraction(text.replace(",", ".")) if _POINTS.fullmatch(text) else None
        allowed = "write a number of points" if most is None else f"write 0 to {float(most):g}, or nothing"
        if points is None:
            self._fault(f"'{text[:40]}' is not a number of points", line, columns["points"] + 1, allowed)
        elif most is not None and not 0 <= points <= most:
            self._fault(f"{text} points are out of range", line, columns["points"] + 1, allowed)
        else:
            return Decision(points, remark, cells.get("decided_by") or SOMEONE)
        return None


def _bare(cell: str) -> str:
    """Return a cell without the apostrophe by which spreadsheets read it as text."""
    cell = cell.strip()
    return cell[1:] if cell.startswith("'") else cell
