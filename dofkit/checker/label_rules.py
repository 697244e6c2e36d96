"""Rules for the labels of a constraint: holonomic, scleronomic, catastatic, exact, integrals."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

from dofkit.checker.dimension_rules import told_integral
from dofkit.checker.evidence import CheckedEvidence
from dofkit.checker.fields import Told, admissible, involutive, of_word
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, refuse, symbol, times
from dofkit.checker.values import CheckedPoint, derivative, excludes_zero, symbols_in

Form = dict[str, Tree]
EQUATIONS, EVERY = ("finite", "velocity"), ("finite", "velocity", "inequality")


def own(evidence: CheckedEvidence, claim: Told, kinds: tuple[str, ...] = EQUATIONS) -> tuple[str, ...]:
    """The relations of the claim's constraint, all of some kinds."""
    found = evidence.owned(claim["owner"], EVERY)
    fits = found and all(evidence.relation(name).kind in kinds for name in found)
    refuse(not fits, "the constraint has no relations, or such as this rule is not for")
    return found


def finite(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """A relation between coordinates and time is holonomic."""
    return bool(own(evidence, claim, ("finite",)))


def inequality(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """An inequality is not holonomic; where there is nothing else, it has no independent equation."""
    counted = claim["field"] == "independent"
    refuse(not evidence.owned(claim["owner"], ("inequality",)), "no inequality")
    refuse(counted and evidence.owned(claim["owner"]), "there are equations as well")
    return 0 if counted else False


def _setting(evidence: CheckedEvidence, claim: Told) -> tuple[str, ...]:
    """The relations that may be used: all, or the constraint's own where it is taken alone."""
    return own(evidence, claim) if claim["field"] == "holonomic_alone" else evidence.equations


def _near(evidence: CheckedEvidence, claim: Told, point: CheckedPoint) -> None:
    if claim["field"] != "holonomic_alone":
        evidence.is_about("here", point)


def integrable(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """The constraint's forms follow from finite relations, and integrals or rows that integrate (Frobenius)."""
    allowed = _setting(evidence, claim)
    start = {name for name in allowed if evidence.relation(name).kind == "finite"}
    if claim["rule"] == "frobenius":
        point, rows = involutive(evidence, claim, allowed)[:2]
    else:
        point, rows = evidence.point(claim["at"]), tuple(claim["integrals"])
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
    (point, _), name = admissible(evidence, claim, _setting(evidence, claim)), claim["pairs"]
    _near(evidence, claim, point)
    forbids = name in own(evidence, claim) and evidence.relation(name).kind == "velocity"
    refuse(not forbids, "what the bracket pairs with is no velocity relation of the constraint")
    vector = of_word(evidence, claim["word"], claim["fields"])
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


def _forms(evidence: CheckedEvidence, claim: Told, single: bool = False) -> dict[str, Form]:
    """The forms of the claim's constraint, by their names; all, or a single one, that is all it says."""
    names = own(evidence, claim)
    forms = {name: form_of(evidence, name) for name in names if evidence.relation(name).kind == "velocity"}
    refuse(not forms or (single and len(names) > 1), "there is no form, or several")
    return forms


def _curl(form: Form, i: str, j: str) -> Tree:
    return add(derivative(form.get(j, ZERO), i), negative(derivative(form.get(i, ZERO), j)))


def _identically(evidence: CheckedEvidence, form: Form, part: Callable[..., Tree], size: int) -> None:
    """`CheckError` unless a part of a form is 0 for any so many variables."""
    held = frozenset(form).union(*map(symbols_in, form.values()))
    for names in combinations([name for name in evidence.variables if name in held], size):
        evidence.identity(part(form, *names), ZERO, f"the part for {', '.join(names)}")


def _somewhere(evidence: CheckedEvidence, claim: Told, form: Form, part: Callable[..., Tree], names: list[str]) -> bool:
    """False; `CheckError` unless a part of a form is not 0 at the claim's point."""
    refuse(not set(names) <= set(evidence.variables), "a form has parts for coordinates and t")
    refuse(not excludes_zero(evidence.point(claim["at"]).value(part(form, *names))), "it may be 0 at the point")
    return False


def _triple(form: Form, i: str, j: str, k: str) -> Tree:
    return add(*(times(form.get(a, ZERO), _curl(form, b, c)) for a, b, c in ((i, j, k), (j, k, i), (k, i, j))))


def wedge(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """One form by itself integrates where omega ^ d(omega) = 0 (Frobenius)."""
    (form,) = _forms(evidence, claim, single=True).values()
    if "triple" in claim:
        return _somewhere(evidence, claim, form, _triple, claim["triple"])
    _identically(evidence, form, _triple, 3)
    return True


def exact(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Forms are exact near every point where they are closed; one is not where a curl is not 0."""
    forms = _forms(evidence, claim, single="pair" in claim and "relation" not in claim)
    if "pair" in claim:
        return _somewhere(evidence, claim, forms[claim.get("relation", min(forms))], _curl, claim["pair"])
    for form in forms.values():
        _identically(evidence, form, _curl, 2)
    return True


def timeless(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Neither t nor dt occurs; what is not linear in velocities is homogeneous."""
    names, catastatic = own(evidence, claim, EVERY), claim["field"] == "catastatic"
    ones = [evidence.relation(name) for name in names]
    refuse(catastatic and all(one.kind != "velocity" for one in ones), "there is no form")
    for one in ones:
        if catastatic and one.kind != "finite":
            evidence.identity(form_of(evidence, one.name).get("t", ZERO), ZERO, f"the dt term of `{one.name}`")
        elif not catastatic:
            refuse(one.kind == "inequality" and evidence.met_by(one.left), "an inequality between velocities")
            for symbol_of_time in ("t", "tdot"):
                slope = derivative(one.left, symbol_of_time)
                evidence.identity(slope, ZERO, f"the derivative of `{one.name}` by {symbol_of_time}")
            if not evidence.is_linear(one.name):
                degree, met = evidence.text(claim["degree"][one.name]), evidence.met_by(one.left)
                refuse(symbols_in(degree), "the degree of a relation between velocities is a number")
                euler = add(*(times(symbol(v), derivative(one.left, v)) for v in met))
                evidence.identity(euler, times(degree, one.left), "Euler's relation")
    return True


def turns(evidence: CheckedEvidence, claim: Told, verified: Told) -> bool:
    """Time enters: at a point of the relation its derivative by t is not 0, or the form has a dt term or turns.

    Where a relation is phi times one without time, phi nowhere 0, none of these is so.
    """
    name, point, catastatic = claim["relation"], evidence.point(claim["at"]), claim["field"] == "catastatic"
    names, one = own(evidence, claim, EVERY), evidence.relation(claim["relation"])
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
    refuse(not excludes_zero(point.value(turned)), "time may not enter at the point")
    return False


def factor(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """An integrating factor makes the form closed, and is not 0."""
    point, tree = evidence.point(claim["at"]), evidence.text(claim["value"])
    (form,) = _forms(evidence, claim, single=True).values()
    refuse(evidence.met_by(tree) or not excludes_zero(point.value(tree)), "the factor may be 0")
    held = dict.fromkeys(symbols_in(tree) & set(evidence.variables), ZERO)
    _identically(evidence, {**held, **{name: times(tree, part) for name, part in form.items()}}, _curl, 2)
    return claim["value"]


def integral(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """The constraint says that a function keeps its value, as a step does: it follows from its rate.

    Where it takes further integrals: a minor of these, of finite relations and a relation of the constraint shows that
    they do not do alone.
    """
    point, function = evidence.point(claim["at"]), evidence.text(told_integral(evidence, claim["value"]))
    moves = any(excludes_zero(point.value(derivative(function, v))) for v in evidence.variables)
    refuse(evidence.met_by(function) or not moves, "the integral may be constant near the point")
    evidence.identity(evidence.relation(claim["step"]).left, function, "the integral of the step")
    others, whole = [*claim.get("integrals", [])], own(evidence, claim)
    if others:
        minor = evidence.minor(claim["minor"], {*others, *evidence.finite, *whole})
        rest = set(minor.rows).difference(whole)
        refuse(minor.point is not point or len(rest) == len(minor.rows), "the minor is not of the constraint")
        evidence.follow({*others, *evidence.finite}, rest, point, "the rows of the minor")
    integrable(evidence, {**claim, "integrals": [claim["step"], *others]}, verified)
    return claim["value"]
