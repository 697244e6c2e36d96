"""The relations at points of M, or of N, at a distance from the germ's point: found in floats, refined with balls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flint import arb, arb_mat, ctx

from dofkit.base.deadline import check
from dofkit.configuration.local.manifold import Manifold, Split
from dofkit.exact.matrices.dense import Vector, dot, largest, length, plus, step, times
from dofkit.exact.points.balls import BallPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.expressions.tree import Expr

#: The largest and the least length of a curve on M, in the columns' scales, and its number of steps.
FAR, NEAR, STEPS = 0.5, 2.0**-24, 8
#: The least cosine between successive steps; corrections may be up to 1 - STRAIGHT of a step.
STRAIGHT = 0.9
#: Residuals, relative to gradients, up to `SURE` count as 0; more than `MANY` relations have no known critical set.
SURE, MANY = 2.0**-150, 60
#: Bits that may be lost by cancellation: a million sizes from the origin, squared, and more.
LOST = 90
#: Bits, and residuals that count as 0, if the curve begins at exact coordinates.
DEEP, DEEP_SURE = 1024, 2.0**-900
#: Bits with which relations are evaluated before they are rounded to floats.
WIDE = 256
#: The step of a difference of gradients, and rounds of Newton's method.
DIFFERENCE, ROUNDS = 2.0**-80, 8
FAULTS = (ArithmeticError, ValueError)


class Neighbourhood:
    """The relations near a manifold's point in scaled coordinates u of its columns: column = start + scale u."""

    def __init__(self, ball: Manifold) -> None:
        self.ball = ball
        self.ring = ball.ring
        self.place = [i for i, c in enumerate(ball.columns) if c >= 0]
        self.number = {i: a for a, i in enumerate(self.place)}
        self.dependent = [self.number[c] for c in ball.frame.dependent]
        self.columns = [ball.columns[i] for i in self.place]
        self.keys = [ball.ring.vars[c].key for c in self.columns]
        self.scales = [float(ball.scales[i]) for i in self.place]
        self.middle: dict[Expr, arb] = {s: arb(v).mid() for s, v in ball.base.symbols.items()}
        self.norm_of = dict.fromkeys(ball.nodes, 1.0)
        _, j = self.floats([0.0] * len(self.columns), ball.nodes)
        self.norm_of = {n: length(row) or 1.0 for n, row in zip(ball.nodes, j, strict=True)}

    def floats(self, u: Vector, nodes: Sequence[int]) -> tuple[list[float], list[list[float]]]:
        """Return (values, Jacobian by u) of relations at u, in units in which their gradients at the point are 1."""
        with ctx.workprec(WIDE):
            point = BallPoint(self.exactly(u))
            at = values(self.ring, point)
            f = [float(at[n].mid()) / self.norm_of[n] for n in nodes]
            rows = jacobian(self.ring, at, point, nodes, self.columns, arb(0))
        return f, [self.scaled(row, n) for n, row in zip(nodes, rows, strict=True)]

    def scaled(self, row: Sequence[arb], node: int) -> list[float]:
        """Return a relation's derivatives by u, given those by the columns, in units of its gradient."""
        return [float(v.mid()) * s / self.norm_of[node] for v, s in zip(row, self.scales, strict=True)]

    def onto_rows(self, j: Sequence[Vector], ahead: Vector) -> list[float]:
        """Return the velocity with the free entries of ``ahead`` on which the rows ``j`` are 0."""
        if not self.dependent:
            return list(ahead)
        moved = list(ahead)
        square = [[row[c] for c in self.dependent] for row in j]
        for c, v in zip(self.dependent, step(square, times(j, ahead)), strict=True):
            moved[c] = v
        return moved

    def exactly(self, u: Vector) -> dict[Expr, arb]:
        """Return the values of all symbols at u."""
        moved = {
            k: self.middle[k] + arb(float(s)) * arb(float(v)) for k, s, v in zip(self.keys, self.scales, u, strict=True)
        }
        return {**self.middle, **{k: v.mid() for k, v in moved.items()}}

    def newton(self, symbols: dict[Expr, arb], nodes: Sequence[int], moved: Sequence[int]) -> dict[Expr, arb] | None:
        """Return the zero of ``nodes`` in the columns numbered ``moved``, in high precision; None if not converged."""
        columns = [self.columns[i] for i in moved]
        for _ in range(ROUNDS):
            check()
            point = BallPoint(symbols)
            at = values(self.ring, point)
            j = arb_mat([[v.mid() for v in row] for row in jacobian(self.ring, at, point, nodes, columns, arb(0))])
            step = j.solve(arb_mat([[at[n].mid()] for n in nodes]))
            symbols = dict(symbols)
            last = arb(0)
            for a, i in enumerate(moved):
                symbols[self.keys[i]] = (symbols[self.keys[i]] - step[a, 0]).mid()
                last = max(last, abs(step[a, 0].mid()) / float(self.scales[i]))
            if last < arb(2) ** (LOST - ctx.prec):
                return symbols
        return None

    def onto(self, symbols: dict[Expr, arb]) -> dict[Expr, arb] | None:
        """Return the point of M with the same free columns; None if Newton's method does not converge."""
        if not self.ball.rows:
            return symbols
        return self.newton(symbols, self.ball.rows, self.dependent)

    def symbol_and_scale(self, c: int) -> tuple[Expr, float]:
        """Return (symbol, scale) of the c-th free column."""
        i = self.number[self.ball.frame.free[c]]
        return self.keys[i], float(self.scales[i])

    def gradients(self, symbols: Mapping[Expr, arb], critical: Split) -> list[arb]:
        """Return df_i/dx_j at a point for each (i, j) of ``critical``, along the manifold of the solved equations."""
        ball = self.ball
        point = BallPoint(symbols)
        at = values(self.ring, point)
        free = [ball.columns[c] for c in ball.frame.free]
        solved = [self.columns[i] for i in self.dependent]
        used = sorted({i for i, _ in critical.equations})
        f = jacobian(self.ring, at, point, [ball.others[i] for i in used], solved + free, arb(0))
        r = len(solved)
        if r:
            g = jacobian(self.ring, at, point, ball.rows, solved + free, arb(0))
            a = arb_mat([[row[c].mid() for row in g] for c in range(r)])
            multipliers = a.solve(arb_mat([[line[c].mid() for line in f] for c in range(r)]))
            f = [
                [v - sum((multipliers[k, i] * g[k][c] for k in range(r)), arb(0)) for c, v in enumerate(line)]
                for i, line in enumerate(f)
            ]
        return [f[used.index(i)][r + j].mid() for i, j in critical.equations]

    def residual(self, symbols: Mapping[Expr, arb], nodes: Sequence[int]) -> float:
        """Return the largest absolute value of the relations, relative to their gradients."""
        at = values(self.ring, BallPoint(symbols))
        return max((abs(float(at[n].mid())) / float(self.norm_of[n]) for n in nodes), default=0.0)


