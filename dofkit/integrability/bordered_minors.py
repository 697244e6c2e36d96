"""Bordered minors: is a row identically a combination of the rows of a system, and is the system involutive?

The minors are written out in the canonical ring, modulo a geometric equation, if there is one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.ring.canonical import Canon, Poly, determinant, polynomials, remainder
from dofkit.exact.ring.program import false_without_value, none_without_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, exterior_derivative
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import Codistribution

#: Bound on the rows of bordered minors.
MAX_ROWS = 5


def is_short(forms: Codistribution) -> bool:
    """Return whether there are few forms and at most one geometric equation, so that minors can be computed."""
    return len(forms.chart.nodes) <= 1 and len(forms.rows.entries) <= MAX_ROWS


class BorderedMinors:
    """The minors of the independent rows of a frame together with another row, in the canonical ring."""

    def __init__(self, forms: Codistribution, frame: Pivots) -> None:
        self.forms, self.chart, self.frame = forms, forms.chart, frame
        self.canon = Canon(forms.chart.ring)
        self._cofactors: dict[int, dict[int, Poly]] = {}

    def vanish(self, f: Expr) -> bool | None:
        """Return whether df depends on the forms identically: all minors of the forms together with df are 0.

        None if the minors are too large, or if one is not 0 but may be 0 on the geometric equations.
        """
        ring, symbols = self.chart.ring, self.chart.symbols
        if not is_short(self.forms):
            return None
        slopes = {i: ring.node(diff(f, s)) for i, s in enumerate(symbols) if s in f.symbols}
        vanishes = self.is_combination(slopes, on_relation=True)
        return None if self.chart.nodes and vanishes is False else vanishes

    @none_without_value
    def is_combination(self, row: Mapping[int, int], on_relation: bool) -> bool | None:
        """Return whether a row {column: node} is a combination of the rows wherever their minor is not 0.

        ``on_relation``: only where the single geometric equation is satisfied. None if minors are undefined or large.
        """
        if len(self.frame.rows) > MAX_ROWS:
            return None
        return all(minor == 0 for minor in self._of(row, on_relation))

    @false_without_value
    def are_involutive(self, forms: Sequence[Mapping[Expr, Expr]]) -> bool:
        """Return whether d(omega)(X, Y) = 0 is an identity for all forms omega and X, Y in D [Frobenius1877]."""
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
        """Return the canonical ring, computed again if the ring has new generators."""
        if len(self.canon.gens) < len(self.chart.ring.vars):
            self.canon, self._cofactors = Canon(self.chart.ring), {}
        return self.canon

    def _of(self, nodes: Mapping[int, int], on_relation: bool) -> Iterator[Poly]:
        """Yield the minors, one for each free column (``on_relation``: modulo the equation); raises NoValueError."""
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
