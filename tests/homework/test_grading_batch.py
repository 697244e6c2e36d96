"""Grading in bulk: what is handed in is told apart, nobody is lost, nothing that one hands in touches another."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from shared.command_line import called
from shared.grading_jobs import orders
from shared.homework_cases import FILES, document
from shared.known_scenes import swept
from shared.late import LONG

import dofkit
from dofkit.base.runs import Pool, in_order
from dofkit.homework.answers.sources import Handed, hand_ins
from dofkit.homework.answers.submission import FilePlace, of_value
from dofkit.homework.grading import Grader
from dofkit.homework.runs.batch import Keeper
from dofkit.homework.runs.run import unfinished
from dofkit.interface import cli
from dofkit.interface.output import INTERRUPTED
from dofkit.methods.classify import classify

POINT = {"coordinates": ["x", "y"], "constraints": [{"name": "circle", "type": "equation", "text": "x^2 + y^2 = 1"}]}
QUESTIONS = [
    {"id": "f", "ask": "dof", "points": 2},
    {"id": "label", "ask": "label", "constraint": "circle"},
    {"id": "eq", "ask": "equation", "constraint": "circle"},
]
ASSIGNMENT = {"title": "A circle", "problems": [{"id": "p", "scene": POINT, "questions": QUESTIONS}]}
KNOWN = {"p.f": ("p", "f"), "p.q.a": ("p.q", "a")}


@pytest.fixture
def assignment(tmp_path: Path) -> str:
    path = tmp_path / "assignment.json"
    path.write_text(json.dumps(ASSIGNMENT))
    return str(path)


def lines_of(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, list[dict[str, Any]], str]:
    """Exit status, the objects on standard output, standard error."""
    status, out, err = called(capsys, *arguments)
    return status, [json.loads(line) for line in out.splitlines()], err


def read(path: Path, data: str | bytes) -> list[tuple[str, Any]]:
    """Every submission in a file: its student with its answers, or with its error."""
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    found = [h.submission(KNOWN) for h in hand_ins([str(path)], KNOWN)]
    return [(s.student, s.error.removeprefix(f"{path}") if s.error else dict(s.answers)) for s in found]


TABLES: dict[str, tuple[str | bytes, Any]] = {
    "plain": ("student,p.f,p.q.a\nana,1,x\n", [("ana", {"p": {"f": "1"}, "p.q": {"a": "x"}})]),
    "zeros of a number stay": ("student,p.f\n007,1\n", [("007", {"p": {"f": "1"}})]),
    "semicolons": ("student;p.f\r\nana;3,5\r\n", [("ana", {"p": {"f": "3,5"}})]),
    "sep=": ("sep=|\nstudent|p.f\nana|1\n", [("ana", {"p": {"f": "1"}})]),
    "byte order mark": (b"\xef\xbb\xbfstudent,p.f\nana,1\n", [("ana", {"p": {"f": "1"}})]),
    "UTF-16": ("student\tp.f\r\nana\t1\r\n".encode("utf-16"), [("ana", {"p": {"f": "1"}})]),
    "old Macintosh": ("student,p.f\rana,1\rbo,2\r", [("ana", {"p": {"f": "1"}}), ("bo", {"p": {"f": "2"}})]),
    "quotes": ('student,p.f\nana,"a, ""b""\nc"\n', [("ana", {"p": {"f": 'a, "b"\nc'}})]),
    "empty cells and rows": ("student,p.f,p.g\n\nana,,2\n,,\n", [("ana", {"p": {"g": "2"}})]),
    "cells beyond the header": (
        "student,p.f\nana,1,,\nbo,1,2\n",
        [("ana", {"p": {"f": "1"}}), ("bo", ", line 3: the row has 3 cells, the header 2")],
    ),
    "ragged": (
        "student,p.f,p.g\nana,1\nbo,1,2\n",
        [("ana", ", line 2: the row has 2 cells, the header 3"), ("bo", {"p": {"f": "1", "g": "2"}})],
    ),
    "an open quote loses nobody": (
        'student,p.f\nana,"1\nbo,2\ncy,3\n',
        [("ana", ", line 2: a quotation mark is never closed"), ("bo", {"p": {"f": "2"}}), ("cy", {"p": {"f": "3"}})],
    ),
    "two open quotes": (
        'student,p.f\nana,"1\nbo,"2\ncy,3\n',
        [
            ("ana", ", line 2: a quote stands inside a cell"),
            ("bo", ", line 3: a quotation mark is never closed"),
            ("cy", {"p": {"f": "3"}}),
        ],
    ),
    "one row is not in UTF-8": (
        b"student,p.f\nan\xe9,1\nbo,2\n",
        [("an\ufffd", ", line 2: the row is not in UTF-8 (save the table as UTF-8)"), ("bo", {"p": {"f": "2"}})],
    ),
    "a header with a column twice": (
        "student,p.f,p.f\nana,1,2\nbo,1,2\n",
        [(name, f", line {n}: the header (line 1) has the column 'p.f' twice") for n, name in ((2, "ana"), (3, "bo"))],
    ),
    "two students": (
        "student,p.f,Student\nana,1,bo\n",
        [("ana", ", line 2: the header (line 1) has the column 'Student' twice")],
    ),
    "no name": ("student,p.f\n,1\n", [("", ", line 2: the row has no student")]),
    "unknown columns": ("student,p.f,email\nana,1,a@b\n", [("ana", {"p": {"f": "1"}, "email": {"": "a@b"}})]),
    "no question": (
        "student,p1\nana,1\nbo,2\n",
        [
            (n, f", line {i}: the header (line 1) names no question: write p.f, p.q.a")
            for i, n in ((2, "ana"), (3, "bo"))
        ],
    ),
    "nearly a question": (
        "student,p.g\nana,1\n",
        [("ana", ", line 2: the header (line 1) names no question: write 'p.f' for 'p.g'")],
    ),
    "nothing but students": (
        "student\nana\n",
        [("ana", ", line 2: the header (line 1) names no question: write p.f, p.q.a")],
    ),
    "one person's": ("p.f;p.q.a\n1;x\n", [("t", {"p": {"f": "1"}, "p.q": {"a": "x"}})]),
    "one person's of two": (
        "p.f\n1\n2\n",
        [("t", ", line 1: its header has no column 'student' but p.f")],
    ),
    "another name for the student": ("name,p.f\nana,1\n", [("ana", {"p": {"f": "1"}})]),
    "no student": ("who,p.f\nana,1\n", [("t", ", line 1: its header has no column 'student' but who, p.f")]),
    "a form": (
        "Timestamp,Email Address,p.f How many?\n1/2/2026,ana@x,1\n",
        [("ana@x", {"p": {"f": "1"}})],
    ),
    "empty": ("", [("t", ", line 1: it is empty")]),
}


@pytest.mark.parametrize("case", list(TABLES))
def test_tables(case: str, tmp_path: Path) -> None:
    data, expected = TABLES[case]
    assert read(tmp_path / "t.csv", data) == expected


SHAPE = "(write 'student: NAME' and 'answers: {PROBLEM: {QUESTION: answer}}')"
DOCUMENTS = {
    "student: 007\nanswers: {p: {f: 4.0, g: [x, y]}}": [("007", {"p": {"f": 4, "g": ("x", "y")}})],
    "answers: {p: {f: 1}}": [("s", {"p": {"f": 1}})],
    "student: ana\nanswers:\n": [("ana", {})],
    '{"student": "ana", "answers": {"p": {"f": 1e999999999, "g": 2}}}': [
        ("s", ", line 1, column 43: the number 1e999999999 is too large or too small (stay within 1e±1000)")
    ],
    "- {student: ana, answers: {}}\n- {student: bo, answers: 3}": [
        ("s", f": a submission is a mapping with 'student' and 'answers' {SHAPE}")
    ],
    "student: ana\nanswers:\n  p: 3": [
        ("ana", ", line 3, column 6: the answers to problem 'p' are a mapping of questions to answers")
    ],
    "student: ana\nanswer: {}": [
        ("ana", ", line 2, column 1: unknown key 'answer': there are 'student' and 'answers'")
    ],
    "student: [ana]\nanswers: {}": [("s", ", line 1, column 10: 'student' is a name or a number")],
    "student: ana\nanswers: {p: {f: 1, f: 2}}": [
        ("s", ", line 2, column 21: the key 'f' is written twice (keep one of the two)")
    ],
    '{"student": "ana", "answers': [("s", ", line 1, column 20: a quoted text is never closed (close the quotes)")],
    "p: {f: 1}\nstudent: ana": [("ana", {"p": {"f": 1}})],
    "p.q.a: x\np.f: 1": [("s", {"p.q": {"a": "x"}, "p": {"f": 1}})],
    "p: {f: 1}\nzz: {f: 2}": [("s", {"p": {"f": 1}, "zz": {"f": 2}})],
    "answers: {p.f: 1, p: {g: 2}}": [("s", {"p": {"f": 1, "g": 2}})],
    "p: {f: 1}\nname: ana": [("s", ", line 1, column 1: unknown key 'p': there are 'student' and 'answers'")],
    "": [("s", f", line 1, column 1: the file is empty {SHAPE}")],
    "3": [("s", f": a submission is a mapping with 'student' and 'answers' {SHAPE}")],
}


@pytest.mark.parametrize("text", list(DOCUMENTS))
def test_documents(text: str, tmp_path: Path) -> None:
    assert read(tmp_path / "s.yaml", text) == DOCUMENTS[text]


def test_lines_of_json(tmp_path: Path) -> None:
    told = read(tmp_path / "s.jsonl", '{"student": "a", "answers": {}}\n\n{"student": "b"\n\xff\n{"answers": {}}')
    assert [name for name, _ in told] == ["a", "s:3", "s:4", "s:5"]
    assert told[1][1].startswith(", line 3, column 16: ")
    assert told[2][1].startswith(", line 4")


def test_a_folder_is_read_in_order_and_nobody_in_it_is_lost(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "two.yaml").write_text("answers: {p: {f: 2}}")
    (tmp_path / "c.csv").write_text("student,p.f\nthree,3\n")
    (tmp_path / "a.json").write_text('{"student": "one", "answers": {}}')
    (tmp_path / "d.pdf").write_bytes(b"%PDF")
    (tmp_path / "e.yaml").symlink_to("/etc/hostname")
    (tmp_path / ".DS_Store").write_text("")
    found = [h.submission(KNOWN) for h in hand_ins([str(tmp_path), str(tmp_path / "no.csv")], KNOWN)]
    assert [(s.student, s.error is None) for s in found] == [
        ("one", True), ("two", True), ("three", True), ("d", False), ("e", False), ("no", False),
    ]  # fmt: skip


def test_a_file_called_answers_is_its_folders(tmp_path: Path) -> None:
    for folder in ("Ada Lovelace_12_assignsubmission_file_", "bob"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "Answers.yaml").write_text("p: {f: 2}")
    for stem in ("Eve_9_assignsubmission_file_hw", "sheet_1_2_ada", "sheet_1_2_bob"):
        (tmp_path / f"{stem}.yaml").write_text("p: {f: 2}")
    handed = list(hand_ins([str(tmp_path)], KNOWN))
    assert [(h.name, h.claims) for h in handed] == [
        ("Ada Lovelace_12", ("Answers", "Ada Lovelace_12_assignsubmission_file_")),
        ("Eve_9", ("Eve_9_assignsubmission_file_hw",)),
        ("bob", ("Answers", "bob")),
        ("sheet_1_2_ada", ("sheet_1_2_ada",)),
        ("sheet_1_2_bob", ("sheet_1_2_bob",)),
    ]
    (direct,) = hand_ins([str(tmp_path / "bob" / "Answers.yaml")], KNOWN)
    assert (direct.name, direct.claims) == ("bob", ("Answers", "bob"))


# the command


def test_a_result_for_everyone_in_order(assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "t.csv"
    table.write_text("student,p.f,p.label,p.eq,p.zz\nana,1,,x^2 = 1 - y^2,\nbo,2,((,,5\nana,1,,,\ncy,1\n")
    status, told, err = lines_of(capsys, "grade", assignment, str(table), "--workers", "1")
    assert (status, err) == (2, "1 submission with a 'doubt', which a person has to settle\n")
    assert [line["student"] for line in told] == ["ana", "bo", "ana", "cy"]
    assert [line["score"] for line in told] == [3.0, 0.0, None, None]
    assert {line["max_score"] for line in told} == {4.0}
    assert [item["status"] for item in told[0]["items"]] == ["right", "missing", "right"]
    assert [item["status"] for item in told[1]["items"]] == ["wrong", "unreadable", "missing", "unreadable"]
    assert "There is no question 'zz'" in told[1]["items"][3]["feedback"]
    second = f"{table}, line 4: 'ana' also submitted {table}, line 2: only that submission is graded"
    assert (told[2]["error"], told[2]["items"], told[0]["error"]) == (second, [], None)
    first = f"{table}, line 2: 'ana' also submitted {table}, line 4: a person has to decide which counts"
    assert told[0]["doubt"] == first
    assert told[3]["error"] == f"{table}, line 5: the row has 2 cells, the header 5"


@pytest.mark.sweep
def test_a_roster_says_whose_a_submission_is(
    assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, roster = tmp_path / "in", tmp_path / "roster.csv"
    folder.mkdir()
    roster.write_text("name,email\nAda Lovelace,ada@x\nBob,bob@x\nEve,eve@x\n")
    for name, student in (("bob", "Ada Lovelace"), ("eve@x", "EVE"), ("Ada Lovelace", "ada@x"), ("zoe", "zoe")):
        (folder / f"{name}.yaml").write_text(f"student: {student}\np: {{f: 1}}")
    command = ("grade", assignment, str(folder), "--workers", "1", "--roster", str(roster))
    status, told, _ = lines_of(capsys, *command)
    assert [(line["student"], line["doubt"] is None, line["score"]) for line in told] == [
        ("ada@x", True, 2.0), ("bob@x", False, 2.0), ("eve@x", True, 2.0), ("zoe", True, 2.0),
    ]  # fmt: skip
    assert status == 0
    assert "bob.yaml: it was submitted as bob@x's, but names 'Ada Lovelace'" in told[1]["doubt"]
    out = tmp_path / "grades.csv"
    assert lines_of(capsys, *command, "--format", "moodle", "--out", str(out))[0] == 0
    table = [line.split(",")[:2] for line in out.read_text().splitlines()]
    assert [row for row in table if "@" in row[0] or row[0].startswith("user")] == [
        ["useremail", "A circle"], ["ada@x", "2"], ["eve@x", "2"],
    ]  # fmt: skip
    assert [line.split(",")[0] for line in (tmp_path / "grades.apart.csv").read_text().splitlines()] == [
        "student", "bob@x", "zoe",
    ]  # fmt: skip


@pytest.mark.sweep
def test_results_within_the_folder_are_no_submissions(
    assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "z.csv").write_text("student,p.f\nana,1\n")
    for form, out in (("native", "a.jsonl"), ("native", "a.jsonl"), ("html", "b"), ("html", "b")):
        assert lines_of(capsys, "grade", assignment, str(tmp_path), "--format", form, "--out", str(tmp_path / out)) == (
            (0, [], "") if form == "native" else (2, [], "")
        )
    assert length(tmp_path / "a.jsonl") == 1


@pytest.mark.parametrize(
    ("form", "out", "said"),
    [
        ("native", "g.csv", "the endings are .jsonl"),
        ("native", "g.html", "the endings are .jsonl"),
        ("canvas", "g.json", "the endings are .csv"),
        ("moodle", "grades", "has no ending: name a file that ends in .csv"),
        ("html", "g.html", "give a name without an ending"),
    ],
)
def test_an_ending_that_does_not_fit_is_an_error(
    form: str, out: str, said: str, assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "z.csv").write_text("student,p.f\nana,1\n")
    table, target = str(tmp_path / "z.csv"), tmp_path / out
    status, _, err = lines_of(capsys, "grade", assignment, table, "--format", form, "--out", str(target))
    assert (status, target.exists()) == (2, False)
    assert said in err


def test_nothing_that_is_read_is_overwritten(
    assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = tmp_path / "answers.jsonl"
    lines.write_text('{"student": "ana", "answers": {"p": {"f": 1}}}\n')
    status, _, err = lines_of(capsys, "grade", assignment, str(lines), "--out", str(lines))
    assert (status, "ana" in lines.read_text()) == (2, True)
    assert "--out would overwrite" in err


def test_one_submission_is_graded_in_python(tmp_path: Path) -> None:
    prepared, table = dofkit.load_assignment(ASSIGNMENT), tmp_path / "t.csv"
    table.write_text("student;p.f\nana;1\n")
    assert dofkit.grade(prepared, table).score == 2.0
    table.write_text("student;p.f\nana;1\nbo;1\n")
    assert "more than one" in str(dofkit.grade(prepared, table).error)
    assert "no such file" in str(dofkit.grade(prepared, tmp_path / "no.yaml").error)
    assert dofkit.grade(ASSIGNMENT, {"student": 7}).error == "'answers' is a mapping of problems to mappings of " + (
        "questions to answers"
    )


def test_answers_to_what_was_not_asked_are_bounded() -> None:
    odd = {"p" * 10**6: {"q": 1}, "p": {f"{i}q": 1 for i in range(10**5)}}
    result = dofkit.grade(ASSIGNMENT, {"student": "ana", "answers": odd})
    assert len(result.items) == 3 + 100
    assert len(result.model_dump_json()) < 50_000


@pytest.mark.sweep
def test_check_only_tells_how_answers_are_read(
    assignment: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "s.json"
    answers = {"p": {"f": "f = 3 - 1 = 2", "label": "no holonomic", "eq": "y = (("}}
    path.write_text(json.dumps({"student": "ana", "answers": answers}))
    status, (told,), _ = lines_of(capsys, "grade", assignment, str(path), "--check-only", "--workers", "1")
    read = {item["question"]: (item["status"], item["read_as"]) for item in told["items"]}
    assert (status, read["f"], read["eq"]) == (0, ("read", "2"), ("unreadable", ""))
    assert read["label"] == ("read", "non-holonomic")
    assert told["score"] is None


@pytest.mark.parametrize(
    "more",
    [
        ["--format", "word"],
        ["--check-only", "--format", "html"],
        pytest.param(["--scheduler", "tcp://127.0.0.1:1"], marks=pytest.mark.sweep),
    ],
)
def test_options_that_cannot_be_are_told(more: list[str], assignment: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, told, err = lines_of(capsys, "grade", assignment, assignment, *more)
    assert (status, told) == (2, [])
    assert "error:" in err


# isolation


def hostile(*answers: Mapping[str, str]) -> list[Handed]:
    made = enumerate(answers)
    return [Handed("", FilePlace("t", i), {"student": f"s{i}", "answers": {"p": given}}) for i, given in made]


def statuses(given: Sequence[Handed], workers: int) -> Iterator[tuple[str, list[str], list[str]]]:
    with Pool(workers) as pool:
        for _, line in in_order(pool, Keeper(orders(), pool).grade, given):
            result = json.loads(line)
            items = result["items"]
            yield result["student"], [item["status"] for item in items], [item["feedback"] for item in items]


@pytest.mark.sweep
def test_an_answer_that_breaks_its_worker_needs_a_review_and_touches_no_other() -> None:
    fine = {"a": "1", "b": "2"}
    given = hostile(
        fine, {"a": "hang", "b": "2"}, {"a": "1", "b": "die"}, {"a": "fail", "b": "eat"}, fine, {"a": "hang"}
    )
    told = list(statuses(given, 1))
    assert [name for name, _, _ in told] == [f"s{i}" for i in range(6)]
    assert [found for _, found, _ in told] == [
        ["right", "right"],
        ["needs_review", "right"],
        ["right", "needs_review"],
        ["needs_review", "needs_review"],
        ["right", "right"],
        ["needs_review", "missing"],
    ]
    review = "A person will review this answer: "
    assert told[3][2] == [
        f"{review}an internal error occurred (ValueError).",
        f"{review}grading it took too long or too much memory.",
    ]
    assert told[1][2][0] == told[5][2][0]


# order, and going on


def rows(number: int) -> str:
    """A table of so many students."""
    made = (f"s{i},{i % 97},{'rheonomic' if i % 3 else 'holonomic scleronomic'}" for i in range(number))
    return "student,p.f,p.label\n" + "\n".join(made) + "\n"


@pytest.mark.sweep
def test_results_are_the_same_with_any_number_of_workers_and_in_any_order(
    assignment: str, tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    table, back = tmp_path / "t.csv", tmp_path / "b.csv"
    head, *lines = rows(300).splitlines(keepends=True)
    table.write_text(head + "".join(lines))
    back.write_text(head + "".join(reversed(lines)))

    def graded(path: Path, workers: int) -> list[bytes]:
        cli.app(["grade", assignment, str(path), "--workers", str(workers)], standalone_mode=False)
        return capfdbinary.readouterr().out.splitlines()

    once = graded(table, 1)
    assert len(once) == 300
    assert once == graded(table, 2) == graded(back, 2)[::-1]


#: The command line, which stops before it writes the results of so many submissions, says so, and waits for a signal.
WAITING = """
import signal, sys
from dofkit.base.runs import Journal
from dofkit.interface import entry
from dofkit.methods.classify import classify
real, left = Journal.write, int(sys.argv.pop(1))
def write(journal, key, result):
    global left
    left -= 1
    while left == 0:
        print("here", flush=True)
        signal.pause()
    real(journal, key, result)
