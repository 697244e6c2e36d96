"""Variants: the same everywhere, as hard as each other, each with a proved key, and graded by their own."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.documents import read_document
from dofkit.homework import own_sheets
from dofkit.homework.answers.roster import load_roster
from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.autograder import main
from dofkit.homework.class_sheets import ClassDraws, class_sheets, write_class
from dofkit.homework.earlier_sheets import VaryError
from dofkit.homework.echo import echo
from dofkit.homework.export import OtterError, export_otter
from dofkit.homework.grading import Grader
from dofkit.homework.key.key import Key
from dofkit.homework.notebooks import QuestionError, item_of
from dofkit.homework.own_sheets import NobodysSheetError, OwnSheet, SheetDrawer, own, structure_told
from dofkit.homework.problem import Problem, StudentSheet
from dofkit.homework.review.identity import answer_id
from dofkit.homework.starting import best_questions
from dofkit.homework.variants.difficulty import difficulty_of
from dofkit.homework.variants.geometry import Stretch, new_stretch, stretched
from dofkit.homework.variants.renaming import renamed, words
from dofkit.homework.variants.stream import Stream
from dofkit.homework.variants.structure import names_at_hand, written_scene
from dofkit.interface import cli
from dofkit.interface.assignment_commands import drawing
from dofkit.scene.catalog import catalog_names
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.reading import load

PENDULUM: dict[str, Any] = {
    "dimension": 2,
    "parameters": {"l": "positive"},
    "particles": ["A"],
    "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
}
WHEEL: dict[str, Any] = {
    "dimension": 2,
    "bodies": ["W"],
    "constraints": [{"name": "ground", "type": "roll", "body": "W", "radius": 1}],
}
#: Three particles in a plane: of three bars and a wall each is as good as another.
TRUSS: dict[str, Any] = {
    "dimension": 2,
    "particles": ["A", "B", "C"],
    "constraints": [
        {"name": "ab", "type": "link", "between": ["A", "B"], "length": 3},
        {"name": "bc", "type": "link", "between": ["B", "C"], "length": 4},
        {"name": "ca", "type": "link", "between": ["C", "A"], "length": 5},
    ],
}
CURVE: dict[str, Any] = {
    "coordinates": ["x", "y"],
    "constraints": [{"name": "wire", "type": "equation", "text": "x^2 + 3*y^2 = 7"}],
}


def problem(name: str, scene: dict[str, Any], *asks: dict[str, Any], **more: Any) -> dict[str, Any]:
    asked = [{"id": f"q{i}", **ask} for i, ask in enumerate(asks)]
    return {"id": name, "scene": scene, "questions": asked, **more}


def varied(*problems: dict[str, Any], students: int = 6) -> Prepared:
    given = [{"student": f"s{i}", "known_as": [f"Student {i}"]} for i in range(students)]
    return load_assignment({"title": "T", "problems": list(problems), "variants": {"seed": "7", "students": given}})


def sheets(prepared: Prepared) -> Iterator[OwnSheet]:
    assert prepared.assignment.variants is not None
    drawer = SheetDrawer(prepared)
    for whose in prepared.assignment.variants.students:
        yield drawer.sheet(prepared.assignment.variants.seed, whose)


LABEL = {"ask": "label", "constraint": "rod"}
SHEET = (
    problem("pendulum", PENDULUM, {"ask": "dof"}, LABEL, {"ask": "equation", "constraint": "rod"}),
    problem("truss", TRUSS, {"ask": "dof"}, {"ask": "redundant"}),
    problem("curve", CURVE, {"ask": "k"}, {"ask": "coordinates"}),
)


def test_every_sheet_is_proved_and_as_hard_as_the_assignment() -> None:
    prepared = varied(*SHEET, students=20)
    wanted = sum((prepared.structures[p.id][0].difficulty.counted() for p in prepared.assignment.problems), Counter())
    marks = set()
    for sheet in sheets(prepared):
        found: Counter[Any] = Counter()
        for variant in sheet.variants:
            report = variant.key.report
            assert (report.verdict, report.consistent) == ("proved", True)
            base = prepared.keys[variant.problem.id]
            assert len(variant.key.coordinates) == len(base.coordinates)
            assert abs(len(report.constraints) - len(base.report.constraints)) <= 1
            found += dict_of(prepared, variant.problem.id, variant.changed)
        assert found == wanted
        marks.add(tuple(v.mark for v in sheet.variants))
    assert len(marks) == 20


def written(problem: Problem) -> dict[str, Any]:
    """The scene that stands in the problem itself."""
    assert isinstance(problem.scene, dict)
    return problem.scene


def dict_of(prepared: Prepared, name: str, changed: str) -> Counter[Any]:
    return next(s.difficulty.counted() for s in prepared.structures[name] if s.changed == changed)


def test_an_equation_gets_other_numbers_and_its_key_follows() -> None:
    prepared = varied(SHEET[2], students=12)
    texts = {written(sheet.variants[0].problem)["constraints"][0]["text"] for sheet in sheets(prepared)}
    assert len(texts) > 6
    assert all(text.startswith("x^2 + ") for text in texts), "an exponent is no number to exchange"


@pytest.mark.sweep
def test_support_in_motion_where_the_problem_says_so() -> None:
    aspects = ["names", "supports"]
    prepared = varied(problem("p", PENDULUM, {"ask": "dof"}, LABEL, vary=aspects), students=20)
    moving = [v for sheet in sheets(prepared) for v in sheet.variants if v.changed]
    assert 3 < len(moving) < 20
    assert {v.key.constraints["rod"].scleronomic for v in moving} == {False}
    assert {v.key.report.dof for v in moving} == {1}
    alone = varied(problem("p", PENDULUM, {"ask": "dof"}, LABEL), students=20)
    assert not [v for sheet in sheets(alone) for v in sheet.variants if v.changed], "its label would be another"


def test_a_link_may_hang_on_what_moves() -> None:
    """Asked for its label; where its equation is asked for, the sheet would have nothing to tell of it."""
    scene = {**PENDULUM, "constraints": [{"name": "rod", "type": "link", "between": [[2, "1/2"], "A"], "length": "l"}]}
    prepared = varied(problem("p", scene, {"ask": "dof"}, LABEL, vary=["supports"]))
    told = {s.changed: s.key.scene.constraints[0].in_words for s in prepared.structures["p"]}
    text = "(x_A - (2 + a*cos(omega*t)))^2 + (y_A - (0.5))^2 = l^2"
    assert told["rod: its support moves by a cos(omega t)"] == text
    asked = problem("p", scene, LABEL, {"ask": "equation", "constraint": "rod"}, vary=["supports"])
    assert {s.changed for s in varied(asked).structures["p"]} == {"", "rod: its length grows at the speed v"}


def test_two_problems_may_trade_their_labels() -> None:
    """One pendulum's rod is drawn in, the other's is not: on every sheet one is, and it is not always the same."""
    drawn = {**PENDULUM, "parameters": {"l": "positive", "v": "positive"}}
    drawn["constraints"] = [{**PENDULUM["constraints"][0], "length": "l + v*t"}]
    asks = ({"ask": "label", "constraint": "rod", "parts": ["scleronomic"]},)
    prepared = varied(problem("one", PENDULUM, *asks), problem("two", drawn, *asks), students=20)
    found = Counter(tuple(v.key.constraints["rod"].scleronomic for v in sheet.variants) for sheet in sheets(prepared))
    assert set(found) == {(True, False), (False, True)}


def test_rolling_or_sliding() -> None:
    prepared = varied(problem("p", WHEEL, {"ask": "dof"}, vary=["rolling"]), students=12)
    found = {(v.changed, v.key.report.dof) for sheet in sheets(prepared) for v in sheet.variants}
    assert found == {("", 1), ("ground: W slides", 2)}


def test_one_of_the_given_is_dropped_or_added() -> None:
    more = {"vary": {"what": ["constraints"], "drop": ["bc"], "add": ["x_A = 0", "y_B = 3"]}}
    prepared = varied(problem("p", TRUSS, {"ask": "dof"}, **more), students=30)
    found = {(v.changed, v.key.report.dof) for sheet in sheets(prepared) for v in sheet.variants}
    assert found == {("", 3), ("without bc", 4), ("with c4: x_A = 0", 2), ("with c4: y_B = 3", 2)}


def test_what_nobody_asks_about_is_dropped_and_nothing_else() -> None:
    asks = ({"ask": "dof"}, {"ask": "label", "constraint": "ab"})
    prepared = varied(problem("p", TRUSS, *asks, vary=["constraints"]))
    assert {s.changed for s in prepared.structures["p"]} == {"", "without bc", "without ca"}


def test_own_words_keep_their_names() -> None:
    text = "A rod of length $l$ holds a particle."
    named = {v.names for sheet in sheets(varied(problem("p", PENDULUM, {"ask": "dof"}, text=text), students=20))
             for v in sheet.variants}  # fmt: skip
    assert any("for A" not in told for told in named), "nothing but a letter in the text"
    assert not any("for l" in told for told in named)
    for more in ({"title": "At $x_A = 0$"}, {"text": "Its velocity is $\\dot{x}_A$."}):
        named = {v.names for sheet in sheets(varied(problem("p", PENDULUM, {"ask": "dof"}, **more), students=20))
                 for v in sheet.variants}  # fmt: skip
        assert not any("for A" in told for told in named)


def test_questions_follow_the_names() -> None:
    scene = {"coordinates": ["theta"], "parameters": {"m": "positive", "l": "positive"},
             "energies": {"kinetic": "1/2 m l^2 thetadot^2"}}  # fmt: skip
    asked = problem("p", scene, {"ask": "momentum", "coordinate": "theta"}, also={"s": "l theta"}, names={"theta": "w"})
    for sheet in sheets(varied(asked, students=8)):
        (variant,) = sheet.variants
        (angle,) = variant.key.coordinates
        assert variant.problem.questions[0].about == (angle,)
        assert list(variant.problem.names) == [angle]
        assert angle in variant.problem.also["s"]
        right = f"{written(variant.problem)['energies']['kinetic']}"
        given = right.replace("1/2 ", "").replace("dot^2", "dot")
        result = Grader(sheet.prepared).grade(of_value({"answers": {"p": {"q0": given}}}, "s"))
        assert result.items[0].status == "right"


def test_a_key_that_is_not_proved_is_not_varied() -> None:
    asked = {"id": "p", "scene": "double-pendulum-links", "questions": [{"id": "f", "ask": "dof"}]}
    prepared = varied(asked)
    assert prepared.keys["p"].report.verdict == "probable"
    assert {v.mark for sheet in sheets(prepared) for v in sheet.variants} == {next(sheets(prepared)).variants[0].mark}


# the same everywhere


@pytest.mark.sweep
def test_the_same_sheet_on_every_machine() -> None:
    """Whatever seed Python's own hashes have."""
    code = (
        "import json, sys; from tests_of import varied, sheets, SHEET\n"
        "print(json.dumps([[v.problem.scene for v in s.variants] for s in sheets(varied(*SHEET, students=3))]))"
    )
    here = Path(__file__).parent
    told = set()
    for seed in ("0", "1"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)}
        run = code.replace("from tests_of import", f"sys.path.insert(0, {str(here)!r}); from test_variants import")
        done = subprocess.run([sys.executable, "-c", run], env=environment, capture_output=True, text=True, check=True)
        told.add(done.stdout)
    assert len(told) == 1
    mine = [[v.problem.scene for v in s.variants] for s in sheets(varied(*SHEET, students=3))]
    assert json.loads(told.pop()) == json.loads(json.dumps(mine))


