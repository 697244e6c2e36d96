"""What contradicts a claim: verified evidence for another value, or bounds that leave out what is told.

Evidence at a point contradicts only what is told of that point: of the scene's configuration where one is given, or of
all points where the relations leave one part, on which what is analytic is the same almost everywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from typing import Any, NamedTuple

from dofkit.checker.evidence import admissible, field_named, involutive, span
from dofkit.checker.label_rules import consistent, moves
from dofkit.checker.trees import CheckError, along, not_zero
from dofkit.methods.certificates.dimension import graph_order
from dofkit.methods.certificates.fields import Words, involutive_rows, tangent_fields, words_of
from dofkit.methods.certificates.labels import integral_text
from dofkit.methods.certificates.numerics import echelon
from dofkit.methods.certificates.room import Room, Standing
from dofkit.report import ConstraintEntry, Report

#: Rules whose evidence is of the whole set, or of a constraint wherever it is looked at.
OF_ALL = frozenset(
    ("count", "finite", "inequality", "timeless", "turns", "exact", "not exact", "wedge", "nullstellensatz")
)
#: Fields that are shown by any point.
OF_ANY_POINT = ("consistent", "feasible", "conflicting")


class Contradiction(NamedTuple):
    """Why a claim cannot be, and the value that was shown instead (None: only that it is not what is told)."""

    why: str
    shown: Any = None


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
    parts = [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")]
    return (parts[2], parts[3]) if len(parts) == 4 else ("", parts[-1])


def _with_labels(report: Report, names: Sequence[str], field: str, value: Any) -> Report:
    told = [e.model_copy(update={field: value}) if e.name in names else e for e in report.constraints]
    return report.model_copy(update={"constraints": told})


def _other_values(field: str, value: Any, coordinates: int, report: Report) -> Iterator[Any]:
    if isinstance(value, bool):
        yield not value
    elif field in ("dof", "velocity_dof"):
        yield from (k for k in range(coordinates + 1) if k != value)
    elif field in ("circuit", "conflicting") and value:
        yield from ([one for one in value if one != name] for name in value)
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
    return bool(room.scenery.reduced_from) or (field == "instantaneous_dof" and room.has_empty_row)


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
    analytic = all(evidence.has_value_everywhere(evidence.relation(one).left) for one in evidence.equations)
    if not analytic or room.problem.world.names.functions:
        return False
    slopes = (evidence.slope(one, q) for one in evidence.finite for q in room.problem.coordinates)
    if all(map(evidence.own_symbol, evidence.finite)) or all(evidence.ring.rational(s) is not None for s in slopes):
        return True
    return not graph_order(room, list(evidence.finite))[1]


def exclusions(room: Room, report: Report, path: str, value: Any) -> Iterator[Contradiction]:
    """Yield bounds, verified by the checker's rules, that exclude what is claimed under a path."""
    name, field = _parts(path)
    entry = next((one for one in report.constraints if one.name == name), None)
    if field == "conflicting":
        yield from _met_together(room, value)
    elif field == "consistent" and value is False:
        yield from _held_at_edges(room)
    elif speaks_for_all(room):
        if entry is not None:
            yield from LABELS[field](room, entry) if field in LABELS else ()
        elif field in NUMBERS:
            yield from NUMBERS[field](room, value)


def _verified_minor(room: Room, standing: Standing) -> int:
    """The rows of a minor that the checker finds regular at the main point."""
    return len(room.scenery.evidence.minor(room.minor(standing)).rows)


def _at_most(room: Room, standing: Standing | None, value: int) -> Iterator[Contradiction]:
    size = len(room.problem.coordinates)
    if standing is not None and size - len(standing.rows) < value:
        most = size - _verified_minor(room, standing)
        yield Contradiction(f"the evidence gives at most {most}, not {value}")


def _words(room: Room, most: int) -> tuple[Standing, Words] | None:
    standing = room.standing
    if standing is None or not standing.accounted or room.nonlinear or not room.scenery.evidence.moving:
        return None
    words = words_of(room, standing, most)
    return None if words is None else (standing, words)


def _spanned(room: Room, standing: Standing, words: Words, count: int, longest: int) -> int:
    """How many directions words are verified to span, that of time left out."""
    given = {"at": standing.point.name, "fields": words.fields, "rows": words.rows, "minor": room.minor(standing)}
    columns = [pivot.column for pivot in echelon(words.vectors[:count]).pivots]
    return span(room.scenery.evidence, {**given, "words": words.words[:count], "columns": columns}, longest)[1]


