"""Evidence that relations cannot be met: combinations that leave a number over, sums of squares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.checker.trees import MINUS
from dofkit.methods.certificates.context import Context, Told
from dofkit.methods.certificates.scenery import number_text, text_of
from dofkit.methods.certificates.steps import constant_cofactors, positive_sum, rate_of


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
    """Ways in which relations cannot be met."""
    evidence = context.scenery.evidence
    equations = [name for name in names if evidence.relation(name).kind != "inequality"]
    rates = [
        rate
        for name in equations
        if evidence.relation(name).kind == "finite" and (rate := rate_of(context.scenery, name))
    ]
    for chosen in (equations, [*equations, *rates]):
        if (factors := constant_cofactors(context.scenery, MINUS, chosen)) is not None:
            yield {"rule": "nullstellensatz", "c": factors, "number": "1"}
    for name in names:
        yield from _by_squares(context, name)


def _by_squares(context: Context, name: str) -> Iterator[Told]:
    """Yield evidence that one relation is never satisfied: it is a positive number and squares, or their negative."""
    checked = context.scenery.evidence.relation(name)
    for sign in (1, -1):
        positive = positive_sum(context.scenery, checked.tree, Fraction(sign))
        if positive is not None:
            squares = [[c, text_of(base)] for c, base in positive[1]]
            factor = {name: number_text(-sign)}
            yield {"rule": "nullstellensatz", "number": positive[0], "sos": squares, "c": factor}
