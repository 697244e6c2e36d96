"""States of motion: a configuration and time together with a velocity that the constraints allow there.

A generic state is a generic solution (q, qdot) of g(q, t) = 0, the time derivatives dg/dt = 0, the linear forms, and
the relations f(q, qdot, t) = 0 nonlinear in the velocities.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from dofkit.exact.points.balls import BallPoint, RealPoint, jacobian
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.points.frames import rank_over
from dofkit.exact.points.real_search import RealSearch, at_another_time
from dofkit.exact.ring.program import Scalar, false_without_value, none_without_value, values, vanish
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.unknowns import Unknown, unknown_of
from dofkit.exact.zero import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import NOBODY, Block, Row, aliases
from dofkit.relations.normal.normal_form import linear_form, velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import rate

#: Attempts at a state over GF(p).
TRIES = 3
#: Random configurations at which real velocities are searched.
STARTS = 6
#: Starts of a short search, and the steps of each.
NEAR_STARTS, NEAR_STEPS = 2, 25
#: If angles occur, searches from this number on begin farther from 0, by this factor.
FAR_FROM, FAR = 4, 16.0
#: Generators that are one branch of several; generators that a relation may be solved for.
BRANCHED = ("sign", "asin", "atan2")
SOLVED = ("symbol", "call", "cos", "sin")


class States:
    """The states of some rows and ``hidden`` equations, at which ``more`` expressions can be evaluated.

    With ``still`` they are configurations without velocities. ``finite``, ``linear`` (time derivatives of geometric
    equations, then forms) and ``curved`` (nonlinear) are the nodes of the relations.
    """

    def __init__(
        self,
        coordinates: Sequence[str],
        rows: Sequence[Row],
        hidden: Sequence[Expr],
        setting: Setting,
        more: Sequence[Expr] = (),
        still: bool = False,
    ) -> None:
        finite, linear, nonlinear = state_relations(rows, hidden)
        if still:
            linear, nonlinear = [], []
        everything = [*finite, *linear, *nonlinear, *more]
        self.setting = setting
        self.ring = Ring(everything, setting.positive, aliases(Block(tuple(coordinates), tuple(rows)), finite))
        self.finite = [self.ring.node(g) for g in finite]
        self.linear = [self.ring.node(e) for e in linear]
        self.curved = [self.ring.node(f) for f in nonlinear]
        self.extra = {e: self.ring.node(e) for e in more}
        self.places = [ex.coordinate(c) for c in coordinates]
        self.rates = [ex.velocity(c) for c in coordinates]
        self.velocities = [self.ring.var_index(v) for v in self.rates]

    @property
    def relations(self) -> list[int]:
        """The nodes of all relations."""
        return [*self.finite, *self.moving]

    @property
    def moving(self) -> list[int]:
        """The nodes of the relations between velocities."""
        return [*self.linear, *self.curved]

    @property
    def independent(self) -> bool:
        """Whether an expression that is not 0 over GF(p) is certainly not 0."""
        return independent_on_set(self.ring, self.finite)

    @property
    def chosen(self) -> bool:
        """Whether signs, which points over GF(p) choose at random, or branches of inverse functions occur.

        A result for one sign need not be valid for the other: atan2(y, x) = pi/4 is one half of the line y = x.
        """
        return any(v.kind in BRANCHED and self.ring.var_expr[v.index].symbols for v in self.ring.vars)

    @property
    def kinked(self) -> bool:
        """Whether velocities occur in abs()."""
        signs = (self.ring.var_expr[v.index] for v in self.ring.vars if v.kind == "sign")
        return any(s.args[0] == "velocity" for e in signs for s in e.symbols)

    @cached_property
    def rational(self) -> bool:
        """Whether the states are rational functions of free numbers, so that real states are generic.

        Otherwise the set may have components over GF(p) without real states: r^2 = -l^2 of r^4 = l^4.
        """
        if any(v.kind == "root" and self.ring.var_expr[v.index].symbols for v in self.ring.vars):
            return False
        solvers = [self._of_configurations, self._of_velocities]
        if any(self.ring.vars[unknown[1]].kind not in SOLVED for s in solvers for _, unknown in s.plan.steps):
            return False
        return all(not s.plan.stuck and all(s.degree(*step) == 1 for step in s.plan.steps) for s in solvers)

    def draw(self, seed: int) -> FieldPoint | None:
        """Return a generic state over GF(p): a generic configuration, and then velocities; None after `TRIES`."""
        if "field" not in self.setting.engines:
            return None
        for k in range(TRIES):
            base = self._base(TRIES * seed + k)
            point = None if base is None else self._of_velocities.completed(base)
            if point is not None and vanish(self.ring, point, self.relations):
                return point
        return None

    @none_without_value
    def _base(self, seed: int) -> FieldPoint | None:
        """Return a random configuration over GF(p) that satisfies the geometric equations; None if undefined."""
        return self._of_configurations.draw(seed) if self.finite else field_point([self.ring], seed)

    def _solver(self, nodes: Sequence[int], fixed: frozenset[Unknown] = frozenset()) -> TriangularSolver:
        return TriangularSolver(self.ring, [n for n in nodes if self.ring.code[n] != (0, 0)], fixed, seed=5)

    @cached_property
    def _of_configurations(self) -> TriangularSolver:
        return self._solver(self.finite)

    @cached_property
    def _of_velocities(self) -> TriangularSolver:
        still = [v for v in self.ring.vars if not moves(self.ring, v.index)]
        return self._solver(self.moving, frozenset(unknown_of(self.ring, v.index) for v in still))

    def real(self, seed: int) -> RealPoint | None:
        """Return a real state with balls, at a random configuration if possible; None if none is found."""
        if "balls" not in self.setting.engines:
            return None
        places = [*self.places, *self.setting.generic]
        search = self._search(self.relations, [*places, *self.rates])
        configurations, velocities = self._search(self.finite, places), self._search(self.moving, self.rates)
        for k in range(STARTS):
            symbols = self._spread(search.start(STARTS * seed + k, {}), seed)
            if configurations.descend(symbols, seed) is not None and velocities.descend(symbols, seed) is not None:
                state = search.search(seed, symbols, starts=1)
                if state is not None and state.certain:
                    return state
        return search.search(seed) or at_another_time(search, seed)

    @false_without_value
    def has_near_real_state(self) -> bool:
        """Return whether a short search from random starts finds a certified real state."""
        search = self._search(self.relations, [*self.places, *self.setting.generic, *self.rates])
        state = search.search(starts=NEAR_STARTS, steps=NEAR_STEPS) if "balls" in self.setting.engines else None
        return state is not None and state.certain

    def _spread(self, symbols: dict[Expr, float], seed: int) -> dict[Expr, float]:
        """Return starting values, for later searches farther from 0 if angles occur (to cover several turns)."""
        if seed < FAR_FROM or not any(v.kind in ("sin", "cos") for v in self.ring.vars):
            return symbols
        return {s: FAR * v if s in self.places else v for s, v in symbols.items()}

    def _search(self, nodes: Sequence[int], unknowns: Sequence[Expr]) -> RealSearch:
        return RealSearch(self.ring, nodes, unknowns, self.setting.positive)

    def certain(self, count: int) -> Iterator[BallPoint]:
        """Yield the certified real states at generic configurations, of ``count`` searches."""
        for k in range(count):
            state = self.real(k)
            if state is not None and state.certain:
                whole, moving, finite = self.ranks(state.point)
                if whole - moving == finite:
                    yield state.point

    def by_velocity(self, point: Any, nodes: Sequence[int]) -> list[list[Scalar]]:
        """Return the derivatives of some nodes by all velocities; one that does not occur has a column of zeros."""
        at = values(self.ring, point)
        zero = at[0] * 0
        present = [c for c in self.velocities if c is not None]
        rows = jacobian(self.ring, at, point, nodes, present, zero)
        place = {c: k for k, c in enumerate(present)}
        return [[zero if c is None else row[place[c]] for c in self.velocities] for row in rows]

    def ranks(self, point: FieldPoint | BallPoint) -> tuple[int, int, int]:
        """Return ranks of Jacobians: of all by (q, t, qdot), ``moving`` ones by qdot, ``finite`` by (q, t)."""
        at = values(self.ring, point)
        zero = at[0] * 0
        places = [i for s in (*self.places, ex.TIME) if (i := self.ring.var_index(s)) is not None]
        present = [c for c in self.velocities if c is not None]
        return (
            rank_over(jacobian(self.ring, at, point, self.relations, [*places, *present], zero), zero),
            rank_over(jacobian(self.ring, at, point, self.moving, present, zero), zero),
            rank_over(jacobian(self.ring, at, point, self.finite, places, zero), zero),
        )


def state_relations(rows: Sequence[Row], hidden: Sequence[Expr]) -> tuple[list[Expr], list[Expr], list[Expr]]:
    """Return (geometric equations, linear expressions in velocities (dg/dt, then forms), nonlinear ones)."""
    finite = [*(r.piece.expr for r in rows if isinstance(r.piece, Finite)), *hidden]
    forms = [r.piece.rate for r in rows if isinstance(r.piece, Pfaffian)]
    return finite, [*map(rate, finite), *forms], [r.piece.expr for r in rows if isinstance(r.piece, Nonlinear)]


def rows_at(relations: Sequence[Expr], pose: Mapping[Expr, Expr]) -> tuple[Row, ...]:
    """Return the rows of relations between velocities at one configuration; raises NoValueError if undefined there."""
    rows = []
    for e in (substitute(e, pose) for e in relations if velocities_of(e)):
        form = linear_form(e)
        if not e.is_zero:
            rows.append(Row(NOBODY, Nonlinear(e) if form is None else form))
    return tuple(rows)


def moves(ring: Ring, index: int) -> bool:
    """Return whether a generator depends on velocities."""
    return any(s.args[0] == "velocity" for s in ring.var_expr[index].symbols)


@none_without_value
def value_at(ring: Ring, point: FieldPoint | BallPoint, node: int) -> Scalar | None:
    """Return the value of a node at a point; None if it has none."""
    return values(ring, point, node + 1)[node]
