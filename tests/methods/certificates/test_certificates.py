"""Certificates of reports: what is proved is shown again, what is told wrongly is not."""

from __future__ import annotations

import json
from typing import Any

import pytest

import dofkit
from dofkit.methods.certificates.certificate import Certifying
from dofkit.methods.certificates.lowering import document_of_scene, with_certificate
from dofkit.report import Report

FOUR_BAR = "four-bar-linkage"
SKATE = {"name": "skate", "coordinates": ["x", "y", "theta"], "constraints": ["sin(theta) dx - cos(theta) dy = 0"]}
SQUARE = {
    "name": "square",
    "dimension": 2,
    "particles": ["A", "B", "C", "D"],
    "constraints": [
        {"type": "link", "between": pair}
        for pair in (["A", "B"], ["B", "C"], ["C", "D"], ["D", "A"], ["A", "C"], ["B", "D"])
    ],
}


def certified(scene: Any, **changes: Any) -> tuple[dict[str, Any], dict[str, str]]:
    """The certificate of a report, some of whose fields were changed, and what it contradicts."""
    loaded = dofkit.load(scene)
    making = Certifying(document_of_scene(loaded), dofkit.classify(loaded).model_copy(update=changes))
    return making.written(), making.contradictions


def test_a_linkage_is_covered_whole() -> None:
    certificate, failed = certified(FOUR_BAR)
    assert (certificate["uncovered"], failed) == ([], {})
    assert len(json.dumps(certificate)) < 6000


def test_the_same_report_has_the_same_certificate() -> None:
    assert certified(SKATE) == certified(SKATE)


def test_a_skate_reaches_every_pose() -> None:
    certificate, _ = certified(SKATE)
    claims = {claim["path"]: claim for claim in certificate["claims"]}
    assert claims["/dof"]["value"] == 3
    assert claims["/dof"]["least"]["words"][-1][1:] != []
    assert claims["/constraints/c1/holonomic"]["rule"] == "bracket"
    assert claims["/growth_vector"]["value"] == [2, 3]


def test_a_redundant_link_is_covered_by_rigid_motions() -> None:
    # Six links between four points of the plane: 8 coordinates less 3 rigid motions leave 5 rows.
    certificate, failed = certified(SQUARE)
    claims = {claim["path"]: claim["value"] for claim in certificate["claims"]}
    assert (claims["/dof"], claims["/redundant"], claims["/constraints/c6/independent"], failed) == (3, ["c6"], 0, {})
    assert len(certificate["covers"][0]["blocks"][0]["fields"]) == 3


@pytest.mark.parametrize(
    ("scene", "changes", "path"),
    [
        (FOUR_BAR, {"dof": 2}, "/dof"),
        (FOUR_BAR, {"instantaneous_dof": 3}, "/instantaneous_dof"),
        ({"coordinates": ["x", "y"], "constraints": ["x = 2 y"]}, {"redundant_equations": 1}, "/redundant_equations"),
        ({"coordinates": ["x", "y"], "constraints": ["x = 2 y"]}, {"holonomic": False}, "/holonomic"),
    ],
)
def test_what_is_reported_wrongly_is_contradicted(scene: Any, changes: dict[str, Any], path: str) -> None:
    certificate, failed = certified(scene, **changes)
    assert path in failed
    assert failed[path].startswith("the evidence gives")
    assert path not in {claim["path"] for claim in certificate["claims"]}
    assert path not in certificate["uncovered"]


def test_a_contradicted_number_is_undecided() -> None:
    scene = dofkit.load(FOUR_BAR)
    wrong: Report = dofkit.classify(scene).model_copy(update={"dof": 2})
    found = with_certificate(scene, wrong)
    assert (found.dof, found.verdicts["dof"].verdict, found.verdict) == (None, "undecided", "undecided")
    assert any("/dof" in line and "second program" in line for line in found.warnings)
    assert found.certificate is not None


def test_verdicts_say_whether_they_are_checked() -> None:
    scene = dofkit.load("universal-joint-alone")
    report = dofkit.classify(scene)
    assert {verdict.checked for verdict in report.verdicts.values()} == {None}
    checked = {field: verdict.checked for field, verdict in with_certificate(scene, report).verdicts.items()}
    # The joint turns about x and y; phi turns about z at this pose and theta about x: no chart of it.
    assert [field for field, accepted in checked.items() if not accepted] == ["generalized_coordinates"]
    strict = with_certificate(scene, report, strict=True)
    assert (strict.verdict, strict.verdicts["generalized_coordinates"].verdict) == ("probable", "probable")
    assert strict.verdicts["dof"].verdict == "proved"
    assert Report.model_validate(strict.model_dump(mode="json")) == strict
    wrong = report.model_copy(update={"instantaneous_dof": 5})
    assert with_certificate(scene, wrong).verdicts["instantaneous_dof"].checked is False


