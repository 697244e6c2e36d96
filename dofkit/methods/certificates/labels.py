"""Evidence for the labels of one constraint and for integrals."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

from dofkit.checker.label_rules import change, exterior_part
from dofkit.checker.trees import ZERO
from dofkit.methods.certificates.context import Context, Told
from dofkit.methods.certificates.fields import (
    curvatures,
    integrable_names,
    integral_steps,
    involutive_rows,
    pairing,
    reach,
    words_of,
)
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import FAR, exponentials
from dofkit.methods.certificates.steps import combined, combined_integral, function_in, rates_of
from dofkit.report import ConstraintEntry


def follows(context: Context, name: str, steps: list[str], alone: bool) -> bool:
    """Whether a form follows, by a step that stands up, from integrals, and geometric equations if not ``alone``."""
    scenery, sources = context.scenery, [*steps, *(() if alone else context.scenery.finite)]
    implied = {"id": f"{scenery.label}{name} from {' and '.join(steps)}{' alone' * alone}", "by": "implied", "of": name}
    if implied["id"] in scenery.steps or context.point is None:
        return implied["id"] in scenery.steps
    return combined(scenery, context.point, implied, scenery.form(name), rates_of(scenery, sources))


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
    yield from involutive_rows(context, context.scenery.owned(entry.name) if alone else integrable_names(context))


def _reached(context: Context, owner: str, alone: bool) -> Iterator[Told]:
    """Yield a word of brackets that a form of the constraint does not allow."""
    evidence = context.scenery.evidence
    owned = [name for name in context.scenery.owned(owner) if not (alone and name in context.scenery.shared)]
    standing = context.standing_of(owned) if alone else context.standing
    if standing is None or not (alone or standing.accounted):
        return
    yield from (claim for claim in curvatures(context, standing) if claim["pairs"] in owned)
    most = len(context.problem.coordinates) + context.scenery.timed if alone else reach(context)
    words = words_of(context, standing, most)
    if words is None:
        return
    for name in filter(context.scenery.linear, context.scenery.owned(owner, ("velocity",))):
        for word, vector in zip(words.words, words.vectors, strict=True):
            if len(word) > 1 and abs(pairing(context, name, standing.point, vector)) > FAR:
                used = {"fields": words.fields, "rows": words.rows, "word": word, "pairs": name}
                if any(map(evidence.is_open, (evidence.relation(other).tree for other in evidence.finite))):
                    used["minor"] = context.minor(standing)
                yield {"rule": "bracket", "at": standing.point.name, **used}
                return


def integral(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The integral that is reported: of the form alone, or in the system."""
    names = [*filter(context.scenery.linear, context.scenery.owned(entry.name, ("velocity",)))]
    function = function_in(entry.integral)
    if len(names) != 1 or context.point is None or not function:
        return
    claim = {"rule": "integral", "at": context.point.name}
    step = combined_integral(context.scenery, context.point, function, names[0])
    if step and follows(context, names[0], [step], alone=True):
        yield {**claim, "step": step}
    if (step := combined_integral(context.scenery, context.point, function)) is None:
        return
    texts = (other.integral for other in context.report.constraints)
    others = [other for other in integral_steps(context, texts) if other != step]
    standing = context.standing_of([*context.scenery.finite, *others, names[0]])
    if standing and names[0] in standing.rows and follows(context, names[0], [step, *others], alone=False):
        yield {**claim, "step": step, "integrals": others, "minor": context.minor(standing)}


def exact(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Closed, or a point where it is not."""
    if entry.exact:
        yield {"rule": "exact"}
        return
    evidence = context.scenery.evidence
    names = evidence.owned(entry.name, ("velocity",)) if not context.scenery.cayley else ()
    for name in names:
        form = context.scenery.form(name)
        which = {"relation": name} if len(names) > 1 else {}
        for point, pair in product(filter(None, _points_of(context, name)), combinations(evidence.variables, 2)):
            if context.scenery.differs(exterior_part(form, *pair), point.estimates):
                yield {"rule": "not exact", "at": context.add_point(point), "pair": list(pair), **which}


def time_evidence(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Yield evidence that time does not occur, or of a point at which it matters."""
    names = context.scenery.evidence.owned(entry.name, ("finite", "velocity", "inequality"))
    if getattr(entry, field):
        yield {"rule": "timeless"}
        trees = [context.scenery.evidence.relation(name).tree for name in names]
        yield from ({"rule": "timeless", "factor": text} for tree in trees for text in exponentials(tree))
        return
    for name in names:
        pairs = combinations(context.scenery.form(name), 2) if field == "scleronomic" else ()
        claims: list[Told] = [{"relation": name}, *({"relation": name, "pair": list(pair)} for pair in pairs)]
        trees = [change(context.scenery.evidence, {**claim, "field": field}) for claim in claims]
        for point in filter(None, _points_of(context, name) if any(tree != ZERO for tree in trees) else ()):
            for claim, tree in zip(claims, trees, strict=True):
                if context.scenery.differs(tree, point.estimates):
                    yield {"rule": "time-dependent", "at": context.add_point(point), **claim}


def _points_of(context: Context, name: str) -> Iterator[FoundPoint | None]:
    """The main point, where it is one of the relation, and others."""
    if context.scenery.evidence.relation(name).kind != "inequality":
        yield context.point
    yield from context.search.touching(name)
