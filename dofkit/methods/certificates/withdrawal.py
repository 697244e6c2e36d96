"""What is taken back: a claim that a second program does not confirm is undecided, whatever the engines said of it."""

from __future__ import annotations

from typing import Any

from dofkit.base.verdicts import weakest
from dofkit.report import ConstraintEntry, FieldVerdict, Report, ToldModel

OPEN_VERDICT = FieldVerdict(verdict="undecided")


def withdrawn(report: Report, path: str, why: str) -> Report:
    """The report with the claim of a path undecided, and a warning that says why."""
    warning = f"{path} is not told: its certificate was refused ({why})."
    parts = path.split("/")[1:]
    changes: dict[str, Any] = {"warnings": [*report.warnings, warning]}
    if parts[0] == "constraints":
        name = parts[1].replace("~1", "/").replace("~0", "~")
        entries = [_without(e, parts[2]) if e.name == name else e for e in report.constraints]
        changes["constraints"] = entries
    else:
        changes |= _opened(report, parts[0])
    told = report.model_copy(update=changes)
    return told.model_copy(update={"verdict": _weakest(told)})


def _without(entry: ConstraintEntry, field: str) -> ConstraintEntry:
    told = entry.model_copy(update=_opened(entry, field))
    return told.model_copy(update={"verdict": weakest(*(v.verdict for v in told.verdicts.values()))})


def _opened(of: Report | ConstraintEntry, field: str) -> dict[str, Any]:
    """A field's value as what is not known, and its verdict."""
    if field not in of.verdicts:
        return {}
    return {field: _unknown(type(of), field), "verdicts": {**of.verdicts, field: OPEN_VERDICT}}


def _unknown(model: type[ToldModel], field: str) -> Any:
    """None, but for lists that are always there: those are empty."""
    shown = model.model_fields[field]
    return [] if shown.get_default(call_default_factory=True) == [] or "list" in str(shown.annotation)[:5] else None


def _weakest(report: Report) -> Any:
    entries = (v.verdict for e in report.constraints for v in e.verdicts.values())
    return weakest(*(v.verdict for v in report.verdicts.values()), *entries)
