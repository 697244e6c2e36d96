"""The instantaneous freedom at the reference configuration P, and the dimension of the set of solutions near P.

If the equations are dependent at P, only the dependent ones have to be analysed. Let B be a basis of the rows of the
Jacobian at P, and M the manifold on which the equations of B are satisfied. The set of all equations is M if those
outside B vanish on M. An equation outside B whose row is a combination of rows S of B is analysed together with a set
of equations that contains S: if the set of these is the manifold M' of those of them that are in B [ImplicitFunctions],
the equation vanishes on M', and so on M, which is contained in M'. So equations in no dependent set (coloops) are left
out, and independent mechanisms are analysed separately.

Two rows are in one class if a minimal dependent set contains both. Equations that mention only coordinates of a class
are added to it: without them a bar across a square would not show that the square is fixed. If this is not sufficient,
all equations are analysed together.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from flint import arb, ctx

from dofkit.base.libraries import nx
from dofkit.base.verdicts import VERDICTS
from dofkit.base.wording import gap_in_words
from dofkit.configuration.local import conclusions, criteria
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.configuration.rigid_motions import rigid_fields, rigid_motions_real
from dofkit.configuration.variety import chart_of_rows, field_jacobian, is_parametric, point_at, pose_point, smaller
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.sparse import (
    Echelon,
    Pivots,
    SparseRow,
    echelon,
    rank_of,
    rank_of_rows,
    sparse,
    without_time,
)
from dofkit.exact.points.balls import BallPoint, RealPoint, exact_rank, jacobian, precision, rational_values
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealSearch, are_joined
from dofkit.exact.ring.program import none_without_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import FollowedClasses
from dofkit.relations.blocks import Chart

#: The least ratio of two pivots between which the rank is certain.
CLEAR = 1e3
#: Number of values, up to 2^+-`WIDEST`, of each parameter without a fixed value, for which signs are compared.
DRAWS, WIDEST = 24, 8
#: Sizes of random displacements from the reference in `near_reference`.
NEAR = (2**-6, 2**-10, 2**-16, 2**-24)
RIGID = f"the dependent part is rigid: {conclusions.WHOLE}"
EXPLICIT = "each equation determines one coordinate in terms of others, so the set is a graph"


@dataclass(frozen=True)
class AtReference:
    """The instantaneous freedom at the reference (proved if ``sure``), and the dimension of the set (``local``).

    ``matrix`` is the Jacobian over GF(``modulus``), of rank ``rank``, or modulo 2 the pattern of its dependent rows;
    then ``dependent`` are the columns to solve for. ``rigid``: the dimension of rigid motions of the system.
    ``looked``: the relations and coordinates that were analysed.
    """

    instantaneous: int
    local: LocalDimension
    matrix: list[SparseRow]
    modulus: int
    rank: int
    rigid: int
    dependent: tuple[int, ...] | None = None
    looked: FollowedClasses = field(default_factory=FollowedClasses)
    sure: bool = False


def at_reference(chart: Chart, reference: Mapping[Expr, Expr]) -> AtReference | None:
    """Return the result at the reference configuration and t = 0; None if it does not satisfy the equations."""
    with ctx.workprec(precision()):
        pose = {**reference, ex.TIME: ex.ZERO}
        if "field" not in chart.setting.engines:
            return _by_balls(chart, pose)
        answer = _by_field(chart, pose)
        return answer if answer is None else replace(answer, sure=_is_exact(chart, pose, answer))


def _is_exact(chart: Chart, pose: Mapping[Expr, Expr], answer: AtReference) -> bool:
    """Return whether the rank over GF(p), which cannot be too large, is proved not to be too small.

    It is if no row depends on others, if only rigid motions of the system remain, or by the rank at a rational point.
    """
    velocities = answer.instantaneous
    if chart.coordinates - velocities == len(answer.matrix) or velocities == answer.rigid:
        return True
    columns = [c for s, c in zip(chart.symbols, chart.columns, strict=True) if s != ex.TIME]
    return exact_rank(chart.ring, chart.nodes, columns, rational_values(pose)) == chart.coordinates - velocities


def _by_field(chart: Chart, pose: Mapping[Expr, Expr]) -> AtReference | None:
    """Return `at_reference` by a point over GF(p), and balls for signs."""
    point = point_at(chart, pose, 3)
    if point is None:
        return None
    matrix = field_jacobian(chart, point)
    n = chart.coordinates
    rank = rank_of_rows(matrix, point.p)
    rank_q = rank_of_rows(without_time(matrix, n), point.p) if len(chart.columns) > n else rank
    timed = len(chart.columns) - n
    fields = rigid_fields(chart, point)
    rigid = rank_of(fields, point.p)
    by_classes = None if timed or rank == n - rigid else _by_classes(chart, pose, matrix, point.p, rank)
    if by_classes is not None:
        local, looked = by_classes
        return AtReference(n - rank_q, local, matrix, point.p, rank, rigid, looked=looked)
    if rank < len(matrix) and not timed:
        local, spared = _with_fewer(chart, pose, point, fields)
        looked = FollowedClasses(coordinates=n - spared, spared=spared)
        return AtReference(n - rank_q, local, matrix, point.p, rank, rigid, looked=looked)
    balls = ball_points(chart, pose) if rank < len(matrix) else []
    local = _at_fixed_time(criteria.local_at(chart, point, balls, rigid), timed)
    return AtReference(n - rank_q, local, matrix, point.p, rank, rigid)


def _with_fewer(
    chart: Chart,
    pose: Mapping[Expr, Expr],
    point: FieldPoint,
    fields: Sequence[Sequence[Any]],
    asked: Sequence[criteria.Criterion] = criteria.CRITERIA,
) -> tuple[LocalDimension, int]:
    """Return (local dimension, number of coordinates eliminated by linear equations); ``fields``: the rigid motions."""
    small, free = smaller(chart)
    spared = chart.coordinates - small.coordinates
    here = point if small is chart else point_at(small, pose, 3)
    if here is None:
        return LocalDimension(
            None, "undecided", "in the reduced coordinates the reference configuration does not satisfy the equations"
        ), 0
    if not small.nodes:
        return LocalDimension(free, "proved", EXPLICIT, argument="graph"), spared
    kept = [i for i, s in enumerate(chart.symbols) if s in small.symbols]
    rigid = rank_of([[field[i] for i in kept] for field in fields], point.p)
    local = criteria.local_at(small, here, ball_points(small, pose), rigid, asked=asked)
    return replace(local, dimension=None if local.dimension is None else local.dimension + free), spared


def _by_classes(
    chart: Chart, pose: Mapping[Expr, Expr], matrix: Sequence[SparseRow], p: int, rank: int
) -> tuple[LocalDimension, FollowedClasses] | None:
    """Return the local dimension if the set of every class of dependent relations is a manifold, and what was analysed.

    None if this is not known of a class, or if one class has all relations: then all have to be analysed together.
    """
    dimension = len(chart.columns) - rank
    if rank == len(matrix):
        regular = LocalDimension(dimension, "proved", conclusions.INDEPENDENT, argument="independent relations")
        return regular, FollowedClasses(rank)
    reduced = echelon(matrix, p, supports=True)
    classes = dependent_parts(chart, reduced)
    if len(classes) == 1 and len(classes[0].rows) == len(matrix):
        return None
    dimensions = []
    followed = more = 0
    for part in classes:
        class_chart = chart_of_rows(chart, part.rows)
        local, spared = _of_class(class_chart, pose, part.rank)
        if local is None:
            return None
        dimensions.append(local)
        followed += 0 if local.reason == RIGID else class_chart.coordinates - spared
        more += spared
    reasons = dict.fromkeys(local.reason for local in dimensions)
    looked_at = {row for part in classes for row in part.rows}
    weak = max(dimensions, key=lambda local: VERDICTS.index(local.verdict))
    local = LocalDimension(dimension, weak.verdict, "; ".join(reasons), argument=weak.argument)
    return local, FollowedClasses(len(matrix) - len(looked_at), followed, more)


def _of_class(chart: Chart, pose: Mapping[Expr, Expr], rank: int) -> tuple[LocalDimension | None, int]:
    """Return (local dimension of one class of relations, which depend on no others; number of eliminated coordinates).

    The dimension is None unless the set is known to be a manifold whose codimension is the rank.
    """
    point = pose_point(chart, pose, 3)
    if point is None:
        return None, 0
    corank = len(chart.columns) - rank
    fields = rigid_fields(chart, point)
    rigid = rank_of(fields, point.p)
    if corank == rigid:
        return LocalDimension(corank, "proved", RIGID, argument="rigid to first order"), 0
    local, spared = _with_fewer(chart, pose, point, fields, criteria.OF_MANIFOLDS)
    return (local if local.dimension == corank else None), spared


def _at_fixed_time(local: LocalDimension, timed: int) -> LocalDimension:
    """Return the dimension at fixed time, 1 less if there is time; None if time is constant on the set."""
    if local.dimension is None:
        return local
    return replace(local, dimension=None if local.confined else local.dimension - timed)


def _by_balls(chart: Chart, pose: Mapping[Expr, Expr]) -> AtReference | None:
    """Return `at_reference` by balls only; a value whose tiny ball contains 0 counts as 0."""
    balls = ball_points(chart, pose)
    matrix = ball_matrix(chart, balls[0], True) if balls else None
    if matrix is None:
        return None
    n, columns = chart.coordinates, len(chart.columns)
    timed = columns - n
    part = ball_part(matrix)
    rank = part.rank
    rigid = rigid_motions_real(chart, balls[0])
    of_q = ball_part([row[:n] for row in matrix])
    local = LocalDimension(None, "undecided", gap_in_words(part.gap, "pivot"))
    if part.gap > CLEAR:
        frame = Pivots(tuple(part.rows), tuple(part.columns), tuple(c for c in range(columns) if c not in part.columns))
        manifolds = (Manifold(chart.ring, chart.nodes, chart.columns, frame, b, chart.scales) for b in balls)
        germs = (Germ(None, manifold, rigid, chart.time) for manifold in manifolds)
        local = _at_fixed_time(criteria.local_dimension(next(germs), criteria.CRITERIA, germs), timed)
    pattern = sparse(dependencies(matrix, part))
    names = tuple(of_q.columns) if rank == of_q.rank else ()
    return AtReference(n - of_q.rank, local, pattern, 2, rank, rigid, names)  # the pattern is modulo 2


@none_without_value
def ball_matrix(chart: Chart, ball: BallPoint, exact: bool) -> list[list[arb]] | None:
    """Return the Jacobian over all columns; None if it has no value, or (``exact``) a relation's ball excludes 0."""
    at = values(chart.ring, ball)
    if exact and not all(at[node].contains(0) for node in chart.nodes):
        return None
    present = [c for c in chart.columns if c >= 0]
    slopes = jacobian(chart.ring, at, ball, chart.nodes, present, arb(0))
    place = {c: i for i, c in enumerate(present)}
    return [[row[place[c]] if c >= 0 else arb(0) for c in chart.columns] for row in slopes]


