"""Rules for what can be met and what cannot: configurations, motions, contradictions."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import arb

from dofkit.checker.balls import ball_of, evaluated, excludes_zero
from dofkit.checker.derivatives import derivative, substituted, symbols_in
from dofkit.checker.dimension_rules import Told, equal, names_told
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence, has_own_symbol
from dofkit.checker.points import CheckedPoint
from dofkit.checker.problem import CheckedRelation
from dofkit.checker.texts import has_value_everywhere
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, number, symbol, times

MOST_BOXES = 20_000


def consistent(evidence: CheckedEvidence, claim: Told) -> None:
    """A motion through an interval of time meets all equations, and each inequality holds somewhere."""
    moves(evidence, claim, (*evidence.finite, *evidence.moving))
    for one in evidence.problem.relations:
        if one.kind == "inequality":
            places = claim.get("inequalities", {})
            _met(evidence, one, evidence.point(places.get(one.name, places.get(one.owner, claim.get("at")))))
    equal(claim, True)


def _met(evidence: CheckedEvidence, one: CheckedRelation, point: CheckedPoint) -> None:
    equal_will_do = not one.strict and not evidence.is_open(one.left)
    if not point.value(one.left) > 0 and not (equal_will_do and evidence.holds(one.name, point)):
        raise CheckError(f"the inequality `{one.name}` is not shown to hold at its point")


def feasible(evidence: CheckedEvidence, claim: Told) -> None:
    """At one point a motion meets all equations, and all inequalities hold."""
    sided = [one for one in evidence.problem.relations if one.kind == "inequality"]
    refuse(not sided, "there are no inequalities")
    moves(evidence, claim, (*evidence.finite, *evidence.moving))
    point = evidence.point(claim["at"]) if claim["rule"] == "point" else evidence.minor(claim["minor"]).point
    for one in sided:
        refuse(evidence.has_velocities(one.left), "an inequality between velocities needs more than a point")
        _met(evidence, one, point)
    equal(claim, True)


def moves(evidence: CheckedEvidence, given: Told, wanted: Sequence[str]) -> None:
    """Some equations are met through an interval of time: at rest, by a regular point, or by a motion that is told."""
    if given["rule"] == "regular":
        minor = evidence.minor(given["minor"])
        evidence.covers(minor, wanted)
    elif given["rule"] == "motion":
        _motion(evidence, given, wanted)
    elif given["rule"] == "point":
        point = evidence.point(given["at"])
        _rest(evidence, point, wanted)
        finite = [name for name in wanted if evidence.relation(name).kind == "finite"]
        if any(
            evidence.is_open(evidence.relation(name).left) and not has_own_symbol(evidence, name) for name in finite
        ):
            minor = evidence.minor(given["minor"])
            evidence.covers(minor, finite)
            refuse(minor.point is not point, "the minor is not at the point")
    else:
        raise CheckError(f"no rule `{str(given['rule'])[:40]}` for what can be met")


def _rest(evidence: CheckedEvidence, point: CheckedPoint, wanted: Sequence[str]) -> None:
    """To stay at the point is a motion."""
    evidence.on_set(point, [name for name in wanted if evidence.relation(name).kind == "finite"])
    still = {name + "dot": ZERO for name in evidence.problem.coordinates} | {"tdot": ONE}
    values = {name: tree for name, tree in point.exact.items() if name != "t"} | still
    for name in wanted:
        one = evidence.relation(name)
        if one.kind == "finite" and "t" not in symbols_in(one.left):
            continue
        point.value_with(one.left, still)
        if one.kind == "velocity" and evidence.is_linear(name):
            for v in sorted(evidence.velocities & symbols_in(one.left)):
                point.value(derivative(one.left, v))
        left = substituted(one.left, still if evidence.is_open(one.left) else values)
        evidence.identity(left, f"`{name}` at rest")


def _motion(evidence: CheckedEvidence, given: Told, wanted: Sequence[str]) -> None:
    """Coordinates as functions of time that meet the equations identically, smooth around one moment."""
    point = evidence.point(given["at"])
    path = {q: evidence.text(given["q"][q]) for q in evidence.problem.coordinates}
    moving = {*evidence.problem.coordinates, *evidence.velocities}
    if any(not symbols_in(tree).isdisjoint(moving) for tree in path.values()):
        raise CheckError("a motion gives the coordinates by time and parameters")
    rates = {q + "dot": derivative(tree, "t") for q, tree in path.items()}
    for tree in (*path.values(), *rates.values()):
        point.value(tree)
    for name in wanted:
        held = substituted(evidence.relation(name).left, {**path, **rates, "tdot": ONE})
        point.value(held)
        evidence.identity(held, f"`{name}` along the motion")


def refuted(evidence: CheckedEvidence, given: Told, allowed: Sequence[str]) -> None:
    """No motion meets the equations ``allowed`` (or one inequality by itself)."""
    rules = {"nullstellensatz": _combination, "polygon": _polygon, "boxes": _boxes}
    refuse(given["rule"] not in rules, f"no rule `{str(given['rule'])[:40]}` for what cannot be met")
    rules[given["rule"]](evidence, given, evidence.closure(allowed, None))


def inconsistent(evidence: CheckedEvidence, claim: Told) -> None:
    """The equations cannot all be met."""
    names = tuple(one.name for one in evidence.problem.relations)
    refuted(evidence, claim, names)
    equal(claim, False)


def conflict(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraints cannot all be met, and without any one of them the others can."""
    names = names_told(claim)
    owned = {name: evidence.owned(name, ("finite", "velocity", "inequality")) for name in names}
    refuted(evidence, claim["refutation"], [one for found in owned.values() for one in found])
    for name in names:
        others = [one for other in names if other != name for one in owned[other]]
        refuse(any(evidence.relation(one).kind == "inequality" for one in others), "an inequality conflicts by itself")
        if others:
            given = claim["minimal"][name]
            moves(evidence, {"rule": "point", "at": given} if isinstance(given, str) else given, others)