def holds_away(ball: Manifold, direction: Sequence[float], deep: bool) -> bool | None:
    """Return whether the dependent relations are 0, in high precision, at a distant point of M; None without one.

    ``deep``: the curve begins at exact coordinates, so that nonzero terms of an order of several hundreds are seen.
    """
    try:
        here = Neighbourhood(ball)
        reach = FAR
        while reach > NEAR:
            u = _walk(here, direction, reach)
            if u is not None:
                with ctx.workprec(DEEP if deep else ctx.prec):
                    return _is_satisfied_near(here, u, DEEP_SURE if deep else SURE)
            reach /= 4
    except FAULTS:
        pass  # no point
    return None


def _is_satisfied_near(here: Neighbourhood, u: Vector, sure: float) -> bool | None:
    """Return whether the dependent relations are 0, up to ``sure``, at the point of M near u; None if it has none."""
    ball = here.ball
    rows, columns = independent(here.floats(u, ball.rows)[1], 0.0) if ball.rows else ([], [])
    if len(rows) < len(ball.rows):
        return None
    symbols = here.newton(here.exactly(u), [ball.rows[r] for r in rows], columns)
    return None if symbols is None else here.residual(symbols, ball.others) <= sure


def holds_on_critical(ball: Manifold, critical: Split, direction: Sequence[float]) -> bool:
    """Return whether the dependent relations are 0, in high precision, at a distant point of N; False without one."""
    if len(ball.rows) > MANY:
        return False
    try:
        here = Neighbourhood(ball)
        reach = FAR
        while reach > NEAR:
            symbols = _onto_critical(here, critical, direction, reach)
            if symbols is not None:
                return here.residual(symbols, ball.others) <= SURE
            reach /= 8
    except FAULTS:
        pass  # nowhere near
    return False


