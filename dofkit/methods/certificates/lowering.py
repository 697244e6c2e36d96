"""A report with its certificate: what the evidence contradicts is no longer told as proved."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

from dofkit.base.verdicts import weakest
from dofkit.expressions.text.characters import DEGREE, GREEK_LETTERS
from dofkit.methods.certificates.certificate import Certifying
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.lowering import survey_of
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import SAID, with_plain_subscripts

_UNDECIDED = FieldVerdict(verdict="undecided")
#: What fields are where they are undecided; the others stay as they are.
_OPEN: Mapping[str, Any] = {
    **dict.fromkeys(("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic")),
    **dict.fromkeys(("redundant", "redundant_equations", "generalized_coordinates", "growth_vector")),
    **dict.fromkeys(("integrable_part", "feasible")),
    **{"redundancies": [], "conflicting": [], "infeasible": []},
}


#: A number of degrees; `deg` where that is no declared name.
_DEGREES = re.compile(
    rf"(?<![\w.{GREEK_LETTERS}])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[ \t]*(?:{DEGREE}|(deg(?:rees?)?)(?!\w))",
    re.ASCII,
)


def document_of_scene(scene: Scene) -> dict[str, Any]:
    """The document of a scene as JSON has it: what was written, in standard words, its angles in radians."""
    document: dict[str, Any] = scene.model_dump(mode="json", by_alias=True, exclude_unset=True)
    unit = partial(_unit, scene)
    return {"name": scene.name, **{key: part if key in SAID else _plain(part, unit) for key, part in document.items()}}


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
    """Return the report with a certificate; a claim whose evidence gives another value is lowered, with a warning."""
    making = Certifying(document_of_scene(scene), report)
    certificate = making.written()
    against = making.contradictions
    if against:
        report = lowered(report, {**against, **_doubted(report, against, certificate["uncovered"])})
    return report.model_copy(update={"certificate": certificate})


def _doubted(report: Report, contradictions: Mapping[str, str], uncovered: list[str]) -> dict[str, str]:
    """Return the claims without evidence that rest on the argument of one that failed, or on consistency that did."""
    verdicts = {path: verdict for path, _, verdict in told_fields(report)}
    failed = {verdicts[path].argument: path for path in contradictions}
    doubted = {}
    for path in uncovered:
        verdict = verdicts.get(path)
        if verdict is not None and verdict.argument in failed:
            doubted[path] = f"it rests on the argument of {failed[verdict.argument]}"
        elif verdict is not None and "/consistent" in contradictions and path.count("/") == 1:
            doubted[path] = "it rests on /consistent"
    return doubted


def told_fields(report: Report) -> Iterator[tuple[str, Any, FieldVerdict]]:
    """Every field with a verdict: its path, its value and how sure it is."""
    for field, verdict in report.verdicts.items():
        yield f"/{field}", getattr(report, field), verdict
    for entry in report.constraints:
        for field, verdict in entry.verdicts.items():
            yield f"{_entry_path(entry)}/{field}", getattr(entry, field), verdict


def _entry_path(entry: ConstraintEntry) -> str:
    return "/constraints/" + entry.name.replace("~", "~0").replace("/", "~1")


def lowered(report: Report, contradictions: Mapping[str, str]) -> Report:
    """Return the report with the claims at some paths undecided, and why in its warnings."""
    fields = {
        path[1:]: _OPEN.get(path[1:], getattr(report, path[1:])) for path in contradictions if path.count("/") == 1
    }
    warnings = [
        f"{path}: a second program finds otherwise ({why}); it is undecided" for path, why in contradictions.items()
    ]
    changes = {
        **fields,
        "verdicts": {**report.verdicts, **dict.fromkeys(fields, _UNDECIDED)},
        "constraints": [_entry(entry, contradictions) for entry in report.constraints],
        "verdict": weakest(report.verdict, "undecided"),
        "warnings": [*report.warnings, *warnings],
    }
    return report.model_copy(update=changes)


def _entry(entry: ConstraintEntry, contradictions: Mapping[str, str]) -> ConstraintEntry:
    start = _entry_path(entry)
    fields = [field for field in entry.verdicts if f"{start}/{field}" in contradictions]
    if not fields:
        return entry
    verdicts = {**entry.verdicts, **dict.fromkeys(fields, _UNDECIDED)}
    return entry.model_copy(update={**dict.fromkeys(fields), "verdicts": verdicts, "verdict": "undecided"})
