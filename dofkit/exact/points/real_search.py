"""Real points of {g = 0}: a search in floating point, and a certificate in balls.

Gauss-Newton from random starts in floating point gives a point; Newton's method refines it for a subset of independent
relations, and the interval Newton test certifies it: the ball then contains exactly one real zero of that subset.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from flint import arb, arb_mat, ctx

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.certified import PivotedPart, ball_part, independent_part
from dofkit.exact.matrices.dense import largest, length, step
from dofkit.exact.points.balls import BallPoint, FloatPoint, RealPoint, jacobian, precision, random_values
from dofkit.exact.ring.program import false_without_value, none_without_value, raising_no_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import TIME, Expr

STARTS, ITERATIONS, NEWTON_STEPS = 12, 80, 24
#: `at_another_time`: searches, the factor from one starting time to the next but one, and the denominator of times.
MOMENTS, LATER, TICKS = 8, 4.0, 512
#: How often a step that leaves the domain of the functions is halved.
HALVINGS = 8
#: Bound on the multiplications of an elimination with balls at a point near the zero set.
MAX_ELIMINATED = 20_000
#: How far unknowns move to see whether relations stay dependent, in parts of random numbers.
NEARBY = 2.0**-12
#: A relative Newton step below 2^(SPARE_BITS - precision) ends the refinement.
SPARE_BITS = 16
#: How often the box around two points is made wider, and by how much at least.
INFLATIONS, ROOM = 4, 2**-30


class RealSearch:
    """Searches for real points on the zero set of ``nodes`` by changing ``unknowns`` (also unnamed parameters)."""

    def __init__(
        self,
        ring: Ring,
        nodes: Sequence[int],
        unknowns: Sequence[Expr],
        positive: frozenset[Expr],
        ranked: Sequence[Expr] | None = None,
    ) -> None:
        """``ranked``: the symbols for the Jacobian of a `RealPoint`, by default all unknowns."""
        self.ring = ring
        self.nodes = list(nodes)
        self.ranked = None if ranked is None else [i for s in ranked if (i := ring.var_index(s)) is not None]
        self.unknowns = [u for u in unknowns if ring.var_index(u) is not None]
        self.columns = [ring.var_index(u) or 0 for u in self.unknowns]
        self.positive = positive
        self.upto = len(ring.code)

    def start(self, seed: int, initial: Mapping[Expr, float]) -> dict[Expr, float]:
        """Return ``initial`` values of symbols, completed by random values of the others."""
        drawn = random_values(self.ring, self.positive, seed)
        return {s: initial.get(s, value) for s, value in drawn.items()}

    @raising_no_value
    def search(
        self,
        seed: int = 0,
        initial: Mapping[Expr, float] | None = None,
        starts: int = STARTS,
        steps: int = ITERATIONS,
    ) -> RealPoint | None:
        """Return the first ``certain`` point, else the first other one or None; starts have the ``initial`` values."""
        singular: RealPoint | None = None
        for attempt in range(starts):
            symbols = self.start(seed * STARTS + attempt, initial or {})
            slopes = self.descend(symbols, seed, steps)
            refined = None if slopes is None else self.refine(symbols, slopes, seed)
            if refined is not None and refined.certain:
                return refined
            singular = singular or refined
        return singular

    def descend(self, symbols: dict[Expr, float], seed: int, steps: int = ITERATIONS) -> list[list[float]] | None:
        """Move ``symbols`` (in place) to the zero set by Gauss-Newton in floats; return the Jacobian with scaled rows.

        None if it does not converge. At a singular point convergence is linear: it goes on until steps are fast or 0.
        """
        if not self.nodes:
            return []
        previous, j = math.inf, list[list[float]]()
        base, change = dict.fromkeys(self.unknowns, 0.0), [symbols[u] for u in self.unknowns]
        for _ in range(steps):
            check()
            system = self._within_domain(symbols, base, change, seed)
            if system is None:
                return None
            f, j = system
            reach = max(1.0, math.hypot(*(symbols[u] for u in self.unknowns)))
            if not (math.isfinite(sum(f)) and math.isfinite(sum(map(sum, j)))):
                return None
            scale = [largest(row) + 1e-300 for row in j]
            j = [[v / size for v in row] for row, size in zip(j, scale, strict=True)]
            f = [v / size for v, size in zip(f, scale, strict=True)]
            residual = largest(f) / reach
            fast, stands = residual <= previous / 8, residual >= 0.9 * previous
            if residual == 0 or (residual < 1e-13 and (fast or stands)) or (residual < 1e-11 and stands):
                return j
            previous = residual
            change = step(j, f)
            far = length(change)
            if not math.isfinite(far):
                return None
            if far > 4 * reach:
                change = [4 * reach / far * s for s in change]
            base = {u: symbols[u] for u in self.unknowns}
            for u, s in zip(self.unknowns, change, strict=True):
                symbols[u] += s
        return j if previous < 1e-13 else None

    def _within_domain(
        self, symbols: dict[Expr, float], base: Mapping[Expr, float], change: Sequence[float], seed: int
    ) -> tuple[list[float], list[list[float]]] | None:
        """Return the system at ``symbols``, moved back to ``base`` by halving the step while it has no value there."""
        for halvings in range(HALVINGS):
            try:
                return self.float_system(symbols, seed)
            except (ValueError, OverflowError, NoValueError):
                for u, s in zip(self.unknowns, change, strict=True):
                    symbols[u] = base[u] + s / 2 ** (halvings + 1)
        return None

    def float_system(self, symbols: Mapping[Expr, float], seed: int) -> tuple[list[float], list[list[float]]]:
        """Return the relations' values at a point, and their Jacobian by the unknowns."""
        point = FloatPoint(symbols, seed)
        at = values(self.ring, point, self.upto)
        j = jacobian(self.ring, at, point, self.nodes, self.columns, 0.0)
        return [float(at[n]) for n in self.nodes], [list(map(float, row)) for row in j]

    def refine(self, symbols: Mapping[Expr, float], j: list[list[float]], seed: int) -> RealPoint | None:
        """Return the point near ``symbols``, refined for independent rows of its Jacobian ``j`` by interval Newton.

        None if it diverges or a positive symbol is not positive. If the point is uncertain, more rows are tried.
        """
        if any(symbols[p] <= 0 for p in self.positive if p in symbols):
            return None
        with ctx.workprec(max(ctx.prec, precision())):
            return self._precise(symbols, j, seed)

    def _precise(self, symbols: Mapping[Expr, float], j: list[list[float]], seed: int) -> RealPoint | None:
        """Return the point refined with the rows that are independent in floats, or else with those of `_part_at`."""
        rows, columns = independent_part(j)[2:] if j else ([], [])
        refined = self._refined(symbols, rows, columns, seed)
        if (refined is not None and refined.certain) or len(rows) == len(self.nodes):
            return refined
        part = self._part_at(symbols, seed)
        if part is None or part.rank <= len(rows):
            return refined
        other = self._refined(symbols, part.rows, part.columns, seed)
        return other if other is not None and other.certain else refined

    @none_without_value
    def _part_at(self, symbols: Mapping[Expr, float], seed: int) -> PivotedPart | None:
        """Return a nonsingular submatrix of the Jacobian in balls at a point; None if it is too large or has a pole."""
        if len(self.nodes) ** 2 * len(self.columns) > MAX_ELIMINATED:
            return None
        point = BallPoint({s: arb(v) for s, v in symbols.items()}, seed)
        at = values(self.ring, point, self.upto)
        return ball_part(jacobian(self.ring, at, point, self.nodes, self.columns, arb(0)))

    @none_without_value
    def _refined(
        self, symbols: Mapping[Expr, float], rows: Sequence[int], columns: Sequence[int], seed: int
    ) -> RealPoint | None:
        """Return the zero of the relations ``rows``, in the unknowns ``columns``, near ``symbols``; None if none."""
        exact, certified = {s: arb(v) for s, v in symbols.items()}, True
        if rows:
            moved = self._newton(exact, rows, columns, seed)
            if moved is None:
                return None
            exact, certified = moved
        point = BallPoint(exact, seed)
        at = values(self.ring, point, self.upto)
        ranked = self.columns if self.ranked is None else self.ranked
        matrix = jacobian(self.ring, at, point, self.nodes, ranked, arb(0))
        consistent = all(at[n].contains(0) for n in self.nodes)
        if consistent and len(rows) < len(self.nodes):
            consistent = _vanish_nearby(self, exact, rows, columns, seed)
        return RealPoint(point, ball_part(matrix), certified, consistent, matrix, len(rows))

    def _newton(
        self, exact: dict[Expr, arb], rows: Sequence[int], columns: Sequence[int], seed: int
    ) -> tuple[dict[Expr, arb], bool] | None:
        """Return the ball of a zero near ``exact`` (changed in place), and whether interval Newton certifies it."""
        nodes = [self.nodes[r] for r in rows]
        unknowns = [self.unknowns[c] for c in columns]
        indices = [self.columns[c] for c in columns]
        tiny = arb(2) ** (SPARE_BITS - precision())
        try:
            for _ in range(NEWTON_STEPS):
                f, j = self._ball_system(exact, nodes, indices, seed)
                step = _solution(j, f)
                for i, u in enumerate(unknowns):
                    exact[u] = (exact[u] - step[i, 0]).mid()
                if all(abs(step[i, 0]) <= (1 + abs(exact[u])) * tiny for i, u in enumerate(unknowns)):
                    break
            radius = arb(0, arb(2) ** -(precision() // 2))
            boxed = {**exact, **{u: exact[u] + radius for u in unknowns}}
            at = values(self.ring, BallPoint(exact, seed), self.upto)
            _, j = self._ball_system(boxed, nodes, indices, seed)
            step = _solution(j, arb_mat([[at[n]] for n in nodes]))
        except NoValueError:
            return None
        inside = True  # [KrawczykNewton]
        for i, u in enumerate(unknowns):
            new = exact[u] - step[i, 0]
            inside = inside and bool(boxed[u].contains_interior(new))
            boxed[u] = new
        return boxed, inside

    def _ball_system(
        self, exact: Mapping[Expr, arb], nodes: Sequence[int], indices: Sequence[int], seed: int
    ) -> tuple[arb_mat, arb_mat]:
        point = BallPoint(exact, seed)
        at = values(self.ring, point, self.upto)
        j = jacobian(self.ring, at, point, nodes, indices, arb(0))
        return arb_mat([[at[n]] for n in nodes]), arb_mat(j)


@false_without_value
def _vanish_nearby(
    search: RealSearch, exact: Mapping[Expr, arb], rows: Sequence[int], columns: Sequence[int], seed: int
) -> bool:
    """Return whether all relations vanish where other unknowns move a little too: at no singular point alone."""
    drawn = random_values(search.ring, search.positive, seed)
    free = {u: NEARBY * drawn[u] for k, u in enumerate(search.unknowns) if k not in columns}
    moved = {s: v.mid() + free.get(s, 0) for s, v in exact.items()}
    solved = search._newton(moved, rows, columns, seed) if rows else (moved, True)
    at = None if solved is None else values(search.ring, BallPoint(solved[0], seed), search.upto)
    return at is not None and all(at[n].contains(0) for n in search.nodes)


@false_without_value
def are_joined(search: RealSearch, start: Mapping[Expr, arb], end: RealPoint, rank: int) -> bool:
    """Return whether it is proved that a curve of zeros leads from ``start`` to ``end``.

    This is proved if, in a box around the two points, ``rank`` relations that are independent at ``end`` determine
    ``rank`` unknowns as functions of the other symbols [KrawczykNewton].
    """
    at = values(search.ring, end.point, search.upto)
    part = ball_part(jacobian(search.ring, at, end.point, search.nodes, search.columns, arb(0)))
    unknowns = [search.unknowns[c] for c in part.columns]
    box = {s: v.union(start[s]) for s, v in end.point.symbols.items()}
    middle = {u: box[u].mid() for u in unknowns}
    nodes, indices = [search.nodes[r] for r in part.rows], [search.columns[c] for c in part.columns]
    for _ in range(INFLATIONS if part.rank == rank else 0):
        f = search._ball_system({**box, **middle}, nodes, indices, end.point.seed)[0]
        step = _solution(search._ball_system(box, nodes, indices, end.point.seed)[1], f)
        reached = {u: v - step[i, 0] for i, (u, v) in enumerate(middle.items())}
        if all(box[u].contains_interior(v) for u, v in reached.items()):
            return True
        box |= {u: box[u].union(middle[u] + 2 * (v - middle[u]) + arb(0, ROOM)) for u, v in reached.items()}
    return False


def at_another_time(search: RealSearch, seed: int = 0) -> RealPoint | None:
    """Return a certain point at some other time, or None; the search in floats takes time as an unknown."""
    if TIME in search.unknowns or search.ring.var_index(TIME) is None:
        return None
    timed = RealSearch(search.ring, search.nodes, [*search.unknowns, TIME], search.positive)
    for k in range(MOMENTS):
        symbols = timed.start(MOMENTS * seed + k, {})
        symbols[TIME] *= (-1) ** k * LATER ** (k // 2)
        if timed.descend(symbols, seed) is None:
            continue
        symbols[TIME] = round(symbols[TIME] * TICKS) / TICKS
        point = search.search(seed, symbols, starts=1)
        if point is not None and point.certain:
            return point
    return None


@raising_no_value
def _solution(matrix: arb_mat, right: arb_mat) -> arb_mat:
    """Return x with matrix x = right; raises PoleError if the matrix of balls may be singular."""
    return matrix.solve(right)
