"""Rules for the labels of a constraint: holonomic, scleronomic, catastatic, exact, integrals."""

from __future__ import annotations

from itertools import combinations
from typing import Any

from dofkit.checker.balls import CheckedPoint, excludes_zero
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.dimension_rules import told_integral
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import Told, admissible, involutive, of_word
from dofkit.checker.relations import total_derivative
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, refuse, symbol, times

Form = dict[str, Tree]


def own(evidence: CheckedEvidence, claim: Told, kinds: tuple[str, ...] = ("finite", "velocity")) -> tuple[str, ...]:
    """The relations of the claim's constraint, all of some kinds."""
    found = evidence.owned(claim["owner"], ("finite", "velocity", "inequality"))
    fits = found and all(evidence.relation(name).kind in kinds for name in found)
    refuse(not fits, "the constraint has no relations, or such as this rule is not for")
    return found


def finite(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A relation between coordinates and time is holonomic."""
    return bool(own(evidence, claim, ("finite",)))


def inequality(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """An inequality is not holonomic; where there is nothing else, it has no independent equation."""
    refuse(not evidence.owned(claim["owner"], ("inequality",)), "no inequality")
    refuse(claim["field"] == "independent" and evidence.owned(claim["owner"]), "there are equations as well")
    return 0 if claim["field"] == "independent" else False


def _setting(evidence: CheckedEvidence, claim: Told) -> tuple[tuple[str, ...], set[str]]:
    """The relations that may be used, all or the constraint's own where it is taken alone; and the finite ones."""
    allowed = own(evidence, claim) if claim["field"] == "holonomic_alone" else evidence.equations
    return allowed, {name for name in allowed if evidence.relation(name).kind == "finite"}


def _near(evidence: CheckedEvidence, claim: Told, point: CheckedPoint) -> None:
    if claim["field"] != "holonomic_alone":
        evidence.is_about("here", point)


def integrable(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """The constraint's forms follow from finite relations, and integrals or rows that integrate (Frobenius)."""
    allowed, start = _setting(evidence, claim)
    if claim["rule"] == "frobenius":
        minor = involutive(evidence, claim, allowed)
        point, rows = minor.point, list(minor.rows)
    else:
        point, rows = evidence.point(claim["at"]), list(claim["integrals"])
        refuse(not all(evidence.relation(name).leaf for name in rows), "an integral is a step `integral`")
        evidence.follow(rows, allowed, point, "what is taken together")
    evidence.on_set(point, start)
    _near(evidence, claim, point)
    evidence.follow(own(evidence, claim), {*start, *rows}, point, "what keeps its value")
    return True


def bracket(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A direction that motions through the point reach, and that a form of the constraint forbids.

    A consequence of finite relations holds for all directions in which the orbit of the fields extends.
    """
    (point, _), name, vector = admissible(evidence, claim, _setting(evidence, claim)[0]), claim["pairs"], Form()
    _near(evidence, claim, point)
    forbids = name in own(evidence, claim) and evidence.relation(name).kind == "velocity"
    refuse(not forbids, "what the bracket pairs with is no velocity relation of the constraint")
    for coefficient, word in claim["combination"]:
        factor = evidence.text(coefficient)
        refuse(symbols_in(factor), "a direction is a sum of words of the fields, times numbers")
        for q, tree in of_word(evidence, word, claim["fields"]).items():
            vector[q] = add(vector.get(q, ZERO), times(factor, tree))
    slow = not evidence.is_linear(name) and not evidence.same(point.prepared(vector.get("t", ZERO)), ONE)
    refuse(slow, "the direction does not have time go by 1")
    values = {q + "dot": point.value(vector.get(q, ZERO)) for q in evidence.variables}
    value = point.value_with(evidence.relation(name).left, values)
    refuse(not excludes_zero(value), "the form may be 0 in that direction")
    return False


def form_of(evidence: CheckedEvidence, name: str) -> Form:
    """The coefficients of a relation that is linear in velocities."""
    one = evidence.relation(name)
    refuse(one.kind != "velocity" or not evidence.is_linear(name), f"`{name}` is no form")
    return {v: evidence.slope(name, v) for v in evidence.variables if v + "dot" in symbols_in(one.left)}


def _only_form(evidence: CheckedEvidence, claim: Told) -> Form:
    names = own(evidence, claim, ("velocity",))
    refuse(len(names) != 1, "the constraint has several forms")
    return form_of(evidence, names[0])


def _curl(form: Form, i: str, j: str) -> Tree:
    return add(derivative(form.get(j, ZERO), i), negative(derivative(form.get(i, ZERO), j)))


def _variables(evidence: CheckedEvidence, form: Form) -> list[str]:
    held = frozenset(form).union(*(symbols_in(tree) for tree in form.values()))
    return [name for name in evidence.variables if name in held]


def wedge(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """One form by itself integrates where omega ^ d(omega) = 0 (Frobenius)."""
    form = _only_form(evidence, claim)
    refuse(claim["field"] != "holonomic_alone", "the rule `wedge` is for a form by itself")

    def triple(i: str, j: str, k: str) -> Tree:
        return add(*(times(form.get(a, ZERO), _curl(form, b, c)) for a, b, c in ((i, j, k), (j, k, i), (k, i, j))))

    if "triple" in claim:
        value = evidence.point(claim["at"]).value(triple(*claim["triple"]))
        refuse(not excludes_zero(value), "omega ^ d(omega) may be 0 at the point")
        return False
    for names in combinations(_variables(evidence, form), 3):
        evidence.identity(triple(*names), ZERO, "omega ^ d(omega)")
    return True


def _closed(evidence: CheckedEvidence, form: Form) -> None:
    for i, j in combinations(_variables(evidence, form), 2):
        evidence.identity(_curl(form, i, j), ZERO, f"the curl in {i}, {j}")


def exact(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A form is exact near every point where it is closed; it is not where a curl is not 0."""
    names = [name for name in own(evidence, claim) if evidence.relation(name).kind == "velocity"]
    refuse(not names, "there is no form")
    if "pair" in claim:
        name = claim.get("relation", names[0])
        refuse(name not in names or (len(names) > 1 and "relation" not in claim), "no form of the constraint is named")
        refuse(not set(claim["pair"]) <= set(evidence.variables), "a curl is in two coordinates")
        value = evidence.point(claim["at"]).value(_curl(form_of(evidence, name), *claim["pair"]))
        refuse(not excludes_zero(value), "the curl may be 0 at the point")
        return False
    for name in names:
        _closed(evidence, form_of(evidence, name))
    return True


def _reduced(evidence: CheckedEvidence, name: str, steps: Any) -> list[str]:
    """What is left of a relation after steps that change its set nowhere."""
    left = [name]
    for step in steps:
        made = [one for one in evidence.consequences if one.step == step and not one.nonzero]
        down = [one for one in made if len(one.sources) == 1 and one.sources[0] in left]
        back = [one for one in made if set(one.sources) == {other.target for other in down}]
        whole = all(evidence.has_value_everywhere(tree) for one in (*down, *back) for tree in one.defined)
        if down and whole and any(one.target == down[0].sources[0] for one in back):
            left = [one for one in left if one != down[0].sources[0]] + [one.target for one in down]
    return left


def timeless(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Neither t nor dt occurs, once factors that are nowhere 0 are taken out."""
    pieces, catastatic = own(evidence, claim, ("finite", "velocity", "inequality")), claim["field"] == "catastatic"
    forms = any(evidence.relation(name).kind == "velocity" for name in pieces)
    refuse(catastatic and not forms, "there is no form")
    for name in (one for piece in pieces for one in _reduced(evidence, piece, claim.get("steps", []))):
        one = evidence.relation(name)
        if catastatic and one.kind != "finite":
            evidence.identity(form_of(evidence, name).get("t", ZERO), ZERO, f"the dt term of `{name}`")
        elif not catastatic:
            evidence.identity(derivative(one.left, "tdot"), ZERO, f"the dt term of `{name}`")
            evidence.identity(derivative(one.left, "t"), ZERO, f"the derivative of `{name}` by t")
            fast = one.kind == "inequality" and evidence.met_by(one.left)
            refuse(fast, "an inequality between velocities")
            if not evidence.is_linear(name):
                degree = evidence.text(claim["degree"][name])
                refuse(symbols_in(degree), "the degree of a relation between velocities is a number")
                evidence.identity(_euler(evidence, one.left), times(degree, one.left), "Euler's relation")
    return True


def _euler(evidence: CheckedEvidence, left: Tree) -> Tree:
    return add(*(times(symbol(v), derivative(left, v)) for v in evidence.met_by(left) if v != "tdot"))


def turns(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Time enters: at a point of the relation its derivative by t is not 0, or the form has a dt term or turns.

    Where a relation is phi times one without time, phi nowhere 0, none of these is so.
    """
    name, point, catastatic = claim["relation"], evidence.point(claim["at"]), claim["field"] == "catastatic"
    names, one = own(evidence, claim, ("finite", "velocity", "inequality")), evidence.relation(claim["relation"])
    plain = len(names) == 1 or all(evidence.relation(other).kind == "finite" for other in names)
    refuse(name not in names or not plain, "the rule `turns` is for one relation of the constraint, or finite ones")
    turned = derivative(one.left, "t")
    if one.kind == "velocity" and evidence.is_linear(name):
        form = form_of(evidence, name)
        turned = form.get("t", ZERO)
        if not catastatic and "pair" in claim:
            a, b = (form.get(v, ZERO) for v in claim["pair"])
            turned = add(times(a, derivative(b, "t")), negative(times(b, derivative(a, "t"))))
    else:
        refuse(catastatic, "only a form is catastatic or not")
        if one.kind == "finite":
            evidence.on_set(point, names)
        refuse(one.kind != "finite" and not evidence.holds(name, point), "the relation is not shown to be 0 there")
        if one.kind == "velocity" and claim.get("euler") is True:
            turned = _euler(evidence, one.left)
    refuse(not excludes_zero(point.value(turned)), "time may not enter at the point")
    return False


def integral(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """The constraint says that a function keeps its value: its differential is a multiple, or it is a step's.

    An integrating factor makes the form closed.
    """
    point, factor = evidence.point(claim["at"]), evidence.text(claim.get("factor", "1"))
    if claim["field"] == "integrating_factor":
        factor = evidence.text(claim["value"])
        scaled = {name: times(factor, tree) for name, tree in _only_form(evidence, claim).items()}
        _closed(evidence, {**dict.fromkeys(symbols_in(factor) & set(evidence.variables), ZERO), **scaled})
    refuse(evidence.met_by(factor) or not excludes_zero(point.value(factor)), "the factor may be 0")
    if claim["field"] == "integrating_factor":
        return claim["value"]
    function = evidence.text(told_integral(evidence, claim["value"]))
    moves = any(excludes_zero(point.value(derivative(function, v))) for v in evidence.variables)
    refuse(evidence.met_by(function) or not moves, "the integral may be constant near the point")
    if "step" in claim:
        evidence.identity(evidence.relation(claim["step"]).left, function, "the integral of the step")
        integrable(evidence, {**claim, "integrals": [claim["step"]]}, verified)
        return claim["value"]
    (relation,) = own(evidence, claim, ("velocity",))
    change = total_derivative(function, evidence.variables)
    evidence.identity(change, times(factor, evidence.relation(relation).left), "the integral")
    return claim["value"]
