"""What is different on a locus of configurations, checked at points on it by both engines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import comb
from typing import Any, NamedTuple

from flint import arb, ctx, nmod, nmod_mat

from dofkit.classification.special.common_zeros import MAX_READ, Leaf, common_zeros
from dofkit.classification.special.minors import MAX_MINORS, EliminatedTable, MinorTable, curvatures
from dofkit.configuration.generic_points import on_variety
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import PRECISION, BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, Pivots, certified_rank, field_frame, rank_over
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import Poly, determinant
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


class Candidates(NamedTuple):
    """Conditions on coordinates under which all largest minors vanish, and all curvature or a minor of it."""

    ranks: list[Leaf]
    bends: list[Leaf]


def candidates(table: MinorTable, rank: int, curvature: int, curved: bool) -> Candidates:
    """Return the candidates; ``rank``: of the rows in the columns of the coordinates.

    ``curvature``: the number of independent directions that [D, D] adds to D at a generic point, 0 where not known.
    Where nothing is ``curved`` curvature has nothing to tell. What is too large has no candidates.
    """
    reduction = EliminatedTable(table)
    size = rank - len(reduction.solved)
    ranks = _attempt(lambda: _loci(table, reduction.minors(size) if size > 0 else ()))
    bends = _attempt(lambda: _bends(table, reduction, size, curvature)) if curved and size >= 0 else []
    return Candidates(ranks, bends)


def _attempt(search: Callable[[], Iterable[Leaf]]) -> list[Leaf]:
    try:
        return raising_no_value(lambda: list(search()))()
    except NoValueError:
        return []


def _bends(table: MinorTable, reduction: EliminatedTable, size: int, independent: int) -> Iterator[Leaf]:
    """Yield the loci on which all curvature vanishes, and those on which less of it is independent."""
    if not any(table.curls):
        return
    matrix = curvatures(table, reduction.kernel(size))
    yield from _loci(table, [c for row in matrix for c in row])
    bent = [row for row in matrix if any(c != 0 for c in row)]
    if independent > 1 and comb(len(bent), independent) * comb(len(bent[0]), independent) <= MAX_MINORS:
        columns = range(len(bent[0]))
        picked = [(r, c) for r in combinations(bent, independent) for c in combinations(columns, independent)]
        yield from _loci(table, [determinant(table.canon, [[row[i] for i in c] for row in r]) for r, c in picked])


def _loci(table: MinorTable, polynomials: Iterable[Poly]) -> Iterator[Leaf]:
    """Yield conditions on coordinates under which polynomials vanish and the finite relations can hold for a while."""
    present = [p for p in polynomials if p != 0]
    for leaf in common_zeros(table.reals, present, short=True) if present else ():
        conditions = leaf.conditions(table.canon)
        short = all(len(p) <= MAX_READ for p in (*leaf.others, *(v for _, v in leaf.solved)))
        alone = any(_is_instant(table, c) or table.reals.of_parameters(c) for c in conditions)
        if not short or alone or not _is_of_coordinates(table, conditions) or not _is_defined(table, leaf):
            continue
        if _can_hold(table, leaf):
            yield leaf


def _can_hold(table: MinorTable, leaf: Leaf) -> bool:
    """Return whether the finite relations may hold on a leaf for an interval of time and all parameters."""
    relations = [table.reals.on(leaf, g) for g in table.relations]
    if any(table.reals.never_zero(g) for g in relations):
        return False
    try:
        ways = [way.conditions(table.canon) for way in common_zeros(table.reals, relations)]
    except NoValueError:
        return True
    return any(not any(_is_instant(table, c) or table.reals.of_parameters(c) for c in way) for way in ways)


def _is_instant(table: MinorTable, condition: Poly) -> bool:
    """Return whether a condition is one on time alone."""
    symbols = _symbols(table, [condition])
    return ex.TIME in symbols and all(s.args[0] in ("time", "parameter") for s in symbols)


def _symbols(table: MinorTable, conditions: Iterable[Poly]) -> frozenset[Expr]:
    present = {i for poly in conditions for i in table.canon.generators_in(poly)}
    return frozenset[Expr]().union(*(table.canon.ring.var_expr[i].symbols for i in present))


def _is_defined(table: MinorTable, leaf: Leaf) -> bool:
    """Return whether the denominators of the rows do not vanish on a leaf."""
    below = [table.reals.on(leaf, p) for p in table.below]
    return all(p != 0 and not any(divmod(p, c)[1] == 0 for c in leaf.others) for p in below)


def _is_of_coordinates(table: MinorTable, conditions: Sequence[Poly]) -> bool:
    """Return whether coordinates occur, and no unknown functions."""
    kinds = {table.canon.ring.vars[i].kind for poly in conditions for i in table.canon.generators_in(poly)}
    return "call" not in kinds and any(s.args[0] == "coordinate" for s in _symbols(table, conditions))


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
    result = points_of(chart)
    if result is None:
        return None
    n, point = chart.coordinates, result.field
    try:
        matrix = rows.matrix(values(chart.ring, point), point.number(ex.ZERO.args[0]))
        with ctx.workprec(PRECISION):
            balls = rows.matrix(values(chart.ring, result.real), arb(0))
            certified = certified_rank(_part(balls, n)), certified_rank(balls)
    except NoValueError:
        return None
    rank, whole = rank_of(_part(matrix, n), point.p), rank_of(matrix, point.p)
    if certified != (rank, whole):
        return None
    owners = _owners(block, a, _dependent(a, _part(matrix, n), point.p))
    frame = field_frame(matrix, len(rows.columns), point.p)
    if not rank == whole == grows or not frame.rows or not frame.free:
        return Locus(rank, whole == rank, owners, result.regular)
    return Locus(rank, True, owners, result.regular, _growth(rows, frame, point, a))


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
    result = []
    for k in range(LONGEST):
        vectors += [v for flow in flows for v in columns_of(flow.pulled[k])]
        result.append(rank_over(vectors, flows[0].sample))
    return tuple(result)
