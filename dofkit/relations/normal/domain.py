"""Where an expression has a value: what its roots, logarithms, inverse functions and denominators ask for.

A relation that is rewritten (a factor dropped, a square root squared) is the old one only where these conditions hold.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Canon, lowest_terms
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.domains import DomainSense, of_function, of_power
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes


@dataclass(frozen=True)
class DomainCondition:
    """``expr`` >= 0, > 0 or != 0: no relation, but a part of the space outside of which the relation says nothing.

    ``adjoining``: > 0 or != 0, and where it is 0 the branch goes on into another, which says what holds there.
    """

    expr: Expr
    sense: DomainSense
    adjoining: bool = False

    @property
    def strict(self) -> bool:
        """Is it > 0?"""
        return self.sense == ">"


def conditions_of(e: Expr, positive: frozenset[Expr]) -> tuple[DomainCondition, ...]:
    """Where ``e`` has a real value, less what always holds; a denominator counts in lowest terms."""
    found = list(dict.fromkeys(_inside(e, outermost=True)))
    below = _denominator(e, positive)
    if below is not None:
        found.append(DomainCondition(below, "!="))
    return tuple(c for c in dict.fromkeys(found) if not _always(c, positive))


def _inside(e: Expr, outermost: bool) -> Iterator[DomainCondition]:
    """The conditions of all nodes; quotients of sums and products on the outside are left to `_denominator`."""
    rational = e.op in ("add", "mul") or (
        e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1
    )
    if not (rational and outermost):
        yield from _own(e, outermost)
    for part in ex.children(e):
        yield from _inside(part, outermost and rational)


def _own(e: Expr, outermost: bool) -> Iterator[DomainCondition]:
    if e.op == "pow":
        yield from (DomainCondition(*required) for required in of_power(*e.args))
    elif e.op == "fn" and not (outermost and e.args[0] in ("tan", "sec", "cot", "csc")):
        yield from (DomainCondition(*required) for required in of_function(*e.args))


def _denominator(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """What is left below when all is one quotient in lowest terms."""
    try:
        ring = Ring([e], positive)
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        _, bottom = lowest_terms(top, bottom)
        return None if bottom.is_constant() else canon.to_expr(bottom)
    except NoValueError:
        return None


def _always(c: DomainCondition, positive: frozenset[Expr]) -> bool:
    """Is a condition proved to hold wherever its expression has a value?"""
    if c.sense == "!=":
        return never_vanishes(c.expr, positive)
    return never_holds(-c.expr, c.sense == ">=", positive)


def holds_at(c: DomainCondition, known: Mapping[Expr, Expr], positive: frozenset[Expr]) -> bool | None:
    """Does a condition hold at a configuration? None where its sign there is not known."""
    try:
        sign = _sign(substitute(c.expr, known), positive)
    except NoValueError:
        return False
    if sign is None:
        return None
    if sign == 0:
        return c.adjoining or c.sense == ">="
    return sign > 0 or c.sense == "!="


def has_value(c: DomainCondition, known: Mapping[Expr, Expr], positive: frozenset[Expr]) -> bool:
    """Has what is asked for a value at a configuration? A pole has none."""
    try:
        _sign(substitute(c.expr, known), positive)
    except NoValueError:
        return False
    return True


def _sign(e: Expr, positive: frozenset[Expr]) -> int | None:
    """The sign of a constant, for generic parameters that of some values of them."""
    ring = Ring([e], positive)
    node = ring.node(e)
    point = BallPoint(RealSearch(ring, (), (), positive).start(0, {}), 0)
    value = values(ring, point)[node]
    if not value.contains(0):
        return 1 if value > 0 else -1
    return 0 if is_proved_zero(e, positive) else None