def test_a_stream_is_even_and_depends_on_every_mark() -> None:
    counts = Counter(Stream("s", n).below(5) for n in range(2000))
    assert all(320 < counts[k] < 480 for k in range(5))
    assert sorted(Stream("a").shuffled(range(9))) == list(range(9))


# grading


@pytest.mark.sweep
def test_everyone_is_graded_by_their_own_key() -> None:
    prepared = varied(SHEET[2], SHEET[1], students=8)
    grader = Grader(prepared)
    for n, sheet in enumerate(sheets(prepared)):
        curve, truss = sheet.variants
        given = {"curve": {"q0": 1, "q1": curve.key.coordinates[0]}, "truss": {"q0": truss.key.report.dof}}
        for name in (f"s{n}", f"STUDENT {n}"):
            result = grader.grade(of_value({"student": name, "answers": given}, ""))
            assert [i.status for i in result.items if i.status != "missing"] == ["right"] * 3
            assert [i.variant for i in result.items] == [curve.mark] * 2 + [truss.mark] * 2
            assert structure_told(curve.mark) == "as given"


def test_who_has_no_sheet_is_told_so() -> None:
    prepared = varied(SHEET[2])
    result = dofkit.grade(prepared, {"student": "zoe", "answers": {"curve": {"q0": 1}}})
    assert result.error is not None
    assert "not among the students" in result.error
    assert echo(prepared, of_value({"student": "zoe", "answers": {}}, "")).error is not None
    with pytest.raises(NobodysSheetError):
        own(prepared, "zoe")
    with pytest.raises(QuestionError):
        item_of(prepared, "curve", "q0", 1, {})


