"""What waits for a person: shown as typed, queued once for all who gave it, decided in a table, and never lost."""

from __future__ import annotations

import ast
import csv
import io
import json
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from shared.command_line import called
from shared.sources import one_process, tree_at

import dofkit
from dofkit.homework.assignment import load_assignment
from dofkit.homework.formats.wording import stop_of
from dofkit.homework.result import Item
from dofkit.homework.review import Decision, ReviewError, answer_id, question_mark, read_table
from dofkit.homework.runs.run import fingerprint
from dofkit.homework.sentences import meanings

ROD = {
    "dimension": 2,
    "parameters": {"l": "positive"},
    "particles": ["A"],
    "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
}
QUESTIONS = [
    {"id": "f", "ask": "dof", "points": 2},
    {"id": "rod", "ask": "equation", "constraint": "rod", "points": 4},
    {"id": "q", "ask": "coordinates"},
]
SHEET: dict[str, Any] = {"title": "Sheet 1", "problems": [{"id": "p", "scene": ROD, "questions": QUESTIONS}]}
HOSTILE = ["<script>alert(1)</script>", "{{ 7*7 }}", '"quoted", (text', "a\x00b", "\u202edcba", "a; b | c", "\u200bzz"]
#: Two equations that nobody can read, in three writings, and one that can be.
UNREAD = "x_B^2 + y_A^2 = l^2"
CLASS = [
    ("ana", {"f": "1", "rod": "x_A^2 + y_A^2 = l^2"}),
    ("bo", {"f": "1", "rod": UNREAD}),
    ("cy", {"f": "2 or 3", "rod": f"  {UNREAD} "}),
    ("di", {"f": "3 = 2", "rod": "x_A^2 + y_A^2 = l^2 haha lol"}),
]


def item_of(question: str, answer: Any, **more: Any) -> Item:
    result = dofkit.grade({**SHEET, **more}, {"student": "s", "answers": {"p": {question: answer}}})
    return next(one for one in result.items if one.question == question)


