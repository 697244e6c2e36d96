"""The certificate of a report: for every claim that is said to be proved its evidence, or its path among the uncovered."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from dofkit.checker.document import sha256_of
from dofkit.checker.errors import CheckError
from dofkit.checker.problem import Problem, read_problem
from dofkit.methods.certificates import emptiness, forms, freedom, labels
from dofkit.methods.certificates.estimates import NoEstimateError
from dofkit.methods.certificates.room import Room, Told
from dofkit.methods.certificates.scenery import Scenery
from dofkit.report import ConstraintEntry, Report

_NUMBERS: dict[str, Callable[[Room, str], Told | None]] = {
    "consistent": freedom.consistent,
    "dof": freedom.dof,
    "velocity_dof": freedom.velocity_dof,
    "instantaneous_dof": freedom.instantaneous,
    "singular": freedom.counted,
    "holonomic": freedom.counted,
    "scleronomic": freedom.counted,
    "redundant_equations": freedom.counted,
    "redundant": freedom.redundant,
    "generalized_coordinates": freedom.generalized_coordinates,
    "growth_vector": forms.growth_vector,
    "conflicting": emptiness.conflicting,
}
_LABELS: dict[str, Callable[[Room, ConstraintEntry, str], Told | None]] = {
    "holonomic": labels.holonomic,
    "holonomic_alone": labels.holonomic,
    "scleronomic": labels.scleronomic,
    "catastatic": labels.scleronomic,
    "exact": labels.exact,
    "integrating_factor": labels.integrating_factor,
    "integral": labels.integral,
}
_FAULTS = (CheckError, NoEstimateError, RecursionError, KeyError, ValueError, ZeroDivisionError, OverflowError)


def certificate_of(document: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """The certificate of a report of the scene that a document writes."""
    scene = {"name": report.scene, "sha256": sha256_of(document), "document": dict(document)}
    parts: dict[str, list[Told]] = {"relations": [], "points": [], "minors": [], "fields": []}
    found: dict[str, Any] = {"certificate": 1, "scene": scene, "cayley": []}
    try:
        rooms = _rooms(document, report, parts, found)
    except CheckError:
        rooms = []
    claims, uncovered = [], []
    for path, value, make in _asked(report):
        claim = _made(rooms, make)
        if claim is None:
            uncovered.append(path)
        else:
            claims.append({"path": path, "value": value, **claim})
    for room in rooms:
        uncovered += room.uncovered
    return {**found, **parts, "claims": claims, "uncovered": uncovered}


def _rooms(
    document: Mapping[str, Any], report: Report, parts: dict[str, list[Told]], found: dict[str, Any]
) -> list[Room]:
    """The readings that evidence is looked for in: with Cayley parameters first, where a drawing is given."""
    plain = read_problem(document)
    rooms = [Room(report, document, Scenery(plain, False, parts))]
    bodies = frozenset(_names(document.get("bodies")))
    if plain.dimension == 3 and bodies and plain.reference:
        chart = _with_cayley(document, bodies)
        if chart is not None:
            found["cayley"] = sorted(bodies)
            rooms.insert(0, Room(report, document, Scenery(chart, True, parts)))
    return rooms


def _names(entries: Any) -> Iterator[str]:
    for entry in entries or []:
        yield entry if isinstance(entry, str) else entry["name"]


def _with_cayley(document: Mapping[str, Any], bodies: frozenset[str]) -> Problem | None:
    try:
        return read_problem(document, bodies)
    except CheckError:
        return None


def _asked(report: Report) -> Iterator[tuple[str, Any, Callable[[Room], Told | None]]]:
    """The claims that are said to be proved: path, value, and how evidence is looked for."""
    told = report.model_dump(mode="json")
    for field, verdict in report.verdicts.items():
        if verdict.verdict == "proved":
            yield f"/{field}", told[field], _number_maker(field)
    for entry, values in zip(report.constraints, told["constraints"], strict=True):
        name = entry.name.replace("~", "~0").replace("/", "~1")
        for field, verdict in entry.verdicts.items():
            if verdict.verdict == "proved":
                yield f"/constraints/{name}/{field}", values[field], _label_maker(entry, field)


def _number_maker(field: str) -> Callable[[Room], Told | None]:
    make = _NUMBERS.get(field)
    return lambda room: make(room, f"/{field}") if make else None


def _label_maker(entry: ConstraintEntry, field: str) -> Callable[[Room], Told | None]:
    if field == "independent":
        return lambda room: freedom.independent(room, entry.name)
    make = _LABELS.get(field)
    return lambda room: make(room, entry, field) if make and not room.scenery.cayley else None


def _made(rooms: list[Room], make: Callable[[Room], Told | None]) -> Told | None:
    """The evidence of the first reading that has some."""
    for room in rooms:
        try:
            claim = make(room)
        except _FAULTS:
            continue
        if claim is not None:
            return {**claim, "cayley": True} if room.scenery.cayley else claim
    return None
