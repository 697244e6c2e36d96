"""The growth vector of D = ker I: dimensions of D_1 = D and D_{k+1} = D_k + [D, D_k] at a generic point.

Let B be a frame of D. Along a curve of a random field X in D the brackets ad_X^j B, j < k, span a subspace S_k of D_k.
It is tested whether S_k = D_k: if D_j = S_j for j <= k near the point, then D_{k+1} = S_k + [D, ad_X^(k-1) B], because
the brackets with ad_X^j B, j < k - 1, are in D_k already; so S_{k+1} = D_{k+1} if and only if [b, ad_X^(k-1) B] is in
S_{k+1} for a random field b in D. Its derivative transversal to the curve is a variation of the curve, computed with
dual numbers. If one curve is not sufficient, S_k is the span of the brackets of several.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, rank_over
from dofkit.exact.points.series import Series, SeriesPoint
from dofkit.exact.ring.program import Scalar, Var, gradient, partials, values
from dofkit.integrability.lie_algebra import (
    AdmissibleCurve,
    Matrix,
    MatrixSeries,
    Span,
    columns_of,
    product_coefficient,
    some_columns,
)

#: Bound on the number of curves.
MAX_CURVES = 24


class Dual:
    """The dual number re + e du with e^2 = 0, for series ``re`` and ``du`` along the curve; None for du = 0."""

    __slots__ = ("du", "re")

    def __init__(self, re: Series, du: Series | None) -> None:
        self.re = re
        self.du = du

    def __add__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.re + other, self.du)
        if self.du is None or other.du is None:
            return Dual(self.re + other.re, self.du or other.du)
        return Dual(self.re + other.re, self.du + other.du)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.re, None if self.du is None else -self.du)

    def __mul__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.re * other, None if self.du is None else self.du * other)
        first = None if self.du is None else self.du * other.re
        right = None if other.du is None else self.re * other.du
        return Dual(self.re * other.re, first if right is None else right if first is None else first + right)

    __rmul__ = __mul__

    def __pow__(self, n: int) -> Dual:
        total: Dual = self
        for _ in range(n - 1):
            total = total * self
        return total

    def inverse(self) -> Dual:
        """Return 1/(f + e g) = 1/f - e g/f^2."""
        below = self.re.inverse()
        return Dual(below, None if self.du is None else -(self.du * below * below))

    def __truediv__(self, other: Any) -> Dual:
        inverse: Dual = other.inverse()
        return self * inverse

    def __rtruediv__(self, other: Any) -> Dual:
        below: Dual = self.inverse()
        return below.__mul__(other)


@dataclass(frozen=True)
class DualPoint:
    """A curve with the variation of ``symbols`` (series by generator); that of others is by the chain rule."""

    point: SeriesPoint
    flow: AdmissibleCurve
    symbols: Mapping[int, Series]

    def number(self, value: Any) -> Dual:
        return Dual(self.point.number(value), None)

    def generator(self, var: Var, args: Sequence[Dual]) -> Dual:
        if var.kind == "symbol":
            return Dual(self.point.generator(var, ()), self.symbols.get(var.index))
        plain = [a.re for a in args]
        at = self.flow.at
        value = at[self.flow.rows.ring.var_node[var.index]] if var.index >= 0 else self.point.generator(var, plain)
        total: Series | None = None
        for (_, slope), argument in zip(self._slopes(var, plain), args, strict=False):
            if argument.du is not None:
                term = argument.du * slope
                total = term if total is None else total + term
        return Dual(value, total)

    def _slopes(self, var: Var, plain: Sequence[Series]) -> list[tuple[int, Series]]:
        """Return (argument, derivative of the generator by it), as series."""
        if var.index >= 0:
            return partials(self.flow.rows.ring, var, self.flow.at, self.point)
        name, orders, key = var.key
        slopes = []
        for i in range(len(plain)):
            raised = tuple(o + (i == j) for j, o in enumerate(orders))
            slopes.append((i, self.point.generator(Var(-1, "call", (name, raised, key), var.args), plain)))
        return slopes


@dataclass(frozen=True)
class Variation:
    """Derivatives at the curve's point for a random field b = sum beta_l B_l with constant beta.

    ``coefficients[k]`` is (b . grad) V_k, a matrix (columns, fields), V_k as in `AdmissibleCurve`; ``slope`` is grad b.
    """

    coefficients: MatrixSeries
    slope: Matrix

    def bracket(self, flow: AdmissibleCurve, k: int) -> Matrix:
        """Return [b, V_k] = (b . grad) V_k - (grad b) V_k at the point."""
        return self.coefficients[k] - self.slope * flow.pulled[k]


def variation(flow: AdmissibleCurve) -> Variation:
    """Return the variation of a curve for a random field in D."""
    start = flow.full_frame[0] * random_column(flow, len(flow.frame.free))
    return Variation(varied_frame(flow, start), _slope(flow, start))


def random_column(flow: AdmissibleCurve, size: int) -> Matrix:
    """Return a column of random numbers."""
    return flow.numbers.matrix(size, 1, [flow.base.number(flow.base.rng.randrange(1, 1 << 12)) for _ in range(size)])


def varied_frame(flow: AdmissibleCurve, start: Matrix) -> MatrixSeries:
    """Return (start . grad) V_k at the point for all k: the derivative by the curve's starting point, same controls."""
    numbers, order = flow.numbers, flow.order
    moved = _path_variation(flow, start)
    series = [Series(numbers.polynomial([m[i, 0] for m in moved]), order) for i in range(len(flow.path))]
    point = DualPoint(flow.point, flow, {c: series[i] for i, c in enumerate(flow.rows.columns) if c >= 0})
    at = values(flow.rows.ring, point)
    return _frame_variation(flow, at, point, series)


