"""The forms of a block at one random point, for all questions about some of them: one ring, one point, one run of it.

Where nothing finite holds, the point is one of the ambient space, and as good for some of the forms as for all. What is
not 0 there is not 0 as a function, where the functions that occur are known to be independent.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, field_frame
from dofkit.exact.ring.instructions import VAR, Scalar
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.zero.independence import doubt, independent_generators
from dofkit.expressions import tree as ex
from dofkit.integrability.lie_algebra import lie_span
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.relations.ambient import free_point
from dofkit.relations.blocks import Block
from dofkit.relations.setting import Setting

#: The seed of the point.
SEED = 5


@dataclass(frozen=True)
class SharedForms:
    """A block's forms, a point, and the program's values there."""

    forms: Codistribution
    point: FieldPoint
    at: Sequence[Scalar]

    def reach_everything(self, numbers: Sequence[int]) -> bool:
        """Do brackets of the velocities that some independent forms allow reach every direction?

        Then the largest integrable part of these forms is 0 at a generic point [Frobenius1877]. Only columns of what
        they mention are looked at: nothing else is touched by them.
        """
        rows = self._of(numbers)
        if len(numbers) == 1:
            return is_curved(rows, 0, self.at, self.point)
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


def shared_forms(block: Block, setting: Setting) -> SharedForms | None:
    """The forms of a block on which no finite relation holds; None where GF(p) does not tell what is not 0."""
    if block.finite or block.nonlinear or not block.forms:
        return None
    forms = codistribution(block, setting, ())
    ring = forms.chart.ring
    point = free_point(forms.chart, SEED) if doubt(ring) is None and independent_generators(ring) else None
    return None if point is None else SharedForms(forms, point, values(ring, point))


def is_curved(rows: FormRows, row: int, at: Sequence[Scalar], point: Any) -> bool:
    """Is d(omega) ^ omega of one row something else than 0 at a point? Then it does not integrate by itself.

    With a coefficient a_k that is not 0 that holds where a component (i, j, k) is not 0 for some i and j.
    """
    entries, columns = rows.entries[row], rows.columns
    one = point.number(ex.ONE.args[0])
    pivot = next((c for c, node in entries.items() if at[node] != 0), None)
    if pivot is None:
        return False
    slopes = {c: gradient(rows.ring, at, point, [(node, one)]) for c, node in entries.items()}
    zero = one * 0

    def curl(i: int, j: int) -> Scalar:
        return slopes.get(j, {}).get(columns[i], zero) - slopes.get(i, {}).get(columns[j], zero)

    value = {c: at[node] for c, node in entries.items()}
    others = [c for c in range(len(columns)) if c != pivot]
    for i, j in combinations(others, 2):
        total = value[pivot] * curl(i, j) + value.get(i, zero) * curl(j, pivot)
        if total + value.get(j, zero) * curl(pivot, i) != 0:
            return True
    return False
