"""Curves on what independent rows leave: along them another relation is followed, where it is stationary itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.checker.evidence import CheckedEvidence, CheckedMinor
from dofkit.checker.fields import Told, field_named, independent, tangent
from dofkit.checker.relations import total_derivative
from dofkit.checker.trees import Tree, refuse
from dofkit.checker.values import PRECISION, excludes_zero, heads_in, symbols_in

HIGHEST_ORDER = 8


def along_curve(
    evidence: CheckedEvidence, minor: CheckedMinor, speeds: Mapping[str, Any], tree: Tree, order: int
) -> Any:
    """The derivative of a tree of some order along a curve through the minor's point on which its rows stay 0.

    Coordinates in ``speeds`` have these, and no acceleration; those of the columns follow; all others rest. Of g(q) = 0
    the k-th derivative is J q^(k) and a rest without q^(k), by which q^(k) is found.
    """
    refuse(type(order) is not int or not 1 <= order <= HIGHEST_ORDER, "the order of a derivative is small")
    lefts, moved = [*(evidence.relation(row).left for row in minor.rows), tree], [*minor.columns, *speeds]
    names, rates = list(moved), dict[str, Any]()
    taken = evidence.chosen.intersection(q + "dot" * k for q in moved for k in range(1, order + 1))
    refuse(taken, "a parameter has the name of a derivative")
    with ctx.workprec(PRECISION):
        slopes = [[minor.point.value(evidence.slope(row, column)) for column in minor.columns] for row in minor.rows]
        for k in range(1, order + 1):
            evidence.effort.spend(10 * sum(left.size for left in lefts))
            lefts = [total_derivative(left, names) for left in lefts]
            names += [q + "dot" * k for q in moved]
            rates |= {q + "dot" * k: speeds.get(q, arb(0)) if k == 1 else arb(0) for q in moved}
            rest = arb_mat([[minor.point.value_with(left, rates)] for left in lefts[:-1]])
            found = arb_mat(slopes).solve(rest) if minor.rows else rest
            rates |= {q + "dot" * k: -found[i, 0] for i, q in enumerate(minor.columns)}
    return minor.point.value_with(lefts[-1], rates)


def _stationary(evidence: CheckedEvidence, given: Told) -> tuple[CheckedMinor, Tree, tuple[str, ...]]:
    """A minor of finite relations of the scene, and another finite one, all analytic and without time."""
    minor, name = evidence.minor(given["minor"]), given["zero"]
    names = (*minor.rows, name)
    refuse(not set(names) <= set(evidence.finite), "the rows are finite relations of the scene")
    trees = [evidence.relation(one).left for one in names]
    refuse(evidence.moving or any("t" in symbols_in(t) or "apply" in heads_in(t) for t in trees), "forms, or time")
    evidence.on_set(minor.point, names)
    return minor, trees[-1], names


def isolated(evidence: CheckedEvidence, given: Told) -> CheckedMinor:
    """A minor at whose point the set is no more than the orbit of fields, which keep it.

    Where the fields' own coordinates (``pins``) rest, the rows leave a curve, on which another relation has a
    derivative that is not 0: its zero is isolated. Every point near it is moved there by the fields.
    """
    minor, zero, names = _stationary(evidence, given)
    fields, pins, free = [field_named(evidence, name) for name in given["fields"]], given["pins"], given["free"]
    every = sorted((*minor.columns, *pins, free))
    refuse(every != sorted(evidence.problem.coordinates), "columns, pins and one more are the coordinates, each once")
    refuse(any("t" in field for field in fields), "a field moves time")
    tangent(evidence, fields, names)
    independent(evidence, fields, pins, minor.point)
    value = along_curve(evidence, minor, {free: arb(1)}, zero, given["order"])
    refuse(not excludes_zero(value), "the zero on the curve is not shown to be isolated")
    return minor


def crossing(evidence: CheckedEvidence, given: Told) -> CheckedMinor:
    """A minor at whose point one more relation is positive along a curve and negative along another, and all follow.

    Its zeros part what the rows leave, so that their dimension is one less (Hurewicz and Wallman 1941), and no larger,
    since it is analytic. Signs: of the second derivatives; where a first one is not 0 it has both signs anyway.
    """
    minor, zero, names = _stationary(evidence, given)
    evidence.follow(evidence.equations, names, minor.point, "the rows and one more")
    evidence.on_set(minor.point, evidence.equations)
    left = set(evidence.problem.coordinates) - set(minor.columns)
    for sign, speeds in zip((1, -1), given["speeds"], strict=True):
        numbers = {q: evidence.text(text) for q, text in speeds.items()}
        refuse(not numbers.keys() <= left or any(map(symbols_in, numbers.values())), "numbers for free coordinates")
        balls = {q: minor.point.value(tree) for q, tree in numbers.items()}
        value = along_curve(evidence, minor, balls, zero, 2) * sign
        refuse(not value > 0, "the sign along a curve is not shown")
    return minor