def _onto_critical(
    here: Neighbourhood, critical: Split, direction: Sequence[float], reach: float
) -> dict[Expr, arb] | None:
    """Return the point of N, by Newton's method, whose free coordinates are moved by ``reach`` along ``direction``."""
    symbols = dict(here.middle)
    for value, c in zip(direction, critical.free, strict=True):
        if here.ball.frame.free[c] not in here.number:
            continue
        key, scale = here.symbol_and_scale(c)
        symbols[key] = symbols[key] + arb(value * reach * scale)
    point = here.onto(symbols)
    last = arb(1)
    for _ in range(ROUNDS if critical.solved else 0):
        check()
        if point is None:
            return None
        before, (last, point) = last, _newton_step(here, critical, point)
        if last < arb(DIFFERENCE):
            return point
        if last > before:
            return None
    return None if critical.solved else point


def _newton_step(here: Neighbourhood, critical: Split, symbols: dict[Expr, arb]) -> tuple[arb, dict[Expr, arb] | None]:
    """Return (size, point) after a Newton step on the manifold M towards the critical set N of dependent relations.

    The size is relative to the columns' scales; the Hessian is one of differences. If M is not reached, point is None.
    """
    gradients = here.gradients(symbols, critical)
    columns = []
    for c in critical.solved:
        key, scale = here.symbol_and_scale(c)
        step = arb(DIFFERENCE * scale)
        moved = here.onto({**symbols, key: symbols[key] + step})
        if moved is None:
            return arb(1), None
        columns.append([(b - a) / step for a, b in zip(gradients, here.gradients(moved, critical), strict=True)])
    change = arb_mat(columns).transpose().solve(arb_mat([[g] for g in gradients]))
    size = arb(0)
    for i, c in enumerate(critical.solved):
        key, scale = here.symbol_and_scale(c)
        symbols = {**symbols, key: (symbols[key] - change[i, 0]).mid()}
        size = max(size, abs(change[i, 0].mid()) / scale)
    return size, here.onto(symbols)


def _walk(here: Neighbourhood, direction: Sequence[float], reach: float) -> list[float] | None:
    """Return the point of M, as u, at about the distance ``reach`` along a curve; None if steps bend too much."""
    ball = here.ball
    u, ahead = [0.0] * len(here.place), [0.0] * len(here.place)
    for value, c in zip(direction, ball.frame.free, strict=True):
        if c in here.number:
            ahead[here.number[c]] = float(value)
    if not ball.rows:
        return [reach * v for v in ahead]
    _, j = here.floats(u, ball.rows)
    ahead = here.onto_rows(j, ahead)
    for _ in range(STEPS):
        tangent = plus(ahead, 1.0, step(j, times(j, ahead)))
        size = length(tangent)
        if not size > 0:
            return None
        tangent = [v / size for v in tangent]
        if dot(tangent, ahead) < STRAIGHT * length(ahead):
            return None
        moved = plus(u, reach / STEPS, tangent)
        corrected = _onto_manifold(here, moved)
        if corrected is None or length(plus(corrected[0], -1.0, moved)) > (1 - STRAIGHT) * reach / STEPS:
            return None
        (u, j), ahead = corrected, tangent
    return u


def _onto_manifold(here: Neighbourhood, u: Vector) -> tuple[list[float], list[list[float]]] | None:
    """Return (the point of M near ``u``, the rows of M there), by Newton's method in floats; None if not converged."""
    moved = list(u)
    for _ in range(ROUNDS):
        f, j = here.floats(moved, here.ball.rows)
        change = step(j, f)
        moved = plus(moved, 1.0, change)
        if largest(change) < 1e-12:
            return moved, j
    return None


def independent(j: Sequence[Vector], least: float) -> tuple[list[int], list[int]]:
    """Return (rows, columns) of a well conditioned submatrix, by complete pivoting with pivots above ``least``."""
    work, rows, columns = {r: list(row) for r, row in enumerate(j)}, list[int](), list[int]()
    while work:
        r = max(work, key=lambda i: largest(work[i]))
        row = work.pop(r)
        c = max(range(len(row)), key=lambda i: abs(row[i]))
        if not abs(row[c]) > least:
            break
        rows.append(r)
        columns.append(c)
        for i, other in work.items():
            work[i] = plus(other, -other[c] / row[c], row)
            work[i][c] = 0.0
    return rows, columns
