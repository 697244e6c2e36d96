"""Evidence for numbers of freedoms, independence and redundancy."""

from __future__ import annotations

from typing import Any

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.methods.certificates.forms import orbit
from dofkit.methods.certificates.rigid_fields import covering
from dofkit.methods.certificates.room import Room, Standing, Told


def consistent(room: Room, path: str) -> Told | None:
    """A point with a motion through it."""
    if room.report.consistent is False:
        return None
    inequalities = _inequalities(room)
    if inequalities is None:
        return None
    standing = room.standing
    if standing is not None and standing.accounted and (standing.rows or room.scenery.timed):
        return {"rule": "regular", "minor": room.minor(standing), "inequalities": inequalities}
    if standing is not None and not room.scenery.timed:
        return {"rule": "point", "at": standing.point.name, "inequalities": inequalities}
    return None


def _inequalities(room: Room) -> dict[str, str] | None:
    """For every inequality a point where it holds."""
    found: dict[str, str] = {}
    for one in room.problem.relations:
        if one.kind == "inequality":
            point = room.search.meeting(one.name)
            if point is None:
                return None
            room.scenery.parts["points"].append(point.entry())
            found[one.name] = point.name
    return found


def dof(room: Room, path: str) -> Told | None:
    """The dimension of the configuration space: everywhere where that is one line, else near the main point."""
    if not room.equations:
        return {"rule": "nothing", "about": "everywhere"}
    told = room.report.verdicts["dof"].about
    if told == "everywhere" and (found := _everywhere(room)):
        return found
    found = _near(room)
    if found is not None and told != room.about:
        room.uncovered.append("/verdicts/dof/about")
    return found


def _everywhere(room: Room) -> Told | None:
    if room.scenery.evidence.moving or room.scenery.cayley:
        return None
    if order := graph_order(room):
        return {"rule": "graph", "order": order, "about": "everywhere"}
    standing = room.standing
    if len(room.equations) == 1 and standing is not None and len(standing.rows) == 1:
        return {"rule": "one relation", "minor": room.minor(standing), "about": "everywhere"}
    return None


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


def _near(room: Room) -> Told | None:
    if room.scenery.evidence.moving:
        return orbit(room, "dof")
    standing = room.standing
    if standing is None:
        return None
    if standing.accounted:
        return {"rule": "regular", "minor": room.minor(standing), "about": room.about}
    return _squeezed(room, standing)


def _squeezed(room: Room, standing: Standing) -> Told | None:
    """Rows that depend on others without a step: the rank is constant, by fields that keep blocks of them."""
    if (blocks := covering(room, standing)) is None:
        return None
    minor = room.minor(standing)
    least = {"rule": "cover", "minor": minor, "blocks": blocks}
    return {"rule": "squeeze", "most": {"rule": "minor", "minor": minor}, "least": least, "about": room.about}


def velocity_dof(room: Room, path: str) -> Told | None:
    """The independent velocities."""
    if not room.scenery.evidence.moving:
        return {"rule": "count"}
    standing = room.standing
    told = room.report.verdicts["velocity_dof"].about
    if standing is None or not standing.accounted:
        return None
    if told != room.about:
        room.uncovered.append("/verdicts/velocity_dof/about")
    return {"rule": "regular", "minor": room.minor(standing), "about": room.about}


def instantaneous(room: Room, path: str) -> Told | None:
    """The rank at the scene's configuration."""
    standing = room.standing_of(room.equations) if room.at_reference else None
    if standing is None:
        return None
    found: dict[str, Any] = {"rule": "rank", "at": standing.point.name}
    if not standing.dependent and standing.rows:
        return {**found, "minor": room.minor(standing), "dependent": {}}
    return found


def counted(room: Room, path: str) -> Told:
    """What follows from other claims."""
    return {"rule": "compare" if path == "/singular" else "count"}


def redundant(room: Room, path: str) -> Told | None:
    """All relations follow from the others."""
    standing = room.standing
    if standing is None or not standing.accounted:
        return None
    return {"rule": "cofactors", "minor": room.minor(standing)}


def generalized_coordinates(room: Room, path: str) -> Told | None:
    """The other coordinates are functions of these."""
    chosen = room.report.generalized_coordinates
    standing = room.finite_standing
    if chosen is None or standing is None or room.point is None:
        return None
    others = [q for q in room.problem.coordinates if q not in chosen]
    if set(others) == set(standing.columns):
        return {"rule": "minor", "minor": room.minor(standing)}
    solving = room.solving(others)
    return None if solving is None else {"rule": "minor", "minor": room.minor(solving)}


def independent_count(room: Room, path: str) -> Told | None:
    """The finite relations that are independent."""
    standing = room.finite_standing
    if standing is None or not standing.accounted:
        return None
    return {"rule": "independent", "minor": room.minor(standing)}


def independent(room: Room, owner: str) -> Told | None:
    """How many rows of a constraint are independent of those before."""
    standing = room.standing
    if standing is None:
        return None
    owners = [one.owner for one in room.problem.relations]
    place = {one.name: owners.index(one.owner) for one in room.problem.relations}
    last = owners.index(owner)
    if not standing.accounted and any(place[name] <= last for name in standing.dependent):
        return None
    return {"rule": "independent", "minor": room.minor(standing, sum(place[row] <= last for row in standing.rows))}
