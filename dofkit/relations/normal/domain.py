"""Conditions under which an expression has a value, from its roots, logarithms, inverse functions and denominators.

A rewritten relation (a factor dropped, a root squared) is equivalent to the original where these are satisfied.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product as cartesian

from dofkit.exact.points.balls import random_ball_point
from dofkit.exact.ring.canonical import lowest_terms, quotients_of, square_root
from dofkit.exact.ring.program import false_without_value, none_without_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import linear_terms, substitute
from dofkit.expressions.real_values import DomainSense, of_function, of_power
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes


@dataclass(frozen=True)
class DomainCondition:
    """``expr`` >= 0, > 0 or != 0: the region in which a relation has a value; outside it is not satisfied."""

    expr: Expr
    sense: DomainSense

    @property
    def strict(self) -> bool:
        """Whether the sense is > 0."""
        return self.sense == ">"


def conditions_of(e: Expr, positive: frozenset[Expr]) -> tuple[DomainCondition, ...]:
    """Return the conditions for a real value of ``e`` that can fail; a quotient is put in lowest terms first."""
    result = list(dict.fromkeys(_conditions_of_nodes(e, in_no_function=True)))
    below = _denominator(e, positive)
    if below is not None:
        result.append(DomainCondition(below, "!="))
    return tuple(c for c in dict.fromkeys(result) if not is_always_satisfied(c, positive))


def _conditions_of_nodes(e: Expr, in_no_function: bool) -> Iterator[DomainCondition]:
    """Yield the conditions of all nodes, except those of quotients outside functions and roots (see `_denominator`)."""
    rational = e.op in ("add", "mul") or (
        e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1
    )
    if not (rational and in_no_function):
        yield from _required_by(e, in_no_function)
    for part in ex.children(e):
        yield from _conditions_of_nodes(part, in_no_function and rational)


def _required_by(e: Expr, in_no_function: bool) -> Iterator[DomainCondition]:
    if e.op == "pow":
        yield from (DomainCondition(*required) for required in of_power(*e.args))
    elif e.op == "fn" and not (in_no_function and e.args[0] in ("tan", "sec", "cot", "csc")):
        yield from (DomainCondition(*required) for required in of_function(*e.args))


@none_without_value
def _denominator(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return the denominator of ``e`` as one quotient in lowest terms; None if it is constant or too large."""
    canon, [quotient] = quotients_of([e], positive)
    _, bottom = lowest_terms(*quotient)
    return None if bottom.is_constant() else canon.to_expr(bottom)


def is_always_satisfied(c: DomainCondition, positive: frozenset[Expr]) -> bool:
    """Return whether a condition is proved to be satisfied wherever its expression has a value."""
    if c.sense == "!=":
        return never_vanishes(c.expr, positive)
    return never_holds(-c.expr, c.sense == ">=", positive)


@false_without_value
def is_satisfied_at(
    c: DomainCondition, configuration: Mapping[Expr, Expr], positive: frozenset[Expr], strictly: bool = False
) -> bool | None:
    """Return whether a condition is satisfied at a configuration (``strictly``: >= as >); None if not known."""
    sign = _sign(substitute(c.expr, configuration), positive)
    if sign is None:
        return None
    if sign == 0:
        return c.sense == ">=" and not strictly
    return sign > 0 or c.sense == "!="


def _sign(e: Expr, positive: frozenset[Expr]) -> int | None:
    """Return the sign of an expression without coordinates; with parameters, its sign at one random choice of them."""
    ring = Ring([e], positive)
    node = ring.node(e)
    point = random_ball_point(ring, positive, 0)
    value = values(ring, point)[node]
    if not value.contains(0):
        return 1 if value > 0 else -1
    return 0 if is_proved_zero(e, positive) else None


#: Bound on the number of arguments whose signs are distinguished.
MAX_ARGUMENTS = 4


def arguments_of(e: Expr) -> list[Expr]:
    """Return the arguments u of absolute values abs(u) and of roots of squares sqrt(u^2) in ``e``."""
    if e.functions.isdisjoint(("abs", "pow")):
        return []
    every = list(ex.nodes(e))
    result = [node.args[1] for node in every if node.op == "fn" and node.args[0] == "abs"]
    result += [node.args[0].args[0] for node in every if _root_of_square(node)]
    return list(dict.fromkeys(result))


