"""The master notebook of an assignment for ``otter assign``, and the two files that its tests read.

``otter assign NOTEBOOK DIST`` makes of it what students get, with ``names.json``, and what grades them, with
``assignment.json``: the scenes, and with them the key, are in the latter only. Names of tests are plain, since otter
makes files of them.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.export.inline import exact_json, inlined
from dofkit.homework.export.names_only import names_only
from dofkit.homework.formats.wording import number
from dofkit.homework.otter import parts_of
from dofkit.homework.problem import Problem
from dofkit.homework.questions import QuestionBase
from dofkit.homework.statement import marked

NAMES, ASSIGNMENT = "names.json", "assignment.json"
_CONFIG = f"""# ASSIGNMENT CONFIG
init_cell: true
export_cell:
  pdf: false
run_tests: false
requirements:
- dofkit
files:
- {NAMES}
autograder_files:
- {ASSIGNMENT}
tests:
  ok_format: false
  files: false
"""
_TEST = '''""" # BEGIN TEST CONFIG
hidden: {hidden}
points: {points}
""" # END TEST CONFIG
def test_{name}(answers):
    from dofkit.homework.otter import {call}
    {call}({arguments})
'''


class OtterError(DofkitError):
    """An assignment of which no notebook for otter can be made."""


def export_otter(assignment: str | os.PathLike[str], folder: Path) -> list[Path]:
    """Write the master notebook and its files into a folder; the paths written.

    Raises AssignmentError, OtterError where two questions would have the same test or every student has another sheet,
    and OSError.
    """
    prepared = load_assignment(assignment)
    if prepared.assignment.variants is not None:
        raise OtterError("every student has a variant, but otter runs the same tests for all: use dofkit grade")
    folder.mkdir(parents=True, exist_ok=True)
    texts = {
        f"{_plain(Path(assignment).stem)}.ipynb": json.dumps(_notebook(prepared), indent=1, ensure_ascii=False) + "\n",
        NAMES: json.dumps(names_only(prepared), indent=1) + "\n",
        ASSIGNMENT: f"{exact_json(inlined(assignment))}\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in texts]


def _plain(text: str) -> str:
    return re.sub(r"\W", "_", text, flags=re.ASCII)


def _notebook(prepared: Prepared) -> dict[str, Any]:
    cells = [
        _cell("raw", _CONFIG),
        _cell("markdown", f"# {marked(prepared.assignment.title)}"),
        _cell("code", f"answers = {json.dumps({p.id: {} for p in prepared.assignment.problems})}"),
    ]
    taken: set[str] = set()
    for problem, question in prepared.questions():
        name = _plain(f"{problem.id}_{question.id}")
        if name in taken:
            raise OtterError(f"two questions would have the test '{name}': rename one of them")
        taken.add(name)
        cells += _question(name, problem, question)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    numbered = [{**cell, "id": f"cell-{i}"} for i, cell in enumerate(cells)]
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": numbered, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def _question(name: str, problem: Problem, question: QuestionBase) -> Iterator[dict[str, Any]]:
    """The cells of one question."""
    asked = type(question).model_fields["ask"].description or question.kind()
    place = f"answers[{json.dumps(problem.id)}][{json.dumps(question.id)}]"
    yield _cell("raw", f"# BEGIN QUESTION\nname: {name}")
    heading = f"{marked(problem.title or problem.id)}, {marked(question.id)}"
    yield _cell("markdown", f"**{heading}** ({number(float(question.points))}): {asked}")
    yield _cell("raw", "# BEGIN SOLUTION")
    yield _cell("code", f"{place} = None # SOLUTION")
    yield _cell("raw", "# END SOLUTION")
    yield _cell("raw", "# BEGIN TESTS")
    yield _cell("code", _test(f"{name}_is_read", "readable", 0.0, [NAMES], problem, question))
    parts = parts_of(question)
    for part in range(1, parts + 1):
        points = float(question.points / parts)
        yield _cell("code", _test(f"{name}_{part}", "check", points, [ASSIGNMENT, part, parts], problem, question))
    yield _cell("raw", "# END TESTS")
    yield _cell("raw", "# END QUESTION")


def _test(name: str, call: str, points: float, given: list[Any], problem: Problem, question: QuestionBase) -> str:
    """The code of a test: ``given`` is the file, and what stands behind the answer's place."""
    file, *rest = given
    arguments = [repr(file), "answers", repr(problem.id), repr(question.id), *map(repr, rest)]
    hidden = str(call == "check").lower()
    return _TEST.format(name=name, call=call, points=points, hidden=hidden, arguments=", ".join(arguments))


def _cell(kind: str, source: str) -> dict[str, Any]:
    code: dict[str, Any] = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, "source": source.splitlines(keepends=True), **code}
