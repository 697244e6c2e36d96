"""What a state of motion has to satisfy for the inequalities to hold: relations, conditions, and what moves.

Where nothing depends on time and every relation between velocities allows rest, a configuration at rest is a motion,
and only the finite relations count. Else a motion passes through a state (q, v) at the time t at which the rows that
are linear in v by their differentials are independent: there v is a smooth function of (q, t) and free numbers
[ImplicitFunctions], and what holds strictly there holds for a while.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import combinations

from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import has_call
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row
from dofkit.relations.linear import presolve
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.velocity_reductions import form_rate, rate


@dataclass(frozen=True)
class StateProblem:
    """``equations`` = 0 and ``conditions`` in ``places``, ``rates`` (velocities), time and parameters.

    ``moving``: those of the equations that are to be independent by the rates, where there are rates; else all are to
    be so by the places. ``still``: a configuration at rest is asked for. ``fixed``: values of time and parameters;
    those without one may have any. ``drawn_only``: of points only the drawn one is meant by all relations.
    """

    equations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]
    places: tuple[Expr, ...]
    rates: tuple[Expr, ...] = ()
    moving: tuple[Expr, ...] = ()
    still: bool = False
    fixed: Mapping[Expr, Fraction] = field(default_factory=dict)
    drawn_only: bool = False

    @cached_property
    def symbols(self) -> frozenset[Expr]:
        """All that occurs."""
        return frozenset[Expr]().union(*(e.symbols for e in self.expressions))

    @property
    def expressions(self) -> list[Expr]:
        """All equations, then what the conditions are about."""
        return [*self.equations, *(c.expr for c in self.conditions)]

    @property
    def constants(self) -> list[Expr]:
        """Time and the parameters that occur."""
        return sorted((s for s in self.symbols if s.args[0] in ("parameter", "time")), key=repr)

    @property
    def unknowns(self) -> list[Expr]:
        """Places, rates, and what may have any value."""
        return [*self.places, *self.rates, *(s for s in self.constants if s not in self.fixed)]

    @property
    def independent(self) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        """(rows, symbols by which they are to be independent, so that a motion passes through a point)."""
        return (self.moving, self.rates) if self.rates else (self.equations, self.places)

    @property
    def rigidly(self) -> bool:
        """Will any one point do? Nothing varies but places, and they rest."""
        return self.still and not self.constants

    @property
    def unknown_functions(self) -> bool:
        """Does an unknown function occur?"""
        return any(map(has_call, self.expressions))


def problems_of(
    rows: Sequence[Row], conditions: Sequence[DomainCondition], names: Sequence[str]
) -> Iterator[StateProblem]:
    """At rest, where that is a motion, and then in motion, where the rows or the conditions hold velocities."""
    finite = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    others = [form_rate(r.piece) for r in rows if isinstance(r.piece, Pfaffian)]
    others += [r.piece.expr for r in rows if isinstance(r.piece, Nonlinear)]
    boundaries, conditions = _boundaries(conditions)
    finite += [e for e in boundaries if not velocities_of(e)]
    others += [e for e in boundaries if velocities_of(e)]
    places = tuple(ex.coordinate(name) for name in names)
    rest = {ex.velocity(name): ex.ZERO for name in names}
    asked = [*finite, *others, *(c.expr for c in conditions)]
    finite = _independent(finite)
    timed = any(ex.TIME in e.symbols for e in asked)
    if not timed and all(zero_and_verdict(substitute(e, rest), frozenset()) == (True, "proved") for e in others):
        still = tuple(DomainCondition(substitute(c.expr, rest), c.sense) for c in conditions)
        yield StateProblem(tuple(finite), still, places, still=True)
    elif not others and not any(map(velocities_of, asked)):
        yield StateProblem(tuple(finite), conditions, places)
    if any(map(velocities_of, asked)) and (timed or others or any(velocities_of(c.expr) for c in conditions)):
        moving = (*(rate(g) for g in finite), *others)
        yield StateProblem((*finite, *moving), conditions, places, tuple(rest), moving)


def _boundaries(conditions: Sequence[DomainCondition]) -> tuple[list[Expr], tuple[DomainCondition, ...]]:
    """(what e >= 0 and -e >= 0 make 0, the other conditions)."""
    closed = [c for c in conditions if c.sense == ">="]
    pairs = [(a, b) for a, b in combinations(closed, 2) if not linear_terms(a.expr + b.expr)]
    gone = {id(c) for pair in pairs for c in pair}
    return [a.expr for a, _ in pairs], tuple(c for c in conditions if id(c) not in gone)


def _independent(finite: Sequence[Expr]) -> list[Expr]:
    """The equations without those that linear ones before them imply."""
    superfluous = presolve(finite).superfluous
    return [e for i, e in enumerate(finite) if i not in superfluous]
