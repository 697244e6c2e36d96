"""Velocity fields: rigid motions, fields by Cramer's rule, words of brackets, orbits, growth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from networkx.utils import UnionFind

from dofkit.checker.evidence import CheckedEvidence, VelocityField, bracket, field_named, on_row
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, add, negative, times
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError, echelon
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.room import Room, Standing, Told
from dofkit.methods.certificates.scenery import Scenery, text_of

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


def parts_of(scenery: Scenery, names: Sequence[str]) -> list[list[str]]:
    """Return the relations in groups that share no coordinate."""
    classes, groups = UnionFind(), dict[Any, list[str]]()
    for name in names:
        held = scenery.evidence.relation(name).left.symbols
        classes.union((name,), *(q for q in scenery.problem.coordinates if not held.isdisjoint((q, f"{q}dot"))))
    for name in names:
        groups.setdefault(classes[name,], []).append(name)
    return list(groups.values())


def _chosen(scenery: Scenery, fields: list[dict[str, str]], standing: Standing) -> list[tuple[int, str]]:
    """Independent fields at the point, each with a column."""
    estimates = Estimates(standing.point.floats)
    rows = [{q: estimates.value(scenery.evidence.text(text)) for q, text in one.items()} for one in fields]
    return [(p.row, p.column) for p in echelon(rows).pivots]


def _kept(scenery: Scenery, ids: Sequence[str], names: Sequence[str]) -> bool:
    """Return whether fields are tangent to relations, identically."""
    evidence = scenery.evidence

    def is_tangent(field: str, row: str) -> bool:
        return evidence.ring.vanishes(on_row(evidence, row, field_named(evidence, field)))

    try:
        return all(evidence.once(("kept", a, row), partial(is_tangent, a, row)) for a in ids for row in names)
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


# Evidence about what velocities allow: fields by Cramer's rule, words of brackets, orbits, growth.

#: The most rows of a determinant that is written out; the longest word, and the most words of a length.
LARGEST_CRAMER, LONGEST, MOST_WORDS = 5, 7, 60


@dataclass
class Words:
    """Fields tangent to rows, and words of them by levels that are independent at the point, each with a column."""

    fields: list[str]
    rows: list[str]
    words: list[list[str]]
    columns: list[str]
    vectors: list[dict[str, float]]
    levels: list[int]


def tangent_fields(room: Room, standing: Standing) -> list[str] | None:
    """Fields that span the kernel of rows: one for every coordinate (and time) that is no column."""
    scenery, pairs = room.scenery, dict(zip(standing.rows, standing.columns, strict=True))
    evidence = scenery.evidence
    timed = any(not {"t", "tdot"}.isdisjoint(evidence.relation(row).left.symbols) for row in standing.rows)
    free = [q for q in (*room.problem.coordinates, *(["t"] if timed else [])) if q not in pairs.values()]
    found = []
    for one in free:
        touched = _touched(room, standing, one)
        if len(touched) > LARGEST_CRAMER:
            return None
        components = _by_cramer(evidence, touched, [pairs[row] for row in touched], one)
        found.append(field_id(scenery, {"components": components}))
    return found


def _by_cramer(evidence: CheckedEvidence, rows: Sequence[str], columns: Sequence[str], free: str) -> dict[str, str]:
    """The field with the determinant of the columns at ``free``, and Cramer's numerators at the columns."""

    def minor(names: Sequence[str]) -> Tree:
        return determinant([[evidence.slope(row, name) for name in names] for row in rows])

    found = {free: minor(columns)}
    for place, column in enumerate(columns):
        found[column] = negative(minor([*columns[:place], free, *columns[place + 1 :]]))
    return {name: text_of(tree) for name, tree in found.items() if tree != ZERO}


def _touched(room: Room, standing: Standing, free: str) -> list[str]:
    """The rows that move together when one free coordinate moves."""
    evidence = room.scenery.evidence
    parts = parts_of(room.scenery, standing.rows)
    if free == "t":
        moved = [part for part in parts if any(_holds(evidence.relation(row).left, "t") for row in part)]
    else:
        moved = [part for part in parts if any(_holds(evidence.relation(row).left, free) for row in part)]
    return [row for row in standing.rows if any(row in part for part in moved)]


def _holds(tree: Tree, name: str) -> bool:
    return not {name, f"{name}dot"}.isdisjoint(tree.symbols)


def words_of(room: Room, standing: Standing, most: int) -> Words | None:
    """Left-normed brackets, level by level, until ``most`` are independent at the point or nothing new comes."""
    key = (*standing.rows, "", *standing.columns, str(most))
    if key not in room.words:
        try:
            fields = tangent_fields(room, standing)
            room.words[key] = _grown(room, standing, fields, most) if fields else None
        except (CheckError, NoEstimateError, RecursionError):
            room.words[key] = None
    found: Words | None = room.words[key]
    return found


def reach(room: Room) -> int:
    """How many directions all words of the scene's fields span at most, as far as it is told."""
    whole = len(room.problem.coordinates) if room.report.dof is None else room.report.dof
    return whole + room.scenery.evidence.timed


