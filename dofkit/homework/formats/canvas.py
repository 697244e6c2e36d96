"""Canvas's gradebook table: ``Student,ID,SIS User ID,SIS Login ID,Section`` and the assignment.

What Canvas makes of a table is its ``GradebookImporter`` (``lib/gradebook_importer.rb``) and what posts it
(``process_gradebook_upload.js``), by which this is written:

* It finds a student by ``ID``, else by the two SIS columns, else by the name. With a roster, best a gradebook that
  Canvas exported, all of them are filled in; without one the name handed in is ``Student`` and ``SIS Login ID``.
* A row whose first cell holds "Points Possible" is the row of points, whoever is called so: no student's row has it.
* A blank grade is posted as such and wipes what stands there: who has no final grade has no row.
* One row of a student it does not know makes it ask about all of them: who is not in the roster has no row.
* A column "TITLE (ID)" is the assignment with that id, as the exported gradebook has it; headers with words such as
  "Final Grade" are no assignments.

Results without a row are listed in a table of their own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, FormatError, Target
from dofkit.homework.formats.cells import cell
from dofkit.homework.formats.unplaced_results import beside, with_rows
from dofkit.homework.formats.wording import line, number
from dofkit.homework.result import Result

POINTS = "Points Possible"
#: Headers that Canvas takes for none of an assignment: where they stand anywhere, and where they are all of it.
_TAKEN = re.compile(r"(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
_RESERVED = frozenset(
    {
        "Student",
        "LastName",
        "FirstName",
        "ID",
        "SIS User ID",
        "SIS Login ID",
        "Section",
        "Integration ID",
        "Root Account",
    }
)


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """A table of all who have a final grade. Raises FormatError for a title that Canvas takes for something else."""
    _write(results, prepared, target, None)


def write_known(results: Iterator[Result], prepared: Prepared, target: Target, roster: Roster) -> None:
    """The same of those in a roster."""
    _write(results, prepared, target, roster)


def _write(results: Iterator[Result], prepared: Prepared, target: Target, roster: Roster | None) -> None:
    most = float(sum(question.points for _, question in prepared.questions()))
    title = _column(line(prepared.assignment.title), roster)
    with beside(target) as (rows, apart):
        rows.writerow(["Student", "ID", "SIS User ID", "SIS Login ID", "Section", cell(title)])
        rows.writerow([POINTS, "", "", "", "", number(most)])
        for result, member in with_rows(results, roster, apart):
            found = _identity(result.student, member)
            if POINTS in found[0]:
                apart.add(result, f"Canvas would take a row of '{found[0]}' for that of the points")
            else:
                rows.writerow([*map(cell, found), number(result.score or 0.0)])


def _column(title: str, roster: Roster | None) -> str:
    """The header of the assignment, with Canvas's own id where the roster is a gradebook that has it."""
    if title in _RESERVED or _TAKEN.search(title):
        raise FormatError(f"Canvas takes no column '{title}' for an assignment: give the assignment another title")
    known = () if roster is None else roster.columns
    return next((name for name in known if re.fullmatch(r"(.*?)\s*\(\d+\)", name) and name.startswith(title)
                 and re.fullmatch(r"\s*\(\d+\)", name[len(title):])), title)  # fmt: skip


def _identity(student: str, member: Participant | None) -> list[str]:
    """``Student, ID, SIS User ID, SIS Login ID, Section``."""
    if member is None:
        return [student, "", "", student, ""]
    login = member.username or ("" if member.canvas or member.number else member.email)
    numbers = [member.canvas, member.number, login]
    named = member.name or member.student
    if POINTS in named:
        named = next(filter(None, numbers), named)
    return [named, *numbers, member.section]


CANVAS = Format("canvas", write, endings=("csv",), folders=False, write_known=write_known)