def with_absolute_values(e: Expr, positive: frozenset[Expr]) -> Expr:
    """Return ``e`` with roots of expanded squares as absolute values: sqrt(x^2 + 2 x y + y^2) becomes abs(x + y)."""
    if "pow" not in e.functions or not any(_root_of_sum(node) for node in ex.nodes(e)):
        return e

    def with_absolute_values(node: Expr) -> Expr:
        operands = ex.children(node)
        base = square_root(node.args[0], positive) if _root_of_sum(node) else None
        if base is not None:
            return ex.power(ex.fn("abs", base), ex.num(2 * node.args[1].args[0]))
        return ex.rebuild(node, tuple(map(with_absolute_values, operands))) if operands else node

    return with_absolute_values(e)


def _root_of_sum(node: Expr) -> bool:
    return node.op == "pow" and node.args[0].op == "add" and _is_half(node.args[1])


def _is_half(exponent: Expr) -> bool:
    return exponent.op == "num" and exponent.args[0].denominator == 2


def holds_on_a_region(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether ``e`` is identically 0 for some signs in its absolute values (x + abs(x) for x <= 0)."""
    arguments = arguments_of(e)
    if not arguments or len(arguments) > MAX_ARGUMENTS:
        return False
    return any(is_proved_zero(signed, positive) for signed, _ in by_signs(e, arguments, positive))


def by_signs(
    e: Expr, arguments: Sequence[Expr], positive: frozenset[Expr]
) -> Iterator[tuple[Expr, tuple[DomainCondition, ...]]]:
    """Yield (``e`` without absolute values, conditions) for every choice of the arguments' signs that is possible."""
    for signs in cartesian((1, -1), repeat=len(arguments)):
        mapping = dict(zip(arguments, signs, strict=True))
        plain = {u: with_signs(u, mapping) * s for u, s in mapping.items()}
        if not any(never_holds(u, True, positive) for u in plain.values()):
            yield with_signs(e, mapping), tuple(DomainCondition(u, ">=") for u in plain.values())


def up_to_a_number(e: Expr) -> frozenset[tuple[Expr, Fraction]]:
    """Return a key that is equal for expressions that are multiples of each other by a number."""
    terms = linear_terms(e)
    first = terms[min(terms, key=hash)] if terms else 1
    return frozenset((s, c / first) for s, c in terms.items())


@none_without_value
def squared(e: Expr, positive: frozenset[Expr]) -> tuple[Expr, DomainCondition] | None:
    """Return (a^2 u - b^2, the condition -a b >= 0) for ``e`` = a sqrt(u) + b; None if ``e`` is not so."""
    canon, [(top, _)] = quotients_of([e], positive)
    ring = canon.ring
    roots = [v for v in ring.vars if v.kind == "root" and ring.var_expr[v.index].symbols]
    if len(roots) != 1 or roots[0].degree != 2:
        return None
    index = roots[0].index
    if any(ring.var_expr[index] in ex.nodes(ring.var_expr[v.index]) for v in ring.vars if v.index != index):
        return None
    coefficients = canon.collected(top, {index})
    a, b = coefficients.pop(((index, 1),), None), coefficients.pop((), None)
    if a is None or b is None or coefficients:
        return None
    u, below = canon.quotient(roots[0].args[0])
    norm, sided = canon.reduce(a * a * u - b * b * below), canon.reduce(-a * b)
    return canon.regular_expr(norm, norm), DomainCondition(canon.regular_expr(sided, canon.unit), ">=")


def _root_of_square(node: Expr) -> bool:
    """Return whether a node is u^2 to the power k/2, k odd, as sqrt(u^2) is."""
    if node.op != "pow" or not _is_half(node.args[1]):
        return False
    inner = node.args[0]
    return bool(inner.op == "pow" and inner.args[1].op == "num" and inner.args[1].args[0] == 2)


def with_signs(e: Expr, signs: Mapping[Expr, int]) -> Expr:
    """Return ``e`` with abs(u) and sqrt(u^2) replaced by u times its sign, for the u in ``signs``."""
    if e.op == "fn" and e.args[0] == "abs" and e.args[1] in signs:
        return with_signs(e.args[1], signs) * signs[e.args[1]]
    if _root_of_square(e) and e.args[0].args[0] in signs:
        inner = e.args[0].args[0]
        return ex.power(with_signs(inner, signs) * signs[inner], ex.num(2 * e.args[1].args[0]))
    operands = ex.children(e)
    return ex.rebuild(e, tuple(with_signs(part, signs) for part in operands)) if operands else e
