"""Evidence where rows are stationary at the main point: what is isolated along a curve, and what crosses itself."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from flint import arb

from dofkit.checker.evidence import HIGHEST_ORDER, along_curve
from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.families import families
from dofkit.methods.certificates.rigid_fields import kept_motions
from dofkit.methods.certificates.room import FAR, Room, Standing, Told

SIGNS = (1, -1)
#: The engines' arguments by which it is so.
ISOLATED, CROSSING = "isolated zero of one variable", "indefinite form"


def stationary(room: Room) -> Iterator[Told]:
    """dof near a point at which a relation depends on the others to first order alone."""
    standing = room.standing
    if standing is None or not standing.dependent:
        return
    for found in _isolations(room):
        most = {key: part for key, part in found.items() if key not in ("fields", "pins")}
        yield {"rule": "squeeze", "about": room.about, "most": most, "least": _orbit(room, found)}
    if room.report.verdicts["dof"].argument == CROSSING:
        for least in families(room, room.report.dof or 0):
            for most in _crossings(room, standing):
                yield {"rule": "squeeze", "about": room.about, "most": most, "least": least}


def _isolations(room: Room) -> Iterator[Told]:
    """The rule `isolated`, with the generalized coordinates for pins, or what moves with the fields."""
    chosen = room.report.generalized_coordinates
    for wanted in (chosen, room.problem.coordinates) if room.report.verdicts["dof"].argument == ISOLATED else ():
        fields = kept_motions(room, wanted) if wanted else {}
        if wanted is not None and len(fields) == room.report.dof:
            yield from _pinned(room, list(fields), list(fields.values()))


def _pinned(room: Room, fields: list[str], pins: list[str]) -> Iterator[Told]:
    if room.standing is None:
        return
    others = [q for q in room.problem.coordinates if q not in pins]
    standing = room.standing_of(room.standing.order, others)
    if standing is None or len(standing.rows) != len(others) - 1:
        return
    free = next(q for q in others if q not in standing.columns)
    given: Told = {"rule": "isolated", "minor": room.minor(standing), "speeds": {free: "1"}}
    given |= {"fields": fields, "pins": pins}
    for order in range(2, HIGHEST_ORDER + 1):
        for zero in standing.dependent:
            yield {**given, "zero": zero, "order": order}


def _orbit(room: Room, most: Told) -> Told:
    """From below: the orbit of the fields, or the point alone."""
    at, finite = room.standing.point.name if room.standing else "", list(room.scenery.evidence.finite)
    words = [[name] for name in most["fields"]]
    return {"rule": "span", "at": at, "fields": most["fields"], "rows": finite, "words": words, "columns": most["pins"]}


def _crossings(room: Room, standing: Standing) -> Iterator[Told]:
    """The rule `isolated`: a direction in which a relation has a second derivative."""
    free = [q for q in room.problem.coordinates if q not in standing.columns]
    ways = [{q: 1} for q in free] + [{a: 1, b: sign} for a, b in combinations(free, 2) for sign in SIGNS]
    for zero in standing.dependent:
        for way in ways:
            if abs(_bends(room, standing, zero, way)) > FAR:
                speeds = {q: str(value) for q, value in way.items()}
                yield {"rule": "isolated", "minor": room.minor(standing), "zero": zero, "speeds": speeds, "order": 2}
                break


def _bends(room: Room, standing: Standing, zero: str, way: dict[str, int]) -> float:
    """The second derivative of a relation in a direction; 0 where it cannot be told."""
    evidence = room.scenery.evidence
    try:
        minor = evidence.minor(room.minor(standing))
        speeds = {q: arb(value) for q, value in way.items()}
        return float(along_curve(evidence, minor, speeds, evidence.relation(zero).left, 2).mid())
    except (CheckError, ArithmeticError):
        return 0.0
