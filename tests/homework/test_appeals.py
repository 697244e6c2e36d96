"""Certificates for appeals: one for each problem, in the folder and nowhere else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import dofkit
from dofkit.homework.assignment import load_assignment
from dofkit.homework.own_sheets import SheetDrawer
from dofkit.homework.runs.run import GradingOptions, run

QUESTION = "questions: [{id: f, ask: dof, points: 2}]"


def test_every_problem_has_its_certificate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet, answers = tmp_path / "sheet.yaml", tmp_path / "ada.yaml"
    scene = '{coordinates: [x, y], constraints: ["x^2 + y^2 = 1"]}'
    sheet.write_text(
        f"title: One\nproblems:\n- {{id: bars, scene: four-bar-linkage, {QUESTION}}}\n"
        f'- {{id: "../circle", scene: {scene}, {QUESTION}}}\n'
    )
    answers.write_text("student: ada\nanswers: {bars: {f: 1}}\n")
    assert run(str(sheet), [str(answers)], GradingOptions(certificates=tmp_path / "a" / "why"))
    assert '"score":2.0' in capsys.readouterr().out.replace(" ", "")
    folder = tmp_path / "a" / "why"
    assert sorted(p.name for p in folder.iterdir()) == ["..%2Fcircle.json", "bars.json"]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a", "ada.yaml", "sheet.yaml"]
    for path, given in ((folder / "bars.json", "four-bar-linkage"), (folder / "..%2Fcircle.json", None)):
        found = dofkit.verify(given, path)
        assert (found.failed, found.verified) == ([], found.claims)
        assert found.claims


#: A circle about the origin, and a skate beside it; what is asked for is the equation of each.
SHEET = """
title: Two
problems:
- id: ring
  scene:
    coordinates: [x, y, u, v, theta]
    parameters: {l: positive}
    constraints:
    - {name: circle, text: "x^2 + y^2 = l^2"}
    - {name: skate, text: "du sin(theta) = dv cos(theta)"}
  questions:
  - {id: circle, ask: equation, constraint: circle, points: 1}
  - {id: skate, ask: equation, constraint: skate, points: 1}
"""
#: Answers, whether they are right, and how many certificates tell so.
ANSWERS = {
    "ada": ("2 x^2 + 2 y^2 - 2 l^2 = 0", "2 sin(theta) du - 2 cos(theta) dv = 0", "right", 2),
    "ben": ("x^2 + y^2 = 4 l^2", "du cos(theta) + dv sin(theta) = 0", "wrong", 1),
}


@pytest.mark.sweep
@pytest.mark.parametrize("student", ANSWERS)
def test_answers_in_equations_have_certificates(
    student: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    circle, skate, status, many = ANSWERS[student]
    sheet, given, folder = tmp_path / "sheet.yaml", tmp_path / "given.json", tmp_path / "why"
    sheet.write_text(SHEET)
    given.write_text(json.dumps({"student": student, "answers": {"ring": {"circle": circle, "skate": skate}}}))
    assert run(str(sheet), [str(given)], GradingOptions(certificates=folder))
    assert [item["status"] for item in json.loads(capsys.readouterr().out)["items"]] == [status, status]
    told = json.loads((folder / "answers.json").read_text())
    assert [(one["question"], one["status"], len(one["files"])) for one in told] == [
        ("circle", status, many),
        ("skate", status, many),
    ]
    for file in (file for one in told for file in one["files"]):
        found = dofkit.verify(None, folder / file)
        assert (found.failed, found.verified) == ([], 1)
        claim = json.loads((folder / file).read_text())["claims"][0]
        assert (claim["path"], claim["value"]) == ("/feasible", status == "wrong")


@pytest.mark.sweep
def test_answers_without_evidence_say_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # the root has no value where it would be of a negative number: no cofactor does everywhere
    sheet, given, folder = tmp_path / "sheet.yaml", tmp_path / "given.json", tmp_path / "why"
    sheet.write_text(SHEET)
    given.write_text(json.dumps({"student": "cleo", "answers": {"ring": {"circle": "sqrt(x^2 + y^2) = l"}}}))
    assert run(str(sheet), [str(given)], GradingOptions(certificates=folder))
    capsys.readouterr()
    (told,) = json.loads((folder / "answers.json").read_text())
    assert (told["status"], told["files"]) == ("right", [])
    assert told["uncovered"] == "no cofactors were found that do everywhere"


@pytest.mark.sweep
def test_certificates_are_of_the_students_own_scenes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Another particle for each: of both the scene, and the right answer both ways."""
    rod = {"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": 2}
    scene = {"dimension": 2, "particles": ["A"], "constraints": [rod]}
    asked = [{"id": "rod", "ask": "equation", "constraint": "rod"}]
    students = [{"student": "ana"}, {"student": "bo"}]
    sheet = {"title": "T", "problems": [{"id": "p", "scene": scene, "questions": asked, "vary": ["names"]}]}
    varied = {**sheet, "variants": {"seed": "7", "students": students}}
    (tmp_path / "sheet.json").write_text(json.dumps(varied))
    drawer = SheetDrawer(load_assignment(varied))
    lines = []
    for name in ("ana", "bo"):
        x, y = drawer.own(name).keys["p"].coordinates
        lines.append(json.dumps({"student": name, "answers": {"p": {"rod": f"{x}^2 + {y}^2 = 4"}}}))
    assert lines[0][20:] != lines[1][20:]
    (tmp_path / "in.jsonl").write_text("\n".join(lines))
    folder = tmp_path / "why"
    assert run(str(tmp_path / "sheet.json"), [str(tmp_path / "in.jsonl")], GradingOptions(certificates=folder))
    capsys.readouterr()
    told = json.loads((folder / "answers.json").read_text())
    assert [(one["status"], len(one["files"])) for one in told] == [("right", 2)] * 2
    assert len({one["variant"] for one in told}) == 2
    assert len(list(folder.glob("p.????????.json"))) == 2
    for path in folder.glob("p.*.json"):
        found = dofkit.verify(None, path)
        assert (found.failed, found.verified) == ([], found.claims)
