"""A report against the truth, field by field: right, undecided or wrong; and the claims that the checker accepts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from dofkit.benchmark.trials.construction import KnownScene
from dofkit.checker import CheckError, verify
from dofkit.report import Report

#: What the warning of a claim says that was lowered.
CONTRADICTED = "a second program finds otherwise"


def rechecked(scene: Mapping[str, Any], report: Report) -> tuple[list[str], dict[str, str]]:
    """Return the fields whose claims the checker accepts, and the claims that it refuses, with its reasons.

    Fields are named as a case's truth names them. The scene is read again from what was written.
    """
    certificate = report.certificate or {"claims": []}
    refused = {f"contradicted {i}": text for i, text in enumerate(report.warnings) if CONTRADICTED in text}
    if not certificate["claims"]:
        return [], refused
    try:
        failed = {row["path"]: f"{row['rule']}: {row['why']}" for row in verify(dict(scene), certificate).failed}
    except CheckError as error:
        return [], refused | {"no certificate": str(error)}
    paths = [claim["path"] for claim in certificate["claims"] if claim["path"] not in failed]
    return [*map(field_of, paths)], refused | {f"unverified {field_of(path)}": why for path, why in failed.items()}


def field_of(path: str) -> str:
    """Return a path of a certificate as a case's truth names the field: ``dof``, ``c1.holonomic``."""
    parts = [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")[1:]]
    return ".".join(parts[1:]) if parts[0] == "constraints" else ".".join(parts)


Outcome = Literal["right", "undecided", "wrong"]
#: Fields whose order, or inner order, does not matter.
SETS = ("redundant", "circuit", "conflicting")


class Judgement(NamedTuple):
    """A field of the truth, how the report's value compares, that value, the truth, and the verdict."""

    field: str
    outcome: Outcome
    value: Any
    truth: Any
    verdict: str


def judged(case: KnownScene, report: Mapping[str, Any]) -> list[Judgement]:
    """Return a judgement for each field of the truth. ``report``: as JSON.

    A field's own verdict counts where it has one, else that of the report or the entry; a value of a smaller component
    is right where the report says that it speaks of one component only.
    """
    entries = {entry["name"]: entry for entry in report["constraints"]}
    judgements = []
    for field, truth in case.truth.items():
        owner, _, name = field.rpartition(".")
        part = entries[owner] if owner else report
        claim = (part.get("verdicts") or {}).get(name) or {}
        verdict = claim.get("verdict", part["verdict"])
        allowed = [truth, *(case.elsewhere.get(field, ()) if claim.get("about") == "component" else ())]
        value = part.get(name)
        outcome: Outcome = "undecided" if value is None or verdict == "undecided" else "wrong"
        if any(_same(name, value, other) for other in allowed):
            outcome = "right"
        judgements.append(Judgement(field, outcome, value, truth, verdict))
    return judgements


def _same(name: str, value: Any, truth: Any) -> bool:
    if name in SETS and value is not None and truth is not None:
        return sorted(value) == sorted(truth)
    return isinstance(value, bool) == isinstance(truth, bool) and bool(value == truth)


def overall(judgements: list[Judgement]) -> Outcome:
    """Return ``wrong`` where one of them is, ``right`` where all are, else ``undecided``."""
    outcomes = {judgement.outcome for judgement in judgements}
    return "wrong" if "wrong" in outcomes else "undecided" if "undecided" in outcomes else "right"
