"""Regularity: does an answer with the same solutions also have as good a gradient on them, on every branch?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from itertools import product as cartesian

from flint import arb

from dofkit.configuration.generic_points import field_jacobian
from dofkit.configuration.search import find
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.exact.points.balls import jacobian
from dofkit.exact.ring.program import values
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions.calculus import diff, in_velocities
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.chart import make_chart
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.normal.polynomial_zeros import EXPONENT_NOTE, POWER_NOTE, SQUARES_NOTE
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import eliminated, form_rate

#: Choices of branches on which gradients are looked at.
MAX_BRANCHES = 16


@dataclass(frozen=True)
class Regularity:
    """The relations of others, those that were asked for, and the constraints of an answer with the same solutions."""

    others: Sequence[Normal]
    wanted: Sequence[Normal]
    given: Sequence[Reduced]
    setting: Setting
    coordinates: Sequence[str]

    def irregular(self) -> bool | None:
        """Does the answer's gradient lose rank where that of what was asked for does not? None: not decided."""
        answer = [n for r in self.given for n in r.normals]
        if any(isinstance(p, Pfaffian) for n in (*answer, *self.wanted) for p in n.pieces):
            choices = list(cartesian(*(n.branches for n in self.wanted if n.branches)))[:MAX_BRANCHES]
            return any(_is_flat(r, choice, self.setting.positive) for r in self.given for choice in choices)
        if _lost(answer) and not _lost(self.wanted):
            return True
        branches = list(cartesian(*(n.branches for n in (*self.others, *self.wanted) if n.branches)))
        regular = {self._as_regular(choice) for choice in branches[:MAX_BRANCHES]}
        if False in regular:
            return True
        return None if None in regular or len(branches) > MAX_BRANCHES else False

    def _as_regular(self, choice: Sequence[Sequence[Piece]]) -> bool | None:
        """Do the gradients of the answer as written span as much as those that were asked for, on one branch?"""
        finite = [[p for p in branch if isinstance(p, Finite)] for branch in choice]
        others = len([n for n in self.others if n.branches])
        before = [p.expr for branch in finite[:others] for p in branch]
        wanted = [p.expr for branch in finite[others:] for p in branch]
        if not wanted:
            return True
        raw = [e.expr for r in self.given for e in r.constraint.relations]
        ranks = self._ranks([*chain(*finite)], [*before, *raw], [*before, *wanted])
        return None if ranks is None else ranks[0] >= ranks[1]

    def _ranks(self, on: Sequence[Finite], *sets: Sequence[Expr]) -> list[int] | None:
        """The ranks of the gradients of sets of expressions at a generic point of the set where ``on`` vanish."""
        blocks, _ = split(self.coordinates, [Row(0, p) for p in on])
        rows = tuple(row for b in blocks for row in b.rows)
        whole = Block(tuple(n for n in self.coordinates if any(n in b.coordinates for b in blocks)), rows)
        chart = make_chart(whole, self.setting, more=list(chain(*sets)))
        result = find(chart, {}, 7)
        nodes = [[chart.ring.node(e) for e in s] for s in sets]
        try:
            if result.samples:
                point = result.samples[0]
                return [rank_of_rows(field_jacobian(chart, point, some), point.p) for some in nodes]
            if result.real is None or not result.real.certified:
                return None
            real, columns = result.real.point, [c for c in chart.columns if c >= 0]
            at = values(chart.ring, real)
            slopes = [jacobian(chart.ring, at, real, some, columns, arb(0)) for some in nodes]
        except NoValueError:
            return None
        return [ball_part(j).rank if j else 0 for j in slopes]


def _lost(normals: Sequence[Normal]) -> bool:
    """Was a relation a power or a sum of squares in exponentials? Points over GF(p) do not know the zeros of those."""
    return any(EXPONENT_NOTE in n.notes and not {POWER_NOTE, SQUARES_NOTE}.isdisjoint(n.notes) for n in normals)


def _is_flat(r: Reduced, choice: Sequence[Sequence[Piece]], positive: frozenset[Expr]) -> bool:
    """Return whether the slopes of a relation by all velocities are 0 on forms, as a square's are, or have no value."""
    written = [in_velocities(e.expr)[0] for e in r.constraint.relations]
    slopes = [diff(e, v) for e in written for v in velocities_of(e)]
    if not slopes:
        return False
    try:
        forms = [form_rate(p) for branch in choice for p in branch if isinstance(p, Pfaffian)]
        return all(is_proved_zero(eliminated(e, forms)[0], positive) for e in slopes)
    except NoValueError:
        return True
