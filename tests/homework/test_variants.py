"""Variants from the lecturer's lists: each combination proved, picked by a keyed hash, kept when the roster changes."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import AssignmentError, Prepared, load_assignment
from dofkit.homework.grading import Grader
from dofkit.homework.handout.class_sheets import ASSIGNMENT, TABLE, write_sheets
from dofkit.homework.variants import NobodysVariantError, VaryError, differing_share, new_variants, picked, sheet_of
from dofkit.interface.assignment_commands import drawing
from dofkit.interface.cli import app

#: f = 2 n - (n - 1) = n + 1 for a chain of n particles in a line; the support at rest is scleronomic, moved rheonomic.
CHAIN = {
    "id": "chain",
    "text": "A mass on a rod of length $[[l]]$; the support [[support.how]].",
    "vary": {
        "l": [2, 3, 5],
        "support": [{"how": "is at rest", "at": "0"}, {"how": "moves", "at": "sin(t)"}],
    },
    "scene": {
        "coordinates": ["x", "y"],
        "constraints": [{"name": "rod", "text": "(x - [[support.at]])^2 + y^2 = [[l]]^2"}],
    },
    "questions": [
        {"id": "f", "ask": "dof", "points": 1},
        {"id": "label", "ask": "label", "constraint": "rod", "points": 1},
        {"id": "eq", "ask": "equation", "constraint": "rod", "points": 2},
    ],
}  # fmt: skip
SHEET: dict[str, Any] = {"title": "Rods", "problems": [CHAIN]}


def roster(*names: str) -> Roster:
    return Roster(tuple(Participant(name, name=name, email=f"{name}@x") for name in names))


def with_students(*names: str, seed: str = "s") -> Prepared:
    variants = new_variants(load_assignment(SHEET), roster(*names), seed)
    return load_assignment({**SHEET, "variants": variants.model_dump()})


def test_every_combination_is_a_scene_of_its_own() -> None:
    prepared = load_assignment(SHEET)
    assert len(prepared.combinations["chain"]) == 6
    sheet = picked(prepared, {"chain": {"l": 2, "support": 1}})
    (problem,) = sheet.assignment.problems
    assert problem.text == "A mass on a rod of length $5$; the support moves."
    assert sheet.keys["chain"].constraints["rod"].text == "(x - sin(t))^2 + y^2 = 5^2"
    assert sheet.keys["chain"].constraints["rod"].scleronomic is False


def test_a_hash_picks_the_same_for_the_same_seed_and_others_for_another() -> None:
    names = [f"s{i}" for i in range(40)]
    first, again, other = (with_students(*names, seed=seed) for seed in ("7", "7", "8"))
    assert first.assignment.variants == again.assignment.variants != other.assignment.variants
    assert first.assignment.variants is not None
    assert len({repr(one.picks) for one in first.assignment.variants.students}) == 6


def test_everyone_is_graded_by_their_own_key() -> None:
    prepared = with_students(*(f"s{i}" for i in range(12)))
    grader = Grader(prepared)
    for n in range(12):
        sheet = sheet_of(prepared, f"S{n}@X")
        pick = prepared.assignment.variants.find(f"s{n}").picks["chain"]  # type: ignore[union-attr]
        length = (2, 3, 5)[pick["l"]]
        answers = {"f": "1", "label": ("holonomic, scleronomic", "holonomic, rheonomic")[pick["support"]]}
        answers["eq"] = f"(x - {('0', 'sin(t)')[pick['support']]})^2 + y^2 = {length**2}"
        result = grader.grade(of_value({"student": f"s{n}", "answers": {"chain": answers}}, ""))
        assert [item.status for item in result.items] == ["right"] * 3
        assert result.items[0].variant is None  # f is 1 in every variant, so one decision holds for all
        assert result.items[2].variant == f"l = {length}, support = {('is at rest', 'moves')[pick['support']]}"
        assert sheet.assignment.variants is None
    nobody = Grader(load_assignment(SHEET)).grade(of_value({"student": "s1", "answers": {"chain": {"f": 1}}}, ""))
    assert "no student has a variant" in str(nobody.error)  # not graded by the first one
    labels = [sheet_of(prepared, f"s{n}").marks["chain", "label"] for n in range(12)]
    assert set(labels) == {"support = is at rest", "support = moves"}  # of which alone the label depends
    assert "none of the students" in str(grader.grade(of_value({"student": "zoe", "answers": {}}, "")).error)
    with pytest.raises(NobodysVariantError, match="several students"):
        sheet_of(prepared, ["s1", "s2"])


def test_copying_is_worth_less_than_the_share_that_differs() -> None:
    # f never differs; the label does with probability 1/2, the equation with 5/6: (1/2 + 2*5/6)/4 = 13/24
    assert differing_share(load_assignment(SHEET)) == pytest.approx(13 / 24)


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        (["names"], "`vary` lists the values of each name"),
        ({"l": []}, "`vary` needs a list of values for 'l'"),
        ({"l": [1, {"a": 2}]}, "do not all have the same fields"),
        ({"l": list(range(1, 70))}, "`vary` has 69 combinations"),
        ({"l": [2, "a"], "support": [{"at": "0", "how": ""}]}, "for l = a, support = 0: `a` is not declared"),
    ],
)
def test_lists_that_cannot_be_are_told(vary: Any, said: str) -> None:
    with pytest.raises(AssignmentError) as error:
        load_assignment({**SHEET, "problems": [{**CHAIN, "vary": vary}]})
    assert said in str(error.value)


def test_a_key_that_is_not_proved_is_refused() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["exp(x) + cos(exp(y)) = [[l]] + 10^-40", "x = y"]}
    varied = {**CHAIN, "scene": scene, "vary": {"l": [1, 2]}, "text": None, "questions": [{"id": "f", "ask": "dof"}]}
    with pytest.raises(AssignmentError, match="for l = 1: the key is not proved"):
        load_assignment({**SHEET, "problems": [varied]})


def test_a_key_has_evidence_and_what_evidence_contradicts_is_for_a_person(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = {
        "title": "Bars",
        "problems": [{"id": "p", "scene": "four-bar-linkage", "questions": CHAIN["questions"][:1]}],
    }
    report = load_assignment(sheet).keys["p"].report
    assert {told.checked for told in report.verdicts.values() if told.verdict == "proved"} == {True}
    monkeypatch.setattr("dofkit.methods.classify.classify", lambda scene: report.model_copy(update={"dof": 2}))
    answer = of_value({"student": "s", "answers": {"p": {"f": 2}}}, "")
    assert Grader(load_assignment(sheet)).grade(answer).items[0].status == "needs_review"


def test_a_class_keeps_its_variants(tmp_path: Path) -> None:
    (tmp_path / "sheet.yaml").write_text(yaml.safe_dump(SHEET))
    (tmp_path / "roster.csv").write_text("name,email\nAda,ada@x\nBo,bo@x\nCy,cy@x\n")
    command = ["assignment", "vary", "sheet.yaml", "--roster", "roster.csv", "--seed", "1", "--out", "class"]
    runner = CliRunner()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path)
        picks = []
        for names in ("", "Dee,dee@x\nAda L,ada@x\nCy,cy@x\n"):
            if names:
                (tmp_path / "roster.csv").write_text(f"name,email\n{names}")
            assert runner.invoke(app, command).exit_code == 0
            variants = load_assignment("class/assignment.yaml").assignment.variants
            assert variants is not None
            picks.append({one.student: one.picks for one in variants.students})
        assert [picks[0][name] == picks[1][name] for name in ("ada@x", "cy@x")] == [True, True]
        written = ["assignment", "handout", "class/assignment.yaml", "--roster", "roster.csv", "--out", "class/sheets"]
        assert runner.invoke(app, written).exit_code == 0
        assert len(list((tmp_path / "class" / "sheets").iterdir())) == 3
        table = list(csv.DictReader((tmp_path / "class" / TABLE).open(encoding="utf-8-sig")))
        assert {row["student"] for row in table} == {"ada@x", "cy@x", "dee@x"}
        answers = {"chain": {"f": 1}}
        (tmp_path / "dee@x.json").write_text(json.dumps({"student": "Dee", "answers": answers}))
        graded = runner.invoke(app, ["grade", f"class/{ASSIGNMENT}", "dee@x.json", "--roster", "roster.csv"])
        assert json.loads(graded.output.splitlines()[0])["score"] == 1.0
        preview = runner.invoke(app, ["assignment", "handout", "class/assignment.yaml", "--out", "first.html"])
        assert "this is a preview" in preview.output
        assert "[[" not in (tmp_path / "first.html").read_text(encoding="utf-8")
        plain = {"id": "p", "scene": "four-bar-linkage", "questions": [{"id": "f", "ask": "dof"}]}
        (tmp_path / "plain.yaml").write_text(yaml.safe_dump({**SHEET, "problems": [plain]}))
        assert "nothing varies" in runner.invoke(app, [*command[:2], "plain.yaml", *command[3:]]).output


def test_a_page_with_fields_has_only_names_of_its_own_sheet(tmp_path: Path) -> None:
    """Nothing of the key, of the scene's constraints, of another variant or of another student is in a page."""
    questions = CHAIN["questions"][:1] + CHAIN["questions"][2:]
    scene = {**CHAIN["scene"], "energies": {"kinetic": "777 xdot^2"}, "expect": {"dof": 1}, "notes": "secret"}
    written = {**SHEET, "problems": [{**CHAIN, "questions": questions, "scene": scene}]}
    members = roster(*(f"student{i}" for i in range(10, 19)))
    variants = new_variants(load_assignment(written), members, "seed-of-mine")
    prepared = load_assignment({**written, "variants": variants.model_dump()})
    write_sheets(prepared, members, "page", drawing(), tmp_path)
    for student in variants.students:
        page = (tmp_path / f"{student.student}.html").read_text(encoding="utf-8")
        picked_l, picked_support = student.picks["chain"]["l"], student.picks["chain"]["support"]
        hidden = {"y^2", "y^{2}", "777", "secret", "seed-of-mine", "expect", "vary", "picks"}
        hidden |= {other.student for other in variants.students if other is not student}
        assert [text for text in hidden if text in page] == []
        assert ("the support moves." in page, "the support is at rest." in page) == (
            picked_support == 1,
            picked_support == 0,
        )
        assert re.findall(r"<mn>(\d)</mn>", page) == [str((2, 3, 5)[picked_l])]
        (text,) = re.findall(r'id="data">(.*?)</script>', page)
        data = json.loads(text)
        assert data["assignment"] is None
        assert {key: value for key, value in data["declared"]["chain"].items() if key != "questions"} == {
            "scene": {"dimension": 3, "coordinates": ["x", "y"]}, "constraints": ["rod"], "also": {}
        }  # fmt: skip
    with pytest.raises(NobodysVariantError, match="no student has a variant"):
        write_sheets(load_assignment(written), members, "page", drawing(), tmp_path)


def test_a_roster_of_nobody() -> None:
    with pytest.raises(VaryError, match="empty"):
        new_variants(load_assignment(SHEET), Roster(()), "1")
