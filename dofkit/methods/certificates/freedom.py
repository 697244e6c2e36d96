"""Evidence for numbers of freedoms, independence and redundancy: one way after another, the best first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from dofkit.methods.certificates.dimension import everywhere, families, stationary, velocities_everywhere
from dofkit.methods.certificates.emptiness import inconsistent
from dofkit.methods.certificates.fields import backing, integrable_names, involutive_rows, orbit
from dofkit.methods.certificates.labels import integral_of_text
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.room import Room, Told, states_of
from dofkit.report import ConstraintEntry


def consistent(room: Room) -> Iterator[Told]:
    """A point with a motion through it."""
    if room.report.consistent is False:
        yield from inconsistent(room)
        return
    standing, inequalities = room.standing, _inequalities(room)
    if standing is None or inequalities is None:
        return
    if (backed := backing(room, standing)) is not None and (standing.rows or room.scenery.timed):
        yield {"rule": "regular", "minor": room.minor(standing), "inequalities": inequalities, **backed}
    yield {"rule": "point", "at": standing.point.name, "inequalities": inequalities}


def _inequalities(room: Room) -> dict[str, str] | None:
    """Return for every inequality a point where it holds, as an equality where no other was reached; else None."""
    places: dict[str, str] = {}
    for relation in room.problem.relations:
        if relation.kind == "inequality":
            point = _meeting(room, [relation.name]) or room.search.touching(relation.name, 70)
            if point is None:
                return None
            places[relation.name] = room.add_point(point)
    return places


def _meeting(room: Room, inequalities: list[str], seed: int = 100) -> FoundPoint | None:
    """Return a point at which inequalities hold, and the finite relations; if they hold velocities, all relations."""
    evidence = room.scenery.evidence
    moving = any(evidence.met_by(evidence.relation(name).tree) for name in inequalities)
    names, unknowns = states_of(room) if moving else (evidence.finite, room.problem.coordinates)
    return room.search.meeting(inequalities, names, unknowns, seed)


def dof(room: Room) -> Iterator[Told]:
    """The dimension of the configuration space: everywhere where that is one line, else near the main point."""
    if not room.equations:
        yield {"rule": "everywhere", "about": "everywhere"}
        return
    if room.report.verdicts["dof"].about == "everywhere":
        yield from everywhere(room)
    yield from _near(room)


def _near(room: Room) -> Iterator[Told]:
    if room.scenery.evidence.moving:
        yield from orbit(room)
        return
    standing = room.standing
    if standing is not None and (backed := backing(room, standing)) is not None:
        yield {"rule": "regular", "minor": room.minor(standing), "about": room.about, **backed}
    yield from stationary(room)
    if standing is not None and standing.dependent:
        most = {"rule": "minor", "minor": room.minor(standing)}
        for least in families(room, len(room.problem.coordinates) - len(standing.rows)):
            yield {"rule": "squeeze", "most": most, "least": least, "about": room.about}


def velocity_dof(room: Room) -> Iterator[Told]:
    """The independent velocities."""
    if not room.scenery.evidence.moving:
        yield {"rule": "count"}
        return
    if room.report.verdicts["velocity_dof"].about == "everywhere":
        yield from velocities_everywhere(room)
    standing = room.standing
    if standing is not None and (backed := backing(room, standing)) is not None:
        yield {"rule": "regular", "minor": room.minor(standing), "about": room.about, **backed}


def instantaneous(room: Room) -> Iterator[Told]:
    """The rank at the scene's configuration."""
    standing = room.standing if room.at_reference else None
    if standing is None:
        return
    claim: dict[str, Any] = {"rule": "rank", "at": standing.point.name}
    if not standing.dependent and standing.rows:
        yield {**claim, "minor": room.minor(standing)}
    yield claim


def counted(room: Room) -> Iterator[Told]:
    """What follows from other claims."""
    yield {"rule": "count"}


def redundant(room: Room) -> Iterator[Told]:
    """What is dropped follows from the rest."""
    dropped = set(room.report.redundant or [])
    names = sorted(room.equations, key=lambda name: room.owner(name) in dropped)
    standing = room.accounted(names)
    if standing is not None and (backed := backing(room, standing)) is not None:
        yield {"rule": "cofactors", "minor": room.minor(standing), **backed}
    if not dropped:
        yield from _needed(room)


