"""PrairieLearn's tables: submissions are read as it writes them, and points of a person go back as it takes them."""

from __future__ import annotations

import base64
import csv
import doctest
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from dofkit.homework.answers import prairielearn
from dofkit.homework.answers.sources import hand_ins
from dofkit.interface.cli import app

KNOWN = {"p.f": ("p", "f"), "p.eq": ("p", "eq")}
SHEET = """\
title: Circle
problems:
- id: p
  scene: {coordinates: [x, y], constraints: [{name: c, text: x^2 + y^2 = 1}]}
  questions:
  - {id: f, ask: dof, points: 1}
  - {id: eq, ask: equation, constraint: c, points: 3}
"""
#: The columns of both tables, as `instructorAssessmentDownloads.tsx` has them.
MANUAL = (
    "uid", "uin", "Zone number", "Zone title", "qid", "old_score_perc", "old_feedback", "old_auto_points",
    "old_manual_points", "submission_id", "params", "true_answer", "submitted_answer", "old_partial_scores",
    "partial_scores", "score_perc", "feedback",
)  # fmt: skip
FINAL = (
    "UID", "UIN", "Username", "Name", "Role", "Assessment", "Assessment instance", "Zone number", "Zone title",
    "Question", "Question instance", "Variant", "Seed", "Params", "True answer", "Options", "submission_id",
    "Submission date", "Submitted answer", "Partial Scores", "Score", "Question points", "Question % score",
)  # fmt: skip
RIGHT, MUMBLED = "x^2 + y^2 = 1", "x^2 + y^2 = 1 hopefully thats it"


def given(f: object = "1", eq: object = RIGHT, sign: str = ".", **more: Any) -> dict[str, Any]:
    return {f"p{sign}f": f, f"p{sign}eq": eq, **more}


def written(path: Path, columns: Sequence[str], *rows: Mapping[str, Any]) -> Path:
    """A table as PrairieLearn writes it: objects are JSON, what is null is blank."""
    with path.open("w", newline="") as stream:
        table = csv.DictWriter(stream, columns, lineterminator="\n")
        table.writeheader()
        for row in rows:
            table.writerow({k: json.dumps(v) if isinstance(v, dict) else v for k, v in row.items()})
    return path


def manual(path: Path, *rows: tuple[str, str, object, object]) -> Path:
    """Rows of (uid, submission, answers, what PrairieLearn gave), all to the question `circle`."""
    told = [
        {"uid": who, "uin": 7, "qid": "circle", "submission_id": n, "submitted_answer": a, "old_score_perc": old}
        for who, n, a, old in rows
    ]
    return written(path, MANUAL, *told)


def results(*arguments: object, status: int = 0) -> list[dict[str, Any]]:
    done = CliRunner().invoke(app, ["grade", *map(str, arguments), "--workers", "1"])
    assert done.exit_code == status, done.output
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    (tmp_path / "sheet.yaml").write_text(SHEET)
    return tmp_path / "sheet.yaml"


def test_documentation() -> None:
    outcome = doctest.testmod(prairielearn)
    assert (outcome.failed, outcome.attempted > 1) == (0, True)


def test_the_last_submission_of_everyone_is_read(tmp_path: Path) -> None:
    """Whatever the order; of other questions of the assessment nothing; a blank is no answer."""
    table = manual(
        tmp_path / "t.csv",
        ("ada@x", "12", given("2"), 0), ("ada@x", "9", given("3"), 0), ("bob@x", "10", given(None, "", "_"), ""),
    )  # fmt: skip
    with table.open("a") as stream:
        stream.write('ada@x,7,1,,other,100,,,,99,{},{},"{""ans"": ""p""}",,,,\n')
    handed = list(hand_ins([str(table)], KNOWN))
    assert [(h.name, h.place.line) for h in handed] == [("ada@x", 2), ("bob@x", 4)]
    submissions = [one for h in handed for one in h.submissions(KNOWN)]
    assert [s.answers for s in submissions] == [{"p": {"f": "2", "eq": RIGHT}}, {"p": {"eq": ""}}]
    assert all(s.error is None for s in submissions)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("answers.yaml", "p: {f: 1}"),
        ("hw.json", '{"student": "ada@x", "answers": {"p": {"f": 1}}}'),
        ("answers.csv", "p.f\n1\n"),
    ],
)
def test_files_are_read_from_the_table(name: str, text: str, tmp_path: Path) -> None:
    files = [
        {"name": name, "contents": base64.b64encode(text.encode()).decode()},
        {"name": "x.pdf", "contents": "JQ=="},
    ]
    row = {"UID": "ada@x", "Question": "circle", "submission_id": 5, "Submitted answer": {"_files": files}}
    (one,) = hand_ins([str(written(tmp_path / "t.csv", FINAL, row))], KNOWN)
    (submission,) = one.submissions(KNOWN)
    assert (submission.student, submission.error) == ("ada@x", None)
    assert str(submission.answers["p"]["f"]) == "1"


@pytest.mark.sweep
def test_files_of_the_archive_name_their_students(sheet: Path) -> None:
    folder = sheet.parent / "Homework1"
    folder.mkdir()
    for name in ("ada@x_7_circle_5_answers.yaml", "bob_b@x_1_circle_1_2_6_answers.yaml"):
        (folder / name).write_text("p: {f: 1}")
    assert [(one["student"], one["score"]) for one in results(sheet, folder)] == [("ada@x", 1.0), ("bob_b@x", 1.0)]


