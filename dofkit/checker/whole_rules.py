"""Rules for numbers of the whole set: what no part of it exceeds."""

from __future__ import annotations

from fractions import Fraction

from dofkit.checker.dimension_rules import bounds
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import Told
from dofkit.checker.trees import Tree, refuse
from dofkit.checker.values import CheckedPoint, excludes_zero, heads_in, symbols_in


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
