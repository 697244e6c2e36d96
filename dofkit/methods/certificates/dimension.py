"""Evidence for dimensions: the whole set, and points at which rows are stationary."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations, product
from operator import itemgetter

from flint import arb

from dofkit.checker.curves import HIGHEST_ORDER, along_curve
from dofkit.checker.geometry import determinant, dot
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, operands, symbol, times
from dofkit.checker.whole_sets import HIGHEST_DEGREE, degree
from dofkit.methods.certificates.context import Context, Standing, Told
from dofkit.methods.certificates.fields import backing, kept_motions, orbit
from dofkit.methods.certificates.numerics import least_step
from dofkit.methods.certificates.scenery import FAR, number_text, polynomial_text, text_of
from dofkit.methods.certificates.steps import LARGEST_CRAMER, solving_order

#: The largest denominator of a weight.
DENOMINATOR = 60


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

#: The engines' arguments by which it is so.
STATIONARY = ("isolated zero of one variable", "indefinite form", "definite form", "definite combination", "cases")


def stationary(context: Context) -> Iterator[Told]:
    """Yield dof near a point at which the differential of a relation depends on others: `isolated`, `crossing`."""
    standing, dof = context.standing, context.report.dof or 0
    if standing is None or context.report.verdicts["dof"].argument not in STATIONARY:
        return
    names = context.scenery.evidence.finite
    fields = kept_motions(context, names, standing.point, standing.columns) if dof else {}
    for most in _isolated(context, standing, fields):
        for least in (*_crossing(context, standing), *_motions_from(context, standing, dof, fields)):
            yield {"rule": "squeeze", "about": context.about, "most": most, "least": least}


def _motions_from(context: Context, standing: Standing, size: int, fields: dict[str, str]) -> Iterator[Told]:
    """Yield ``size`` motions from the point: rigid ones of all together, or none."""
    if len(fields) == size:
        orbit_of = {"fields": list(fields), "words": [[name] for name in fields], "columns": list(fields.values())}
        yield {"rule": "span", "at": standing.point.name, "rows": list(context.scenery.evidence.finite), **orbit_of}


def _isolated(context: Context, standing: Standing, fields: dict[str, str]) -> Iterator[Told]:
    """Yield the rule `isolated`: along what is free besides rigid motions a form is definite; or in one direction."""
    across = [q for q in context.problem.coordinates if q not in (*standing.columns, *fields.values())]
    filled = {"fields": list(fields)} if len(across) == 1 else {}
    rows = {name: context.row(name, standing.point) for name in (*standing.rows, *standing.dependent)}
    for zero in standing.dependent if len(across) > 1 else ():
        columns = [{name: rows[name].get(q, 0.0) for name in standing.rows} for q in standing.columns]
        terms = least_step(columns, [rows[zero].get(q, 0.0) for q in standing.columns])
        weights = {name: number_text(-Fraction(value).limit_denominator(DENOMINATOR)) for name, value in terms.items()}
        evidence_of = _left_over(context, standing, zero, *({q: 1} for q in across))
        evidence_of["zero"] |= {name: weight for name, weight in weights.items() if weight != "0"}
        yield {"rule": "isolated", **evidence_of, "fields": list(fields)}
    directions = [{q: 1} for q in across] if filled else _directions(context, standing)
    for order, zero, direction in product(range(2, HIGHEST_ORDER + 1), standing.dependent, directions):
        if abs(_derivative_along(context, standing, zero, direction, order)) > FAR:
            yield {"rule": "isolated", **_left_over(context, standing, zero, direction), "order": order, **filled}
            return


def _directions(context: Context, standing: Standing) -> list[dict[str, int]]:
    free = [q for q in context.problem.coordinates if q not in standing.columns]
    return [{q: 1} for q in free] + [{a: 1, b: sign} for a, b in combinations(free, 2) for sign in (1, -1)]


def _crossing(context: Context, standing: Standing) -> Iterator[Told]:
    """Yield the rule `crossing`: along two directions the only dependent relation has different signs."""
    for zero in standing.dependent if len(standing.dependent) == 1 else ():
        pairs = [(_derivative_along(context, standing, zero, v, 2), v) for v in _directions(context, standing)]
        (low, down), (high, up) = (extreme(pairs, key=itemgetter(0)) for extreme in (min, max))
        if low < -FAR and high > FAR:
            yield {"rule": "crossing", **_left_over(context, standing, zero, up, down)}


def _left_over(context: Context, standing: Standing, zero: str, *directions: dict[str, int]) -> Told:
    speeds = [{q: str(value) for q, value in direction.items()} for direction in directions]
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
