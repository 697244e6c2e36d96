"""Nothing to steal: what a student could try to get points that nobody earned, and what comes of it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from shared.known_scenes import spread

import dofkit
from dofkit.homework import hand_in
from dofkit.homework.assignment import load_assignment
from dofkit.homework.formats import coursera, gradescope, prairielearn
from dofkit.homework.runs.run import GradingOptions, run

LINE = {"coordinates": ["x", "y"], "constraints": ["x = y"]}
SHEET = {"title": "Sheet", "problems": [{"id": "p", "scene": LINE, "questions": [{"id": "f", "ask": "dof"}]}]}
ROSTER = "name,email\nAda,ada@x\nGrace,grace@x\nEve,eve@x\n"
RIGHT, WRONG = "p: {f: 1}\n", "p: {f: 2}\n"


def graded(folder: Path, files: dict[str, str], roster: bool = True) -> list[dict[str, Any]]:
    """The results of a folder of submissions."""
    (folder / "sheet.json").write_text(json.dumps(SHEET))
    (folder / "roster.csv").write_text(ROSTER)
    for name, text in files.items():
        path = folder / "in" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    source = folder / "in"
    known = folder / "roster.csv" if roster else None
    run(str(folder / "sheet.json"), [str(source)], GradingOptions(out=folder / "out.jsonl", workers=1, roster=known))
    return [json.loads(line) for line in (folder / "out.jsonl").read_text().splitlines()]


def told(results: list[dict[str, Any]]) -> list[tuple[str, float | None, bool, bool]]:
    """Of every result: whose, points, in doubt, refused."""
    return [(one["student"], one["score"], one["doubt"] is not None, one["error"] is not None) for one in results]


@pytest.mark.parametrize("roster", [True, False])
def test_a_file_that_claims_to_be_anothers_displaces_nobody(roster: bool, tmp_path: Path) -> None:
    files = {"aaa.json": '{"student": "grace@x", "answers": {"p": {"f": 2}}}', "grace@x.yaml": RIGHT}
    assert told(graded(tmp_path, files, roster)) == [("grace@x", None, False, True), ("grace@x", 1.0, False, False)]


def test_a_guests_folder_cannot_submit_for_somebody_in_the_roster(tmp_path: Path) -> None:
    files = {
        "Zoe Guest_77_assignsubmission_file/aaa.yaml": "student: grace@x\n" + WRONG,
        "Grace_78_assignsubmission_file/answers.yaml": RIGHT,
    }
    assert told(graded(tmp_path, files))[::-1] == [("grace@x", None, False, True), ("grace@x", 1.0, False, False)]


@pytest.mark.parametrize(
    "files",
    spread(
        [
            {"a.yaml": "student: ada@x\n" + RIGHT, "b.yaml": "student: ada@x\n" + WRONG},
            {"ADA@X.json": '{"answers": {"p": {"f": 1}}}', "ada@x.json": '{"answers": {"p": {"f": 2}}}'},
            {"form.csv": "Email,p.f\nada@x,1\nada@x,2\n"},
            {"form.csv": "Timestamp,Email Address,p.f How many?\n2026-01-01 10:00,ada@x,1\n2026-01-02 10:00,Ada@x,2\n"},
        ],
        2,
    ),
)
def test_a_second_submission_is_an_error_and_leaves_the_first_in_doubt(files: dict[str, str], tmp_path: Path) -> None:
    assert told(graded(tmp_path, files)) == [("ada@x", 1.0, True, False), ("ada@x", None, False, True)]


def test_the_same_submission_twice_counts_once(tmp_path: Path) -> None:
    results = told(graded(tmp_path, {"ada@x.yaml": RIGHT, "ADA@x.yml": RIGHT}))
    assert results == [("ada@x", 1.0, False, False), ("ada@x", None, False, True)]


@pytest.mark.parametrize(
    ("name", "roster", "doubts"),
    spread(
        [
            ("\u0430da@x", True, [False, True]),  # a Cyrillic letter
            ("ada@x\u200b", True, [False, True]),
            ("\u0430da@x", False, [True, True]),
            ("eda@x", True, [False, False]),
        ],
        2,
        several=True,
    ),
)
def test_a_name_that_looks_like_anothers_is_a_doubt(
    name: str, roster: bool, doubts: list[bool], tmp_path: Path
) -> None:
    result = graded(tmp_path, {"ada@x.yaml": RIGHT, f"{name}.yaml": WRONG}, roster)
    assert [one["doubt"] is not None for one in result] == doubts
    assert [one["score"] for one in result] == [1.0, 0.0]


#: Answers of one shape, of which only the first is right: a constant under another name, and two readings.
ORACLES = [
    ("eq", "x^2 + y^2 = r^2", "x^2 + y^2 = 2 r^2"),
    ("eq", "1/2x^2 + 1/2y^2 = 1/2 l^2", "1/2x^2 + 1/2y^2 = 1/3 l^2"),
    ("eq", "x = l sin(a), y = l cos(a)", "x = l sin(a), y = 2 l cos(a)"),
    ("eq", "u^2 + v^2 = l^2", "u^2 + v^2 = 2 l^2"),
    ("f", "1 or 2", "2 or 3"),
    ("f", "1?", "2?"),
    ("label", "holonomic? scleronomic", "non-holonomic? scleronomic"),
]


@pytest.mark.parametrize(("question", "right", "wrong"), ORACLES)
def test_what_is_seen_before_points_does_not_tell_right_from_wrong(question: str, right: str, wrong: str) -> None:
    scene = {"parameters": {"l": "positive"}, "coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = l^2"]}
    asked = [
        {"id": "f", "ask": "dof"},
        {"id": "eq", "ask": "equation", "constraint": "c1"},
        {"id": "label", "ask": "label", "constraint": "c1"},
    ]
    sheet = load_assignment({"title": "One", "problems": [{"id": "p", "scene": scene, "questions": asked}]})
    shown = []
    for answer in (right, wrong):
        result = dofkit.grade(sheet, {"student": "eve", "answers": {"p": {question: answer}}})
        grades = prairielearn.document(result, sheet)
        early = [
            test for test in gradescope.document(result, sheet, "hidden")["tests"] if test["visibility"] == "visible"
        ]
        shown.append(json.dumps([grades.get("gradable"), grades.get("format_errors"), early]).replace(answer, "..."))
    for text, other in zip(*(re.split(r"Read as: [^\"]*|declared: [^\"]*", text) for text in shown), strict=True):
        assert text == other


@pytest.mark.parametrize(
    ("question", "answer"), [("f", "7?"), ("f", "3 = 4"), ("f", "n = 9"), ("label", "holonomic? rheonomic?")]
)
def test_nothing_is_had_for_an_answer_that_commits_to_nothing(question: str, answer: str) -> None:
    asked = [{"id": "f", "ask": "dof"}, {"id": "label", "ask": "label", "constraint": "c1"}]
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}
    sheet = load_assignment({"title": "One", "problems": [{"id": "p", "scene": scene, "questions": asked}]})
    result = dofkit.grade(sheet, {"student": "eve", "answers": {"p": {question: answer}}})
    assert (result.score, coursera.document(result, sheet)["fractionalScore"]) == (0, 0)


def test_a_line_of_json_holds_no_end_of_line(tmp_path: Path) -> None:
    graded(tmp_path, {"ada@x.json": json.dumps({"answers": {"p": {"f": "1\u2028{\u0085\u2029"}}})})
    text = (tmp_path / "out.jsonl").read_text(encoding="utf-8")
    assert len(text.splitlines()) == 1
    assert "\u2028" in json.loads(text)["items"][0]["answer"]


def test_a_notebook_only_writes_its_answers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    x = sp.Symbol("x")
    given = {"f": 1, "g": ..., "h": {"x", "y"}, "e": sp.Eq(x, 2), "n": np.int64(3), "m": sp.Matrix([x, 1])}
    path = hand_in({"p": given}, tmp_path / "answers.json", "ada@x")
    written = {"f": 1, "h": ["x", "y"], "e": "Eq(x, 2)", "n": 3, "m": [["x"], ["1"]]}
    assert json.loads(path.read_text()) == {"student": "ada@x", "answers": {"p": written}}
    assert "submit this file" in capsys.readouterr().out
