"""First integrals as combinations of products: their differentials are held against D at points over GF(p)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations_with_replacement
from math import isqrt
from typing import Any

from flint import nmod, nmod_mat

from dofkit.base.deadline import check
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.points.frames import field_frame, kernel
from dofkit.exact.points.series import RandomCurve
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.chart import free_point

#: Products of up to so many functions, and so many products at most.
MAX_DEGREE, MAX_PRODUCTS = 3, 170
#: Functions that occur in the products.
MAX_FUNCTIONS = 12
#: Fresh points at which an integral is checked where the minors are not written out.
CHECKS = 4
#: Equations more than unknowns; curves that are tried, and where their seeds begin.
SPARE, CURVES, CURVE_SEED = 6, 4, 30_000

Monomial = tuple[int, ...]
#: The number of the step that made a product (below 0: none), and the function that it is multiplied by.
Step = tuple[int, int]


class IntegralSearch:
    """The functions of some forms that are constant along D = ker I, looked for among products of what occurs in them.

    At points over GF(p) on the finite relations the differentials of the products are held against D.
    """

    def __init__(self, forms: Codistribution, seed: int) -> None:
        forms = self.forms = _with_all_symbols(forms)
        self.seed, chart = seed, forms.chart
        self.ring = chart.ring
        self.functions = [v.index for v in self.ring.vars if v.kind not in ("sign", "pi")][:MAX_FUNCTIONS]
        self.constant = {i for i in self.functions if not _moves(self.ring.var_expr[i])}
        self.solver = TriangularSolver(self.ring, list(chart.nodes), seed=seed) if chart.nodes else None
        self.points: list[FormSample] = []
        self._rates: dict[int, ProductRates] = {}
        self._drawn = 0
        self._places: dict[Monomial, int] = {}
        self._steps: list[Step] = []

    def monomials(self, degree: int) -> list[Monomial]:
        """Products of up to ``degree`` functions that move, simple ones first; sines occur once (sin^2 = 1 - cos^2)."""
        found = []
        for size in range(1, degree + 1):
            for m in combinations_with_replacement(self.functions, size):
                once = all(m.count(i) == 1 for i in set(m) if self.ring.vars[i].kind in ("sin", "root"))
                if once and any(i not in self.constant for i in m):
                    found.append(m)
                if len(found) > MAX_PRODUCTS:
                    return found
        return sorted(found, key=lambda m: (len(m), sum(self.ring.vars[i].kind != "symbol" for i in m), m))

    def candidates(self, monomials: Sequence[Monomial]) -> Iterator[Expr]:
        """Combinations that are constant along D, the simplest first."""
        first = self.sample()
        if first is None:
            return
        if self.solver is not None:
            monomials = self._distinct(monomials)
        equations = self._along_curve(monomials, first) or self._at_points(monomials)
        if equations is None:
            return
        for weights in _simplest_first(equations):
            written = self._written(monomials, weights, first.p)
            if written is not None:
                yield written

    def _distinct(self, monomials: Sequence[Monomial]) -> list[Monomial]:
        """Of products that are one function on the finite relations the simplest; those that move nowhere are left out.

        Where theta = alpha, theta x is alpha x: it makes no integral that alpha x does not make. Functions are told
        apart at as many points as there are equations for the products that are left.
        """
        while True:
            like = self._likeness()
            found: dict[Monomial, Monomial] = {}
            for m in monomials:
                key = tuple(sorted([like[i] for i in m]))
                if any(i not in self.constant for i in key):
                    found.setdefault(key, m)
            if self._sample(len(found) + SPARE - 1) is None or self._likeness() == like:
                return list(found.values())

    def _likeness(self) -> dict[int, int]:
        """For every function the first that has its value at all points, before others one that is constant."""
        first: dict[tuple[int, ...], int] = {}
        for i in sorted(self.functions, key=lambda i: i not in self.constant):
            first.setdefault(self._values_of(i), i)
        return {i: first[self._values_of(i)] for i in self.functions}

    def _values_of(self, function: int) -> tuple[int, ...]:
        return tuple([int(sample.at[function]) for sample in self.points])

    def _at_points(self, monomials: Sequence[Monomial]) -> nmod_mat | None:
        """The slopes of the products at points, each a column; None where there are not enough points."""
        equations: list[list[Any]] = []
        places = [self._place(m) for m in monomials]
        while len(equations) < len(monomials) + SPARE:
            sample = self._sample(len(equations))
            if sample is None:
                return None
            rates = self._rates.get(id(sample))
            if rates is None:
                rates = self._rates[id(sample)] = ProductRates(sample)
            equations += [[along[k] for k in places] for along in rates.of(self._steps)]
        return nmod_mat(len(equations), len(places), [e for row in equations for e in row], self.points[0].p)

    def _place(self, m: Monomial) -> int:
        """The number of the step that makes a product out of a shorter one, which is made before."""
        found = self._places.get(m)
        if found is None:
            before = self._place(m[:-1]) if m[:-1] else -1
            found = self._places[m] = len(self._steps)
            self._steps.append((before, m[-1]))
        return found

    def _along_curve(self, monomials: Sequence[Monomial], first: FormSample) -> nmod_mat | None:
        """The same as series along one random curve; None where finite relations hold, on which no curve is drawn."""
        if self.solver is not None:
            return None
        order = -(-(len(monomials) + SPARE) // len(first.basis))
        for attempt in range(CURVES):
            base = field_point([self.ring], CURVE_SEED + 3 * (self.seed + attempt))
            sample = _sample_at(self.forms, RandomCurve(base, order)) if base.p == first.p else None
            if sample is not None and len(sample.basis) == len(first.basis):
                places = [self._place(m) for m in monomials]
                return _coefficients(ProductRates(sample).of(self._steps), places, order, sample.p)
        return None

    def sample(self) -> FormSample | None:
        """A point."""
        return self._sample(0)

    def slope(self, f: Expr, sample: FormSample, v: Sequence[Any]) -> Any:
        """df on a vector at a point."""
        g = self._gradient(f, sample)
        return sum((g[c] * v[i] for i, c in enumerate(self.forms.chart.columns) if c in g), sample.one * 0)

    def _gradient(self, f: Expr, sample: FormSample) -> dict[int, Any]:
        node = self.ring.node(f)
        return gradient(self.ring, values(self.ring, sample.point), sample.point, [(node, sample.one)])

    def adds(self, f: Expr, known: Sequence[Expr]) -> bool:
        """Is df independent of the finite relations and of the integrals that are known?"""
        sample = self.points[0]
        rows = [list(r) for r in sample.matrix[: self.forms.finite]]
        for e in (*known, f):
            g = self._gradient(e, sample)
            rows.append([g.get(c, sample.one * 0) for c in self.forms.chart.columns])
        return rank_of(rows, sample.p) > rank_of(rows[:-1], sample.p)

    def _sample(self, used: int) -> FormSample | None:
        """One more point, all modulo one prime."""
        width = len(self.points[0].basis) if self.points else 1
        number = used // max(1, width)
        while len(self.points) <= number:
            check()
            self._drawn += 1
            if self._drawn > 4 * MAX_PRODUCTS:
                return None
            sample = _sample_at(self.forms, self._point(3 * (self.seed + self._drawn)))
            if sample is not None and sample.basis and (not self.points or sample.p == self.points[0].p):
                self.points.append(sample)
            elif sample is not None and not sample.basis:
                return None
        return self.points[number]

    def _point(self, seed: int) -> FieldPoint | None:
        return free_point(self.forms.chart, seed) if self.solver is None else self.solver.draw(seed)

    def _written(self, monomials: Sequence[Monomial], weights: Sequence[Any], p: int) -> Expr | None:
        """The combination with the small fractions that the weights are modulo p; None where one is none."""
        terms = []
        for m, weight in zip(monomials, weights, strict=True):
            if weight:
                c = _rational(int(weight), p)
                if c is None:
                    return None
                terms.append(ex.mul(ex.num(c), *(self.ring.var_expr[i] for i in m)))
        return ex.add(*terms)

    def holds(self, f: Expr) -> bool:
        """Is X f = 0 for D at fresh points, modulo other primes?"""
        held = 0
        for k in range(6 * CHECKS):
            sample = _sample_at(self.forms, self._point(7000 + k))
            if sample is None:
                continue
            if any(self.slope(f, sample, v) != 0 for v in sample.basis):
                return False
            held += 1
            if held == CHECKS:
                return True
        return False


@dataclass(frozen=True)
class FormSample:
    """A point, or a curve, with the functions' values and gradients there, by column, and a basis of D."""

    point: FieldPoint | RandomCurve
    p: int
    one: Any
    at: list[Any]
    gradients: dict[int, dict[int, Any]]
    basis: list[list[Any]]
    matrix: list[list[Any]]

    def across(self, row: int) -> list[Any] | None:
        """A velocity that only ``row`` forbids; None where the row depends on the others."""
        others = [r for i, r in enumerate(self.matrix) if i != row]
        n = len(self.matrix[row])
        frame = field_frame(others, n, self.p)
        vectors = kernel(others, frame, self.one * 0) if others else _unit(n, self.one)
        for v in vectors:
            if sum((a * b for a, b in zip(self.matrix[row], v, strict=True)), self.one * 0) != 0:
                return v
        return None


