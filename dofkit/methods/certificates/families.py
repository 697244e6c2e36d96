"""Families of configurations: linear relations that hold along a motion, from which all others follow."""

from __future__ import annotations

import random
from collections.abc import Iterator
from fractions import Fraction

from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.dependence import accounted
from dofkit.methods.certificates.elimination import SMALL, echelon
from dofkit.methods.certificates.estimates import NoEstimateError
from dofkit.methods.certificates.room import Room, Told
from dofkit.methods.certificates.texts import number_text

#: The size of a step along a motion, of what is added by chance, and the largest denominator of a coefficient.
STEP, NOISE, DENOMINATOR = 0.25, 0.05, 60
#: Scenes are followed up to this product of the size of their relations and of the number of their coordinates.
MOST_FOLLOWED = 6000
Samples = list[dict[str, float]]


def families(room: Room, size: int) -> Iterator[Told]:
    """The rule `family` with so many freedoms, for some motions through the main point."""
    size_of_all = sum(one.left.size for one in room.problem.relations) * len(room.problem.coordinates)
    if room.point is None or room.scenery.evidence.moving or size_of_all > MOST_FOLLOWED:
        return
    for seed in range(2):
        try:
            found = _family(room, size, seed)
        except (CheckError, NoEstimateError):
            continue
        if found is not None:
            yield found


def _family(room: Room, size: int, seed: int) -> Told | None:
    point, scenery = room.point, room.scenery
    if point is None:
        return None
    assumed = []
    for i, text in enumerate(_linear_relations(room, _samples(room, seed))):
        step = f"{scenery.label}family {seed}.{i}"
        if not scenery.has_step(step):
            scenery.add_step({"id": step, "by": "assumed", "function": text})
        assumed.append(step)
    standing = room.standing_of([*assumed, *scenery.evidence.finite])
    if standing is None or len(standing.rows) != len(room.problem.coordinates) - size:
        return None
    left = [name for name in standing.dependent if name not in assumed]
    if not all(accounted(scenery, name, standing.rows, point, f"family {seed}") for name in left):
        return None
    minor = {"at": point.name, "rows": standing.rows, "columns": standing.columns}
    return {"rule": "family", "minor": minor}


def _samples(room: Room, seed: int) -> Samples:
    """Configurations along a motion that leaves the main point: as many as span its linear hull."""
    drawn, found = random.Random(seed), Samples()
    coordinates = room.problem.coordinates
    now = before = dict(room.point.floats) if room.point is not None else {}
    for place in range(len(coordinates) + 4):
        far = max((abs(now[q] - before[q]) for q in coordinates), default=0.0)
        noise = NOISE if place else STEP
        moved = {
            q: now[q] + (now[q] - before[q]) * STEP / (far or 1.0) + noise * drawn.uniform(-1, 1) for q in coordinates
        }
        start = {name: Fraction(value) for name, value in {**now, **moved}.items()}
        reached = room.search.approached(start, room.equations, set(coordinates))
        if reached is not None:
            found.append(reached)
            before, now = now, reached
    return found


def _linear_relations(room: Room, samples: Samples) -> Iterator[str]:
    """Texts that are 0 at the main point and at all samples, linear with rational coefficients, each in few terms."""
    point, coordinates = room.point, room.problem.coordinates
    if point is None or not samples:
        return
    rows = [{q: one[q] - point.floats[q] for q in coordinates} for one in samples]
    basis = reduced_rows(rows)
    for q in coordinates:
        if q in basis:
            continue
        terms = {p: row.get(q, 0.0) for p, row in basis.items()}
        short = {p: Fraction(value).limit_denominator(DENOMINATOR) for p, value in terms.items()}
        if all(abs(float(short[p]) - value) < 1e-6 for p, value in terms.items()):
            parts = [(q, Fraction(1)), *((p, -value) for p, value in short.items() if value)]
            yield " + ".join(f"({number_text(c)})*{_from(point.values[p], p)}" for p, c in parts)


def _from(value: str, q: str) -> str:
    return q if value == "0" else f"({q} - ({value}))"


def reduced_rows(rows: Samples) -> dict[str, dict[str, float]]:
    """A basis of what rows span, by pivots: in each row the pivot's entry is 1, and those of the other pivots are 0."""
    found: dict[str, dict[str, float]] = {}
    for pivot in echelon(rows).pivots:
        row = dict(rows[pivot.row])
        for column, other in found.items():
            factor = row.get(column, 0.0)
            row = {q: value - factor * other.get(q, 0.0) for q, value in row.items()}
        lead = row[pivot.column]
        if abs(lead) < SMALL:
            continue
        row = {q: value / lead for q, value in row.items()}
        for column, other in found.items():
            factor = other[pivot.column]
            found[column] = {q: value - factor * row[q] for q, value in other.items()}
        found[pivot.column] = row
    return found
