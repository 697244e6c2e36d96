"""Right, undecided or wrong: a report against the truth, field by field."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

from dofkit.benchmark.trials.construction import KnownScene

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