def test_a_sheet_that_comes_out_another_way_is_not_graded() -> None:
    """As with another version of dofkit: nobody is held to a sheet that was not theirs."""
    given = {"title": "T", "problems": [SHEET[2]]}
    students = [{"student": "s0", "sheet": "0123456789abcdef"}]
    prepared = load_assignment({**given, "variants": {"seed": "7", "version": "0.0.9", "students": students}})
    result = dofkit.grade(prepared, {"student": "s0", "answers": {"curve": {"q0": 1}}})
    assert result.score is None
    assert "comes out another way than dofkit 0.0.9 made it" in str(result.error)


def test_what_a_person_decides_counts_for_one_variant() -> None:
    prepared = varied(SHEET[2], students=2)
    first, second = (own(prepared, name) for name in ("s0", "s1"))
    assert first.marks != second.marks
    ids = {answer_id("curve", "q1", "the angle", sheet.marks["curve"]) for sheet in (first, second)}
    assert len(ids) == 2


@pytest.mark.sweep
def test_a_platform_says_whose_sheet_it_is(tmp_path: Path) -> None:
    """Whatever the file and what is in it are called; nobody's and a group's are not graded by somebody's key."""
    prepared = varied(SHEET[1], students=2)
    sheet = tmp_path / "assignment.json"
    sheet.write_text(prepared.assignment.model_dump_json(exclude_none=True))
    right = own(prepared, "s1").keys["truss"].report.dof
    folder = tmp_path / "autograder"
    (folder / "submission").mkdir(parents=True)
    (folder / "submission" / "s0.json").write_text(json.dumps({"answers": {"truss": {"q0": right}}}))

    def graded(*users: dict[str, str]) -> Any:
        (folder / "submission_metadata.json").write_text(json.dumps({"users": users}))
        assert main(["gradescope", str(sheet), "--root", str(folder)]) == 0
        return json.loads((folder / "results" / "results.json").read_text())

    found = graded({"email": "one@x.org", "name": "Student 1", "id": "7"})
    assert found["score"] == 1.0
    assert "several students of the assignment" in graded({"email": "s0"}, {"email": "s1"})["output"]
    assert "none of the students of the assignment" in graded({"email": "zoe@x.org"})["output"]
    with pytest.raises(OtterError):
        export_otter(sheet, tmp_path / "otter")


