"""Certificates on the command line: written by `classify`, rechecked by `verify`, with a status for each outcome."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from checker.certified import document_of
from shared.command_line import called
from shared.known_scenes import OURS, spread

import dofkit
from dofkit.checker.problem import sha256_of


@pytest.fixture
def made(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    """A pendulum's certificate, and where it is."""
    scene = tmp_path / "pendulum.yaml"
    scene.write_text("dimension: 2\ncoordinates: [x, y]\nconstraints:\n- x^2 + y^2 = 1\n")
    place = tmp_path / "why" / "pendulum.json"
    status, _, err = called(capsys, "classify", str(scene), "--certificate", str(place))
    assert (status, err) == (0, "")
    return {"scene": scene, "place": place, "certificate": json.loads(place.read_text())}


def test_a_certificate_is_verified_with_its_scene_and_alone(
    made: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    for given in ([str(made["scene"]), str(made["place"])], [str(made["place"])]):
        status, out, err = called(capsys, "verify", "--strict", *given)
        assert (status, err) == (0, "")
        assert out.startswith("pendulum: ")
        assert "claims verified" in out
    status, out, _ = called(capsys, "verify", "--json", str(made["place"]))
    document = json.loads(out)
    assert (status, document["failed"], document["uncovered"]) == (0, [], [])
    assert document["claims"] == document["verified"] == len(made["certificate"]["claims"])


#: A singular configuration: for its degrees of freedom no rule is known.
FLATTENED = next(path for path in OURS if path.stem == "parallelogram-flattened")


def test_a_strict_report_calls_nothing_proved_that_has_no_evidence(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = called(capsys, "classify", "--strict", "--json", str(FLATTENED))
    assert (status, err) == (0, "")
    verdicts = json.loads(out)["verdicts"].values()
    assert {verdict["checked"] for verdict in verdicts if verdict["verdict"] == "proved"} == {True}
    assert any(verdict["verdict"] == "probable" for verdict in verdicts)


def test_a_false_claim_ends_with_1(made: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    claim = next(c for c in made["certificate"]["claims"] if c["path"] == "/dof")
    claim["value"] = 2
    made["place"].write_text(json.dumps(made["certificate"]))
    status, out, _ = called(capsys, "verify", str(made["scene"]), str(made["place"]))
    assert status == 1
    assert "failed     /dof by" in out


@pytest.mark.sweep
def test_what_is_uncovered_ends_with_1_where_it_is_strict(
    made: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    claims = made["certificate"]["claims"]
    made["certificate"]["claims"] = [c for c in claims if c["path"] != "/singular"]
    made["certificate"]["uncovered"].append("/singular")
    made["place"].write_text(json.dumps(made["certificate"]))
    assert called(capsys, "verify", str(made["place"]))[0] == 0
    status, out, _ = called(capsys, "verify", "--strict", str(made["place"]))
    assert status == 1
    assert "uncovered  /singular" in out


@pytest.mark.parametrize(
    "text", spread(["{", "[]", "{}", '{"certificate": 2}', "null", "", '{"certificate": 1, "scene": 5}'])
)
def test_what_is_no_certificate_ends_with_2(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = tmp_path / "bad.json"
    place.write_text(text)
    status, out, err = called(capsys, "verify", str(place))
    assert (status, out) == (2, "")
    assert "error" in err
    status, out, _ = called(capsys, "verify", "--json", str(place))
    assert status == 2
    assert json.loads(out)["error"]["message"]


@pytest.mark.sweep
def test_another_scene_or_none_ends_with_2(made: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    for scene, message in (("four-bar-linkage", "another scene"), ("none.yaml", "none.yaml: error: there is no file")):
        status, _, err = called(capsys, "verify", scene, str(made["place"]))
        assert (status, message in err) == (2, True)


def test_several_certificates_go_to_a_folder_and_none_hides_another(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "same.yaml").write_text("coordinates: [x, y]\nconstraints:\n- x = y\n")
    given = [str(tmp_path / folder / "same.yaml") for folder in ("a", "b")]
    status, _, _ = called(capsys, "classify", *given, "--certificate", str(tmp_path / "out"))
    assert status == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["same-2.json", "same.json"]


def test_a_place_that_cannot_be_written_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    status, _, err = called(capsys, "classify", "four-bar-linkage", "--certificate", str(tmp_path / "file" / "x.json"))
    assert status == 2
    assert "cannot be written" in err


def test_the_door_takes_a_scene_in_every_way(tmp_path: Path) -> None:
    report = dofkit.classify("four-bar-linkage", certificate=True)
    assert report.certificate is not None
    place = tmp_path / "c.json"
    place.write_text(json.dumps(report.certificate))
    scene = dofkit.load("four-bar-linkage")
    written = scene.model_dump(mode="json", exclude_unset=True)
    for given in ("four-bar-linkage", scene, written, None):
        for certificate in (report.certificate, place, str(place), place.read_text(), place.read_bytes()):
            verification = dofkit.verify(given, certificate)
            assert (verification.failed, verification.verified) == ([], verification.claims)
    odd: Any = 5
    with pytest.raises(dofkit.DofkitError, match="is a mapping, a path or JSON"):
        dofkit.verify(scene, odd)


@pytest.mark.sweep
def test_a_scene_in_other_words_is_verified_in_standard_ones(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene, place = tmp_path / "hinge.yaml", tmp_path / "why.json"
    scene.write_text(
        "dimension: 2\nbodies: [a]\ncoordinates: [s₁]\njoints:\n- {type: hinge, between: [ground, a], at: [0, 0]}\n"
        'constraints:\n- {name: q, text: "s₁ = 2 sin 30° + 1/2 theta_a"}\n',
        encoding="utf-8",
    )
    assert called(capsys, "classify", str(scene), "--certificate", str(place))[0] == 0
    for given in ([str(scene), str(place)], [str(place)]):
        status, out, err = called(capsys, "verify", *given)
        assert (status, err) == (0, "")
        assert "claims verified" in out
        assert "failed" not in out


@pytest.mark.sweep
def test_equations_of_motion_have_a_certificate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A bead on a parabola: one claim, which is verified, and refused for another mass."""
    scene, place = tmp_path / "bead.yaml", tmp_path / "why" / "bead.json"
    scene.write_text(
        "dimension: 2\nparameters: {m: positive, g: positive}\nparticles: [{name: P, coordinates: [x, y], mass: m}]\n"
        "constraints: [y = x^2]\nforces: [{type: gravity, acceleration: g}]\n"
    )
    status, out, err = called(capsys, "lagrange", str(scene), "--certificate", str(place))
    assert (status, err) == (0, "")
    assert "Equations of motion" in out
    status, out, _ = called(capsys, "verify", "--strict", str(scene), str(place))
    assert (status, out) == (0, "bead: 1 of 1 claims verified\n")
    scene.write_text(scene.read_text().replace("mass: m", "mass: 2 m"))
    certificate = json.loads(place.read_text())
    certificate["scene"]["sha256"] = sha256_of(document_of(scene.read_text()))
    place.write_text(json.dumps(certificate))
    status, out, _ = called(capsys, "verify", str(scene), str(place))
    assert status == 1
    assert "failed     /motion by lagrange: the Lagrangian" in out
