"""Evidence for the labels of one constraint and for integrals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from dofkit.checker.label_rules import exterior_part, form_of
from dofkit.checker.trees import ZERO, CheckError, Tree, add, derivative, symbol
from dofkit.methods.certificates.context import Context, Told
from dofkit.methods.certificates.fields import (
    LARGEST_CRAMER,
    by_cramer,
    integrable_names,
    involutive_rows,
    pairing,
    reach,
    words_of,
)
from dofkit.methods.certificates.numerics import Estimates, NoEstimateError, echelon, least_step
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import FAR, text_of
from dofkit.methods.certificates.steps import Order, needed_puts, puts, rate_of, with_puts
from dofkit.report import ConstraintEntry

Components = dict[str, Tree]


def combined_integral(context: Context, function: str, alone: str = "") -> str | None:
    """Return the id of a step by which a function keeps its value: by one form ``alone``, or whatever that takes."""
    name = f"{context.scenery.label}{function} is constant{f' by {alone}' if alone else ''}"
    if name in context.scenery.evidence.by_name:
        return name
    if context.point is None:
        return None
    try:
        tree = context.scenery.evidence.text(function)
    except CheckError:
        return None
    target = {v: derivative(tree, v) for v in context.scenery.evidence.variables}
    step = {"id": name, "by": "integral", "function": function}
    sources = [alone] if alone else [*context.rates, *context.scenery.evidence.moving]
    return name if _combined(context, step, target, sources) else None


def add_step_from_integrals(context: Context, name: str, steps: Sequence[str], alone: bool = False) -> bool:
    """Add the step by which integrals imply a form, and geometric equations if not ``alone``; return whether."""
    step = f"{context.scenery.label}{name} from {' and '.join(steps) if alone else 'integrals'}"
    if step in context.scenery.steps:
        return True
    sources = [*steps, *(() if alone else context.scenery.evidence.finite)]
    rates = [rate for source in sources if (rate := rate_of(context.scenery, source))]
    return _combined(context, {"id": step, "by": "implied", "of": name}, components(context, name), rates)


def integral_alone(context: Context, entry: ConstraintEntry, name: str) -> str | None:
    """Return the step of the integral that is claimed of a form, where each implies the other on its own."""
    function = function_in(entry.integral)
    step = combined_integral(context, function, name) if function and form_or_none(context, name) is not None else None
    return step if step and add_step_from_integrals(context, name, [step], alone=True) else None


def _combined(context: Context, step: Told, target: Components, sources: Sequence[str]) -> bool:
    """Whether a step stands up with cofactors, where need be after coordinates that relations give are put in."""
    rows = {source: components(context, source) for source in sources}
    for order in ([], puts(context.scenery, context.scenery.evidence.finite)):
        placed = {source: _placed(context, row, order) for source, row in rows.items()}
        combination = cofactors(context, _placed(context, target, order), placed)
        if combination is None:
            continue
        h, factors = combination
        used = [*target.values(), h, *factors.values(), *(tree for row in factors for tree in rows[row].values())]
        multipliers = {"h": text_of(h), "c": {row: text_of(factor) for row, factor in factors.items()}}
        put = needed_puts(context.scenery, used, order)
        try:
            context.scenery.add_step({**step, **multipliers, **({"put": put} if put else {})})
        except CheckError:
            continue
        return True
    return False


def _placed(context: Context, row: Components, order: Order) -> Components:
    return {v: with_puts(context.scenery, tree, order) for v, tree in row.items()} if order else row


def form_or_none(context: Context, name: str) -> Components | None:
    """Return the components of a relation that is a linear form, or None."""
    try:
        return form_of(context.scenery.evidence, name)
    except CheckError:
        return None


def components(context: Context, name: str) -> Components:
    """The components of a linear relation of velocities."""
    tree = context.scenery.evidence.relation(name).tree
    return {v: derivative(tree, f"{v}dot") for v in context.scenery.evidence.variables}


def cofactors(context: Context, target: Components, rows: dict[str, Components]) -> tuple[Tree, dict[str, Tree]] | None:
    """h and c_i with h target = sum c_i row_i in as many columns as there are rows; None where a few do not do."""
    try:
        chosen, columns = _chosen(context, target, rows)
    except NoEstimateError:
        return None
    if len(chosen) > LARGEST_CRAMER:
        return None
    matrix = [[rows[row][column] for row in chosen] for column in columns]
    h, numerators = by_cramer(matrix, [target[column] for column in columns])
    return h, dict(zip(chosen, numerators, strict=True))


def _chosen(context: Context, target: Components, rows: dict[str, Components]) -> tuple[list[str], list[str]]:
    """The sources whose cofactors are not 0 near the point, and columns in which they are independent at it."""
    floats = context.point.floats if context.point is not None else {}
    nearby = Estimates({name: value + (1 + i % 5) / 16 for i, (name, value) in enumerate(floats.items())})
    numbers = {row: _floats(context, nearby, components) for row, components in rows.items()}
    pivots = echelon(list(numbers.values()))
    kept, goal = [list(rows)[p.row] for p in pivots], _floats(context, nearby, target)
    square = [{row: numbers[row].get(p.column, 0.0) for row in kept} for p in pivots]
    solution = least_step(square, [goal.get(p.column, 0.0) for p in pivots])
    chosen = [row for row in rows if abs(solution.get(row, 0.0)) > FAR]
    estimates = Estimates(floats)
    pivots = echelon([_floats(context, estimates, rows[row]) for row in chosen])
    return [chosen[p.row] for p in pivots], [p.column for p in pivots]


def _floats(context: Context, estimates: Estimates, row: Components) -> dict[str, float]:
    return {v: estimates.value(context.scenery.chosen(tree)) for v, tree in row.items() if tree != ZERO}


# Evidence for the labels of one constraint.


def holonomic(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Finite, an inequality, integrated, or reached across."""
    evidence = context.scenery.evidence
    if evidence.owned(entry.name, ("inequality",)):
        yield {"rule": "inequality"}
        return
    if not evidence.owned(entry.name, ("velocity",)):
        yield {"rule": "finite"}
        return
    alone = field == "holonomic_alone"
    if getattr(entry, field) is False:
        yield from _reached(context, entry.name, alone)
        return
    yield from _integrated(context, entry)
    yield from involutive_rows(context, list(evidence.owned(entry.name)) if alone else integrable_names(context))


