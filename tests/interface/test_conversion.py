"""The command `convert`, and models where a scene's file stands."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import dofkit
from dofkit.interface.cli import app

ROBOT = """<robot name='two arms'>
<link name='base'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>
<link name='arm'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>
<joint name='hip: left' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 1 1'/>
<limit lower='-1' upper='1'/></joint>
</robot>
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    place = tmp_path / "arms.urdf"
    place.write_text(ROBOT)
    return place


def test_a_model_becomes_a_file_with_the_same_answer(robot: Path, tmp_path: Path) -> None:
    out = tmp_path / "arms.yaml"
    told = CliRunner().invoke(app, ["convert", str(robot), "--out", str(out)])
    assert (told.exit_code, told.stdout.strip()) == (0, str(out))
    text = out.read_text()
    first, second, *_ = text.splitlines()
    assert first == "# yaml-language-server: $schema=.dofkit-schema.json"
    assert second.startswith("# Made from arms.urdf by dofkit")
    assert json.loads((tmp_path / ".dofkit-schema.json").read_text())["additionalProperties"] is False
    assert 'name: "hip: left"' in text
    assert dofkit.load(out).model_dump() == dofkit.load(robot).model_dump()
    assert dofkit.classify(out).dof == dofkit.classify(robot).dof == 1


def test_a_first_scene_is_written_once_and_is_a_scene(tmp_path: Path) -> None:
    """Two particles in the plane have 4 coordinates; the rail and the rod leave 2."""
    out = tmp_path / "pendulum.yaml"
    assert CliRunner().invoke(app, ["new", str(out)]).exit_code == 0
    assert dofkit.classify(out).dof == 2
    again = CliRunner().invoke(app, ["new", str(out)])
    assert (again.exit_code, "exists" in again.stderr) == (2, True)
    assert dofkit.loads(CliRunner().invoke(app, ["new"]).stdout).title == dofkit.load(out).title
    refused = CliRunner().invoke(app, ["new", "pendulum.txt"])
    assert (refused.exit_code, "there is no ending '.txt'" in refused.stderr) == (2, True)


def test_without_a_path_it_is_printed(robot: Path) -> None:
    told = CliRunner().invoke(app, ["convert", str(robot), "--limits"])
    assert "-1 <= p <= 1" in told.stdout
    assert dofkit.loads(told.stdout).name == "arms"


def test_what_is_no_model_is_said(tmp_path: Path) -> None:
    scene = tmp_path / "a.yaml"
    scene.write_text("coordinates: [x]")
    told = CliRunner().invoke(app, ["convert", str(scene)])
    assert told.exit_code == 2
    assert "is not a model" in told.stderr


def test_classify_reads_a_model_and_tells_its_faults_by_line(robot: Path, tmp_path: Path) -> None:
    bad = tmp_path / "bad.urdf"
    bad.write_text(ROBOT.replace("child link='arm'", "child link='arn'"))
    told = CliRunner().invoke(app, ["classify", "--json", str(robot), str(bad)])
    assert told.exit_code == 2
    right, wrong = map(json.loads, told.stdout.splitlines())
    assert (right["dof"], right["scene"]) == (1, "arms")
    assert "left out: the ranges of joints" in right["modelled"]
    assert (wrong["error"]["line"], wrong["error"]["hint"]) == (4, "did you mean 'arm'?")


def test_limits_are_asked_for(robot: Path) -> None:
    told = CliRunner().invoke(app, ["classify", "--json", "--limits", str(robot)])
    report = json.loads(told.stdout)
    assert [c["type"] for c in report["constraints"]][-1] == "coupling"
    assert report["constraints"][-1]["form"] == "inequality"
    assert dofkit.classify(dofkit.load(robot, limits=True)).feasible is True
