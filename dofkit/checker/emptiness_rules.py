"""Rules for what can be met and what cannot: configurations, motions, contradictions."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.checker.dimension_rules import names_told
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import Told
from dofkit.checker.trees import ONE, ZERO, add, refuse, times
from dofkit.checker.values import CheckedPoint, derivative, substituted, symbols_in


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
