"""Grades the submission in Gradescope's folder: ``python -m dofkit.homework.autograder ASSIGNMENT``.

A result in which every answer is undecided is written first: it remains if grading is interrupted.
The student is the platform's user, not the name in the submission. If a submission names another ``student``, a person
has to review it, and the result says so.

Points that a person gave in a ``review.csv`` beside the assignment's file are applied to all equal answers when the
submissions are graded again.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.base.runs import Pool
from dofkit.homework.answers.roster import Participant, doubt_of_platform
from dofkit.homework.answers.sources import DOCUMENTS, LINES, TABLES, Handed, hand_ins
from dofkit.homework.answers.submission import clean
from dofkit.homework.assignment import Prepared, Visibility, load_assignment
from dofkit.homework.formats.base import text
from dofkit.homework.formats.gradescope import document
from dofkit.homework.formats.review import TABLE, RunReview
from dofkit.homework.grading import item_of
from dofkit.homework.judgement import needs_review
from dofkit.homework.result import Result
from dofkit.homework.runs.batch import MODULES, Keeper, Orders
from dofkit.homework.variants import NobodysVariantError, sheet_of

#: Gradescope's folder, the file of the result in it, and the seconds of processor time for a submission.
ROOT, RESULTS, SECONDS = Path("/autograder"), "results/results.json", 240.0
#: The most bytes of a platform's file that are read.
MOST_BYTES = 8_000_000


def undecided(prepared: Prepared, student: str, reason: str) -> Result:
    """Return a result in which every answer needs a review, for the given reason."""
    review = needs_review("", reason)
    items = [item_of(prepared, problem, question, review) for problem, question in prepared.questions()]
    return Result(student=student, score=0.0, max_score=prepared.max_score, items=items, needs_review=len(items))


def grade_at(root: Path, assignment: Path, memory: int) -> Result:
    """Grade the submission below ``root``, write the result and return it.

    ``memory``: the limit in bytes of the process that judges answers. Raises AssignmentError, OSError if nothing can be
    written, and ReviewError if the ``review.csv`` beside the assignment is unusable; then no result is written.
    """
    metadata = _object(_json(root / "submission_metadata.json"))
    users = _users(metadata)
    student = ", ".join(user.student for user in users) or "student"
    prepared, reviewed = load_assignment(assignment), assignment.with_name(TABLE)
    prepared = RunReview.read(prepared, reviewed if reviewed.is_file() else None, None).applied(prepared)
    visibility = _visibility(prepared, metadata)
    _write(root, document(undecided(prepared, student, "grading was interrupted."), prepared, visibility))
    try:
        prepared = sheet_of(prepared, [name for user in users for name in (user.student, *user.called())])
        handed = _only_hand_in(root / "submission", prepared)
    except NobodysVariantError as error:
        handed = Result.refused(student, prepared.max_score, str(error))
    result = handed if isinstance(handed, Result) else _result(handed, prepared, memory)
    named = isinstance(handed, Handed) and result.student not in ("", student, *handed.claims)
    doubt = doubt_of_platform(users, result.student) if named else None
    result = result.model_copy(update={"student": student, "doubt": doubt})
    _write(root, document(result, prepared, visibility))
    return result


def _users(metadata: Mapping[str, Any]) -> list[Participant]:
    """Return the users who submitted, with their address, name or id as ``student``."""
    users = metadata.get("users")
    persons = [_object(user) for user in users] if isinstance(users, list) else []
    identities = [[clean(str(user.get(key) or "")) for key in ("email", "name", "sid", "id")] for user in persons]
    return [
        Participant(email or name or other_id, name=name, email=email, number=sid, other=other_id)
        for email, name, sid, other_id in identities
        if email or name or other_id
    ]


def _visibility(prepared: Prepared, metadata: Mapping[str, Any]) -> Visibility:
    """Return when points are shown: as the assignment says, but without a due date when grades are published."""
    visibility, dates = prepared.assignment.visibility, _object(metadata.get("assignment"))
    endless = "due_date" in dates and not (dates["due_date"] or dates.get("late_due_date"))
    return "after_published" if visibility == "after_due_date" and endless else visibility


def _only_hand_in(folder: Path, prepared: Prepared) -> Handed | Result:
    """Return the only submission, or the result that says why there is none or more than one."""
    submitted: list[Handed] = []
    for handed in hand_ins([str(folder)], prepared.columns()):
        path = Path(handed.place.file)
        if path.suffix.lower() in (*DOCUMENTS, *LINES, *TABLES) and not path.is_symlink():
            place = replace(handed.place, file=str(path.relative_to(folder)))
            submitted.append(replace(handed, place=place))
    if len(submitted) == 1:
        return submitted[0]
    why = "there is no file with answers: submit one named answers.yaml, answers.json or answers.csv"
    if submitted:
        why = f"there is more than one submission: {'; '.join(str(h.place) for h in submitted)}; submit one of them"
    return Result.refused("", prepared.max_score, clean(why))


def _result(handed: Handed, prepared: Prepared, memory: int) -> Result:
    """Return the result of a submission; each answer gets a share of the time."""
    orders = Orders.of(prepared)
    share = SECONDS / (2 * len(prepared.columns()) + 2)
    orders = replace(orders, seconds=min(orders.seconds, share), hard=min(orders.hard, 2 * share))
    with Pool(1, memory, MODULES) as pool:
        pool.fork()
        return Result.model_validate_json(Keeper(orders, pool).grade(handed))


def _write(root: Path, fields: dict[str, Any]) -> None:
    """Write the result atomically, by renaming a temporary file."""
    path = root / RESULTS
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.new")
    temporary.write_text(text(fields), encoding="ascii")
    os.replace(temporary, path)


def _json(path: Path) -> Any:
    """Return the content of a platform's file, or None if it cannot be read."""
    try:
        with path.open("rb") as file:
            return json.loads(file.read(MOST_BYTES))
    except (OSError, ValueError, RecursionError):
        return None


def _object(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, dict) else {}


def main(arguments: Sequence[str] | None = None) -> int:
    """Grade on Gradescope; return the exit status, 0 if a result was written, else 2."""
    parser = argparse.ArgumentParser(prog="python -m dofkit.homework.autograder", description=__doc__)
    parser.add_argument("assignment", type=Path)
    parser.add_argument("--root", type=Path, default=ROOT, help="the platform's folder")
    parser.add_argument("--memory", type=int, default=2048, metavar="MB", help="address space for judging answers")
    options = parser.parse_args(arguments)
    try:
        result = grade_at(options.root, options.assignment, options.memory << 20)
    except (DofkitError, OSError) as error:
        print(f"no result: {error}", file=sys.stderr)
        return 2
    print(f"{len(result.items)} answers, {result.needs_review} to review" if result.error is None else result.error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
