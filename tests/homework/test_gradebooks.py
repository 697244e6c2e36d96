"""Tables for gradebooks: every cell by hand, no grade wiped, no row of another, none of anybody outside the course."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import pytest

from dofkit.homework.answers.roster import Participant, Roster, RosterError, attributed, doubt_of_platform, load_roster
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats import FORMATS, FormatError
from dofkit.homework.formats.gradebooks import apart_path
from dofkit.homework.formats.wording import standing
from dofkit.homework.result import Item, Result

LINE = {"coordinates": ["x", "y"], "constraints": [{"name": "c", "text": "x = y"}]}
QUESTIONS = [{"id": "f", "ask": "dof", "points": 2}, {"id": "eq", "ask": "equation", "constraint": "c", "points": 8}]
CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Sheet 1 (4711),Final Score
    Points Possible,,,,,10,
"Lovelace, Ada",101,S1,ada,M1,,
"Hopper, Grace",102,S2,grace,M1,,
"Points Possible, Eve",103,S3,eve,M2,,
"""
MOODLE = """\
First name;Last name;ID number;Email address
Ada;Lovelace;S1;ada@uni.example
Grace;Hopper;;grace@uni.example
"""


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return load_assignment({"title": "Sheet 1", "problems": [{"id": "p", "scene": LINE, "questions": QUESTIONS}]})


def result(student: str, score: float = 2.0, open_points: float = 0.0, **more: Any) -> Result:
    items = [
        Item(problem="p", question="f", score=score, max_score=2.0, status="right", codes=[], read_as="1", feedback="")
    ]
    if open_points:
        waits = {"status": "needs_review", "codes": [], "read_as": "", "feedback": "", "score": None}
        items.append(Item.model_validate({"problem": "p", "question": "eq", "max_score": open_points, **waits}))
    fields = {"needs_review": int(open_points > 0), **more}
    return Result(student=student, score=score, max_score=10.0, items=items, **fields)


def roster(text: str, folder: Path) -> Roster:
    (folder / "roster.csv").write_text(text)
    return load_roster(folder / "roster.csv")


def tables(name: str, prepared: Prepared, folder: Path, *results: Result, known: Roster | None = None) -> Any:
    """The rows of the table, and those of the one beside it."""
    out = folder / "grades.csv"
    FORMATS[name].write(results, prepared, out, known)
    apart = apart_path(out)
    return [list(csv.reader(io.StringIO(path.read_text(encoding="utf-8"), newline=""))) if path.exists() else []
            for path in (out, apart)]  # fmt: skip


REFUSED = Result(student="ada", score=None, max_score=10.0, items=[], error="line 3: <b>no</b> JSON")
HEADER = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Sheet 1"]


def test_canvas_without_a_roster(prepared: Prepared, tmp_path: Path) -> None:
    found, apart = tables("canvas", prepared, tmp_path, result("ada"), result("bob", open_points=8), REFUSED)
    assert found == [HEADER, ["Points Possible", "", "", "", "", "10"], ["ada", "", "", "ada", "", "2"]]
    assert apart == [
        ["student", "points so far", "of", "open points", "why"],
        ["bob", "2", "10", "8", "it is not final: 8 points are undecided"],
        ["ada", "", "10", "0", "it could not be graded: line 3: <b>no</b> JSON"],
    ]


def test_canvas_by_its_own_gradebook(prepared: Prepared, tmp_path: Path) -> None:
    known = roster(CANVAS, tmp_path)
    assert [member.student for member in known.members] == ["S1", "S2", "S3"]
    given = [result("ada"), result("Grace Hopper", 1.0), result("103", 0.0), result("mallory"), result("S1", 1.5)]
    found, apart = tables("canvas", prepared, tmp_path, *given, known=known)
    assert found == [
        [*HEADER[:5], "Sheet 1 (4711)"],
        ["Points Possible", "", "", "", "", "10"],
        ["Lovelace, Ada", "101", "S1", "ada", "M1", "2"],
        ["Hopper, Grace", "102", "S2", "grace", "M1", "1"],
        ["103", "103", "S3", "eve", "M2", "0"],
    ]
    assert [(row[0], row[-1]) for row in apart[1:]] == [
        ("mallory", "the student is not in the roster"),
        ("S1", "the student already has a row"),
    ]


@pytest.mark.parametrize("student", ["Points Possible", "  Points Possible", "Dr Points Possible"])
def test_nobody_is_the_row_of_points(student: str, prepared: Prepared, tmp_path: Path) -> None:
    found, apart = tables("canvas", prepared, tmp_path, result(student), result("ada"))
    assert [row[0] for row in found] == ["Student", "Points Possible", "ada"]
    assert len(apart) == 2


