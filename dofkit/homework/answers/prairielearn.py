"""PrairieLearn's tables of submissions, as the page "Downloads" of an assessment has them.

``..._submissions_for_manual_grading.csv`` has ``uid, uin, qid, old_score_perc, submission_id, submitted_answer`` and
more; ``..._final_submissions.csv``, ``best`` and ``all``, which hold files too, have ``UID, Question, submission_id,
Submitted answer, Question % score`` and more; where teams work, their name stands for the ``uid``. (So they are written
in ``instructorAssessmentDownloads.tsx`` of its source.) What was typed is a JSON object of the inputs by their names,
with files in base64 among it. Of one's submissions to a question the last counts, which is graded by hand there, too.
"""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from dofkit.homework.answers.submission import clean
from dofkit.homework.answers.tables import DELIMITERS, MOST_LISTED, Columns, NumberedLines, TableError, records

#: What the columns are called, in small letters, in either table.
_HEADERS: Mapping[str, tuple[str, ...]] = {
    "uid": ("uid",),
    "team": ("group_name", "group name"),
    "question": ("qid", "question"),
    "submission": ("submission_id",),
    "given": ("submitted_answer", "submitted answer"),
    "score": ("old_score_perc", "question % score"),
}
_NEEDED = ("question", "submission", "given")
#: What stands between the problem and the question in an input's name.
_SIGNS = ".-_"
#: Of several files the one called so is the submission.
_NAMES = ("answers", "submission")


class SubmittedFile(NamedTuple):
    """A file that was handed in: its name, and what is in it."""

    name: str
    data: bytes


@dataclass(frozen=True)
class SubmittedRow:
    """One submission of PrairieLearn's: whose it is, to which question, and what was given.

    ``team``: it is a team's. ``percent``: what the student has there for the question; None where nothing is told.
    """

    student: str
    team: bool
    question: str
    submission: str
    line: int
    given: Mapping[str, Any] = field(default_factory=dict)
    percent: float | None = None
    error: str | None = None

    def files(self, endings: Sequence[str]) -> list[SubmittedFile]:
        """The files with one of these endings; of several the one that is called ``answers`` or ``submission``."""
        given = self.given.get("_files")
        listed = [one for one in given if isinstance(one, Mapping)] if isinstance(given, list) else []
        found = [
            SubmittedFile(clean(str(one.get("name") or "")), _decoded(one.get("contents")))
            for one in listed
            if str(one.get("name") or "").lower().endswith(tuple(endings))
        ]
        named = [one for one in found if one.name.rpartition(".")[0].lower() in _NAMES]
        return named if len(named) == 1 else found


def _decoded(contents: object) -> bytes:
    try:
        return base64.b64decode(str(contents or ""), validate=False)
    except (binascii.Error, ValueError):
        return b""


def is_submissions_header(line: str) -> bool:
    """Does a line begin a table of PrairieLearn's submissions?

    >>> is_submissions_header("uid,uin,qid,submission_id,params,submitted_answer"), is_submissions_header("student,p.f")
    (True, False)
    """
    return set(_NEEDED) <= set(_columns(_names(line, _delimiter(line))))


def _delimiter(line: str) -> str:
    return max(DELIMITERS, key=line.count)


def _names(line: str, delimiter: str) -> list[str]:
    return [cell.strip(' "\r\n\ufeff').lower() for cell in line.split(delimiter)]


def _columns(names: Sequence[str]) -> dict[str, int]:
    return {field: names.index(name) for field, called in _HEADERS.items() for name in called if name in names}


def submitted_rows(lines: Iterable[str], known: Columns, endings: Sequence[str]) -> list[SubmittedRow]:
    """The submissions that answer an assignment, the last of everyone to each question, in the order of the table.

    ``known``: the assignment's columns; ``endings``: of files that may be submissions. Rows of other questions of the
    same assessment are left out. Raises TableError where none is left.
    """
    every = list(_rows(NumberedLines(lines)))
    ours = {row.question for row in every if answers_of(row.given, known) or row.files(endings)}
    if every and not ours and all(row.error is None for row in every):
        shown = ", ".join(list(known)[:MOST_LISTED])
        raise TableError(
            f"no row answers a question of this assignment: inputs are named {shown} there, and files are in "
            "the table of final submissions only"
        )
    latest: dict[tuple[str, str], SubmittedRow] = {}
    for row in every:
        if row.question in ours or row.error is not None:
            place = (row.student, row.question)
            before = latest.get(place)
            if before is None or _order(row) >= _order(before):
                latest[place] = row
    return list(latest.values())


def _order(row: SubmittedRow) -> tuple[int, int]:
    """Later ones have larger numbers."""
    return (int(row.submission) if row.submission.isdecimal() else -1, row.line)


def _rows(lines: NumberedLines) -> Iterator[SubmittedRow]:
    first = lines.take() or ""
    lines.give_back([first])
    found = records(lines, _delimiter(first))
    _, header, error = next(found)
    columns = _columns([name.strip(" \ufeff").lower() for name in header])
    if error is not None or not set(_NEEDED) <= set(columns):
        raise TableError(error or "this is not a table of submissions from PrairieLearn")
    for line, cells, error in found:
        if error is not None or any(cell.strip() for cell in cells):
            told = {name: clean(cells[i]).strip() if i < len(cells) else "" for name, i in columns.items()}
            yield _row(line, told, error)


def _row(line: int, cells: Mapping[str, str], error: str | None) -> SubmittedRow:
    team = cells.get("team", "")
    student = team or cells.get("uid", "")
    given: object = {}
    if error is None:
        try:
            given = json.loads(cells["given"] or "{}")
        except (ValueError, RecursionError):
            error = "the submitted answer is not a JSON object: use the table as it was downloaded"
    if error is None and not isinstance(given, Mapping):
        error = "the submitted answer is not a JSON object"
    if error is None and not student:
        error = "the row names neither a uid nor a group"
    answered = given if isinstance(given, Mapping) and error is None else {}
    told = (student, bool(team), cells["question"], cells["submission"], line)
    return SubmittedRow(*told, answered, _percent(cells.get("score", "")), error)


def _percent(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def answers_of(given: Mapping[str, Any], known: Columns) -> dict[str, dict[str, Any]]:
    """The answers in inputs that are called ``PROBLEM.QUESTION``, or with ``-`` or ``_`` for the dot.

    >>> answers_of({"p.f": 1, "q_g": {"_type": "sympy", "_value": "x + y"}}, {"p.f": ("p", "f"), "q.g": ("q", "g")})
    {'p': {'f': 1}, 'q': {'g': 'x + y'}}
    """
    answers: dict[str, dict[str, Any]] = {}
    for problem, question in known.values():
        name = next((name for sign in _SIGNS if (name := f"{problem}{sign}{question}") in given), None)
        if name is not None:
            answers.setdefault(problem, {})[question] = _plain(given[name])
    return answers


def _plain(value: Any) -> Any:
    """An expression as the text that it was stored as; anything else as it is."""
    typed = isinstance(value, Mapping) and value.get("_type") == "sympy"
    return value.get("_value") if typed else value
