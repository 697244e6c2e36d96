"""Fields that keep relations whatever they are: motions of all particles and bodies together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from dofkit.checker.evidence import field_named, on_row
from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.elimination import echelon
from dofkit.methods.certificates.estimates import Estimates
from dofkit.methods.certificates.room import Room, Standing, Told
from dofkit.methods.certificates.scenery import Scenery

_AXES = "xyz"


def places_of(document: Mapping[str, Any], dimension: int) -> list[tuple[list[str], str]]:
    """The coordinates of every particle and body of the plane: its place, and its angle or ""."""
    found = []
    for key in ("particles", "bodies"):
        for entry in document.get(key) or []:
            given = {"name": entry} if isinstance(entry, str) else entry
            roles = _AXES[:dimension] if dimension < 3 or key == "particles" else ""
            names = given.get("coordinates") or [f"{role}_{given['name']}" for role in roles]
            angle = (given.get("coordinates") or [f"theta_{given['name']}"])[-1] if key == "bodies" else ""
            if roles:
                found.append((list(names[:dimension]), angle if dimension == 2 else ""))
    return found


def motions(document: Mapping[str, Any], dimension: int) -> list[dict[str, str]]:
    """Translations and rotations as fields; none where a body of space occurs."""
    places = places_of(document, dimension)
    if dimension == 3 and document.get("bodies"):
        return []
    found = [{place[i]: "1" for place, _ in places} for i in range(dimension)]
    for i in range(dimension):
        for j in range(i):
            turn = {place[j]: f"-{place[i]}" for place, _ in places} | {place[i]: place[j] for place, _ in places}
            found.append(turn | {angle: "1" for _, angle in places if angle})
    return found


def backing(room: Room, standing: Standing | None) -> Told | None:
    """What a claim says besides its minor so that all relations follow: nothing, or covers; None where they do not."""
    if standing is None:
        return None
    if standing.accounted:
        return {}
    if (blocks := covering(room, standing)) is None:
        return None
    covers, given = room.scenery.parts["covers"], {"minor": room.minor(standing), "blocks": blocks}
    for one in covers:
        if all(one[key] == value for key, value in given.items()):
            return {"covers": [one["id"]]}
    covers.append({"id": f"cover{len(covers)}", **given})
    return {"covers": [covers[-1]["id"]]}


def covering(room: Room, standing: Standing) -> list[Told] | None:
    """Blocks of relations whose rank is told by how many there are, or by rigid motions."""
    scenery, blocks = room.scenery, []
    candidates = motions(room.document, room.problem.world.dimension)
    known = {*standing.rows, *standing.dependent}
    finite = [name for name in scenery.evidence.finite if name in known]
    for names in parts_of(scenery, finite):
        rank = sum(row in names for row in standing.rows)
        if rank == len(names):
            blocks.append({"rows": names, "fields": [], "columns": []})
            continue
        held = {symbol for name in names for symbol in scenery.evidence.relation(name).left.symbols}
        own = [q for q in room.problem.coordinates if q in held]
        fields = [{q: text for q, text in one.items() if q in held} for one in candidates]
        columns = _chosen(scenery, fields, standing)
        ids = [field_id(scenery, {"components": fields[place]}) for place, _ in columns]
        if len(own) - rank != len(ids) or not _kept(scenery, ids, names):
            return None
        blocks.append({"rows": names, "fields": ids, "columns": [column for _, column in columns]})
    return blocks


def kept_motions(room: Room, columns: Sequence[str]) -> dict[str, str]:
    """Motions of all together that keep all finite relations, each with a column: independent at the main point."""
    scenery, estimates = room.scenery, Estimates(room.point.floats if room.point else {})
    finite = list(scenery.evidence.finite)
    ids = [field_id(scenery, {"components": one}) for one in motions(room.document, room.problem.world.dimension)]
    kept = [one for one in ids if _kept(scenery, [one], finite)]
    fields = [field_named(scenery.evidence, one) for one in kept]
    rows = [{q: estimates.value(tree) for q, tree in one.items() if q in columns} for one in fields]
    return {kept[p.row]: p.column for p in echelon(rows).pivots}


def parts_of(scenery: Scenery, names: list[str]) -> list[list[str]]:
    """Relations that share coordinates, together."""
    coordinates = set(scenery.problem.coordinates)
    held = {name: scenery.evidence.relation(name).left.symbols for name in names}
    moved = {name: {s for q in coordinates for s in (q, f"{q}dot") if s in held[name]} for name in names}
    found: list[tuple[set[str], list[str]]] = []
    for name in names:
        own, members = {s.removesuffix("dot") if s not in coordinates else s for s in moved[name]}, [name]
        rest = []
        for symbols, others in found:
            if symbols & own:
                own, members = own | symbols, others + members
            else:
                rest.append((symbols, others))
        found = [*rest, (own, members)]
    order = {name: place for place, name in enumerate(names)}
    return [sorted(members, key=order.__getitem__) for _, members in found]


def _chosen(scenery: Scenery, fields: list[dict[str, str]], standing: Standing) -> list[tuple[int, str]]:
    """Independent fields at the point, each with a column."""
    estimates = Estimates(standing.point.floats)
    rows = [{q: estimates.value(scenery.evidence.text(text)) for q, text in one.items()} for one in fields]
    return [(p.row, p.column) for p in echelon(rows).pivots]


def _kept(scenery: Scenery, ids: list[str], names: list[str]) -> bool:
    try:
        found = [field_named(scenery.evidence, one) for one in ids]
        return all(scenery.evidence.ring.vanishes(on_row(scenery.evidence, row, one)) for one in found for row in names)
    except CheckError:
        return False


def field_id(scenery: Scenery, given: Told) -> str:
    """The id of a field, new or known."""
    fields = scenery.parts["fields"]
    for one in fields:
        if all(one.get(key) == value for key, value in given.items()):
            return str(one["id"])
    fields.append({"id": f"X{len(fields)}", **given})
    return str(fields[-1]["id"])
