"""Comparisons of submitted constraints with wanted ones: multiples, gradients on the same set, roots.

Two equations are equivalent if one is, term by term, a number times the other.
a sqrt(P) + b = 0 is the branch a b <= 0 of b^2 = a^2 P, and equivalent to it if other constraints imply a b <= 0.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from itertools import product as cartesian

from flint import arb

from dofkit.base.errors import NoValueError
from dofkit.classification.freedom.preparation import scaled
from dofkit.configuration.search import find
from dofkit.configuration.variety import field_jacobian
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.exact.points.balls import jacobian
from dofkit.exact.ring.program import none_without_value, values
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, in_velocities, replace_nodes, substitute
from dofkit.expressions.real_values import Requirement
from dofkit.expressions.tree import HALF, MINUS_ONE, ZERO, Expr
from dofkit.relations.blocks import NOBODY, Block, Row, make_chart, split
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.normal.polynomial_zeros import EXPONENT_NOTE, POWER_NOTE, SQUARES_NOTE
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import eliminated
from dofkit.system import Relation


def same_up_to_numbers(submitted: Collection[Reduced], wanted: Collection[Reduced]) -> bool:
    """Return whether every submitted equation, as written, is a number times a wanted one, and every wanted one occurs.

    True proves that the sets are equivalent and equally regular; False: not proved.
    """
    if _as_written(submitted) == _as_written(wanted):
        return True
    keys, wanted_keys = ({scaled(n) for r in some for n in r.normals} for some in (submitted, wanted))
    unchanged = not any(n.notes for r in submitted for n in r.normals)
    return unchanged and keys == wanted_keys


def _as_written(constraints: Iterable[Reduced]) -> set[tuple[frozenset[Expr], frozenset[Requirement]]]:
    """Return the equations e = 0 as ({e, -e}, conditions for a value of e)."""
    relations = (e for r in constraints for e in r.constraint.relations)
    return {(frozenset((e.expr, -e.expr)), frozenset(e.domain)) for e in relations}


#: Bound on the choices of branches on which gradients are compared.
MAX_BRANCHES = 16


@dataclass(frozen=True)
class Regularity:
    """Submitted constraints with the same solutions as the wanted ones, together with the ``others``."""

    others: Sequence[Normal]
    wanted: Collection[Reduced]
    submitted: Collection[Reduced]
    setting: Setting
    coordinates: Sequence[str]

    def irregular(self) -> bool | None:
        """Return whether submitted gradients lose rank where wanted ones do not; None if undecided."""
        submitted, wanted = ([n for r in some for n in r.normals] for some in (self.submitted, self.wanted))
        nonlinear = any(isinstance(p, Nonlinear) for n in (*submitted, *wanted) for p in n.pieces)
        if _is_power(submitted, nonlinear) and not _is_power(wanted, nonlinear):
            return True
        if any(isinstance(p, Pfaffian) for n in (*submitted, *wanted) for p in n.pieces):
            choices = list(cartesian(*(n.branches for n in wanted if n.branches)))[:MAX_BRANCHES]
            return any(self._flat(self.submitted, c) and not self._flat(self.wanted, c) for c in choices)
        branches = list(cartesian(*(n.branches for n in (*self.others, *wanted) if n.branches)))
        regular = {self._as_regular(choice) for choice in branches[:MAX_BRANCHES]}
        if False in regular:
            return True
        return None if None in regular or len(branches) > MAX_BRANCHES else False

    def _as_regular(self, choice: Sequence[Sequence[Piece]]) -> bool | None:
        """Return whether the submitted gradients have at least the rank of the wanted ones on one branch, or None."""
        finite = [[p for p in branch if isinstance(p, Finite)] for branch in choice]
        others = len([n for n in self.others if n.branches])
        before = [p.expr for branch in finite[:others] for p in branch]
        wanted = [p.expr for branch in finite[others:] for p in branch]
        if not wanted:
            return True
        raw, raw_wanted = (
            [e.expr for r in some for e in r.constraint.relations if e.sense == "="]
            for some in (self.submitted, self.wanted)
        )
        ranks = self._ranks([*chain(*finite)], [*before, *raw], [*before, *wanted])
        if ranks is not None and ranks[0] < ranks[1]:  # the wanted equations as written may lose rank here too
            ranks = self._ranks([*chain(*finite)], [*before, *raw], [*before, *raw_wanted])
        return None if ranks is None else ranks[0] >= ranks[1]

    def _flat(self, some: Iterable[Reduced], choice: Sequence[Sequence[Piece]]) -> bool:
        return any(_is_flat(r, choice, self.setting.positive) for r in some)

    @none_without_value
    def _ranks(self, on: Sequence[Finite], *sets: Sequence[Expr]) -> list[int] | None:
        """Return the ranks of the gradients of sets of expressions at a generic point of ``on`` = 0; None if none."""
        blocks, _ = split(self.coordinates, [Row(NOBODY, p) for p in on])
        rows = tuple(row for b in blocks for row in b.rows)
        joined = Block(tuple(n for n in self.coordinates if any(n in b.coordinates for b in blocks)), rows)
        chart = make_chart(joined, self.setting, more=list(chain(*sets)))
        result = find(chart, {}, 7)
        nodes = [[chart.ring.node(e) for e in s] for s in sets]
        if result.samples:
            point = result.samples[0]
            return [rank_of_rows(field_jacobian(chart, point, some), point.p) for some in nodes]
        if result.real is None or not result.real.certified:
            return None
        real, columns = result.real.point, [c for c in chart.columns if c >= 0]
        at = values(chart.ring, real)
        slopes = [jacobian(chart.ring, at, real, some, columns, arb(0)) for some in nodes]
        return [ball_part(j).rank for j in slopes]


def _is_power(normals: Sequence[Normal], nonlinear: bool) -> bool:
    """Return whether a relation was a power or a sum of squares, in exponentials or ``nonlinear`` in the velocities.

    Gradients of such relations are not compared at points.
    """
    powers = [n for n in normals if not {POWER_NOTE, SQUARES_NOTE}.isdisjoint(n.notes)]
    return any(nonlinear or EXPONENT_NOTE in n.notes for n in powers)


def _is_flat(r: Reduced, choice: Sequence[Sequence[Piece]], positive: frozenset[Expr]) -> bool:
    """Return whether the derivatives of relations by all velocities are 0 (as a square's are), or have no value.

    They are taken where the forms of a choice of branches are 0.
    """
    written = [in_velocities(e.expr)[0] for e in r.constraint.relations]
    slopes = [diff(e, v) for e in written for v in velocities_of(e)]
    if not slopes:
        return False
    try:
        forms = [p.rate for branch in choice for p in branch if isinstance(p, Pfaffian)]
        return all(is_proved_zero(eliminated(e, forms)[0], positive) for e in slopes)
    except NoValueError:
        return True


_ROOT = ex.parameter("value of a root")


def unsound(submitted: Iterable[Reduced], sound: Sequence[bool | None]) -> list[Expr]:
    """Return the submitted expressions that are not ``sound`` (implied); none if there is not one for each relation."""
    written = [relation.expr for r in submitted for relation in r.constraint.relations]
    return [e for e, s in zip(written, sound, strict=True) if not s] if len(written) == len(sound) else []


def by_root(e: Expr) -> tuple[list[Normal], list[Relation]]:
    """Return ([b^2 = a^2 P], [a b <= 0 where P >= 0]), equivalent to e = a sqrt(P) + b = 0; empty lists for other e."""
    roots = {n for n in ex.nodes(e) if n.op == "pow" and n.args[1] == HALF}
    if len(roots) != 1:
        return [], []
    (root,) = roots
    named = replace_nodes(e, {root: _ROOT})
    a, b, under = diff(named, _ROOT), substitute(named, {_ROOT: ZERO}), root.args[0]
    if _ROOT in a.symbols or a.is_zero:
        return [], []
    squared = Normal(((Finite(b * b - a * a * under),),))
    return [squared], [Relation(ex.mul(MINUS_ONE, a, b), ">=", domain=((under, ">="),))]
