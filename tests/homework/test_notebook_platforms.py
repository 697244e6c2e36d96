"""The notebooks' graders themselves, run on assignments: otter-grader and nbgrader.

Each is found beside this Python, on the path, or by ``DOFKIT_OTTER`` and ``DOFKIT_NBGRADER``, which name a Python that
has it, with ipykernel and what dofkit needs. (dofkit itself is put on its path.)
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.homework import stand_ins

pytestmark = pytest.mark.sweep
ROOT = Path(dofkit.__file__).parent.parent
SHEET = """\
title: Sheet 1
problems:
- id: pendulum
  scene:
    dimension: 2
    title: SECRET
    parameters: {l: 3/10}
    particles: [A]
    constraints:
    - {name: rod, type: link, between: [[0, 0], A], length: l}
    expect: {dof: 1}
  questions:
  - {id: f, ask: dof, points: 2}
  - {id: rod, ask: equation, constraint: rod, points: 8}
  - {id: label, ask: label, constraint: rod, points: 2}
- id: disc
  scene: disc-rolling-on-plane
  questions:
  - {id: f, ask: dof, points: 0.5}
"""
#: Right, half right, in doubt (half until a person has reviewed it), wrong: 2 + 4 + 1 + 0. And: what cannot be read, 0.
ANSWERS = {"f": "f = 1", "rod": "(x_A^2 + y_A^2 - l^2)^2", "label": "holonomic? scleronomic?", "disc": "2"}
UNREADABLE = {"f": "$$((", "rod": "x_A^2 + ( = ", "label": "holonomic, scleronomic", "disc": "4"}


def program(name: str, variable: str, package: str) -> Path:
    """A platform's program, or the test is skipped."""
    python = os.environ.get(variable)
    beside = Path(python or sys.executable).parent / name
    found = str(beside) if beside.exists() else shutil.which(name) if python is None else None
    if found is None:
        pytest.skip(
            f"there is no {package}: pip install {package} ipykernel, or name a Python that has it in {variable}"
        )
    return Path(found)


def run(folder: Path, *command: object, **more: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "JUPYTER_PLATFORM_DIRS": "1", **more}
    environment["PATH"] = f"{Path(str(command[0])).parent}{os.pathsep}{environment['PATH']}"
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, env=environment, capture_output=True, text=True, timeout=300,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout + done.stderr


def rows(table: Path) -> list[tuple[str, ...]]:
    """Problem, question, status and points of every row."""
    with table.open(newline="") as stream:
        return [tuple(row[1:5]) for row in csv.reader(stream)][1:]


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    (tmp_path / "sheet.yaml").write_text(SHEET)
    return tmp_path / "sheet.yaml"


def filled(notebook: Path, answers: dict[str, str], to: Path) -> Path:
    """A student's notebook with answers."""
    text: dict[str, Any] = json.loads(notebook.read_text())
    places = {f'answers["{p}"]["{q}"]': answers[key] for key, p, q in (
        ("f", "pendulum", "f"), ("rod", "pendulum", "rod"), ("label", "pendulum", "label"), ("disc", "disc", "f"),
    )}  # fmt: skip
    for cell in text["cells"]:
        source = "".join(cell["source"])
        for place, answer in places.items():
            if source.startswith(f"{place} = ..."):
                cell["source"] = [f"{place} = {answer!r}"]
    to.write_text(json.dumps(text))
    return to


def test_otter(sheet: Path) -> None:
    otter = program("otter", "DOFKIT_OTTER", "otter-grader")
    folder = sheet.parent
    run(folder, sys.executable, "-m", "dofkit", "export", "otter", sheet, "--out", folder / "otter")
    run(folder / "otter", otter, "assign", "sheet.ipynb", folder / "dist", "--no-pdfs")
    student = folder / "dist" / "student"
    given = sorted(path.name for path in student.rglob("*") if path.is_file())
    assert given == ["names.json", "sheet.ipynb"]
    shown = "".join(path.read_text() for path in student.iterdir())
    for secret in ("SECRET", "3/10", "expect", "link", "assignment.json", "check("):
        assert secret not in shown.replace("grader.check(", "")
    (archive,) = (folder / "dist" / "autograder").glob("*.zip")
    expected = {
        "right": (ANSWERS, {"pendulum_f": 2.0, "pendulum_rod": 4.0, "pendulum_label": 1.0, "disc_f": 0.0}),
        "unread": (UNREADABLE, {"pendulum_f": 0.0, "pendulum_rod": 0.0, "pendulum_label": 2.0, "disc_f": 0.5}),
        "empty": (dict.fromkeys(ANSWERS, ""), dict.fromkeys(
            ("pendulum_f", "pendulum_rod", "pendulum_label", "disc_f"), 0.0
        )),
    }  # fmt: skip
    listed = {}
    for name, (answers, scores) in expected.items():
        out, table = folder / name, folder / f"{name}.csv"
        out.mkdir()
        submission = filled(student / "sheet.ipynb", answers, folder / f"{name}.ipynb")
        run(folder, otter, "run", "-a", archive, "-o", out, "--no-logo", submission, DOFKIT_OPEN=str(table))
        found = json.loads((out / "results.json").read_text())["tests"]
        assert {test["name"]: test["score"] for test in found if "score" in test} == scores
        listed[name] = rows(table) if table.exists() else []
        public = next(test["output"] for test in found if test["name"] == "Public Tests")
        if name == "unread":
            assert "pendulum.f: Not readable (column " in public
            assert "pendulum_label results: All test cases passed!" in public
    assert listed == {
        "right": [("pendulum", "label", "needs_review", "1")],
        "unread": [("pendulum", "f", "unreadable", "0"), ("pendulum", "rod", "unreadable", "0")],
        "empty": [],
    }


