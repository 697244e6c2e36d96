"""Hidden finite relations: where dt lies in the span of the rows, motion is confined to a locus.

If lambda A = 0 for the coordinates' columns A and lambda b is not 0 for the time column b, the rows imply
(lambda b) dt = 0, so motion through an interval of time needs a finite relation that nobody wrote
(x + y = t with xdot + ydot = z forces z = 1). Prolongation in the sense of Cartan. The locus is where the largest
minors of [A b] vanish; their common factor is the relation (single minors carry factors of A of their own).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations, islice
from itertools import product as cartesian
from typing import Any

from flint import arb

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.configuration.variety import Variety
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.frames import FormRows
from dofkit.exact.ring.canonical import Canon, determinant, divided, polynomials
from dofkit.exact.ring.program import Point, Scalar, values
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.normal.zero_set import never_vanishes, zero_set
from dofkit.relations.setting import Setting

#: Choices of columns that are looked at, and minors that are divided out of each other.
MAX_CHOICES, MAX_MINORS, MAX_SIZE = 400, 12, 8
#: Ways in which several hidden relations hold together that are looked at.
MAX_TOGETHER = 12


def confinements(forms: Codistribution, found: Variety) -> tuple[tuple[Expr, ...], ...] | None:
    """Ways in which motion is confined where dt lies in the span of the rows; None where it does not."""
    if len(forms.chart.symbols) == forms.n:
        return None
    n = forms.n
    if found.samples:
        point = found.samples[0]
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
        free = rank_of([row[:n] for row in matrix], point.p) == rank_of(matrix, point.p)
        return None if free else hidden_relation(forms.rows, n, point)
    if found.real is None:
        return None
    try:
        balls = forms.rows.matrix(values(forms.chart.ring, found.real.point), arb(0))
    except NoValueError:
        return None
    free = ball_part([row[:n] for row in balls]).rank == ball_part(balls).rank
    return None if free else hidden_relation(forms.rows, n, found.real.point)


def prolong(ways: Sequence[Sequence[Expr]], setting: Setting) -> tuple[tuple[Expr, ...], ...] | None:
    """The branches of hidden relations; none where they cannot hold, None where they have too many together."""
    if not ways:
        return ((),)
    found = [_joint_branches(way, setting) for way in ways]
    every = [branches for branches in found if branches is not None]
    return tuple(dict.fromkeys(b for branches in every for b in branches)) if len(every) == len(found) else None


def _joint_branches(relations: Sequence[Expr], setting: Setting) -> list[tuple[Expr, ...]] | None:
    """The branches on which all of some relations hold; None where they are too many or it is not known."""
    options = []
    for relation in relations:
        if never_vanishes(relation, setting.positive):
            return []
        if not any(s.args[0] == "coordinate" for s in relation.symbols):
            return [] if is_analytic(relation, relation.symbols, setting.positive) else None
        variables = frozenset(s for s in relation.symbols if s.args[0] in ("coordinate", "time"))
        options.append(zero_set(relation, setting.positive, variables)[0])
    if math.prod(map(len, options)) > MAX_TOGETHER:
        return None
    together = cartesian(*options)
    return [tuple(dict.fromkeys(g for branch in choice for g in branch)) for choice in together]


def hidden_relation(rows: FormRows, n: int, point: Point) -> tuple[tuple[Expr, ...], ...]:
    """Ways in which the largest minors with the time column vanish: their common factor does, or all that is left.

    No way where they grow too large.

    ``n`` is the number of coordinate columns; time is column n. Which minors are not 0 is decided at a generic
    point of the variety.
    """
    at = values(rows.ring, point)
    zero = at[0] * 0
    numbers = rows.matrix(at, zero)
    chosen = _independent(numbers, range(n + 1))
    size = len(chosen)
    if size > MAX_SIZE:
        return ()
    canon = Canon(rows.ring)
    common: Any = None
    minors: list[Any] = []
    try:
        table = [polynomials(canon, rows.entries[r], n + 1) for r in chosen]
        for columns in islice(combinations(range(n), size - 1), MAX_CHOICES):
            check()
            picked = (*columns, n)
            if len(_independent([[numbers[r][c] for c in picked] for r in chosen], range(size))) < size:
                continue
            minor = determinant(canon, [[row[c] for c in picked] for row in table])
            common = minor if common is None else common.gcd(minor)
            minors.append(minor)
            if len(minors) == MAX_MINORS or minor.is_constant():
                break
        if common is None:
            return ()
        left = tuple(dict.fromkeys(canon.to_expr(divided(m, common)) for m in minors))
        return ((canon.to_expr(common),), left)
    except NoValueError:
        return ()


def _independent(matrix: Sequence[Sequence[Scalar]], columns: Sequence[int] | range) -> list[int]:
    """The first rows, in order, that are independent on some columns; balls that hold 0 count as 0."""
    kept: list[tuple[list[Scalar], int]] = []
    found = []
    for r, row in enumerate(matrix):
        rest = [row[c] for c in columns]
        for pivot_row, pivot in kept:
            factor = rest[pivot] / pivot_row[pivot]
            rest = [a - factor * b for a, b in zip(rest, pivot_row, strict=True)]
        place = next((c for c, v in enumerate(rest) if is_nonzero(v)), None)
        if place is not None:
            kept.append((rest, place))
            found.append(r)
    return found


def is_nonzero(value: Scalar) -> bool:
    """Not 0 in GF(p); or a ball that excludes 0."""
    return not value.contains(0) if isinstance(value, arb) else bool(value != 0)
