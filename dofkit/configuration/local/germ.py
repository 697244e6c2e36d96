"""The germ of {g = 0} at one of its points P: the quantities that the criteria use, each computed when first needed.

Let J be the Jacobian at P, of rank r, with n columns, and m = n - r. The r independent relations define a manifold M of
dimension m through P; the others are functions f_1, ..., f_k on M without linear part. The set is
{f_1 = ... = f_k = 0} on M. It contains the orbit of P under rigid motions of the system, of dimension mu.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import NamedTuple

from flint import arb

from dofkit.base.verdicts import Verdict
from dofkit.configuration.local import quadratic_cone
from dofkit.configuration.local.manifold import Form, Manifold, Split, series_on_critical, split
from dofkit.configuration.local.neighbourhood import holds_away
from dofkit.exact.points.frames import vanishes
from dofkit.exact.points.series import Series
from dofkit.exact.ring.program import ADD, MUL, NUM, VAR, Scalar, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import degree_bound

#: Orders to which the f_i are expanded on M; the second if m - mu <= 1.
ORDER, LONG_ORDER = 8, 16
#: Relations of this degree (over balls, of the degree `LONG_ORDER`) or more are expanded to `LONG_ORDER` only.
LONGEST = 65
#: The order of terms that are seen at a distance from the point.
SEEN = 400
#: If m - mu is larger, no second-order forms are computed with balls.
MANY_WAYS = 60
#: The order to which the f_i are expanded on N, and the number of random directions for the sign of f there.
CRITICAL_ORDER, DIRECTIONS = 12, 12


class Conclusion(NamedTuple):
    """The result of a criterion: the dimension of the set, None if undecided; ``confined``: time is constant on it.

    ``verdict``: an upper bound on the verdict of the criterion.
    """

    dimension: int | None
    reason: str
    confined: bool = False
    verdict: Verdict = "proved"


class Germ:
    """The set near a point, with the manifold M over GF(p) (``field``), over balls (``ball``), or both.

    A nonzero coefficient over GF(p) proves that a function is not 0; balls decide signs. With balls only, a value whose
    tiny ball contains 0 counts as 0. ``rigid`` is mu; ``time`` is the column of time, if there is one. ``distance``:
    whether functions that are 0 along a curve must be evaluated at a distance, on ``afar``, M over balls; ``ball`` is
    the same, but None if m - mu is large.
    """

    def __init__(
        self, field: Manifold | None, ball: Manifold | None, rigid: int, time: int | None = None, distance: bool = True
    ) -> None:
        manifold = ball if field is None else field
        if manifold is None:
            raise ValueError("a germ needs a manifold")
        self.manifold, self.field, self.afar = manifold, field, ball
        self.ball = ball if manifold.dimension - rigid <= MANY_WAYS else None
        self.rigid, self.time, self.distance = rigid, time, distance

    @property
    def exact(self) -> bool:
        """Whether there is a point over GF(p)."""
        return self.field is not None

    @property
    def m(self) -> int:
        """The dimension of M."""
        return self.manifold.dimension

    @property
    def dependent(self) -> int:
        """k, the number of dependent relations."""
        return len(self.manifold.others)

    @cached_property
    def degree(self) -> int:
        """A bound on the degree of the dependent relations along a line of the free columns."""
        return degree_of(self.manifold)

    @cached_property
    def order(self) -> int:
        """The order to which the dependent relations are followed on M."""
        few = self.exact and self.m - self.rigid <= 1
        if self.degree >= (LONGEST if self.exact else LONG_ORDER):
            return LONG_ORDER
        return max(LONG_ORDER if few else ORDER, self.degree + 1)

    @cached_property
    def series(self) -> list[Series]:
        """The dependent relations along a random curve of M."""
        return self.manifold.follow(random_direction(self.manifold), self.order)

    @cached_property
    def vanishes(self) -> bool:
        """Whether they are 0 along that curve, to the order."""
        return all(vanishes(s.coefficient(k)) for s in self.series for k in range(self.order))

    @cached_property
    def vanishes_away(self) -> bool | None:
        """Whether they are 0 at a distance too; None if no curve could be followed that far.

        True without a test at a random point: a function that is 0 along a curve there is 0 on M [SchwartzZippel].
        """
        if self.afar is None:
            return None if self.distance else True
        return holds_away(self.afar, ahead(self.afar, self.m), self.exact)

    @cached_property
    def signs(self) -> list[Form]:
        """The second-order parts of the dependent relations in balls; none without balls."""
        return [] if self.ball is None else self.ball.quadratic_forms()

    @cached_property
    def signature(self) -> tuple[int, int]:
        """Certified numbers of positive and negative squares of the first form."""
        return quadratic_cone.signature_of(self.signs[0])

    @cached_property
    def forms(self) -> list[Form]:
        """The second-order parts over GF(p); none without a point there."""
        return [] if self.field is None else self.field.quadratic_forms()

    @cached_property
    def cone(self) -> int:
        """An upper bound on the dimension of the second-order cone."""
        return quadratic_cone.bound(self.forms, self.rigid)

    @cached_property
    def critical(self) -> Split:
        """A choice of equations of the critical set N, and of coordinates of M for which they can be solved."""
        return split(self.forms)

    @cached_property
    def remainders(self) -> list[Series]:
        """The dependent relations along a random curve of N."""
        assert self.field is not None
        direction = [self.field.base.random() for _ in self.critical.free]
        return series_on_critical(self.field, self.forms, self.critical, direction, CRITICAL_ORDER)

    @cached_property
    def remainder_order(self) -> int | None:
        """The order of the first nonzero coefficient of the first remainder; None if there is none."""
        return next((k for k in range(CRITICAL_ORDER) if self.remainders[0].coefficient(k) != 0), None)

    @cached_property
    def remainder_signs(self) -> set[int]:
        """The certified signs of that coefficient in random directions of N."""
        assert self.ball is not None
        assert self.remainder_order is not None
        rng, leading_signs = self.ball.base.rng, set[int]()
        for _ in range(DIRECTIONS):
            direction = [arb(rng.choice((-1, 1)) * rng.randrange(64, 512)) / 256 for _ in self.critical.free]
            series = series_on_critical(self.ball, self.signs, self.critical, direction, self.remainder_order + 1)[0]
            value = series.coefficient(self.remainder_order)
            leading_signs |= set() if value.contains(0) else {1 if value > 0 else -1}
        return leading_signs


def random_direction(manifold: Manifold) -> Sequence[Scalar]:
    """Return a random direction of the manifold's free columns, in numbers of its type."""
    if isinstance(manifold.sample, arb):
        return [arb(manifold.base.rng.randrange(64, 512)) / 256 for _ in range(manifold.dimension)]
    return [manifold.base.random() for _ in range(manifold.dimension)]


