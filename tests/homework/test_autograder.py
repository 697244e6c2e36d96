"""Grading where a course platform has put a submission, and what the platform is given for it."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from dofkit.homework.assignment import load_assignment
from dofkit.homework.autograder import RESULTS, grade_at, main
from dofkit.homework.export import export_gradescope
from dofkit.homework.handout.portable import standing_alone
from dofkit.interface.cli import app

MEMORY = 2 << 30
ASSIGNMENT = """\
title: Sheet 1
visibility: visible
problems:
- id: pendulum
  scene: pendulum.yaml
  questions:
  - {id: f, ask: dof, points: 2}
  - {id: rod, ask: equation, constraint: rod, points: 8}
- id: disc
  scene: disc-rolling-on-plane
  questions:
  - {id: f, ask: dof, points: 0.5}
"""
SCENE = """\
dimension: 2
particles: [A]
constraints:
- {name: rod, type: link, between: [[0, 0], A], length: 0.1}
"""
#: f = 1 is right; the squared equation is worth half; the disc has f = 4, not 2.
ANSWERS: dict[str, dict[str, Any]] = {"pendulum": {"f": "f = 1", "rod": "(x_A^2 + y_A^2 - 0.01)^2"}, "disc": {"f": 2}}


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    folder = tmp_path / "sheet"
    folder.mkdir()
    (folder / "pendulum.yaml").write_text(SCENE)
    (folder / "assignment.yaml").write_text(ASSIGNMENT)
    return folder / "assignment.yaml"


def hand_in(folder: Path, **files: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name.replace("__", ".")).write_text(text)
    return folder.parent


def written(root: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((root / RESULTS).read_text(encoding="ascii"))
    return document


def submission(**more: Any) -> str:
    return json.dumps({"answers": ANSWERS, **more})


def test_gradescope(sheet: Path, tmp_path: Path) -> None:
    root = hand_in(tmp_path / "autograder" / "submission", anything__json=submission(student="somebody else"))
    (root / "submission_metadata.json").write_text('{"users": [{"email": "ada@uni.example", "name": "Ada", "id": 1}]}')
    assert main([str(sheet), "--root", str(root)]) == 0
    found = written(root)
    assert found["score"] == 6.0
    assert found["extra_data"]["student"] == "ada@uni.example"
    assert "ada@uni.example's, but names 'somebody else'" in found["extra_data"]["doubt"]
    assert found["output"].startswith("This result is not final: it was submitted as ada@uni.example's")
    assert [(t["name"], t["score"], t["max_score"], t["status"]) for t in found["tests"]] == [
        ("pendulum.f", 2.0, 2.0, "passed"),
        ("pendulum.rod", 4.0, 8.0, "failed"),
        ("disc.f", 0.0, 0.5, "failed"),
    ]
    assert sorted(path.name for path in (root / "results").iterdir()) == ["results.json"]


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("answers.csv", "pendulum.f,disc.f\n1,4\n"),
        ("x.csv", "disc.f;pendulum.f\n4;1\n"),
        ("hw.yaml", "pendulum: {f: 1}\ndisc: {f: 4}\n"),
        ("hw.yml", "pendulum.f: 1\ndisc.f: 4\n"),
        ("folder/within/answers.json", '{"pendulum": {"f": 1}, "disc": {"f": 4}}'),
    ],
)
def test_what_says_nothing_of_its_student_is_the_submitters(name: str, text: str, sheet: Path, tmp_path: Path) -> None:
    path = tmp_path / "autograder" / "submission" / name
    path.parent.mkdir(parents=True)
    path.write_text(text)
    for left in (".git/config.yaml", "__MACOSX/folder/._answers.json"):
        other = tmp_path / "autograder" / "submission" / left
        other.parent.mkdir(parents=True)
        other.write_text("a: 1")
    root = tmp_path / "autograder"
    (root / "submission_metadata.json").write_text('{"users": [{"email": "ada@uni.example", "name": "Ada", "id": 1}]}')
    found = grade_at(root, sheet, MEMORY)
    assert (found.student, found.score, found.doubt, found.error) == ("ada@uni.example", 2.5, None, None)


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("line", "expected"),
    [("", "after_due_date"), ("visibility: visible\n", "visible"), ("visibility: after_published\n", "after_published"),
     ("visibility: hidden\n", "hidden")],
)  # fmt: skip
def test_when_points_are_shown(line: str, expected: str, sheet: Path, tmp_path: Path) -> None:
    sheet.write_text(line + ASSIGNMENT.replace("visibility: visible\n", ""))
    given = {"pendulum": {"f": 1, "rod": "x_A + ("}}
    root = hand_in(tmp_path / "root" / "submission", answers__json=json.dumps({"answers": given}))
    grade_at(root, sheet, MEMORY)
    found = written(root)
    judged = [test for test in found["tests"] if "extra_data" in test]
    read = [test for test in found["tests"] if "extra_data" not in test]
    assert {found["visibility"], *(test["visibility"] for test in judged)} == {expected}
    if expected == "visible":
        assert read == []
        return
    assert all(test["visibility"] == "visible" and not {"score", "status"} & set(test) for test in read)
    outputs = {test["name"]: test["output"] for test in read}
    assert outputs["pendulum.f: how it was read"] == "Read as: 1"
    assert outputs["pendulum.rod: how it was read"].startswith("Not readable (column ")
    assert outputs["disc.f: how it was read"] == "No answer was given."
    assert "points are shown later" in found["output"]


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("line", "dates", "expected"),
    [
        ("", {"due_date": "2026-11-30T23:00:00-07:00", "late_due_date": None}, "after_due_date"),
        ("", {"due_date": None, "late_due_date": None}, "after_published"),
        ("visibility: after_due_date\n", {"due_date": None}, "after_published"),
        ("", {"due_date": None, "late_due_date": "2026-12-02T23:00:00-07:00"}, "after_due_date"),
    ],
)
def test_without_a_due_date_points_are_shown_when_they_are_published(
    line: str, dates: dict[str, Any], expected: str, sheet: Path, tmp_path: Path
) -> None:
    sheet.write_text(line + ASSIGNMENT.replace("visibility: visible\n", ""))
    root = hand_in(tmp_path / "root" / "submission", answers__json=submission())
    (root / "submission_metadata.json").write_text(json.dumps({"assignment": {"id": 1, **dates}}))
    grade_at(root, sheet, MEMORY)
    assert written(root)["visibility"] == expected


@pytest.mark.sweep
@pytest.mark.parametrize("sign", [".", "_", "-"])
def test_prairielearn_takes_what_was_typed(sign: str, sheet: Path, tmp_path: Path) -> None:
    given: dict[str, Any] = {f"{p}{sign}{q}": str(a) for p, answers in ANSWERS.items() for q, a in answers.items()}
    given[f"disc{sign}f"] = {"_type": "sympy", "_value": "2"}
    data = {"params": {}, "submitted_answers": {**given, "_files": []}}
    root = hand_in(tmp_path / "grade" / "data", data__json=json.dumps(data))
    command = ["grade", str(sheet), str(root / "data" / "data.json"), "--format", "prairielearn"]
    assert CliRunner().invoke(app, [*command, "--out", str(root / RESULTS)]).exit_code == 0
    found = written(root)
    assert (found["gradable"], found["score"]) == (True, 6 / 10.5)
    assert [test["points"] for test in found["tests"]] == [2.0, 4.0, 0.0]


ONE, LINKED = submission(), "link"


@pytest.mark.parametrize(
    ("files", "why"),
    [
        ({"a.json": ONE, "b.json": ONE}, "there is more than one submission: a.json; b.json; submit one"),
        ({"answers.json": f"[{ONE}, {ONE}]"}, "a submission is a mapping"),
        ({"answers.csv": "student,disc.f\nada,4\nbob,4\n"}, "more than one submission: answers.csv, line 2;"),
        ({"answers.json": LINKED}, "there is no file with answers"),
        ({"answers.json": '{"answers": {'}, "line 1"),
        ({}, "there is no file with answers"),
        ({"essay.pdf": "%PDF", "script.py": "import os"}, "there is no file with answers"),
    ],
)
def test_what_is_no_submission_is_said(files: dict[str, str], why: str, sheet: Path, tmp_path: Path) -> None:
    root = hand_in(tmp_path / "root" / "submission", **{k: v for k, v in files.items() if v != LINKED})
    if LINKED in files.values():
        (tmp_path / "secret.json").write_text(ONE)
        (root / "submission" / "answers.json").symlink_to(tmp_path / "secret.json")
    result = grade_at(root, sheet, MEMORY)
    assert result.error is not None
    assert result.score is None
    assert why in result.error
    assert why in json.dumps(written(root))


@pytest.mark.sweep
@pytest.mark.parametrize("metadata", ["", "[]", '{"users": 3}', '{"users": [7]}', '{"users": []}', "[" * 100_000])
def test_metadata_may_be_anything(metadata: str, sheet: Path, tmp_path: Path) -> None:
    root = hand_in(tmp_path / "root" / "submission", answers__json=submission())
    (root / "submission_metadata.json").write_text(metadata)
    assert grade_at(root, sheet, MEMORY).score == 6.0


def unpacked(sheet: Path, tmp_path: Path) -> Path:
    """An autograder as Gradescope lays it out, with a submission."""
    archive = tmp_path / "out" / "autograder.zip"
    export_gradescope(sheet, archive)
    root = hand_in(tmp_path / "autograder" / "submission", answers__json=submission())
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(root / "source")
    script = root / "run_autograder"
    script.write_bytes((root / "source" / "run_autograder").read_bytes())
    script.chmod(0o755)
    return root


def run(root: Path, **more: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join(p for p in sys.path if p)
    environment = {**os.environ, "DOFKIT_AUTOGRADER": str(root), "DOFKIT_PYTHON": sys.executable, "PYTHONPATH": path}
    return subprocess.run(
        [str(root / "run_autograder")],
        env={**environment, **more},
        cwd=root,
        capture_output=True,
        text=True,
        check=True,
    )


def test_the_exported_autograder_runs(sheet: Path, tmp_path: Path) -> None:
    root = unpacked(sheet, tmp_path)
    sheet.unlink()
    (sheet.parent / "pendulum.yaml").unlink()
    done = run(root)
    assert written(root)["score"] == 6.0
    assert done.stdout == "3 answers, 0 to review\n"


@pytest.mark.parametrize(
    "more", [{"DOFKIT_PYTHON": "/bin/false"}, {"DOFKIT_SECONDS": "0.05"}, {"DOFKIT_PYTHON": "/no"}]
)
def test_an_autograder_that_fails_leaves_a_result(more: dict[str, str], sheet: Path, tmp_path: Path) -> None:
    root = unpacked(sheet, tmp_path)
    done = run(root, **more)
    assert "needs a review" in done.stdout
    found = written(root)
    assert found["output"].startswith("Points so far: 0 of 10.5. This is not final")
    assert [test["name"] for test in found["tests"]] == ["pendulum.f", "pendulum.rod", "disc.f"]
    assert all(not {"score", "status"} & set(test) for test in found["tests"])
    assert all("grading was interrupted" in test["output"] for test in found["tests"])


def test_the_zip(sheet: Path, tmp_path: Path) -> None:
    for name in ("a.zip", "b.zip"):
        export_gradescope(sheet, tmp_path / name)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.zip") as packed:
        modes = {i.filename: oct(i.external_attr >> 16) for i in packed.infolist()}
        required = packed.read("requirements.txt").decode()
    code = {name for name in modes if name.startswith("code/dofkit/")}
    assert {name: mode for name, mode in modes.items() if name not in code} == {
        "README.txt": "0o644", "run_autograder": "0o755", "setup.sh": "0o755", "assignment.json": "0o644",
        "fallback.json": "0o644", "requirements.txt": "0o644",
    }  # fmt: skip
    assert {"code/dofkit/py.typed", "code/dofkit/homework/formats/templates/base.html"} <= code
    assert any(name.startswith("code/dofkit/_catalog/") and name.endswith("/four-bar-linkage.yaml") for name in code)
    assert not [name for name in code if "__pycache__" in name]
    assert any(line.startswith("sympy") for line in required.splitlines())


def test_an_assignment_in_one_piece(sheet: Path, tmp_path: Path) -> None:
    first = load_assignment(sheet)
    (tmp_path / "alone.json").write_text(json.dumps(standing_alone(first, tmp_path)))
    second = load_assignment(tmp_path / "alone.json")
    for name, key in first.keys.items():
        assert second.keys[name].scene.constraints == key.scene.constraints
        assert second.keys[name].report == key.report


def test_the_commands(sheet: Path, tmp_path: Path) -> None:
    runner = CliRunner()
    zipped = runner.invoke(app, ["export", "gradescope", str(sheet), "--out", str(tmp_path / "a.zip")])
    assert (zipped.exit_code, zipfile.is_zipfile(tmp_path / "a.zip")) == (0, True)
    refused = runner.invoke(
        app, ["export", "gradescope", str(tmp_path / "none.yaml"), "--out", str(tmp_path / "no.zip")]
    )
    assert refused.exit_code == 2
    assert "there is no file" in refused.stderr
    for what in ("scene", "assignment", "result", "report"):
        printed = runner.invoke(app, ["schema", what] if what != "scene" else ["schema"])
        assert json.loads(printed.stdout)["title"].lower() == what
    assert runner.invoke(app, ["schema", "homework"]).exit_code == 2


@pytest.mark.sweep
def test_what_a_person_decided_comes_back(sheet: Path, tmp_path: Path) -> None:
    given = json.dumps({"answers": {"pendulum": {"f": "$$((", "rod": "x_A^2 + y_A^2 = 0.01"}, "disc": {"f": 4}}})
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "ada.json").write_text(given)
    ran = CliRunner().invoke(app, ["grade", str(sheet), str(tmp_path / "in"), "--out", str(tmp_path / "out.jsonl")])
    assert ran.exit_code == 0
    table = tmp_path / "out.review.csv"
    rows = list(csv.reader(io.StringIO(table.read_text(encoding="utf-8-sig"), newline="")))
    place = rows[0].index("points")
    rows[1][place] = "1.5"
    with (sheet.parent / "review.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows(rows)
    archive = tmp_path / "a.zip"
    export_gradescope(sheet, archive, reviewed=sheet.parent / "review.csv")
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path / "source")
    root = hand_in(tmp_path / "autograder" / "submission", answers__json=given)
    assert main([str(tmp_path / "source" / "assignment.json"), "--root", str(root)]) == 0
    assert written(root)["score"] == 10.0
    (sheet.parent / "review.csv").write_text("no table")
    assert main([str(sheet), "--root", str(root)]) == 2
    assert written(root)["score"] == 10.0