class Course:
    """A sheet and a class in a folder, and what the command makes of them."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder, self.capsys = folder, capsys
        self.sheet, self.out = folder / "sheet.json", folder / "out"
        self.sheet.write_text(json.dumps(SHEET))
        self.hand_in(CLASS)

    def hand_in(self, given: Sequence[tuple[str, dict[str, str]]]) -> None:
        lines = [json.dumps({"student": name, "answers": {"p": answers}}) for name, answers in given]
        (self.folder / "class.jsonl").write_text("\n".join(lines))

    def grade(self, *more: str, out: str | None = None) -> tuple[int, str, str]:
        target = [] if out == "-" else ["--out", out or str(self.out)]
        given = ["grade", str(self.sheet), str(self.folder / "class.jsonl"), "--workers", "1", *target, *more]
        return called(self.capsys, *given)

    def results(self) -> dict[str, dict[str, Any]]:
        lines = (self.out / "results.jsonl").read_text().splitlines()
        return {one["student"]: one for one in map(json.loads, lines)}

    def table(self) -> list[dict[str, str]]:
        return rows_of((self.out / "review.csv").read_bytes())

    def fill(self, points: dict[str, str], **more: str) -> Path:
        """Points by text, written into the table, as a person does."""
        rows = self.table()
        for row in rows:
            if row["text"] in points:
                row.update(points=points[row["text"]], **more)
        (self.out / "review.csv").write_bytes(saved(rows, ",").encode("utf-8-sig"))
        return self.out / "review.csv"


@pytest.fixture
def course(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Course:
    return Course(tmp_path, capsys)


def rows_of(data: bytes, delimiter: str = ",") -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline=""), delimiter=delimiter))


def saved(rows: list[dict[str, str]], delimiter: str) -> str:
    stream = io.StringIO()
    writer = csv.DictWriter(stream, list(rows[0]), delimiter=delimiter, lineterminator="\r\n")
    writer.writeheader()
    writer.writerows(rows)
    return stream.getvalue()


# what is open


def test_what_cannot_be_read_is_open_unless_the_assignment_says_otherwise() -> None:
    given = {"student": "s", "answers": {"p": {"f": 1, "rod": UNREAD}}}
    result = dofkit.grade(SHEET, given)
    assert [(i.status, i.score) for i in result.items] == [("right", 2.0), ("unreadable", None), ("missing", 0.0)]
    assert (result.score, result.needs_review) == (2.0, 1)
    result = dofkit.grade({**SHEET, "unreadable": "zero"}, given)
    assert [(i.status, i.score) for i in result.items] == [("right", 2.0), ("unreadable", 0.0), ("missing", 0.0)]
    assert (result.score, result.needs_review) == (2.0, 0)


@pytest.mark.parametrize(
    ("question", "answer", "lines"),
    [
        ("rod", UNREAD, [UNREAD, "^"]),
        ("rod", "x_A = 1\nzzz_A = 2", ["zzz_A = 2", "^"]),
        ("q", "x_A, zz", ["x_A, zz", "     ^"]),
    ],
)
def test_a_caret_stands_where_reading_stopped(question: str, answer: Any, lines: list[str]) -> None:
    stop = stop_of(item_of(question, answer))
    assert stop is not None
    assert stop.lines() == lines


@pytest.mark.parametrize(
    ("scene", "constraint", "said"),
    [
        (ROD, "rod", "A correct answer is x_A^2 + y_A^2 - l^2 = 0."),
        ({"coordinates": ["x"], "constraints": [{"name": "c", "type": "equation", "text": "x = 2"}]}, "c", "x = 2."),
    ],
)
def test_full_feedback_shows_an_equation(scene: dict[str, Any], constraint: str, said: str) -> None:
    asked = {"id": "p", "scene": scene, "questions": [{"id": "q", "ask": "equation", "constraint": constraint}]}
    sheet = {"title": "t", "feedback": "full", "problems": [asked]}
    symbol = "x_A" if scene is ROD else "x"
    found = dofkit.grade(sheet, {"student": "s", "answers": {"p": {"q": f"{symbol} = 7"}}}).items[0]
    assert found.feedback.endswith(said)


def test_a_row_for_each_different_answer(course: Course) -> None:
    status, out, err = course.grade()
    assert (status, out) == (0, "")
    assert "4 different answers await review in" in err
    assert sorted(path.name for path in course.out.iterdir()) == ["results.jsonl", "review.csv", "review.html"]
    rows = course.table()
    assert [(r["problem"], r["question"], r["text"], r["students"], r["given_by"]) for r in rows] == [
        ("p", "f", "'2 or 3", "1", "cy"),
        ("p", "f", "'3 = 2", "1", "di"),
        ("p", "rod", UNREAD, "2", "bo; cy"),
        ("p", "rod", "x_A^2 + y_A^2 = l^2 haha lol", "1", "di"),
    ]
    assert rows[2]["why"] == "column 1: 'x_B' is not declared (the declared names are x_A, y_A, l)"
    assert rows[3]["max_points"] == "4"
    assert {(r["points"], r["remark"], r["decided_by"]) for r in rows} == {("", "", "")}


def test_identities_survive_spreadsheets() -> None:
    made = {answer_id("p", "f", text) for text in (*HOSTILE, *map(str, range(2000)))}
    assert len(made) == len({" ".join(text.split()) for text in HOSTILE}) + 2000
    assert all(re.fullmatch(r"q[0-9a-f]{8}-[0-9a-f]{16}", one) for one in made)
    assert {one.partition("-")[0] for one in made} == {question_mark("p", "f")}


FORMULAS = ["=1+1", "+1+1 zz", "-1 zz", "@SUM(A1)", "\t=1", "＝1+1", "|calc", "'=1", "1/2 zz", "1E5 zz", "0012 zz"]


def test_no_cell_begins_as_a_formula_does(course: Course) -> None:
    course.hand_in([(name or "?", {"rod": f"{name} (("}) for name in (*FORMULAS, *HOSTILE)])
    course.grade()
    data = (course.out / "review.csv").read_bytes()
    assert data.startswith(b"\xef\xbb\xbf")
    rows = rows_of(data)
    assert len(rows) == len({" ".join(name.split()) for name in (*FORMULAS, *HOSTILE)})
    for row in rows:
        assert not any(re.match(r"\s*[=+\-@|＝\t\r]", text) for text in row.values()), row
        assert row["text"][:1].isalpha() or row["text"][:1] == "'", row


# what a person decides


@pytest.mark.sweep
def test_what_a_person_decides_holds_for_all_and_for_later_ones(course: Course) -> None:
    course.grade()
    table = course.fill({UNREAD: "3", "'3 = 2": "0"}, remark="The particle is A.", decided_by="Dr. Ng")
    course.hand_in([*CLASS, ("later", {"rod": "x_B^2 +  y_A^2 = l^2\n", "f": "1"})])
    status, _, err = course.grade("--reviewed", str(table))
    assert status == 0
    assert "2 different answers await review" in err
    found = course.results()
    for name, score, review in (("bo", 5.0, 0), ("cy", 3.0, 1), ("later", 5.0, 0), ("ana", 6.0, 0)):
        assert (found[name]["score"], found[name]["needs_review"]) == (score, review)
    item = next(i for i in found["later"]["items"] if i["question"] == "rod")
    told = {key: item[key] for key in ("score", "status", "decided_by", "feedback", "answer")}
    assert told == {
        "score": 3.0, "status": "partly", "decided_by": "Dr. Ng", "feedback": "The particle is A.",
        "answer": "x_B^2 +  y_A^2 = l^2\n",
    }  # fmt: skip
    rows = course.table()
    assert [(r["text"], r["points"], r["students"]) for r in rows] == [
        ("'2 or 3", "", "1"), ("x_A^2 + y_A^2 = l^2 haha lol", "", "1"), ("'3 = 2", "0", "1"), (UNREAD, "3", "3"),
    ]  # fmt: skip
    assert rows[3]["remark"] == "The particle is A."


def test_points_that_the_page_saves_are_taken(course: Course) -> None:
    course.grade()
    rows = {row["text"]: row["id"] for row in course.table()}
    page = (course.out / "review.html").read_text()
    assert all(f'data-id="{one}"' in page for one in rows.values())
    saved = course.folder / "points.csv"
    saved.write_text(f'\ufeff"id","points","remark","decided_by"\r\n"{rows[UNREAD]}","3","so, so","Ng"\r\n')
    assert course.grade("--reviewed", str(saved))[0] == 0
    assert course.results()["bo"]["score"] == 5.0
    (row,) = (row for row in course.table() if row["points"])
    assert (row["text"], row["points"], row["remark"], row["decided_by"]) == (UNREAD, "3", "so, so", "Ng")


@pytest.mark.sweep
def test_the_function_takes_a_review_too(course: Course) -> None:
    course.grade()
    table = course.fill({UNREAD: "3"}, decided_by="Ng")
    given = {"student": "z", "answers": {"p": {"rod": UNREAD, "f": 1}}}
    for path in (table, str(table)):
        result = dofkit.grade(SHEET, given, reviewed=path)
        assert [(item.score, item.decided_by) for item in result.items] == [(2.0, None), (3.0, "Ng"), (0.0, None)]
    assert dofkit.grade(SHEET, given).needs_review == 1
    table.write_text("id,marks\n")
    with pytest.raises(ReviewError, match="there is no column 'points'"):
        dofkit.grade(SHEET, given, reviewed=table)


@pytest.mark.sweep
def test_decisions_stay_where_the_queue_is_written_again(course: Course) -> None:
    course.grade()
    course.fill({UNREAD: "3"}, remark="-> A, not B")
    course.grade()
    assert course.results()["bo"]["score"] == 5.0
    once = (course.out / "review.csv").read_bytes()
    course.grade()
    assert (course.out / "review.csv").read_bytes() == once
    course.hand_in(CLASS[:1])
    course.grade()
    (row,) = course.table()
    assert (row["text"], row["points"], row["remark"], row["students"]) == (UNREAD, "3", "'-> A, not B", "0")
    course.hand_in(CLASS)
    course.grade()
    assert course.results()["bo"]["score"] == 5.0
    item = next(i for i in course.results()["bo"]["items"] if i["question"] == "rod")
    assert item["feedback"] == "-> A, not B"


def test_a_decision_goes_before_what_dofkit_finds(course: Course) -> None:
    course.grade()
    rows = course.table()
    rows[0].update(id=answer_id("p", "rod", "x_A^2 + y_A^2 = l^2"), question="rod", points="1.5")
    (course.out / "review.csv").write_text(saved(rows, ","))
    course.grade()
    assert course.results()["ana"]["score"] == 3.5


def test_what_follows_from_a_decided_number_is_carried_still(tmp_path: Path) -> None:
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["dx = y dz", "y = 2 z"]}
    problem = {"id": "p", "scene": scene, "questions": [{"id": "k", "ask": "k"}, {"id": "f", "ask": "dof"}]}
    (tmp_path / "r.csv").write_text(f"id,points\n{answer_id('p', 'k', '1')},1\n")
    given = {"student": "s", "answers": {"p": {"k": "1", "f": "2"}}}
    result = dofkit.grade({"title": "t", "problems": [problem]}, given, reviewed=tmp_path / "r.csv")
    assert "CARRIED" in result.items[1].codes, result.items[1]


SAVED: dict[str, Callable[[list[dict[str, str]]], bytes]] = {
    "as it was written": lambda rows: saved(rows, ",").encode("utf-8-sig"),
    "by Excel in Germany": lambda rows: saved(rows, ";").encode("cp1252"),
    "as Unicode text": lambda rows: saved(rows, "\t").encode("utf-16"),
    "with sep=": lambda rows: ("sep=;\r\n" + saved(rows, ";")).encode("utf-8-sig"),
    "with empty rows and columns": lambda rows: re.sub(rb"\r\n", b";;\r\n", saved(rows, ";").encode()) + b";;;;\r\n",
    "columns in another order": lambda rows: saved([dict(reversed(row.items())) for row in rows], ",").encode(),
}


@pytest.mark.sweep
@pytest.mark.parametrize("way", list(SAVED))
def test_tables_are_read_as_spreadsheets_save_them(way: str, course: Course) -> None:
    course.grade()
    rows = course.table()
    rows[2].update(points="2,5", remark="für Ärger; zu spät")
    path = course.folder / "mine.csv"
    path.write_bytes(SAVED[way](rows))
    found = read_table(path, load_assignment(SHEET).most_points())
    decision = found.rows[rows[2]["id"]].decision
    assert decision is not None
    assert (decision.points, decision.remark, decision.by) == (Fraction(5, 2), "für Ärger; zu spät", "review")
    assert sum(row.decision is not None for row in found.rows.values()) == 1


def test_all_faults_of_a_table_are_told_at_once(course: Course) -> None:
    course.grade()
    rows = course.table()
    rows[0].update(points="two")
    rows[1].update(points="2.5")
    rows[2].update(points="-1")
    rows.append({**rows[3], "points": "1", "remark": "so"})
    rows.append({**rows[3], "points": "2"})
    rows.append({**rows[3], "id": "x" + rows[3]["id"], "points": "1"})
    rows.append({**rows[3], "id": "", "points": "1"})
    before = saved(rows, ",").encode()
    (course.out / "review.csv").write_bytes(before)
    status, out, err = course.grade()
    assert (status, out) == (2, "")
    told = [line for line in err.splitlines() if ": error: " in line]
    places = [line.partition(": error: ")[0].removeprefix(f"{course.out / 'review.csv'}:") for line in told]
    assert places == ["2:12", "3:12", "4:12", "7:12", "8:1", "9:1"]
    assert "'two' is not a number of points" in told[0]
    assert "2.5 points are out of range" in told[1]
    assert "write 0 to 2, or nothing" in err
    assert "decided differently in another row" in told[3]
    assert (course.out / "review.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n1,2\n", "there is no column 'id'"),
        ("id,Pionts\n", "is it 'pionts'?"),
        ("id,points,points\n", "the column 'points' is there twice"),
        (f"id,points\n{answer_id('p', 'other', '1')},1\n", "is not the id of an answer to this assignment"),
        (f"id,points\n{question_mark('p', 'f')}-1e5,1\n", "-1e5' is not the id of an answer to this assignment"),
    ],
)
def test_a_table_that_is_none(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text)
    with pytest.raises(ReviewError) as caught:
        read_table(path, load_assignment(SHEET).most_points())
    told = " ".join(f"{fault.message} {fault.hint}" for fault in caught.value.faults)
    assert said in told
    assert all(fault.line and fault.column for fault in caught.value.faults)


def test_a_row_of_a_question_that_is_gone_stays_and_decides_nothing(course: Course) -> None:
    course.grade()
    gone = {**course.table()[0], "id": answer_id("p", "gone", "1"), "points": "99"}
    (course.out / "review.csv").write_text(saved([*course.table(), gone], ","))
    assert course.grade()[0] != 2
    assert [row["id"] for row in course.table() if row["points"] == "99"] == [gone["id"]]


# in every format, and with everything else


def test_an_interrupted_run_does_not_go_on_with_other_decisions() -> None:
    plain = load_assignment(SHEET)
    made = [replace(plain, decisions={"a": Decision(Fraction(points), "so")}) for points in (1, 2, 2)]
    marks = [fingerprint(one, False) for one in (plain, *made)]
    assert len(set(marks)) == 3
    assert marks[2] == marks[3]


@pytest.mark.sweep
def test_the_pages_show_answers_as_typed_and_no_codes(course: Course) -> None:
    course.hand_in([(f"s{i}", {"rod": UNREAD if i < 8 else "x_A = 1", "f": "7"}) for i in range(15)])
    course.grade("--format", "html")
    index, student = (course.out / "index.html").read_text(), (course.out / "students" / "s1.html").read_text()
    assert index.index("To review") < index.index("<h2>Points</h2>")
    assert '<span class="stop">x<sub>^</sub></span><span class="rest">_B^2 + y_A^2 = l^2</span>' in student
    assert "<code>x_B</code> is not declared" in student
    other = (course.out / "students" / "s9.html").read_text()
    assert "`" not in student + other
    assert not [code for code in meanings() if re.search(rf"\b{code}\b", student + other)]
    page = (course.out / "review.html").read_text()
    assert course.table()[0]["id"] in page
    assert "8 students" in page


@one_process
def test_every_code_has_a_text() -> None:
    room = Path(dofkit.homework.__file__ or "").parent
    codes: set[str] = set()
    for path in [*(room / "questions").glob("*.py"), *(room / "key").glob("*.py")]:
        tree = tree_at(path)
        texts = {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)}
        codes |= {text for text in texts if re.fullmatch(r"[A-Z][A-Z0-9]+(_[A-Z0-9]+)+", text)}
    assert len(codes) > 20
    assert codes - set(meanings()) == set()
    assert all(told.strip() for told in meanings().values())