Journal.write = write
signal.signal(signal.SIGINT, signal.default_int_handler)
entry.main()
"""


def started(
    assignment: str, table: Path, out: Path, stderr: int = subprocess.PIPE, until: int = 0
) -> subprocess.Popen[bytes]:
    """A run; with ``until`` one that waits there for a signal."""
    begun = ["-c", WAITING, str(until)] if until else ["-m", "dofkit"]
    command = [sys.executable, *begun, "grade", assignment, str(table), "--out", str(out)]
    path = os.pathsep.join(place for place in sys.path if place)
    return subprocess.Popen(command, env={**os.environ, "PYTHONPATH": path}, stdout=subprocess.PIPE, stderr=stderr)


def length(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


@pytest.mark.sweep
def test_a_run_interrupted_twice_ends_as_one_that_was_not(assignment: str, tmp_path: Path) -> None:
    table, out, whole = tmp_path / "t.csv", tmp_path / "out.jsonl", tmp_path / "whole.jsonl"
    table.write_text(rows(1000))
    journal = unfinished(out)
    for number, status, reached in ((signal.SIGKILL, -signal.SIGKILL, 300), (signal.SIGINT, INTERRUPTED, 600)):
        with started(assignment, table, out, until=reached + 1) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == b"here\n"
            process.send_signal(number)
            said = process.communicate(timeout=LONG)[1]
        assert (said, process.returncode, out.exists()) == (b"", status, False)
    with closing(sqlite3.connect(journal)) as results, results:
        assert results.execute("SELECT count(*) FROM results").fetchone() == (600,)
        results.execute("UPDATE results SET result = replace(result, 's599', 'kept')")
    for path in (out, whole):
        with started(assignment, table, path) as process:
            assert (process.communicate(timeout=LONG), process.returncode) == ((b"", b""), 0)
    assert b"kept" in out.read_bytes()
    assert out.read_bytes().replace(b"kept", b"s599") == whole.read_bytes()
    assert length(out) == 1000
    assert sorted(path.name for path in tmp_path.iterdir()) == ["assignment.json", "out.jsonl", "t.csv", "whole.jsonl"]


@pytest.mark.parametrize("seconds", [swept(0.002), 0.008])
@pytest.mark.parametrize("name", FILES)
def test_too_little_time_needs_a_review_and_makes_nothing_wrong(name: str, seconds: float) -> None:
    made = document(name)
    here = Grader(dofkit.load_assignment(made["assignment"]), seconds)
    for place, answer, status, *_ in made["answers"]:
        problem, question = place.split(".")
        result = here.grade(of_value({"student": "s", "answers": {problem: {question: answer}}}, "s"))
        found = next(item.status for item in result.items if (item.problem, item.question) == (problem, question))
        assert found in (status, "needs_review"), answer


def _breaks(*_: object, **__: object) -> Any:
    raise KeyError("x")


def test_a_scene_on_which_dofkit_fails_costs_nobody_the_other_problems(monkeypatch: pytest.MonkeyPatch) -> None:
    def classified(scene: Any) -> Any:
        return _breaks() if scene.name == "broken" else classify(scene)

    monkeypatch.setattr("dofkit.homework.key.key.strict_report", classified)
    made = [{"id": one, "scene": {**POINT, "name": one}, "questions": QUESTIONS} for one in ("broken", "whole")]
    for feedback in ("hint", "full"):
        prepared = dofkit.load_assignment({"title": "One", "feedback": feedback, "problems": made})
        answers = {"f": "1", "label": "rheonomic", "eq": "x^2 + y^2 = 1"}
        result = dofkit.grade(prepared, {"student": "Ana", "answers": {"broken": answers, "whole": answers}})
        assert [item.status for item in result.items] == [
            "needs_review",
            "needs_review",
            *["right"] * 2,
            "wrong",
            "right",
        ]
        assert result.items[0].feedback.endswith("(KeyError).")
