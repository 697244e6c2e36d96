"""What `dofkit.homework.nbgrader` and `dofkit.homework.otter` share: one answer from a notebook, judged on the spot."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from contextlib import redirect_stderr
from functools import lru_cache
from io import StringIO
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.grading import Grader
from dofkit.homework.result import Item
from dofkit.homework.sentences.translations import Language

#: An assignment: its path, or what was made of it.
Source = str | os.PathLike[str] | Mapping[str, Any] | Prepared


class QuestionError(DofkitError):
    """A question that the assignment does not ask."""


def item_of(
    assignment: Source, problem: str, question: str, answer: object, others: Mapping[str, object]
) -> tuple[Item, Language]:
    """Return the result of one answer, and the language of the assignment.

    ``others``: the student's answers to other questions of the problem.

    Nothing is written to standard error meanwhile. Raises AssignmentError, and QuestionError for what is not asked.
    """
    with warnings.catch_warnings(), redirect_stderr(StringIO()):
        warnings.simplefilter("ignore")
        grader = _grader_of(assignment)
        if grader.prepared.assignment.variants is not None:
            raise QuestionError("every student has a variant: grade them with `dofkit grade`, not in a notebook")
        if (problem, question) not in {(p.id, q.id) for p, q in grader.prepared.questions()}:
            raise QuestionError(f"the assignment has no question '{question}' in a problem '{problem}'")
        given = {"answers": {problem: {**others, question: answer}}}
        result = grader.grade(of_value(given, "student"))
    if result.error is not None:
        raise QuestionError(result.error)
    item = next(item for item in result.items if (item.problem, item.question) == (problem, question))
    return item, grader.prepared.assignment.language


def _grader_of(assignment: Source) -> Grader:
    if isinstance(assignment, Prepared):
        return Grader(assignment)
    if isinstance(assignment, Mapping):
        return Grader(load_assignment(assignment))
    path = Path(assignment)
    return _grader(str(path), path.stat().st_mtime_ns if path.exists() else 0)


@lru_cache(maxsize=8)
def _grader(path: str, changed: int) -> Grader:
    del changed
    return Grader(load_assignment(path))
