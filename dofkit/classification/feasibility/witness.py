"""Points at which equations and conditions hold together, with a certificate: exact numbers, or balls.

An inequality e >= 0 becomes the equation e = s^2 of one more unknown. A zero that the interval Newton test certifies
[KrawczykNewton], with s apart from 0, is a point at which it holds strictly.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from flint import arb, fmpq, fmpq_mat

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.classification.feasibility.state_problem import SignClaim, StateProblem, linear_condition
from dofkit.exact.boxes import WHOLE, BoxProgram, EmptyError, Interval, bounds
from dofkit.exact.linear_inequalities import solution
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.balls import BallPoint, jacobian
from dofkit.exact.points.real_search import RealPoint, RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import linear
from dofkit.relations.normal.domain import DomainCondition

#: Searches along slacks, from so many starts each, with so many steps; equations and conditions that one may have.
SEARCHES, STARTS, STEPS, MAX_ROWS = 3, 6, 60, 80
#: An exact value, or a ball, of symbols.
Values = Mapping[Expr, Expr | arb]


def witness(problem: StateProblem, positive: frozenset[Expr], drawn: Mapping[Expr, Expr]) -> Values | None:
    """Return the values of all symbols at a certified point at which all of a problem is satisfied, or None.

    A motion passes through it.

    ``drawn``: values of places to try first.
    """
    if problem.unknown_functions:
        return None
    result = _at(problem, positive, drawn)
    if result is not None or problem.drawn_only:
        return result
    if all(linear(e) is not None for e in problem.expressions) and not any(c.sense == "!=" for c in problem.conditions):
        return _linearly(problem, positive)
    if len(problem.expressions) > MAX_ROWS:
        return None
    return _by_slacks(problem, positive)


def value_of(s: Expr) -> Fraction:
    """A value for time or a parameter, positive, and the same wherever it occurs."""
    return Fraction(random.Random(f"dofkit feasible {s!r}").randrange(256, 1025), 512)


# -- exact points -----------------------------------------------------------------------------------


def _at(problem: StateProblem, positive: frozenset[Expr], drawn: Mapping[Expr, Expr]) -> Values | None:
    """The point with some exact values of all places, where it is at rest.

    The equations hold there whatever the parameters; the conditions strictly at some values of them, or at all.
    """
    if not problem.still or not all(s in drawn for s in problem.places):
        return None
    point = {s: drawn[s] for s in problem.places}
    try:
        moved = [substitute(e, point) for e in problem.expressions]
        here = {s: value_of(s) for s in _symbols((*moved, *point.values()))}
        n = len(problem.equations)
        if not all(_vanishes(e, positive, here) for e in moved[:n]):
            return None
        held = zip(moved[n:], problem.conditions, strict=True)
        if all(_holds(e, c, positive, here) for e, c in held):
            numbers = {s: ex.num(v) for s, v in here.items()}
            return {s: substitute(v, numbers) for s, v in (*point.items(), *((c, c) for c in problem.constants))}
    except (NoValueError, ArithmeticError, ValueError):
        return None
    return None


def _symbols(expressions: Iterable[Expr]) -> frozenset[Expr]:
    return frozenset[Expr]().union(*(e.symbols for e in expressions))


def _vanishes(e: Expr, positive: frozenset[Expr], at: Mapping[Expr, Fraction]) -> bool:
    """0 for all values of the parameters, and with a value at these."""
    return interval_of(e, at) is not None and zero_and_verdict(e, positive) == (True, "proved")


def _holds(e: Expr, c: DomainCondition, positive: frozenset[Expr], at: Mapping[Expr, Fraction]) -> bool:
    value = interval_of(e, at)
    if value is None:
        return False
    if c.sense == "!=":
        return not value.contains(0)
    return bool(value > 0) or (c.sense == ">=" and _vanishes(e, positive, at))


# -- linear ones ------------------------------------------------------------------------------------


def _linearly(problem: StateProblem, positive: frozenset[Expr]) -> Values | None:
    """A point from exact linear programming: all is linear with rational coefficients."""
    rows, columns = problem.independent
    order = sorted(problem.symbols, key=repr)
    open_only = not problem.rigidly
    if open_only and _linear_rank(rows, columns) < len(rows):
        return None
    claims = [SignClaim(e, "=") for e in problem.equations]
    claims += [SignClaim(c.expr, ">" if open_only or c.sense == ">" else ">=") for c in problem.conditions]
    claims += [SignClaim(s, ">") for s in order if s in positive]
    claims += [SignClaim(s - ex.num(v), "=") for s, v in problem.fixed.items() if s in order]
    result = solution([linear_condition(claim, order) for claim in claims])
    if not result:
        return None
    at: dict[Expr, Expr | arb] = dict.fromkeys(problem.unknowns, ex.ZERO)
    return at | {s: ex.num(Fraction(int(v.p), int(v.q))) for s, v in zip(order, result, strict=True)}


def _linear_rank(rows: Sequence[Expr], columns: Sequence[Expr]) -> int:
    tables = [linear(e) or {} for e in rows]
    entries = [[Fraction(t.get(s, 0)) for s in columns] for t in tables]
    if not entries or not columns:
        return 0
    return int(fmpq_mat([[fmpq(v.numerator, v.denominator) for v in row] for row in entries]).rank())


# -- balls ------------------------------------------------------------------------------------------


class _Search:
    """The search for points along slacks, one for each condition."""

    def __init__(self, problem: StateProblem, positive: frozenset[Expr]) -> None:
        self.problem, self.positive = problem, positive
        self.slacks = [ex.coordinate(f"_slack {k}") for k, c in enumerate(problem.conditions) if c.sense != "!="]
        wanted = [c.expr for c in problem.conditions if c.sense != "!="]
        above = [e - s * s for e, s in zip(wanted, self.slacks, strict=True)]
        rows = [*problem.equations, *above]
        self.ring = Ring([*rows, *problem.expressions], positive)
        self.rows = [self.ring.node(e) for e in rows]
        self.search = RealSearch(self.ring, self.rows, [*problem.unknowns, *self.slacks], positive)
        self.values = {s: float(v) for s, v in problem.fixed.items()}

    def certified_point(self, seed: int) -> RealPoint | None:
        """A point that is certified, with all slacks apart from 0."""
        try:
            point = self.search.search(seed, self.values, STARTS, STEPS)
        except (NoValueError, ArithmeticError, ValueError):
            return None
        if point is None or not point.certified or not point.consistent:
            return None
        apart = all(not arb(point.point.symbols[s]).contains(0) for s in self.slacks)
        return point if apart and self._signs(point) else None

    def _signs(self, point: RealPoint) -> bool:
        at = point.point.symbols
        return all(arb(at[p]) > 0 for p in self.positive if p in at)


def _by_slacks(problem: StateProblem, positive: frozenset[Expr]) -> Values | None:
    search = _Search(problem, positive)
    for seed in range(SEARCHES):
        check()
        point = search.certified_point(seed)
        if point is not None and _is_certified(problem, search, point):
            at = point.point.symbols
            point_values = {s: arb(at[s]) for s in (*problem.unknowns, *problem.constants) if s in at}
            return {**dict.fromkeys(problem.unknowns, ex.ZERO), **point_values}
    return None


def _is_certified(problem: StateProblem, search: _Search, point: RealPoint) -> bool:
    """Return whether all conditions hold at the point and a motion passes through it."""
    if not _defined(problem, point.point) or not point.solved == point.part.rank == len(search.rows):
        return False
    rows, columns = problem.independent
    return problem.rigidly or _rank(search.ring, point.point, rows, columns) == len(rows)


def _rank(ring: Ring, point: BallPoint, rows: Sequence[Expr], columns: Sequence[Expr]) -> int:
    """The certified rank of the derivatives of some rows by some symbols."""
    indices = [i for s in columns if (i := ring.var_index(s)) is not None]
    if not rows or not indices:
        return 0
    at = values(ring, point)
    return ball_part(jacobian(ring, at, point, [ring.node(e) for e in rows], indices, arb(0))).rank


def _defined(problem: StateProblem, point: BallPoint) -> bool:
    """Return whether all has a value on the whole ball, equations one that may be 0, conditions the right sign."""
    try:
        program = BoxProgram([(e, WHOLE) for e in problem.expressions])
        box = [bounds(arb(point.symbols[s])) for s in program.variables]
        at = program.forward(box)
        if not program.is_defined(at):
            return False
    except (EmptyError, NoValueError, KeyError):
        return False
    answer = [at[e] for e in problem.expressions]
    n = len(problem.equations)
    zeros = all(low <= 0.0 <= high for low, high in answer[:n])
    return zeros and all(_agrees(v, c) for v, c in zip(answer[n:], problem.conditions, strict=True))


def _agrees(value: Interval, c: DomainCondition) -> bool:
    low, high = value
    return (low > 0.0 or high < 0.0) if c.sense == "!=" else low > 0.0
