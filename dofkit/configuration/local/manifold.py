"""The manifold of independent relations through a point, followed along curves as power series."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flint import arb_mat

from dofkit.base.deadline import check
from dofkit.base.verdicts import ArgumentKey, Verdict
from dofkit.exact.matrices.sparse import Pivots, Reduction, factored
from dofkit.exact.points.frames import field_frame, solve
from dofkit.exact.points.series import Series, SeriesPoint, monomial, zero_poly
from dofkit.exact.residues import Residue, modulus, residue
from dofkit.exact.ring.program import Scalar, gradient, raising_no_value, values
from dofkit.exact.ring.ring import Ring

Form = list[list[Scalar]]


@dataclass(frozen=True)
class LocalDimension:
    """The dimension of a set at one of its points (with time, if it is a column), None if undecided.

    ``confined``: time is constant on the set near the point; ``argument``: the key of the criterion's argument.
    """

    dimension: int | None
    verdict: Verdict
    reason: str
    confined: bool = False
    argument: ArgumentKey | None = None


class Curve:
    """A curve on the manifold: the ``path`` of every column, and the program's values ``at`` its points, as series."""

    def __init__(self, ring: Ring, path: list[Series], point: SeriesPoint, at: list[Series]) -> None:
        self.ring, self.path, self.point, self.at = ring, path, point, at

    def slopes(self, nodes: Sequence[int], columns: Sequence[int]) -> list[list[Series]]:
        """Return d(node)/d(column) along the curve, as series."""
        order = self.point.order
        zero, unit = Series(self.point.like, order), Series(self.point.like + 1, order)
        matrix = []
        for node in nodes:
            check()
            g = gradient(self.ring, self.at, self.point, [(node, unit)])
            matrix.append([g.get(c, zero) if c >= 0 else zero for c in columns])
        return matrix


class Manifold:
    """The manifold M of the independent relations ``rows`` at a point; ``others`` are the nodes of the dependent ones.

    The coordinates of M are the ``free`` columns of ``frame``. ``scales``: units of the columns (1 for angles).
    """

    def __init__(
        self,
        ring: Ring,
        nodes: Sequence[int],
        columns: Sequence[int],
        frame: Pivots,
        base: Any,
        scales: Sequence[float] = (),
    ) -> None:
        self.ring, self.nodes, self.columns, self.frame, self.base = ring, list(nodes), list(columns), frame, base
        self.scales = list(scales) or [1.0] * len(self.columns)
        at = values(ring, base)
        self.sample = at[0] * 0 if at else base.number(0)
        self.like = zero_poly(self.sample)
        self.start = [at[ring.var_node[c]] if c >= 0 else self.sample for c in columns]
        kept = set(frame.rows)
        self.rows = [self.nodes[r] for r in frame.rows]
        self.others = [n for i, n in enumerate(self.nodes) if i not in kept]

    @property
    def dimension(self) -> int:
        """The dimension m of M."""
        return len(self.frame.free)

    @cached_property
    def _inverse(self) -> Any:
        """The inverse matrix (or elimination) of the independent rows in the dependent columns, at the point."""
        at, columns = values(self.ring, self.base), [self.columns[c] for c in self.frame.dependent]
        slopes = [gradient(self.ring, at, self.base, [(node, self.sample + 1)]) for node in self.rows]
        if isinstance(self.sample, Residue):
            place = {column: k for k, column in enumerate(columns)}
            rows = [{place[c]: int(v) for c, v in slope.items() if c in place and v != 0} for slope in slopes]
            return factored(rows, modulus(self.sample))
        return inverse([[slope.get(c, self.sample) for c in columns] for slope in slopes])

    def follow(self, direction: Sequence[Scalar], order: int) -> list[Series]:
        """Return the dependent relations, as series, along the curve with free columns start + s direction."""
        curve = self.line(direction, order)
        return [curve.at[n] for n in self.others]

    def line(self, direction: Sequence[Scalar], order: int) -> Curve:
        """Return the curve on M with free columns start + s direction."""
        step = Series(monomial(self.like), order)
        starts = [Series(self.like + self.start[c], order) for c in self.frame.free]
        return self.curve([a + step * v for a, v in zip(starts, direction, strict=True)], order)

    def curve(self, free: Sequence[Series], order: int) -> Curve:
        """Return the curve on M with the given free columns; the dependent columns are computed order by order.

        With A the inverse of dg/d(dependent) at the point, their coefficient of s^k is -A [s^k] g, where g is evaluated
        with this coefficient 0, because it contributes only dg/d(dependent) times itself to [s^k] g.
        """
        path = [Series(self.like + value, order) for value in self.start]
        for c, series in zip(self.frame.free, free, strict=True):
            path[c] = series
        for k in range(1, order if self.rows else 1):
            check()
            _, at = self._evaluate(path, k + 1)
            step = product(self._inverse, [at[n].coefficient(k) for n in self.rows])
            power = monomial(self.like) ** k
            for value, c in zip(step, self.frame.dependent, strict=True):
                path[c] = path[c] - Series(power * value, order)
        point, at = self._evaluate(path, order)
        return Curve(self.ring, path, point, at)

    def _evaluate(self, path: Sequence[Series], order: int) -> tuple[SeriesPoint, list[Series]]:
        """Return (the point whose symbols are series, the values of the program there)."""
        moved = {c: path[i].truncated(order) for i, c in enumerate(self.columns) if c >= 0}
        point = SeriesPoint(self.base, moved, order, self.like)
        return point, values(self.ring, point)

    def slopes(self, curve: Curve, functions: Sequence[int]) -> list[list[Series]]:
        """Return the derivatives by the free columns of ``functions`` on the manifold, along a curve.

        df/d(free) = f_free - l B, with the multipliers l A = f_dep for the rows (A, B) of the independent relations.
        """
        dependent = [self.columns[c] for c in self.frame.dependent]
        free = [self.columns[c] for c in self.frame.free]
        rows = curve.slopes(self.rows, dependent + free)
        ambient = curve.slopes(functions, dependent + free)
        r = len(dependent)
        a = [[row[c] for row in rows] for c in range(r)]
        multipliers = solve(a, [[f[c] for f in ambient] for c in range(r)]) if r else []
        restricted = []
        for i, f in enumerate(ambient):
            line = list(f[r:])
            for k, row in enumerate(rows):
                line = [v - multipliers[k][i] * row[r + j] for j, v in enumerate(line)]
            restricted.append(line)
        return restricted

    def quadratic_forms(self) -> list[Form]:
        """Return, for each dependent relation, the matrix of its second-order part in the free columns."""
        m = self.dimension
        zero, unity = self.sample, self.sample + 1
        unit = [[unity if i == j else zero for j in range(m)] for i in range(m)]
        alone = [self._second(u) for u in unit]
        forms = [[[zero] * m for _ in range(m)] for _ in self.others]
        for i in range(m):
            for j in range(i + 1):
                both = alone[i] if i == j else self._second([a + b for a, b in zip(unit[i], unit[j], strict=True)])
                for k in range(len(self.others)):
                    value = both[k] if i == j else (both[k] - alone[i][k] - alone[j][k]) / 2
                    forms[k][i][j] = forms[k][j][i] = value
        return forms

    def _second(self, direction: Sequence[Scalar]) -> list[Scalar]:
        return [s.coefficient(2) for s in self.follow(direction, 3)]