def code(name: str, source: str, **more: Any) -> dict[str, Any]:
    """A cell of nbgrader's."""
    said = {"grade": False, "solution": False, "locked": False, "task": False, "schema_version": 3, **more}
    return {
        "cell_type": "code", "id": name, "metadata": {"nbgrader": {"grade_id": name, **said}},
        "execution_count": None, "outputs": [], "source": source,
    }  # fmt: skip


def master(places: list[tuple[str, str, str, float]]) -> dict[str, Any]:
    """A notebook for nbgrader in which every question has a cell for its answer and one that grades it."""
    cells = []
    for key, problem, question, points in places:
        cells.append(code(f"{key}-answer", f"### BEGIN SOLUTION\n{key} = None\n### END SOLUTION", solution=True))
        call = f"points('../../../sheet.yaml', '{problem}', '{question}', {key})"
        hidden = f"from dofkit.homework.nbgrader import points\n{call}"
        source = f"### BEGIN HIDDEN TESTS\n{hidden}\n### END HIDDEN TESTS"
        cells.append(code(key, source, grade=True, locked=True, points=points))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


SCORES = """
import json
from nbgrader.api import Gradebook
with Gradebook("sqlite:///gradebook.db") as book:
    print(json.dumps({s.student.id: {g.name: g.auto_score for n in s.notebooks for g in n.grades}
                      for s in book.assignment_submissions("ps1")}))
"""


def test_nbgrader(sheet: Path) -> None:
    nbgrader = program("nbgrader", "DOFKIT_NBGRADER", "nbgrader")
    folder = sheet.parent
    places = [("f", "pendulum", "f", 2.0), ("rod", "pendulum", "rod", 8.0), ("label", "pendulum", "label", 2.0),
              ("disc", "disc", "f", 0.5)]  # fmt: skip
    source = folder / "source" / "ps1"
    source.mkdir(parents=True)
    (source / "sheet.ipynb").write_text(json.dumps(master(places)))
    run(folder, nbgrader, "generate_assignment", "ps1", f"--course-dir={folder}")
    release = folder / "release" / "ps1" / "sheet.ipynb"
    assert "sheet.yaml" not in release.read_text()
    for student, answers in (("ada", ANSWERS), ("bob", UNREADABLE)):
        text = json.loads(release.read_text())
        for cell in text["cells"]:
            name = cell["metadata"]["nbgrader"]["grade_id"]
            if name.endswith("-answer"):
                key = name.removesuffix("-answer")
                cell["source"] = f"{key} = {answers[key]!r}"
        (folder / "submitted" / student / "ps1").mkdir(parents=True)
        (folder / "submitted" / student / "ps1" / "sheet.ipynb").write_text(json.dumps(text))
    run(folder, nbgrader, "autograde", "ps1", f"--course-dir={folder}")
    told = run(folder, nbgrader.with_name("python"), "-c", SCORES)
    assert json.loads(told[told.index("{") :].splitlines()[0]) == {
        "ada": {"f": 2.0, "rod": 4.0, "label": 1.0, "disc": 0.0},
        "bob": {"f": 0.0, "rod": 0.0, "label": 2.0, "disc": 0.5},
    }
    graded = folder / "autograded"
    assert rows(graded / "ada" / "ps1" / stand_ins.NAME) == [("pendulum", "label", "needs_review", "1")]
    assert [row[1] for row in rows(graded / "bob" / "ps1" / stand_ins.NAME)] == ["f", "rod"]
    printed = (graded / "bob" / "ps1" / "sheet.ipynb").read_text()
    assert "$$((\\n" in printed
    assert "submit again" in printed
