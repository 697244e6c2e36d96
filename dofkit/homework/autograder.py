"""One submission, graded where a course platform has put it: ``python -m dofkit.homework.autograder SITE ASSIGNMENT``.

A result is always written, first of all one in which every answer is open: it stands where the grading is cut short.
What a student wrote says nothing of who the student is: that is the platform's to say, where it does. Where a
submission names another ``student`` than its user a person has to look at it, and the result says so.

What a person decided comes back: a ``review.csv`` beside the assignment's file is applied to all who give those
answers. So it is put there, and the submissions are graded again.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.base.runs import Pool
from dofkit.homework.answers.roster import Participant, doubt_of_platform
from dofkit.homework.answers.sources import DOCUMENTS, LINES, TABLES, Handed, hand_ins
from dofkit.homework.answers.submission import FilePlace, clean
from dofkit.homework.assignment import Prepared, Visibility, load_assignment
from dofkit.homework.formats import gradescope, prairielearn
from dofkit.homework.formats.base import text
from dofkit.homework.formats.review import TABLE, RunReview
from dofkit.homework.grading import item_of
from dofkit.homework.judgement import needs_review
from dofkit.homework.result import Result
from dofkit.homework.runs.batch import MODULES, Keeper, Orders
from dofkit.homework.sentences import Language
from dofkit.homework.variants import NobodysVariantError, sheet_of

#: A longer file of a platform is not read.
MOST_BYTES = 8_000_000
#: Of several files that could be the submission, the one called so.
_NAMES = ("answers", "submission")
BROKEN = "the assignment of this autograder cannot be read. This is not your fault: please tell your instructors"


@dataclass(frozen=True)
class Site:
    """A platform: where things are, below ``root``, and what its result looks like.

    ``seconds``: after which a submission needs a review, within what the platform gives.
    """

    root: Path
    folder: str
    results: str
    seconds: float
    document: Callable[[Result, Prepared | None, Path], dict[str, Any]]
    users: Callable[[Path], list[Participant]] = lambda root: []
    form: Callable[[Path, Prepared], Handed | None] = lambda root, prepared: None


def _gradescope_users(root: Path) -> list[Participant]:
    """Those who handed in, called by their addresses, or by their names."""
    users = _object(_json(root / "submission_metadata.json")).get("users")
    persons = [_object(user) for user in users] if isinstance(users, list) else []
    identities = [[clean(str(user.get(key) or "")) for key in ("email", "name", "sid", "id")] for user in persons]
    return [
        Participant(email or name or other_id, name=name, email=email, number=sid, other=other_id)
        for email, name, sid, other_id in identities
        if email or name or other_id
    ]


def _gradescope_visibility(prepared: Prepared | None, root: Path) -> Visibility:
    """Return when points are shown: without a due date when grades are published."""
    visibility = gradescope.visibility_of(prepared)
    dates = _object(_object(_json(root / "submission_metadata.json")).get("assignment"))
    endless = "due_date" in dates and not (dates["due_date"] or dates.get("late_due_date"))
    return "after_published" if visibility == "after_due_date" and endless else visibility


def _prairielearn_form(root: Path, prepared: Prepared) -> Handed | None:
    """The answers that were typed into a question, in inputs named ``PROBLEM.QUESTION``, or with ``_`` or ``-``."""
    submitted = _object(_json(root / "data" / "data.json")).get("submitted_answers")
    if not isinstance(submitted, dict):
        return None
    answers: dict[str, dict[str, Any]] = {}
    for problem, question in prepared.columns().values():
        name = next((name for sign in ".-_" if (name := f"{problem}{sign}{question}") in submitted), None)
        if name is not None:
            value = submitted[name]
            symbolic = isinstance(value, dict) and value.get("_type") == "sympy"
            answers.setdefault(problem, {})[question] = value.get("_value") if symbolic else value
    return Handed("student", FilePlace("data.json"), {"answers": answers})


def _language(prepared: Prepared | None) -> Language:
    return "en" if prepared is None else prepared.assignment.language


SITES: dict[str, Site] = {
    "gradescope": Site(
        Path("/autograder"), "submission", "results/results.json", 240.0,
        lambda result, prepared, root: gradescope.document(
            result, _gradescope_visibility(prepared, root), _language(prepared)
        ),
        _gradescope_users,
    ),
    "prairielearn": Site(
        Path("/grade"), "student", "results/results.json", 25.0,
        lambda result, prepared, _: prairielearn.document(result, _language(prepared)),
        form=_prairielearn_form,
    ),
}  # fmt: skip


def undecided(prepared: Prepared, student: str, reason: str) -> Result:
    """The result in which every answer needs a review."""
    review = needs_review("", reason)
    items = [item_of(prepared, problem, question, review) for problem, question in prepared.questions()]
    return Result(student=student, score=0.0, max_score=prepared.max_score, items=items, needs_review=len(items))


def grade_at(site: Site, assignment: Path, memory: int) -> Result:
    """Grade what was handed in and write the result. Raises AssignmentError, and OSError where nothing can be written.

    ``memory``: the bytes that the process may take in which answers are judged. Raises ReviewError where the
    ``review.csv`` beside the assignment cannot be used.
    """
    users = site.users(site.root)
    student = ", ".join(user.student for user in users) or "student"
    prepared = _prepared(site, assignment, student)
    _write(site, undecided(prepared, student, "grading was interrupted."), prepared)
    try:
        prepared = sheet_of(prepared, [name for user in users for name in (user.student, *user.called())])
        handed = _only_hand_in(site, prepared)
    except NobodysVariantError as error:
        handed = Result.refused(student, prepared.max_score, str(error))
    result = handed if isinstance(handed, Result) else _result(handed, prepared, site.seconds, memory)
    named = isinstance(handed, Handed) and result.student not in ("", student, *handed.claims)
    doubt = doubt_of_platform(users, result.student) if named else None
    result = result.model_copy(update={"student": student, "doubt": doubt})
    _write(site, result, prepared)
    return result


def _prepared(site: Site, assignment: Path, student: str) -> Prepared:
    review_table = assignment.with_name(TABLE)
    try:
        prepared = load_assignment(assignment)
        return RunReview.read(prepared, review_table if review_table.is_file() else None, None).applied(prepared)
    except (DofkitError, OSError):
        _write(site, Result.refused(student, 0.0, BROKEN), None)
        raise


def _only_hand_in(site: Site, prepared: Prepared) -> Handed | Result:
    """The one thing that was handed in, or the result that says why there is none."""
    folder = site.root / site.folder
    handed_in: dict[Path, list[Handed]] = {}
    for handed in hand_ins([str(folder)], prepared.columns()):
        path = Path(handed.place.file)
        if path.suffix.lower() in (*DOCUMENTS, *LINES, *TABLES) and not path.is_symlink():
            place = replace(handed.place, file=str(path.relative_to(folder)))
            handed_in.setdefault(path, []).append(replace(handed, place=place))
    named = [path for path in handed_in if path.stem.lower() in _NAMES]
    chosen = named if len(named) == 1 else list(handed_in)
    if not chosen and (typed := site.form(site.root, prepared)) is not None:
        return typed
    if len(chosen) == 1:
        submissions = handed_in[chosen[0]]
        if len(submissions) == 1:
            return submissions[0]
        why = f"{chosen[0].name} contains {len(submissions)} submissions, not one"
    elif chosen:
        names = ", ".join(str(path.relative_to(folder)) for path in chosen)
        why = f"there is more than one file: {names}; name one of them answers.yaml"
    else:
        why = "there is no file with answers: submit one named answers.yaml, answers.json or answers.csv"
    return Result.refused("", prepared.max_score, clean(why))


def _result(handed: Handed, prepared: Prepared, seconds: float, memory: int) -> Result:
    """The result of what was handed in; each answer has its share of the time."""
    count = sum(1 for _ in prepared.questions())
    orders = Orders.of(prepared)
    share = seconds / (2 * count + 2)
    orders = replace(orders, seconds=min(orders.seconds, share), hard=min(orders.hard, 2 * share))
    with Pool(1, memory, MODULES) as pool:
        pool.fork()
        return Result.model_validate_json(Keeper(orders, pool).grade(handed))


def _write(site: Site, result: Result, prepared: Prepared | None) -> None:
    """Write the result whole: it never stands there in part."""
    path = site.root / site.results
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.new")
    temporary.write_text(text(site.document(result, prepared, site.root)), encoding="ascii")
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
    """Grade at a platform; the exit status says whether a result was written."""
    parser = argparse.ArgumentParser(prog="python -m dofkit.homework.autograder", description=__doc__)
    parser.add_argument("site", choices=list(SITES))
    parser.add_argument("assignment", type=Path)
    parser.add_argument("--root", type=Path, help="the platform's folder, such as /autograder")
    parser.add_argument("--seconds", type=float, help="for the whole submission")
    parser.add_argument("--memory", type=int, default=2048, metavar="MB", help="address space for judging answers")
    options = parser.parse_args(arguments)
    site = SITES[options.site]
    site = replace(site, root=options.root or site.root, seconds=options.seconds or site.seconds)
    try:
        result = grade_at(site, options.assignment, options.memory << 20)
    except (DofkitError, OSError) as error:
        print(f"no result: {error}", file=sys.stderr)
        return 2
    print(f"{len(result.items)} answers, {result.needs_review} to review" if result.error is None else result.error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
