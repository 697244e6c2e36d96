"""A scene with what is true of it, and how an answer is held against that. Nothing here asks dofkit what is true."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from dofkit.report import Report

Outcome = Literal["right", "undecided", "wrong"]


@dataclass(frozen=True)
class Trial:
    """A scene and what is true of it.

    ``truth`` by report key; ``labels`` by constraint and key. Trials of one ``group`` belong together.
    """

    group: str
    name: str
    scene: Mapping[str, Any]
    truth: Mapping[str, Any]
    labels: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def differences(trial: Trial, report: Report) -> tuple[list[str], list[str]]:
    """(what is answered and not true, what is left open)."""
    wrong, opened = [], []
    told = {key: (getattr(report, key), report.verdict) for key in trial.truth}
    truth: dict[str, Any] = dict(trial.truth)
    for entry in report.constraints:
        for key, value in trial.labels.get(entry.name, {}).items():
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


def outcome(trial: Trial, report: Report) -> Outcome:
    """Right where everything that is asked is answered and true; wrong where one answer is not true."""
    wrong, opened = differences(trial, report)
    return "wrong" if wrong else "undecided" if opened else "right"


def scene(coordinates: Sequence[str], *constraints: Any, **more: Any) -> dict[str, Any]:
    """A scene in coordinates alone."""
    return {"coordinates": list(coordinates), "constraints": list(constraints), **more}
