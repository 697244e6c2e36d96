"""First integrals of a system of forms: functions f with df in the span I of its rows, found together.

f is a combination of few products of the block's own functions (coordinates, sines, exponentials, parameters) with
rational coefficients. X f = 0 for every X in D = ker I is linear in the coefficients; it is imposed along one random
curve over GF(p), or at random points on the geometric equations, and the solutions are read as rationals. An integral
is returned only if it holds identically: the bordered minors of df under the rows vanish in the canonical ring (modulo
a geometric equation, if there is one), or, where that grows too large or there are several of them, at fresh points
modulo fresh primes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations, combinations_with_replacement

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.configuration.variety import pose_point
from dofkit.exact.matrices.sparse import Pivots, rank_of, reconstructed
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame, kernel, pairing
from dofkit.exact.points.series import Series, SeriesPoint
from dofkit.exact.residues import Residue, null_vectors, residue_matrix, residue_polynomial
from dofkit.exact.ring.canonical import Canon, Poly, determinant, polynomials, remainder
from dofkit.exact.ring.program import Scalar, false_without_value, gradient, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, exterior_derivative
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.search import arranged, upright
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.normal.semidefinite import fraction

#: Products of up to so many functions, so many products, and so many functions in them at most.
MAX_DEGREE, MAX_PRODUCTS, MAX_FUNCTIONS = 3, 170, 12
#: Equations more than unknowns; fresh points at which an integral is checked where the minors are not written out.
SPARE, CHECKS = 6, 4
#: Rows of the bordered minors that are written out; the largest numbers in a coefficient of an integral.
MAX_ROWS, LARGEST = 5, 1 << 20

Monomial = tuple[int, ...]


@dataclass(frozen=True)
class FirstIntegral:
    """f, constant along all motions; ``identically``: proved so in the canonical ring."""

    expr: Expr
    identically: bool


def first_integrals(forms: Codistribution, number: int) -> list[FirstIntegral]:
    """Return up to ``number`` independent f with df in the span of the rows, the simplest first.

    None of them is a consequence of the geometric equations.
    """
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
                if identical or (identical is None and search.holds(f)):
                    integrals.append(FirstIntegral(arranged(upright(f)), bool(identical)))
                if len(integrals) == number:
                    return integrals
    return integrals


@dataclass(frozen=True)
class FormSample:
    """A point over GF(p), or a curve: the functions' values, their gradients by column, a basis of D, and the rows."""

    point: FieldPoint
    frame: Pivots
    at: list[Scalar]
    gradients: list[dict[int, Scalar]]
    basis: list[list[Scalar]]
    matrix: list[list[Scalar]]
    _products: dict[Monomial, tuple[Scalar, list[Scalar]]] = field(default_factory=dict)

    def product(self, m: Monomial) -> tuple[Scalar, list[Scalar]]:
        """Return a product of functions, and its rate along each vector of the basis: (f g)' = f' g + f g'."""
        value_and_rates = self._products.get(m)
        if value_and_rates is None:
            last = self.at[m[-1]]
            rates = [sum((a * v[c] for c, a in self.gradients[m[-1]].items()), last * 0) for v in self.basis]
            value_and_rates = last, rates
            if m[:-1]:
                before, slopes = self.product(m[:-1])
                value_and_rates = before * last, [a * last + before * b for a, b in zip(slopes, rates, strict=True)]
            self._products[m] = value_and_rates
        return value_and_rates

    def across(self, row: int) -> list[Residue] | None:
        """Return a velocity that only ``row`` forbids, or None where the row depends on the others."""
        others = [r for i, r in enumerate(self.matrix) if i != row]
        n, unit = len(self.matrix[row]), self.point.number(Fraction(1))
        if others:
            vectors = kernel(others, field_frame(others, n, self.point.p), unit * 0)
        else:
            vectors = [[unit if i == j else unit * 0 for j in range(n)] for i in range(n)]
        return next((v for v in vectors if pairing(self.matrix[row], [v])[0] != 0), None)


