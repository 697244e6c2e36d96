"""Evidence for numbers of freedoms, independence and redundancy: one way after another, the best first."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.methods.certificates.forms import involutive_rows, integrable_names, orbit
from dofkit.methods.certificates.rigid_fields import covering
from dofkit.methods.certificates.room import Room, Standing, Told
from dofkit.report import ConstraintEntry


def consistent(room: Room) -> Iterator[Told]:
    """A point with a motion through it."""
    standing, timed = room.standing, room.scenery.timed
    inequalities = _inequalities(room)
    if room.report.consistent is False or standing is None or inequalities is None:
        return
    if standing.accounted and (standing.rows or timed):
        yield {"rule": "regular", "minor": room.minor(standing), "inequalities": inequalities}
    yield {"rule": "point", "at": standing.point.name, "inequalities": inequalities}


def _inequalities(room: Room) -> dict[str, str] | None:
    """For every inequality a point where it holds."""
    found: dict[str, str] = {}
    for one in room.problem.relations:
        if one.kind == "inequality":
            point = room.search.meeting(one.name)
            if point is None:
                return None
            found[one.name] = room.add_point(point)
    return found


def dof(room: Room) -> Iterator[Told]:
    """The dimension of the configuration space: everywhere where that is one line, else near the main point."""
    if not room.equations:
        yield {"rule": "nothing", "about": "everywhere"}
        return
    if room.report.verdicts["dof"].about == "everywhere":
        yield from _everywhere(room)
    yield from _near(room)


def _everywhere(room: Room) -> Iterator[Told]:
    if room.scenery.evidence.moving or room.scenery.cayley:
        return
    if order := graph_order(room):
        yield {"rule": "graph", "order": order, "about": "everywhere"}
    standing = room.standing
    if len(room.equations) == 1 and standing is not None and len(standing.rows) == 1:
        yield {"rule": "one relation", "minor": room.minor(standing), "about": "everywhere"}


def graph_order(room: Room) -> list[list[str]] | None:
    """Each relation with a coordinate that it alone gives, once those after it are taken away."""
    evidence = room.scenery.evidence
    left = list(evidence.finite)
    held = {name: symbols_in(evidence.relation(name).left) for name in left}
    order: list[list[str]] = []
    try:
        while left:
            found = next(
                (
                    [name, q]
                    for name in left
                    for q in room.problem.coordinates
                    if q in held[name]
                    and not any(q in held[other] for other in left if other != name)
                    and evidence.ring.rational(derivative(evidence.relation(name).left, q))
                ),
                None,
            )
            if found is None:
                return None
            order.insert(0, found)
            left.remove(found[0])
    except CheckError:
        return None
    return order


def _near(room: Room) -> Iterator[Told]:
    if room.scenery.evidence.moving:
        yield from orbit(room)
        return
    standing = room.standing
    if standing is None:
        return
    if standing.accounted:
        yield {"rule": "regular", "minor": room.minor(standing), "about": room.about}
    else:
        yield from _squeezed(room, standing)


def _squeezed(room: Room, standing: Standing) -> Iterator[Told]:
    """Rows that depend on others without a step: the rank is constant, by fields that keep blocks of them."""
    if (blocks := covering(room, standing)) is not None:
        minor = room.minor(standing)
        least = {"rule": "cover", "minor": minor, "blocks": blocks}
        yield {"rule": "squeeze", "most": {"rule": "minor", "minor": minor}, "least": least, "about": room.about}


def velocity_dof(room: Room) -> Iterator[Told]:
    """The independent velocities."""
    if not room.scenery.evidence.moving:
        yield {"rule": "count"}
    elif (standing := room.standing) is not None and standing.accounted:
        yield {"rule": "regular", "minor": room.minor(standing), "about": room.about}


def instantaneous(room: Room) -> Iterator[Told]:
    """The rank at the scene's configuration."""
    standing = room.standing if room.at_reference else None
    if standing is None:
        return
    found: dict[str, Any] = {"rule": "rank", "at": standing.point.name}
    if not standing.dependent and standing.rows:
        yield {**found, "minor": room.minor(standing), "dependent": {}}
    yield found


def counted(room: Room) -> Iterator[Told]:
    """What follows from other claims."""
    yield {"rule": "count"}


def compared(room: Room) -> Iterator[Told]:
    """Two numbers that differ, or do not."""
    yield {"rule": "compare"}


def redundant(room: Room) -> Iterator[Told]:
    """All relations follow from the others."""
    standing = room.standing
    if standing is not None and standing.accounted:
        yield {"rule": "cofactors", "minor": room.minor(standing)}


def generalized_coordinates(room: Room) -> Iterator[Told]:
    """The other coordinates are functions of these."""
    chosen = room.report.generalized_coordinates
    if chosen is None or room.finite_standing is None:
        return
    others = [q for q in room.problem.coordinates if q not in chosen]
    solving = room.solving(others)
    if solving is not None:
        yield {"rule": "minor", "minor": room.minor(solving)}
    if room.scenery.evidence.moving:
        for found in involutive_rows(room, integrable_names(room), others):
            yield {**found, "rule": "minor"}


def independent_count(room: Room) -> Iterator[Told]:
    """The finite relations that are independent."""
    standing = room.finite_standing
    if standing is not None and standing.accounted:
        yield {"rule": "independent", "minor": room.minor(standing)}


def independent(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """How many rows of a constraint are independent of those before."""
    if entry.form == "inequality":
        yield {"rule": "inequality"}
        return
    standing = room.standing
    if standing is None:
        return
    owners = [one.owner for one in room.problem.relations]
    place = {one.name: owners.index(one.owner) for one in room.problem.relations}
    last = owners.index(entry.name)
    yield {"rule": "independent", "minor": room.minor(standing, sum(place[row] <= last for row in standing.rows))}
