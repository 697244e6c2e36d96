"""Rules for the whole set: what can be met and what cannot, and numbers that no part of it exceeds."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from dofkit.checker.dimension_rules import bounds, names_told
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import Told
from dofkit.checker.trees import ONE, ZERO, Tree, add, refuse, times
from dofkit.checker.values import CheckedPoint, derivative, excludes_zero, heads_in, substituted, symbols_in


def consistent(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A motion meets all equations, and each inequality holds somewhere; all at one point where that is asked."""
    point, places = moves(evidence, claim, evidence.equations), claim.get("inequalities", {})
    sided = [one for one in evidence.problem.relations if one.kind == "inequality"]
    together = claim["path"] == "/feasible"
    fast = any(evidence.met_by(one.left) for one in sided)
    refuse(together and (fast or not sided), "there are no inequalities, or such between velocities")
    for one in sided:
        name = places.get(one.name, places.get(one.owner))
        place = point if together or name is None else evidence.point(name)
        equal_will_do = not one.strict and not evidence.is_open(one.left)
        met = place.value(one.left) > 0 or (equal_will_do and evidence.holds(one.name, place))
        refuse(not met, f"the inequality `{one.name}` is not shown to hold at its point")
    return True


def moves(evidence: CheckedEvidence, given: Told, wanted: Sequence[str]) -> CheckedPoint:
    """A point through which a motion meets equations: a regular one, or one at which all may rest."""
    if given["rule"] == "regular":
        return evidence.accounts(evidence.minor(given["minor"]), wanted).point
    refuse(given["rule"] != "point", "what can be met is shown by `regular` or `point`")
    point, still = evidence.point(given["at"]), [name for name in wanted if evidence.relation(name).kind == "finite"]
    evidence.on_set(point, still)
    evidence.settled(point, still, given)
    chosen = any(evidence.is_open(evidence.relation(name).left) for name in still)
    exact = {} if chosen else {name: tree for name, tree in point.exact.items() if name != "t"}
    rest = {**dict.fromkeys(evidence.velocities, ZERO), "tdot": ONE}
    balls = {rate: point.value(tree) for rate, tree in rest.items()}
    for name in wanted:
        left = evidence.relation(name).left
        if name not in still or "t" in symbols_in(left):
            for tree in (left, *(derivative(left, v) for v in evidence.met_by(left))):
                point.value_with(tree, balls)
            put_in = substituted(left, {**({} if evidence.is_open(left) else exact), **rest})
            evidence.identity(put_in, ZERO, f"`{name}` at rest")
    return point


def refuted(evidence: CheckedEvidence, given: Told, allowed: Sequence[str]) -> bool:
    """No motion meets equations: a positive number plus squares plus multiples of what is 0 cannot be 0.

    An inequality is refuted by itself, times squares (Krivine 1964, Stengle 1974).
    """
    refuse(given["rule"] != "nullstellensatz", "what cannot be met is shown by `nullstellensatz`")
    held = evidence.closure(allowed, None)
    total = [evidence.text(given["number"]), evidence.squares(given.get("sos", []))]
    refuse(not evidence.is_nowhere_zero(total[0], True), "the number that is left over is not positive")
    sided = {name: evidence.squares(terms) for name, terms in given.get("inequality", {}).items()}
    factors = {name: evidence.text(text) for name, text in given.get("c", {}).items()}
    refuse(len(sided) + bool(factors) > 1 and sided, "an inequality is refuted by itself")
    for name, factor in (*sided.items(), *factors.items()):
        one = evidence.relation(name)
        refuse(name not in held or one.leaf, f"`{name}` is not shown to follow everywhere")
        refuse((one.kind == "inequality") != (name in sided), "an inequality is no equation")
        refuse(not evidence.has_value_everywhere(factor), "a cofactor has no value everywhere")
        total.append(times(factor, one.left))
    evidence.identity(substituted(add(*total), {"tdot": ONE}), ZERO, "what is left over")
    return False


