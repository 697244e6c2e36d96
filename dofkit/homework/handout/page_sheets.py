"""Pages with a field for each answer and how it is read: for submitting answers, or for practice with judgements.

A page for submitting contains only the declared names and questions: no constraints, and no other student's sheet.
Answers are read by Python in the browser, in one script beside the pages, which work from a folder without a network.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from dofkit.base.errors import DofkitError
from dofkit.homework.answers.submission import Submission
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats.wording import STATUSES, points
from dofkit.homework.grading import Grader
from dofkit.homework.handout.markup import Draw, page_of
from dofkit.homework.handout.portable import standing_alone
from dofkit.homework.handout.reading import Json, declared_of
from dofkit.homework.handout.sheets import written_sheet
from dofkit.homework.result import Status
from dofkit.homework.sentences import in_language

#: The script that runs dofkit in a page, and the path at which `python -m dofkit.site` builds it in a clone.
RUNTIME = "runtime.js"
BUILT = Path(__file__).parents[3] / "build" / "site" / "bench" / RUNTIME
_TONES: dict[Status, str] = {
    "right": "good",
    "partly": "care",
    "needs_review": "care",
    "wrong": "bad",
    "unreadable": "bad",
}
#: {key in the script: text of the page}.
_WORDS = {
    "loading": "The page is getting ready to read your answers.",
    "unread": "How your answers are read cannot be shown: the file runtime.js is not beside this page.",
    "read": "Read as:",
    "check": "Check this answer",
    "all": "Check all answers",
    "name": "Your name, as the course knows you:",
    "save": "Save the file to submit",
    "saved": "{count} of {most} answers are in the file {file}. Submit that file.",
}
_DRAFTS = "Your answers stay in this browser."
_PRACTICE = (
    "This sheet is for practice: nothing is handed in, and whoever reads the source of the page can find the key."
)
_TO_SUBMIT = "Write your answers into the fields, save the file, and submit it."


class RuntimeMissingError(DofkitError):
    """The script that runs dofkit in a browser was not found."""


@lru_cache(maxsize=4)
def _grader(assignment: str) -> Grader:
    return Grader(load_assignment(json.loads(assignment)))


def judge_answers(assignment: str, answers: Mapping[str, Mapping[str, str]]) -> list[Json]:
    """Return the judgement of each answer as fields for the page; ``assignment``: as JSON, with its language."""
    grader = _grader(assignment)
    language = grader.prepared.assignment.language
    return [
        {
            "problem": item.problem,
            "question": item.question,
            "status": in_language(language, STATUSES[item.status]),
            "tone": _TONES.get(item.status, "plain"),
            "points": points(item, language),
            "feedback": item.feedback,
        }
        for item in grader.grade(Submission("", answers)).items
    ]


def put_runtime(folder: Path, runtime: Path = BUILT) -> None:
    """Copy the script that reads answers to a folder of pages. Raises RuntimeMissingError and OSError."""
    if not runtime.is_file():
        raise RuntimeMissingError(
            f"there is no {runtime}, which shows how answers are read: run `python -m dofkit.site` in a clone with "
            "node and npm, or name a runtime.js with --runtime"
        )
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / RUNTIME).exists() or not runtime.samefile(folder / RUNTIME):
        shutil.copyfile(runtime, folder / RUNTIME)


def write_page(prepared: Prepared, draw: Draw, out: Path, whose: str | None = None, judges: bool = False) -> None:
    """Write the page of a sheet; ``whose``: the student, or None for all. Raises FigureError and OSError."""
    language = prepared.assignment.language
    sheet = written_sheet(prepared, draw, whose, has_fields=True)
    note = f"{in_language(language, _PRACTICE if judges else _TO_SUBMIT)} {in_language(language, _DRAFTS)}"
    data = {
        "language": language,
        "words": {name: in_language(language, sentence) for name, sentence in _WORDS.items()} | {"note": note},
        "student": whose,
        "declared": {
            problem.id: declared_of(problem, prepared.keys[problem.id].scene)
            for problem in prepared.assignment.problems
        },
        "assignment": standing_alone(prepared, out.parent) if judges else None,
    }
    out.write_text(page_of(sheet.markdown, sheet.title, language, sheet.figures, data), encoding="utf-8")