# of types


def beside(cls: type[ConstraintBase], dimension: int) -> list[Any]:
    return [read_document(line.encode(), "beside").value for line in cls.beside.get(dimension, ())]


@pytest.mark.parametrize("kind", list(TYPES))
def test_every_type_can_be_stretched(kind: str) -> None:
    """Its example, half as large again: every number of geometry changes, and the scene stays a scene."""
    cls = TYPES[kind]
    for dimension, line in cls.examples.items():
        d = dimension or 2
        constraint: Any = read_document(line.encode(), "example").value
        scene = load(
            {"dimension": d, "bodies": ["crank", "rod", "wheel"], "particles": ["A", "B", "C"],
             "coordinates": ["x", "y"], "constraints": [*beside(cls, d), constraint]}
        )  # fmt: skip
        written = written_scene(scene)
        found = stretched(scene, written, Stretch((Fraction(3, 2),) * d, Fraction(3, 2), {}))
        load(found)
        geometric = {*cls.variation.places, *cls.variation.directions, *cls.variation.lengths, *cls.variation.numbers}
        fields = {"at", "axis", "axes", "point", "length", "pitch", "radius"} & set(cls.model_fields)
        assert fields <= geometric, "a field of geometry that the type does not declare"


@pytest.mark.parametrize("kind", list(TYPES))
def test_what_may_replace_a_type_is_a_scene(kind: str) -> None:
    cls = TYPES[kind]
    for dimension, line in cls.examples.items():
        d = dimension or 2
        base = {
            "dimension": d,
            "bodies": ["crank", "rod", "wheel"],
            "particles": ["A", "B", "C"],
            "coordinates": ["x", "y"],
        }
        scene = load({**base, "constraints": [*beside(cls, d), read_document(line.encode(), "example").value]})
        for other in scene.constraints[-1].replacements(names_at_hand(scene)):
            more = {"constraints": [*beside(cls, d), other.fields], "parameters": dict(other.parameters)}
            load({**base, **more})
            assert other.told


