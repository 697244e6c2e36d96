"""A report with its certificate: what the evidence contradicts is no longer told as proved."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from dofkit.base.verdicts import VERDICTS
from dofkit.expressions.text.characters import DEGREE, GREEK_LETTERS
from dofkit.methods.certificates.certificate import made
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.scene import Scene, survey_of
from dofkit.scene.synonyms import SAID, with_plain_subscripts

_UNDECIDED = FieldVerdict(verdict="undecided")
#: Fields that are null where they are undecided.
_NULLABLE = (
    *("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic", "redundant"),
    *("redundant_equations", "generalized_coordinates", "growth_vector", "integrable_part", "feasible"),
)


#: A number of degrees; `deg` where that is no declared name.
_DEGREES = re.compile(
    rf"(?<![\w.{GREEK_LETTERS}])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[ \t]*(?:{DEGREE}|(deg(?:rees?)?)(?!\w))",
    re.ASCII,
)


def document_of_scene(scene: Scene) -> dict[str, Any]:
    """The document of a scene as JSON has it: what was written, in standard words, its angles in radians."""
    found: dict[str, Any] = scene.model_dump(mode="json", by_alias=True, exclude_unset=True)
    unit = partial(_unit, scene)
    return {"name": scene.name, **{key: part if key in SAID else _plain(part, unit) for key, part in found.items()}}


def _unit(scene: Scene, match: re.Match[str]) -> str:
    """A number of degrees in radians; ``deg`` that is a declared name stays."""
    declared = match[2] and survey_of(scene).names.lookup.meaning(match[2]) is not None
    return match[0] if declared else f"({match[1]}*pi/180)"


def _plain(value: Any, unit: Callable[[re.Match[str]], str]) -> Any:
    if isinstance(value, str):
        return _DEGREES.sub(unit, with_plain_subscripts(value)) if "deg" in value or not value.isascii() else value
    if isinstance(value, dict):
        return {key: _plain(part, unit) for key, part in value.items()}
    return [_plain(part, unit) for part in value] if isinstance(value, list) else value


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