@pytest.mark.parametrize("title", ["Final Grade", "My Current Score", "Section", "ID"])
def test_a_title_that_canvas_takes_for_something_else(title: str, tmp_path: Path) -> None:
    asked = {"title": title, "problems": [{"id": "p", "scene": LINE, "questions": QUESTIONS}]}
    with pytest.raises(FormatError, match="another title"):
        tables("canvas", load_assignment(asked), tmp_path, result("ada"))


def test_moodle_without_a_roster(prepared: Prepared, tmp_path: Path) -> None:
    given = [result("ada@uni.example"), result("S2"), result("0"), result("b@uni.example", open_points=8)]
    found, apart = tables("moodle", prepared, tmp_path, *given)
    assert found == [
        ["useremail", "Sheet 1", "Sheet 1 (feedback)"],
        ["ada@uni.example", "2", "Points: 2 of 10.\n\np.f: 2 of 2. Correct.\nRead as: 1"],
    ]
    assert [row[0] for row in apart[1:]] == ["b@uni.example", "S2", "0"]
    found, apart = tables("moodle", prepared, tmp_path, result("S2"), result("0"), REFUSED)
    assert [row[0] for row in found] == ["useridnumber", "S2"]
    assert [row[0] for row in apart[1:]] == ["ada", "0"]


def test_moodle_by_what_everyone_has(prepared: Prepared, tmp_path: Path) -> None:
    known = roster(MOODLE, tmp_path)
    found, apart = tables(
        "moodle", prepared, tmp_path, result("Ada Lovelace"), result("grace@uni.example"), known=known
    )
    assert [row[:2] for row in found] == [
        ["useremail", "Sheet 1"], ["ada@uni.example", "2"], ["grace@uni.example", "2"],
    ]  # fmt: skip
    assert apart == []
    own = roster("userid,email\n7,ada@uni.example\n8,grace@uni.example\n", tmp_path)
    assert tables("moodle", prepared, tmp_path, result("grace@uni.example"), known=own)[0][1][:2] == ["8", "2"]


def test_moodle_shows_feedback_as_html(prepared: Prepared, tmp_path: Path) -> None:
    (_, row), _ = tables("moodle", prepared, tmp_path, result("1", doubt=None).model_copy(
        update={"items": [result("1").items[0].model_copy(update={"read_as": "x<y"})]}
    ))  # fmt: skip
    assert row[2].endswith("Read as: x&lt;y")


@pytest.mark.parametrize("name", ["canvas", "moodle"])
def test_what_is_doubtful_is_listed_apart(name: str, prepared: Prepared, tmp_path: Path) -> None:
    given = [result("S1", doubt="it names 'bob'"), result("S1", 1.0)]
    found, apart = tables(name, prepared, tmp_path, *given, known=roster(CANVAS, tmp_path))
    assert [row[-1] for row in found[2:]] == (["1"] if name == "canvas" else [])
    assert [row[-1] for row in apart[1:]] == ["it names 'bob'"]
    assert standing(given[0]).startswith("This result is not final: it names 'bob'.\nPoints: 2 of 10.")


HOSTILE = [
    "<script>", "=cmd|'/C calc'!A0", "+1+cmd", "@SUM(A1)", "\t=1", " =1", "＝1", "a\nb,c\"d", "a\0b", "\u202eabc", "",
    "  ", "x" * 40_000, "\x1b[31m", "a\u2028=b", "|calc", " ada", "ada ", "a\u200bda", "ada\u00a0",
]  # fmt: skip


@pytest.mark.parametrize("name", ["canvas", "moodle"])
def test_names_that_cannot_stand_in_a_table_are_apart(name: str, prepared: Prepared, tmp_path: Path) -> None:
    found, apart = tables(name, prepared, tmp_path, *map(result, HOSTILE))
    assert [row[0] for row in found if row[0] not in ("Student", "Points Possible", "useridnumber")] == ["<script>"]
    assert len(apart) == len(HOSTILE)
    for row in (*found, *apart):
        assert not [c for c in row if c.lstrip()[:1] in tuple("=+-@|＝")]


# rosters


