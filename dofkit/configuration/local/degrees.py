"""Degrees of the dependent relations in the free columns, as far as other relations give columns explicitly.

Along a line a polynomial of degree k that begins later than s^k is 0. Where independent relations say x_1 = x_0^2,
x_2 = x_1^2, ..., the degree of x_n is 2^n: what is built of it begins as late as that.
"""

from __future__ import annotations

from collections.abc import Iterable

from dofkit.configuration.local.manifold import Manifold
from dofkit.exact.ring.program import ADD, MUL, NUM, POW, VAR, reachable
from dofkit.exact.ring.ring import Ring


def degree(manifold: Manifold) -> int:
    """A bound on the degree of the dependent relations; columns that no relation gives explicitly count 1."""
    weights = _Weights(manifold)
    return max((weights.of(n) for n in manifold.others), default=0)


class _Weights:
    def __init__(self, manifold: Manifold) -> None:
        self.ring = manifold.ring
        dependent = {manifold.columns[c] for c in manifold.frame.dependent}
        self.explicit: dict[int, list[int]] = {}
        for row in manifold.rows:
            for column, rest in _explicit_columns(self.ring, row):
                if column in dependent and column not in self.explicit:
                    self.explicit[column] = rest
                    break
        self.known: dict[int, int] = {}

    def of(self, node: int) -> int:
        """The degree of an instruction."""
        degrees: dict[int, int] = {}
        for i in reversed(reachable(self.ring, [node], through_generators=False)):
            op, payload = self.ring.code[i]
            if op == MUL:
                degrees[i] = sum(degrees[j] for j in payload)
            elif op == ADD:
                degrees[i] = max(degrees[j] for j in payload)
            elif op == POW:
                degrees[i] = abs(payload[1]) * degrees[payload[0]]
            else:
                degrees[i] = self._generator(payload) if op == VAR else 0
        return degrees[node]

    def _generator(self, column: int) -> int:
        if column not in self.known:
            self.known[column] = 1
            inside = self.ring.vars[column].args or self.explicit.get(column, ())
            self.known[column] = max((1, *(self.of(n) for n in inside)))
        return self.known[column]


def _explicit_columns(ring: Ring, row: int) -> Iterable[tuple[int, list[int]]]:
    """(column, the other terms) for each column that a sum holds linearly, in one term, with a number."""
    op, terms = ring.code[row]
    if op != ADD:
        return
    for term in terms:
        column = _column_of(ring, term)
        rest = [t for t in terms if t != term]
        if column is not None and ring.var_node[column] not in reachable(ring, rest):
            yield column, rest


def _column_of(ring: Ring, term: int) -> int | None:
    op, payload = ring.code[term]
    if op == MUL:
        left = [i for i in payload if ring.code[i][0] != NUM]
        op, payload = ring.code[left[0]] if len(left) == 1 else (NUM, None)
    return payload if op == VAR and ring.vars[payload].kind == "symbol" else None
