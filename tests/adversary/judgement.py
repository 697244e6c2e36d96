"""A report against the truth, field by field: right, undecided or wrong; and what the checker believes of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from dofkit.benchmark.trials.construction import KnownScene
from dofkit.checker import CheckError, verify
from dofkit.report import Report

#: What the warning of a claim says that was lowered.
CONTRADICTED = "a second program finds otherwise"


class Recheck(NamedTuple):
    """``verified``: fields as a case's truth names them; ``faults``: claims that are refused, with why."""

    verified: frozenset[str] = frozenset()
    faults: Mapping[str, str] = {}


def rechecked(scene: Mapping[str, Any], report: Report) -> Recheck:
    """What the checker says of a report with its certificate; the scene is read again from what was written."""
    certificate = report.certificate or {"claims": []}
    told = {f"contradicted {i}": text for i, text in enumerate(report.warnings) if CONTRADICTED in text}
    if not certificate["claims"]:
        return Recheck(frozenset(), told)
    try:
        found = verify(dict(scene), certificate)
    except CheckError as error:
        return Recheck(frozenset(), {**told, "no certificate": str(error)})
    failed = {one["path"]: f"{one['rule']}: {one['why']}" for one in found.failed}
    paths = [claim["path"] for claim in certificate["claims"] if claim["path"] not in failed]
    faults = {f"unverified {field_of(path)}": why for path, why in failed.items()}
    return Recheck(frozenset(map(field_of, paths)), {**told, **faults})


def field_of(path: str) -> str:
    """A path of a certificate as a case's truth names the field: ``dof``, ``c1.holonomic``."""
    parts = [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")[1:]]
    return ".".join(parts[1:]) if parts[0] == "constraints" else ".".join(parts)


Outcome = Literal["right", "undecided", "wrong"]
#: Fields whose order, or inner order, does not matter.
SETS = ("redundant", "circuit", "conflicting")


class Judgement(NamedTuple):
    field: str
    outcome: Outcome
    told: Any
    truth: Any
    verdict: str


def judged(case: KnownScene, report: Mapping[str, Any]) -> list[Judgement]:
    """Each field of the truth. ``report``: as JSON. A field's own verdict counts where it has one, else that of the
    report or the entry; a value of a smaller part is right where the report says that it speaks of one only."""
    entries = {entry["name"]: entry for entry in report["constraints"]}
    found = []
    for field, truth in case.truth.items():
        owner, _, name = field.rpartition(".")
        told = entries[owner] if owner else report
        own = (told.get("verdicts") or {}).get(name) or {}
        verdict = own.get("verdict", told["verdict"])
        allowed = [truth, *(case.elsewhere.get(field, ()) if own.get("about") == "component" else ())]
        outcome = _outcome(name, told.get(name), truth, allowed, verdict)
        found.append(Judgement(field, outcome, told.get(name), truth, verdict))
    return found


def _outcome(name: str, told: Any, truth: Any, allowed: list[Any], verdict: str) -> Outcome:
    if any(_same(name, told, value) for value in allowed):
        return "right"
    if told is None or verdict == "undecided":
        return "undecided"
    return "wrong"


def _same(name: str, told: Any, value: Any) -> bool:
    if name in SETS and told is not None and value is not None:
        return sorted(told) == sorted(value)
    return isinstance(told, bool) == isinstance(value, bool) and bool(told == value)


def overall(judgements: list[Judgement]) -> Outcome:
    """Wrong where one is, right where all are."""
    outcomes = {one.outcome for one in judgements}
    return "wrong" if "wrong" in outcomes else "undecided" if "undecided" in outcomes else "right"
