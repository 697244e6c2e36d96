"""Rules for the labels of a constraint: holonomic, scleronomic, catastatic, exact, integrals."""

from __future__ import annotations

from itertools import combinations
from typing import Any

from dofkit.checker.balls import excludes_zero
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.dimension_rules import Told, equal, is_here
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import admissible, involutive, of_word
from dofkit.checker.points import CheckedPoint
from dofkit.checker.steps import total_derivative
from dofkit.checker.trees import Tree, add, negative, number, symbol, times


def own(evidence: CheckedEvidence, claim: Told, kinds: tuple[str, ...] = ("finite", "velocity")) -> tuple[str, ...]:
    """The relations of the claim's constraint."""
    found = evidence.owned(claim["owner"], (*kinds, "inequality"))
    if not found or any(evidence.relation(name).kind not in kinds for name in found):
        raise CheckError(f"`{claim['owner']}` has no relations, or such as this rule is not for")
    return found


def _allowed(evidence: CheckedEvidence, claim: Told) -> tuple[str, ...]:
    """The relations that may be used: all, or the constraint's own where it is taken alone."""
    if claim["field"] == "holonomic_alone":
        return own(evidence, claim)
    return (*evidence.finite, *evidence.moving)


def finite(evidence: CheckedEvidence, claim: Told) -> None:
    """A relation between coordinates and time is holonomic."""
    own(evidence, claim, ("finite",))
    equal(claim, True)


def inequality(evidence: CheckedEvidence, claim: Told) -> None:
    """An inequality is not holonomic; where there is nothing else, it has no independent equation."""
    refuse(not evidence.owned(claim["owner"], ("inequality",)), "no inequality")
    refuse(claim["field"] == "independent" and evidence.owned(claim["owner"]), "there are equations as well")
    equal(claim, 0 if claim["field"] == "independent" else False)


def _follow(evidence: CheckedEvidence, claim: Told, start: set[str], point: CheckedPoint) -> None:
    left = set(own(evidence, claim)) - evidence.closure(start, point)
    if left:
        raise CheckError(f"`{min(left)}` is not shown to follow from what keeps its value")


