"""Certificates made by hand: for tests only."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.checker.problem import sha256_of
from dofkit.checker.verification import verify

Parts = dict[str, Any]


def certificate(document: Mapping[str, Any], claims: list[Parts], **parts: Any) -> Parts:
    """A certificate of a document."""
    scene = {"name": "scene", "sha256": sha256_of(document)}
    return {"certificate": 1, "scene": scene, **parts, "claims": claims}


def faults(document: Mapping[str, Any], claims: list[Parts], **parts: Any) -> dict[str, str]:
    """The claims that fail, and why."""
    found = verify(document, certificate(document, claims, **parts))
    assert found.claims == len(claims)
    assert found.verified == len(claims) - len(found.failed)
    return {one["path"]: one["why"] for one in found.failed}


def accepted(document: Mapping[str, Any], claims: list[Parts], **parts: Any) -> bool:
    """Whether every claim is verified."""
    return not faults(document, claims, **parts)


def branch(name: str, of: str, factors: list[str], chosen: int, power: int = 1) -> list[Parts]:
    """Steps for one factor of a product, which is 0 where the others are not, and back."""
    rest = "*".join([f"({one})" for i, one in enumerate(factors) if i != chosen] or ["1"])
    base = factors[chosen]
    return [
        {"id": name, "by": "implied", "function": base, "h": rest, "power": power, "c": {of: "1"}},
        {"id": f"{name} back", "by": "implied", "of": of, "c": {name: f"({rest})*({base})^{power - 1}"}},
    ]


def squares(name: str, of: str, terms: list[list[str]]) -> list[Parts]:
    """Steps for the terms c a^2 of a sum that is 0, and back."""
    ids = [f"{name}.{i}" for i in range(1, len(terms) + 1)]
    steps = [
        {
            **{"id": one, "by": "implied", "function": base, "power": 2, "h": c, "c": {of: "1"}},
            "sos": [other for j, other in enumerate(terms) if j != i],
        }
        for i, (one, (c, base)) in enumerate(zip(ids, terms, strict=True))
    ]
    cofactors = {one: f"({c})*({base})" for one, (c, base) in zip(ids, terms, strict=True)}
    return [*steps, {"id": f"{name} back", "by": "implied", "of": of, "c": cofactors}]
