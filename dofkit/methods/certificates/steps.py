"""Steps of a certificate: coordinates put in, and relations that follow from others; sums of squares."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial, reduce
from itertools import chain, combinations
from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.checker.geometry import determinant
from dofkit.checker.ring import Quotient
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, derivative, linear_in, put_in, substituted
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError, echelon, least_step
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import FAR, Scenery, text_of

Step = dict[str, Any]


def is_accepted(scenery: Scenery, step: Step) -> bool:
    """Return whether a step stands up; one that is there already does."""
    try:
        if str(step["id"]) not in scenery.steps:
            scenery.add_step(step)
    except CheckError:
        return False
    return True


# Coordinates that geometric equations give by others: put into a relation, they may leave nothing of it.

#: Relations, each with the coordinate that it gives; whether it gives it.
Order = list[list[str]]
Gives = Callable[[str, str], bool]
#: Relations that are longer are not solved in pairs.
LARGEST_OF_PAIR = 30


def solving_order(
    names: Iterable[str], scenery: Scenery, columns: Sequence[str], gives: Gives, skips: bool = False
) -> tuple[Order, list[str]]:
    """Return relations with a coordinate each that those before do not hold, and the relations left over.

    The last alone holds its coordinate, of the others again the last, and so on. ``skips``: where none does, the one
    that holds most is left over; else all are.
    """
    held = {name: moved_by(scenery, name) for name in names}
    order, skipped = Order(), list[str]()
    while held:
        alone = {q for q, often in Counter(chain(*held.values())).items() if often == 1}
        free = ([name, q] for q in columns if q in alone for name in held if q in held[name] and gives(name, q))
        if (pair := next(free, None)) is not None:
            order.insert(0, pair)
        elif not skips:
            return order, [*held]
        else:
            skipped.append(max(held, key=lambda name: len(held[name])))
        del held[pair[0] if pair else skipped[-1]]
    return order, skipped


def moved_by(scenery: Scenery, name: str) -> set[str]:
    """The variables of a geometric equation; those with velocities in another."""
    equation, variables = scenery.evidence.relation(name), scenery.evidence.variables
    dot = "" if equation.kind == "finite" else "dot"
    return {q for q in variables if q + dot in equation.tree.symbols}


def puts(scenery: Scenery, names: Sequence[str]) -> Order:
    """Return geometric equations with the coordinates that they give, in the order in which these are put into others.

    The later one is put in, the fewer coordinates its relation holds that another one gives.
    """
    finite = [name for name in names if scenery.evidence.relation(name).kind == "finite"]
    order, _ = solving_order(finite, scenery, scenery.problem.coordinates, partial(_gives, scenery), skips=True)
    return order[::-1]


def _gives(scenery: Scenery, name: str, q: str) -> bool:
    """Return whether an equation is linear in a coordinate with a factor that is nowhere 0."""
    evidence = scenery.evidence
    tree = evidence.relation(name).tree
    return evidence.once(("gives", name, q), lambda: evidence.is_nowhere_zero(put_in(ZERO, q, tree)[0]))


def with_puts(scenery: Scenery, tree: Tree, order: Order) -> Tree:
    """A tree with coordinates put in."""
    for name, q in order:
        tree = put_in(tree, q, scenery.evidence.relation(name).tree)[1]
    return tree


def needed_puts(scenery: Scenery, trees: Iterable[Tree], order: Order) -> Order:
    """Those that change trees."""
    held, needed = frozenset[str]().union(*(tree.symbols for tree in trees)), Order()
    for name, q in order:
        if q in held:
            needed.append([name, q])
            held |= scenery.evidence.relation(name).tree.symbols
    return needed


def solved_pairs(scenery: Scenery, names: Sequence[str], point: FoundPoint) -> list[str]:
    """Add the steps that prove coordinates to be 0 and that the checker accepts; return their ids.

    Two relations that are linear in the same coordinates, without other terms, are satisfied by 0 only where their
    determinant is not 0.
    """
    ids = []
    short = [name for name in names if scenery.evidence.relation(name).tree.size <= LARGEST_OF_PAIR]
    for pair in combinations(short, 2):
        for step in _pair_steps(scenery, pair, point):
            if is_accepted(scenery, step):
                ids.append(str(step["id"]))
    return ids


def _pair_steps(scenery: Scenery, pair: tuple[str, str], point: FoundPoint) -> Iterator[dict[str, object]]:
    lefts = [scenery.evidence.relation(name).tree for name in pair]
    shared = lefts[0].symbols & lefts[1].symbols
    for first, other in combinations([q for q in scenery.problem.coordinates if q in shared], 2):
        linear = [linear_in(tree, (first, other)) for tree in lefts]
        if any(part is None or not scenery.evidence.ring.vanishes(part[1]) for part in linear):
            continue
        (a, b), (c, d) = ([part[0].get(q, ZERO) for q in (first, other)] for part in linear if part is not None)
        h = a * d - b * c
        if not scenery.differs(h, point.estimates):
            continue
        for q, factors in ((first, (d, -b)), (other, (-c, a))):
            multipliers = {
                "h": text_of(h),
                "c": {name: text_of(part) for name, part in zip(pair, factors, strict=True)},
            }
            yield {"id": f"{scenery.label}{q} by {' and '.join(pair)}", "by": "implied", "function": q, **multipliers}


# Rows that follow from others: cofactors by linear algebra over the rationals.

#: The most terms of all relations that are combined, as they are written and multiplied out.
MOST_TERMS = 4_000


def accounted(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint, what: str = "others") -> bool:
    """Whether a step was found by which others imply a relation near the point.

    The cofactors are numbers: as the relations are, or after coordinates that some of them give are put in; those of
    forms may be functions.
    """
    dependent = scenery.evidence.relation(name)
    sources = [row for row in rows if scenery.evidence.relation(row).kind == dependent.kind]
    if dependent.kind == "velocity":
        sources += [rate for row in rows if row not in sources and (rate := rate_of(scenery, row))]
    step = f"{scenery.label}{name} from {what}"
    if step in scenery.steps:
        return True
    try:
        if (factors := constant_cofactors(scenery, dependent.tree, sources)) is not None:
            return is_accepted(scenery, {"id": step, "by": "implied", "of": name, "c": factors})
        finite = [row for row in sources if scenery.evidence.relation(row).kind == "finite"]
        order = puts(scenery, [*solved_pairs(scenery, finite, point), *finite])
        factors = constant_cofactors(scenery, dependent.tree, sources, order) if order else None
    except CheckError:
        return False
    if factors is not None:
        used = [scenery.evidence.relation(row).tree for row in (name, *factors)]
        put = needed_puts(scenery, used, order)
        return is_accepted(scenery, {"id": step, "by": "implied", "of": name, "c": factors, "put": put})
    forms = dependent.kind == "velocity" and all(map(scenery.linear, (name, *sources)))
    return forms and combined(scenery, point, {"id": step, "by": "implied", "of": name}, scenery.form(name), sources)


def constant_cofactors(
    scenery: Scenery, target: Tree, names: Sequence[str], order: Order | None = None
) -> dict[str, str] | None:
    """Numbers c with target = sum c_i relation_i in the checker's ring, by linear algebra over Q; or None.

    ``order``: coordinates that relations give are put in first; those relations are 0 then.
    """
    ring, put = scenery.evidence.ring, order or []
    used = [name for name in names if all(name != row for row, _ in put)]
    trees = [*(scenery.evidence.relation(name).tree for name in used), target]
    if sum(tree.size for tree in trees) > MOST_TERMS:
        return None
    quotients = [ring.read(with_puts(scenery, substituted(tree, {"tdot": ONE}), put)) for tree in trees]
    if any(len(below) > 1 for _, below in quotients) or sum(len(above) for above, _ in quotients) > MOST_TERMS:
        return None
    denominator = Quotient(reduce(lambda a, b: a * b / a.gcd(b), (q.below for q in quotients), ring.unit), ring.unit)
    columns = [ring.times(quotient, denominator).above.to_dict() for quotient in quotients]
    monomials = sorted({key for column in columns for key in column})
    entries = [column.get(key, fmpq(0)) for key in monomials for column in columns]
    matrix, rank = fmpq_mat(len(monomials), len(columns), entries).rref()
    leads = [next(j for j in range(len(columns)) if matrix[i, j] != 0) for i in range(rank)]
    if len(used) in leads:
        return None
    return {used[lead]: str(matrix[i, len(used)]) for i, lead in enumerate(leads) if matrix[i, len(used)] != 0}


def rate_of(scenery: Scenery, name: str) -> str:
    """Return the id of a step for the rate of a configuration-level equation; "" where it does not stand up."""
    step = f"{scenery.label}rate of {name}"
    return step if is_accepted(scenery, {"id": step, "by": "rate", "of": name}) else ""


def rates_of(scenery: Scenery, names: Iterable[str]) -> list[str]:
    """The steps for the rates of configuration-level equations and integrals."""
    return [step for name in names if (step := rate_of(scenery, name))]


# Forms that follow from others, and functions that keep their values: cofactors by Cramer's rule.

Components = dict[str, Tree]
#: The most rows of a determinant that is written out.
LARGEST_CRAMER = 5


def combined_integral(scenery: Scenery, point: FoundPoint | None, function: str, alone: str = "") -> str | None:
    """Return the id of a step by which a function keeps its value: by one form ``alone``, or whatever that takes."""
    name = f"{scenery.label}{function} is constant{f' by {alone}' if alone else ''}"
    if name in scenery.evidence.by_name:
        return name
    if point is None:
        return None
    try:
        tree = scenery.evidence.text(function)
    except CheckError:
        return None
    target = {v: derivative(tree, v) for v in scenery.evidence.variables}
    step = {"id": name, "by": "integral", "function": function}
    sources = [alone] if alone else [*rates_of(scenery, scenery.finite), *filter(scenery.linear, scenery.moving)]
    return name if combined(scenery, point, step, target, sources) else None


def combined(scenery: Scenery, point: FoundPoint, step: Step, target: Components, sources: Sequence[str]) -> bool:
    """Whether a step stands up with cofactors, where need be after coordinates that relations give are put in."""
    rows = {source: scenery.form(source) for source in sources}
    for order in ([], puts(scenery, scenery.finite)):
        placed = {source: _placed(scenery, row, order) for source, row in rows.items()}
        combination = cofactors(scenery, point, _placed(scenery, target, order), placed)
        if combination is None:
            continue
        h, factors = combination
        used = [*target.values(), h, *factors.values(), *(tree for row in factors for tree in rows[row].values())]
        multipliers = {"h": text_of(h), "c": {row: text_of(factor) for row, factor in factors.items()}}
        put = needed_puts(scenery, used, order)
        if is_accepted(scenery, {**step, **multipliers, **({"put": put} if put else {})}):
            return True
    return False


def _placed(scenery: Scenery, row: Components, order: Order) -> Components:
    return {v: with_puts(scenery, tree, order) for v, tree in row.items()} if order else row


def cofactors(
    scenery: Scenery, point: FoundPoint, target: Components, rows: dict[str, Components]
) -> tuple[Tree, dict[str, Tree]] | None:
    """Return h and c_i with h target = sum c_i row_i in as many columns as there are rows; None for too many rows."""
    try:
        chosen, columns = _chosen(scenery, point, target, rows)
    except NoEstimateError:
        return None
    if len(chosen) > LARGEST_CRAMER:
        return None
    matrix = [[rows[row][column] for row in chosen] for column in columns]
    h, numerators = by_cramer(matrix, [target[column] for column in columns])
    return h, dict(zip(chosen, numerators, strict=True))


def by_cramer(matrix: Sequence[Sequence[Tree]], right: Sequence[Tree]) -> tuple[Tree, list[Tree]]:
    """Return the determinant of a square matrix and Cramer's numerators: the matrix maps them to it times the right."""
    replaced = (
        [[*line[:i], b, *line[i + 1 :]] for line, b in zip(matrix, right, strict=True)] for i in range(len(matrix))
    )
    return determinant(matrix), [*map(determinant, replaced)]


