"""The forms of a block at one random point, for all questions about some of them: one ring, one point, one run of it.

Where nothing finite holds, the point is one of the ambient space, and as good for some of the forms as for all. What is
not 0 there is not 0 as a function, where the functions that occur are known to be independent.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import combinations
from typing import Any

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, field_frame
from dofkit.exact.ring.program import VAR, Scalar, gradient, values
from dofkit.exact.zero import doubt, independent_generators
from dofkit.expressions import tree as ex
from dofkit.integrability.lie_algebra import lie_span
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.chart import free_point

#: The seed of the point.
SEED = 5


class CurlAtPoint:
    """One form and its differential at a point: d(omega) has the components d_i a_j - d_j a_i."""

    def __init__(self, rows: FormRows, row: int, at: Sequence[Scalar], point: Any) -> None:
        one, entries = point.number(ex.ONE.args[0]), rows.entries[row]
        self.columns, self.zero = rows.columns, one * 0
        self.value = {c: at[node] for c, node in entries.items()}
        self.slopes = {c: gradient(rows.ring, at, point, [(node, one)]) for c, node in entries.items()}

    def curl(self, i: int, j: int) -> Scalar:
        """A component of d(omega)."""
        columns, zero = self.columns, self.zero
        return self.slopes.get(j, {}).get(columns[i], zero) - self.slopes.get(i, {}).get(columns[j], zero)

    @cached_property
    def is_open(self) -> bool:
        """Is d(omega) something else than 0?"""
        return any(self.curl(i, j) != 0 for i, j in combinations(range(len(self.columns)), 2))

    @cached_property
    def is_curved(self) -> bool:
        """Is d(omega) ^ omega something else than 0? Then the form does not integrate by itself [Frobenius1877].

        With a coefficient a_k that is not 0 that holds where a component (i, j, k) is not 0 for some i and j.
        """
        value, zero = self.value, self.zero
        k = next((c for c, a in value.items() if a != 0), None)
        if k is None:
            return False
        for i, j in combinations([c for c in range(len(self.columns)) if c != k], 2):
            total = value[k] * self.curl(i, j) + value.get(i, zero) * self.curl(j, k)
            if total + value.get(j, zero) * self.curl(k, i) != 0:
                return True
        return False


class SharedForms:
    """A block's forms, a point, and the program's values there."""

    def __init__(self, forms: Codistribution, point: FieldPoint) -> None:
        self.forms, self.point = forms, point
        self.at = values(forms.chart.ring, point)
        self._curls: dict[int, CurlAtPoint] = {}

    def curl(self, number: int) -> CurlAtPoint:
        """One form with its differential."""
        if number not in self._curls:
            self._curls[number] = CurlAtPoint(self.forms.rows, number, self.at, self.point)
        return self._curls[number]

    def reach_everything(self, numbers: Sequence[int]) -> bool:
        """Do brackets of the velocities that some independent forms allow reach every direction?

        Then the largest integrable part of these forms is 0 at a generic point [Frobenius1877]. Only columns of what
        they mention are looked at: nothing else is touched by them.
        """
        if len(numbers) == 1:
            return self.curl(numbers[0]).is_curved
        rows = self._of(numbers)
        n = len(rows.columns)
        try:
            frame = field_frame(rows.matrix(self.at, self.point.number(ex.ZERO.args[0])), n, self.point.p)
            return len(frame.rows) == len(numbers) and lie_span(rows, frame, self.point).dimension == n
        except NoValueError:
            return False

    def _of(self, numbers: Sequence[int]) -> FormRows:
        """Some rows over the columns that these mention."""
        rows = self.forms.rows
        entries = [rows.entries[i] for i in numbers]
        own = set(_symbols(rows, entries))
        kept = [c for c, index in enumerate(rows.columns) if index in own or any(c in row for row in entries)]
        place = {c: k for k, c in enumerate(kept)}
        moved = tuple({place[c]: node for c, node in row.items()} for row in entries)
        return FormRows(rows.ring, moved, tuple(rows.columns[c] for c in kept))


def _symbols(rows: FormRows, entries: Iterable[dict[int, int]]) -> Iterable[int]:
    """The generators that the coefficients of some rows depend on."""
    ring = rows.ring
    roots = tuple(node for row in entries for node in row.values())
    return (ring.code[i][1] for i in ring.order(roots) if ring.code[i][0] == VAR)


def shared_forms(forms: Codistribution) -> SharedForms | None:
    """Forms on which no finite relation holds, at a point; None where GF(p) does not tell what is not 0."""
    ring = forms.chart.ring
    certain = not forms.finite and doubt(ring) is None and independent_generators(ring)
    point = free_point(forms.chart, SEED) if certain else None
    return None if point is None else SharedForms(forms, point)
