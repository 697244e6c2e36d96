"""Tables of grades that Canvas and Moodle import.

The rules of the imports are in their source code: Canvas's ``lib/gradebook_importer.rb`` and
``process_gradebook_upload.js``, Moodle's ``grade/import/csv/classes/load_data.php`` and ``grade/import/lib.php``.

* A blank grade erases the one in the gradebook (both), so a student without a final grade has no row.
* A row for somebody outside the course makes Canvas ask about all rows and stops Moodle's import, so with a roster
  only its members have rows.
* Canvas finds a student by ``ID``, else by the SIS columns, else by the name; a first cell with "Points Possible" is
  the row of points even if it is a student's name; headers with words such as "Final Grade" are no assignments.
* Moodle maps rows by one column: ``userid``, ``useridnumber``, ``username`` or ``useremail``; a first cell that is
  blank or 0 means the student of the previous row. It shows feedback as HTML, so markup is escaped.

Results without a row are listed with the reason in ``TABLE.apart.csv``.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, FormatError, Target, cell, opened, table
from dofkit.homework.formats.wording import decided, feedback, identity, line, number, open_points
from dofkit.homework.result import Result

#: Results without a row, each with the reason.
Unwritten = list[tuple[Result, str]]
POINTS = "Points Possible"
#: Headers that Canvas does not read as assignments: words anywhere in a title, and whole titles.
_TAKEN = re.compile(r"(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
_CANVAS = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
_NO_TITLES = frozenset({*_CANVAS, "LastName", "FirstName", "Integration ID", "Root Account"})
#: {Moodle's name of a column: function that returns a member's value}, in order of preference.
_MOODLE: dict[str, Callable[[Participant], str]] = {
    "userid": lambda member: member.moodle,
    "useridnumber": lambda member: member.number,
    "username": lambda member: member.username,
    "useremail": lambda member: member.email,
}


def apart_path(out: Path) -> Path:
    """Return the path of the list of results without a row: ``grades.apart.csv`` beside ``grades.csv``."""
    return out.with_name(f"{out.stem}.apart.csv")


def _write(rows: Sequence[Sequence[str]], apart: Unwritten, target: Target) -> None:
    """Write a table, and list the results without a row: in a file beside it, or for a stream on standard error."""
    with opened(target) as stream:
        table(stream).writerows(rows)
    if not isinstance(target, Path):
        for result, why in apart:
            print(f"not in the table: {line(result.student)}: {why}", file=sys.stderr)
        return
    path = apart_path(target)
    path.unlink(missing_ok=True)
    if apart:
        listed = [["student", "points so far", "of", "open points", "why"]]
        for result, why in apart:
            points = "" if result.score is None else number(result.score)
            amounts = [number(result.max_score), number(open_points(result)), cell(why)]
            listed.append([cell(identity(result.student)), points, *amounts])
        with opened(path) as stream:
            table(stream).writerows(listed)


def _unfit(result: Result) -> str | None:
    """Return why a result has no grade for a gradebook, or None if it has one."""
    if result.error is not None:
        return f"it could not be graded: {line(result.error)}"
    if result.doubt is not None:
        return line(result.doubt)
    if not decided(result):
        return f"it is not final: {number(open_points(result))} points are undecided"
    return None


def is_cell(student: str) -> bool:
    """Return whether a name can be written to a cell unchanged, so that it is recognized again.

    >>> is_cell("Ada B"), is_cell("=1"), is_cell("ada\u200e"), is_cell(" ")
    (True, False, False, False)
    """
    return bool(student.strip()) and cell(identity(student)) == student


def _rows(
    results: Iterable[Result], roster: Roster | None, apart: Unwritten
) -> list[tuple[Result, Participant | None]]:
    """Return (result, member of the roster or None) for the results that have a row; append the others to ``apart``."""
    rows: dict[str, tuple[Result, Participant | None]] = {}
    for result in results:
        member = None if roster is None else roster.find(result.student)
        student = result.student if member is None else member.student
        why = _unfit(result)
        if roster is not None and member is None:
            why = "the student is not in the roster" + (f"; {why}" if why else "")
        elif why is None and member is None and not is_cell(student):
            why = "the name cannot be written to a table unchanged"
        elif why is None and student in rows:
            why = "the student already has a row"
        if why is None:
            rows[student] = result, member
        else:
            apart.append((result, why))
    return list(rows.values())


def write_canvas(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """Write Canvas's table. Raises FormatError for a title that Canvas does not read as an assignment."""
    title, apart = line(prepared.assignment.title), Unwritten()
    if title in _NO_TITLES or _TAKEN.search(title):
        raise FormatError(f"Canvas takes no column '{title}' for an assignment: give the assignment another title")
    exported = re.compile(re.escape(title) + r"\s*\(\d+\)")  # as an exported gradebook has it, with Canvas's own id
    column = next((name for name in (roster.columns if roster else ()) if exported.fullmatch(name)), title)
    table_rows = [[*_CANVAS, cell(column)], [POINTS, "", "", "", "", number(prepared.max_score)]]
    for result, member in _rows(results, roster, apart):
        cells = _canvas_identity(result.student, member)
        if POINTS in cells[0]:
            apart.append((result, f"Canvas would take a row of '{cells[0]}' for that of the points"))
        else:
            table_rows.append([*map(cell, cells), number(result.score or 0.0)])
    _write(table_rows, apart, target)


def _canvas_identity(student: str, member: Participant | None) -> list[str]:
    """Return a student's cells of ``Student, ID, SIS User ID, SIS Login ID, Section``."""
    if member is None:
        return [student, "", "", student, ""]
    login = member.username or ("" if member.canvas or member.number else member.email)
    numbers = [member.canvas, member.number, login]
    name = member.name or member.student
    if POINTS in name:
        name = next(filter(None, numbers), name)
    return [name, *numbers, member.section]


def write_moodle(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """Write Moodle's table: a column that identifies the student, the grade, and the feedback."""
    title, apart = line(prepared.assignment.title), Unwritten()
    rows = _rows(results, roster, apart)
    column = _moodle_column(roster, rows[0][0].student if rows else "")
    table_rows = [[column, cell(title), cell(f"{title} (feedback)")]]
    for result, member in rows:
        who = result.student if member is None else _MOODLE[column](member)
        if not is_cell(who) or who == "0" or (member is None and ("@" in who) != (column == "useremail")):
            apart.append((result, f"the student has no {column}"))
        else:
            remarks = escape(feedback(result, prepared.assignment.language), quote=False)
            table_rows.append([who, number(result.score or 0.0), cell(remarks)])
    _write(table_rows, apart, target)


def _moodle_column(roster: Roster | None, first: str) -> str:
    """Return the column for which most members have a value; without a roster, by the first student's name."""
    if roster is None:
        return "useremail" if "@" in first else "useridnumber"
    return max(_MOODLE, key=lambda name: sum(bool(_MOODLE[name](member)) for member in roster.members))


CANVAS = Format("canvas", write_canvas, endings=("csv",), folders=False)
MOODLE = Format("moodle", write_moodle, endings=("csv",), folders=False)