def _path_variation(flow: AdmissibleCurve, start: Matrix) -> MatrixSeries:
    """Return the variation eta of the path, with eta' = S eta."""
    moved = [start]
    for k in range(flow.order):
        moved.append(product_coefficient(flow.full_slope, moved, k) * (1 / flow.base.number(k + 1)))
    return moved


def _frame_variation(flow: AdmissibleCurve, at: list[Any], point: DualPoint, moved: list[Series]) -> MatrixSeries:
    """Return the variation of V = Psi B, given that of the path (``moved``) and of the program's values (``at``)."""
    n, order, frame = len(flow.path), flow.order, flow.frame
    ring = flow.rows.ring
    velocity = [Dual(v, m.derivative()) for v, m in zip(flow.velocities(), moved, strict=True)]
    slopes = [gradient(ring, at, point, [(node, velocity[c]) for c, node in row.items()]) for row in flow.frame_rows]
    first = flow.by_coefficient(
        [[g[c].du if c >= 0 and c in g else None for c in flow.rows.columns] for g in slopes], n
    )
    rows = flow.by_coefficient([[at[row[c]].du if c in row else None for c in range(n)] for row in flow.frame_rows], n)
    of_dependent = [some_columns(m, frame.dependent, flow.numbers) for m in rows]
    slope = flow.dependent_series(lambda k: -(first[k] + product_coefficient(of_dependent, flow.slope, k)), order)
    frames = flow.dependent_series(lambda k: -product_coefficient(rows, flow.full_frame, k), order)
    full_slope, full_frame = ([flow.over_all_columns(m, None) for m in series] for series in (slope, frames))
    back = [flow.back[0] * (flow.sample * 0)]
    for k in range(order - 1):
        total = product_coefficient(back, flow.full_slope, k) + product_coefficient(flow.back, full_slope, k)
        back.append(total * (-1 / flow.base.number(k + 1)))
    return [
        product_coefficient(back, flow.full_frame, k) + product_coefficient(flow.back, full_frame, k)
        for k in range(order)
    ]


def _slope(flow: AdmissibleCurve, direction: Matrix) -> Matrix:
    """Return grad b at the point for the field b = sum beta_l B_l with constant beta: A_d grad b_d = -grad(A b)."""
    rows, base = flow.rows, flow.base
    at = values(rows.ring, base)
    gradients = [
        gradient(rows.ring, at, base, [(node, direction[c, 0]) for c, node in row.items()]) for row in flow.frame_rows
    ]
    zero, n = flow.sample * 0, len(flow.path)
    right = flow.numbers.matrix(
        len(gradients), n, [g.get(c, zero) if c >= 0 else zero for g in gradients for c in rows.columns]
    )
    return flow.over_all_columns(-(flow.inverse * right), None)


def spanning_curves(
    rows: FormRows, frame: Pivots, base: Any, span: Span
) -> tuple[list[AdmissibleCurve], tuple[int, ...] | None]:
    """Return curves whose S_k together span D_k, and the dimensions of all D_k, or None if some D_k is not reached."""
    full = span.dimension
    curves: list[tuple[AdmissibleCurve, Variation]] = []
    rounds_without_gain = 0
    dimensions: tuple[int, ...] = ()
    flows_before = [] if span.flow is None else [span.flow]
    for _ in range(MAX_CURVES):
        flow = flows_before.pop() if flows_before else AdmissibleCurve(rows, frame, base)
        flow.follow(span.dimensions.index(full) + 2)
        curves.append((flow, variation(flow)))
        before, dimensions = dimensions, _dimensions([f for f, _ in curves], full)
        if _are_sufficient(curves, dimensions, full):
            return [f for f, _ in curves], dimensions
        rounds_without_gain = rounds_without_gain + 1 if dimensions == before else 0
        if rounds_without_gain == 2:
            break
    return [f for f, _ in curves], None


def _dimensions(flows: Sequence[AdmissibleCurve], terminal: int | None = None) -> tuple[int, ...]:
    """Return the dimensions of S_1, S_2, ..., up to the dimension ``terminal`` of the Lie algebra, if it is known."""
    vectors: list[tuple[Scalar, ...]] = []
    dimensions: list[int] = []
    for k in range(min(f.order for f in flows)):
        vectors += [v for f in flows for v in columns_of(f.pulled[k])]
        dimensions.append(rank_over(vectors, flows[0].sample))
        if dimensions[-1] == terminal:
            break
    return tuple(dimensions)


