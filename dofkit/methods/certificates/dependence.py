"""Rows that follow from others: cofactors by linear algebra over the rationals."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.elimination import echelon, solved
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.substitutions import needed_puts, puts, solved_pairs, with_puts
from dofkit.methods.certificates.texts import number_text


def accounted(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint) -> bool:
    """Whether a step was found by which a relation follows from others near the point."""
    own = scenery.evidence.relation(name)
    kinds = [row for row in rows if scenery.evidence.relation(row).kind == own.kind]
    if own.kind == "velocity":
        kinds += [rate for row in rows if row not in kinds and (rate := rate_of(scenery, row))]
    step = f"{scenery.label}{name} from others"
    if scenery.has_step(step):
        return True
    try:
        factors = constant_cofactors(scenery, name, kinds, point)
        found = None if factors is None else {"c": {row: number_text(value) for row, value in factors.items()}}
        if found is None and own.kind == "finite":
            found = _put(scenery, name, kinds, point)
        if found is not None:
            scenery.add_step({"id": step, "by": "implied", "of": name, **found})
    except (CheckError, NoEstimateError):
        return False
    return found is not None


def _put(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint) -> dict[str, Any] | None:
    """That nothing of a relation is left once coordinates that others give are put in; None where something is."""
    left = scenery.evidence.relation(name).left
    order = puts(scenery, [*solved_pairs(scenery, rows, point), *rows])
    if not scenery.evidence.ring.vanishes(with_puts(scenery, left, order)):
        return None
    return {"c": {}, "put": needed_puts(scenery, [left], order)}


def rate_of(scenery: Scenery, name: str) -> str:
    """The id of a step for the rate of a finite relation; "" where it does not stand up."""
    step = f"{scenery.label}rate of {name}"
    if step in scenery.evidence.known:
        return step
    try:
        scenery.add_step({"id": step, "by": "rate", "of": name})
    except CheckError:
        return ""
    return step


def constant_cofactors(
    scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint
) -> dict[str, Fraction] | None:
    """Numbers c with relation = sum c_i row_i, as they seem from the point and one other; None where there are none."""
    coordinates = [s for q in scenery.problem.coordinates for s in (q, f"{q}dot")]
    rates = {f"{q}dot": 0.0 for q in (*scenery.problem.coordinates, "t")} | {"tdot": 1.0}
    estimates = Estimates({**rates, **point.floats})
    wanted = set(coordinates)
    entries = [{s: value for s, value in estimates.gradient(scenery.left(one)).items() if s in wanted} for one in rows]
    target = estimates.gradient(scenery.left(name))
    pivots = echelon(entries).pivots
    chosen = [rows[p.row] for p in pivots]
    transposed = [
        {one: entries[p.row].get(q.column, 0.0) for one, p in zip(chosen, pivots, strict=True)} for q in pivots
    ]
    found = solved(transposed, [target.get(q.column, 0.0) for q in pivots], chosen)
    if found is None:
        return None
    short = {one: Fraction(value).limit_denominator(1000) for one, value in found.items()}
    if any(abs(float(short[one]) - value) > 1e-7 for one, value in found.items()):
        return None
    shifted = {s: value + 0.137 * (1 + i % 7) for i, (s, value) in enumerate({**rates, **point.floats}.items())}
    other = Estimates(shifted)
    rest = sum(float(value) * other.value(scenery.left(one)) for one, value in short.items() if value)
    if abs(other.value(scenery.left(name)) - rest) > 1e-6 * (1 + abs(rest)):
        return None
    return {one: value for one, value in short.items() if value}
