"""First integrals of a system of forms: functions f with df in the span I of its rows.

f is a combination of few products of the block's own functions (coordinates, sines, exponentials, parameters) with
rational coefficients. X f = 0 for every X in D = ker I is linear in the coefficients; it is imposed along one random
curve over GF(p), or at random points on the geometric equations, and the coefficients are reconstructed as rationals.
An integral is returned only after a test: the bordered minors of df and the rows are 0 in the canonical ring (modulo a
geometric equation, if there is one), or, if these are too large or there are several equations, at new points modulo
other primes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations_with_replacement

from dofkit.base.deadline import check
from dofkit.configuration.variety import pose_point
from dofkit.exact.matrices.rational import reconstructed
from dofkit.exact.matrices.sparse import Pivots, rank_of
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame, kernel, pairing
from dofkit.exact.points.series import Series, SeriesPoint
from dofkit.exact.residues import Residue, null_vectors, residue_matrix, residue_polynomial
from dofkit.exact.ring.program import Scalar, gradient, none_without_value, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.bordered_minors import BorderedMinors
from dofkit.integrability.integrals.writing import arranged, upright
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.normal.semidefinite import fraction

#: Bounds on the factors of a product, on the number of products, and on the functions in them.
MAX_DEGREE, MAX_PRODUCTS, MAX_FUNCTIONS = 3, 170, 12
#: Number of equations beyond that of unknowns; new points at which an integral is tested without minors.
SPARE, CHECKS = 6, 4
#: Bound on numerators and denominators of coefficients.
LARGEST = 1 << 20

Monomial = tuple[int, ...]


@dataclass(frozen=True)
class FirstIntegral:
    """A function constant along all motions; ``identically``: this is proved in the canonical ring."""

    expr: Expr
    identically: bool


def first_integrals(forms: Codistribution, number: int) -> list[FirstIntegral]:
    """Return up to ``number`` first integrals, independent of each other and of geometric equations, simplest first."""
    search = IntegralSearch(forms)
    integrals: list[FirstIntegral] = []
    bordered: BorderedMinors | None = None
    for degree in range(1, MAX_DEGREE + 1):
        monomials = search.monomials(degree)
        if len(monomials) > MAX_PRODUCTS or len(integrals) >= number:
            break
        for f in search.candidates(monomials):
            if search.is_independent(f, [k.expr for k in integrals]):
                bordered = bordered or BorderedMinors(search.forms, search.points[0].frame)
                identical = bordered.vanish(f)
                if identical or (identical is None and search.is_constant(f)):
                    integrals.append(FirstIntegral(arranged(upright(f)), bool(identical)))
                if len(integrals) == number:
                    return integrals
    return integrals


@dataclass(frozen=True)
class FormSample:
    """Values at a point over GF(p) or along a curve: of functions (``at``), their gradients, a basis of D, and rows."""

    point: FieldPoint
    frame: Pivots
    at: list[Scalar]
    gradients: list[dict[int, Scalar]]
    basis: list[list[Scalar]]
    matrix: list[list[Scalar]]
    _products: dict[Monomial, tuple[Scalar, list[Scalar]]] = field(default_factory=dict)

    def product(self, m: Monomial) -> tuple[Scalar, list[Scalar]]:
        """Return (value of a product of functions, its derivatives along the vectors of the basis)."""
        value_and_rates = self._products.get(m)
        if value_and_rates is None:
            if len(m) > 1:
                (before, slopes), (last, rates) = self.product(m[:-1]), self.product(m[-1:])
                value_and_rates = before * last, [a * last + before * b for a, b in zip(slopes, rates, strict=True)]
            else:
                last, slope = self.at[m[0]], self.gradients[m[0]].items()
                value_and_rates = last, [sum((a * v[c] for c, a in slope), last * 0) for v in self.basis]
            self._products[m] = value_and_rates
        return value_and_rates

    def transversal(self, row: int) -> list[Residue] | None:
        """Return a velocity that all rows except ``row`` allow; None if the row depends on the others."""
        others = [r for i, r in enumerate(self.matrix) if i != row]
        n, unit = len(self.matrix[row]), self.point.number(Fraction(1))
        if others:
            vectors = kernel(others, field_frame(others, n, self.point.p), unit * 0)
        else:
            vectors = [[unit if i == j else unit * 0 for j in range(n)] for i in range(n)]
        return next((v for v in vectors if pairing(self.matrix[row], [v])[0] != 0), None)


class IntegralSearch:
    """The search for functions that are constant along D = ker I, among products of the functions in the forms."""

    def __init__(self, forms: Codistribution) -> None:
        self.forms = _with_all_symbols(forms)
        chart = self.forms.chart
        self.ring = chart.ring
        self.functions = [v.index for v in self.ring.vars if v.kind not in ("sign", "pi")][:MAX_FUNCTIONS]
        self.constant = {i for i in self.functions if not _depends_on_motion(self.ring.var_expr[i])}
        self.solver = TriangularSolver(self.ring, list(chart.nodes)) if chart.nodes else None
        self.points: list[FormSample] = []
        self._attempts = 0

    def monomials(self, degree: int) -> list[Monomial]:
        """Return products of up to ``degree`` functions, simple ones first; a sine at most once (sin^2 = 1 - cos^2)."""
        monomials: list[Monomial] = []
        for size in range(degree + 1):
            for m in combinations_with_replacement(self.functions, size):
                once = all(m.count(i) == 1 for i in set(m) if self.ring.vars[i].kind in ("sin", "root"))
                if once and any(i not in self.constant for i in m):
                    monomials.append(m)
                if len(monomials) > MAX_PRODUCTS:
                    return monomials
        return sorted(monomials, key=lambda m: (len(m), sum(self.ring.vars[i].kind != "symbol" for i in m), m))

    def candidates(self, monomials: Sequence[Monomial]) -> Iterator[Expr]:
        """Yield combinations of products that are constant along D, the simplest first."""
        equations = self._along_curve(monomials) if self.solver is None else []
        number = 0
        while len(equations) < len(monomials) + SPARE:
            sample = self.sample(number)
            if sample is None:
                return
            columns = [sample.product(m)[1] for m in monomials]
            equations += [list(row) for row in zip(*columns, strict=True)]
            number += 1
        p = self.points[0].point.p
        for weights in null_vectors(residue_matrix(equations, p)):  # ordered by their last monomials, simple ones first
            f = self._combination(monomials, weights, p)
            if f is not None:
                yield f

    def _along_curve(self, monomials: Sequence[Monomial]) -> list[list[Residue]]:
        """Return the linear equations X f = 0 for the weights of the products in f, for every X of a basis of D.

        They are coefficients of power series along one random curve; [] if a function has no series there.
        """
        sample = self.sample(0)
        if sample is None:
            return []
        base, p, order = sample.point, sample.point.p, -(-(len(monomials) + SPARE) // len(sample.basis))
        path = {}
        for i in (v.index for v in self.ring.vars if v.kind == "symbol"):  # parameters vary too, as from point to point
            others = [base.rng.randrange(p) for _ in range(1, order)]
            path[i] = Series(residue_polynomial([int(sample.at[i]), *others], p), order)
        curve = _sample_of(self.forms, base, SeriesPoint(base, path, order, residue_polynomial([0], p)), sample.frame)
        if curve is None:
            return []
        rates = [[rate.poly for rate in curve.product(m)[1]] for m in monomials]
        return [[along[i][k] for along in rates] for i in range(len(curve.basis)) for k in range(order)]

    def slope(self, f: Expr, sample: FormSample, v: Sequence[Residue]) -> Scalar:
        """Return df(v) for a vector v at a point."""
        return pairing(self._gradient(f, sample), [v])[0]

    def is_independent(self, f: Expr, integrals: Sequence[Expr]) -> bool:
        """Return whether df is independent of the geometric equations and of the differentials of ``integrals``."""
        sample = self.points[0]
        rows = [list(r) for r in sample.matrix[: self.forms.finite]]
        rows += [self._gradient(e, sample) for e in (*integrals, f)]
        return rank_of(rows, sample.point.p) > rank_of(rows[:-1], sample.point.p)

    def sample(self, number: int) -> FormSample | None:
        """Return the sample with this number, all modulo one prime; None if too few points are found."""
        while len(self.points) <= number:
            check()
            self._attempts += 1
            if self._attempts > 4 * MAX_PRODUCTS:
                return None
            sample = self._sample(3 * self._attempts)
            if sample is not None and not sample.basis:
                return None
            if sample is not None and (not self.points or sample.point.p == self.points[0].point.p):
                self.points.append(sample)
        return self.points[number]

    def is_constant(self, f: Expr) -> bool:
        """Return whether X f = 0 for all X in D at `CHECKS` new points, modulo other primes."""
        checked = 0
        for k in range(6 * CHECKS):
            sample = self._sample(7000 + k)
            if sample is None:
                continue
            if any(v != 0 for v in pairing(self._gradient(f, sample), sample.basis)):
                return False
            checked += 1
            if checked == CHECKS:
                return True
        return False

    def _gradient(self, f: Expr, sample: FormSample) -> list[Residue]:
        node, unit = self.ring.node(f), sample.point.number(Fraction(1))
        g = gradient(self.ring, values(self.ring, sample.point), sample.point, [(node, unit)])
        return [g.get(c, unit * 0) for c in self.forms.chart.columns]

    def _sample(self, seed: int) -> FormSample | None:
        point = pose_point(self.forms.chart, {}, seed) if self.solver is None else self.solver.draw(seed)
        return None if point is None else _sample_of(self.forms, point, point)

    def _combination(self, monomials: Sequence[Monomial], weights: Sequence[Residue], p: int) -> Expr | None:
        """Return the combination with rational coefficients equal to the weights modulo p; None if one is too large."""
        terms = []
        for m, weight in zip(monomials, weights, strict=True):
            if weight:
                c = reconstructed(int(weight), p)
                if max(abs(c.p), c.q) > LARGEST:
                    return None
                terms.append(ex.mul(ex.num(fraction(c)), *(self.ring.var_expr[i] for i in m)))
        return ex.add(*terms)


def _with_all_symbols(forms: Codistribution) -> Codistribution:
    """Return the forms in a chart with a generator for every column, also if no coefficient mentions it."""
    ring = forms.chart.ring
    for s in forms.chart.symbols:
        ring.node(s)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in forms.chart.symbols)
    chart = replace(forms.chart, columns=columns)
    return Codistribution(chart, replace(forms.rows, columns=columns), forms.finite)


def _depends_on_motion(e: Expr) -> bool:
    return any(s.args[0] in ("coordinate", "time") for s in e.symbols)


@none_without_value
def _sample_of(
    forms: Codistribution, base: FieldPoint, point: FieldPoint | SeriesPoint, frame: Pivots | None = None
) -> FormSample | None:
    """Return the sample at ``point``: ``base``, or a curve through it; None if a function has no value or series.

    ``frame``: the pivots of the rows at ``base``, by default of those at ``point``; they give a basis of D.
    """
    ring, columns = forms.chart.ring, forms.chart.columns
    unit = point.number(Fraction(1))
    at = values(ring, point)
    matrix = forms.rows.matrix(at, unit * 0)
    frame = frame or field_frame(matrix, len(columns), base.p)
    basis = kernel(matrix, frame, unit * 0) if frame.free else []
    gradients = []
    for v, node in zip(ring.vars, ring.var_node, strict=True):
        g = gradient(ring, at, point, [(node, unit)]) if _depends_on_motion(ring.var_expr[v.index]) else {}
        gradients.append({i: g[c] for i, c in enumerate(columns) if c in g})
    return FormSample(base, frame, [at[node] for node in ring.var_node], gradients, basis, matrix)


def integral_by_row(forms: Codistribution, integrals: Sequence[FirstIntegral]) -> dict[int, FirstIntegral]:
    """Return {row: an integral that can replace it}: together with the other rows it implies the row.

    f can replace a row if df is not in the span of the other rows. Preferred is an integral that no other row has, then
    one with the most similar symbols.
    """
    search = IntegralSearch(forms)
    sample = search.sample(0) if integrals else None
    if sample is None:
        return {}
    moving, chosen = frozenset(forms.chart.symbols), dict[int, FirstIntegral]()
    for row in range(forms.finite, len(forms.rows.entries)):
        transversal = sample.transversal(row)
        possible = [f for f in integrals if transversal and search.slope(f.expr, sample, transversal) != 0]
        mentioned = {forms.chart.symbols[c] for c in forms.rows.entries[row]}
        cost = {f: (f in chosen.values(), len(mentioned ^ (f.expr.symbols & moving))) for f in possible}
        if possible:
            chosen[row] = min(possible, key=cost.__getitem__)
    return chosen