def test_names_change_as_whole_words_only() -> None:
    scene = load({"dimension": 2, "parameters": ["l", "m"], "particles": ["A"], "coordinates": ["theta"],
                  "constraints": ["x_A = l sin(θ) + m", "dx_A = l dtheta", "x_Adot + xdot_A = thetadot"]})  # fmt: skip
    changes = words(scene, {"l": "a", "A": "P", "theta": "phi"})
    told = [c["text"] for c in renamed(written_scene(scene), changes)["constraints"]]
    assert told == ["x_P = a sin(phi) + m", "dx_P = a dphi", "x_Pdot + xdot_P = phidot"]


def test_numbers_of_texts_are_no_exponents_and_no_fractions() -> None:
    scene = load({"coordinates": ["x", "y"], "constraints": ["3*x^2 + y**2 = 5/2 + 0.25 + 12"]})
    written = written_scene(scene)
    assert sorted(new_stretch(written, 3, Stream("s")).others) == [3, 12]


# the command


@pytest.mark.sweep
def test_a_class(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    roster = tmp_path / "roster.csv"
    roster.write_text("Name,Email\nAda Lovelace,ada@x.org\nBob,bob@x.org\n=cmd|' /C calc'!A0,eve@x.org\n")
    (tmp_path / "own.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    source = tmp_path / "sheet.json"
    problems = [*SHEET, problem("drawn", CURVE, {"ask": "k"}, figure="own.svg")]
    source.write_text(json.dumps({"title": "T", "problems": problems}))
    out = tmp_path / "made"
    args = ["assignment", "vary", str(source), "--roster", str(roster), "--seed", "7", "--out", str(out)]
    cli.app(args, standalone_mode=False)
    told = capsys.readouterr()
    assert "3 sheets" in told.out
    assert "problem 'drawn' is the same for everyone" in told.err
    table = (out / "variants.csv").read_text(encoding="utf-8-sig").splitlines()
    assert len(table) == 1 + 3 * 4
    assert "proved" in (out / "variants.html").read_text()
    pages = sorted((out / "sheets").glob("*.html"))
    assert len(pages) == 3
    assert len({page.read_text() for page in pages}) == 3
    made = load_assignment(out / "assignment.yaml")
    one = own(made, "Ada Lovelace")
    answers = {"truss": {"q0": one.keys["truss"].report.dof}}
    (tmp_path / "ada.json").write_text(json.dumps({"student": "ADA@x.org", "answers": answers}))
    cli.app(["grade", str(out / "assignment.yaml"), str(tmp_path / "ada.json")], standalone_mode=False)
    (line,) = capsys.readouterr().out.splitlines()
    assert json.loads(line)["score"] == 1.0
    args = [
        "assignment",
        "handout",
        str(out / "assignment.yaml"),
        "--student",
        "Bob",
        "--out",
        str(tmp_path / "b.html"),
    ]
    cli.app(args, standalone_mode=False)
    assert (tmp_path / "b.html").read_text().replace("Bob", "bob@x.org") == (
        out / "sheets" / "bob@x.org.html"
    ).read_text()
    capsys.readouterr()
    again = tmp_path / "again"
    cli.app(["assignment", "vary", str(source), "--roster", str(roster), "--seed", "7", "--out", str(again)],
            standalone_mode=False)  # fmt: skip
    assert (again / "assignment.yaml").read_text().replace("../", "") == (out / "assignment.yaml").read_text().replace(
        "../", ""
    )


def test_no_two_have_the_same_sheet_where_there_are_enough(tmp_path: Path) -> None:
    """One letter of ten: for eight students the same is drawn twice, and then again."""
    source, roster = tmp_path / "sheet.json", tmp_path / "roster.csv"
    scene = {"dimension": 2, "particles": ["A"]}
    source.write_text(json.dumps({"title": "T", "problems": [problem("p", scene, {"ask": "dof"}, vary=["names"])]}))
    roster.write_text("email\n" + "".join(f"s{i}@x.org\n" for i in range(8)))
    made = class_sheets(str(source), load_roster(roster), "7", tmp_path / "made")
    assert len({row.names for row in made.rows}) == 8
    assert any(whose.draw for whose, _ in made.sheets)
    assert not list(made.remarks())
    roster.write_text("email\n" + "".join(f"s{i}@x.org\n" for i in range(12)))
    assert len(list(class_sheets(str(source), load_roster(roster), "7", tmp_path / "made").remarks())) == 2


def test_what_cannot_be_varied(tmp_path: Path) -> None:
    source, roster = tmp_path / "sheet.json", tmp_path / "roster.csv"
    source.write_text(json.dumps({"title": "T", "problems": [SHEET[2]]}))
    roster.write_text("email\nada@x.org\n")
    made = class_sheets(str(source), load_roster(roster), "7", tmp_path / "made")
    write_class(made, "md", drawing(), tmp_path / "made")
    with pytest.raises(VaryError, match="vary what it was made from"):
        class_sheets(str(tmp_path / "made" / "assignment.yaml"), load_roster(roster), "7", tmp_path / "more")
    roster.write_text("email\n")
    with pytest.raises(VaryError, match="nobody"):
        class_sheets(str(source), load_roster(roster), "7", tmp_path / "made")


@pytest.mark.sweep
@pytest.mark.parametrize("name", catalog_names())
@pytest.mark.parametrize("free", [False, True])
def test_variants_of_the_whole_catalog(name: str, free: bool) -> None:
    """Three students of every scene, with what is asked of it first; a base that is not proved stays as it is."""
    asked = list(best_questions(Key(load(name))))
    more = {"vary": True} if free else {}
    prepared = varied({"id": "p", "scene": name, "questions": asked, **more}, students=3)
    base = prepared.keys["p"]
    for sheet in sheets(prepared):
        (variant,) = sheet.variants
        if base.report.verdict != "proved":
            assert (variant.changed, variant.numbers, variant.names) == ("", "", "")
            continue
        assert (variant.key.report.verdict, variant.key.report.consistent) == ("proved", True)
        assert len(variant.key.coordinates) == len(base.coordinates)
        assert (variant.key.report.dof == 0) == (base.report.dof == 0)
        if not free:
            assert difficulty_of(variant.problem, variant.key) == prepared.structures["p"][0].difficulty


# a course that changes


def graded(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, dict[str, Any]]:
    """The results of a command by student."""
    capsys.readouterr()
    cli.app(["grade", *map(str, arguments), "--workers", "1"], standalone_mode=False)
    found = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    return {one["student"]: one for one in found}


ROD = problem("rod", PENDULUM, {"ask": "dof"}, {"ask": "coordinates"})


def varied_class(folder: Path, roster: str, *more: str, status: int = 0) -> Path:
    """A class with sheets in `made`; the command ends with this status."""
    (folder / "roster.csv").write_text(roster)
    (folder / "sheet.json").write_text(json.dumps({"title": "T", "problems": [ROD]}))
    given = ["--roster", str(folder / "roster.csv"), "--seed", "7", "--out", str(folder / "made"), "--format", "md"]
    ended = cli.app(["assignment", "vary", str(folder / "sheet.json"), *given, *more], standalone_mode=False)
    assert (ended or 0) == status
    return folder / "made" / "assignment.yaml"


def test_nobodys_sheet_changes_with_the_roster(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Another order, one gone, one under another name, one with another address, one more at the top."""
    made = varied_class(tmp_path, "Name,Email,ID\nAda,a@x,1\nBob,b@x,2\nCy,c@x,3\nDi,d@x,4\n")
    before = {path.name: path.read_text() for path in (tmp_path / "made" / "sheets").glob("*.md")}
    first = load_assignment(made)
    assert len(before) == 4
    capsys.readouterr()
    varied_class(tmp_path, "Name,Email,ID\nNew,n@x,9\nDi King,d@x,4\nCy,c@y,3\nAda,a@x,1\n")
    assert "'b@x' is not in the roster any more" in capsys.readouterr().err
    after = {path.name: path.read_text() for path in (tmp_path / "made" / "sheets").glob("*.md")}
    assert {name: after[name] for name in before} == before
    assert len(set(after.values())) == 5
    again = load_assignment(made)
    for name in ("a@x", "b@x", "c@x", "d@x"):
        assert own(again, name).marks == own(first, name).marks
    assert own(again, "c@y").marks == own(again, "Cy").marks == own(first, "c@x").marks
    assert own(again, "Di King").marks == own(first, "Di").marks


@pytest.mark.sweep
def test_a_folder_keeps_the_sheets_it_has(tmp_path: Path) -> None:
    roster = "Name,Email,ID\nAda,a@x,1\nBob,b@x,2\n"
    made = varied_class(tmp_path, roster)
    text = made.read_text()
    varied_class(tmp_path, roster, "--seed", "8", status=2)
    assert made.read_text() == text
    varied_class(tmp_path, roster, "--seed", "8", "--anew")
    assert made.read_text() != text
    made.write_text(re.sub("sheet: [0-9a-f]+", "sheet: '00'", made.read_text()))
    varied_class(tmp_path, roster, "--seed", "8", status=2)
    varied_class(tmp_path, "Name,Email\nAda,b@x\n", "--seed", "8", status=2)


@pytest.mark.sweep
def test_sheets_are_found_by_a_later_roster_and_by_what_platforms_call_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = varied_class(tmp_path, "Name,Email\nAda Lovelace,a@x\nBob,b@x\nCy,c@x\n")
    prepared = load_assignment(made)
    (tmp_path / "later.csv").write_text("Name,Email,ID\nAda King,a@x,4711\nBob,b@x,4712\nCy,c@x,4713\n")
    right = {name: own(prepared, name).keys["rod"].coordinates[0] for name in ("a@x", "b@x", "c@x")}
    assert len(set(right.values())) > 1, "an answer for another's sheet is not right"
    folder = tmp_path / "in"
    for name, student, who in (
        ("Ada Lovelace_12_assignsubmission_file_", "", "a@x"),
        ("4712", "", "b@x"),
        ("any", "student: 4713\n", "c@x"),
    ):
        (folder / name).mkdir(parents=True)
        (folder / name / "answers.yaml").write_text(f"{student}rod: {{q1: {right[who]}}}\n")
    files = [folder / name / "answers.yaml" for name in ("Ada Lovelace_12_assignsubmission_file_", "any")]
    found = graded(capsys, made, *files)
    assert found["a@x"]["items"][1]["status"] == "right"
    assert "not among the students" in found["4713"]["error"]
    for name in ("Ada Lovelace_12_assignsubmission_file_", "any", "4712"):
        who = {"any": "c@x", "4712": "b@x"}.get(name, "a@x")
        one = graded(capsys, made, folder, "--roster", tmp_path / "later.csv")[who]
        assert (one["items"][1]["status"], one["doubt"], one["error"]) == ("right", None, None), name


def test_many_with_few_sheets_are_quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten letters for 300: what comes out the same is proved once."""
    asked = problem("p", {"dimension": 2, "particles": ["A"]}, {"ask": "dof"}, vary=["names"])
    draws, proofs = ClassDraws(SheetDrawer(varied(asked, students=1)), "7"), []
    monkeypatch.setattr(
        own_sheets, "_proved", lambda *given, proved=own_sheets._proved: proofs.append(given) or proved(*given)
    )
    found = {draws.different(StudentSheet(student=f"s{n}"))[1].digest for n in range(300)}
    assert (len(found), len(proofs)) == (10, 10)