class ProductRates:
    """The values of products at a point, or along a curve, and their rates along every vector of a basis of D."""

    def __init__(self, sample: FormSample) -> None:
        zero = sample.one * 0
        self._at = sample.at
        self._own = [
            {i: sum((a * v[c] for c, a in g.items()), zero) for i, g in sample.gradients.items()} for v in sample.basis
        ]
        self._values: list[Any] = []
        self._rates: list[list[Any]] = [[] for _ in sample.basis]

    def of(self, steps: Sequence[Step]) -> list[list[Any]]:
        """Of each vector the rate of what each step makes: (f g)' = f' g + f g'; what is known is not made again."""
        at, values, new = self._at, self._values, steps[len(self._values) :]
        for before, last in new:
            values.append(at[last] if before < 0 else values[before] * at[last])
        for own, rates in zip(self._own, self._rates, strict=True):
            for before, last in new:
                rate = own[last]
                rates.append(rate if before < 0 else rates[before] * at[last] + values[before] * rate)
        return self._rates


def _coefficients(rates: Sequence[Sequence[Any]], places: Sequence[int], order: int, p: int) -> nmod_mat:
    """Rates along a curve: of every coefficient of the series a row, of every product a column."""
    columns: list[list[Any]] = [[] for _ in places]
    for along in rates:
        for column, k in zip(columns, places, strict=True):
            found = along[k].poly.coeffs()
            column += found + [0] * (order - len(found))
    return nmod_mat(columns, p).transpose()