def _chosen(
    scenery: Scenery, point: FoundPoint, target: Components, rows: dict[str, Components]
) -> tuple[list[str], list[str]]:
    """The sources whose cofactors are not 0 near the point, and columns in which they are independent at it."""
    nearby = Estimates({name: value + (1 + i % 5) / 16 for i, (name, value) in enumerate(point.floats.items())})
    numbers = {row: _floats(scenery, nearby, components) for row, components in rows.items()}
    pivots = echelon(list(numbers.values()))
    kept, goal = [list(rows)[p.row] for p in pivots], _floats(scenery, nearby, target)
    square = [{row: numbers[row].get(p.column, 0.0) for row in kept} for p in pivots]
    solution = least_step(square, [goal.get(p.column, 0.0) for p in pivots])
    chosen = [row for row in rows if abs(solution.get(row, 0.0)) > FAR]
    pivots = echelon([_floats(scenery, point.estimates, rows[row]) for row in chosen])
    return [chosen[p.row] for p in pivots], [p.column for p in pivots]


def _floats(scenery: Scenery, estimates: Estimates, row: Components) -> dict[str, float]:
    return {v: estimates.value(scenery.chosen(tree)) for v, tree in row.items() if tree != ZERO}


def function_in(text: str | None) -> str:
    """The function that a text such as ``x*y = C`` says to be constant; none where it is 0."""
    function, _, constant = (text or "").rpartition("=")
    return function.strip() if constant.strip() != "0" else ""
