"""What is proved of the catalog, and of a tenth of the test scenes, verifies: the rest is listed here, with why."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest
from shared.known_scenes import CATALOG, OURS, few, report_of, scene_of, stem

from dofkit.checker import verify
from dofkit.methods.certificates.certificate import made
from dofkit.methods.certificates.lowering import document_of_scene

#: What is proved and not verified today: why, and of which scenes. A name may only go.
UNCOVERED: Mapping[str, tuple[str, str]] = {
    "/consistent": (
        "no evidence is found",
        "particle-inside-expanding-sphere",
    ),
    "/constraints/along_x/integral": (
        "the integral: the two sides are not the same",
        "disc-rolling-along-straight-line",
    ),
    "/constraints/along_y/integral": (
        "the integral: the two sides are not the same",
        "disc-rolling-along-straight-line",
    ),
    "/dof": (
        "no evidence is found",
        "lead-screw",
    ),
    "/generalized_coordinates": (
        "no evidence is found",
        "ball-and-socket-chain block-on-table cylindrical-driven cylindrical-piston lead-screw rccc-linkage "
        "rigid-body-fixed-axis rigid-body-four-bars-space rssr-linkage welded-bracket",
    ),
    "/integrable_part": (
        "the minor is not of the basis",
        "disc-rolling-along-straight-line",
    ),
    "/redundancies": (
        "a field is missing or of another kind ('/redundant_equations')",
        "lead-screw",
    ),
    "/redundant": (
        "no evidence is found",
        "lead-screw",
    ),
    "/redundant_equations": (
        "a field is missing or of another kind ('/velocity_dof')",
        "lead-screw",
    ),
    "/velocity_dof": (
        "a field is missing or of another kind ('/dof about')",
        "lead-screw",
    ),
    "/verdicts/dof/about": (
        "shown near a point, told of everywhere",
        "bead-on-fixed-rod bead-on-rotating-rod block-on-movable-wedge-equation "
        "disc-rolling-along-straight-line disc-rolling-on-line disc-rolling-on-plane "
        "disc-string-no-slip-equation hoist non-holonomic-definition particle-on-longitude rolling-ball "
        "rolling-ball-euler-angles sphere-rolling-and-pinned-height velocities-that-integrate x-dy-plus-y-dx",
    ),
    "/verdicts/velocity_dof/about": (
        "shown near a point, told of everywhere",
        "disc-rolling-along-straight-line disc-rolling-on-line disc-rolling-on-plane "
        "disc-string-no-slip-equation non-holonomic-definition rolling-ball rolling-ball-euler-angles "
        "sphere-rolling-and-pinned-height velocities-that-integrate x-dy-plus-y-dx",
    ),
}
#: The least share of the proved claims of all test scenes, and of a tenth, that verify.
LEAST = 0.92


def _shown(path: Path) -> tuple[int, set[str]]:
    """How many claims verify, and what is uncovered; none fails, and nothing contradicts the report."""
    document = document_of_scene(scene_of(path))
    certificate, contradicted = made(document, report_of(path))
    found = verify(document, json.loads(json.dumps(certificate)))
    assert not contradicted
    assert not found.failed
    return found.verified, set(found.uncovered)


@pytest.mark.parametrize("path", CATALOG, ids=stem)
def test_what_is_proved_of_the_catalog_verifies(path: Path) -> None:
    _, uncovered = _shown(path)
    assert uncovered == {claim for claim, (_, names) in UNCOVERED.items() if path.stem in names.split()}


def test_what_is_listed_is_of_the_catalog() -> None:
    assert {name for _, names in UNCOVERED.values() for name in names.split()} <= {path.stem for path in CATALOG}


#: What is measured is not proved, and has no certificate.
EXACT = [path for path in OURS if scene_of(path).tolerance is None]


@pytest.mark.parametrize("path", few("certificates", EXACT, 10), ids=stem)
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