@none_without_value
def ball_point(chart: Chart, pose: Mapping[Expr, Expr], draw: int = 0) -> BallPoint | None:
    """Return a pose as a point of balls, with random values of the other symbols; None if a value is undefined.

    From ``draw`` 1 on the values are of very different sizes, and negative ones too, unless they are declared positive.
    """
    rng, symbols = random.Random(f"dofkit reference {draw}"), dict[Expr, Any]()
    with ctx.workprec(precision()):
        keys = [var.key for var in chart.ring.vars if var.kind == "symbol"]
        for s in dict.fromkeys(u for k in keys for u in (sorted(pose[k].symbols, key=repr) if k in pose else [k])):
            symbols[s] = arb(rng.randrange(257, 1023)) / 512
            if draw:
                symbols[s] *= arb(2) ** rng.randint(-WIDEST, WIDEST)
                symbols[s] *= 1 if s in chart.setting.positive else rng.choice((-1, 1))
        constants = BallPoint(symbols, draw)
        for s in (s for s in keys if s in pose):
            ring = Ring([pose[s]])
            node = ring.node(pose[s])
            symbols = {**symbols, s: values(ring, constants)[node]}
    return BallPoint({s: symbols[s] for s in keys}, draw)


def ball_points(chart: Chart, pose: Mapping[Expr, Expr]) -> list[BallPoint]:
    """Return a pose as points of balls: one, or up to `DRAWS` if there are other symbols or unknown functions.

    None of these if only one of the values drawn for other symbols is defined: it cannot be compared.
    """
    free = is_parametric(chart, pose) or any(pose[s].symbols for s in chart.symbols if s in pose)
    draws = range(DRAWS if free else 1) if "balls" in chart.setting.engines else ()
    balls = [ball for draw in draws if (ball := ball_point(chart, pose, draw)) is not None]
    return [] if free and len(balls) == 1 else balls


