"""The table by which PrairieLearn takes back points that a person gave: "Upload question scores" of an assessment.

It has a row for each submission of which a person decided an answer, and for each that has no points there, by
``uid`` (or ``group_name``), ``qid`` and ``submission_id`` of the table of submissions that was graded, with
``score_perc``, from 0 to 100, and ``feedback`` in Markdown. (So ``score-upload.ts`` of its source reads it: it looks
the submission up by its number, checks the others, and sets the points of the whole question.) There is no row for what
PrairieLearn has graded and no person has touched; none for what is still open; and none that would take points away.
Those of whom points may be missed are listed apart, with why.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from dofkit.homework.answers.prairielearn import SubmittedRow
from dofkit.homework.answers.roster import Roster
from dofkit.homework.answers.sources import submitted_in
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import FormatError, Handback
from dofkit.homework.formats.cells import cell
from dofkit.homework.formats.unplaced_results import beside, unfit
from dofkit.homework.formats.wording import number, plain, points, title
from dofkit.homework.result import Item, Result
from dofkit.homework.sentences.translations import Language
from dofkit.homework.statement import marked

#: Less than this makes no difference to a percentage.
_LEAST = 0.005


def write_scores(results: Iterator[Result], prepared: Prepared, target: Path, handback: Handback) -> None:
    """Write the table. Raises FormatError where no table of PrairieLearn's submissions was graded."""
    rows = submitted_in(handback.sources, prepared.columns())
    if not rows:
        raise FormatError(
            f"{target} returns points to PrairieLearn in its own table: grade the CSV from its Downloads page,  "
            "of submissions for manual grading or of final submissions"
        )
    known: dict[str, SubmittedRow] = {}
    for each in rows:
        known.setdefault(_name(each, handback.roster), each)  # of several only the first was graded
    teams = any(row.team for row in rows)
    with beside(target) as (table, apart):
        table.writerow(["group_name" if teams else "uid", "qid", "submission_id", "score_perc", "feedback"])
        for result in results:
            row = known.get(result.student)
            if not _is_asked(result, row):
                continue
            why = "the table has no submission of this student" if row is None else _withheld(result, row)
            if row is None or why is not None:
                apart.add(result, str(why))
                continue
            feedback = _feedback(result, prepared.assignment.language)
            cells = (row.student, row.question, row.submission, f"{_percent(result):.4f}", feedback)
            table.writerow([*map(cell, cells)])


def _is_asked(result: Result, row: SubmittedRow | None) -> bool:
    """May points be missed there: those of a person, or all of them?"""
    if any(item.decided_by is not None for item in result.items):
        return True
    if row is None or row.percent:
        return False
    return row.percent is None or unfit(result) is not None or _percent(result) >= _LEAST


def _name(row: SubmittedRow, roster: Roster | None) -> str:
    """What the results call whose submission it is."""
    member = None if roster is None else roster.find(row.student)
    return row.student if member is None else member.student


def _percent(result: Result) -> float:
    return 100.0 * (result.score or 0.0) / result.max_score if result.max_score else 0.0


def _withheld(result: Result, row: SubmittedRow) -> str | None:
    """Why a submission has no row; None where it has."""
    why = unfit(result)
    if why is None and row.percent is not None and _percent(result) < row.percent + _LEAST:
        why = f"PrairieLearn has {number(row.percent)} % already"
    return why


def _feedback(result: Result, language: Language) -> str:
    """What is told of every answer, in Markdown that shows what was written as it stands."""
    return "\n".join(f"* **{marked(title(item))}**: {_told(item, language)}" for item in result.items)


def _told(item: Item, language: Language) -> str:
    said = marked(plain(item.feedback)) if item.decided_by is not None else ""
    return f"{points(item, language)}. {said}".rstrip()
