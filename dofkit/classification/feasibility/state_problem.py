"""The conditions on a state of motion that satisfies inequalities (`StateProblem`), and certified solutions.

If nothing depends on time and every relation between velocities allows rest, a configuration at rest is a motion, and
only the geometric equations count. Otherwise a motion passes through a state (q, v) at time t if the derivatives of the
relations by v are independent there: v is then a smooth function of (q, t) and free numbers [ImplicitFunctions], and
inequalities that are satisfied strictly stay so for a while.

A state is searched with slack variables: an inequality e >= 0 becomes the equation e = s^2 with one more unknown, and a
zero is certified by the interval Newton test [KrawczykNewton].
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from itertools import product as cartesian
from math import prod

from flint import arb

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.classification.freedom.common_point import hold_strictly, without_satisfied
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import components
from dofkit.exact.points.balls import RealPoint, jacobian
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import linear_terms, substitute
from dofkit.expressions.enclosures import has_call, interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import coordinates_of
from dofkit.relations.linear_relations import solve_linear
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Pfaffian, Piece, Reduced
from dofkit.relations.normal.sign_claims import SignClaim
from dofkit.relations.velocity_reductions import rate

#: Bound on the choices of branches.
MAX_CHOICES = 16
#: Numbers of searches, of starts of each, and of steps of each start; bound on the equations and conditions.
SEARCHES, STARTS, STEPS, MAX_ROWS = 3, 6, 60, 80
#: Exact values, or balls, of symbols.
Values = Mapping[Expr, Expr | arb]


@dataclass(frozen=True)
class StateProblem:
    """``equations`` = 0 and ``conditions`` in ``places`` (coordinates), ``rates`` (velocities), time and parameters.

    ``moving``: the equations whose derivatives by the rates must be independent; without rates all equations must be
    independent by the places. ``still``: the state is a configuration at rest.
    """

    equations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]
    places: tuple[Expr, ...]
    rates: tuple[Expr, ...] = ()
    moving: tuple[Expr, ...] = ()
    still: bool = False

    @property
    def expressions(self) -> list[Expr]:
        """The expressions of the equations, then of the conditions."""
        return [*self.equations, *(c.expr for c in self.conditions)]

    @property
    def constants(self) -> list[Expr]:
        """Time and parameters, as far as they occur."""
        symbols = frozenset[Expr]().union(*(e.symbols for e in self.expressions))
        return sorted((s for s in symbols if s.args[0] in ("parameter", "time")), key=repr)

    @property
    def claims(self) -> list[SignClaim]:
        """The equations and conditions as claims, without conditions != 0."""
        sided = [SignClaim(c.expr, ">" if c.sense == ">" else ">=") for c in self.conditions if c.sense != "!="]
        return [*(SignClaim(e, "=") for e in self.equations), *sided]


@dataclass(frozen=True)
class Part:
    """Constraints that are connected by coordinates, with their ``numbers``; one of them has an inequality."""

    numbers: tuple[int, ...]
    reduced: tuple[Reduced, ...]

    @property
    def inequalities(self) -> list[Inequality]:
        """The inequalities of all constraints."""
        return [q for r in self.reduced for q in r.inequalities]

    def choices(self) -> list[list[StateProblem]]:
        """Return, for every choice of branches, the problems one of which each state of a motion solves.

        An empty list if the choices are too many, or if differentials occur in an inequality.
        """
        normals = [n for r in self.reduced for n in r.normals]
        kinds = {s.args[0] for q in self.inequalities for s in q.expr.symbols}
        if prod(len(n.branches) for n in normals) > MAX_CHOICES or not kinds.isdisjoint({"differential", "dt"}):
            return []
        sides = [DomainCondition(q.expr, ">" if q.strict else ">=") for q in self.inequalities]
        sides += [c for r in self.reduced for c in r.domain(inequalities=True)]
        chosen = cartesian(*(n.branches for n in normals))
        return [_problems([p for branch in choice for p in branch], sides) for choice in chosen]


def parts_of(reduced: Sequence[Reduced], numbers: Sequence[int], shared: bool) -> list[Part]:
    """Return the parts with an inequality; with ``shared``, time and parameters connect constraints as well."""
    together = components(_mentioned(reduced[i], shared) for i in numbers)
    groups = [sorted(numbers[k] for k in group) for group in together]
    every = [Part(tuple(g), tuple(reduced[i] for i in g)) for g in groups]
    return sorted((p for p in every if p.inequalities), key=lambda p: p.numbers)


def _mentioned(r: Reduced, shared: bool) -> frozenset[str]:
    """Return the coordinates of a constraint, and if ``shared`` also its parameters and the time, as texts."""
    domain = r.domain(inequalities=True)
    pieces = [*(p for n in r.normals for branch in n.branches for p in branch), *r.inequalities, *domain]
    names = frozenset[str]().union(*map(coordinates_of, pieces))
    written = (*(q.expr for q in r.constraint.relations), *(c.expr for c in domain))
    constants = (s for e in written for s in e.symbols if s.args[0] in ("parameter", "time"))
    return names | frozenset(repr(s) for s in constants) if shared else names


def _problems(pieces: Sequence[Piece], sides: Sequence[DomainCondition]) -> list[StateProblem]:
    """Return the problem at rest, if that is a motion, then the one in motion, if velocities occur."""
    finite = [p.expr for p in pieces if isinstance(p, Finite)]
    others = [p.rate if isinstance(p, Pfaffian) else p.expr for p in pieces if isinstance(p, Pfaffian | Nonlinear)]
    boundaries, conditions = _boundaries([*(p for p in pieces if isinstance(p, DomainCondition)), *sides])
    names = sorted(frozenset[str]().union(*map(coordinates_of, (*pieces, *sides))))
    finite = _independent([*finite, *(e for e in boundaries if not velocities_of(e))])
    others += [e for e in boundaries if velocities_of(e)]
    conditions = without_satisfied(conditions, finite)
    places, rates = tuple(map(ex.coordinate, names)), tuple(map(ex.velocity, names))
    occurring = [*finite, *others, *(c.expr for c in conditions)]
    timed, moves = any(ex.TIME in e.symbols for e in occurring), any(map(velocities_of, occurring))
    still = None if timed else _at_rest(others, conditions, dict.fromkeys(rates, ex.ZERO))
    result = [] if still is None else [StateProblem(tuple(finite), still, places, still=True)]
    if moves:
        moving = (*map(rate, finite), *others)
        result.append(StateProblem((*finite, *moving), conditions, places, rates, moving))
    return result or [StateProblem(tuple(finite), conditions, places)]


def _at_rest(
    others: Sequence[Expr], conditions: Sequence[DomainCondition], no_velocity: Mapping[Expr, Expr]
) -> tuple[DomainCondition, ...] | None:
    """Return the conditions at velocities 0; None if the relations are not satisfied, or have no value, there."""
    try:
        if all(is_proved_zero(substitute(e, no_velocity), frozenset()) for e in others):
            resting = [DomainCondition(substitute(c.expr, no_velocity), c.sense) for c in conditions]
            return tuple(c for c in resting if c.sense != ">=" or not c.expr.is_zero)
    except NoValueError:
        pass
    return None


def _boundaries(conditions: Sequence[DomainCondition]) -> tuple[list[Expr], tuple[DomainCondition, ...]]:
    """Return (the e for which e >= 0 and -e >= 0 are both conditions, the other conditions)."""
    closed = [c for c in dict.fromkeys(conditions) if c.sense == ">="]
    pairs = [(a, b) for a, b in combinations(closed, 2) if not linear_terms(a.expr + b.expr)]
    paired = {c for pair in pairs for c in pair}
    return [a.expr for a, _ in pairs], tuple(c for c in dict.fromkeys(conditions) if c not in paired)


def _independent(finite: Sequence[Expr]) -> list[Expr]:
    """Return the equations without linear ones that other linear ones imply."""
    implied = solve_linear(finite).implied
    return [e for i, e in enumerate(finite) if i not in implied]


def certified_state(problem: StateProblem, positive: frozenset[Expr], fixed: bool) -> Values | None:
    """Return the values of all symbols at a certified solution through which a motion passes, or None.

    ``fixed``: time and parameters have given values, positive and the same wherever they occur.
    """
    if any(map(has_call, problem.expressions)) or len(problem.expressions) > MAX_ROWS:
        return None
    sided = [c.expr for c in problem.conditions if c.sense != "!="]
    slacks = [ex.coordinate(f"_slack {k}") for k in range(len(sided))]
    rows = [*problem.equations, *(e - s * s for e, s in zip(sided, slacks, strict=True))]
    ring = Ring([*rows, *problem.expressions], positive)
    free = [*problem.places, *problem.rates, *(() if fixed else problem.constants)]
    search = RealSearch(ring, [ring.node(e) for e in rows], [*free, *slacks], positive)
    start = {s: random.Random(f"dofkit {s!r}").randrange(256, 1025) / 512 for s in problem.constants if fixed}
    for seed in range(SEARCHES):
        check()
        try:
            point = search.search(seed, start, STARTS, STEPS)
        except (NoValueError, ArithmeticError, ValueError):
            continue
        if point is not None and point.solved == len(rows) and _is_solution(problem, ring, point, positive):
            at = point.point.symbols
            at_point = {s: arb(at[s]) for s in (*free, *problem.constants) if s in at}
            return {**dict.fromkeys(free, ex.ZERO), **at_point}
    return None


def _is_solution(problem: StateProblem, ring: Ring, point: RealPoint, positive: frozenset[Expr]) -> bool:
    """Return whether a certified point solves the problem on its whole ball, and a motion passes through it."""
    at = point.point.symbols
    zeros = [interval_of(e, at) for e in problem.equations]
    if not (point.certain and point.part.rank == point.solved):
        return False
    if not all(v is not None and v.contains(0) for v in zeros) or not hold_strictly(problem.conditions, at):
        return False
    if not all(arb(at[p]) > 0 for p in positive if p in at):
        return False
    if problem.still and not problem.constants:
        return True
    rows, columns = (problem.moving, problem.rates) if problem.rates else (problem.equations, problem.places)
    indices = [i for s in columns if (i := ring.var_index(s)) is not None]
    if not rows or not indices:
        return not rows
    slopes = jacobian(ring, values(ring, point.point), point.point, [ring.node(e) for e in rows], indices, arb(0))
    return ball_part(slopes).rank == len(rows)