@raising_no_value
def inverse(rows: list[list[Scalar]]) -> Any:
    """Return the inverse of a square matrix of balls, or its elimination over GF(p); raises PoleError."""
    if not rows:
        return None
    if isinstance(rows[0][0], Residue):
        return factored([{c: int(v) for c, v in enumerate(row) if v != 0} for row in rows], modulus(rows[0][0]))
    return arb_mat(rows).inv()


def product(matrix: Any, vector: Sequence[Scalar]) -> list[Scalar]:
    """Return the product of an inverse (a matrix, or the elimination of its inverse) with a vector."""
    if isinstance(matrix, Reduction):
        return [residue(v, matrix.p) for v in matrix.solved([int(v) for v in vector])]
    image = matrix * arb_mat([[v] for v in vector])
    return [image[i, 0] for i in range(len(vector))]


# The critical set N of dependent relations


@dataclass(frozen=True)
class Split:
    """The manifold N in M on which some gradients of the dependent relations f_1, ..., f_k vanish.

    Independent rows of the Hessians of the f_i give ``equations`` df_i/dx_j = 0, as pairs (i, j), which can be solved
    for as many coordinates of M (``solved``, the others are ``free``). Their solutions are N, tangent to the common
    kernel. If all f_i vanish on N, it is a branch of the set on which every pose is singular. For k = 1, N is the
    critical set of the splitting lemma [GromollMeyer1969].
    """

    equations: tuple[tuple[int, int], ...]
    solved: tuple[int, ...]
    free: tuple[int, ...]


def split(forms: Sequence[Form]) -> Split:
    """Return a choice of equations, and of coordinates for which they can be solved, from forms over GF(p)."""
    m = len(forms[0])
    rows = [(i, j) for i in range(len(forms)) for j in range(m)]
    frame = field_frame([forms[i][j] for i, j in rows], m, modulus(forms[0][0][0]))
    return Split(tuple(rows[a] for a in frame.rows), frame.dependent, frame.free)


def series_on_critical(
    manifold: Manifold, forms: Sequence[Form], critical: Split, direction: Sequence[Scalar], order: int
) -> list[Series]:
    """Return the dependent relations along the curve of N whose free coordinates are start + s direction."""
    frame = manifold.frame
    path = [Series(manifold.like + manifold.start[c], order) for c in frame.free]
    step = monomial(manifold.like)
    for value, c in zip(direction, critical.free, strict=True):
        path[c] = path[c] + Series(step * value, order)
    hessian = [[forms[i][j][c] * 2 for c in critical.solved] for i, j in critical.equations]
    inverse_hessian = inverse(hessian)
    used = sorted({i for i, _ in critical.equations})
    place = {i: a for a, i in enumerate(used)}
    for k in range(1, order if critical.solved else 1):
        curve = manifold.curve([s.truncated(k + 1) for s in path], k + 1)
        slopes = manifold.slopes(curve, [manifold.others[i] for i in used])
        gradient_terms = [slopes[place[i]][j].coefficient(k) for i, j in critical.equations]
        for value, c in zip(product(inverse_hessian, gradient_terms), critical.solved, strict=True):
            path[c] = path[c] - Series(step**k * value, order)
    curve = manifold.curve(path, order)
    return [curve.at[n] for n in manifold.others]