def inconsistent(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """The relations cannot all be met."""
    return refuted(evidence, claim, [one.name for one in evidence.problem.relations])


def conflict(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraints cannot all be met, and without any one of them the others can."""
    names = names_told(claim)
    owned = {name: evidence.owned(name, ("finite", "velocity", "inequality")) for name in names}
    refuted(evidence, claim["refutation"], [one for found in owned.values() for one in found])
    for name in names:
        others = [one for other in names if other != name for one in owned[other]]
        refuse(any(evidence.relation(one).kind == "inequality" for one in others), "an inequality conflicts by itself")
        if others:
            moves(evidence, claim["minimal"][name], others)
    return names


def everywhere(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """The largest number over all parts of the set, from relations of three kinds, from which the others follow.

    ``order``: each relation gives a coordinate, or its velocity, with a factor of numbers and parameters, and those
    before do not hold it: the finite ones are a graph, and all have constant rank. Instead of a coordinate one may give
    t, of which almost all values are then regular, where nothing else is told (Sard 1942).
    ``blocks``: a single analytic relation that is not 0 everywhere has zeros of dimension n - 1 at most; a single form,
    of which all finite relations are a graph, has rank 1 but on such a part.
    ``generic``: relations with a symbol of their own in which they are nowhere stationary: for almost all values of
    these the set is a manifold, of the rank that a cover of all shows (Sard 1942, Federer 3.4.3). Blocks, and the
    generic relations together, share no free coordinate.

    dof, where there are forms: that near a point (``most``, ``least``). None is larger where the finite relations allow
    no more, or where all relations are named here and analytic: then orbits have the dimension that the brackets span,
    which is largest almost everywhere at once (Nagano 1966).
    """
    order, blocks, generic = claim.get("order", []), claim.get("blocks", []), dict(claim.get("generic", []))
    names, size = [*(name for name, _ in order), *blocks, *generic], len(evidence.problem.coordinates)
    known, rank = evidence.closure(names, None), len(names)
    whole, apart = known.issuperset(evidence.equations), len(set(names)) == rank
    refuse(claim.get("about") != "everywhere", "the rule is about everywhere")
    refuse(not apart or not set(names) <= set(evidence.equations), "each relation stands in one place")
    refuse(not known.issuperset(evidence.finite), "not all relations are told, or follow from them everywhere")
    refuse(not all(map(evidence.is_linear, names)), "a relation is not linear in the velocities")
    forms = [name for name in names if evidence.relation(name).kind != "finite"]
    refuse(forms and (generic or (blocks and not blocks == forms == names[-1:])), "forms stand in the order, or alone")
    minor = evidence.accounts(evidence.minor(claim["minor"], names), names) if "minor" in claim else None
    free, rank = _free(evidence, order, minor and minor.point), len(minor.rows if minor else names)
    groups = [_coordinates(evidence, name, free) for name in blocks]
    groups.append(frozenset().union(*(_coordinates(evidence, name, free) for name in generic)))
    refuse(sum(map(len, groups)) != len(frozenset().union(*groups)), "two blocks share a coordinate")
    if minor:
        evidence.is_about("here", minor.point)
    for name, letter in generic.items():
        refuse(not evidence.own_symbol(name, [letter]), f"`{letter}` is not the own symbol of `{name}`")
    smooth = all(_is_analytic(evidence, name, not minor or name in dict(order)) for name in names)
    timely = any(q == "t" for _, q in order)
    refuse(not minor and (blocks or generic or timely), "a point is needed")
    refuse(timely and (blocks or generic or evidence.moving), "where t is given, nothing else is told")
    refuse((blocks or rank < len(names) or not minor) and not smooth, "a relation is not analytic")
    if rank < len(names):
        rows = [row for name in claim["covers"] for row in evidence.seen["covers", name]]
        refuse(blocks or order or sorted(rows) != sorted(names), "one cover of all finite relations is needed")
    if not evidence.moving or claim["path"] == "/velocity_dof":
        refuse(not whole, "each relation stands in one place")
        return size - rank
    found = bounds(evidence, {**claim, "about": "here"}, verified)
    refuse(found != size - rank + len(forms) and not (whole and smooth), "another part may be larger")
    return found


def _is_analytic(evidence: CheckedEvidence, name: str, given: bool) -> bool:
    """Whether a relation is analytic at all places; a form, and what gives no coordinate, up to a denominator."""
    one = evidence.relation(name)
    whole = given and one.kind == "finite"
    plain = evidence.has_value_everywhere(one.left) if whole else _is_meromorphic(evidence, one.left)
    return plain and "apply" not in heads_in(one.left)


def _is_meromorphic(evidence: CheckedEvidence, tree: Tree) -> bool:
    """Whether a tree is a quotient of expressions that are analytic everywhere."""
    below, exponent = tree.below, tree.below[-1].value if tree.head == "power" else None
    if isinstance(exponent, Fraction) and exponent.denominator == 1:
        return _is_meromorphic(evidence, below[0])
    if tree.head in ("tan", "cot", "sec", "csc"):
        return evidence.has_value_everywhere(below[0])
    parts = tree.head in ("sum", "product") and all(_is_meromorphic(evidence, part) for part in below)
    return parts or evidence.has_value_everywhere(tree)


def _free(evidence: CheckedEvidence, order: list[list[str]], point: CheckedPoint | None) -> dict[str, frozenset[str]]:
    """On which coordinates those that are given depend."""
    later, found = [q for _, q in order], dict[str, frozenset[str]]()
    own = len(set(later)) == len(later) and set(later) <= set(evidence.variables)
    refuse(not own, "each relation gives a coordinate of its own")
    for i, (name, q) in enumerate(order):
        one, slope, dot = evidence.relation(name), evidence.slope(name, q), "dot"
        dot = dot if one.kind == "velocity" else ""
        plain = symbols_in(slope) <= evidence.chosen and evidence.has_value_everywhere(slope)
        sure = evidence.ring.rational(slope) or evidence.is_nowhere_zero(slope)
        gives = sure or (plain and point and excludes_zero(point.value(slope)))
        refuse(not gives or q + dot == "tdot", f"`{name}` does not give `{q}` everywhere")
        refuse(not symbols_in(one.left).isdisjoint(q + dot for q in later[i + 1 :]), f"`{name}` holds what comes later")
        if not dot:
            found[q] = _coordinates(evidence, name, found) - {q}
    return found


def _coordinates(evidence: CheckedEvidence, name: str, given: dict[str, frozenset[str]]) -> frozenset[str]:
    held = symbols_in(evidence.relation(name).left) & set(evidence.problem.coordinates)
    return frozenset().union(*(given.get(q, frozenset((q,))) for q in held))
