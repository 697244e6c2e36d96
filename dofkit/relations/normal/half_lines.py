"""Relations between velocities that keep to one side: sqrt(xdot^2 + ydot^2) = xdot says ydot = 0 where xdot >= 0.

A square root is squared away, an inverse function undone, and th = atan2(ydot, xdot) is xdot sin th = ydot cos th where
xdot cos th + ydot sin th > 0. What is left is the relation as written where the conditions hold, velocities in them
included. Of several pieces none goes on into another but at rest, so that a motion keeps to the lines of one of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.zero.identity import is_proved_zero, is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition, conditions_of, constantly
from dofkit.relations.normal.inverse_functions import inverse_of
from dofkit.relations.normal.signs import squared
from dofkit.relations.normal.velocity_roots import rates

#: What a function is replaced by; no scene declares such a name.
_VALUE = ex.sym("parameter", "the function's value")
UNDONE_NOTE = "the root or function of the velocities was inverted"
INEQUALITY_NOTE = "it is satisfied exactly where the argument of abs() has one sign: it states no more than that"
ONE_SIDE_NOTE = (
    "the velocities are also restricted to one side, as by an inequality, which does not reduce the number of degrees "
    "of freedom"
)
PIECES_NOTE = (
    "the velocities lie on one of several pieces, and change from one to another at rest only: the numbers are those "
    "of a motion on one piece"
)


class SidedRelation(NamedTuple):
    """``expr`` = 0 where the conditions hold."""

    expr: Expr
    conditions: tuple[DomainCondition, ...]


class SidedLines(NamedTuple):
    """Forms in the velocities that vanish together where the conditions hold; some may be finite."""

    relations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]


def rewritten(e: Expr, positive: frozenset[Expr]) -> list[SidedRelation] | None:
    """``e = 0`` without its square root, angle or inverse function that holds velocities: one of these holds.

    None where there is none, or not one alone.
    """
    found = _without_root(e, positive)
    if found is None:
        found = _without_function(e, positive)
    return found


def _without_root(e: Expr, positive: frozenset[Expr]) -> list[SidedRelation] | None:
    found = squared(e, positive)
    if found is None or not rates(found[0]):
        return None
    return [SidedRelation(found[0], (found[1], *conditions_of(e, positive)))]


def _without_function(e: Expr, positive: frozenset[Expr]) -> list[SidedRelation] | None:
    """a f(u) + b = 0 with numbers a and b free of velocities, for the one function f that holds all of these."""
    inner = _function_around(e)
    if inner is None:
        return None
    outside = _replaced(e, inner, _VALUE)
    slope = diff(outside, _VALUE)
    if rates(outside) or slope.op != "num" or slope.is_zero:
        return None
    value = -substitute(outside, {_VALUE: ex.ZERO}) / slope
    within = tuple(c for u in (value, *inner.args[1:]) for c in conditions_of(u, positive))
    if inner.args[0] == "atan2":
        return [_along(value, inner.args[1], inner.args[2], within)]
    roots = inverse_of(inner.args[0], value)
    return None if roots is None else [SidedRelation(inner.args[1] - r.value, (*r.conditions, *within)) for r in roots]


def _along(angle: Expr, y: Expr, x: Expr, within: tuple[DomainCondition, ...]) -> SidedRelation:
    """atan2(y, x) = angle."""
    sin, cos = ex.fn("sin", angle), ex.fn("cos", angle)
    ahead = DomainCondition(x * cos + y * sin, ">")
    turn = DomainCondition(angle + ex.PI, ">"), DomainCondition(ex.PI - angle, ">=")
    return SidedRelation(y * cos - x * sin, (ahead, *turn, *within))


def _function_around(e: Expr) -> Expr | None:
    """The outermost function that every velocity is in."""
    found: list[Expr] = []

    def look(node: Expr) -> None:
        if rates(node):
            if node.op == "fn" or node.args[0] == "velocity":
                found.append(node)
            else:
                for part in ex.children(node):
                    look(part)

    look(e)
    different = set(found)
    only = different.pop() if len(different) == 1 else None
    return only if only is not None and only.op == "fn" else None


def _replaced(e: Expr, inner: Expr, by: Expr) -> Expr:
    if e == inner:
        return by
    parts = ex.children(e)
    return ex.rebuild(e, tuple(_replaced(part, inner, by) for part in parts)) if parts else e


# -- the pieces --------------------------------------------------------------------------------------


def settled(lines: Sequence[SidedLines], positive: frozenset[Expr]) -> list[SidedLines]:
    """The lines with conditions in the velocities that are left free, without those that hold nowhere or twice.

    Conditions that hold always go; u >= 0 and -u >= 0 together are the form u.
    """
    found: dict[object, SidedLines] = {}
    for one in lines:
        told = _settled(one, positive)
        if told is not None:
            found.setdefault((frozenset(told.relations), frozenset(told.conditions)), told)
    return list(found.values())


def _settled(one: SidedLines, positive: frozenset[Expr]) -> SidedLines | None:
    relations = list(one.relations)
    conditions = [replace(c, expr=scaled(freed(c.expr, relations))) for c in one.conditions]
    kept: list[DomainCondition] = []
    for c in dict.fromkeys(conditions):
        told = _known(c, positive)
        if told is False:
            return None
        pair = next((k for k in kept if c.sense == k.sense == ">=" and not linear_terms(c.expr + k.expr)), None)
        if pair is not None:
            kept.remove(pair)
            more = SidedLines((*relations, c.expr), tuple(k for k in conditions if k not in (pair, c)))
            return _settled(more, positive)
        if told is None:
            kept.append(c)
    return SidedLines(_canonical(relations), tuple(kept))


def lies_within(one: SidedLines, region: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Do the conditions of a region hold on lines that are settled?"""
    asked = [replace(c, expr=scaled(freed(c.expr, one.relations))) for c in region]
    return all(c in one.conditions or _known(c, positive) for c in asked)


