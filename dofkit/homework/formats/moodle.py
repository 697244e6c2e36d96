"""Moodle's grade import: a column that says who, the grade, and the feedback.

What Moodle makes of a table is its ``gradeimport_csv_load_data`` (``grade/import/csv/classes/load_data.php``) and
``grade_import_commit`` (``grade/import/lib.php``), by which this is written:

* A row is mapped by one column: ``userid`` (Moodle's own), ``useridnumber``, ``username`` or ``useremail``. With a
  roster it is the first of these that everyone in it has; without one the first student who is graded decides: an
  address makes it ``useremail``, anything else ``useridnumber``.
* A row of nobody stops the whole import: who is not in the roster, or does not fit the column, has no row.
* A row whose first cell is blank or 0 goes to the student of the row before it: there is none.
* A blank grade is set, as no grade: who has no final grade has no row. The grade column is always there, since feedback
  that is imported without it wipes grades in older versions.
* Feedback is shown as HTML, so that its markup is escaped for that as well.

Results without a row are listed in a table of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from itertools import chain

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.cells import cell, is_cell
from dofkit.homework.formats.unplaced_results import beside, with_rows
from dofkit.homework.formats.wording import feedback, line, number
from dofkit.homework.result import Result

#: What Moodle calls a column, and who a member is there; the platform's own first.
_COLUMNS: dict[str, Callable[[Participant], str]] = {
    "userid": lambda member: member.moodle,
    "useridnumber": lambda member: member.number,
    "username": lambda member: member.username,
    "useremail": lambda member: member.email,
}


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """A table of all who have a final grade."""
    _write(results, prepared, target, None)


def write_known(results: Iterator[Result], prepared: Prepared, target: Target, roster: Roster) -> None:
    """The same of those in a roster."""
    _write(results, prepared, target, roster)


def _write(results: Iterator[Result], prepared: Prepared, target: Target, roster: Roster | None) -> None:
    title = line(prepared.assignment.title)
    with beside(target) as (rows, apart):
        rest = with_rows(results, roster, apart)
        first = next(rest, None)
        column = _column(roster, "" if first is None else first[0].student)
        rows.writerow([column, cell(title), cell(f"{title} (feedback)")])
        for result, member in chain([] if first is None else [first], rest):
            who = result.student if member is None else _COLUMNS[column](member)
            if not is_cell(who) or who == "0" or (member is None and ("@" in who) != (column == "useremail")):
                apart.add(result, f"the student has no {column}")
                continue
            told = escape(feedback(result, prepared.assignment.language), quote=False)
            rows.writerow([who, number(result.score or 0.0), cell(told)])


def _column(roster: Roster | None, first: str) -> str:
    """What everyone in the roster has, else what most of them have; without a roster what the first student has."""
    if roster is None:
        return "useremail" if "@" in first else "useridnumber"
    having = {name: sum(bool(of(member)) for member in roster.members) for name, of in _COLUMNS.items()}
    return max(having, key=lambda name: having[name])


MOODLE = Format("moodle", write, endings=("csv",), folders=False, write_known=write_known)
