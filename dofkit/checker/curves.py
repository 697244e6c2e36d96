"""Curves on which rows stay 0: what is isolated, crosses or is curved at a point; bounds of dof from above."""

from collections.abc import Callable, Collection
from itertools import chain, product
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.checker.evidence import CheckedEvidence, CheckedMinor, Told, field_named, independent, involutive, tangent
from dofkit.checker.point import PRECISION, not_zero
from dofkit.checker.trees import Tree, add, along, derivative, refuse, symbol

HIGHEST_ORDER, MOST_DIRECTIONS = 8, 12


def along_curve(evidence: CheckedEvidence, minor: CheckedMinor, speeds: Told, tree: Tree, order: int) -> Any:
    """The derivative of a tree of some order along a curve through the minor's point on which its rows stay 0.

    Coordinates in ``speeds`` have these, and no acceleration; those of the columns follow; all others rest. Of g(q) = 0
    the k-th derivative is J q^(k) and a rest without q^(k), by which q^(k) is found.
    """
    refuse(type(order) is not int or not 1 <= order <= HIGHEST_ORDER, "the order of a derivative is small")
    lefts, moved = [*(evidence.relation(row).tree for row in minor.rows), tree], [*minor.columns, *speeds]
    names, rates = list(moved), dict[str, Any]()
    with ctx.workprec(PRECISION):
        slopes = [[minor.point.value(evidence.slope(row, column)) for column in minor.columns] for row in minor.rows]
        for k in range(1, order + 1):
            evidence.effort.spend(10 * sum(equation.size for equation in lefts))
            lefts = [along({name: symbol(name + "'") for name in names}, equation) for equation in lefts]
            names += [q + "'" * k for q in moved]
            rates |= {q + "'" * k: speeds.get(q, arb(0)) if k == 1 else arb(0) for q in moved}
            remainder = arb_mat([[minor.point.value_with(equation, rates)] for equation in lefts[:-1]])
            solution = arb_mat(slopes).solve(remainder) if minor.rows else remainder
            rates |= {q + "'" * k: -solution[i, 0] for i, q in enumerate(minor.columns)}
    return minor.point.value_with(lefts[-1], rates)


def left_over(evidence: CheckedEvidence, claim: Told) -> tuple[CheckedMinor, Tree, Callable[..., Any]]:
    """A minor, a combination of equations that is 0 besides its rows, and its derivatives along free directions."""
    minor, weights = evidence.minor(claim["minor"]), {name: evidence.text(text) for name, text in claim["zero"].items()}
    names, point = [*minor.rows, *weights], minor.point
    unfit = evidence.moving or evidence.problem.world.names.functions or evidence.holds_time(names)
    refuse(unfit or not {*names} <= {*evidence.finite}, "holonomic equations of the scene, without time")
    refuse(any(weight.symbols for weight in weights.values()), "the weights are numbers")
    evidence.on_set(point, names)
    zero = add(*(weight * evidence.relation(name).tree for name, weight in weights.items()))

    def derivative_of(order: int, *directions: dict[str, str]) -> Any:
        speeds = {
            q: point.value(add(*(evidence.text(direction.get(q, "0")) for direction in directions)))
            for q in chain(*directions)
        }
        bound = not speeds.keys() <= {*evidence.problem.coordinates} - {*minor.columns}
        refuse(bound, "speeds are of free coordinates")
        return along_curve(evidence, minor, speeds, zero, order)

    return minor, zero, derivative_of