class IntegralSearch:
    """The functions of some forms that are constant along D = ker I, among products of the functions in them."""

    def __init__(self, forms: Codistribution) -> None:
        self.forms = _with_all_symbols(forms)
        chart = self.forms.chart
        self.ring = chart.ring
        self.functions = [v.index for v in self.ring.vars if v.kind not in ("sign", "pi")][:MAX_FUNCTIONS]
        self.constant = {i for i in self.functions if not _moves(self.ring.var_expr[i])}
        self.solver = TriangularSolver(self.ring, list(chart.nodes)) if chart.nodes else None
        self.points: list[FormSample] = []
        self._drawn = 0

    def monomials(self, degree: int) -> list[Monomial]:
        """Return products of up to ``degree`` functions, simple ones first; sines occur once (sin^2 = 1 - cos^2)."""
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
        for weights in null_vectors(residue_matrix(equations, p)):  # each one's last monomial, from simple to hard
            f = self._combination(monomials, weights, p)
            if f is not None:
                yield f

    def _along_curve(self, monomials: Sequence[Monomial]) -> list[list[Residue]]:
        """Return the rates of the products along D as series on one random curve, a row for each coefficient.

        No rows where a function has no series there.
        """
        sample = self.sample(0)
        if sample is None:
            return []
        base, p, order = sample.point, sample.point.p, -(-(len(monomials) + SPARE) // len(sample.basis))
        path = {}
        for i in (v.index for v in self.ring.vars if v.kind == "symbol"):  # parameters vary too, as from point to point
            others = [base.rng.randrange(p) for _ in range(1, order)]
            path[i] = Series(residue_polynomial([int(sample.at[i]), *others], p), order)
        curve = _sample_of(self.forms, base, sample.frame, SeriesPoint(base, path, order, residue_polynomial([0], p)))
        if curve is None:
            return []
        rates = [curve.product(m)[1] for m in monomials]
        return [[along[i].coefficient(k) for along in rates] for i in range(len(curve.basis)) for k in range(order)]

    def slope(self, f: Expr, sample: FormSample, v: Sequence[Residue]) -> Scalar:
        """Return df on a vector at a point."""
        return pairing(self._gradient(f, sample), [v])[0]

    def is_independent(self, f: Expr, integrals: Sequence[Expr]) -> bool:
        """Return whether df is independent of the geometric equations and of the integrals that are known."""
        sample = self.points[0]
        rows = [list(r) for r in sample.matrix[: self.forms.finite]]
        rows += [self._gradient(e, sample) for e in (*integrals, f)]
        return rank_of(rows, sample.point.p) > rank_of(rows[:-1], sample.point.p)

    def sample(self, number: int) -> FormSample | None:
        """Return one of the points, all modulo one prime, or None where so many are not found."""
        while len(self.points) <= number:
            check()
            self._drawn += 1
            if self._drawn > 4 * MAX_PRODUCTS:
                return None
            sample = _sample_at(self.forms, self._point(3 * self._drawn))
            if sample is not None and not sample.basis:
                return None
            if sample is not None and (not self.points or sample.point.p == self.points[0].point.p):
                self.points.append(sample)
        return self.points[number]

    def holds(self, f: Expr) -> bool:
        """Return whether X f = 0 for D at fresh points, modulo other primes."""
        checked = 0
        for k in range(6 * CHECKS):
            sample = _sample_at(self.forms, self._point(7000 + k))
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

    def _point(self, seed: int) -> FieldPoint | None:
        return pose_point(self.forms.chart, {}, seed) if self.solver is None else self.solver.draw(seed)

    def _combination(self, monomials: Sequence[Monomial], weights: Sequence[Residue], p: int) -> Expr | None:
        """Return the combination with the small fractions that the weights are modulo p, or None if one is none."""
        terms = []
        for m, weight in zip(monomials, weights, strict=True):
            if weight:
                c = reconstructed(int(weight), p)
                if max(abs(c.p), c.q) > LARGEST:
                    return None
                terms.append(ex.mul(ex.num(fraction(c)), *(self.ring.var_expr[i] for i in m)))
        return ex.add(*terms)


def _with_all_symbols(forms: Codistribution) -> Codistribution:
    """Return the same forms with a function for every column, also for those that no coefficient mentions."""
    ring = forms.chart.ring
    for s in forms.chart.symbols:
        ring.node(s)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in forms.chart.symbols)
    chart = replace(forms.chart, columns=columns)
    return Codistribution(chart, replace(forms.rows, columns=columns), forms.finite)


def _moves(e: Expr) -> bool:
    return any(s.args[0] in ("coordinate", "time") for s in e.symbols)


def _sample_at(forms: Codistribution, point: FieldPoint | None) -> FormSample | None:
    """Return the forms at a point, or None where there is none or a function has no value at it."""
    if point is None:
        return None
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(Fraction(0)))
    except NoValueError:
        return None
    return _sample_of(forms, point, field_frame(matrix, len(forms.chart.columns), point.p), point)


def _sample_of(
    forms: Codistribution, base: FieldPoint, frame: Pivots, place: FieldPoint | SeriesPoint
) -> FormSample | None:
    """Return the forms at a point or along a curve through it, or None where a function has no value or series."""
    ring, columns = forms.chart.ring, forms.chart.columns
    unit = place.number(Fraction(1))
    try:
        at = values(ring, place)
        matrix = forms.rows.matrix(at, unit * 0)
        basis = kernel(matrix, frame, unit * 0) if frame.free else []
        gradients = []
        for v, node in zip(ring.vars, ring.var_node, strict=True):
            g = gradient(ring, at, place, [(node, unit)]) if _moves(ring.var_expr[v.index]) else {}
            gradients.append({i: g[c] for i, c in enumerate(columns) if c in g})
        return FormSample(base, frame, [at[node] for node in ring.var_node], gradients, basis, matrix)
    except NoValueError:
        return None


def is_short(forms: Codistribution) -> bool:
    """Return whether there are few forms and one geometric equation at most, so that minors can be written out."""
    return len(forms.chart.nodes) <= 1 and len(forms.rows.entries) <= MAX_ROWS


