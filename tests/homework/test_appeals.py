"""Certificates for appeals: one for each problem, in the folder and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

import dofkit
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