def float_point(chart: Chart, pose: Mapping[Expr, Expr]) -> dict[Expr, float] | None:
    """Return a pose at t = 0 in floating point, symbols without a value at random; None if a value is undefined."""
    ball = ball_point(chart, {**pose, ex.TIME: ex.ZERO})
    return None if ball is None else {s: float(v.mid()) for s, v in ball.symbols.items()}


def near_reference(chart: Chart, rank: int) -> Iterator[RealPoint | None]:
    """Yield certified configurations near the reference, joined to it by a curve of the set; None without relations."""
    if not chart.nodes:
        yield None
        return
    start = ball_point(chart, {**(chart.setting.reference or {}), ex.TIME: ex.ZERO})
    if chart.setting.reference is None or start is None:
        return
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.setting.positive, chart.symbols)
    for seed, away in enumerate(NEAR):
        rng, initial = random.Random(f"dofkit near {seed}"), {s: float(v.mid()) for s, v in start.symbols.items()}
        initial |= {s: initial[s] + away * rng.uniform(-1.0, 1.0) for s in search.unknowns}
        real = search.search(seed, initial, starts=1)
        if real and real.certain and are_joined(search, start.symbols, real, rank):
            yield real


# Classes of dependent equations


@dataclass(frozen=True)
class DependentClass:
    """The numbers of rows that are analysed together, and the rank of these rows."""

    rows: tuple[int, ...]
    rank: int


def dependent_parts(chart: Chart, reduced: Echelon) -> list[DependentClass]:
    """Return the classes of dependent rows (by the supports of an echelon form), with equations of its coordinates."""
    graph: nx.Graph = nx.Graph()
    for row, support in reduced.supports.items():
        graph.add_node(row)
        graph.add_edges_from((row, other) for other in support)
    columns = frozenset(s for s in chart.symbols)
    mentioned = [g.symbols & columns for g in chart.relations]
    users: dict[Expr, list[int]] = {}
    for i, symbols in enumerate(mentioned):
        for s in symbols:
            users.setdefault(s, []).append(i)
    classes = []
    for component in nx.connected_components(graph):
        occurring = frozenset[Expr]().union(*(mentioned[i] for i in component))
        enclosed = {i for s in occurring for i in users[s] if mentioned[i] <= occurring and i not in reduced.supports}
        rows = tuple(sorted(component | enclosed))
        classes.append(DependentClass(rows, len(rows) - sum(r in reduced.supports for r in rows)))
    return sorted(classes, key=lambda part: part.rows)
