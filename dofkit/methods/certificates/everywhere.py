"""Evidence that no part of the set is larger: graphs, single relations, relations with symbols of their own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.forms import orbit
from dofkit.methods.certificates.rigid_fields import backing
from dofkit.methods.certificates.room import Room, Standing, Told

Order = list[list[str]]


def everywhere(room: Room) -> Iterator[Told]:
    """dof of the whole set; with forms from that near the main point."""
    if room.scenery.cayley or room.standing is None:
        return
    evidence, finite = room.scenery.evidence, room.finite_standing
    if not evidence.moving:
        yield from _of_set(room, room.standing)
        return
    for local in orbit(room):
        for parts in _of_forms(room):
            yield {**local, **parts}
        for parts in _of_set(room, finite) if finite is not None else ():
            yield {**local, **parts}


def velocities_everywhere(room: Room) -> Iterator[Told]:
    """The independent velocities, at the whole set."""
    if not room.scenery.cayley and room.standing is not None:
        yield from _of_forms(room)


def _of_forms(room: Room) -> Iterator[Told]:
    """All relations in an order; or the finite ones, and a single form."""
    evidence, standing = room.scenery.evidence, room.standing
    if standing is None or not standing.accounted:
        return
    found = {"rule": "everywhere", "about": "everywhere", "minor": room.minor(standing)}
    order, left = graph_order(room, _needed(standing, evidence.equations))
    moving = _needed(standing, evidence.moving)
    if not left:
        yield {**found, "order": order}
    elif len(moving) == 1:
        order, left = graph_order(room, _needed(standing, evidence.finite))
        if not left:
            yield {**found, "order": order, "blocks": moving}


def _needed(standing: Standing, names: Sequence[str]) -> list[str]:
    """Relations without those that follow from the rows."""
    return [name for name in names if not (standing.accounted and name in standing.dependent)]


def _of_set(room: Room, standing: Standing) -> Iterator[Told]:
    """What the geometric equations define."""
    evidence = room.scenery.evidence
    finite = _needed(standing, evidence.finite)
    order, left = graph_order(room, finite, columns=["t"])
    found: Told = {"rule": "everywhere", "about": "everywhere"}
    if not left:
        yield {**found, "order": order}
    found["minor"] = room.minor(standing)
    if not left:
        yield {**found, "order": order}
    own = own_symbols(room)
    if not standing.dependent or standing.accounted:
        for tried, rest in ((order, left), given_first(room, finite), ([], finite)):
            blocks, generic = _split(room, tried, rest, own)
            if all(name in own for name in generic):
                yield {**found, "order": tried, "blocks": blocks, "generic": [[name, own[name]] for name in generic]}
    if all(name in own for name in evidence.finite) and (backed := backing(room, standing)):
        yield {**found, "generic": [[name, own[name]] for name in evidence.finite], **backed}


def graph_order(room: Room, names: Sequence[str] | None = None, columns: Sequence[str] = ()) -> tuple[Order, list[str]]:
    """Relations with a coordinate that each alone gives, once those after it are taken away; and those left over.

    ``names``: the finite ones where it is left out; ``columns``: what may be given besides coordinates.
    """
    left, columns = (
        list(room.scenery.evidence.finite if names is None else names),
        [*room.problem.coordinates, *columns],
    )
    held = {name: _moved(room, name) for name in left}
    order: Order = []
    found: list[str] | None = []
    while left and found is not None:
        found = next(
            (
                [name, q]
                for q in columns
                for name in left
                if q in held[name]
                and not any(q in held[other] for other in left if other != name)
                and _gives(room, name, q)
            ),
            None,
        )
        if found is not None:
            order.insert(0, found)
            left.remove(found[0])
    return order, left


def _moved(room: Room, name: str) -> set[str]:
    """The variables of a finite relation; those with velocities in another."""
    one = room.scenery.evidence.relation(name)
    held = one.left.symbols
    if one.kind == "finite":
        return set(held) & set(room.scenery.evidence.variables)
    return {q for q in room.problem.coordinates if f"{q}dot" in held}


def given_first(room: Room, names: Sequence[str]) -> tuple[Order, list[str]]:
    """Relations that give a coordinate which those chosen before do not hold, short ones first; and the others."""
    coordinates = room.problem.coordinates
    held = {name: room.scenery.evidence.relation(name).left.symbols & set(coordinates) for name in names}
    order: Order = []
    taken: set[str] = set()
    for name in sorted(held, key=lambda one: len(held[one])):
        fit = [q for q in coordinates if q in held[name] and q not in taken and _gives(room, name, q)]
        if fit:
            order.append([name, fit[0]])
            taken |= held[name]
    return order, [name for name in names if all(name != chosen for chosen, _ in order)]


def _gives(room: Room, name: str, q: str) -> bool:
    """Whether a relation gives a coordinate with a factor of numbers and parameters."""
    evidence = room.scenery.evidence
    try:
        slope = evidence.slope(name, q)
        plain = slope.symbols <= evidence.chosen and room.point is not None and room.differs(slope, room.point)
        return plain or bool(evidence.ring.rational(slope))
    except CheckError:
        return False


def own_symbols(room: Room) -> dict[str, str]:
    """For each relation a generic symbol or parameter that occurs in no other."""
    relations = room.problem.relations
    held = {one.name: one.left.symbols for one in relations}
    found: dict[str, str] = {}
    for one in relations:
        for symbol in (*room.problem.world.generic, *room.problem.world.signs):
            if symbol in held[one.name] and not any(symbol in held[other] for other in held if other != one.name):
                found.setdefault(one.name, symbol)
    return found


def _split(room: Room, order: Order, left: list[str], own: dict[str, str]) -> tuple[list[str], list[str]]:
    """What is left as single relations, and those that share coordinates."""
    given: dict[str, frozenset[str]] = {}
    coordinates = set(room.problem.coordinates)

    def free(name: str) -> frozenset[str]:
        held = room.scenery.evidence.relation(name).left.symbols & coordinates
        return frozenset().union(*(given.get(q, frozenset((q,))) for q in held))

    for name, q in order:
        given[q] = free(name) - {q}
    sets = {name: free(name) for name in left}
    alone = [name for name in left if all(sets[name].isdisjoint(sets[other]) for other in left if other != name)]
    return alone, [name for name in left if name not in alone]
