"""A share of what `bench_certificates.py` does by the thousand: certificates and scenes that are tampered with."""

from __future__ import annotations

import json
import random
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import CATALOG, few, report_of, scene_of, stem, strict_report_of
from shared.tampering import accepted, asserted, edited, renewed, tampered, untrue

import dofkit
from dofkit.checker import CheckError, verify
from dofkit.methods.certificates.lowering import document_of_scene

#: How many mutations and edits a scene has.
MUTATIONS, EDITS = 30, 3


@cache
def certified(path: Path) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """A scene's document, its report and its certificate, all as JSON."""
    certificate = json.loads(json.dumps(strict_report_of(path).certificate))
    return document_of_scene(scene_of(path)), report_of(path).model_dump(mode="json"), certificate


@pytest.mark.parametrize("path", few("mutated certificates", CATALOG, 12), ids=stem)
def test_a_mutated_certificate_is_refused_or_claims_the_same(path: Path) -> None:
    document, report, certificate = certified(path)
    rng, refused = random.Random(path.stem), 0
    for _ in range(MUTATIONS):
        change = tampered(certificate, rng)
        if change is not None:
            claims = accepted(document, change.certificate)
            refused += claims is None
            assert claims is None or not untrue(claims, report, choices=False), change.told
    assert refused > MUTATIONS // 4


@pytest.mark.parametrize("path", few("edited scenes", CATALOG, 12), ids=stem)
def test_of_an_edited_scene_only_what_is_still_true_is_verified(path: Path) -> None:
    document, _, certificate = certified(path)
    rng = random.Random(path.stem)
    for _ in range(EDITS):
        change = edited(document, rng)
        if change is None:
            continue
        done, scene = change
        try:
            report = dofkit.classify(scene).model_dump(mode="json")
            verification = verify(scene, renewed(certificate, scene))
        except (dofkit.SceneError, CheckError):
            continue
        assert not untrue(asserted(certificate, verification), report), done


@pytest.mark.parametrize("path", few("edited scenes, unsaid", CATALOG, 40), ids=stem)
def test_the_certificate_of_another_scene_is_refused(path: Path) -> None:
    document, _, certificate = certified(path)
    changes = (edited(document, random.Random(seed)) for seed in range(50))
    added = {**document, "coordinates": [*document.get("coordinates", []), "another"]}
    changed = next((change[1] for change in changes if change is not None), added)
    with pytest.raises(CheckError, match="another scene"):
        verify(changed, certificate)