def _reached(context: Context, owner: str, alone: bool) -> Iterator[Told]:
    """Yield a word of brackets that a form of the constraint does not allow."""
    evidence = context.scenery.evidence
    names = evidence.owned(owner) if alone else context.equations
    standing = context.standing_of(names) if alone else context.standing
    if standing is None or not (alone or standing.accounted) or not all(map(context.scenery.linear, names)):
        return
    words = words_of(context, standing, len(context.problem.coordinates) + 1 if alone else reach(context))
    if words is None:
        return
    for name in evidence.owned(owner, ("velocity",)):
        for word, vector in zip(words.words, words.vectors, strict=True):
            if len(word) > 1 and abs(pairing(context, name, standing.point, vector)) > FAR:
                used = {"fields": words.fields, "rows": words.rows, "word": word, "pairs": name}
                if any(map(evidence.is_open, (evidence.relation(other).tree for other in evidence.finite))):
                    used["minor"] = context.minor(standing)
                yield {"rule": "bracket", "at": standing.point.name, **used}
                return


def _integrated(context: Context, entry: ConstraintEntry) -> Iterator[Told]:
    """Yield the rule `integral` for a constraint of one equation whose integral is known."""
    names = context.scenery.evidence.owned(entry.name)
    if len(names) == 1 and context.point is not None and (step := integral_alone(context, entry, names[0])):
        yield {"rule": "integral", "at": context.point.name, "integrals": [step]}


def function_in(text: str | None) -> str:
    """The function that a text such as ``x*y = C`` says to be constant; none where it is 0."""
    function, _, constant = (text or "").rpartition("=")
    return function.strip() if constant.strip() != "0" else ""


def integral(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The integral that is reported: of the form alone, or in the system."""
    names = context.scenery.evidence.owned(entry.name, ("velocity",))
    function = function_in(entry.integral)
    if len(names) != 1 or context.point is None or not function:
        return
    claim = {"rule": "integral", "at": context.point.name}
    if alone := integral_alone(context, entry, names[0]):
        yield {**claim, "step": alone}
    if (step := combined_integral(context, function)) is None:
        return
    texts = dict.fromkeys(function_in(other.integral) for other in context.report.constraints)
    others = [other for text in texts if text and (other := combined_integral(context, text)) and other != step]
    standing = context.standing_of([*context.scenery.evidence.finite, *others, names[0]])
    if (
        add_step_from_integrals(context, names[0], [step, *others])
        and standing is not None
        and names[0] in standing.rows
    ):
        yield {**claim, "step": step, "integrals": others, "minor": context.minor(standing)}


def exact(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Closed, or a point where it is not."""
    if entry.exact:
        yield {"rule": "exact"}
        return
    evidence, point = context.scenery.evidence, context.point
    if context.scenery.cayley or point is None:
        return
    names = evidence.owned(entry.name, ("velocity",))
    for name in names:
        form = form_or_none(context, name) or {}
        which = {"relation": name} if len(names) > 1 else {}
        for pair in combinations(evidence.variables, 2):
            if context.scenery.differs(exterior_part(form, *pair), point.estimates):
                yield {"rule": "not exact", "at": point.name, "pair": list(pair), **which}


def time_evidence(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Yield evidence that time does not occur, or of a point at which it matters."""
    if getattr(entry, field):
        yield {"rule": "timeless"}
        return
    for name in context.scenery.evidence.owned(entry.name, ("finite", "velocity", "inequality")):
        for place in _time_dependence(context, name, field):
            yield {"rule": "time-dependent", "relation": name, **place}


def _time_dependence(context: Context, name: str, field: str) -> Iterator[Told]:
    """Yield points at which time is in a relation, or in the quotient of two components of a form."""
    scenery, tree, form = context.scenery, context.scenery.tree(name), form_or_none(context, name)
    turned = derivative(tree, "t") if form is None else form.get("t", ZERO)
    velocities = [v for v in scenery.evidence.velocities if v in tree.symbols]
    if field == "catastatic" and form is None and velocities:
        turned = add(*(symbol(v) * derivative(tree, v) for v in velocities))
    changes: list[tuple[Tree, Told]] = [(turned, {})]
    for (a, first), (b, other) in combinations((form or {}).items(), 2) if field == "scleronomic" else ():
        turn = first * derivative(other, "t") - other * derivative(first, "t")
        changes.append((turn, {"pair": [a, b]}))
    changes = [change for change in changes if change[0] != ZERO]
    for point in _points_of(context, name) if changes else ():
        for change, pair in changes:
            if point is not None and scenery.differs(change, point.estimates):
                yield {"at": context.add_point(point), **pair}


def _points_of(context: Context, name: str) -> Iterator[FoundPoint | None]:
    """The main point, where it is one of the relation, and others."""
    if context.scenery.evidence.relation(name).kind != "inequality":
        yield context.point
    yield from context.search.touching(name)
