"""Evidence that relations cannot be met: combinations that leave a number over, sums of squares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dofkit.checker.trees import ONE, add
from dofkit.methods.certificates.context import Context, Told
from dofkit.methods.certificates.scenery import Scenery, number_text, squares_of, text_of
from dofkit.methods.certificates.steps import constant_cofactors, is_accepted, rate_of


def conflicting(context: Context) -> Iterator[Told]:
    """The constraints that cannot be met together, each of them needed."""
    evidence, members = context.scenery.evidence, context.report.conflicting
    kinds = ("finite", "velocity", "inequality")
    for refutation in refutations(context, [relation for name in members for relation in evidence.owned(name, kinds)]):
        minimal: Told = {}
        for name in members:
            others = [relation for other in members if other != name for relation in evidence.owned(other)]
            if others and (witness := _met(context, others)):
                minimal[name] = witness
        yield {"rule": "conflict", "refutation": refutation, "minimal": minimal}


def _met(context: Context, others: Sequence[str]) -> Told | None:
    """What shows that the others can be met."""
    relation = context.scenery.evidence.relation
    finite = [other for other in others if relation(other).kind == "finite"]
    point = next(context.search.points(finite, context.problem.coordinates, 300), None)
    if point is None:
        return None
    standing = context.standing_of(others, point=point)
    if standing is not None and standing.rows and not standing.dependent:
        return {"rule": "regular", "minor": context.minor(standing)}
    return {"rule": "point", "at": context.add_point(point)}


def refutations(context: Context, names: Sequence[str]) -> Iterator[Told]:
    """Ways in which relations cannot be met: steps by which 1 would be 0."""
    scenery = context.scenery
    equations = [name for name in names if scenery.evidence.relation(name).kind != "inequality"]
    rates = [step for name in equations if (step := rate_of(scenery, name))]
    if (factors := constant_cofactors(scenery, ONE, [*equations, *rates])) is not None:
        for unit in ("1", "tdot"):
            yield from _refuted(scenery, {"function": unit, "c": factors})
    for name in names:
        for squares in _by_squares(context, name):
            yield from _refuted(scenery, {"function": "1", **squares})


def _refuted(scenery: Scenery, reason: Told) -> Iterator[Told]:
    """The rule `nullstellensatz`, where the step by which something that is not 0 would be 0 stands up."""
    step = {"id": f"{scenery.label}contradiction {len(scenery.steps)}", "by": "implied", **reason}
    if is_accepted(scenery, step):
        yield {"rule": "nullstellensatz", "step": step["id"]}


def _by_squares(context: Context, name: str) -> Iterator[Told]:
    """Yield evidence that one relation is never satisfied: it is a positive number and squares, or their negative."""
    evidence = context.scenery.evidence
    for sign, plain, squares in squares_of(evidence.relation(name).tree, evidence.chosen):
        yield {"h": text_of(add(*plain)), "sos": squares, "c": {name: number_text(sign)}}