def integrable(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraint's forms follow from finite relations and from functions that keep their values."""
    allowed, point = _allowed(evidence, claim), evidence.point(claim["at"])
    evidence.on_set(point, [name for name in allowed if evidence.relation(name).kind == "finite"])
    integrals = list(claim["integrals"])
    refuse(not all(evidence.relation(name).leaf for name in integrals), "an integral is a step `integral`")
    if not evidence.closure(allowed, point).issuperset(integrals):
        raise CheckError("an integral is not shown to keep its value near the point")
    if claim["field"] != "holonomic_alone":
        is_here(evidence, point)
    start = {name for name in allowed if evidence.relation(name).kind == "finite"}
    _follow(evidence, claim, {*start, *integrals}, point)
    equal(claim, True)


def frobenius(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraint's forms follow from rows that integrate (Frobenius)."""
    allowed = _allowed(evidence, claim)
    minor = involutive(evidence, claim, allowed)
    start = {name for name in allowed if evidence.relation(name).kind == "finite"}
    evidence.on_set(minor.point, start)
    if claim["field"] != "holonomic_alone":
        is_here(evidence, minor.point)
    _follow(evidence, claim, {*start, *minor.rows}, minor.point)
    equal(claim, True)


def bracket(evidence: CheckedEvidence, claim: Told) -> None:
    """A direction that motions through the point reach, and that a form of the constraint forbids.

    A consequence of finite relations holds for all directions in which the orbit of the fields extends.
    """
    allowed = _allowed(evidence, claim)
    point, _ = admissible(evidence, claim, allowed)
    if claim["field"] != "holonomic_alone":
        is_here(evidence, point)
    if claim["pairs"] not in own(evidence, claim) or evidence.relation(claim["pairs"]).kind != "velocity":
        raise CheckError("what the bracket pairs with is no velocity relation of the constraint")
    direction: dict[str, list[Tree]] = {}
    for coefficient, word in claim["combination"]:
        factor = evidence.text(coefficient)
        if symbols_in(factor) or not set(word) <= set(claim["fields"]):
            raise CheckError("a direction is a sum of words of the fields, times numbers")
        for name, tree in of_word(evidence, word).items():
            direction.setdefault(name, []).append(times(factor, tree))
    vector = {name: add(*terms) for name, terms in direction.items()}
    refuse(
        not evidence.is_linear(claim["pairs"])
        and not evidence.ring.vanishes(add(point.prepared(vector.get("t", number(0))), number(-1))),
        "the direction does not have time go by 1",
    )
    pairing = evidence.relation(claim["pairs"]).left
    values = {name + "dot": vector.get(name, number(0)) for name in evidence.variables}
    refuse(not excludes_zero(point.value_with(pairing, values)), "the form may be 0 in that direction")
    equal(claim, False)


def form_of(evidence: CheckedEvidence, name: str) -> dict[str, Tree]:
    """The coefficients of a relation that is linear in velocities."""
    one = evidence.relation(name)
    refuse(one.kind != "velocity" or not evidence.is_linear(name), f"`{name}` is no form")
    return {v: evidence.slope(name, v) for v in evidence.variables if v + "dot" in symbols_in(one.left)}


def _only_form(evidence: CheckedEvidence, claim: Told) -> dict[str, Tree]:
    names = own(evidence, claim, ("velocity",))
    refuse(len(names) != 1, "the constraint has several forms")
    return form_of(evidence, names[0])


def _curl(form: dict[str, Tree], i: str, j: str) -> Tree:
    zero = number(0)
    return add(derivative(form.get(j, zero), i), negative(derivative(form.get(i, zero), j)))


def _variables(evidence: CheckedEvidence, form: dict[str, Tree]) -> list[str]:
    held = frozenset(form).union(*(symbols_in(tree) for tree in form.values()))
    return [name for name in evidence.variables if name in held]


def wedge(evidence: CheckedEvidence, claim: Told) -> None:
    """One form by itself integrates where omega ^ d(omega) = 0 (Frobenius)."""
    form = _only_form(evidence, claim)
    refuse(claim["field"] != "holonomic_alone", "the rule `wedge` is for a form by itself")

    def triple(i: str, j: str, k: str) -> Tree:
        zero = number(0)
        parts = ((i, j, k), (j, k, i), (k, i, j))
        return add(*(times(form.get(a, zero), _curl(form, b, c)) for a, b, c in parts))

    if claim["value"] is True:
        for names in combinations(_variables(evidence, form), 3):
            evidence.identity(triple(*names), "omega ^ d(omega)")
        return
    point = evidence.point(claim["at"])
    refuse(not excludes_zero(point.value(triple(*claim["triple"]))), "omega ^ d(omega) may be 0 at the point")
    equal(claim, False)


def closed(evidence: CheckedEvidence, claim: Told) -> None:
    """A form is exact near every point where it is closed."""
    forms = [form_of(evidence, name) for name in own(evidence, claim) if evidence.relation(name).kind == "velocity"]
    for form in forms:
        for i, j in combinations(_variables(evidence, form), 2):
            evidence.identity(_curl(form, i, j), f"the curl in {i}, {j}")
    refuse(not forms, "there is no form")
    equal(claim, True)


def not_closed(evidence: CheckedEvidence, claim: Told) -> None:
    """A curl that is not 0 at a point, of the constraint's form or of that of its forms which is named."""
    form, (i, j) = _only_form(evidence, claim) if "relation" not in claim else {}, claim["pair"]
    if "relation" in claim:
        refuse(claim["relation"] not in own(evidence, claim), "no relation of the constraint")
        form = form_of(evidence, claim["relation"])
    if not {i, j} <= set(evidence.variables) or not excludes_zero(evidence.point(claim["at"]).value(_curl(form, i, j))):
        raise CheckError("the curl may be 0 at the point")
    equal(claim, False)


def _reduced(evidence: CheckedEvidence, name: str, steps: Any) -> list[str]:
    """What is left of a relation after steps that change its set nowhere."""
    left = [name]
    for step in steps:
        made = next((one for one in evidence.parts["relations"] if one.get("id") == step), {})
        if made.get("by") not in ("factor", "square", "sos") or made.get("of") not in left:
            continue
        names = [one.target for one in evidence.consequences if one.sources == (made["of"],) and not one.nonzero]
        names = [one for one in names if one == step or one.startswith(f"{step}.")]
        if names:
            left = [one for one in left if one != made["of"]] + names
    return left


def timeless(evidence: CheckedEvidence, claim: Told) -> None:
    """Neither t nor dt occurs, once factors that are nowhere 0 are taken out."""
    pieces = own(evidence, claim, ("finite", "velocity", "inequality"))
    if claim["field"] == "catastatic" and not any(evidence.relation(name).kind == "velocity" for name in pieces):
        raise CheckError("there is no form")
    for name in (one for piece in pieces for one in _reduced(evidence, piece, claim.get("steps", []))):
        left = evidence.relation(name).left
        if claim["field"] == "catastatic" and (
            evidence.relation(name).kind == "finite" or form_of(evidence, name).get("t") is None
        ):
            continue
        evidence.identity(derivative(left, "tdot"), f"the dt term of `{name}`")
        if claim["field"] == "scleronomic":
            evidence.identity(derivative(left, "t"), f"the derivative of `{name}` by t")
            if not evidence.is_linear(name) or (
                evidence.relation(name).kind == "inequality" and evidence.has_velocities(left)
            ):
                degree = evidence.text(claim["degree"][name])
                if symbols_in(degree) or evidence.relation(name).kind == "inequality":
                    raise CheckError("the degree of a relation between velocities is a number")
                euler = add(*(times(symbol(v), derivative(left, v)) for v in sorted(evidence.velocities)))
                evidence.identity(add(euler, negative(times(degree, left))), "Euler's relation")
    equal(claim, True)


def turns(evidence: CheckedEvidence, claim: Told) -> None:
    """Time enters: at a point of the relation its derivative by t is not 0, or the form has a dt term or turns.

    Where a relation is phi times one without time, phi nowhere 0, none of these is so.
    """
    name, point = claim["relation"], evidence.point(claim["at"])
    names = own(evidence, claim, ("finite", "velocity", "inequality"))
    one = evidence.relation(name)
    if name not in names or (len(names) > 1 and any(evidence.relation(n).kind != "finite" for n in names)):
        raise CheckError("the rule `turns` is for one relation of the constraint, or for finite ones")
    if one.kind == "velocity" and evidence.is_linear(name):
        form = form_of(evidence, name)
        turned = form.get("t", number(0))
        if claim["field"] == "scleronomic" and "pair" in claim:
            a, b = (form.get(v, number(0)) for v in claim["pair"])
            turned = add(times(a, derivative(b, "t")), negative(times(b, derivative(a, "t"))))
    else:
        refuse(claim["field"] != "scleronomic", "only a form is catastatic or not")
        turned = _moved_by_time(evidence, claim, names, point)
    refuse(not excludes_zero(point.value(turned)), "time may not enter at the point")
    equal(claim, False)


def _moved_by_time(evidence: CheckedEvidence, claim: Told, names: tuple[str, ...], point: CheckedPoint) -> Tree:
    one = evidence.relation(claim["relation"])
    if one.kind == "finite":
        evidence.on_set(point, names)
    elif not evidence.holds(one.name, point):
        raise CheckError("the relation is not shown to be 0 at the point")
    if one.kind == "velocity" and claim.get("euler") is True:
        return add(*(times(symbol(v), derivative(one.left, v)) for v in sorted(evidence.velocities - {"tdot"})))
    return derivative(one.left, "t")


def factor(evidence: CheckedEvidence, claim: Told) -> None:
    """An integrating factor: times it the form is closed, and it is not 0 at a point."""
    form, multiplier = _only_form(evidence, claim), evidence.text(claim["value"])
    if evidence.has_velocities(multiplier) or not excludes_zero(evidence.point(claim["at"]).value(multiplier)):
        raise CheckError("the factor may be 0 at the point")
    scaled = {name: times(multiplier, tree) for name, tree in form.items()}
    for i, j in combinations(_variables(evidence, {**scaled, "": multiplier}), 2):
        evidence.identity(_curl(scaled, i, j), f"the curl in {i}, {j}")


def integral(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraint says that a function keeps its value: alone (its differential is a multiple), or in the system."""
    text, _, constant = str(claim["value"]).rpartition("=")
    function, point = evidence.text(claim["function"]), evidence.point(claim["at"])
    if not constant.strip().isidentifier() or constant.strip() in {*evidence.variables, *evidence.problem.parameters}:
        raise CheckError("an integral ends with `= C`")
    evidence.identity(add(evidence.text(text.strip()), negative(function)), "the integral as it is told")
    names = [v for v in evidence.variables if v in symbols_in(function)]
    if evidence.has_velocities(function) or not any(excludes_zero(point.value(derivative(function, v))) for v in names):
        raise CheckError("the integral may be constant near the point")
    if "step" not in claim:
        multiplier = evidence.text(claim["factor"])
        (relation,) = own(evidence, claim, ("velocity",))
        if evidence.has_velocities(multiplier) or not excludes_zero(point.value(multiplier)):
            raise CheckError("the factor may be 0 at the point")
        change = total_derivative(function, evidence.variables)
        evidence.identity(add(change, negative(times(multiplier, evidence.relation(relation).left))), "the integral")
        return
    step = evidence.relation(claim["step"])
    evidence.identity(add(step.left, negative(function)), "the integral of the step")
    integrable(evidence, {**claim, "value": True, "integrals": [claim["step"]], "field": "integral"})