def _are_sufficient(
    curves: Sequence[tuple[AdmissibleCurve, Variation]], dimensions: Sequence[int], terminal: int
) -> bool:
    """Return whether S_k = D_k for all k, and the last dimension is that of the Lie algebra (``terminal``).

    For every k the brackets of a random field in D with the V_{k-1} of each curve have to be in S_{k+1}.
    """
    flows = [f for f, _ in curves]
    vectors = [v for f in flows for v in columns_of(f.pulled[0])]
    for k in range(1, len(dimensions)):
        vectors += [v for f in flows for v in columns_of(f.pulled[k])]
        brackets = [v for f, w in curves for v in columns_of(w.bracket(f, k - 1))]
        if rank_over([*vectors, *brackets], flows[0].sample) > dimensions[k]:
            return False
    return dimensions[-1] == terminal


#: Bounds on the length of brackets, and on the number of curves, at a point that is not generic.
LONGEST, CURVES = 5, 12


def growth_at(rows: FormRows, frame: Pivots, point: FieldPoint, largest: int) -> tuple[int, ...]:
    """Return the certain dimensions of D, D + [D, D], ... at a point that need not be generic.

    The values of ad_X^k B for many X span all brackets of length k + 1 up to length 3, and up to length 4 for two
    fields (there the multilinear part of the free Lie algebra is generated by such elements). Longer brackets are
    certain only if the dimension reaches that at generic points (``largest``).
    """
    certain = 4 if len(frame.free) == 2 else 3
    flows: list[AdmissibleCurve] = []
    dimensions: tuple[int, ...] = ()
    rounds_without_gain = 0
    while rounds_without_gain < 2 and len(flows) < CURVES:
        flows.append(AdmissibleCurve(rows, frame, point))
        flows[-1].follow(LONGEST)
        before, dimensions = dimensions, _dimensions(flows)
        rounds_without_gain = rounds_without_gain + 1 if dimensions == before else 0
    reached = next((k + 1 for k, d in enumerate(dimensions) if d == largest), LONGEST + 1)
    return dimensions[: reached if reached <= certain + 1 else certain]


def derived_flag(rows: FormRows, frame: Pivots, base: Any, span: Span) -> tuple[int, ...] | None:
    """Return the ranks of I, I', I'', ... down to the largest integrable part; None if they are not certain.

    I' consists of the forms of I whose differential is 0 modulo I, so that it annihilates D + [D, D], and so on with
    D^(j+1) = D^(j) + [D^(j), D^(j)]: brackets of random fields of D^(j) are added until they add nothing.
    """
    n, terminal = len(rows.columns), span.dimension
    if span.flow is None or not frame.rows or len(frame.free) == terminal:
        return (n - len(frame.free),)
    flows, dimensions = spanning_curves(rows, frame, base, span)
    if dimensions is None:
        return None
    flag, step = [dimensions[0]], 1
    while flag[-1] < terminal:
        larger = _derived(flows, dimensions, step)
        if larger is None:
            return None
        flag.append(larger)
        step = dimensions.index(larger) + 1
    return tuple(n - d for d in flag)


def _derived(flows: Sequence[AdmissibleCurve], dimensions: Sequence[int], step: int) -> int | None:
    """Return the dimension of S_step + [S_step, S_step]; None if this is not one of the later S_k."""
    if step == 1:
        return dimensions[1]
    layers = [[v for f in flows for v in columns_of(f.pulled[k])] for k in range(len(dimensions))]
    vectors = [v for layer in layers[: step + 1] for v in layer]
    sample = flows[0].sample
    larger = rank_over(vectors, sample)
    while larger < dimensions[-1]:
        vectors.append(_random_bracket(flows, step))
        before, larger = larger, rank_over(vectors, sample)
        if larger == before:
            break
    if larger not in dimensions:
        return None
    within = [v for layer in layers[: dimensions.index(larger) + 1] for v in layer]
    return larger if rank_over([*vectors, *within], sample) == larger else None


def _random_bracket(flows: Sequence[AdmissibleCurve], step: int) -> tuple[Scalar, ...]:
    """Return the bracket [Y, Z] at the point of two random fields of S_k, k = ``step``: brackets of up to k factors."""
    weights = [[[random_column(f, f.pulled[k].ncols()) for k in range(step)] for f in flows] for _ in range(2)]
    fields = [_combined([f.pulled for f in flows], w) for w in weights]
    derivatives = [_combined([varied_frame(f, fields[1 - i]) for f in flows], weights[i]) for i in range(2)]
    return columns_of(derivatives[1] - derivatives[0])[0]


def _combined(series: Sequence[MatrixSeries], weights: Sequence[Sequence[Matrix]]) -> Matrix:
    """Return the sum of the coefficients of all series, each times its weight; those without a weight are left out."""
    total = None
    for layers, factors in zip(series, weights, strict=True):
        for layer, w in zip(layers, factors, strict=False):
            total = layer * w if total is None else total + layer * w
    return total
