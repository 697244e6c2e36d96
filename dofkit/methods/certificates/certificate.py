"""The certificate of a report: evidence for every claim that is said to be proved, or its path among the uncovered."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar

from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import read_problem
from dofkit.checker.trees import CheckError
from dofkit.methods.certificates import emptiness, fields, freedom, labels
from dofkit.methods.certificates.contradictions import (
    as_if,
    is_decisive,
    is_of_largest_part,
    is_told_of_less,
    other_reports,
    refutations,
)
from dofkit.methods.certificates.numerics import NoEstimateError
from dofkit.methods.certificates.room import ClaimTrial, Room, Told, empty_certificate
from dofkit.methods.certificates.scenery import Scenery
from dofkit.report import ConstraintEntry, Report

Maker = Callable[[Room], Iterator[Told]]
Candidate = TypeVar("Candidate")

NUMBERS: dict[str, Maker] = {
    "consistent": freedom.consistent,
    "dof": freedom.dof,
    "velocity_dof": freedom.velocity_dof,
    "instantaneous_dof": freedom.instantaneous,
    "singular": freedom.counted,
    "holonomic": freedom.counted,
    "scleronomic": freedom.counted,
    "redundant_equations": freedom.counted,
    "redundancies": freedom.counted,
    "integrable_part": freedom.integrable_part,
    "feasible": freedom.feasible,
    "redundant": freedom.redundant,
    "generalized_coordinates": freedom.generalized_coordinates,
    "growth_vector": fields.growth_vector,
    "conflicting": emptiness.conflicting,
}
LABELS: dict[str, Callable[[Room, ConstraintEntry, str], Iterator[Told]]] = {
    "holonomic": labels.holonomic,
    "holonomic_alone": labels.holonomic,
    "exact": labels.exact,
    "integral": labels.integral,
    "scleronomic": labels.scleronomic,
    "catastatic": labels.scleronomic,
    "independent": freedom.independent,
    "circuit": freedom.circuit,
}
#: Claims that follow from others, which therefore stand before them.
LAST = (
    *("/singular", "/holonomic", "/scleronomic", "/redundant_equations", "/redundancies", "/integrable_part"),
    "/growth_vector",
)
#: Numbers that may differ from one part of the set to another.
OF_A_POINT = ("dof", "velocity_dof", "redundant", "generalized_coordinates", "growth_vector", "independent", "circuit")
HINDRANCES = (CheckError, NoEstimateError, RecursionError, KeyError, ValueError, ZeroDivisionError, OverflowError)


def certificate_of(document: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """The certificate of a report of the scene that a document writes."""
    return made(document, report)[0]


def made(document: Mapping[str, Any], report: Report) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    """The certificate, of claims that the checker's rules have shown, and what the evidence contradicts, with why."""
    making = Certifying(document, report)
    return making.written(), list(making.contradictions.items())


