"""Canvas's gradebook table: ``Student,ID,SIS User ID,SIS Login ID,Section`` and the assignment.

Students are named by what they handed in under, as ``Student`` and as ``SIS Login ID``; Canvas's own ``ID`` is left
open, for it is not known here. A grade is left empty, never 0, where an answer needs a review or the submission could
not be read: the table has no place to say why, so that such students are best looked up in the overview of the format
``html``; they come last. A student's second submission has no row of its own: it could wipe the grade of the first.
"""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target, opened
from dofkit.homework.formats.cells import cell, one_each, table
from dofkit.homework.formats.wording import decided, identity, line, number
from dofkit.homework.result import Result


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """A table of all students."""
    most = float(sum(question.points for _, question in prepared.questions()))
    with opened(target) as stream:
        rows = table(stream)
        title = cell(line(prepared.assignment.title))
        rows.writerow(["Student", "ID", "SIS User ID", "SIS Login ID", "Section", title])
        rows.writerow(["Points Possible", "", "", "", "", number(most)])
        for result in one_each(results):
            student = cell(identity(result.student))
            rows.writerow([student, "", "", student, "", _grade(result)])


def _grade(result: Result) -> str:
    return number(result.score) if decided(result) and result.score is not None else ""


CANVAS = Format("canvas", write, folder=lambda path: False)