def _known(evidence: CheckedEvidence, names: Any, held: set[str]) -> None:
    for name in names:
        if name not in held or evidence.relation(name).leaf:
            raise CheckError(f"`{str(name)[:40]}` is not shown to follow everywhere")


def _weighted(evidence: CheckedEvidence, given: dict[str, str], held: set[str]) -> Tree:
    """A sum of equations times expressions that have a value everywhere."""
    _known(evidence, given, held)
    refuse(any(evidence.relation(name).kind == "inequality" for name in given), "an inequality is no equation")
    factors = {name: evidence.text(text) for name, text in given.items()}
    refuse(not all(has_value_everywhere(tree) for tree in factors.values()), "a cofactor has no value everywhere")
    return add(*(times(factor, evidence.relation(name).left) for name, factor in factors.items()))


def _positive(evidence: CheckedEvidence, tree: Tree) -> bool:
    if tree.head in ("product", "power") and symbols_in(tree):
        return all(_positive(evidence, part) for part in tree.below[: 1 if tree.head == "power" else None])
    if tree.head == "symbol":
        return evidence.problem.parameters.get(str(tree.value)) == "positive"
    return not symbols_in(tree) and bool(evaluated(tree, {}, evidence.effort) > 0)


def _combination(evidence: CheckedEvidence, given: Told, held: set[str]) -> None:
    """A positive number plus squares plus multiples of what is 0 cannot be 0 (Krivine 1964, Stengle 1974)."""
    constant, squares = evidence.text(given["number"]), evidence.squares(given.get("sos", []))
    sided = [(name, evidence.squares(terms)) for name, terms in given.get("inequality", {}).items()]
    _known(evidence, [name for name, _ in sided], held)
    refuse(sided and (given.get("c") or len(sided) > 1), "an inequality is refuted by itself")
    refuse(any(evidence.relation(name).kind != "inequality" for name, _ in sided), "no inequality")
    refuse(not _positive(evidence, constant), "the number that is left over is not positive")
    if any(not has_value_everywhere(tree) for tree in (squares, *(square for _, square in sided))):
        raise CheckError("a square has no value everywhere")
    total = add(constant, squares, _weighted(evidence, given.get("c", {}), held))
    total = add(total, *(times(square, evidence.relation(name).left) for name, square in sided))
    evidence.identity(substituted(total, {"tdot": ONE}), "what is left over")