def isolated(evidence: CheckedEvidence, claim: Told) -> CheckedMinor:
    """A minor whose rows leave more dimensions than there are: another relation is not 0 on all that they leave.

    It has a derivative that is not 0 along a curve there, and what is analytic is 0 on a thin set only. Or a
    combination is stationary, and its second derivatives in several directions are definite (Sylvester): across these
    it is 0 at the point alone (Morse). Fields that keep all, and fill the other directions, carry that point to all
    that there is around; with one direction they may be left out, and then nothing is said of this.
    """
    (minor, zero, rate), names = left_over(evidence, claim), claim.get("fields", [])
    directions = claim["speeds"]
    refuse(not 0 < len(directions) <= MOST_DIRECTIONS, "a few directions are needed")
    if len(directions) == 1:
        refuse(not not_zero(rate(claim["order"], *directions)), "the zero on the curve is not shown to be isolated")
    else:
        form = [[rate(2, a, b) - rate(2, a) - rate(2, b) for b in directions] for a in directions]
        signed = [[entry if form[0][0] > 0 else -entry for entry in row] for row in form]
        leading = (arb_mat([row[:k] for row in signed[:k]]).det() for k in range(1, len(directions) + 1))
        refuse(not all(value > 0 for value in leading), "the form is not shown to be definite")
        slopes = (minor.point.prepared(derivative(zero, q)) for q in evidence.problem.coordinates)
        chosen = any(evidence.is_open(evidence.relation(name).tree) for name in (*minor.rows, *claim["zero"]))
        still = not chosen and all(map(evidence.ring.vanishes, slopes))
        refuse(not still, "the combination is not stationary at the point, whatever the point chose")
    if names or len(directions) > 1:
        tangent(evidence, ([name] for name in names), (*minor.rows, *claim["zero"]))
        crossed = [*({q: evidence.text(text) for q, text in direction.items()} for direction in directions)]
        free = [q for q in evidence.problem.coordinates if q not in minor.columns]
        independent(evidence, [*crossed, *(field_named(evidence, name) for name in names)], free, minor.point)
    return minor


def crossing(evidence: CheckedEvidence, claim: Told) -> CheckedMinor:
    """A minor whose rows, with one relation more, are all: this takes both signs near the point, on what they leave.

    So its zeros separate a manifold there, and have one dimension less at least (Hurewicz and Wallman 1941).
    """
    (minor, _, derivative_of), (name,) = left_over(evidence, claim), claim["zero"]
    evidence.follow(evidence.finite, {*minor.rows, name}, minor.point, "the rows and what is 0")
    evidence.on_set(minor.point, evidence.finite)
    first, other = (derivative_of(2, direction) for direction in claim["speeds"])
    refuse(not (first > 0 > other), "it is not shown to take both signs")
    return minor


def curvature(evidence: CheckedEvidence, claim: Told, allowed: Collection[str]) -> CheckedMinor:
    """Rows that account for relations at a state, of which one is curved along a velocity that all of them allow.

    Near the state the velocities that are allowed are a manifold with the rows' kernel for tangent space. A second
    derivative of a row along it that is not 0 shows that the manifold is no plane: its vectors span a dimension more at
    least, and motions reach all of that.
    """
    minor, name = evidence.accounts(evidence.minor(claim["minor"], allowed), allowed), claim["pairs"]
    value = minor.point.value
    speeds = {q: value(evidence.text(text)) for q, text in claim["speeds"].items() if q not in (*minor.columns, "t")}
    refuse(name not in minor.rows, "what is curved is a row")
    with ctx.workprec(PRECISION):
        slopes = [[value(evidence.slope(row, column)) for column in minor.columns] for row in minor.rows]
        pushed = [[sum((value(evidence.slope(row, q)) * v for q, v in speeds.items()), arb(0))] for row in minor.rows]
        solution = arb_mat(slopes).solve(arb_mat(pushed))
        speeds |= {q: -solution[i, 0] for i, q in enumerate(minor.columns)}
        second = {(a, b): value(derivative(evidence.slope(name, a), f"{b}dot")) for a, b in product(speeds, repeat=2)}
        curve = sum((slope * speeds[a] * speeds[b] for (a, b), slope in second.items()), arb(0))
        refuse(not not_zero(curve), "it may not be curved")
    return minor


def finite_minor(evidence: CheckedEvidence, claim: Told) -> CheckedMinor:
    """A minor of geometric equations and integrals."""
    minor = evidence.minor(claim["minor"])
    refuse(any(evidence.relation(row).kind != "finite" for row in minor.rows), "a row of velocities reduces no dof")
    return minor


#: What shows how many freedoms there are at most: as many as coordinates less rows, or one less.
MOST = {"minor": finite_minor, "frobenius": involutive, "isolated": isolated}
#: What shows how many there are at least: a minor, and how many more than coordinates less rows.
LEAST: dict[str, Callable[[CheckedEvidence, Told], tuple[CheckedMinor, int]]] = {
    "regular": lambda evidence, least: (evidence.accounts(evidence.minor(least["minor"]), evidence.equations), 0),
    "crossing": lambda evidence, least: (crossing(evidence, least), -1),
    "curved": lambda evidence, least: (curvature(evidence, least, evidence.equations), 1),
}
