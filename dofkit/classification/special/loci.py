"""What is different on a locus of configurations, checked at points on it by both engines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from flint import arb, ctx, nmod, nmod_mat

from dofkit.base.verdicts import Verdict
from dofkit.configuration.generic_points import on_variety
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import PRECISION, BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, Pivots, certified_rank, field_frame, rank_over
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import AdmissibleCurve, columns_of
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, uses_time
from dofkit.relations.chart import Chart, make_chart
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.relations.setting import Setting

#: Starts and steps of the search for a real point of a locus; where it is regular a few are enough.
STARTS, STEPS = 2, 14
#: Brackets up to this length are looked at on a locus; and curves.
LONGEST, CURVES = 5, 12


@dataclass(frozen=True)
class Points:
    """A random point of a locus over GF(p) and a certified real one.

    ``regular``: the conditions are independent at the real one, so that there is a true real point for certain.
    """

    field: FieldPoint
    real: BallPoint
    regular: bool


def points_of(chart: Chart) -> Points | None:
    """Points where all relations of a chart hold; None where they were not found at once."""
    solver = TriangularSolver(chart.ring, chart.nodes, seed=1)
    drawn = solver.draw(1)
    if drawn is None or not on_variety(chart, drawn):
        return None
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive)
    real = search.search(starts=STARTS, steps=STEPS)
    if real is None or not real.certified or not real.consistent:
        return None
    return Points(drawn, real.point, real.rank == len(chart.nodes))


@dataclass(frozen=True)
class Locus:
    """A block's rows on a locus.

    ``rank`` in the coordinates' columns; ``moves``: False where no velocity satisfies them (dt lies in their
    span); ``dependent``: the constraints whose independent rows depend on each other there; ``regular``: that such
    real configurations exist is proved. ``growth``: dimensions of D, D + [D, D], ..., where they were asked for, as far
    as they are certain.
    """

    rank: int
    moves: bool
    dependent: tuple[int, ...]
    regular: bool
    growth: tuple[int, ...] = ()


@raising_no_value
def place(
    block: Block, a: Answer, setting: Setting, conditions: Sequence[Expr], relations: Sequence[Expr], grows: int
) -> Locus | None:
    """The rows on the locus; None where there is no such real configuration, or the engines disagree on a rank.

    ``relations``: the finite relations that do not hold there anyway; ``grows``: the rank at which D's growth is asked.
    """
    rows, chart = _rows(block, a, setting, conditions, relations)
    found = points_of(chart)
    if found is None:
        return None
    n, point = chart.coordinates, found.field
    try:
        matrix = rows.matrix(values(chart.ring, point), point.number(ex.ZERO.args[0]))
        with ctx.workprec(PRECISION):
            balls = rows.matrix(values(chart.ring, found.real), arb(0))
            certified = certified_rank(_part(balls, n)), certified_rank(balls)
    except NoValueError:
        return None
    rank, whole = rank_of(_part(matrix, n), point.p), rank_of(matrix, point.p)
    if certified != (rank, whole):
        return None
    owners = _owners(block, a, _dependent(a, _part(matrix, n), point.p))
    frame = field_frame(matrix, len(rows.columns), point.p)
    if not rank == whole == grows or not frame.rows or not frame.free:
        return Locus(rank, whole == rank, owners, found.regular)
    return Locus(rank, True, owners, found.regular, _growth(rows, frame, point, a))


def _part(matrix: list[list[Any]], n: int) -> list[list[Any]]:
    return [row[:n] for row in matrix]


def _rows(
    block: Block, a: Answer, setting: Setting, conditions: Sequence[Expr], relations: Sequence[Expr]
) -> tuple[FormRows, Chart]:
    """The block's rows over a chart of the locus: finite differentials, hidden ones among them, then forms."""
    finite = [*(r.piece.expr for r in block.finite if isinstance(r.piece, Finite)), *a.hidden]
    symbols = [ex.coordinate(c) for c in block.coordinates]
    if uses_time(block) or any(ex.TIME in g.symbols for g in (*finite, *conditions)):
        symbols.append(ex.TIME)
    place_of = {s: i for i, s in enumerate(symbols)}
    entries = [{place_of[s]: diff(g, s) for s in symbols if s in g.symbols} for g in finite]
    entries += [{place_of[s]: e for s, e in r.piece.items()} for r in block.forms if isinstance(r.piece, Pfaffian)]
    chart = _chart(block, setting, [*relations, *conditions], [e for row in entries for e in row.values()])
    if len(chart.symbols) < len(symbols):
        index = chart.ring.var_index(ex.TIME)
        chart = replace(chart, symbols=tuple(symbols), columns=(*chart.columns, -1 if index is None else index))
    nodes = tuple({c: chart.ring.node(e) for c, e in row.items() if not e.is_zero} for row in entries)
    return FormRows(chart.ring, nodes, chart.columns), chart


