"""Whether an answer can be read, and how: all that can be told where only the names of a scene are known."""

from __future__ import annotations

import json
import os
from decimal import Decimal
from functools import lru_cache, partial
from pathlib import Path
from typing import NamedTuple

from dofkit.base.deadline import by_processor
from dofkit.base.errors import TextError
from dofkit.homework.answers.prose import says_nothing
from dofkit.homework.answers.submission import of_value
from dofkit.homework.answers.typed import in_whole, shown_text
from dofkit.homework.assignment import Assignment, Prepared
from dofkit.homework.formats.wording import line, plain, remark
from dofkit.homework.grading import ANSWER_SECONDS
from dofkit.homework.judgement import DoubtError, Given, Judgement, needs_review, unreadable
from dofkit.homework.key.key import Key
from dofkit.homework.notebooks import QuestionError
from dofkit.homework.questions import QuestionBase
from dofkit.homework.repairs import nearest_reading
from dofkit.homework.result import Item
from dofkit.homework.sentences.translations import Language, in_language
from dofkit.scene.reading import load


class Understood(NamedTuple):
    """``told``: how an answer is read; where it is not ``readable``, why, and where reading stopped."""

    readable: bool
    told: str


def reading_of(names: str | os.PathLike[str], problem: str, question: str, answer: object) -> Understood:
    """Whether an answer can be read; ``names``: the file that `names_only` made of an assignment.

    One that reads in several ways, or by what only the whole scene says (a student's own coordinates), can be read, and
    it is told what is open. Raises QuestionError for a question that is not asked.
    """
    path = Path(names)
    prepared = _prepared(str(path), path.stat().st_mtime_ns)
    asked = next((q for p, q in prepared.questions() if (p.id, q.id) == (problem, question)), None)
    if asked is None:
        raise QuestionError(f"the assignment has no question '{question}' in a problem '{problem}'")
    found = of_value({"answers": {problem: {question: None if answer is ... else answer}}}, "student")
    given = found.answers.get(problem, {}).get(question)
    where, language = f"{line(problem)}.{line(question)}", prepared.assignment.language
    if given is None or says_nothing(given):
        return Understood(False, f"{where}: {in_language(language, 'No answer was given.')}")
    key = prepared.keys[problem]
    try:
        with by_processor(ANSWER_SECONDS):
            return Understood(
                True, f"{where}: {in_language(language, 'Read as: {text}', text=plain(asked.read(given, key)))}"
            )
    except DoubtError as error:
        return Understood(True, f"{where}: {needs_review('', error.message).feedback(language)}")
    except TextError as error:
        return Understood(False, f"{where}: {_stopped(error, problem, asked, given, key, language)}")


def _stopped(error: TextError, problem: str, asked: QuestionBase, given: Given, key: Key, language: Language) -> str:
    """Why reading stopped, where, and what would be read."""
    error = in_whole(given, error, partial(asked.read, key=key))

    def judged(text: str) -> Judgement:
        return needs_review(asked.read(text, key), "grading was interrupted.")

    nearest = nearest_reading(given, error, judged)
    found = unreadable(error, () if nearest is None else (nearest,))
    item = Item(
        problem=problem, question=asked.id, score=None, max_score=float(asked.points), status="unreadable", codes=[],
        read_as="", feedback=found.feedback(language), column=found.column, answer=shown_text(given),
        would_read=None if nearest is None else nearest.read_as,
    )  # fmt: skip
    return remark(item, language)


@lru_cache(maxsize=8)
def _prepared(path: str, changed: int) -> Prepared:
    """The names of an assignment; no question of the assignment has this name of them but how texts read."""
    del changed
    value = json.loads(Path(path).read_text(encoding="utf-8"), parse_float=Decimal)
    assignment = Assignment.model_validate(value)
    keys = {p.id: Key(load(p.scene, name=p.id), assignment.convention, {}, p.other_names) for p in assignment.problems}
    return Prepared(assignment, keys)
