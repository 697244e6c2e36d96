"""Evidence that no part of the set is larger: graphs, single relations, relations with symbols of their own."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.rigid_fields import backing
from dofkit.methods.certificates.room import Room, Told

Order = list[list[str]]


def everywhere(room: Room) -> Iterator[Told]:
    """dof of the whole set."""
    evidence, standing = room.scenery.evidence, room.standing
    if evidence.moving or room.scenery.cayley or standing is None:
        return
    order, left = graph_order(room)
    found: Told = {"rule": "everywhere", "about": "everywhere", "order": order}
    if not left:
        yield found
    own = own_symbols(room)
    if not standing.dependent:
        for tried, rest in ((order, left), given_first(room), ([], list(evidence.finite))):
            blocks, generic = _split(room, tried, rest, own)
            if all(name in own for name in generic):
                pairs = [[name, own[name]] for name in generic]
                parts = {"order": tried, "blocks": blocks, "generic": pairs}
                yield {**found, **parts, "minor": room.minor(standing)}
    if all(name in own for name in evidence.finite) and (backed := backing(room, standing)):
        pairs = [[name, own[name]] for name in evidence.finite]
        minor = room.minor(standing)
        yield {"rule": "everywhere", "about": "everywhere", "order": [], "generic": pairs, "minor": minor, **backed}


def graph_order(room: Room) -> tuple[Order, list[str]]:
    """Relations with a coordinate that each alone gives, once those after it are taken away; and those left over."""
    evidence = room.scenery.evidence
    left = list(evidence.finite)
    held = {name: symbols_in(evidence.relation(name).left) for name in left}
    order: Order = []
    found: list[str] | None = []
    while left and found is not None:
        found = next(
            (
                [name, q]
                for name in left
                for q in room.problem.coordinates
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


def given_first(room: Room) -> tuple[Order, list[str]]:
    """Relations that give a coordinate which those chosen before do not hold, short ones first; and the others."""
    evidence = room.scenery.evidence
    coordinates = room.problem.coordinates
    held = {name: symbols_in(evidence.relation(name).left) & set(coordinates) for name in evidence.finite}
    order: Order = []
    taken: set[str] = set()
    for name in sorted(held, key=lambda one: len(held[one])):
        fit = [q for q in coordinates if q in held[name] and q not in taken and _gives(room, name, q)]
        if fit:
            order.append([name, fit[0]])
            taken |= held[name]
    return order, [name for name in evidence.finite if all(name != chosen for chosen, _ in order)]


def _gives(room: Room, name: str, q: str) -> bool:
    evidence = room.scenery.evidence
    try:
        return bool(evidence.ring.rational(derivative(evidence.relation(name).left, q)))
    except CheckError:
        return False


def own_symbols(room: Room) -> dict[str, str]:
    """For each relation a generic symbol or parameter that occurs in no other."""
    relations = room.problem.relations
    held = {one.name: symbols_in(one.left) for one in relations}
    found: dict[str, str] = {}
    for one in relations:
        for symbol in (*room.problem.generic, *room.problem.parameters):
            if symbol in held[one.name] and not any(symbol in held[other] for other in held if other != one.name):
                found.setdefault(one.name, symbol)
    return found


def _split(room: Room, order: Order, left: list[str], own: dict[str, str]) -> tuple[list[str], list[str]]:
    """What is left as single relations, and those that share coordinates."""
    given: dict[str, frozenset[str]] = {}
    coordinates = set(room.problem.coordinates)

    def free(name: str) -> frozenset[str]:
        held = symbols_in(room.scenery.evidence.relation(name).left) & coordinates
        return frozenset().union(*(given.get(q, frozenset((q,))) for q in held))

    for name, q in order:
        given[q] = free(name) - {q}
    sets = {name: free(name) for name in left}
    alone = [name for name in left if all(sets[name].isdisjoint(sets[other]) for other in left if other != name)]
    return alone, [name for name in left if name not in alone]