def _polygon(evidence: CheckedEvidence, given: Told, held: set[str]) -> None:
    """A side is no longer than the way round by the others."""
    way = [_segment(evidence, one, held) for one in given["way"]]
    vector, length = _segment(evidence, given["side"], held)
    for i, part in enumerate(vector):
        total = add(*(other[i] for other, _ in way))
        evidence.identity(add(part, negative(total)), "the side as the sum of the way")
    if any(len(other) != len(vector) for other, _ in way) or not length > sum((size for _, size in way), arb(0)):
        raise CheckError("the side is not shown to be longer than the way")


def _segment(evidence: CheckedEvidence, given: Any, held: set[str]) -> tuple[list[Tree], Any]:
    """A relation that is, up to a number, vector^2 - length^2."""
    name, vector, text, *scale = given
    _known(evidence, [name], held)
    parts, length = [evidence.text(part) for part in vector], evidence.text(text)
    squares = add(*(times(part, part) for part in parts), negative(times(length, length)))
    refuse(evidence.relation(name).kind != "finite", "a side is a finite relation")
    factor = evidence.text(scale[0]) if scale else ONE
    evidence.number_sign(scale[0] if scale else "1")
    refuse(not all(has_value_everywhere(part) for part in parts), "a side has no value everywhere")
    evidence.identity(add(evidence.relation(name).left, negative(times(factor, squares))), f"the length of `{name}`")
    return parts, abs(evaluated(length, {}, evidence.effort))


def _boxes(evidence: CheckedEvidence, given: Told, held: set[str]) -> None:
    """Boxes that cover all configurations that could be, each excluded by a sum of equations (Moore 1966)."""
    start: dict[str, tuple[Fraction, Fraction]] = {}
    for name, half in given["variables"].items():
        if half == "angle":
            start[name] = (Fraction(-4), Fraction(4))
            continue
        bound, size = given["bounds"][name], evidence.ring.rational(evidence.text(half))
        if size is None or size <= 0:
            raise CheckError("the half of a box is a positive rational number")
        squares = evidence.squares(bound.get("sos", []))
        refuse(not has_value_everywhere(squares), "a square has no value everywhere")
        over = add(number(size * size), negative(times(symbol(name), symbol(name))))
        total = add(_weighted(evidence, bound["c"], held), squares)
        evidence.identity(add(over, negative(total)), f"the bound of `{name}`")
        start[name] = (-size, size)
    angles = [name for name, half in given["variables"].items() if half == "angle"]
    cuts: dict[str, Tree] = {}
    stack = [(given["tree"], start)]
    for _ in range(MOST_BOXES):
        if not stack:
            return
        node, box = stack.pop()
        if node[0] == "cut":
            key = repr(sorted(node[1].items()))
            if key not in cuts:
                cuts[key] = _cut(evidence, node[1], held, set(start), angles)
            _excluded(evidence, cuts[key], box)
            continue
        name, at, left, right = node
        middle, (low, high) = evidence.ring.rational(evidence.text(at)), box[name]
        if middle is None or not low < middle < high:
            raise CheckError("a box is cut inside it")
        stack += [(left, {**box, name: (low, middle)}), (right, {**box, name: (middle, high)})]
    raise CheckError("too many boxes")


def _cut(evidence: CheckedEvidence, given: Any, held: set[str], known: set[str], angles: list[str]) -> Tree:
    """A sum of equations that mentions the variables only, with the period of every angle."""
    total = _weighted(evidence, given, held)
    refuse(not symbols_in(total) <= known, "an equation holds what has no bounds")
    turn = times(number(2), Tree("pi"))
    for angle in angles:
        for name in given:
            left = evidence.relation(name).left
            turned = substituted(left, {angle: add(symbol(angle), turn)})
            evidence.identity(add(turned, negative(left)), f"the period of `{angle}`")
    return total


def _excluded(evidence: CheckedEvidence, tree: Tree, box: dict[str, tuple[Fraction, Fraction]]) -> None:
    """0 is not among the values in a box: directly, or by the mean value form."""
    balls = {name: ball_of(low).union(ball_of(high)) for name, (low, high) in box.items()}
    if excludes_zero(evaluated(tree, balls, evidence.effort)):
        return
    middles = {name: ball_of((low + high) / 2) for name, (low, high) in box.items()}
    value = evaluated(tree, middles, evidence.effort)
    for name in sorted(symbols_in(tree)):
        slope = evaluated(derivative(tree, name), balls, evidence.effort)
        value = value + slope * (balls[name] - middles[name])
    refuse(not excludes_zero(value), "a box is not excluded")
