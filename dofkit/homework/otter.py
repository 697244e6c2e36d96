"""What the tests call that `dofkit export otter` writes for otter-grader.

The public test of a question, which students have, says whether the answer can be read and how: it knows the names of a
scene and nothing else. The hidden ones judge it, by the lecturer's file. A test of otter passes or fails, so that a
question is as many tests as its answer can have parts, at least two: of half an answer half of the tests pass. Half of
them pass as well for an answer that could not be decided; for one that could not be read none does. Both are listed for
the lecturer (`dofkit.homework.stand_ins`). The notebook defines ``answers = {PROBLEM: {QUESTION: answer}}``.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from dofkit.homework.formats.wording import remark, stand_in
from dofkit.homework.notebooks import Source, item_of
from dofkit.homework.questions import QuestionBase
from dofkit.homework.readings import reading_of
from dofkit.homework.stand_ins import list_open


def readable(names: str | os.PathLike[str], answers: object, problem: str, question: str) -> None:
    """Print how an answer is read. Raises AssertionError where it cannot be: its text says where reading stopped."""
    found = reading_of(names, problem, question, _given(answers, problem).get(question))
    if not found.readable:
        raise AssertionError(found.told)
    print(found.told)


def check(assignment: Source, answers: object, problem: str, question: str, number: int = 1, parts: int = 1) -> None:
    """Pass where an answer is worth ``number`` of ``parts`` parts or more.

    Raises AssertionError otherwise: its text is the feedback.
    """
    found = _given(answers, problem)
    item, language = item_of(assignment, problem, question, found.pop(question, None), found)
    list_open([item])
    share = stand_in(item) / item.max_score if item.max_score else 1.0
    if share * parts < number - 1e-9:
        raise AssertionError(remark(item, language))


def _given(answers: object, problem: str) -> dict[str, object]:
    """The answers to a problem; what is left as ``...`` is none."""
    given = answers.get(problem) if isinstance(answers, Mapping) else None
    return {key: each for key, each in given.items() if each is not ...} if isinstance(given, Mapping) else {}


def parts_of(question: QuestionBase) -> int:
    """In how many parts the points of a question may be given."""
    several = getattr(question, "parts", None) or getattr(question, "constraint", None)
    return 2 * len(several) if isinstance(several, tuple) else 2
