"""Pages with a field for each answer, under which stands how it is read: practice sheets, which also judge.

Reading needs what a sheet declares, never its key: `declared_of` has no constraint's content and no other variant.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.deadline import by_processor
from dofkit.base.errors import DofkitError, TextError
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.submission import Submission
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats.wording import STATUSES, points
from dofkit.homework.grading import ANSWER_SECONDS, Grader
from dofkit.homework.handout.class_sheets import standing_alone
from dofkit.homework.handout.markup import Draw, page_of
from dofkit.homework.handout.sheets import written_sheet
from dofkit.homework.problem import Problem
from dofkit.homework.questions import KINDS, NumberQuestion, QuestionBase
from dofkit.homework.questions.labels import LabelQuestion
from dofkit.homework.questions.names import Coordinates, Redundant
from dofkit.homework.result import Status
from dofkit.homework.sentences import Language, in_language, say, stopped
from dofkit.scene.scene import Scene

#: What of a bench a practice sheet needs, and where `python -m dofkit.site` puts a bench in a clone.
RUNTIME = ("runtime", "practice.js", "bench.css", "icon.svg")
BENCH = Path(__file__).parents[3] / "build" / "site" / "bench"
#: What declares names; nothing else of a scene is on a page that only reads.
_DECLARING = ("dimension", "parameters", "functions", "coordinates")
_TONES: dict[Status, str] = {
    "right": "good",
    "partly": "care",
    "needs_review": "care",
    "wrong": "bad",
    "unreadable": "bad",
}
#: Questions whose answers are words, names and numbers; others are answered by formulas.
_IN_WORDS = (NumberQuestion, LabelQuestion, Coordinates, Redundant)

Json = dict[str, Any]


class BenchMissingError(DofkitError):
    """The files that run dofkit in a browser were not found."""


def declared_of(problem: Problem, scene: Scene) -> Json:
    """Return what reading the answers to a problem needs: its names and questions, and nothing of its key."""
    value = scene.model_dump(mode="json", include=set(_DECLARING))
    for kind in ("particles", "bodies"):
        value[kind] = [part.model_dump(mode="json", include={"name", "coordinates"}) for part in getattr(scene, kind)]
    names = [constraint.name or f"c{n}" for n, constraint in enumerate(scene.constraints, 1)]
    questions = [q.model_dump(mode="json", exclude={"text"}, exclude_none=True) for q in problem.questions]
    return {
        "scene": {key: part for key, part in value.items() if part},
        "constraints": names,
        "also": dict.fromkeys(problem.also, ""),
        "others": {other: name for name, others in problem.names.items() for other in others},
        "questions": questions,
    }


class _Declared(NamedTuple):
    names: DeclaredNames
    questions: dict[str, QuestionBase]


@lru_cache(maxsize=64)
def _declared(text: str) -> _Declared:
    value = json.loads(text)
    names = DeclaredNames.of(Scene.model_validate({"name": "sheet", **value["scene"]}), value["also"], value["others"])
    questions = [KINDS[question["ask"]].model_validate(question) for question in value["questions"]]
    return _Declared(replace(names, constraints=tuple(value["constraints"])), {q.id: q for q in questions})


def read_answer(declared: str, question: str, text: str, language: Language) -> Json:
    """Return how an answer is read, or why and where it cannot be; ``declared``: `declared_of` as JSON."""
    names, questions = _declared(declared)
    asked = questions[question]
    try:
        with by_processor(ANSWER_SECONDS):
            read_as = asked.read(text, names)
            if isinstance(asked, _IN_WORDS):
                return {"read_as": say("{text}", text=read_as).translated(language), "formula": False}
            return {"read_as": read_as, "formula": True}
    except TextError as error:
        hint = stopped(error.hint, language) if error.hint else ""
        return {"fault": stopped(error.message, language), "column": error.column or 1, "hint": hint}
    except (DofkitError, ArithmeticError, ValueError, RecursionError) as error:
        return {"fault": stopped(str(error), language), "column": 1, "hint": ""}


@lru_cache(maxsize=4)
def _grader(assignment: str) -> Grader:
    return Grader(load_assignment(json.loads(assignment)))


def judge_answers(assignment: str, answers: Mapping[str, Mapping[str, str]]) -> list[Json]:
    """Return the judgement of each answer, in the language of the assignment, which is given as JSON."""
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


def write_practice(prepared: Prepared, draw: Draw, out: Path, bench: Path = BENCH) -> None:
    """Write a practice sheet and what it needs into a folder. Raises BenchMissingError and OSError."""
    missing = [name for name in RUNTIME if not (bench / name).exists()]
    if missing:
        raise BenchMissingError(
            f"{bench} has no {missing[0]}, which runs dofkit in a browser: run `python -m dofkit.site` in a clone with "
            "node and npm, or name the folder of a bench with --bench"
        )
    out.mkdir(parents=True, exist_ok=True)
    for name in RUNTIME:
        if (bench / name).is_dir():
            shutil.copytree(bench / name, out / name, dirs_exist_ok=True)
        else:
            shutil.copyfile(bench / name, out / name)
    language = prepared.assignment.language
    sheet = written_sheet(prepared, draw, has_fields=True)
    data = {
        "language": language,
        "words": words_of(language),
        "declared": {
            problem.id: declared_of(problem, prepared.keys[problem.id].scene)
            for problem in prepared.assignment.problems
        },
        "assignment": standing_alone(prepared, out),
    }
    page = page_of(sheet.markdown, sheet.title, language, sheet.figures, "practice.html", data)
    (out / "index.html").write_text(page, encoding="utf-8")


def words_of(language: Language) -> dict[str, str]:
    """Return what the page itself says, in a language."""
    return {
        "loading": in_language(language, "The page is getting ready to read your answers."),
        "read": in_language(language, "Read as:"),
        "check": in_language(language, "Check this answer"),
        "all": in_language(language, "Check all answers"),
        "practice": in_language(
            language,
            "This sheet is for practice: nothing is handed in, and whoever reads the source of the page can find the "
            "key.",
        ),
        "drafts": in_language(language, "Your answers stay in this browser."),
    }