class Certifying:
    """A certificate while it is made."""

    def __init__(self, document: Mapping[str, Any], report: Report) -> None:
        self.document, self.report = document, report
        self.found = empty_certificate(report.scene, document)
        self.rooms: list[Room] = []
        self.trial: ClaimTrial | None = None
        self.contradictions: dict[str, str] = {}

    def written(self) -> dict[str, Any]:
        """All claims that are said to be proved, each with evidence or among the uncovered."""
        try:
            self.rooms = _rooms(self.document, self.report, self.found)
            self.trial = ClaimTrial(self.document, self.found, self.rooms[-1].problem)
            for room in self.rooms:
                self.trial.admit(room.scenery)
        except CheckError:
            self.rooms = []
        unshown = []
        for path, value, make in sorted(_asked(self.report), key=lambda asked: asked[0] in LAST):
            claim = self._made(path, value, make)
            if claim is None and self._is_proved(path):
                self.found["uncovered"].append(path)
                unshown.append((path, value, make))
            elif claim is None:
                self.contradictions.pop(path, None)
            else:
                self.found["claims"].append(claim)
                self._compare_about(path, claim)
        written = without_spare_parts({**self.found})  # what is searched for below adds parts to the lists
        for path, value, make in unshown:
            self._look_for_others(path, value, make)
        written["uncovered"] = [path for path in written["uncovered"] if path not in self.contradictions]
        return written

    def _is_proved(self, path: str) -> bool:
        """Whether a claim is said to be proved; numbers that are probable are tried as well."""
        verdict = self.report.verdicts.get(path[1:])
        return verdict is None or verdict.verdict == "proved"

    def _look_for_others(self, path: str, value: Any, make: Maker) -> None:
        """Write down why a claim without evidence cannot be, where something shows it."""
        if path not in self.contradictions and path in LAST:
            self._made(path, value, make)
        asked_path, asked_value = path, value
        if path == "/generalized_coordinates":  # there are as many as degrees of freedom
            asked_path, asked_value = "/dof", len(value)
        for room in self.rooms:
            for other in _guarded(self._others(room, asked_path, asked_value)):
                self.contradictions.setdefault(path, f"the evidence gives {other!r}, not {str(asked_value)[:80]!r}")
                return
            for why in _guarded(refutations(room, self.report, path, value)):
                self.contradictions.setdefault(path, why)

    def _others(self, room: Room, path: str, value: Any) -> Iterator[Any]:
        """Other values of a claim that are shown where the claim is made."""
        for report in other_reports(self.report, path, value, len(room.problem.coordinates)):
            freedom_asked = path, report.dof, NUMBERS["dof"]
            _, other, make = next((entry for entry in _asked(report) if entry[0] == path), freedom_asked)
            for evidence in _guarded(make(as_if(room, report))):
                claim = self._claim(room, path, other, evidence)
                if is_decisive(room, claim) and self.trial and self.trial.outcome(claim) == "shown":
                    yield other

    @staticmethod
    def _claim(room: Room, path: str, value: Any, evidence: Told) -> Told:
        return {"path": path, "value": value, **evidence, **({"cayley": True} if room.scenery.cayley else {})}

    def _made(self, path: str, value: Any, make: Maker) -> Told | None:
        """A claim that is shown; None where none is. What the evidence contradicts is written down elsewhere."""
        contradicted = ""
        for room in self.rooms:
            for evidence in _guarded(make(room)):
                claim = self._claim(room, path, value, evidence)
                outcome = self.trial.outcome(claim) if self.trial else "open"
                if outcome == "shown":
                    return claim
                counts = outcome == "contradicted" and (self._counts(room, claim) or is_decisive(room, claim))
                if counts and self.trial:
                    contradicted = contradicted or self.trial.reasons[path]
        if contradicted:
            self.contradictions[path] = contradicted
        return None

    def _counts(self, room: Room, claim: Told) -> bool:
        """Whether evidence for another value contradicts what is told, and is not of another place or reading.

        Numbers at a point that was looked for may be those of another part of the set; what is reduced (squares) or
        vanishes at the configuration may be told of what it was reduced to.
        """
        path = claim["path"]
        if is_told_of_less(room, path[1:]):
            return False
        verdict = self.report.verdicts.get(path[1:])
        whole = verdict is not None and verdict.about == "everywhere"
        if path == "/dof" and whole and self.trial and not room.problem.reference:
            number = self.trial.reasons[path].removeprefix("the evidence gives ").partition(",")[0]
            if number.isdigit() and int(number) > claim["value"]:
                return True
        pointed = any(key in claim for key in ("minor", "at", "most")) and path.rpartition("/")[2] in OF_A_POINT
        return not pointed or room.at_reference or is_of_largest_part(room, claim)

    def _compare_about(self, path: str, claim: Told) -> None:
        """A number shown near a point only, that is told of everywhere, is uncovered in that."""
        verdict = self.report.verdicts.get(path[1:])
        if verdict is not None and self._is_proved(path) and "about" in claim and claim["about"] != verdict.about:
            self.found["uncovered"].append(f"/verdicts{path}/about")