def _with_all_symbols(forms: Codistribution) -> Codistribution:
    """The same with a function for every column, those that no coefficient mentions included."""
    ring = forms.chart.ring
    for s in forms.chart.symbols:
        ring.node(s)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in forms.chart.symbols)
    chart = replace(forms.chart, columns=columns)
    return Codistribution(chart, replace(forms.rows, columns=columns), forms.finite)


def _unit(n: int, one: Any) -> list[list[Any]]:
    return [[one if i == j else one * 0 for j in range(n)] for i in range(n)]


def _moves(e: Expr) -> bool:
    return any(s.args[0] in ("coordinate", "time") for s in e.symbols)


def _sample_at(forms: Codistribution, point: FieldPoint | RandomCurve | None) -> FormSample | None:
    if point is None:
        return None
    ring, columns = forms.chart.ring, forms.chart.columns
    p = point.base.p if isinstance(point, RandomCurve) else point.p
    try:
        at = values(ring, point)
        one = point.number(Fraction(1))
        matrix = forms.rows.matrix(at, one * 0)
        heads = [[v.coefficient(0) for v in row] for row in matrix] if isinstance(point, RandomCurve) else matrix
        frame = field_frame(heads, len(columns), p)
        basis = kernel(matrix, frame, one * 0) if frame.free else []
        gradients, moving = {}, {ring.var_node[c] for c in columns if c >= 0}
        for v, node in zip(ring.vars, ring.var_node, strict=True):
            g = {v.index: one} if v.kind == "symbol" else {}
            if not (g or moving.isdisjoint(ring.order((node,)))):
                g = gradient(ring, at, point, [(node, one)])
            gradients[v.index] = {place: g[c] for place, c in enumerate(columns) if c in g}
        at_vars = [at[ring.var_node[v.index]] for v in ring.vars]
    except NoValueError:
        return None
    return FormSample(point, p, one, at_vars, gradients, basis, matrix)


def _simplest_first(equations: nmod_mat) -> Iterator[list[nmod]]:
    """A basis of the null space by its last monomial, the simplest first.

    Monomials, which are the columns, run from simple to hard; each that depends on those before it is a vector's last.
    """
    reduced, rank = equations.rref()
    rows, kept = reduced.table()[:rank], list[int]()
    zero, one = nmod(0, equations.modulus()), nmod(1, equations.modulus())
    for column in range(equations.ncols()):
        if len(kept) < rank and rows[len(kept)][column]:
            kept.append(column)
            continue
        weights = [zero] * equations.ncols()
        weights[column] = one
        for row, pivot in zip(rows, kept, strict=False):
            weights[pivot] = -row[column]
        yield weights


def _rational(value: int, p: int) -> Fraction | None:
    """The fraction with small terms that is ``value`` modulo p [Wang1981]; None where there is none."""
    bound = isqrt(p // 2)
    r0, r1, t0, t1 = p, value % p, 0, 1
    while r1 > bound:
        q = r0 // r1
        r0, r1, t0, t1 = r1, r0 - q * r1, t1, t0 - q * t1
    if t1 == 0 or abs(t1) > bound or r1 > 1 << 20 or abs(t1) > 1 << 20:
        return None
    return Fraction(r1, t1)
