"""A report with its certificate: what the evidence contradicts is no longer told as proved."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

from dofkit.base.verdicts import weakest
from dofkit.expressions.text.characters import DEGREE, GREEK_LETTERS
from dofkit.methods.certificates.certificate import Certifying
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.lowering import survey_of
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import SAID, with_plain_subscripts

_UNDECIDED = FieldVerdict(verdict="undecided")


class Contradiction(NamedTuple):
    """Why a claim cannot be, and the value that was shown instead (None: only that it is not what is told)."""

    why: str
    shown: Any = None


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


def with_certificate(scene: Scene, report: Report, again: Callable[[], Report] | None = None) -> Report:
    """The report with a certificate; a claim whose evidence gives another value is lowered, with a warning.

    ``again``: asks an engine whose answers are probable for the whole report, where a claim was lowered.
    """
    making = Certifying(document_of_scene(scene), report)
    certificate = making.written()
    told = report
    if making.contradictions:
        against = {path: Contradiction(why, making.shown.get(path)) for path, why in making.contradictions.items()}
        against |= _doubted(report, against, certificate["uncovered"])
        told = lowered(report, against, None if again is None else again())
    return told.model_copy(update={"certificate": certificate})


def _doubted(
    report: Report, contradictions: Mapping[str, Contradiction], uncovered: list[str]
) -> dict[str, Contradiction]:
    """Claims without evidence of their own that rest on the argument of one that failed, or on consistency that did."""
    verdicts = {path: verdict for path, _, verdict in told_fields(report)}
    failed = {verdicts[path].argument: path for path in contradictions}
    found = {}
    for path in uncovered:
        verdict = verdicts.get(path)
        if verdict is not None and verdict.argument in failed:
            found[path] = Contradiction(f"it rests on the argument of {failed[verdict.argument]}")
        elif verdict is not None and "/consistent" in contradictions and path.count("/") == 1:
            found[path] = Contradiction("it rests on /consistent")
    return found


def told_fields(report: Report) -> Iterator[tuple[str, Any, FieldVerdict]]:
    """Every field with a verdict: its path, its value and how sure it is."""
    for field, verdict in report.verdicts.items():
        yield f"/{field}", getattr(report, field), verdict
    for entry in report.constraints:
        for field, verdict in entry.verdicts.items():
            yield f"{_entry_path(entry)}/{field}", getattr(entry, field), verdict


def _entry_path(entry: ConstraintEntry) -> str:
    return "/constraints/" + entry.name.replace("~", "~0").replace("/", "~1")


def lowered(report: Report, contradictions: Mapping[str, Contradiction], other: Report | None = None) -> Report:
    """The report with the claims at some paths undecided; probable where another report says what the evidence does."""
    values = {path: value for path, value, _ in told_fields(report)}
    others = {path: (value, verdict) for path, value, verdict in told_fields(other)} if other is not None else {}
    instead = {path: _instead(path, values[path], one, others) for path, one in contradictions.items()}
    constraints = [_entry(entry, instead) for entry in report.constraints]
    fields = {path[1:]: found for path, found in instead.items() if path.count("/") == 1}
    verdicts = {**report.verdicts, **{field: verdict for field, (_, verdict) in fields.items()}}
    told = [
        f"{path}: a second program finds otherwise ({one.why}); it is {instead[path][1].verdict}"
        for path, one in contradictions.items()
    ]
    return report.model_copy(
        update={
            **{field: value for field, (value, _) in fields.items()},
            "verdicts": verdicts,
            "constraints": constraints,
            "verdict": weakest(report.verdict, *(verdict.verdict for _, verdict in instead.values())),
            "warnings": [*report.warnings, *told],
        }
    )


def _instead(
    path: str, value: Any, one: Contradiction, others: Mapping[str, tuple[Any, FieldVerdict]]
) -> tuple[Any, FieldVerdict]:
    """What is told in place of a value that was contradicted, and how sure it is.

    Another engine's answer is taken where it has a bound of its error, is not what was refuted, and is what was shown.
    """
    found, verdict = others.get(path, (None, _UNDECIDED))
    probable = verdict.verdict == "probable" and found is not None and found != value
    if probable and one.shown in (None, found) and not one.why.startswith("it rests"):
        return found, verdict
    field = path.rpartition("/")[2]
    return (None if path.count("/") > 1 else _OPEN.get(field, value)), _UNDECIDED


def _entry(entry: ConstraintEntry, instead: Mapping[str, tuple[Any, FieldVerdict]]) -> ConstraintEntry:
    start = _entry_path(entry)
    found = {field: instead[f"{start}/{field}"] for field in entry.verdicts if f"{start}/{field}" in instead}
    if not found:
        return entry
    verdicts = {**entry.verdicts, **{field: verdict for field, (_, verdict) in found.items()}}
    weak = weakest(entry.verdict, *(verdict.verdict for _, verdict in found.values()))
    told = {field: value for field, (value, _) in found.items()}
    return entry.model_copy(update={**told, "verdicts": verdicts, "verdict": weak})
