"""A report with its certificate: what the evidence contradicts is no longer told as proved."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.base.verdicts import VERDICTS
from dofkit.methods.certificates.certificate import made
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.scene import Scene

_UNDECIDED = FieldVerdict(verdict="undecided")
#: Fields that are null where they are undecided.
_NULLABLE = (
    *("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic", "redundant"),
    *("redundant_equations", "generalized_coordinates", "growth_vector", "integrable_part", "feasible"),
)


def document_of_scene(scene: Scene) -> dict[str, Any]:
    """The document of a scene: what was written, as JSON has it."""
    found: dict[str, Any] = scene.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return {"name": scene.name, **found}


def with_certificate(scene: Scene, report: Report) -> Report:
    """The report with a certificate; a claim whose evidence gives another value is lowered, with a warning."""
    certificate, contradictions = made(document_of_scene(scene), report)
    told = lowered(report, dict(contradictions)) if contradictions else report
    return told.model_copy(update={"certificate": certificate})


def lowered(report: Report, contradictions: Mapping[str, str]) -> Report:
    """The report with the claims at some paths undecided."""
    fields = {path[1:]: why for path, why in contradictions.items() if path.count("/") == 1}
    verdicts = {**report.verdicts, **dict.fromkeys(fields, _UNDECIDED)}
    constraints = [_entry(entry, contradictions) for entry in report.constraints]
    told = [
        f"{path}: a second program finds otherwise ({why}); it is undecided" for path, why in contradictions.items()
    ]
    found = [one.verdict for one in verdicts.values()]
    found += [one.verdict for entry in constraints for one in entry.verdicts.values()]
    return report.model_copy(
        update={
            **{field: None for field in fields if field in _NULLABLE},
            "verdicts": verdicts,
            "constraints": constraints,
            "verdict": max(found, key=VERDICTS.index, default=report.verdict),
            "warnings": [*report.warnings, *told],
        }
    )


def _entry(entry: ConstraintEntry, contradictions: Mapping[str, str]) -> ConstraintEntry:
    name = entry.name.replace("~", "~0").replace("/", "~1")
    fields = [field for field in entry.verdicts if f"/constraints/{name}/{field}" in contradictions]
    if not fields:
        return entry
    told = dict.fromkeys(fields, _UNDECIDED)
    return entry.model_copy(
        update={**dict.fromkeys(fields), "verdicts": {**entry.verdicts, **told}, "verdict": "undecided"}
    )
