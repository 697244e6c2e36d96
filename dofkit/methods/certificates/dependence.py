"""Rows that follow from others: cofactors by linear algebra over the rationals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

from dofkit.checker.trees import CheckError, Tree
from dofkit.methods.certificates.elimination import echelon, solved
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.substitutions import Order, needed_puts, puts, solved_pairs, with_puts
from dofkit.methods.certificates.texts import number_text


def accounted(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint, what: str = "others") -> bool:
    """Whether a step was found by which a relation follows from others near the point."""
    own = scenery.evidence.relation(name)
    kinds = [row for row in rows if scenery.evidence.relation(row).kind == own.kind]
    if own.kind == "velocity":
        kinds += [rate for row in rows if row not in kinds and (rate := rate_of(scenery, row))]
    step = f"{scenery.label}{name} from {what}"
    if scenery.has_step(step):
        return True
    try:
        for found in combined(scenery, name, kinds, point):
            scenery.add_step({"id": step, "by": "implied", "of": name, **found})
            return True
    except (CheckError, NoEstimateError):
        return False
    return False


def combined(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint) -> Iterator[dict[str, Any]]:
    """Cofactors that are numbers, as they seem; and those after coordinates that relations give are put in."""
    found = _combination(scenery, name, rows, point, [])
    if found is not None:
        yield found
    finite = [row for row in rows if scenery.evidence.relation(row).kind == "finite"]
    order = puts(scenery, [*solved_pairs(scenery, finite, point), *finite])
    found = _combination(scenery, name, rows, point, order) if order else None
    if found is not None:
        yield found


def _combination(
    scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint, order: Order
) -> dict[str, Any] | None:
    """Numbers by which a relation is a sum of multiples of others, once coordinates that relations give are put in."""
    trees = {one: with_puts(scenery, scenery.left(one), order) for one in (name, *rows)}
    put = {row for row, _ in order}
    left = trees.pop(name)
    factors = constant_cofactors(scenery, left, {row: tree for row, tree in trees.items() if row not in put}, point)
    if factors is None:
        return None
    found: dict[str, Any] = {"c": {row: number_text(value) for row, value in factors.items()}}
    used = [scenery.evidence.relation(one).left for one in (name, *factors)]
    return {**found, "put": needed_puts(scenery, used, order)} if order else found


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
    scenery: Scenery, left: Tree, trees: Mapping[str, Tree], point: FoundPoint
) -> dict[str, Fraction] | None:
    """Numbers c with left = sum c_i tree_i, as they seem from the point and one other; None where there are none."""
    rows = list(trees)
    coordinates = [s for q in scenery.problem.coordinates for s in (q, f"{q}dot")]
    rates = {f"{q}dot": 0.0 for q in (*scenery.problem.coordinates, "t")} | {"tdot": 1.0}
    estimates = Estimates({**rates, **point.floats})
    wanted = set(coordinates)
    entries = [{s: v for s, v in estimates.gradient(tree).items() if s in wanted} for tree in trees.values()]
    target = {s: v for s, v in estimates.gradient(left).items() if s in wanted}
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
    rest = sum(float(value) * other.value(trees[one]) for one, value in short.items() if value)
    if abs(other.value(left) - rest) > 1e-6 * (1 + abs(rest)):
        return None
    return {one: value for one, value in short.items() if value}
