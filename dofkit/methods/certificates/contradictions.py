"""What contradicts a claim: verified evidence for another value of it.

Evidence at a point contradicts only what is told of that point: of the scene's configuration where one is given, or of
all points where the relations leave one part, on which what is analytic is the same almost everywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from typing import Any

from dofkit.checker.evidence import admissible, field_named
from dofkit.checker.trees import CheckError, along, not_zero
from dofkit.methods.certificates.dimension import graph_order
from dofkit.methods.certificates.fields import tangent_fields
from dofkit.methods.certificates.labels import integral_text
from dofkit.methods.certificates.numerics import NoEstimateError
from dofkit.methods.certificates.room import Room
from dofkit.methods.certificates.scenery import FAR
from dofkit.report import Report

#: Rules whose evidence is of the whole set, or of a constraint wherever it is looked at.
OF_ALL = frozenset(
    ("count", "finite", "inequality", "timeless", "turns", "exact", "not exact", "wedge", "nullstellensatz")
)
#: Fields that are shown by any point.
OF_ANY_POINT = ("consistent", "feasible", "conflicting")


def as_if(room: Room, report: Report) -> Room:
    """The same room with another report: its points and rows stay."""
    point, other = room.point, copy(room)
    other.report, other.point = report, point
    return other


def other_reports(report: Report, path: str, value: Any, coordinates: int) -> Iterator[Report]:
    """Reports that tell other values under a path."""
    name, field = _parts(path)
    for other in _other_values(field, value, coordinates, report):
        if not name:
            yield report.model_copy(update={field: other})
            continue
        yield _with_labels(report, (name,), field, other)
        if field == "holonomic" and other is True:
            yield _with_labels(report, [entry.name for entry in report.constraints], field, other)


def _parts(path: str) -> tuple[str, str]:
    """The constraint's name, or "", and the field."""
    keys = [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")]
    return (keys[2], keys[3]) if len(keys) == 4 else ("", keys[-1])


def _with_labels(report: Report, names: Sequence[str], field: str, value: Any) -> Report:
    entries = [e.model_copy(update={field: value}) if e.name in names else e for e in report.constraints]
    return report.model_copy(update={"constraints": entries})


def _other_values(field: str, value: Any, coordinates: int, report: Report) -> Iterator[Any]:
    if isinstance(value, bool):
        yield not value
    elif field in ("dof", "velocity_dof"):
        yield from (k for k in range(coordinates + 1) if k != value)
    elif field in ("circuit", "conflicting") and value:
        yield from ([member for member in value if member != other] for other in value)
    elif field == "redundant":
        spared = [entry.name for entry in report.constraints if entry.independent == 0 and entry.equations]
        yield from (other for other in ([], spared) if len(other) != len(value))


def is_decisive(room: Room, claim: dict[str, Any]) -> bool:
    """Whether what shows another value speaks of the points that the claim is told of."""
    field = claim["path"].rpartition("/")[2]
    if is_told_of_less(room, field):
        return False
    if claim["rule"] in OF_ALL or field in OF_ANY_POINT or is_of_largest_part(room, claim):
        return True
    return speaks_for_all(room)


def is_of_largest_part(room: Room, claim: dict[str, Any]) -> bool:
    """Whether evidence is of the whole set, and so is the number that is told, not of a part that may be smaller."""
    verdict = room.report.verdicts.get(claim["path"][1:])
    return claim.get("about") == "everywhere" and verdict is not None and verdict.about == "everywhere"


def is_told_of_less(room: Room, field: str) -> bool:
    """Whether a report may be of what relations were reduced to.

    Such are the bases of squares, the terms of a factor that is a sum of squares, and forms without a factor of time.
    """
    if field == "growth_vector" and room.scenery.evidence.timed:
        return True
    return bool(room.scenery.reduced_from) or (field == "instantaneous_dof" and _has_stationary_row(room))


def _has_stationary_row(room: Room) -> bool:
    point = room.point
    rows = (room.row(name, point) for name in room.equations) if point is not None else ()
    try:
        return any(all(abs(value) <= FAR for value in row.values()) for row in rows)
    except NoEstimateError:
        return False


def speaks_for_all(room: Room) -> bool:
    """Whether the main point is the configuration that the report is about, or lies on the one part that there is.

    Where nothing moves, everything may be told of motions.
    """
    point, evidence = room.point, room.scenery.evidence
    if point is None or room.scenery.reduced_from or room.nonlinear or room.report.consistent is not True:
        return False
    if not room.problem.reference:
        return is_one_part(room)
    try:
        evidence.is_about("reference", evidence.point(point.name))
    except CheckError:
        return False
    return True


def is_one_part(room: Room) -> bool:
    """Whether all is analytic, and the finite relations leave a graph: over free coordinates, or as lengths over all.

    Relations that each give a generic symbol of their own are a graph over all coordinates: nearly all lengths have
    fibres of the largest rank alone (Sard). Linear relations with rational coefficients leave an affine space.
    """
    evidence = room.scenery.evidence
    analytic = all(evidence.has_value_everywhere(evidence.relation(name).left) for name in evidence.equations)
    if not analytic or room.problem.world.names.functions:
        return False
    slopes = (evidence.slope(name, q) for name in evidence.finite for q in room.problem.coordinates)
    if all(map(evidence.own_symbol, evidence.finite)) or all(evidence.ring.rational(s) is not None for s in slopes):
        return True
    return not graph_order(room, list(evidence.finite))[1]


def refutations(room: Room, report: Report, path: str, value: Any) -> Iterator[str]:
    """Yield why a claim is false of which no other value is looked for.

    No row of a constraint is independent of its circuit. A function that an admissible velocity changes is no integral.
    """
    name, field = _parts(path)
    if not speaks_for_all(room):
        return
    entry = next((entry for entry in report.constraints if entry.name == name), None)
    if entry is not None and field == "circuit" and value is not None:
        evidence = room.scenery.evidence
        members = [row for member in value for row in evidence.owned(member)]
        if any(_is_apart(room, row, members) for row in evidence.owned(name)):
            yield "the evidence gives a row that is independent of the circuit"
    text = integral_text(entry) if entry is not None and field == "integral" else None
    if text and _is_changed(room, text):
        yield "the evidence gives a velocity that changes it"


def _is_apart(room: Room, name: str, members: Sequence[str]) -> bool:
    """Return whether a row is independent of relations, all of which follow from those that are independent there."""
    standing = room.accounted([*members, name])
    if standing is None or name not in standing.rows or not standing.accounted:
        return False
    return len(room.scenery.evidence.minor(room.minor(standing)).rows) == len(standing.rows)


def _is_changed(room: Room, text: str) -> bool:
    """Return whether a velocity that all relations allow changes a function."""
    standing, evidence = room.standing, room.scenery.evidence
    fields = tangent_fields(room, standing) if standing is not None and standing.accounted else None
    if standing is None or not fields:
        return False
    claim = {"at": standing.point.name, "fields": fields, "rows": standing.rows, "minor": room.minor(standing)}
    point, function = admissible(evidence, claim, evidence.equations)[0], evidence.text(text)
    return any(not_zero(point.value(along(field_named(evidence, field), function))) for field in fields)
