"""Which files are models, and what is said of those that are none."""

from __future__ import annotations

from pathlib import Path

import pytest

import dofkit
from dofkit.base.documents import yaml_text
from dofkit.base.errors import SceneError
from dofkit.models.formats import FORMATS, format_of, is_model
from dofkit.models.model_document import tolerance_of

BEGINNINGS = {
    "<mujoco>": "MJCF",
    "<?xml version='1.0'?>\n<!-- <robot> is in this comment -->\n<mujoco model='a'/>": "MJCF",
    "\ufeff  <robot name='r'>": "URDF",
    "<!DOCTYPE robot><robot/>": "URDF",
    "\xb1\xb2\xb3SolveSpaceREVa\n": "SolveSpace",
}


@pytest.mark.parametrize("text", BEGINNINGS)
def test_a_file_is_known_by_how_it_begins(text: str) -> None:
    data = text.encode("latin-1") if text.startswith("\xb1") else text.encode()
    found = format_of(data)
    assert found is not None
    assert found.title == BEGINNINGS[text]


@pytest.mark.parametrize("text", ["coordinates: [x]", "{}", "", "- <", "<: 1", "x < y"])
def test_a_scene_is_no_model(text: str) -> None:
    assert not is_model(text)
    assert not is_model(text.encode())


def test_every_format_has_a_title_and_a_module() -> None:
    assert len({one.title for one in FORMATS}) == len({one.module for one in FORMATS}) == len(FORMATS)


FAULTS = {
    "<html><body/></html>": "begins with <html>",
    "<mujocoinclude/>": "a part of a model",
    "<robot><link name='a'></robot>": "line 1, column 25: this is not well-formed XML",
    "<robot>" + "<link>" * 300: "nested deeper",
}


@pytest.mark.parametrize("text", FAULTS)
def test_faults_say_what_to_do(text: str, tmp_path: Path) -> None:
    place = tmp_path / "it.xml"
    place.write_text(text)
    with pytest.raises(SceneError) as raised:
        dofkit.load(place)
    assert FAULTS[text] in str(raised.value)
    assert all(fault.hint for fault in raised.value.faults)


def test_entities_are_not_read(tmp_path: Path) -> None:
    """Ten lines would make a billion words."""
    lines = [f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 10)]
    place = tmp_path / "bomb.urdf"
    place.write_text(
        "\n".join(["<?xml version='1.0'?>", '<!DOCTYPE r [<!ENTITY a0 "ha">', *lines, "]>", "<robot>&a9;</robot>"])
    )
    with pytest.raises(SceneError, match="line 2, column 1: entities are not read"):
        dofkit.load(place)


def test_what_is_not_installed_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dofkit.models.formats.find_spec", lambda name: None)
    place = tmp_path / "r.urdf"
    place.write_text("<robot/>")
    with pytest.raises(SceneError, match=r"pip install 'dofkit\[models\]'"):
        dofkit.load(place)


def test_the_tolerance_is_half_of_the_last_digit() -> None:
    assert tolerance_of(["0.7071 0.5 0"], 2.0) == pytest.approx(0.5e-4 / 2)
    assert tolerance_of(["1.5 -2 0.25"], 2.0) == 1e-9
    assert tolerance_of(["0.125"], 0.01) == 1e-3
    assert tolerance_of(["1.234567890123456"], 1.0) == 1e-9


def test_the_text_of_a_scene_is_read_as_it_was() -> None:
    value = {
        "name": "s",
        "dimension": 2,
        "bodies": [{"name": "a", "mass": 1e-07}],
        "constraints": [
            {"name": "a: b, [c]", "type": "revolute", "between": ["ground", "a"], "at": [-0.5, 1e22]},
            {"name": "true", "type": "coupling", "joints": {"q": "a: b, [c]"}, "text": "q = 0"},
        ],
        "left_out": ['it said "no": don\'t'],
    }
    scene = dofkit.loads(yaml_text(value, ("bodies", "constraints", "left_out"), ("a remark",)))
    assert scene == dofkit.load(value)
    assert scene.constraints[0].name == "a: b, [c]"
