"""A block's relations as one-forms, and the hidden equations that they force.

I is spanned by the differentials of the geometric equations and by the Pfaffian forms. If lambda A = 0 for the
coordinates' columns A and lambda b is not 0 for the time column b, the rows imply (lambda b) dt = 0, so motion through
an interval of time needs a geometric equation that nobody wrote (x + y = t with xdot + ydot = z forces z = 1):
prolongation in the sense of Cartan. The locus is where the largest minors of [A b] vanish; their common factor is the
relation (single minors carry factors of A of their own).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, islice
from itertools import product as cartesian
from typing import Any

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.configuration.variety import Variety, point_at
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.frames import FormRows, rank_over
from dofkit.exact.ring.canonical import Canon, determinant, divided, polynomials
from dofkit.exact.ring.program import Point, values
from dofkit.exact.zero import odd_constants
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Chart, Row, make_chart, uses_time
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.normal.zero_set import never_vanishes, zero_set
from dofkit.relations.setting import Setting


@dataclass
class Codistribution:
    """The rows of a block as one-forms over a chart: finite differentials, then Pfaffian forms."""

    chart: Chart
    rows: FormRows
    finite: int

    @property
    def n(self) -> int:
        """The coordinates, time apart."""
        return self.chart.coordinates


def codistribution(
    block: Block, setting: Setting, extra: Sequence[Expr], more: Sequence[Expr] = (), on: Sequence[Expr] | None = None
) -> Codistribution:
    """Return dg for every geometric equation (those ``extra`` included), then the Pfaffian forms.

    ``more`` is evaluated too; the points of the chart satisfy the relations ``on``, by default the finite ones.
    """
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    timed = uses_time(block) or any(ex.TIME in e.symbols for e in (*extra, *(on or ())))
    symbols = [ex.coordinate(c) for c in block.coordinates] + ([ex.TIME] if timed else [])
    gradients = [{i: diff(g, s) for i, s in enumerate(symbols) if s in g.symbols} for g in finite]
    place = {s: i for i, s in enumerate(symbols)}
    forms = [{place[s]: e for s, e in r.piece.items()} for r in block.forms if isinstance(r.piece, Pfaffian)]
    evaluated = [*(e for row in (*gradients, *(() if on is None else forms)) for e in row.values()), *more]
    if on is None:
        chart = make_chart(block, setting, extra, evaluated)
    else:
        locus = Block(block.coordinates, tuple(Row(-1, Finite(g)) for g in on))
        chart = make_chart(locus, setting, (), evaluated)
        index = chart.ring.var_index(ex.TIME)
        if len(chart.symbols) < len(symbols):
            chart = replace(chart, symbols=tuple(symbols), columns=(*chart.columns, -1 if index is None else index))
    entries = tuple({c: chart.ring.node(e) for c, e in row.items() if not e.is_zero} for row in (*gradients, *forms))
    return Codistribution(chart, FormRows(chart.ring, entries, chart.columns), len(finite))


def linear_rows(block: Block, forms: Codistribution) -> Iterator[tuple[int, Row, int]]:
    """(number, row, its place among the forms) of the block's rows that are no nonlinear relations of velocities."""
    number_finite = len(block.finite)
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        yield i, row, i if i < number_finite else i + forms.finite - number_finite


def first_order_freedom(block: Block, setting: Setting, reference: Mapping[Expr, Expr]) -> tuple[int | None, bool]:
    """Velocities that the rows allow at the reference configuration, and whether that is proved.

    None where it is not on the variety, or numbers there may be related in a way that is not known. Else a rank over
    GF(p) is not too large; of as many rows it is not too small.
    """
    forms = codistribution(block, setting, ())
    there = {**reference, ex.TIME: ex.ZERO}
    point = point_at(forms.chart, there, 3) if "field" in setting.engines else None
    if point is None or odd_constants(forms.chart.ring, named=True):
        return None, False
    matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    rank = rank_of([row[: forms.n] for row in matrix], point.p)
    return forms.n - rank, rank == len(matrix)


#: Choices of columns that are looked at, and minors that are divided out of each other.
MAX_CHOICES, MAX_MINORS, MAX_SIZE = 400, 12, 8
#: Alternatives in which several hidden relations hold together that are looked at.
MAX_TOGETHER = 12


def confinements(forms: Codistribution, variety: Variety) -> tuple[tuple[Expr, ...], ...] | None:
    """Ways in which motion is confined where dt lies in the span of the rows; None where it does not."""
    if len(forms.chart.symbols) == forms.n:
        return None
    real = variety.real.point if variety.real is not None and variety.real.certified else None
    point = variety.samples[0] if variety.samples else real
    if point is None:
        return None
    zero = point.number(ex.ZERO.args[0])
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), zero)
    except NoValueError:
        return None
    free = rank_over([row[: forms.n] for row in matrix], zero) == rank_over(matrix, zero)
    return None if free else hidden_relation(forms.rows, forms.n, point)


def prolong(alternatives: Sequence[Sequence[Expr]], setting: Setting) -> tuple[tuple[Expr, ...], ...] | None:
    """Return the branches on which the relations of some alternative vanish together, ``((),)`` for no alternatives.

    Empty where no alternative can vanish, None where there are too many branches, or it is not known.
    """
    if not alternatives:
        return ((),)
    options = [_joint_branches(alternative, setting) for alternative in alternatives]
    every = [branches for branches in options if branches is not None]
    return tuple(dict.fromkeys(b for branches in every for b in branches)) if len(every) == len(options) else None


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
    """Return the alternatives for the largest minors with the time column: the common factor vanishes, or quotients.

    Each alternative is a tuple of expressions that vanish together. None is known where the minors grow too large.

    ``n`` is the number of coordinate columns; time is column n. Which minors are not 0 is decided at a generic
    point of the variety.
    """
    at = values(rows.ring, point)
    zero = at[0] * 0
    numbers = rows.matrix(at, zero)
    chosen: list[int] = []
    for r, row in enumerate(numbers):
        if rank_over([*(numbers[k] for k in chosen), row], zero) > len(chosen):
            chosen.append(r)
    size = len(chosen)
    if size > MAX_SIZE:
        return ()
    canon = Canon(rows.ring)
    common: Any = None
    minors: list[Any] = []
    looked: list[tuple[int, ...]] = []
    try:
        table = [polynomials(canon, rows.entries[r], n + 1) for r in chosen]
        for columns in islice(combinations(range(n), size - 1), MAX_CHOICES):
            check()
            picked = (*columns, n)
            if rank_over([[numbers[r][c] for c in picked] for r in chosen], zero) < size:
                continue
            minor = determinant(canon, [[row[c] for c in picked] for row in table])
            common = minor if common is None else common.gcd(minor)
            minors.append(minor)
            looked.append(columns)
            if len(minors) == MAX_MINORS or minor.is_constant():
                break
        if common is None:
            return ()
        quotients = tuple(dict.fromkeys(canon.to_expr(divided(m, common)) for m in minors))
        forced = divided(common, _content(canon, table, looked, common))
        return ((canon.to_expr(forced),), quotients)
    except NoValueError:
        return ()


def _content(canon: Canon, table: Sequence[Sequence[Any]], looked: Sequence[Sequence[int]], common: Any) -> Any:
    """Return the factor that a common factor of minors shares with all their cofactors of the time column.

    Where it vanishes A loses rank, and nothing is forced: lambda A = 0 for the cofactors without it as well.
    """
    for columns in looked:
        for rows in combinations(table, len(columns)):
            if common.is_constant() or not columns:
                return common**0
            common = common.gcd(determinant(canon, [[row[c] for c in columns] for row in rows]))
    return common
