"""Moodle's grade import: by ``useremail`` or ``useridnumber``, with the grade and the feedback.

The name of the first student who was graded decides: an address makes the column ``useremail``, anything else
``useridnumber``. The grade column is always there, since feedback that is imported without it wipes the grades. The
grade is empty, never 0, where an answer needs a review or the submission could not be read, and the feedback says so;
submissions that could not be read come last. A student's second submission has no row of its own: it could wipe the
grade of the first. Moodle shows feedback as HTML, so that its markup is escaped for that as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from itertools import chain

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target, opened
from dofkit.homework.formats.cells import cell, one_each, table
from dofkit.homework.formats.wording import decided, feedback, identity, line, number
from dofkit.homework.result import Result


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """A table of all students."""
    title = line(prepared.assignment.title)
    rest = one_each(results)
    first = next(rest, None)
    by = "useremail" if first is not None and "@" in first.student else "useridnumber"
    with opened(target) as stream:
        rows = table(stream)
        rows.writerow([by, cell(title), cell(f"{title} (feedback)")])
        for result in chain([] if first is None else [first], rest):
            told = escape(feedback(result), quote=False)
            rows.writerow([cell(identity(result.student)), _grade(result), cell(told)])


def _grade(result: Result) -> str:
    return number(result.score) if decided(result) and result.score is not None else ""


MOODLE = Format("moodle", write, folder=lambda path: False)