def _chart(block: Block, setting: Setting, relations: Sequence[Expr], more: Sequence[Expr]) -> Chart:
    around = Block(block.coordinates, tuple(Row(-1, Finite(g)) for g in relations))
    return make_chart(around, setting, (), more)


def _dependent(a: Answer, matrix: list[list[Any]], p: int) -> set[int]:
    """Of rows that are independent elsewhere, those that a relation between them holds here."""
    n = len(matrix[0])
    chosen: Sequence[int] = range(len(matrix))
    if len(a.matrix) == len(matrix):
        chosen = field_frame(
            [[nmod(row.get(c, 0), a.modulus) for c in range(n)] for row in a.matrix], n, a.modulus
        ).rows
    columns = nmod_mat([[int(matrix[r][c]) for r in chosen] for c in range(n)], p)
    basis, nullity = columns.nullspace()
    return {r for i, r in enumerate(chosen) if any(int(basis[i, k]) for k in range(nullity))}


def _owners(block: Block, a: Answer, rows: Iterable[int]) -> tuple[int, ...]:
    """The constraints of rows, hidden relations left out."""
    first, last = len(block.finite), len(block.finite) + len(a.hidden)
    places = [i if i < first else i - len(a.hidden) for i in rows if i < first or i >= last]
    return tuple(sorted({block.rows[i].constraint for i in places}))


def _growth(rows: FormRows, frame: Pivots, point: FieldPoint, a: Answer) -> tuple[int, ...]:
    """Dimensions of D, D + [D, D], ... at a point that need not be generic, up to what D reaches elsewhere.

    The values of ad_X^k B for many X span all brackets of length k + 1 up to length 3, and up to length 4 in two fields
    (there the multilinear part of the free Lie algebra is generated by such elements); beyond, only a dimension that
    cannot grow is certain.
    """
    largest = a.growth[-1] if a.growth else len(rows.columns)
    certain = 4 if len(frame.free) == 2 else 3
    flows: list[AdmissibleCurve] = []
    dimensions: tuple[int, ...] = ()
    quiet = 0
    while quiet < 2 and len(flows) < CURVES:
        flows.append(AdmissibleCurve(rows, frame, point))
        flows[-1].follow(LONGEST)
        before, dimensions = dimensions, _dimensions(flows)
        quiet = quiet + 1 if dimensions == before else 0
    reached = next((k + 1 for k, d in enumerate(dimensions) if d == largest), LONGEST + 1)
    return dimensions[: reached if reached <= certain + 1 else certain]


def _dimensions(flows: Sequence[AdmissibleCurve]) -> tuple[int, ...]:
    vectors: list[tuple[Any, ...]] = []
    found = []
    for k in range(LONGEST):
        vectors += [v for flow in flows for v in columns_of(flow.pulled[k])]
        found.append(rank_over(vectors, flows[0].sample))
    return tuple(found)


def meeting(coordinates: Sequence[str], setting: Setting, relations: Sequence[Expr]) -> Verdict | None:
    """How sure it is that real configurations satisfy relations; None where none was found."""
    found = points_of(_chart(Block(tuple(coordinates), ()), setting, relations, ()))
    if found is None:
        return None
    return "proved" if found.regular else "probable"
