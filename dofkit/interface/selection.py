"""Some fields of a report, and no others."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from dofkit.base.arguments import require_one_of
from dofkit.interface.show.faults import safe
from dofkit.report import Report


def fields_of(asked: Sequence[str]) -> tuple[str, ...]:
    """The fields in lists with commas. Raises ArgumentError, with the nearest field, for what is none."""
    names = tuple(name for text in asked for name in text.replace(",", " ").split())
    for name in names:
        require_one_of(name, Report.model_fields, "field")
    return names


def selection_of(told: Mapping[str, Any], only: Sequence[str]) -> dict[str, Any]:
    """The scene's name and the fields asked for."""
    return {"scene": told["scene"], **{name: told[name] for name in only}}


def selected_line(report: Report, only: Sequence[str]) -> str:
    """``SCENE  dof 4 (proved)``: each field with how sure it is."""
    told = report.model_dump(mode="json", include=set(only))
    parts = []
    for name in only:
        sure = report.verdicts.get(name)
        parts.append(f"{name} {_shown(told[name])}" + ("" if sure is None else f" ({sure.verdict})"))
    return safe("  ".join([report.scene, *parts]))


def _shown(value: Any) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