def _dof(room: Room, value: int) -> Iterator[Contradiction]:
    yield from _at_most(room, room.finite_standing, value)
    for given in involutive_rows(room, room.equations) if room.scenery.evidence.moving else ():
        most = len(room.problem.coordinates) - len(involutive(room.scenery.evidence, given).rows)
        if most < value:
            yield Contradiction(f"the evidence gives at most {most}, not {value}")
    found = _words(room, len(room.problem.coordinates) + 1)
    if found is not None and len(found[1].words) > value:
        least = _spanned(room, *found, len(found[1].words), 12)
        if least > value:
            yield Contradiction(f"the evidence gives at least {least}, not {value}")


def _growth(room: Room, value: Sequence[int]) -> Iterator[Contradiction]:
    """A vector whose entries are smaller than what words of that length span."""
    told_of_less = is_told_of_less(room, "growth_vector")
    found = None if told_of_less else _words(room, len(room.problem.coordinates) + 1)
    if found is None or not value:
        return
    for step, count in enumerate(found[1].levels, 1):
        told = value[min(step, len(value)) - 1]
        if count > told and _spanned(room, *found, count, step) > told:
            yield Contradiction(f"the evidence gives at least {count} in entry {step}, not {told}")


def _generalized(room: Room, value: Sequence[str]) -> Iterator[Contradiction]:
    """As many coordinates as dof are needed: no more than what the finite relations leave."""
    yield from (Contradiction(one.why) for one in _dof(room, len(value)))


def _is_apart(room: Room, name: str, others: Sequence[str]) -> bool:
    """Whether a row is independent of relations, all of which follow from those that are independent there."""
    standing = room.accounted([*others, name])
    if standing is None or name not in standing.rows or not standing.accounted:
        return False
    return _verified_minor(room, standing) == len(standing.rows)


def _circuit(room: Room, entry: ConstraintEntry) -> Iterator[Contradiction]:
    evidence = room.scenery.evidence
    rows = [row for name in entry.circuit or () for row in evidence.owned(name)]
    if entry.circuit is not None and any(_is_apart(room, one, rows) for one in evidence.owned(entry.name)):
        yield Contradiction("the evidence gives a row that is independent of the circuit")


def _no_integral(room: Room, entry: ConstraintEntry) -> Iterator[Contradiction]:
    """A velocity that all relations allow and that changes the function."""
    text, standing, evidence = integral_text(entry), room.standing, room.scenery.evidence
    if text is None or standing is None or not standing.accounted or room.nonlinear:
        return
    fields = tangent_fields(room, standing)
    if not fields:
        return
    given = {"at": standing.point.name, "fields": fields, "rows": standing.rows, "minor": room.minor(standing)}
    point, function = admissible(evidence, given, evidence.equations)[0], evidence.text(text)
    for one in fields:
        if not_zero(point.value(along(field_named(evidence, one), function))):
            yield Contradiction("the evidence gives a velocity that changes it")


def _held_at_edges(room: Room) -> Iterator[Contradiction]:
    """A motion, and for each inequality a point at which it holds, as an equality where no other was found."""
    if room.point is None:
        return
    places = {}
    for one in room.problem.relations:
        if one.kind == "inequality":
            place = room.search.meeting(one.name) or room.search.touching(one.name, 70)
            if place is None:
                return
            places[one.name] = room.add_point(place)
    claim = {"path": "/consistent", "rule": "point", "at": room.point.name, "inequalities": places}
    if consistent(room.scenery.evidence, claim, {}):
        yield Contradiction("the evidence gives True, not False", True)


def _met_together(room: Room, names: Sequence[str]) -> Iterator[Contradiction]:
    """A motion that meets all of what is said to be in conflict."""
    evidence = room.scenery.evidence
    rows = [one for name in names for one in evidence.owned(name)]
    if not rows or any(evidence.owned(name, ("inequality",)) for name in names) or room.scenery.cayley:
        return
    finite = [one for one in rows if evidence.relation(one).kind == "finite"]
    point = room.search.somewhere(finite, room.problem.coordinates, 400)
    if point is None:
        return
    room.add_point(point)
    standing = room.standing_of(rows, point=point)
    given: dict[str, Any] = {"rule": "point", "at": point.name}
    if standing is not None and standing.rows and not standing.dependent:
        given = {"rule": "regular", "minor": room.minor(standing)}
    moves(evidence, given, rows)
    yield Contradiction("the evidence gives a motion that meets them all")


NUMBERS: dict[str, Callable[[Room, Any], Iterator[Contradiction]]] = {
    "dof": _dof,
    "growth_vector": _growth,
    "generalized_coordinates": _generalized,
}
LABELS: dict[str, Callable[[Room, ConstraintEntry], Iterator[Contradiction]]] = {
    "circuit": _circuit,
    "integral": _no_integral,
}
