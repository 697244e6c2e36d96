"""A report with its certificate: what the evidence contradicts is no longer reported as proved."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from dofkit.base.verdicts import About, least, weakest
from dofkit.checker.grammar import KnownNames, parse_relations
from dofkit.checker.trees import CheckError, symbol
from dofkit.expressions.text import Names
from dofkit.methods.certificates.certificate import Certifying, entry_path
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.scene.plain import PlainScene, plain_scene
from dofkit.scene.scene import Scene

UNDECIDED = FieldVerdict(verdict="undecided", checked=False)
Model = TypeVar("Model", Report, ConstraintEntry)
#: What fields are where they are undecided, if not None.
_OPEN: Mapping[str, Any] = {"redundancies": [], "conflicting": [], "infeasible": []}


def document_of_scene(scene: Scene) -> dict[str, Any]:
    """The document of a scene as the checker reads it."""
    return scene_for_checker(scene).document


def scene_for_checker(scene: Scene) -> PlainScene:
    """A scene in standard words; a text that the checker's grammar does not read stands in plain notation."""
    cached: dict[int, tuple[Names, KnownNames]] = {}

    def reads(text: str, names: Names) -> bool:
        if id(names) not in cached:
            values = {name: symbol(name) for name in names.parameters}
            cached[id(names)] = names, KnownNames(names.coordinates, values, names.arguments)
        try:
            return bool(parse_relations(text, cached[id(names)][1]))
        except CheckError:
            return False

    return plain_scene(scene, reads)


def with_certificate(scene: Scene, report: Report, strict: bool = False) -> Report:
    """Return the report with a certificate, and in each verdict whether the checker accepted evidence for it.

    A claim whose evidence gives another value is undecided, with a warning. If ``strict``, what is proved without
    evidence is probable, and a number is about the points for which it is shown.
    """
    document, readings = scene_for_checker(scene)
    making = Certifying(document, report, readings)
    certificate = making.written()
    confirmed = {claim["path"]: claim.get("about") for claim in certificate["claims"]}
    checked = _checked(report, confirmed, making.contradictions, strict)
    return checked.model_copy(update={"certificate": certificate})


def _checked(
    report: Report, confirmed: Mapping[str, About | None], contradictions: Mapping[str, str], strict: bool = False
) -> Report:
    """Return the report with ``checked`` in each verdict, and what is contradicted undecided, with a warning.

    ``confirmed``: the paths of accepted claims, each with the points that it is about, if it says so.
    """

    def examined(verdict: FieldVerdict, path: str) -> FieldVerdict:
        if path in contradictions:
            return UNDECIDED
        lowered = strict and verdict.verdict == "proved" and path not in confirmed
        about = confirmed.get(path) or verdict.about
        if not strict and about and verdict.about and least(about, verdict.about) != verdict.about:
            return verdict.model_copy(update={"checked": False})
        changes = {"checked": path in confirmed, "about": about, **({"verdict": "probable"} if lowered else {})}
        return verdict.model_copy(update=changes)

    def revised(model: Model, start: str) -> Model:
        verdicts = {field: examined(verdict, f"{start}/{field}") for field, verdict in model.verdicts.items()}
        fields = {field: _OPEN.get(field) for field, verdict in verdicts.items() if verdict is UNDECIDED}
        whole = weakest(model.verdict, *(verdict.verdict for verdict in verdicts.values()))
        return model.model_copy(update={**fields, "verdict": whole, "verdicts": verdicts})

    warnings = [
        f"{path}: a second program finds otherwise ({why}); it is undecided" for path, why in contradictions.items()
    ]
    entries = [revised(entry, entry_path(entry)) for entry in report.constraints]
    whole = revised(report, "")
    verdict = weakest(whole.verdict, *(entry.verdict for entry in entries))
    changes = {"constraints": entries, "warnings": [*report.warnings, *warnings], "verdict": verdict}
    return whole.model_copy(update=changes)