def time_moves(manifold: Manifold, time: int, order: int) -> bool:
    """Return whether time (the column ``time``) changes along a random curve of the manifold, up to an order."""
    path = manifold.line(random_direction(manifold), order).path[time]
    return any(not vanishes(path.coefficient(k)) for k in range(1, order))


def ahead(ball: Manifold, count: int) -> list[float]:
    """Return ``count`` random numbers of either sign, of sizes between 1/2 and 1."""
    return [ball.base.rng.choice((-1, 1)) * ball.base.rng.randrange(128, 256) / 256 for _ in range(count)]


# Degrees in the free columns: where relations say x_1 = x_0^2, x_2 = x_1^2, ..., the degree of x_n is 2^n


def degree_of(manifold: Manifold) -> int:
    """Return a bound on the degree of the dependent relations along lines, see `_Weights`.

    Columns that are given implicitly may be flat: y + y^3 = x^40. This counts if no point at a distance would show it.
    """
    weights = _Weights(manifold)
    degree = degree_bound(manifold.ring, manifold.others, weights.of)
    if degree <= SEEN:
        weights.implicit, weights.degrees = 1, {}
        degree = degree_bound(manifold.ring, manifold.others, weights.of)
    return degree


class _Weights:
    """The degrees of columns: that of its expression for a column that a relation gives explicitly.

    For others ``implicit``, the product of the relations' degrees that are above `ORDER`, or 1.
    """

    def __init__(self, manifold: Manifold) -> None:
        self.ring = manifold.ring
        self.dependent = {manifold.columns[c] for c in manifold.frame.dependent}
        self.explicit: dict[int, list[int]] = {}
        self.implicit = 1
        for row in manifold.rows:
            for column, others in _explicit_columns(self.ring, row):
                if column in self.dependent and column not in self.explicit:
                    self.explicit[column] = others
                    break
            else:
                degree = degree_bound(self.ring, [row], lambda column: 1)
                self.implicit *= degree if degree > ORDER else 1
        self.degrees: dict[int, int] = {}

    def of(self, column: int) -> int:
        if column not in self.degrees:
            least = self.implicit if column in self.dependent and column not in self.explicit else 1
            self.degrees[column] = least
            inside = self.ring.vars[column].args or self.explicit.get(column, ())
            self.degrees[column] = max(least, degree_bound(self.ring, inside, self.of))
        return self.degrees[column]


def _explicit_columns(ring: Ring, row: int) -> Iterable[tuple[int, list[int]]]:
    """Yield (column, the other terms) for each column that occurs in one term of a sum only, number * column."""
    op, terms = ring.code[row]
    if op != ADD:
        return
    for term in terms:
        column = _column_of(ring, term)
        others = [t for t in terms if t != term]
        if column is not None and ring.var_node[column] not in reachable(ring, others):
            yield column, others


def _column_of(ring: Ring, term: int) -> int | None:
    """Return the column of a term that is a number times a symbol, else None."""
    op, payload = ring.code[term]
    if op == MUL:
        factors = [i for i in payload if ring.code[i][0] != NUM]
        op, payload = ring.code[factors[0]] if len(factors) == 1 else (NUM, None)
    return payload if op == VAR and ring.vars[payload].kind == "symbol" else None