def scaled(e: Expr) -> Expr:
    """``e`` times a number > 0, the same for multiples of each other."""
    terms = linear_terms(e)
    first = abs(terms[min(terms, key=repr)]) if terms else Fraction(1)
    return e if first == 1 else e / ex.num(first)


def _canonical(relations: Sequence[Expr]) -> tuple[Expr, ...]:
    """Forms with numbers as coefficients solved for velocities, a single one with a first coefficient above 0."""
    if len(relations) == 1:
        first = diff(relations[0], rates(relations[0])[0]) if rates(relations[0]) else ex.ONE
        return (-relations[0] if first.op == "num" and first.args[0] < 0 else relations[0],)
    found = solved(relations)
    if len(found) < len(relations):
        return tuple(relations)
    return tuple(v - found[v] for v in sorted(found, key=repr))


def _known(c: DomainCondition, positive: frozenset[Expr]) -> bool | None:
    """Does a condition hold always (True), or never? Among numbers, and where it is 0 identically."""
    if c.expr.symbols and is_proved_zero(c.expr, positive):
        return c.sense == ">="
    return constantly(c, positive)


def freed(e: Expr, relations: Iterable[Expr]) -> Expr:
    """``e`` with the velocities put in that forms with a number as coefficient give."""
    for v, value in solved(relations).items():
        e = substitute(e, {v: value})
    return e


def solved(relations: Iterable[Expr], generic: bool = False) -> Mapping[Expr, Expr]:
    """Velocities as functions of others, each free of those solved for before it.

    By a number as coefficient, or by one that is not 0 everywhere where ``generic``.
    """
    found: dict[Expr, Expr] = {}
    for relation in relations:
        own = substitute(relation, found)
        slopes = [(v, diff(own, v)) for v in rates(own)]
        pivot = next(((v, c) for v, c in slopes if c.op == "num" and not c.is_zero), None)
        if pivot is None and generic:
            pivot = next(((v, c) for v, c in slopes if not rates(c) and not is_zero(c, frozenset())), None)
        if pivot is not None:
            v, slope = pivot
            value = -substitute(own, {v: ex.ZERO}) / slope
            found = {k: substitute(e, {v: value}) for k, e in found.items()}
            found[v] = value
    return found


def meet_at_rest(lines: Sequence[SidedLines], velocities: Sequence[Expr]) -> bool:
    """Is each of several pieces bounded by the state at rest alone?

    Its forms and the one form that is to be >= 0 are as many, and independent, as there are velocities; what is to be
    > 0 does not reach its end.
    """
    return all(_is_half_line(one, velocities) for one in lines)


def _is_half_line(one: SidedLines, velocities: Sequence[Expr]) -> bool:
    sided = [c for c in one.conditions if rates(c.expr)]
    edges = [c.expr for c in sided if c.sense == ">="]
    forms = [r for r in one.relations if rates(r)]
    rest = dict.fromkeys(velocities, ex.ZERO)
    if len(edges) > 1 or any(not substitute(e, rest).is_zero for e in (*forms, *edges)):
        return False
    return (not edges and bool(sided)) or len(solved((*forms, *edges), generic=True)) == len(velocities)
