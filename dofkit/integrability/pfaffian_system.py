"""A block's relations as one-forms, and the hidden equations that they imply.

The rows are the differentials of the geometric equations and the Pfaffian forms: a matrix [A b], with the coordinates'
columns A and the time column b. If lambda A = 0 and lambda b is not 0, they imply (lambda b) dt = 0, so motion through
an interval of time is possible only on the locus lambda b = 0, a hidden geometric equation (x + y = t with
xdot + ydot = z implies z = 1); this is Cartan's prolongation. The locus is where the largest minors of [A b] vanish.
Their common factor is the hidden equation; a single minor may have factors that are minors of A.
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
    """The rows of a block as one-forms over a chart: ``finite`` differentials of equations, then Pfaffian forms."""

    chart: Chart
    rows: FormRows
    finite: int

    @property
    def n(self) -> int:
        """The number of coordinates, without time."""
        return self.chart.coordinates


def codistribution(
    block: Block, setting: Setting, extra: Sequence[Expr], more: Sequence[Expr] = (), on: Sequence[Expr] | None = None
) -> Codistribution:
    """Return the one-forms of a block: dg for its geometric equations and the ``extra`` ones, then its Pfaffian forms.

    ``more``: further expressions for the chart to evaluate. ``on``: the equations that its points satisfy, by default
    the geometric ones.
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
    """Yield (number, row, index of its one-form) for the block's rows that are not nonlinear in the velocities."""
    number_finite = len(block.finite)
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        yield i, row, i if i < number_finite else i + forms.finite - number_finite


def first_order_freedom(block: Block, setting: Setting, reference: Mapping[Expr, Expr]) -> tuple[int | None, bool]:
    """Return the velocity freedom at the reference configuration, and whether it is proved.

    None where the reference does not satisfy the equations, or constants may satisfy an unknown relation. A rank over
    GF(p) is never too large, so it is proved if it is the number of rows.
    """
    forms = codistribution(block, setting, ())
    point = point_at(forms.chart, {**reference, ex.TIME: ex.ZERO}, 3) if "field" in setting.engines else None
    if point is None or odd_constants(forms.chart.ring, named=True):
        return None, False
    matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    rank = rank_of([row[: forms.n] for row in matrix], point.p)
    return forms.n - rank, rank == len(matrix)


#: Most choices of columns that are tried, most minors whose common factor is computed, and their largest size.
MAX_CHOICES, MAX_MINORS, MAX_SIZE = 400, 12, 8
#: Most combinations of branches of several hidden relations.
MAX_TOGETHER = 12


def confinements(forms: Codistribution, variety: Variety) -> tuple[tuple[Expr, ...], ...] | None:
    """Return the alternatives of `hidden_relation`; None if dt is not in the span of the rows or there is no point."""
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
    has_motion = rank_over([row[: forms.n] for row in matrix], zero) == rank_over(matrix, zero)
    return None if has_motion else hidden_relation(forms.rows, forms.n, point)


def prolong(alternatives: Sequence[Sequence[Expr]], setting: Setting) -> tuple[tuple[Expr, ...], ...] | None:
    """Return the branches of all alternatives: tuples of equations that together satisfy all relations of one.

    ``((),)`` for no alternatives; empty if no alternative can be satisfied; None if too many or undecided.
    """
    if not alternatives:
        return ((),)
    options = [_joint_branches(alternative, setting) for alternative in alternatives]
    decided = [branches for branches in options if branches is not None]
    return tuple(dict.fromkeys(b for branches in decided for b in branches)) if len(decided) == len(options) else None


def _joint_branches(relations: Sequence[Expr], setting: Setting) -> list[tuple[Expr, ...]] | None:
    """Return the branches of the common zero set of some relations, empty if there is none; None if undecided."""
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
    """Return two ways for all largest minors with the time column to be 0: the common factor is, or all quotients are.

    Each is a tuple of expressions that are 0 together. Empty if the minors are too large. ``n``: the index
    of the time column. ``point``: a generic one, which decides what minors are not 0 identically.
    """
    at = values(rows.ring, point)
    zero = at[0] * 0
    numbers = rows.matrix(at, zero)
    independent: list[int] = []
    for r, row in enumerate(numbers):
        if rank_over([*(numbers[k] for k in independent), row], zero) > len(independent):
            independent.append(r)
    size = len(independent)
    if size > MAX_SIZE:
        return ()
    canon = Canon(rows.ring)
    common: Any = None
    minors: list[Any] = []
    chosen_columns: list[tuple[int, ...]] = []
    try:
        table = [polynomials(canon, rows.entries[r], n + 1) for r in independent]
        for columns in islice(combinations(range(n), size - 1), MAX_CHOICES):
            check()
            with_time = (*columns, n)
            if rank_over([[numbers[r][c] for c in with_time] for r in independent], zero) < size:
                continue
            minor = determinant(canon, [[row[c] for c in with_time] for row in table])
            common = minor if common is None else common.gcd(minor)
            minors.append(minor)
            chosen_columns.append(columns)
            if len(minors) == MAX_MINORS or minor.is_constant():
                break
        if common is None:
            return ()
        quotients = tuple(dict.fromkeys(canon.to_expr(divided(m, common)) for m in minors))
        forced = divided(common, _content(canon, table, chosen_columns, common))
        return ((canon.to_expr(forced),), quotients)
    except NoValueError:
        return ()


def _content(canon: Canon, table: Sequence[Sequence[Any]], chosen_columns: Sequence[Sequence[int]], common: Any) -> Any:
    """Return the greatest common divisor of ``common`` and all cofactors of the time column in the minors.

    It is divided out, because where it is 0 only A loses rank, which implies no equation.
    """
    for columns in chosen_columns:
        for rows in combinations(table, len(columns)):
            if common.is_constant() or not columns:
                return common**0
            common = common.gcd(determinant(canon, [[row[c] for c in columns] for row in rows]))
    return common
