"""Many relations followed for a distance in floating point, their Jacobian without its zeros.

The independent relations are solved for as many columns, chosen by elimination with a threshold for pivots; the other
columns move along a straight line. Corrections keep the Jacobian of their step (the chord method).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from heapq import heapify, heappop, heappush
from typing import Any

from dofkit.base.deadline import check
from dofkit.base.libraries import np
from dofkit.configuration.local.manifold import Manifold
from dofkit.exact.errors import NoValueError, PoleError
from dofkit.exact.points.balls import FloatPoint
from dofkit.exact.ring.program import gradient, values

#: How far is followed, in the columns' scales, at the most and at the least, and in how many steps.
FAR, NEAR, STEPS = 2.0**-4, 2.0**-12, 2
#: What counts as not 0, relative to a relation's gradient, and what a correction comes down to, or goes beyond.
ROUGH, CLOSE, LARGE, ROUNDS = 1e-8, 1e-12, 1.0, 30
#: A pivot is at least this part of the largest entry of its row, and not below the last.
THRESHOLD, TINY = 0.1, 1e-9

FloatRow = dict[int, float]


class SparseColumns:
    """Rows solved for as many columns; raises PoleError where they are nearly dependent."""

    def __init__(self, rows: Sequence[FloatRow]) -> None:
        self._weight = Counter(c for row in rows for c in row)
        self._rows: list[tuple[int, float, FloatRow, FloatRow]] = []
        self._of: dict[int, int] = {}
        for row in rows:
            self._add(row)

    def _add(self, row: FloatRow) -> None:
        """A pivot row: what is left of the row when multiples of earlier ones are taken away, and those multiples."""
        work, used, of = dict(row), FloatRow(), self._of
        pending = [of[c] for c in work if c in of]
        heapify(pending)
        seen = set(pending)
        while pending:
            number = heappop(pending)
            column, pivot, others, _ = self._rows[number]
            factor = used[number] = work.pop(column, 0.0) / pivot
            for c, v in others.items():
                work[c] = work.get(c, 0.0) - factor * v
                k = of.get(c)
                if k is not None and k not in seen:
                    seen.add(k)
                    heappush(pending, k)
        most = max(map(abs, work.values()), default=0.0)
        if most < TINY:
            raise PoleError("the equations are nearly dependent")
        good = [c for c, v in work.items() if abs(v) >= THRESHOLD * most]
        column = min(good, key=lambda c: (self._weight[c], c))
        of[column] = len(self._rows)
        self._rows.append((column, work.pop(column), work, used))

    @property
    def columns(self) -> set[int]:
        """Those solved for."""
        return set(self._of)

    def solve(self, f: np.ndarray) -> dict[int, float]:
        """The values of the solved columns with J u = f, where the others are 0."""
        reduced: list[float] = []
        for (_, _, _, used), value in zip(self._rows, f, strict=True):
            reduced.append(float(value) - sum(factor * reduced[k] for k, factor in used.items()))
        found: dict[int, float] = {}
        for (column, pivot, others, _), value in zip(reversed(self._rows), reversed(reduced), strict=True):
            found[column] = (value - sum(v * found[c] for c, v in others.items() if c in found)) / pivot
        return found


class Wide:
    """The relations around a manifold's point in scaled coordinates u: column = start + scale u."""

    def __init__(self, ball: Manifold) -> None:
        self.ball = ball
        self.place = [i for i, c in enumerate(ball.columns) if c >= 0]
        self.number = {ball.columns[i]: a for a, i in enumerate(self.place)}
        self.keys = [ball.ring.vars[ball.columns[i]].key for i in self.place]
        self.scales = [ball.scales[i] for i in self.place]
        self.middle = {s: float(v.mid()) for s, v in ball.base.symbols.items()}
        self.origin = [self.middle[k] for k in self.keys]

    def at(self, u: np.ndarray) -> tuple[Any, FloatPoint]:
        """Every node's value at u."""
        moved = {k: o + s * float(v) for k, o, s, v in zip(self.keys, self.origin, self.scales, u, strict=True)}
        point = FloatPoint({**self.middle, **moved}, 0)
        return values(self.ball.ring, point), point

    def slopes(self, u: np.ndarray, nodes: Sequence[int]) -> tuple[list[FloatRow], np.ndarray]:
        """The gradients of some relations at u, scaled to length 1, and their lengths."""
        at, point = self.at(u)
        rows, norms = [], np.ones(len(nodes))
        for i, node in enumerate(nodes):
            slope = gradient(self.ball.ring, at, point, [(node, 1.0)])
            row = {a: float(v) * self.scales[a] for c, v in slope.items() if (a := self.number.get(c)) is not None}
            norms[i] = sum(v * v for v in row.values()) ** 0.5 or 1.0
            rows.append({a: v / norms[i] for a, v in row.items() if v})
        return rows, norms

    def values(self, u: np.ndarray, nodes: Sequence[int], norms: np.ndarray) -> np.ndarray:
        """Some relations at u, relative to their gradients."""
        at, _ = self.at(u)
        found: np.ndarray = np.array([at[n] for n in nodes], dtype=float) / norms
        return found


def holds_afar(ball: Manifold, direction: Sequence[float]) -> bool | None:
    """Are the dependent relations 0 in floats some way along a curve on which the independent ones are?

    None where the curve could not be followed.
    """
    here = Wide(ball)
    ahead = np.zeros(len(here.place))
    for value, c in zip(direction, ball.frame.free, strict=True):
        if ball.columns[c] in here.number:
            ahead[here.number[ball.columns[c]]] = value
    reach = FAR
    while reach > NEAR:
        u = _walk(here, ahead, reach)
        if u is not None:
            _, norms = here.slopes(np.zeros(len(u)), ball.others)
            return bool(np.max(np.abs(here.values(u, ball.others, norms))) <= ROUGH)
        reach /= 4
    return None


def _walk(here: Wide, ahead: np.ndarray, reach: float) -> np.ndarray | None:
    """The point at about the distance ``reach`` along a curve; None where it is too bent to be followed so far."""
    u = np.zeros(len(here.place))
    for _ in range(STEPS):
        check()
        rows, norms = here.slopes(u, here.ball.rows)
        try:
            solver = SparseColumns(rows)
        except NoValueError:
            return None
        tangent = _tangent(rows, solver, ahead)
        moved = u + (reach / STEPS) * tangent / max(float(np.linalg.norm(tangent)), TINY)
        corrected = _back(here, moved, solver, norms)
        if corrected is None or np.linalg.norm(corrected - moved) > reach / STEPS:
            return None
        u, ahead = corrected, tangent
    return u


def _tangent(rows: Sequence[Mapping[int, float]], solver: SparseColumns, ahead: np.ndarray) -> np.ndarray:
    """The direction with the free columns of ``ahead`` along which the relations stay 0 to first order."""
    found = ahead.copy()
    found[list(solver.columns)] = 0.0
    rates = np.array([sum(v * found[c] for c, v in row.items()) for row in rows])
    for c, v in solver.solve(rates).items():
        found[c] = -v
    return found


def _back(here: Wide, u: np.ndarray, solver: SparseColumns, norms: np.ndarray) -> np.ndarray | None:
    """Corrections of the solved columns until the relations hold."""
    u = u.copy()
    for _ in range(ROUNDS):
        f = here.values(u, here.ball.rows, norms)
        wrong = float(np.max(np.abs(f)))
        if wrong < CLOSE:
            return u
        if not wrong < LARGE:
            return None
        for c, v in solver.solve(f).items():
            u[c] -= v
    return None