@pytest.mark.parametrize(
    ("texts", "path", "value"),
    [
        (["y z dx - z^2 dy - x y dz = 0"], "/constraints/c1/integral", "x/z - log(y) = C"),
        (["(xdot - 2) sin(y) = zdot cos(y)", "xdot sin(y) = zdot cos(y)"], "/constraints/c1/catastatic", False),
    ],
)
def test_a_point_is_found_where_a_claim_shows(texts: list[str], path: str, value: Any) -> None:
    """The logarithm has no value at the first point tried; where y is 0, as everywhere on the set, dt has no factor."""
    certificate, failed = certified({"coordinates": ["x", "y", "z"], "constraints": texts})
    assert (failed, [claim["value"] for claim in certificate["claims"] if claim["path"] == path]) == ({}, [value])


@pytest.mark.parametrize(("more", "about", "checked"), [([], "everywhere", True), ([[6, 0]], "component", False)])
def test_a_strict_number_is_about_the_points_for_which_it_is_shown(more: list[Any], about: str, checked: bool) -> None:
    """The evidence for a double pendulum is about all of it, that for a four-bar linkage about a point."""
    ends = zip([[0, 0], "A", "B"], ["A", "B", *more], [2, 5, 4], strict=False)
    links = [{"type": "link", "between": [*pair], "length": length} for *pair, length in ends]
    scene = dofkit.load({"dimension": 2, "particles": ["A", "B"], "constraints": links})
    report = dofkit.classify(scene)
    told = {field: with_certificate(scene, report).verdicts[field].checked for field in ("dof", "velocity_dof")}
    assert (report.verdicts["dof"].about, told) == ("everywhere", {"dof": checked, "velocity_dof": checked})
    strict = with_certificate(scene, report, strict=True).verdicts
    shown = [(strict[field].verdict, strict[field].about) for field in ("dof", "velocity_dof")]
    assert shown == [("proved", about)] * 2


@pytest.mark.parametrize(
    ("constraints", "members"),
    [
        (["x = 0", "y = 0", "x = 1"], ["c1", "c3"]),
        (["x^2 + y^2 = -1"], ["c1"]),
        (["x = 1", "xdot = 1"], ["c1", "c2"]),
        (["t = 1"], ["c1"]),
    ],
)
def test_contradictions_are_refuted(constraints: list[str], members: list[str]) -> None:
    certificate, failed = certified({"coordinates": ["x", "y"], "constraints": constraints})
    claims = {claim["path"]: claim for claim in certificate["claims"]}
    assert (claims["/consistent"]["value"], failed) == (False, {})
    assert claims.get("/conflicting", {"value": members})["value"] == members


def test_measured_scenes_show_only_what_is_written() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x = 2 y"], "tolerance": "1/1000"}
    certificate, failed = certified(scene)
    assert {claim["rule"] for claim in certificate["claims"]} == {"finite", "timeless", "count"}
    assert not failed


def test_a_certificate_is_of_json() -> None:
    certificate, _ = certified("rolling-ball-euler-angles")
    assert json.loads(json.dumps(certificate)) == certificate


def test_what_a_cover_of_another_claim_gives_is_not_counted_on() -> None:
    """One of the ball's equations follows by a cover, of which a claim that was left out counted the rod's row."""
    place = {"on": "plate", "at": [-1, 2, 1]}
    scene = {
        "bodies": ["plate", "sleeve"],
        "particles": [{"name": "P", "at": [-1, 2, 1]}, {"name": "Q", "at": [1, -1, 0]}],
        "constraints": [
            {
                "name": "shaft",
                "type": "cylindrical",
                "between": ["ground", "sleeve"],
                "at": [0, 2, 1],
                "axis": [0, 1, 0],
            },
            {"name": "ball", "type": "spherical", "between": ["ground", "sleeve"], "at": [1, 2, -1]},
            {"name": "pin", "type": "coincident", "between": ["P", place]},
            {"name": "rod", "type": "link", "between": ["Q", place]},
        ],
    }
    report = dofkit.classify(scene, certificate=True)
    assert [entry.independent for entry in report.constraints] == [4, 2, 3, 1]
    assert report.certificate is not None
    assert dofkit.verify(scene, report.certificate).failed == []
