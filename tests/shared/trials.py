"""How a report is held against what is known of a scene."""

from __future__ import annotations

from typing import Any, Literal

from dofkit.benchmark.trials.construction import KnownTruth
from dofkit.report import Report

Outcome = Literal["right", "undecided", "wrong"]


def differences(known: KnownTruth, report: Report) -> tuple[list[str], list[str]]:
    """(what is answered and not true, what is left open)."""
    wrong: list[str] = []
    opened: list[str] = []
    told = {key: (getattr(report, key), report.verdict) for key in known.truth}
    truth: dict[str, Any] = dict(known.truth)
    for entry in report.constraints:
        for key, value in known.labels.get(entry.name, {}).items():
            truth[f"{entry.name}.{key}"] = value
            told[f"{entry.name}.{key}"] = (getattr(entry, key), entry.verdict)
    for key, value in truth.items():
        found, sure = told[key]
        if found == value:
            continue
        open_list = key == "redundant" and report.redundant_equations is None
        left_open = found is None or open_list or sure == "undecided"
        (opened if left_open else wrong).append(f"{key}: {found} told ({sure}), {value} true")
    return wrong, opened


def outcome(known: KnownTruth, report: Report) -> Outcome:
    """Right where everything that is asked is answered and true; wrong where one answer is not true."""
    wrong, opened = differences(known, report)
    return "wrong" if wrong else "undecided" if opened else "right"
