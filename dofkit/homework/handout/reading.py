"""Reads answers in a page from the declared names and questions alone, without the key."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

from dofkit.base.deadline import by_processor
from dofkit.base.errors import DofkitError, TextError
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.formats.wording import unmarked
from dofkit.homework.grading import ANSWER_SECONDS
from dofkit.homework.problem import Problem
from dofkit.homework.questions import KINDS, NumberQuestion, QuestionBase
from dofkit.homework.questions.labels import LabelQuestion
from dofkit.homework.questions.names import Coordinates, Redundant
from dofkit.homework.sentences import Language, say, stopped
from dofkit.scene.scene import Scene

#: The fields of a scene that declare names; a page for submitting contains no others.
_DECLARING = ("dimension", "parameters", "functions", "coordinates")
#: Kinds of questions whose answers are words, names and numbers; others are answered by formulas.
_IN_WORDS = (NumberQuestion, LabelQuestion, Coordinates, Redundant)

Json = dict[str, Any]


def declared_of(problem: Problem, scene: Scene) -> Json:
    """Return the names and questions of a problem, which reading its answers needs, without the key."""
    value = scene.model_dump(mode="json", include=set(_DECLARING))
    for kind in ("particles", "bodies"):
        value[kind] = [part.model_dump(mode="json", include={"name", "coordinates"}) for part in getattr(scene, kind)]
    names = [constraint.name or f"c{n}" for n, constraint in enumerate(scene.constraints, 1)]
    questions = [q.model_dump(mode="json", exclude={"text"}, exclude_none=True) for q in problem.questions]
    return {
        "scene": {key: part for key, part in value.items() if part},
        "constraints": names,
        "also": dict.fromkeys(problem.also, ""),
        "questions": questions,
    }


class _Declared(NamedTuple):
    names: DeclaredNames
    questions: dict[str, QuestionBase]


@lru_cache(maxsize=64)
def _declared(text: str) -> _Declared:
    value = json.loads(text)
    names = DeclaredNames.of(Scene.model_validate({"name": "sheet", **value["scene"]}), value["also"])
    questions = [KINDS[question["ask"]].model_validate(question) for question in value["questions"]]
    return _Declared(replace(names, constraints=tuple(value["constraints"])), {q.id: q for q in questions})


def read_answer(declared: str, question: str, text: str, language: Language) -> Json:
    """Return {"read_as", "formula"}, or {"fault", "column", "hint"} for an unreadable answer.

    ``declared``: the value of `declared_of` as JSON.
    """
    names, questions = _declared(declared)
    asked = questions[question]
    try:
        with by_processor(ANSWER_SECONDS):
            read_as = asked.read(text, names)
            if isinstance(asked, _IN_WORDS):
                return {"read_as": say("{text}", text=read_as).translated(language), "formula": False}
            return {"read_as": read_as, "formula": True}
    except TextError as error:
        hint = unmarked(stopped(error.hint, language)) if error.hint else ""
        return {"fault": unmarked(stopped(error.message, language)), "column": error.column or 1, "hint": hint}
    except (DofkitError, ArithmeticError, ValueError, RecursionError) as error:
        return {"fault": unmarked(stopped(str(error), language)), "column": 1, "hint": ""}