def _grown(room: Room, standing: Standing, fields: list[str], most: int) -> Words:
    estimates = Estimates(standing.point.floats, slopes=False)
    chosen = room.scenery.chosen
    bases: dict[str, VelocityField] = {
        one: {q: chosen(tree) for q, tree in field_named(room.scenery.evidence, one).items()} for one in fields
    }
    level = [([one], bases[one]) for one in fields]
    words: list[list[str]] = []
    vectors: list[dict[str, float]] = []
    columns: list[str] = []
    levels: list[int] = []
    for _ in range(LONGEST):
        fresh = []
        for word, value in level:
            vector = {q: estimates.value(tree) for q, tree in value.items()}
            pivots = echelon([*vectors, vector]).pivots
            if len(pivots) > len(vectors):
                words.append(word)
                vectors.append(vector)
                columns = [p.column for p in pivots]
                fresh.append((word, value))
        levels.append(len(words))
        if len(words) >= most or not fresh:
            break
        level = [
            ([*word, one], bracket(room.scenery.evidence, value, bases[one]))
            for word, value in fresh
            for one in fields
            if word != [one]
        ]
        level = level[:MOST_WORDS]
    return Words(fields, list(standing.rows), words, columns, vectors, levels)


def orbit(room: Room) -> Iterator[Told]:
    """dof of a scene with forms: from below what brackets reach, from above finite rows and what integrates."""
    standing, told = room.standing, room.report.dof
    if standing is None or not standing.accounted or told is None or room.nonlinear:
        return
    least = _least(room, standing, told)
    if least is None:
        return
    for most in _most(room, told):
        yield {"rule": "squeeze", "most": most, "least": least, "about": room.about}


def _least(room: Room, standing: Standing, told: int) -> Told | None:
    size = len(room.problem.coordinates)
    if told == size - len(standing.rows):
        return {"rule": "regular", "minor": room.minor(standing)}
    words = words_of(room, standing, reach(room))
    if words is None:
        return None
    moves = any("t" in vector for vector in words.vectors)
    return {
        "rule": "span",
        "at": standing.point.name,
        "fields": words.fields,
        "rows": words.rows,
        "words": words.words[: told + moves],
        "columns": _columns(words, told + moves),
    }


def _columns(words: Words, count: int) -> list[str]:
    return [p.column for p in echelon(words.vectors[:count]).pivots]


def _most(room: Room, told: int) -> Iterator[Told]:
    finite = room.finite_standing
    if finite is not None and told >= len(room.problem.coordinates) - len(finite.rows):
        yield {"rule": "minor", "minor": room.minor(finite)}
    yield from involutive_rows(room, integrable_names(room))


def integrable_names(room: Room) -> list[str]:
    """The finite relations, and the forms that are said to be holonomic."""
    owners = {entry.name for entry in room.report.constraints if entry.holonomic}
    return [one.name for one in room.problem.relations if one.kind != "inequality" and one.owner in owners]


def involutive_rows(room: Room, names: Sequence[str], columns: Sequence[str] | None = None) -> Iterator[Told]:
    """Rows whose kernel is closed under brackets, for the rule `frobenius`; ``columns`` those of the minor."""
    standing = room.standing_of(names, columns)
    if standing is None or not standing.rows or (columns is not None and len(columns) != len(standing.rows)):
        return
    fields = tangent_fields(room, standing)
    if fields is not None:
        free = [q for q in (*room.problem.coordinates, "t") if q not in standing.columns][: len(fields)]
        yield {"rule": "frobenius", "minor": room.minor(standing), "fields": fields, "columns": free}


def growth_vector(room: Room) -> Iterator[Told]:
    """Words for every entry, of as many entries as are claimed, and until nothing new comes."""
    standing, told = room.standing, room.report.growth_vector
    if standing is None or not standing.accounted or not told or room.nonlinear:
        return
    words = words_of(room, standing, reach(room))
    if words is None:
        return
    given = {"rule": "span", "at": standing.point.name, "fields": words.fields, "rows": words.rows}
    given["minor"] = room.minor(standing)
    for steps in sorted({len(told), len(words.levels)}, reverse=True):
        levels = [*words.levels, *words.levels[-1:] * steps][:steps]
        yield {**given, "spans": [{"words": words.words[:k], "columns": _columns(words, k)} for k in levels]}


def pairing(room: Room, name: str, point: FoundPoint, vector: dict[str, float]) -> float:
    """The value of a form in a direction."""
    rates = {f"{q}dot": vector.get(q, 0.0) for q in (*room.problem.coordinates, "t")}
    return Estimates({**point.floats, **rates}).value(room.scenery.left(name))


def determinant(rows: list[list[Tree]]) -> Tree:
    """A small determinant."""
    if not rows:
        return ONE
    parts = []
    for j, entry in enumerate(rows[0]):
        rest = determinant([[*row[:j], *row[j + 1 :]] for row in rows[1:]])
        parts.append(times(entry, rest) if j % 2 == 0 else negative(times(entry, rest)))
    return add(*parts)
