"""Evidence for dimensions: families of configurations, the whole set, and points at which rows are stationary."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations, product
from operator import itemgetter

from flint import arb

from dofkit.checker.curves import HIGHEST_ORDER, along_curve
from dofkit.checker.dimension_rules import HIGHEST_DEGREE, degree
from dofkit.checker.geometry import determinant, dot
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, operands, symbol, times
from dofkit.methods.certificates.context import Context, Standing, Told
from dofkit.methods.certificates.fields import backing, kept_motions, orbit
from dofkit.methods.certificates.numerics import echelon, least_step
from dofkit.methods.certificates.scenery import FAR, number_text, polynomial_text, text_of
from dofkit.methods.certificates.steps import LARGEST_CRAMER, accounted, solving_order

#: The size of a step along a motion, of what is added by chance, and the largest denominator of a coefficient.
STEP, NOISE, DENOMINATOR = 0.25, 0.05, 60
#: Scenes are followed up to this product of the size of their relations and of the number of their coordinates.
MOST_FOLLOWED = 6000
Samples = list[dict[str, float]]


def families(context: Context, size: int) -> Iterator[Told]:
    """The rule `family` with so many freedoms, for a motion through the main point."""
    point, scenery = context.point, context.scenery
    size_of_all = sum(relation.tree.size for relation in context.problem.relations) * len(context.problem.coordinates)
    if point is None or scenery.moving or size_of_all > MOST_FOLLOWED:
        return
    assumed = []
    for i, text in enumerate(_linear_relations(context, _samples(context))):
        step = f"{scenery.label}family {i}"
        if step not in scenery.steps:
            scenery.add_step({"id": step, "by": "assumed", "function": text})
        assumed.append(step)
    standing = context.standing_of([*assumed, *scenery.finite])
    if standing is None or len(standing.rows) != len(context.problem.coordinates) - size:
        return
    others = [name for name in standing.dependent if name not in assumed]
    if all(accounted(scenery, name, standing.rows, point, "family") for name in others):
        yield {"rule": "family", "minor": {"at": point.name, "rows": standing.rows, "columns": standing.columns}}


def _samples(context: Context) -> Samples:
    """Configurations along a motion that leaves the main point: as many as span its linear hull."""
    drawn, samples = random.Random(0), Samples()
    coordinates = context.problem.coordinates
    now = before = dict(context.point.floats) if context.point is not None else {}
    for place in range(len(coordinates) + 4):
        far = max((abs(now[q] - before[q]) for q in coordinates), default=0.0)
        noise = NOISE if place else STEP
        moved = {
            q: now[q] + (now[q] - before[q]) * STEP / (far or 1.0) + noise * drawn.uniform(-1, 1) for q in coordinates
        }
        reached = context.search.approached({**now, **moved}, context.scenery.equations, set(coordinates))
        if reached is not None:
            samples.append(reached)
            before, now = now, reached
    return samples


def _linear_relations(context: Context, samples: Samples) -> Iterator[str]:
    """Texts that are 0 at the main point and at all samples, linear with rational coefficients, each in few terms."""
    point, coordinates = context.point, context.problem.coordinates
    if point is None or not samples:
        return
    rows = [{q: sample[q] - point.floats[q] for q in coordinates} for sample in samples]
    pivots = echelon(rows)
    columns = [p.column for p in pivots]
    for q in coordinates:
        if q in columns:
            continue
        terms = least_step([{c: rows[p.row][c] for c in columns} for p in pivots], [rows[p.row][q] for p in pivots])
        short = {p: Fraction(value).limit_denominator(DENOMINATOR) for p, value in terms.items()}
        if all(abs(float(short[p]) - value) < 1e-6 for p, value in terms.items()):
            coefficients = [(q, Fraction(1)), *((p, -value) for p, value in short.items() if value)]
            yield " + ".join(f"({number_text(c)})*{_from(point.values[p], p)}" for p, c in coefficients)


def _from(value: str, q: str) -> str:
    return q if value == "0" else f"({q} - ({value}))"


# Evidence that no part of the set is larger: graphs, single relations, relations with symbols of their own.


def everywhere(context: Context) -> Iterator[Told]:
    """dof of all of the set; with forms from that near the main point."""
    if context.scenery.cayley or context.standing is None:
        return
    finite = context.finite_standing
    if not context.scenery.moving:
        yield from _of_set(context, context.standing)
        return
    for local in orbit(context):
        for cover in velocities_everywhere(context):
            yield {**local, **cover}
        for cover in _of_set(context, finite) if finite is not None else ():
            yield {**local, **cover}


def velocities_everywhere(context: Context) -> Iterator[Told]:
    """Yield claims by the rule `everywhere`: each relation gives a coordinate that those before do not hold.

    Then the rank is the number of relations at all points. All relations are in such an order; or the finite ones are,
    and a single form stands beside them. ``standing`` is the point at which the relations are known to hold, with the
    rows that account for all.
    """
    scenery, standing = context.scenery, context.standing
    if standing is None or not standing.accounted or scenery.cayley:
        return
    claim = {"rule": "everywhere", "about": "everywhere", "minor": context.minor(standing)}
    chart = scenery, context.problem.coordinates, partial(_gives, context)
    order, unordered = solving_order(_needed(standing, scenery.equations), *chart)
    moving = _needed(standing, scenery.moving)
    if not unordered:
        yield {**claim, "order": order}
        return
    if {*unordered} <= {*moving} and (gram := _gram(context, unordered)):
        yield {**claim, "order": order, "gram": gram}
    if len(moving) == 1:
        order, unordered = solving_order(_needed(standing, scenery.finite), *chart)
        if not unordered:
            yield {**claim, "order": order, "alone": moving[0]}


def _gram(context: Context, forms: list[str]) -> Told | None:
    """Return the Gram determinant of forms, where it is one of parameters alone, each column divided by its own."""
    evidence, coordinates = context.scenery.evidence, context.problem.coordinates
    if len(forms) > LARGEST_CRAMER:
        return None
    rows = [[evidence.slope(name, q) for q in coordinates] for name in forms]
    scales: dict[str, Tree] = {}
    for q, column in zip(coordinates, zip(*rows, strict=True), strict=True):
        shared = [{*operands(entry, "product")} for entry in column if entry != ZERO]
        letters = [symbol(name) for name, sign in context.problem.world.signs.items() if sign == "positive"]
        common = [letter**-2 for letter in letters if shared and all(letter in factors for factors in shared)]
        scales |= {q: times(*common)} if common else {}
    scaled = [[scales.get(q, ONE) * slope for q, slope in zip(coordinates, row, strict=True)] for row in rows]
    try:
        value = evidence.ring.read(determinant([[dot(row, other) for other in scaled] for row in rows]))
        determinant_text = "/".join(f"({polynomial_text(evidence.ring, part)})" for part in value)
    except CheckError:
        return None
    if not evidence.is_nowhere_zero(evidence.text(determinant_text), True):
        return None
    return {"forms": forms, "scales": {q: text_of(tree) for q, tree in scales.items()}, "value": determinant_text}


def _needed(standing: Standing, names: Sequence[str]) -> list[str]:
    """Relations without those that follow from the rows."""
    return [name for name in names if not (standing.accounted and name in standing.dependent)]


def _of_set(context: Context, standing: Standing) -> Iterator[Told]:
    """What the geometric equations define."""
    scenery, evidence, claim = context.scenery, context.scenery.evidence, {"rule": "everywhere", "about": "everywhere"}
    finite, columns = _needed(standing, scenery.finite), context.problem.coordinates
    minor = {"minor": context.minor(standing)}
    for variables in (columns, evidence.variables):
        order, others = solving_order(finite, scenery, variables, partial(_gives, context), skips=True)
        if not others:
            yield {**claim, "order": order}
        if len(others) < 2:
            yield {**claim, **minor, "order": order, **({"alone": others[0]} if others else {})}
    letters = (*context.problem.world.generic, *context.problem.world.signs)
    symbols = {name: letter for name in scenery.finite if (letter := evidence.own_symbol(name, letters))}
    for skips in (False, True) if not standing.dependent or standing.accounted else ():
        order, others = solving_order(finite, scenery, columns, partial(_gives, context, most=HIGHEST_DEGREE), skips)
        if all(name in symbols for name in others):
            yield {**claim, **minor, "order": order, "generic": [[name, symbols[name]] for name in others]}
    if all(name in symbols for name in scenery.finite) and (backed := backing(context, standing)):
        yield {**claim, **minor, "generic": [[name, symbols[name]] for name in scenery.finite], **backed}


def _gives(context: Context, name: str, q: str, most: int = 1) -> bool:
    """Whether a derivative of a relation by a coordinate is nowhere 0."""
    evidence, point = context.scenery.evidence, context.point
    try:
        checked_point = None if point is None else evidence.point(context.add_point(point))
        return evidence.once(("gives", name, q, most), lambda: degree(evidence, name, q, checked_point, most)) > 0
    except CheckError:
        return False


# Evidence where rows are stationary at the main point: what is isolated there, and what crosses itself.

SIGNS = (1, -1)


def stationary(context: Context) -> Iterator[Told]:
    """Yield dof near a point at which the differential of a relation depends on others: `isolated`, `crossing`."""
    standing, dof = context.standing, context.report.dof or 0
    if standing is None or standing.accounted:
        return
    names = context.scenery.evidence.finite
    fields = kept_motions(context, names, standing.point, standing.columns) if dof else {}
    for most in _isolated(context, standing, fields):
        for least in (*_crossing(context, standing), *_motions_from(context, standing, dof, fields)):
            yield {"rule": "squeeze", "about": context.about, "most": most, "least": least}


def _motions_from(context: Context, standing: Standing, size: int, fields: dict[str, str]) -> Iterator[Told]:
    """Yield ``size`` motions from the point: rigid ones of all together, none, or a family."""
    if len(fields) == size:
        orbit_of = {"fields": list(fields), "words": [[name] for name in fields], "columns": list(fields.values())}
        yield {"rule": "span", "at": standing.point.name, "rows": list(context.scenery.evidence.finite), **orbit_of}
    yield from families(context, size)


def _isolated(context: Context, standing: Standing, fields: dict[str, str]) -> Iterator[Told]:
    """Yield the rule `isolated`: along what is free besides rigid motions a form is definite; or in one direction."""
    across = [q for q in context.problem.coordinates if q not in (*standing.columns, *fields.values())]
    filled = {"fields": list(fields)} if len(across) == 1 else {}
    rows = {name: context.row(name, standing.point) for name in (*standing.rows, *standing.dependent)}
    for zero in standing.dependent if len(across) > 1 else ():
        columns = [{name: rows[name].get(q, 0.0) for name in standing.rows} for q in standing.columns]
        terms = least_step(columns, [rows[zero].get(q, 0.0) for q in standing.columns])
        weights = {name: number_text(-Fraction(value).limit_denominator(DENOMINATOR)) for name, value in terms.items()}
        shown = _left_over(context, standing, zero, *({q: 1} for q in across))
        shown["zero"] |= {name: weight for name, weight in weights.items() if weight != "0"}
        yield {"rule": "isolated", **shown, "fields": list(fields)}
    directions = [{q: 1} for q in across] if filled else _directions(context, standing)
    for order, zero, way in product(range(2, HIGHEST_ORDER + 1), standing.dependent, directions):
        if abs(_derivative_along(context, standing, zero, way, order)) > FAR:
            yield {"rule": "isolated", **_left_over(context, standing, zero, way), "order": order, **filled}
            return


def _directions(context: Context, standing: Standing) -> list[dict[str, int]]:
    free = [q for q in context.problem.coordinates if q not in standing.columns]
    return [{q: 1} for q in free] + [{a: 1, b: sign} for a, b in combinations(free, 2) for sign in SIGNS]


def _crossing(context: Context, standing: Standing) -> Iterator[Told]:
    """Yield the rule `crossing`: along two directions the only dependent relation has different signs."""
    for zero in standing.dependent if len(standing.dependent) == 1 else ():
        pairs = [(_derivative_along(context, standing, zero, way, 2), way) for way in _directions(context, standing)]
        (low, down), (high, up) = (extreme(pairs, key=itemgetter(0)) for extreme in (min, max))
        if low < -FAR and high > FAR:
            yield {"rule": "crossing", **_left_over(context, standing, zero, up, down)}


def _left_over(context: Context, standing: Standing, zero: str, *directions: dict[str, int]) -> Told:
    speeds = [{q: str(value) for q, value in way.items()} for way in directions]
    return {"minor": context.minor(standing), "zero": {zero: "1"}, "speeds": speeds}


def _derivative_along(context: Context, standing: Standing, zero: str, direction: dict[str, int], order: int) -> float:
    """Return the derivative of this order of the relation ``zero`` along a curve in a direction, or 0 without one."""
    evidence = context.scenery.evidence
    try:
        minor = evidence.minor(context.minor(standing))
        speeds = {q: arb(value) for q, value in direction.items()}
        return float(along_curve(evidence, minor, speeds, evidence.relation(zero).tree, order).mid())
    except (CheckError, ArithmeticError):
        return 0.0
