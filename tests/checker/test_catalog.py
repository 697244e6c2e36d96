"""What is proved of the catalog, and of a tenth of the test scenes, verifies: the rest is listed here, with why."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest
from shared.known_scenes import CATALOG, OURS, few, report_of, scene_of, stem

import dofkit
from dofkit.checker import verify
from dofkit.methods.certificates.certificate import certificate_of
from dofkit.methods.certificates.lowering import document_of_scene

#: What is proved and not verified today: why, and of which scenes. A name may only go.
UNCOVERED: Mapping[str, tuple[str, str]] = {
    "/generalized_coordinates": (
        "angles of Euler, at a pose where they are singular",
        "ball-and-socket-chain block-on-table cylindrical-driven cylindrical-piston lead-screw rccc-linkage "
        "rigid-body-fixed-axis rigid-body-four-bars-space rssr-linkage welded-bracket",
    ),
    "/verdicts/velocity_dof/about": ("forms that depend on each other where both axles stand across", "snakeboard"),
    "/growth_vector": ("steps between the first and the whole", "snakeboard"),
}
#: The least share of the proved claims of all test scenes, and of a tenth, that verify.
LEAST = 0.94


def _shown(path: Path) -> tuple[int, set[str]]:
    """How many proved claims verify, and what is uncovered; none fails, and nothing contradicts the report."""
    document, report = document_of_scene(scene_of(path)), report_of(path)
    certificate, contradicted = certificate_of(document, report)
    verification = verify(document, json.loads(json.dumps(certificate)))
    assert not contradicted
    assert not verification.failed
    probable = {f"/{field}" for field, told in report.verdicts.items() if told.verdict != "proved"}
    return sum(claim["path"] not in probable for claim in certificate["claims"]), set(verification.uncovered)


def test_a_number_that_is_probable_is_shown_by_a_family() -> None:
    """Three parallel cranks of one length move as one, and their relations depend on each other."""
    (path,) = (one for one in {*CATALOG, *OURS} if one.stem == "parallelogram-three-cranks")
    document, report = document_of_scene(scene_of(path)), report_of(path)
    certificate, _ = certificate_of(document, report)
    (claim,) = (one for one in certificate["claims"] if one["path"] == "/dof")
    assert (report.verdicts["dof"].verdict, claim["value"], claim["least"]["rule"]) == ("probable", 1, "family")


@pytest.mark.parametrize("path", few("proofs", CATALOG, 3), ids=stem)
def test_what_is_proved_of_the_catalog_verifies(path: Path) -> None:
    _, uncovered = _shown(path)
    assert uncovered == {claim for claim, (_, names) in UNCOVERED.items() if path.stem in names.split()}


def test_what_is_listed_is_of_the_catalog() -> None:
    assert {name for _, names in UNCOVERED.values() for name in names.split()} <= {path.stem for path in CATALOG}


#: What is measured is not proved, and has no certificate.
EXACT = [path for path in OURS if "\ntolerance:" not in path.read_text(encoding="utf-8")]


@pytest.mark.parametrize("path", few("certificates", EXACT, 20), ids=stem)
def test_no_claim_of_a_test_scene_fails(path: Path) -> None:
    _shown(path)


@pytest.mark.sweep
def test_most_of_what_is_proved_of_the_test_scenes_verifies() -> None:
    """Counted on every third of them; that none fails is asked of all."""
    counts = Counter[bool]()
    for path in EXACT[::3]:
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
    assert report.certificate is not None
    assert report.dof == 2
    verification = dofkit.verify(scene, report.certificate)
    assert verification.verified > 0
    assert not verification.failed
