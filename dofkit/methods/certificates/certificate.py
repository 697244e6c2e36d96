"""The certificate of a report: evidence for every claim that is said to be proved, or its path among the uncovered."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.problem import canonical, problem_of_canonical
from dofkit.checker.relations import FAULTS, fault_text
from dofkit.checker.trees import CheckError
from dofkit.checker.verification import PARTS, Verifier
from dofkit.methods.certificates import emptiness, fields, freedom, labels
from dofkit.methods.certificates.context import Context, Told, empty_certificate
from dofkit.methods.certificates.numerics import NoEstimateError
from dofkit.methods.certificates.scenery import FAR, Scenery
from dofkit.report import ConstraintEntry, Report

Maker = Callable[[Context], Iterator[Told]]

NUMBERS: dict[str, Maker] = {
    "consistent": freedom.consistent,
    "dof": freedom.dof,
    "velocity_dof": freedom.velocity_dof,
    "instantaneous_dof": freedom.instantaneous,
    "singular": freedom.counted,
    "holonomic": freedom.counted,
    "scleronomic": freedom.counted,
    "redundant_equations": freedom.counted,
    "redundancies": freedom.redundancies,
    "integrable_part": freedom.integrable_part,
    "feasible": freedom.feasible,
    "redundant": freedom.redundant,
    "generalized_coordinates": freedom.generalized_coordinates,
    "growth_vector": fields.growth_vector,
    "conflicting": emptiness.conflicting,
}
LABELS: dict[str, Callable[..., Iterator[Told]]] = {
    "holonomic": labels.holonomic,
    "holonomic_alone": labels.holonomic,
    "exact": labels.exact,
    "integral": labels.integral,
    "scleronomic": labels.time_evidence,
    "catastatic": labels.time_evidence,
    "independent": freedom.independent,
    "circuit": freedom.circuit,
}
#: Claims that follow from others, which therefore stand before them.
LAST = (
    *("/singular", "/holonomic", "/scleronomic", "/redundant_equations", "/redundancies", "/integrable_part"),
    "/growth_vector",
)
HINDRANCES = (CheckError, NoEstimateError, RecursionError, KeyError, ValueError, ZeroDivisionError, OverflowError)


class Certifying:
    """A certificate while it is made; ``contradictions``: claims whose evidence gives another value, and why."""

    def __init__(self, document: Mapping[str, Any], report: Report, readings: Mapping[str, str] | None = None) -> None:
        document = canonical(document)
        self.report, self.contexts = report, list[Context]()
        self.certificate = empty_certificate(report.scene, document, readings or {})
        #: Why the last evidence for a claim was not accepted, and what contradicts claims, by path.
        self.reasons: dict[str, str] = {}
        self.contradictions: dict[str, str] = {}
        with suppress(CheckError):
            self.contexts = _contexts(document, report, self.certificate)
            self.verifier = Verifier(document, self.certificate, self.contexts[-1].problem)
            self.verifier.evidences = {context.scenery.cayley: context.scenery.evidence for context in self.contexts}

    def written(self) -> dict[str, Any]:
        """All claims that are said to be proved, each with evidence or among the uncovered."""
        claims, uncovered = self.certificate["claims"], self.certificate["uncovered"]
        for path, value, make in sorted(_asked(self.report), key=lambda asked: asked[0] in LAST):
            verdict = self.report.verdicts.get(path[1:])
            is_proved = verdict is None or verdict.verdict == "proved"
            claim = self.confirmed(path, value, make, is_proved)
            claims += [claim] if claim else []
            uncovered += [path] if is_proved and not claim and path not in self.contradictions else []
            # a number shown near a point only, that is stated of all points, is uncovered in that
            elsewhere = claim and is_proved and verdict and claim.get("about", verdict.about) != verdict.about
            uncovered += [f"/verdicts{path}/about"] if elsewhere else []
        return without_spare_parts(self.certificate)

    def confirmed(self, path: str, value: Any, make: Maker, is_proved: bool) -> Told | None:
        """A claim that the checker accepts, or None; where the evidence for it gives another value, that is noted."""
        contradicted = ""
        for context in self.contexts:
            chart = {"cayley": True} if context.scenery.cayley else {}
            with suppress(*HINDRANCES):
                for evidence in make(context):
                    claim = {"path": path, "value": value, **evidence, **chart}
                    if (fault := self._fault(claim, context.scenery.evidence)) is None:
                        return claim
                    if fault.startswith("the evidence gives") and self._is_of_same_points(context, claim):
                        contradicted = contradicted or fault
        if contradicted and is_proved:
            self.contradictions[path] = contradicted
        return None

    def _fault(self, claim: Told, evidence: CheckedEvidence) -> str | None:
        """Return why the checker refuses a claim; what follows by its covers is then forgotten."""
        number = len(evidence.consequences)
        try:
            self.verifier.check(claim)
        except FAULTS as error:
            of_covers = [key for key in evidence.seen if key[0] == "covers" or (key[0] == "met" and key[1] >= number)]
            for key in of_covers if number < len(evidence.consequences) else ():
                del evidence.seen[key]
            del evidence.consequences[number:]
            self.reasons[claim["path"]] = fault_text(error)
            return self.reasons[claim["path"]]
        return None

    def _is_of_same_points(self, context: Context, claim: Told) -> bool:
        """Whether evidence is of the configuration, of all points as the report is, or of no point.

        Numbers at a point that was looked for may be those of another component of the set. What vanishes at the
        configuration may be stated of what it was reduced to.
        """
        field = claim["path"][1:]
        verdict = self.report.verdicts.get(field)
        if field == "instantaneous_dof" and _has_stationary_row(context):
            return False
        whole = verdict is not None and claim.get("about") == "everywhere" == verdict.about
        return whole or context.at_reference or not any(key in claim for key in ("minor", "at", "most"))


def _has_stationary_row(context: Context) -> bool:
    """Whether an equation has the differential 0 at the main point, as far as floats tell."""
    rows = [] if context.point is None else [context.row(name, context.point) for name in context.scenery.equations]
    return any(all(abs(value) <= FAR for value in row.values()) for row in rows)


def without_spare_parts(certificate: dict[str, Any]) -> dict[str, Any]:
    """The certificate with only the parts that its claims use, and the steps that say something of its relations."""
    used, kept = _texts_in(certificate["claims"]), dict[str, list[Told]]()
    for part in reversed(PARTS):
        kept[part] = []
        for entry in reversed(certificate[part]):
            if entry["id"] in used or (entry.get("by") == "implied" and "of" in entry):
                kept[part].insert(0, entry)
                used |= _texts_in(entry)
    return certificate | kept


def _texts_in(value: Any) -> set[str]:
    """Every text in a value, keys included."""
    if isinstance(value, str):
        return {value}
    if isinstance(value, dict):
        return set(value) | {text for item in value.values() for text in _texts_in(item)}
    return set().union(*map(_texts_in, value)) if isinstance(value, list) else set()


def _contexts(document: Mapping[str, Any], report: Report, certificate: dict[str, Any]) -> list[Context]:
    """The readings that evidence is looked for in: with Cayley parameters first, where a drawing is given."""
    plain = problem_of_canonical(document)
    contexts = [Context(report, Scenery(plain, False, certificate))]
    bodies = frozenset(plain.world.frames) - {"ground"}
    if plain.world.dimension == 3 and bodies and plain.reference:
        with suppress(CheckError):
            chart = problem_of_canonical(document, bodies)
            contexts.insert(0, Context(report, Scenery(chart, True, certificate)))
            certificate["cayley"] = sorted(bodies)
    return contexts


def _asked(report: Report) -> Iterator[tuple[str, Any, Maker]]:
    """The claims that are said to be proved, or numbers that are probable: path, value, how evidence is looked for."""
    document = report.model_dump(mode="json")
    for field, verdict in report.verdicts.items():
        make = NUMBERS.get(field, _nothing)
        if verdict.verdict == "proved" or (verdict.verdict == "probable" and field in NUMBERS):
            yield f"/{field}", document[field], make
    for entry, values in zip(report.constraints, document["constraints"], strict=True):
        for field, verdict in sorted(entry.verdicts.items(), key=lambda item: item[0] == "scleronomic"):
            if verdict.verdict == "proved":
                of_entry = partial(LABELS.get(field, _nothing), entry=entry, field=field)
                yield f"{entry_path(entry)}/{field}", values[field], of_entry


def entry_path(entry: ConstraintEntry) -> str:
    """The path of a constraint's entry in the report."""
    return "/constraints/" + entry.name.replace("~", "~0").replace("/", "~1")


def _nothing(*_: object, **__: object) -> Iterator[Told]:
    """No rule is known."""
    yield from ()
