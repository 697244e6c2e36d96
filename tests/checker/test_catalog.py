"""What is proved of the catalog, and of a tenth of the test scenes, verifies: the rest is listed here, with why."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest
from checker.certified import document_of
from shared.known_scenes import CATALOG, OURS, few, report_of, scene_of, stem, strict_report_of, verdicts_of

import dofkit
from dofkit.checker import verify
from dofkit.methods.certificates.lowering import document_of_scene

#: What is proved and not verified today: why, and of which scenes. A name may only go.
UNCOVERED: Mapping[str, tuple[str, str]] = {
    "/generalized_coordinates": (
        "angles of Euler, at a pose where they are singular and none turns about the axis",
        "frame-held-fast-in-space universal-joint-alone",
    ),
    "/verdicts/velocity_dof/about": ("forms that depend on each other where both axles stand across", "snakeboard"),
    "/growth_vector": ("steps between the first and the whole", "snakeboard"),
}
#: The least share of the proved claims of all test scenes that verify.
LEAST = 0.98


def _shown(path: Path) -> tuple[int, set[str]]:
    """How many proved claims verify, and what is uncovered; none fails, and nothing contradicts the report."""
    report = strict_report_of(path)
    scene = document_of(path.read_text("utf-8")) if path in CATALOG else document_of_scene(scene_of(path))
    verification = verify(scene, json.dumps(report.certificate))
    assert not verification.failed
    assert not any("a second program" in warning for warning in report.warnings)
    return sum(told.verdict == "proved" for _, _, told in verdicts_of(report)), set(verification.uncovered)


def _expected(path: Path) -> set[str]:
    """The paths of the fields that a scene expects."""
    expect = dict(scene_of(path).expect or {})
    of_constraints = expect.pop("constraints", {}).items()
    return {f"/{key}" for key in expect} | {
        f"/constraints/{name}/{key}" for name, keys in of_constraints for key in keys
    }


@pytest.mark.parametrize("path", CATALOG, ids=stem)
def test_what_the_catalog_expects_as_proved_is_checked(path: Path) -> None:
    proved = {field for field, _, told in verdicts_of(report_of(path)) if told.verdict == "proved"}
    checked = {field for field, _, told in verdicts_of(strict_report_of(path)) if told.verdict == "proved"}
    assert (proved - checked) & _expected(path) == _uncovered(path) & _expected(path)


def _uncovered(path: Path) -> set[str]:
    return {claim for claim, (_, names) in UNCOVERED.items() if path.stem in names.split()}


@pytest.mark.parametrize("path", few("proofs", CATALOG, 3), ids=stem)
def test_what_is_proved_of_the_catalog_verifies(path: Path) -> None:
    _, uncovered = _shown(path)
    assert uncovered == _uncovered(path)


def test_what_is_listed_is_of_the_catalog() -> None:
    assert {name for _, names in UNCOVERED.values() for name in names.split()} <= {path.stem for path in CATALOG}


#: What is measured is not proved, and has no certificate.
EXACT = [path for path in OURS if "\ntolerance:" not in path.read_text(encoding="utf-8")]


@pytest.mark.parametrize("path", few("certificates", EXACT, 20), ids=stem)
def test_no_claim_of_a_test_scene_fails(path: Path) -> None:
    _shown(path)


@pytest.mark.sweep
def test_most_of_what_is_proved_of_the_test_scenes_verifies() -> None:
    counts = Counter[bool]()
    for path in EXACT:
        verified, uncovered = _shown(path)
        counts[True] += verified
        counts[False] += sum(1 for one in uncovered if not one.startswith("/verdicts/"))
    assert counts[True] >= LEAST * counts.total()


def test_hyphens_of_particles_and_bodies() -> None:
    """The coordinates of `k-1` are x_k_1 and y_k_1, for the checker too."""
    scene = {
        "dimension": 2,
        "particles": ["k-1", "k-2"],
        "constraints": [{"type": "link", "between": ["k-1", "k-2"], "length": 1}, "y_k_1 = 0"],
    }
    report = dofkit.classify(scene, certificate=True)
    verification = dofkit.verify(scene, report.certificate or {})
    assert (report.dof, verification.failed, verification.verified > 0) == (2, [], True)