class BorderedMinors:
    """The minors of some independent rows bordered by another one, in the canonical ring."""

    def __init__(self, forms: Codistribution, frame: Pivots) -> None:
        self.forms, self.chart, self.frame = forms, forms.chart, frame
        self.canon = Canon(forms.chart.ring)
        self._cofactors: dict[int, dict[int, Poly]] = {}

    def vanish(self, f: Expr) -> bool | None:
        """Return whether df depends on the forms: all minors of the forms together with df are 0.

        None where the minors are too long to be written out, and where one is not 0 beside geometric equations, on
        which it may vanish all the same.
        """
        ring, symbols = self.chart.ring, self.chart.symbols
        if not is_short(self.forms):
            return None
        slopes = {i: ring.node(diff(f, s)) for i, s in enumerate(symbols) if s in f.symbols}
        vanishes = self.is_combination(slopes, on_relation=True)
        return None if self.chart.nodes and vanishes is False else vanishes

    def is_combination(self, row: Mapping[int, int], on_relation: bool) -> bool | None:
        """Return whether a row, its nodes by column, is a combination of the rows wherever their minor is not 0.

        ``on_relation``: where the only geometric equation is satisfied. None where minors have no value or are long.
        """
        if len(self.frame.rows) > MAX_ROWS:
            return None
        try:
            return all(minor == 0 for minor in self._of(row, on_relation))
        except NoValueError:
            return None

    @false_without_value
    def are_involutive(self, forms: Sequence[Mapping[Expr, Expr]]) -> bool:
        """Return whether d(omega)(X, Y) = 0 for all X and Y that the rows annihilate, by identities [Frobenius1877]."""
        derivatives = [exterior_derivative({s: form.get(s, ex.ZERO) for s in self.chart.symbols}) for form in forms]
        nodes = [{k: self.chart.ring.node(e) for k, e in enumerate(d.values())} for d in derivatives]
        canon = self._current_canon()
        zero = canon.unit * 0
        cofactors = [self._along(canon, j) for j in self.frame.free]
        fields = [[x.get(c, zero) for c in range(len(self.chart.symbols))] for x in cofactors]
        coefficients = [polynomials(canon, row, len(row)) for row in nodes]
        return all(
            canon.reduce(sum((p * (x[i] * y[j] - x[j] * y[i]) for (i, j), p in zip(d, row, strict=True)), zero)) == 0
            for d, row in zip(derivatives, coefficients, strict=True)
            for x, y in combinations(fields, 2)
        )

    def _current_canon(self) -> Canon:
        """The canonical ring with all generators that there are by now."""
        if len(self.canon.gens) < len(self.chart.ring.vars):
            self.canon, self._cofactors = Canon(self.chart.ring), {}
        return self.canon

    def _of(self, nodes: Mapping[int, int], on_relation: bool) -> Iterator[Poly]:
        """Yield the minors, one for each free column, on request modulo a geometric equation. Raises NoValueError."""
        canon = self._current_canon()
        relation = canon.quotient(self.chart.nodes[0])[0] if on_relation and len(self.chart.nodes) == 1 else None
        row = polynomials(canon, nodes, len(self.chart.symbols))
        for j in self.frame.free:
            terms = (canon.reduce(row[c] * m) for c, m in self._along(canon, j).items())
            minor = canon.reduce(sum(terms, canon.unit * 0))
            yield minor if relation is None else remainder(minor, relation)

    def _along(self, canon: Canon, j: int) -> dict[int, Poly]:
        """Return the cofactors of the bordering row in the dependent columns and column ``j``."""
        if j not in self._cofactors:
            rows = [polynomials(canon, self.forms.rows.entries[r], len(self.chart.symbols)) for r in self.frame.rows]
            columns = (*self.frame.dependent, j)
            cofactors = {}
            for k, c in enumerate(columns):
                others = [d for d in columns if d != c]
                minor = determinant(canon, [[row[d] for d in others] for row in rows]) if rows else canon.unit
                cofactors[c] = -minor if k % 2 else minor
            self._cofactors[j] = cofactors
        return self._cofactors[j]


def integral_by_row(forms: Codistribution, integrals: Sequence[FirstIntegral]) -> dict[int, FirstIntegral]:
    """Return an integral for every row that it can stand for: with the other rows it implies the row.

    f can stand for a row where df is not in the span of the others; a row takes one that no other has, if there is one,
    and that mentions the same symbols.
    """
    search = IntegralSearch(forms)
    sample = search.sample(0) if integrals else None
    if sample is None:
        return {}
    moving, chosen = frozenset(forms.chart.symbols), dict[int, FirstIntegral]()
    for row in range(forms.finite, len(forms.rows.entries)):
        across = sample.across(row)
        fitting = [f for f in integrals if across and search.slope(f.expr, sample, across) != 0]
        mentioned = {forms.chart.symbols[c] for c in forms.rows.entries[row]}
        apart = {f: (f in chosen.values(), len(mentioned ^ (f.expr.symbols & moving))) for f in fitting}
        if fitting:
            chosen[row] = min(fitting, key=apart.__getitem__)
    return chosen
