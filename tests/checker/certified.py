"""Certificates made by hand: for tests only."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.base.documents import read_document
from dofkit.checker.problem import sha256_of
from dofkit.checker.verification import verify

Parts = dict[str, Any]


def document_of(text: str) -> Any:
    """What a text writes in YAML or JSON."""
    return read_document(text, "scene").value


def certificate(document: Mapping[str, Any], claims: list[Parts], **parts: Any) -> Parts:
    """A certificate of a document."""
    scene = {"name": "scene", "sha256": sha256_of(document)}
    return {"certificate": 1, "scene": scene, **parts, "claims": claims}


def faults(document: Mapping[str, Any], claims: list[Parts], **parts: Any) -> dict[str, str]:
    """The claims that fail, and why."""
    verification = verify(document, certificate(document, claims, **parts))
    assert verification.claims == len(claims)
    assert verification.verified == len(claims) - len(verification.failed)
    return {one["path"]: one["why"] for one in verification.failed}
