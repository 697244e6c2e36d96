"""Test files for otter-grader, and what they call.

A test of otter passes or fails, so that a question is as many tests as its answer can have parts, at least two: of half
an answer half of the tests pass. Half of them pass as well for an answer that could not be decided, and the text of
the others says that a person has to look. The students' notebook defines ``answers = {PROBLEM: {QUESTION: answer}}``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from dofkit.base.errors import DofkitError
from dofkit.homework.assignment import load_assignment
from dofkit.homework.export.inline import exact_json, inlined
from dofkit.homework.formats.wording import remark, stand_in
from dofkit.homework.notebooks import Source, item_of
from dofkit.homework.questions import QuestionBase

_FILE = '''"""Made by dofkit from an assignment; ``answers`` comes from the notebook."""

from otter.test_files import test_case

from dofkit.homework.otter import check

OK_FORMAT = False

name = {name!r}
points = {points!r}
all_or_nothing = False
{tests}'''
_TEST = """

@test_case(name={name!r}, points={points!r}, hidden=False)
def test_{number}(answers):
    check({assignment!r}, answers, {problem!r}, {question!r}, {number}, {parts})
"""


class TestFileError(DofkitError):
    """Test files that cannot be written."""


def check(assignment: Source, answers: object, problem: str, question: str, number: int = 1, parts: int = 1) -> None:
    """Pass where an answer is worth ``number`` of ``parts`` parts or more.

    Raises AssertionError otherwise: its text, which students see, is the feedback.
    """
    given = answers.get(problem) if isinstance(answers, Mapping) else None
    found = dict(given) if isinstance(given, Mapping) else {}
    answer = found.pop(question, None)
    item = item_of(assignment, problem, question, answer, found)
    share = stand_in(item) / item.max_score if item.max_score else 1.0
    if share * parts < number - 1e-9:
        raise AssertionError(remark(item))


def write_tests(assignment: str | os.PathLike[str], folder: Path) -> list[Path]:
    """Write a test file for every question, and beside the folder ``assignment.json``, which they read.

    Raises AssignmentError, and TestFileError where two questions would have the same file.
    """
    prepared = load_assignment(assignment)
    folder.mkdir(parents=True, exist_ok=True)
    beside = folder.parent / "assignment.json"
    beside.write_text(f"{exact_json(inlined(assignment))}\n", encoding="utf-8")
    written: list[Path] = []
    for problem, question in prepared.questions():
        name = re.sub(r"\W", "_", f"{problem.id}_{question.id}", flags=re.ASCII)
        path = folder / f"{name}.py"
        if path in written:
            raise TestFileError(f"two questions would have the test file {path.name}: rename one of them")
        path.write_text(_test_file(name, problem.id, question, beside.name), encoding="utf-8")
        written.append(path)
    return written


def parts_of(question: QuestionBase) -> int:
    """In how many parts the points of a question may be given."""
    several = getattr(question, "parts", None) or getattr(question, "constraint", None)
    return 2 * len(several) if isinstance(several, tuple) else 2


def _test_file(name: str, problem: str, question: QuestionBase, assignment: str) -> str:
    parts = parts_of(question)
    tests = "".join(
        _TEST.format(
            name=f"{problem}.{question.id}, part {number} of {parts}", points=float(question.points / parts),
            number=number, parts=parts, assignment=assignment, problem=problem, question=question.id,
        )
        for number in range(1, parts + 1)
    )  # fmt: skip
    return _FILE.format(name=name, points=float(question.points), tests=tests)
