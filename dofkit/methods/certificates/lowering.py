"""A report with its certificate: what the evidence contradicts is no longer told as proved."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from typing import Any, TypeVar

from dofkit.base.verdicts import weakest
from dofkit.expressions.text.characters import DEGREE, GREEK_LETTERS
from dofkit.methods.certificates.certificate import Certifying
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.lowering import survey_of
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import SAID, with_plain_subscripts

UNDECIDED = FieldVerdict(verdict="undecided", checked=False)
Model = TypeVar("Model", Report, ConstraintEntry)
#: What fields are where they are undecided, if not None.
_OPEN: Mapping[str, Any] = {"redundancies": [], "conflicting": [], "infeasible": []}


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
    """Return the report with a certificate, and in each verdict whether the checker accepted evidence for it.

    A claim whose evidence gives another value is undecided, with a warning.
    """
    making = Certifying(document_of_scene(scene), report)
    certificate = making.written()
    confirmed = {claim["path"] for claim in certificate["claims"]}
    confirmed -= {path.removeprefix("/verdicts").removesuffix("/about") for path in certificate["uncovered"]}
    return _checked(report, confirmed, making.contradictions).model_copy(update={"certificate": certificate})


def told_fields(report: Report) -> Iterator[tuple[str, Any, FieldVerdict]]:
    """Every field with a verdict: its path, its value and how sure it is."""
    for field, verdict in report.verdicts.items():
        yield f"/{field}", getattr(report, field), verdict
    for entry in report.constraints:
        for field, verdict in entry.verdicts.items():
            yield f"{_entry_path(entry)}/{field}", getattr(entry, field), verdict


def _entry_path(entry: ConstraintEntry) -> str:
    return "/constraints/" + entry.name.replace("~", "~0").replace("/", "~1")


def _checked(report: Report, confirmed: Collection[str], contradictions: Mapping[str, str]) -> Report:
    """Return the report with ``checked`` in each verdict, and what is contradicted undecided, with a warning."""

    def revised(model: Model, start: str) -> Model:
        verdicts = {
            field: UNDECIDED
            if f"{start}/{field}" in contradictions
            else verdict.model_copy(update={"checked": f"{start}/{field}" in confirmed})
            for field, verdict in model.verdicts.items()
        }
        fields = {field: _OPEN.get(field) for field, verdict in verdicts.items() if verdict is UNDECIDED}
        weaker = {"verdict": weakest(model.verdict, "undecided")} if fields else {}
        return model.model_copy(update={**fields, **weaker, "verdicts": verdicts})

    warnings = [
        f"{path}: a second program finds otherwise ({why}); it is undecided" for path, why in contradictions.items()
    ]
    entries = [revised(entry, _entry_path(entry)) for entry in report.constraints]
    weaker = {"verdict": weakest(report.verdict, "undecided")} if contradictions else {}
    changes = {"constraints": entries, "warnings": [*report.warnings, *warnings], **weaker}
    return revised(report, "").model_copy(update=changes)
