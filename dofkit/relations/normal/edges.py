"""Where what a relation was divided by vanishes: there its branches say nothing, and it says something of its own.

z exp(xdot) = y is xdot = log(y/z) where z is not 0; at z = 0 it says y = 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import replace_nodes, substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.half_lines import SidedLines
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.notes import QUADRATIC_NOTE, RATE_NOTE
from dofkit.relations.normal.polynomial_zeros import Conjunction
from dofkit.relations.normal.quadratics import split_power, split_quadratic
from dofkit.relations.normal.signs import up_to_a_number
from dofkit.relations.normal.velocity_roots import rates, velocity_branches
from dofkit.relations.normal.zero_set import zero_set

#: Edges of one relation that are looked at.
MAX_EDGES = 6


def lines_of(e: Expr, positive: frozenset[Expr]) -> tuple[Sequence[SidedLines] | None, str]:
    """The lines that an irreducible relation between velocities splits into, and how; None where that was not seen.

    Each is told not to be where it has a pole and ``e`` has none.
    """
    split = split_quadratic(e, rates(e), positive)
    split = split_power(e, positive) if split is None else split
    if split is not None:
        return _within_edges(e, split, positive), QUADRATIC_NOTE
    found = velocity_branches(e, positive)
    if found is None:
        return None, ""
    lines = [SidedLines((relation,), conditions) for relation, conditions in found]
    return _within_edges(e, lines, positive), RATE_NOTE


def _within_edges(e: Expr, lines: Sequence[SidedLines], positive: frozenset[Expr]) -> list[SidedLines]:
    own = {up_to_a_number(c.expr) for c in conditions_of(e, positive) if c.sense == "!="}
    found = []
    for one in lines:
        shown = [*one.relations, *(c.expr for c in one.conditions)]
        known = own | {up_to_a_number(c.expr) for c in one.conditions if c.sense == "!="}
        poles = dict.fromkeys(c.expr for u in shown for c in conditions_of(u, positive) if c.sense == "!=")
        new = [p for p in poles if _moving(p) and not rates(p) and up_to_a_number(p) not in known]
        found.append(SidedLines(one.relations, (*one.conditions, *(DomainCondition(p, "!=", True) for p in new))))
    return found


def edges_of(lines: Iterable[SidedLines], positive: frozenset[Expr]) -> list[Conjunction] | None:
    """What vanishes together at the edges of some lines, less what vanishes nowhere; None where there are many."""
    every = (c.expr for one in lines for c in one.conditions if c.sense == "!=" and c.adjoining)
    zeros = [zero for edge in dict.fromkeys(every) for zero in zero_set(edge, positive, _moving(edge))[0]]
    found = [zero for zero in dict.fromkeys(zeros) if not no_solution(zero, positive)]
    return found if len(found) <= MAX_EDGES else None


def at_edge(e: Expr, zero: Conjunction) -> Expr | None:
    """``e`` where some finite expressions vanish, written so that they do; None where it has no value there."""
    try:
        there = substitute(e, given_by(zero))
        if there == e:
            there = replace_nodes(e, {g: ex.ZERO for g in zero if g.op != "sym"})
    except NoValueError:
        return None
    return _remainder(e, zero) if there == e else there


def _remainder(e: Expr, zero: Conjunction) -> Expr:
    """What is left of a polynomial over those that vanish; ``e`` where that is nothing else."""
    ring = Ring([e, *zero])
    nodes = [ring.node(u) for u in (e, *zero)]
    try:
        canon = Canon(ring)
        whole, *others = (canon.quotient(node)[0] for node in nodes)
        left = whole
        for other in others:
            left = canon.reduce(divmod(left, other)[1])
        return e if left == whole else canon.to_expr(left)
    except NoValueError:
        return e


def given_by(relations: Iterable[Expr]) -> Mapping[Expr, Expr]:
    """Coordinates that relations, which vanish, give as functions of others, each free of those solved for."""
    found: dict[Expr, Expr] = {}
    for g in relations:
        own = substitute(g, found)
        pivot = next(_pivots(own), None)
        if pivot is not None:
            s, value = pivot
            found = {k: substitute(v, {s: value}) for k, v in found.items()} | {s: value}
    return found


def _pivots(g: Expr) -> Iterator[tuple[Expr, Expr]]:
    """The coordinates that stand in a relation once, with a number before them, and what they are."""
    terms = linear_terms(g)
    for s, c in terms.items():
        if s.op == "sym" and s.args[0] == "coordinate" and not any(s in u.symbols for u in terms if u != s):
            rest = ex.add(*(ex.mul(ex.num(-k / c), u) for u, k in terms.items() if u != s))
            yield s, rest


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] in ("coordinate", "time"))
