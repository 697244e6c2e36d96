"""States of motion: a configuration and time together with a velocity that the constraints allow there.

The relations g(q, t) = 0, their rates dg/dt = 0, the linear forms and the relations f(q, qdot, t) = 0 nonlinear in the
velocities, all in the unknowns (q, qdot): a generic state is a point of the set that they cut out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.exact.points.balls import BallPoint, RealPoint, jacobian
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.points.frames import rank_over
from dofkit.exact.points.real_search import RealSearch, at_another_time
from dofkit.exact.ring.program import Scalar, values, vanish
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.unknowns import Unit, unit_of
from dofkit.exact.zero import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import NOBODY, Block, Row, aliases
from dofkit.relations.normal.normal_form import linear_form, velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import rate

#: Draws of one state from which the one that is taken has to come.
TRIES = 3
#: Random configurations at which real velocities are looked for.
STARTS = 6
#: Functions that repeat are looked at far out as well, from this state on.
FAR_FROM, FAR = 4, 16.0
#: Functions that are one branch of several; what a relation may be solved for.
BRANCHED = ("sign", "asin", "atan2")
SOLVED = ("symbol", "call", "cos", "sin")


class States:
    """The states of some rows; ``more`` expressions can be evaluated at them.

    ``still``: configurations only, without velocities. ``finite``, ``linear`` (rates of geometric equations, then
    forms) and ``curved`` are the nodes of the relations.
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
        """Every relation's node."""
        return [*self.finite, *self.moving]

    @property
    def moving(self) -> list[int]:
        """The nodes of the relations that velocities satisfy."""
        return [*self.linear, *self.curved]

    @property
    def independent(self) -> bool:
        """Whether what is not 0 over GF(p) is certainly not 0."""
        return independent_on_set(self.ring, self.finite)

    @property
    def chosen(self) -> bool:
        """Whether there are signs that points over GF(p) draw at random, or functions that are a branch of an inverse.

        What holds for one sign need not for the other: atan2(y, x) = pi/4 is y = x on one half of it.
        """
        return any(v.kind in BRANCHED and self.ring.var_expr[v.index].symbols for v in self.ring.vars)

    @property
    def kinked(self) -> bool:
        """Whether velocities stand in abs()."""
        signs = (self.ring.var_expr[v.index] for v in self.ring.vars if v.kind == "sign")
        return any(s.args[0] == "velocity" for e in signs for s in e.symbols)

    @cached_property
    def rational(self) -> bool:
        """Whether the states are rational functions of numbers chosen freely: then the real ones are as generic as any.

        Else the set may have parts over GF(p) that no real state lies on: where r^2 = -l^2 of r^4 = l^4, or where
        exp(u) = 1 and u is not 0.
        """
        if any(v.kind == "root" and self.ring.var_expr[v.index].symbols for v in self.ring.vars):
            return False
        solvers = [self._standing, self._moving]
        if any(self.ring.vars[unit[1]].kind not in SOLVED for s in solvers for _, unit in s.plan.steps):
            return False
        return all(not s.plan.stuck and all(s.degree(*step) == 1 for step in s.plan.steps) for s in solvers)

    def draw(self, seed: int) -> FieldPoint | None:
        """Return a generic state over GF(p): velocities at a generic configuration where they can be solved for."""
        if "field" not in self.setting.engines:
            return None
        for k in range(TRIES):
            base = self._base(TRIES * seed + k)
            point = None if base is None else self._moving.completed(base)
            if point is not None and vanish(self.ring, point, self.relations):
                return point
        return None

    def _base(self, seed: int) -> FieldPoint | None:
        """Return a random configuration over GF(p) that satisfies the geometric equations."""
        if self.finite:
            return self._standing.draw(seed)
        try:
            return field_point([self.ring], seed)
        except NoValueError:
            return None

    def _solver(self, nodes: Sequence[int], fixed: frozenset[Unit] = frozenset()) -> TriangularSolver:
        return TriangularSolver(self.ring, [n for n in nodes if self.ring.code[n] != (0, 0)], fixed, seed=5)

    @cached_property
    def _standing(self) -> TriangularSolver:
        return self._solver(self.finite)

    @cached_property
    def _moving(self) -> TriangularSolver:
        still = [v for v in self.ring.vars if not moves(self.ring, v.index)]
        return self._solver(self.moving, frozenset(unit_of(self.ring, v.index) for v in still))

    def real(self, seed: int) -> RealPoint | None:
        """Return a real state with balls: velocities at a random configuration where there are some, else any."""
        if "balls" not in self.setting.engines:
            return None
        places = [*self.places, *self.setting.generic]
        search = self._search(self.relations, [*places, *self.rates])
        standing, moving = self._search(self.finite, places), self._search(self.moving, self.rates)
        for k in range(STARTS):
            symbols = self._spread(search.start(STARTS * seed + k, {}), seed)
            if standing.descend(symbols, seed) is not None and moving.descend(symbols, seed) is not None:
                state = search.search(seed, symbols, starts=1)
                if state is not None and state.certain:
                    return state
        return search.search(seed) or at_another_time(search, seed)

    def _spread(self, symbols: dict[Expr, float], seed: int) -> dict[Expr, float]:
        """Where to begin: far out for later states where angles occur, as what holds near 0 need not hold a turn on."""
        if seed < FAR_FROM or not any(v.kind in ("sin", "cos") for v in self.ring.vars):
            return symbols
        return {s: FAR * v if s in self.places else v for s, v in symbols.items()}

    def _search(self, nodes: Sequence[int], unknowns: Sequence[Expr]) -> RealSearch:
        return RealSearch(self.ring, nodes, unknowns, self.setting.positive)

    def certain(self, count: int) -> Iterator[BallPoint]:
        """Real states that are certified, at generic configurations, of so many searches."""
        for k in range(count):
            state = self.real(k)
            if state is not None and state.certain:
                whole, moving, finite = self.ranks(state.point)
                if whole - moving == finite:
                    yield state.point

    def by_velocity(self, point: Any, nodes: Sequence[int]) -> list[list[Scalar]]:
        """The derivatives of some nodes by the velocities; a velocity that nothing mentions has a column of zeros."""
        at = values(self.ring, point)
        zero = at[0] * 0
        present = [c for c in self.velocities if c is not None]
        rows = jacobian(self.ring, at, point, nodes, present, zero)
        place = {c: k for k, c in enumerate(present)}
        return [[zero if c is None else row[place[c]] for c in self.velocities] for row in rows]

    def ranks(self, point: FieldPoint | BallPoint) -> tuple[int, int, int]:
        """Ranks of all relations by (q, t, qdot), of those on velocities by qdot, and of the finite ones by (q, t)."""
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
    """Return the geometric equations, the linear ones in velocities (rates, then forms), and the nonlinear ones."""
    finite = [*(r.piece.expr for r in rows if isinstance(r.piece, Finite)), *hidden]
    forms = [r.piece.rate for r in rows if isinstance(r.piece, Pfaffian)]
    return finite, [*map(rate, finite), *forms], [r.piece.expr for r in rows if isinstance(r.piece, Nonlinear)]


def rows_at(relations: Sequence[Expr], pose: Mapping[Expr, Expr]) -> tuple[Row, ...]:
    """What relations say of velocities at one configuration: rows with constant coefficients. Raises NoValueError."""
    rows = []
    for e in (substitute(e, pose) for e in relations if velocities_of(e)):
        form = linear_form(e)
        if not e.is_zero:
            rows.append(Row(NOBODY, Nonlinear(e) if form is None else form))
    return tuple(rows)


def moves(ring: Ring, index: int) -> bool:
    """Return whether a generator depends on velocities."""
    return any(s.args[0] == "velocity" for s in ring.var_expr[index].symbols)


def value_at(ring: Ring, point: FieldPoint | BallPoint, node: int) -> Scalar | None:
    """Return the value of a node; None where it has none there."""
    try:
        return values(ring, point, node + 1)[node]
    except NoValueError:
        return None