def _needed(room: Room) -> Iterator[Told]:
    """For every constraint a minor of all rows of the others."""
    minors = {}
    for owner in dict.fromkeys(map(room.owner, room.equations)):
        standing = room.standing_of([name for name in room.equations if room.owner(name) != owner])
        if standing is None or standing.dependent:
            return
        minors[owner] = room.minor(standing)
    yield {"rule": "cofactors", "without": minors}


def generalized_coordinates(room: Room) -> Iterator[Told]:
    """The other coordinates are functions of these."""
    chosen = room.report.generalized_coordinates
    finite = room.finite_standing
    if chosen is None or finite is None:
        return
    others = [q for q in room.problem.coordinates if q not in chosen]
    solving = room.standing_of(finite.rows, others) if len(others) == len(finite.rows) else None
    if solving is not None and not solving.dependent:
        minor: Told = {"rule": "minor", "minor": room.minor(solving)}
        yield minor
        alone = {q for name in solving.rows if len(row := room.row(name, solving.point)) == 1 for q in row}
        tilts = {angles[1] for angles in room.problem.turns if not {*angles} <= alone}
        turned = room.standing_of(solving.rows, [q for q in room.problem.coordinates if q not in tilts])
        if turned is not None and not turned.dependent:
            yield {**minor, "beside": room.minor(turned)}
    if room.scenery.evidence.moving:
        yield from involutive_rows(room, integrable_names(room), others)


def independent(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """How many rows of a constraint are independent of those before."""
    if entry.form == "inequality":
        yield {"rule": "inequality"}
        return
    standing, order = room.standing, room.finite_first
    last = max((k for k, name in enumerate(order) if room.owner(name) == entry.name), default=-1)
    rows = order[: last + 1]
    if standing is None or not rows:
        return
    size = len(set(rows).intersection(standing.rows))
    dependent = [name for name in standing.dependent if name in set(rows)]
    upto = replace(standing, rows=standing.rows[:size], columns=standing.columns[:size], dependent=dependent)
    upto.accounted = standing.accounted or not dependent
    if (backed := backing(room, upto)) is not None:
        yield {"rule": "independent", "minor": room.minor(upto), **backed}
    if len(rows) == len(room.equations):
        yield {"rule": "independent", "minor": room.minor(upto), "last": True}


def circuit(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The constraint follows from those of its circuit, and from no fewer."""
    members, evidence = entry.circuit, room.scenery.evidence
    if members is None or room.point is None:
        return
    equations = list(evidence.owned(entry.name))
    rows = {name: list(evidence.owned(name)) for name in members}
    whole = room.accounted([*(row for name in members for row in rows[name]), *equations])
    backed = backing(room, whole)
    minimal = {}
    for name in members:
        others = [row for other in members if other != name for row in rows[other]]
        for equation in equations:
            standing = room.standing_of([*others, equation])
            if standing is not None and not standing.dependent:
                minimal[name] = {"minor": room.minor(standing)}
                break
    if backed is not None and len(minimal) == len(members):
        yield {"rule": "cofactors", "at": room.point.name, "minimal": minimal, **backed}


def feasible(room: Room) -> Iterator[Told]:
    """A point at which everything holds."""
    inequalities = [relation.name for relation in room.problem.relations if relation.kind == "inequality"]
    for point in (room.point, _meeting(room, inequalities, 200)) if room.report.feasible else ():
        standing = None if point is None else room.standing_of(room.equations, point=point)
        if standing is not None:
            minor = {"minor": room.minor(standing)}
            yield {"rule": "point", "at": room.add_point(standing.point), **minor}
            yield {"rule": "regular", **minor}


def integrable_part(room: Room) -> Iterator[Told]:
    """Finite rows, and integrals for the texts of the basis."""
    part, finite = room.report.integrable_part, room.finite_standing
    if part is None or finite is None:
        return
    yield {"rule": "integrals", "minor": room.minor(finite), "steps": []}
    steps = [step for text in part.basis or [] if (step := integral_of_text(room, text))]
    standing = room.standing_of([*finite.rows, *steps])
    if steps and standing is not None:
        yield {"rule": "integrals", "minor": room.minor(standing), "steps": steps}