def _guarded(candidates: Iterator[Candidate]) -> Iterator[Candidate]:
    """Yield candidates until something stands in the way."""
    try:
        yield from candidates
    except HINDRANCES:
        return


def without_spare_parts(certificate: dict[str, Any]) -> dict[str, Any]:
    """The certificate with only the parts that its claims use."""
    used = _texts_in(certificate["claims"])
    for part in ("covers", "minors", "fields", "points"):
        certificate[part] = [part_entry for part_entry in certificate[part] if part_entry["id"] in used]
        used |= _texts_in(certificate[part])
    kept: set[str] = set()
    while wanted := [
        part_entry
        for part_entry in certificate["relations"]
        if part_entry["id"] not in kept and _needed(part_entry, used)
    ]:
        kept |= {part_entry["id"] for part_entry in wanted}
        used |= _texts_in(wanted)
    certificate["relations"] = [part_entry for part_entry in certificate["relations"] if part_entry["id"] in kept]
    return certificate


def _needed(step: Told, used: set[str]) -> bool:
    """Whether a step is used, or says something of a relation of the scene."""
    return (step["by"] == "implied" and "of" in step) or step["id"] in used


def _texts_in(value: Any) -> set[str]:
    """Every text in a value, keys included."""
    if isinstance(value, str):
        return {value}
    if isinstance(value, dict):
        return set(value) | {text for item in value.values() for text in _texts_in(item)}
    return {text for item in value for text in _texts_in(item)} if isinstance(value, list) else set()


def _rooms(document: Mapping[str, Any], report: Report, certificate: dict[str, Any]) -> list[Room]:
    """The readings that evidence is looked for in: with Cayley parameters first, where a drawing is given."""
    plain = read_problem(document)
    rooms = [Room(report, document, Scenery(plain, False, certificate))]
    bodies = frozenset(_names(document.get("bodies")))
    if plain.world.dimension == 3 and bodies and plain.reference:
        chart = _with_cayley(document, bodies)
        if chart is not None:
            certificate["cayley"] = sorted(bodies)
            rooms.insert(0, Room(report, document, Scenery(chart, True, certificate)))
    return rooms


def _names(entries: Any) -> Iterator[str]:
    for entry in entries or []:
        yield entry if isinstance(entry, str) else entry["name"]


def _with_cayley(document: Mapping[str, Any], bodies: frozenset[str]) -> Problem | None:
    try:
        return read_problem(document, bodies)
    except CheckError:
        return None


def _asked(report: Report) -> Iterator[tuple[str, Any, Maker]]:
    """The claims that are said to be proved, or numbers that are probable: path, value, how evidence is looked for."""
    document = report.model_dump(mode="json")
    for field, verdict in report.verdicts.items():
        if verdict.verdict in ("proved", "probable") and field in NUMBERS:
            yield f"/{field}", document[field], NUMBERS[field]
        elif verdict.verdict == "proved":
            yield f"/{field}", document[field], _nothing
    for entry, values in zip(report.constraints, document["constraints"], strict=True):
        name = entry.name.replace("~", "~0").replace("/", "~1")
        for field, verdict in sorted(entry.verdicts.items(), key=lambda item: item[0] == "scleronomic"):
            if verdict.verdict == "proved":
                yield f"/constraints/{name}/{field}", values[field], _label_maker(entry, field)


def _nothing(room: Room) -> Iterator[Told]:
    """No rule is known."""
    yield from ()


def _label_maker(entry: ConstraintEntry, field: str) -> Maker:
    make = LABELS.get(field)
    local = field in ("independent", "circuit")
    return lambda room: make(room, entry, field) if make and (local or not room.scenery.cayley) else iter(())
