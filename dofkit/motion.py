"""Finite against instantaneous freedom: the local dimension of {g = 0} at one of its points.

Let J be the Jacobian at P, of rank r, on n columns; T = ker J has dimension m = n - r. Where all rows are
independent the set is a manifold of dimension m (implicit function theorem). Else r independent relations
give a manifold M through P, and the others are functions on it without linear part: they are followed along
a random curve of M as power series. All zero: the set is M, dimension m. Not zero, and

- m exceeds the dimension mu of the rigid motions of the whole by one: an analytic function of one variable has
  isolated zeros, so only the rigid motions are left: mu;
- only one function f is left, its second-order part has rank m - mu: by the Morse-Bott lemma the set has dimension mu
  where it is definite, m - 1 where it is indefinite (branches cross);
- otherwise the dimension is not decided here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb

from dofkit.deadline import check
from dofkit.exact.program import gradient, reachable, values
from dofkit.exact.ring import ADD, MUL, POW, VAR, Ring, Scalar
from dofkit.exact.series import Series, SeriesPoint, monomial, series_values, zero_poly
from dofkit.forms import Frame, solve
from dofkit.report import Verdict

#: Orders to which the other relations are followed; the second where one motion is in question.
ORDER, LONG_ORDER = 8, 16
#: Relations of this degree are not followed: their series may begin later.
LONGEST = 64


@dataclass(frozen=True)
class Local:
    """The local dimension at a point: ``dimension`` is None where it is not decided."""

    dimension: int | None
    verdict: Verdict
    reason: str


class Manifold:
    """The manifold of the independent relations, followed along curves as power series."""

    def __init__(self, ring: Ring, nodes: Sequence[int], columns: Sequence[int], frame: Frame, base: Any) -> None:
        self.ring, self.nodes, self.columns, self.frame, self.base = ring, list(nodes), list(columns), frame, base
        at = values(ring, base)
        self.sample = at[0] * 0 if at else base.number(0)
        self.like = zero_poly(base, self.sample)
        self.start = [at[ring.var_node[c]] if c >= 0 else self.sample for c in columns]
        self.others = [n for i, n in enumerate(self.nodes) if i not in set(frame.rows)]

    def follow(self, direction: Sequence[Scalar], order: int) -> list[Series]:
        """The other relations along q(s), whose free columns are start + s direction."""
        _, at = self._evaluate(self.curve(direction, order), order)
        return [at[n] for n in self.others]

    def curve(self, direction: Sequence[Scalar], order: int) -> list[Series]:
        """The columns along q(s), whose free ones are start + s direction."""
        path = [Series(self.like + value, order) for value in self.start]
        step = Series(monomial(self.like), order)
        for value, c in zip(direction, self.frame.free, strict=True):
            path[c] = path[c] + step * value
        at: list[Series] = []
        for _ in range(order):
            check()
            point, at = self._evaluate(path, order)
            moved = self._velocity(at, point, direction, order)
            for i, c in enumerate(self.frame.dependent):
                path[c] = moved[i][0].integral(self.start[c])
        return path

    def _evaluate(self, path: list[Series], order: int) -> tuple[SeriesPoint, list[Series]]:
        point = SeriesPoint(self.base, {c: path[i] for i, c in enumerate(self.columns) if c >= 0}, order, self.like)
        return point, series_values(self.ring, point)

    def _velocity(
        self, at: list[Series], point: SeriesPoint, direction: Sequence[Scalar], order: int
    ) -> list[list[Series]]:
        zero = Series(self.like, order)
        one = Series(self.like + 1, order)
        left, right = [], []
        for r in self.frame.rows:
            g = gradient(self.ring, at, point, [(self.nodes[r], one)])
            row = [g.get(c, zero) if c >= 0 else zero for c in self.columns]
            left.append([row[c] for c in self.frame.dependent])
            total = zero
            for value, c in zip(direction, self.frame.free, strict=True):
                total = total - row[c] * value
            right.append([total])
        return solve(left, right)

    def quadratic_forms(self) -> list[list[list[Scalar]]]:
        """For each other relation, the matrix of its second-order part on the free columns."""
        m = len(self.frame.free)
        zero, one = self.sample, self.sample + 1
        unit = [[one if i == j else zero for j in range(m)] for i in range(m)]
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


def _degree(ring: Ring, nodes: Sequence[int]) -> int:
    """A bound on the degree of some expressions in the generators."""
    degrees: dict[int, int] = {}
    for i in reversed(reachable(ring, nodes, through_generators=False)):
        op, payload = ring.code[i]
        if op == MUL:
            degrees[i] = sum(degrees[j] for j in payload)
        elif op == ADD:
            degrees[i] = max(degrees[j] for j in payload)
        elif op == POW:
            degrees[i] = abs(payload[1]) * degrees[payload[0]]
        else:
            degrees[i] = int(op == VAR)
    return max((degrees[n] for n in nodes), default=0)


def local_dimension(field: Manifold, ball: Manifold | None, rigid: int, timed: bool = False) -> Local:
    """The local dimension at the point; ``rigid`` is the dimension of the motions that move everything as one body.

    ``field`` is over GF(p), where a coefficient that is not 0 proves that the function is not; ``ball`` at the
    same point decides signs. ``timed``: time is one of the columns, and counted in ``rigid``.
    """
    m = len(field.frame.free)
    if not field.others:
        return Local(m, "proved", "all relations are independent here (implicit function theorem)")
    if m == rigid and not timed:
        return Local(m, "proved", "nothing but motions of the whole is possible to first order")
    degree = _degree(field.ring, field.others)
    if degree >= LONGEST:
        return Local(
            None, "undecided", f"a relation of degree {degree} may be flat here to a higher order than is followed"
        )
    order = max(LONG_ORDER if m - rigid <= 1 else ORDER, degree + 1)
    direction = [field.base.random() for _ in range(m)]
    along = field.follow(direction, order)
    if all(s.poly.degree() < 0 for s in along):
        return Local(
            m,
            "probable",
            f"the dependent relations hold along a random curve to order {order - 1}: the motion is finite",
        )
    if timed:
        return Local(None, "undecided", "a dependent relation breaks along a random curve in which time goes on")
    if m - rigid == 1:
        first = min(k for s in along for k in range(order) if s.coefficient(k) != 0)
        return Local(rigid, "proved", f"the one motion left to first order breaks a relation at order {first}")
    return _second_order(ball, m, rigid)


def numeric_dimension(ball: Manifold, rigid: int) -> Local:
    """The same from an approximate point: where a tiny ball contains 0 it is taken for 0; the verdict is numeric."""
    m = len(ball.frame.free)
    if not ball.others or m == rigid:
        return Local(m, "numeric", "the relations kept are independent within the precision")
    order = max(ORDER, _degree(ball.ring, ball.others) + 1)
    if order > LONG_ORDER:
        return Local(None, "undecided", "a relation may be flat here to a higher order than is followed")
    direction = [arb(ball.base.rng.randrange(64, 512)) / 256 for _ in range(m)]
    along = ball.follow(direction, order)
    if all(s.coefficient(k).contains(0) for s in along for k in range(order)):
        return Local(m, "numeric", "the dependent relations hold along a random curve within the precision")
    if m - rigid == 1:
        return Local(rigid, "numeric", "the one motion left to first order breaks a relation")
    found = _second_order(ball, m, rigid)
    return Local(found.dimension, "numeric" if found.dimension is not None else "undecided", found.reason)


def _second_order(ball: Manifold | None, m: int, rigid: int) -> Local:
    undecided = Local(None, "undecided", "the relations are dependent here and the second order does not decide")
    if ball is None:
        return undecided
    forms = ball.quadratic_forms()
    if len(forms) != 1:
        signature = _definite_combination(forms, m, rigid)
        if signature:
            return Local(rigid, "proved", "a combination of them is definite to second order: no finite motion")
        return undecided
    positive, negative = signature_of(forms[0])
    if positive + negative != m - rigid:
        return undecided
    if positive and negative:
        return Local(m - 1, "proved", "the second order is an indefinite form: branches of the motion cross here")
    return Local(rigid, "proved", "to second order the dependent relation is a definite form: no finite motion")


def _definite_combination(forms: list[list[list[arb]]], m: int, rigid: int) -> bool:
    """Is some simple combination of the forms definite on all but the rigid motions?"""
    k = len(forms)
    choices = [[int(i == j) for i in range(k)] for j in range(k)]
    choices += [[1] * k]
    for a in range(k):
        for b in range(a):
            choices += [[1 if i == a else s if i == b else 0 for i in range(k)] for s in (1, -1)]
    for weights in choices[:200]:
        weighted = list(zip(weights, forms, strict=True))
        total = [[sum((w * f[i][j] for w, f in weighted), arb(0)) for j in range(m)] for i in range(m)]
        positive, negative = signature_of(total)
        if not (positive and negative) and positive + negative == m - rigid:
            return True
    return False


def signature_of(form: list[list[arb]]) -> tuple[int, int]:
    """Certified numbers of positive and negative squares (Lagrange's reduction with pivots that exclude 0)."""
    n = len(form)
    work = [list(row) for row in form]
    left = set(range(n))
    positive = negative = 0
    while left:
        pivot = _pivot(work, left)
        if pivot is None:
            break
        i, j = pivot
        if i != j:
            for k in range(n):
                work[i][k] = work[i][k] + work[j][k]
            for k in range(n):
                work[k][i] = work[k][i] + work[k][j]
        value = work[i][i]
        if value.contains(0):
            break
        positive, negative = (positive + 1, negative) if value > 0 else (positive, negative + 1)
        left.discard(i)
        for a in left:
            factor = work[a][i] / value
            for b in left:
                work[a][b] = work[a][b] - factor * work[i][b]
    return positive, negative


def _pivot(work: list[list[arb]], left: set[int]) -> tuple[int, int] | None:
    """A diagonal entry that is not 0, the largest; else an off-diagonal one."""
    best, size = None, arb(0)
    for i in left:
        if not work[i][i].contains(0) and work[i][i].abs_lower() > size:
            best, size = (i, i), work[i][i].abs_lower()
    if best is not None:
        return best
    return next(((i, j) for i in left for j in left if i != j and not work[i][j].contains(0)), None)