@pytest.mark.sweep
def test_a_file_that_names_another_student_takes_nobodys_place(sheet: Path) -> None:
    text = base64.b64encode(b"student: bob@x\np: {f: 2}").decode()
    table = manual(sheet.parent / "t.csv", ("ada@x", "1", {"_files": [{"name": "a.yaml", "contents": text}]}, 0),
                   ("bob@x", "2", given(), 0))  # fmt: skip
    ada, bob = results(sheet, table)
    assert (ada["student"], bob["student"], bob["score"], bob["doubt"]) == ("ada@x", "bob@x", 4.0, None)
    assert "it was submitted as ada@x's, but names 'bob@x'" in ada["doubt"]


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ((("ada@x", "1", {"ans": 1}, 0),), "no row answers a question of this assignment: inputs are named p.f"),
        ((("ada@x", "1", given(), 0), ("bob@x", "2", "{", 0)), "is not a JSON object"),
        ((("", "1", given(), 0),), "names neither a uid nor a group"),
    ],
)
def test_what_cannot_be_read_is_told(rows: Any, why: str, sheet: Path) -> None:
    *_, told = results(sheet, manual(sheet.parent / "t.csv", *rows), status=2)
    assert why in told["error"]


@pytest.mark.sweep
def test_points_of_a_person_come_back(sheet: Path) -> None:
    """Decided: 1 of 3 for the equation, so 2 of 4. A row for who gains by that, and for who had no points there."""
    folder = sheet.parent
    table = manual(
        folder / "cs_hw1_submissions_for_manual_grading.csv",
        ("ada@x", "12", given(eq=MUMBLED), ""), ("bob@x", "13", given(), 100), ("cy@x", "14", given("3", MUMBLED), 25),
        ("eve@x", "15", given(eq="x^2 + y^2 = ((1"), ""), ("zoe@x", "16", given(eq=MUMBLED), 75),
        ("di@x", "17", given("2"), 0), ("fay@x", "18", given("2", "x = 1"), 0),
        ("gus@x", "19", given("2", "x = 1"), ""), ("hal@x", "20", given("2"), 30),
    )  # fmt: skip
    results(sheet, table, "--out", folder / "out")
    review = folder / "out" / "review.csv"
    with review.open(encoding="utf-8-sig", newline="") as stream:
        rows = list(csv.DictReader(stream))
    mumbled = next(row for row in rows if row["students"] == "3")
    mumbled.update(points="1", remark="Say *that* only.", decided_by="Ng")
    with review.open("w", newline="") as stream:
        filled = csv.DictWriter(stream, list(rows[0]))
        filled.writeheader()
        filled.writerows(rows)
    scores = folder / "scores.csv"
    results(sheet, table, "--reviewed", review, "--format", "prairielearn", "--out", scores)
    written_rows = list(csv.DictReader(io.StringIO(scores.read_text(), newline="")))
    assert [tuple(row.values())[:4] for row in written_rows] == [
        ("ada@x", "circle", "12", "50.0000"), ("di@x", "circle", "17", "75.0000"), ("gus@x", "circle", "19", "0.0000"),
    ]  # fmt: skip
    assert written_rows[0]["feedback"].splitlines() == [
        "* **p.f**: 1 of 1.", "* **p.eq**: 1 of 3. Say \\*that\\* only.",
    ]  # fmt: skip
    with (folder / "scores.apart.csv").open(newline="") as stream:
        apart = {row["student"]: row["why"] for row in csv.DictReader(stream)}
    assert apart == {
        "cy@x": "PrairieLearn has 25 % already", "zoe@x": "PrairieLearn has 75 % already",
        "eve@x": "it is not final: 3 points are undecided",
    }  # fmt: skip


@pytest.mark.sweep
def test_of_two_questions_the_first_is_graded_and_gets_its_points(sheet: Path) -> None:
    table = manual(sheet.parent / "t.csv", ("ada@x", "12", given("2"), ""))
    with table.open("a") as stream:
        stream.write('ada@x,7,1,,other,,,,,99,{},{},"{""p.f"": ""1""}",,,,\n')
    out = sheet.parent / "scores.csv"
    results(sheet, table, "--format", "prairielearn", "--out", out, status=2)
    assert [line.split(",")[:4] for line in out.read_text().splitlines()][1] == ["ada@x", "circle", "12", "75.0000"]


@pytest.mark.sweep
def test_teams_and_rosters(sheet: Path) -> None:
    """A team is called by its name; what a roster calls somebody else is the same person to PrairieLearn."""
    folder = sheet.parent
    columns = ("group_name", "uid_list", *MANUAL[2:])
    row = {"group_name": "team 1", "qid": "circle", "submission_id": 4, "submitted_answer": given(eq=MUMBLED)}
    table = written(folder / "t.csv", columns, row)
    (one,) = results(sheet, table)
    assert (one["student"], one["needs_review"]) == ("team 1", 1)
    own = manual(folder / "u.csv", ("ada@x", "12", given(), ""))
    (folder / "roster.csv").write_text("name,email,userid\nAda,ada@y,3\n,ada@x,4\n")
    (told,) = results(sheet, own, "--roster", folder / "roster.csv")
    assert (told["student"], told["doubt"]) == ("ada@x", None)


@pytest.mark.sweep
def test_points_go_back_by_prairielearns_own_table_only(sheet: Path) -> None:
    (sheet.parent / "class.csv").write_text("student,p.f\nada,1\n")
    out = sheet.parent / "scores.csv"
    arguments = ["grade", str(sheet), str(sheet.parent / "class.csv"), "--format", "prairielearn", "--out", str(out)]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 2
    assert "in its own table" in done.output
