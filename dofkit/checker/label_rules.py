"""Rules for the labels of a constraint, for what integrates, and for what can be met and what cannot."""

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from dofkit.checker.curves import curvature
from dofkit.checker.dimension_rules import names_told, verified_rank
from dofkit.checker.evidence import CheckedEvidence, Told, admissible, involutive, of_word, on_row
from dofkit.checker.point import CheckedPoint, not_zero
from dofkit.checker.trees import ONE, ZERO, Tree, add, derivative, homogeneous_degree, refuse, substituted, symbol

EQUATIONS, EVERY = ("finite", "velocity"), ("finite", "velocity", "inequality")


def constraint_relations(evidence: CheckedEvidence, claim: Told, kinds: tuple[str, ...] = EQUATIONS) -> tuple[str, ...]:
    """The relations of the claim's constraint, all of some kinds."""
    names = evidence.owned(claim["owner"], EVERY)
    fits = names and all(evidence.relation(name).kind in kinds for name in names)
    refuse(not fits, "the constraint has no relations, or such as this rule is not for")
    return names


def by_kind(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """Relations between coordinates and time are holonomic; inequalities are not, and no independent equations."""
    constraint_relations(evidence, claim, (claim["rule"],))
    return 0 if claim["field"] == "independent" else claim["rule"] == "finite"


def integrable(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Check that the constraint's forms depend on geometric equations and integrals, or Frobenius-integrable rows."""
    alone = claim["field"] == "holonomic_alone"
    allowed = constraint_relations(evidence, claim) if alone else evidence.equations
    start = {name for name in allowed if evidence.relation(name).kind == "finite"}
    if claim["rule"] == "frobenius":
        point, rows = involutive(evidence, claim, allowed)[:2]
    else:
        point, rows = evidence.point(claim["at"]), tuple(claim["integrals"])
        refuse(not all(evidence.relation(name).leaf for name in rows), "an integral is a step `integral`")
        evidence.follow(rows, allowed, point, "what is taken together")
    evidence.on_set(point, start)
    if not alone:
        evidence.is_about("here", point)
    evidence.follow(constraint_relations(evidence, claim), {*start, *rows}, point, "what keeps its value")
    return True


def bracket(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Return False, not holonomic: motions through the point reach a direction that a form of the constraint forbids.

    A consequence of geometric equations holds for all directions in which the orbit of the fields extends. Or the
    relation is ``curved`` on the velocities that are allowed: where integrals imply it, these are a plane.
    """
    name, alone, curves = claim["pairs"], claim["field"] == "holonomic_alone", claim["rule"] == "curved"
    allowed = constraint_relations(evidence, claim) if alone else evidence.equations
    point = curvature(evidence, claim, allowed).point if curves else admissible(evidence, claim, allowed)[0]
    if not alone:
        evidence.is_about("here", point)
    finite = {*allowed}.intersection(evidence.finite)
    evidence.follow([name], finite.union(constraint_relations(evidence, claim)), point, "the constraint")
    refuse(evidence.relation(name).kind != "velocity", "what the bracket pairs with holds no velocity")
    if not curves:
        value = point.value(on_row(evidence, name, of_word(evidence, claim["word"], claim["fields"])))
        refuse(not not_zero(value), "the form may be 0 in that direction")
    return False


def exact(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Forms are exact near every point where they are closed; one is not where a part of its derivative is not 0.

    With Cayley parameters forms stand times a factor, which may make them so.
    """
    refuse(claim.get("cayley"), "a body turns by its angles here")
    names = [name for name in constraint_relations(evidence, claim) if evidence.relation(name).kind == "velocity"]
    forms = {name: {v: evidence.slope(name, v) for v in evidence.variables} for name in names}
    refuse(not forms or not all(map(evidence.is_linear, names)), "there is no form, or a relation that is none")
    if "pair" not in claim:
        for form in forms.values():
            for pair in combinations(evidence.variables, 2):
                evidence.identity(exterior_part(form, *pair), ZERO, f"the part for {' and '.join(pair)}")
        return True
    a, b = claim["pair"]
    part = exterior_part(forms[claim["relation"] if len(forms) > 1 else names[0]], a, b)
    refuse(not {a, b} <= {*evidence.variables}, "a form has parts for coordinates and t")
    refuse(not not_zero(evidence.point(claim["at"]).value(part)), "it may be 0 at the point")
    return False


def exterior_part(form: dict[str, Tree], i: str, j: str) -> Tree:
    """A component of the derivative of a form."""
    return derivative(form.get(j, ZERO), i) - derivative(form.get(i, ZERO), j)


def timeless(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Return True: neither t nor dt occurs (catastatic: no dt), and what is not linear in velocities is homogeneous.

    Of a single relation that was verified not to be holonomic, only t must not occur. All are divided by a ``factor``
    that is nowhere 0, if one is given.
    """
    catastatic, factor = claim["field"] == "catastatic", evidence.text(claim["factor"]) if "factor" in claim else ONE
    fits = factor == ONE or (evidence.is_nowhere_zero(factor) and not evidence.met_by(factor))
    refuse(not fits, "the factor may be 0, or holds velocities")
    names = constraint_relations(evidence, claim, EQUATIONS if catastatic else EVERY)
    relations = [evidence.relation(name) for name in names]
    refuse(catastatic and all(checked.kind != "velocity" for checked in relations), "there is no form")
    nonholonomic = not catastatic and len(names) == 1 and verified.get(f"holonomic {claim['owner']}") is False
    for checked in relations:
        mixed = homogeneous_degree(checked.tree, evidence.velocities) is None and not evidence.is_linear(checked.name)
        refuse(mixed and not nonholonomic, f"`{checked.name}` is no form, or not homogeneous in velocities")
        for name in ["tdot"] if catastatic else ["t"] if nonholonomic else ["t", "tdot"]:
            what = f"the derivative of `{checked.name}` by {name}"
            evidence.identity(derivative(checked.tree / factor, name), ZERO, what)
    return True


def time_dependent(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Return False, the label of a constraint that depends on time, where a point of the relation shows it.

    There its derivative by t is not 0; or the direction of the form changes with t; or it integrates alone, with dt.
    Where a relation is phi times one without time, none of these is so: where phi is 0 the relation is stationary.
    What is not homogeneous in velocities is not catastatic.
    """
    name, point, catastatic = claim["relation"], evidence.point(claim["at"]), claim["field"] == "catastatic"
    names, checked = constraint_relations(evidence, claim, EVERY), evidence.relation(claim["relation"])
    plain = len(names) == 1 or all(evidence.relation(other).kind == "finite" for other in names)
    refuse(name not in names or not plain, "one relation of the constraint is needed, or finite ones")
    if checked.kind == "velocity" and evidence.is_linear(name):
        integrates = verified.get(f"holonomic_alone {claim['owner']}") is True
        refuse(not catastatic and "pair" not in claim and not integrates, "it is not shown to integrate")
    else:
        if checked.kind != "inequality":
            evidence.on_set(point, names)
        held = checked.kind != "inequality" or evidence.holds(name, point)
        refuse((catastatic and checked.kind != "velocity") or not held, "it holds no velocities, or is not 0 there")
        slopes = {v: derivative(checked.tree, v) for v in sorted(checked.tree.symbols - evidence.chosen - {"t"})}
        stationary = not any(not_zero(point.value(slope)) for slope in slopes.values())
        refuse(stationary and checked.kind != "inequality", "the relation may be stationary at the point")
    refuse(not not_zero(point.value(change(evidence, claim))), "time may not enter at the point")
    return False


def change(evidence: CheckedEvidence, claim: Told) -> Tree:
    """What is not 0 where time enters a relation, or the quotient of a pair of components of a form."""
    checked, catastatic = evidence.relation(claim["relation"]), claim["field"] == "catastatic"
    if checked.kind == "velocity" and evidence.is_linear(checked.name):
        if catastatic or "pair" not in claim:
            return evidence.slope(checked.name, "t")
        a, b = (evidence.slope(checked.name, v) for v in claim["pair"])
        return a * derivative(b, "t") - b * derivative(a, "t")
    if catastatic:
        return add(*(symbol(v) * derivative(checked.tree, v) for v in evidence.met_by(checked.tree)))
    return derivative(checked.tree, "t")


def integral(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """The constraint says that a function keeps its value, as a step does: its rate implies it.

    The constraint and geometric equations imply the step. Where it takes further integrals: a minor of these, of
    geometric equations and a relation of the constraint shows that they do not do alone.
    """
    point = evidence.point(claim["at"])
    function = told_integral(evidence, claim["value"], point)
    moves = any(not_zero(point.value(derivative(function, v))) for v in evidence.variables)
    refuse(evidence.met_by(function) or not moves, "the integral may be constant near the point")
    evidence.identity(evidence.relation(claim["step"]).tree, function, "the integral of the step")
    others, whole = [*claim.get("integrals", [])], constraint_relations(evidence, claim)
    refuse(set(whole) <= set(evidence.finite), "a holonomic equation has no integral")
    if not others:
        evidence.follow([claim["step"]], {*evidence.finite, *whole}, point, "the constraint")
    else:
        minor = evidence.minor(claim["minor"], {*others, *evidence.finite, *whole})
        integrals = set(minor.rows).difference(whole)
        refuse(minor.point is not point or len(integrals) == len(minor.rows), "the minor is not of the constraint")
        evidence.follow({*others, *evidence.finite}, integrals, point, "the rows of the minor")
    integrable(evidence, {**claim, "integrals": [claim["step"], *others]}, verified)
    return claim["value"]


def integrable_part(evidence: CheckedEvidence, claim: Told, verified: Told) -> Told:
    """The rank of what is finite is n - dof; the basis are relations that give it with the finite ones as written."""
    refuse(not evidence.moving, "an integrable part is of forms")
    part: Told = {"rank": len(evidence.problem.coordinates) - verified["/dof"], "basis": claim["value"]["basis"]}
    if part["basis"] is None:
        return part
    minor, steps = evidence.minor(claim["minor"]), claim.get("steps", [])
    whole = set(steps) <= set(minor.rows) <= {*steps, *evidence.finite} and len(minor.rows) == part["rank"]
    refuse(verified_rank(evidence, minor.point, verified) != part["rank"] or not whole, "the minor is not of the basis")
    for text, name in zip(part["basis"], steps, strict=True):
        function, checked = told_integral(evidence, text, minor.point), evidence.relation(name)
        refuse(not checked.leaf, "a relation of the basis is an integral")
        evidence.identity(function, checked.tree, "a relation of the basis as claimed")
    return part


def told_integral(evidence: CheckedEvidence, text: Any, point: CheckedPoint) -> Tree:
    """The function, with a value at a point, of an integral that is stated with a constant of a name of its own."""
    stated, _, constant = map(str.strip, str(text).rpartition("="))
    refuse(not constant.isidentifier() or evidence.is_taken(constant), "an integral ends with `= C`")
    function = evidence.text(stated)
    point.value(function)
    return function


def consistent(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A motion meets all equations, and each inequality holds somewhere; all at one point where that is asked.

    Inequalities between velocities hold for those of the point, which is regular: a motion has them.
    """
    point, places = moves(evidence, claim, evidence.equations), claim.get("inequalities", {})
    sided = [relation for relation in evidence.problem.relations if relation.kind == "inequality"]
    together, moving = claim["path"] == "/feasible", any(evidence.met_by(relation.tree) for relation in sided)
    refuse(together and (not sided or (moving and claim["rule"] != "regular")), "inequalities, and a regular point")
    if together and moving:
        evidence.on_set(point, evidence.equations, states=True)
    for relation in sided:
        place = point if together else evidence.point(places.get(relation.name, places.get(relation.owner, point.name)))
        equal_will_do = not relation.strict and not evidence.is_open(relation.tree)
        met = place.value(relation.tree) > 0 or (equal_will_do and evidence.holds(relation.name, place))
        refuse(not met, f"the inequality `{relation.name}` is not shown to be satisfied at its point")
    return True


def moves(evidence: CheckedEvidence, claim: Told, wanted: Sequence[str]) -> CheckedPoint:
    """A point through which a motion meets equations: a regular one, or one at which all may rest."""
    if claim["rule"] == "regular":
        return evidence.accounts(evidence.minor(claim["minor"]), wanted).point
    point = evidence.point(claim["at"])
    refuse({*wanted} - {*evidence.finite} or evidence.holds_time(wanted), "it may not rest where velocities or t occur")
    evidence.on_set(point, wanted)
    evidence.settled(point, wanted, claim)
    return point


def refuted(evidence: CheckedEvidence, refutation: Told, verified: Told, names: Sequence[str] | None = None) -> bool:
    """Return False, the value of `consistent`: by a step, what is nowhere 0 would be 0 where all relations hold."""
    names = [checked.name for checked in evidence.problem.relations] if names is None else names
    evidence.follow([refutation["step"]], names, None, "the relations")
    checked = evidence.relation(refutation["step"])
    refuse(checked.leaf or checked.kind == "inequality", "an inequality or integral says nothing of 0")
    consequence = substituted(checked.tree, {"tdot": ONE})
    refuse(not evidence.is_nowhere_zero(consequence), "what would be 0 may be so")
    return False


def conflict(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraints cannot all be met, and without any one of them the others can."""
    names = names_told(claim)
    owned = {name: evidence.owned(name, ("finite", "velocity", "inequality")) for name in names}
    refuted(evidence, claim["refutation"], verified, [row for rows in owned.values() for row in rows])
    for name in names:
        others = [row for other in names if other != name for row in owned[other]]
        refuse(any(evidence.relation(row).kind == "inequality" for row in others), "an inequality conflicts by itself")
        if others:
            moves(evidence, claim["minimal"][name], others)
    return names