@pytest.mark.parametrize(
    ("text", "student"),
    [
        ("name,email\nAda Lovelace,ada@x\n", "ada@x"),
        ("Name,SID,Email\nAda Lovelace,7,\n", "7"),
        ("sep=;\nVorname;Nachname;Matrikelnummer\nAda;Lovelace;7\n", "7"),
        ("\ufeffstudent\tid\nada\t7\n", "7"),
        ("student\nada\n", "ada"),
        ("Last Name,First Name\nLovelace,Ada\n", "Ada Lovelace"),
    ],
)
def test_headers_of_rosters(text: str, student: str, tmp_path: Path) -> None:
    known = roster(text, tmp_path)
    assert [member.student for member in known.members] == [student]
    assert known.find(student.upper()) is known.members[0]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "is empty"),
        ("points,grade\n1,2\n", "does not identify anyone: its header is points, grade"),
        ("name,email\nAda,a@x\nBob,A@X\n", "line 3: 'A@X' also occurs in line 2"),
        ("name\nAda\nada\n", "line 3: 'ada' also occurs in line 2"),
        ("name,email\nAda,\nAda,\n", "line 3: 'Ada' also occurs in line 2"),
    ],
)
def test_rosters_that_cannot_be_used(text: str, why: str, tmp_path: Path) -> None:
    with pytest.raises(RosterError, match=why.replace("(", r"\(")):
        roster(text, tmp_path)
    with pytest.raises(RosterError, match="no such file"):
        load_roster(tmp_path / "none.csv")


def test_what_two_go_by_names_nobody(tmp_path: Path) -> None:
    known = roster("name,email,userid,idnumber\nAda,a@x,1,2\nAda,b@x,2,3\n", tmp_path)
    assert [known.find(text) for text in ("Ada", "2")] == [None, None]
    assert [found.email for text in ("1", "3", "a@x") if (found := known.find(text))] == ["a@x", "b@x", "a@x"]
    assert known.find("ada\u200e") is None


@pytest.mark.parametrize(
    ("claims", "student", "expected", "doubted"),
    [
        (("ada",), "ada", "S1", False),
        (("ada",), "Ada Lovelace", "S1", False),
        (("ada",), "Ada", "S1", False),
        (("answers", "Ada Lovelace_12_assignsubmission_file_"), "answers", "S1", False),
        (("lovelaceada_101_99_answers",), "lovelaceada_101_99_answers", "S1", False),
        (("lovelaceada_LATE_101_99_answers",), "S1", "S1", False),
        (("ada",), "grace", "S1", True),
        (("ada",), "somebody", "S1", True),
        (("grace", "Ada Lovelace_12_assignsubmission_file_"), "grace", "S1", True),
        (("class",), "grace", "S2", False),
        (("class",), "mallory", "mallory", False),
    ],
)
def test_whose_it_is(claims: tuple[str, ...], student: str, expected: str, doubted: bool, tmp_path: Path) -> None:
    found = attributed(roster(CANVAS, tmp_path), claims, student, by_default=False)
    assert (found.student, found.doubt is not None) == (expected, doubted)


def test_what_names_nobody_is_its_owners(tmp_path: Path) -> None:
    known = roster(CANVAS, tmp_path)
    moodle = ("Ada Lovelace_3_assignsubmission_file_",)
    assert attributed(known, ("ada",), "ada:3", by_default=True) == ("S1", True, None)
    assert attributed(known, ("ada",), "ada:3", by_default=False).doubt is not None
    assert attributed(known, moodle, "Ada Lovelace_3", by_default=True) == ("S1", True, None)


def test_whose_it_is_at_a_platform() -> None:
    ada = Participant("ada@x", name="Ada Lovelace", email="ada@x", other="7")
    assert [doubt_of_platform([ada], name) for name in ("", "Ada", "ADA@x", "7", "Lovelace, Ada")] == [None] * 5
    assert doubt_of_platform([], "bob") is None
    assert "ada@x's, but names 'bob'" in str(doubt_of_platform([ada], "bob"))


def test_canvas_numbers_its_files_by_its_own_ids(tmp_path: Path) -> None:
    known = roster("name,canvas id,id number\nAda,101,7\nBob,102,101\nEve,103,8\n", tmp_path)
    named = [known.owners([claim]) for claim in ("adal_101_9_answers", "x_8_9_answers", "Eve_1_assignsubmission_file_")]
    assert [[owner.name for owner in owners] for owners in named] == [["Ada"], [], ["Eve"]]


def test_a_platform_is_given_its_own_ids_only(prepared: Prepared, tmp_path: Path) -> None:
    rows, _ = tables("moodle", prepared, tmp_path, result("ada"), known=roster(CANVAS, tmp_path))
    assert [row[0] for row in rows] == ["useridnumber", "S1"]
    of_moodle = roster("name,userid,idnumber\nAda,5,S1\n", tmp_path)
    rows, _ = tables("canvas", prepared, tmp_path, result("ada"), known=of_moodle)
    assert rows[2] == ["Ada", "", "S1", "", "", "2"]
