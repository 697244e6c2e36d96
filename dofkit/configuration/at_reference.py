"""What the reference configuration allows: instantaneously, and as a finite motion.

Where the equations are dependent there, only what is dependent has to be looked at. Let B be a basis of the rows of the
Jacobian at P, and M the manifold on which the equations of B are satisfied. The set that all equations cut out is M if
those outside B vanish on M too. One of them that is a combination of rows S of B is looked at together with any set of
equations that contains S: where these cut out the manifold M' of their part of B [ImplicitFunctions], it vanishes on
M', and M lies in M'. So equations in no dependent set (coloops) are not looked at, and mechanisms that share nothing
are apart.

Two rows are in one class if a minimal dependent set holds both. Together with a class those equations are kept that
mention its coordinates only: without them a bar across a square could not tell that the square is fixed. Where that is
not enough, all equations are looked at together.
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
from dofkit.configuration.variety import chart_of_rows, field_jacobian, point_at, pose_point, smaller
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

#: A gap between singular values that tells them apart.
CLEAR = 1e3
#: How far from the reference the angles are looked at.
NEAR = (2**-6, 2**-10, 2**-16, 2**-24)
EXPLICIT = "each equation determines one coordinate in terms of others, so the set is a graph"


@dataclass(frozen=True)
class AtReference:
    """``instantaneous``: infinitesimal motions allowed; ``local``: the dimension of the finite motion.

    ``matrix`` is the Jacobian there over GF(``modulus``), or the pattern of its dependent rows. ``dependent``: columns
    that the others determine, where the matrix does not tell. ``looked``: what was looked at of the relations.
    ``sure``: is ``instantaneous`` proved?
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
    """Return the answer at the reference configuration (t = 0), or None if that does not satisfy the equations."""
    with ctx.workprec(precision()):
        pose = {**reference, ex.TIME: ex.ZERO}
        if "field" not in chart.setting.engines:
            return _by_balls(chart, pose)
        answer = _by_field(chart, pose)
        return answer if answer is None else replace(answer, sure=_is_exact(chart, pose, answer))


def _is_exact(chart: Chart, pose: Mapping[Expr, Expr], answer: AtReference) -> bool:
    """Return whether the rank, which is not too large over GF(p), is proved not to be too small.

    So it is where no row depends on others, where only rigid motions of the system are left, and at a rational point.
    """
    velocities = answer.instantaneous
    if chart.coordinates - velocities == len(answer.matrix) or velocities == answer.rigid:
        return True
    columns = [c for s, c in zip(chart.symbols, chart.columns, strict=True) if s != ex.TIME]
    return exact_rank(chart.ring, chart.nodes, columns, rational_values(pose)) == chart.coordinates - velocities


def _by_field(chart: Chart, pose: Mapping[Expr, Expr]) -> AtReference | None:
    """`at_reference` with a point over GF(p), and balls where signs are asked for."""
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
    together = timed or rank == n - rigid or "classes" not in chart.setting.reductions
    apart = None if together else _by_parts(chart, pose, matrix, point.p, rank)
    if apart is not None:
        local, looked = apart
        return AtReference(n - rank_q, local, matrix, point.p, rank, rigid, looked=looked)
    if rank < len(matrix) and not timed:
        local, spared = _with_fewer(chart, pose, point, fields)
        looked = FollowedClasses(coordinates=n - spared, spared=spared)
        return AtReference(n - rank_q, local, matrix, point.p, rank, rigid, looked=looked)
    ball = ball_point(chart, pose) if rank < len(matrix) and "balls" in chart.setting.engines else None
    local = _at_fixed_time(criteria.local_at(chart, point, ball, rigid), timed)
    return AtReference(n - rank_q, local, matrix, point.p, rank, rigid)


def _with_fewer(
    chart: Chart,
    pose: Mapping[Expr, Expr],
    point: FieldPoint,
    fields: Sequence[Sequence[Any]],
    asked: Sequence[criteria.Criterion] = criteria.CRITERIA,
) -> tuple[LocalDimension, int]:
    """Return the local dimension by a chart with fewer coordinates, where there is one, and how many went.

    ``fields``: the motions of the system as one body over the chart's columns; what they are on fewer is what is left.
    """
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
    ball = ball_point(small, pose) if "balls" in chart.setting.engines else None
    local = criteria.local_at(small, here, ball, rigid, asked=asked)
    return replace(local, dimension=None if local.dimension is None else local.dimension + free), spared


def _by_parts(
    chart: Chart, pose: Mapping[Expr, Expr], matrix: Sequence[SparseRow], p: int, rank: int
) -> tuple[LocalDimension, FollowedClasses] | None:
    """Return the local dimension where every class of dependent relations gives a manifold, and what was looked at.

    None where one does not, or is not known to, or is all there is: then all have to be
    looked at together.
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
        local, spared = _of_part(class_chart, pose, part.rank)
        if local is None:
            return None
        dimensions.append(local)
        followed += 0 if local.reason == _rigid() else class_chart.coordinates - spared
        more += spared
    reasons = dict.fromkeys(local.reason for local in dimensions)
    looked_at = {row for part in classes for row in part.rows}
    weak = max(dimensions, key=lambda local: VERDICTS.index(local.verdict))
    local = LocalDimension(dimension, weak.verdict, "; ".join(reasons), argument=weak.argument)
    return local, FollowedClasses(len(matrix) - len(looked_at), followed, more)


def _rigid() -> str:
    """Why what depends on itself does not move."""
    return f"the dependent part is rigid: {conclusions.WHOLE}"


def _of_part(chart: Chart, pose: Mapping[Expr, Expr], rank: int) -> tuple[LocalDimension | None, int]:
    """One class by itself, and how many coordinates went before it was followed.

    None where its set is not known to be a manifold of the codimension of its rank.
    """
    point = pose_point(chart, pose, 3)
    if point is None:
        return None, 0
    corank = len(chart.columns) - rank
    fields = rigid_fields(chart, point)
    rigid = rank_of(fields, point.p)
    if corank == rigid:
        return LocalDimension(corank, "proved", _rigid(), argument="rigid to first order"), 0
    local, spared = _with_fewer(chart, pose, point, fields, criteria.OF_MANIFOLDS)
    return (local if local.dimension == corank else None), spared


def _at_fixed_time(local: LocalDimension, timed: int) -> LocalDimension:
    """Return the dimension without that of time, along which the set goes on; none where it does not."""
    if local.dimension is None:
        return local
    return replace(local, dimension=None if local.confined else local.dimension - timed)


def _by_balls(chart: Chart, pose: Mapping[Expr, Expr]) -> AtReference | None:
    """`at_reference` with balls alone: what a tiny ball contains 0 of is taken for 0."""
    ball = ball_point(chart, pose)
    matrix = None if ball is None else ball_matrix(chart, ball, True)
    if ball is None or matrix is None:
        return None
    n, columns = chart.coordinates, len(chart.columns)
    timed = columns - n
    part = ball_part(matrix)
    rank = part.rank
    rigid = rigid_motions_real(chart, ball)
    of_q = ball_part([row[:n] for row in matrix])
    local = LocalDimension(None, "undecided", gap_in_words(part.gap, "pivot"))
    if part.gap > CLEAR:
        frame = Pivots(tuple(part.rows), tuple(part.columns), tuple(c for c in range(columns) if c not in part.columns))
        manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, ball, chart.scales)
        local = _at_fixed_time(criteria.local_dimension(Germ(None, manifold, rigid, chart.time)), timed)
    pattern = sparse(dependencies(matrix, part))
    names = tuple(of_q.columns) if rank == of_q.rank else ()
    return AtReference(n - of_q.rank, local, pattern, 2, rank, rigid, names)


@none_without_value
def ball_matrix(chart: Chart, ball: BallPoint, exact: bool) -> list[list[arb]] | None:
    """Return the Jacobian over all columns; None where a relation's ball excludes 0 or has no value."""
    at = values(chart.ring, ball)
    if exact and not all(at[node].contains(0) for node in chart.nodes):
        return None
    present = [c for c in chart.columns if c >= 0]
    slopes = jacobian(chart.ring, at, ball, chart.nodes, present, arb(0))
    place = {c: i for i, c in enumerate(present)}
    return [[row[place[c]] if c >= 0 else arb(0) for c in chart.columns] for row in slopes]


@none_without_value
def ball_point(chart: Chart, pose: Mapping[Expr, Expr]) -> BallPoint | None:
    """Return the reference configuration with balls; symbols without a value get random ones, in its values too."""
    rng, symbols = random.Random("dofkit reference"), dict[Expr, Any]()
    with ctx.workprec(precision()):
        keys = [var.key for var in chart.ring.vars if var.kind == "symbol"]
        symbols |= {s: arb(rng.randrange(257, 1023)) / 512 for s in keys if pose.get(s) is None}
        for s in (s for s in keys if s not in symbols):
            ring = Ring([pose[s]])
            node = ring.node(pose[s])
            constants = {v.key: symbols.get(v.key, arb(3) / 4) for v in ring.vars if v.kind == "symbol"}
            symbols[s] = values(ring, BallPoint(constants))[node]
    return BallPoint(symbols)


def float_point(chart: Chart, pose: Mapping[Expr, Expr]) -> dict[Expr, float] | None:
    """Return a pose at t = 0 in floating point, symbols without a value at random; None if a value is undefined."""
    ball = ball_point(chart, {**pose, ex.TIME: ex.ZERO})
    return None if ball is None else {s: float(v.mid()) for s, v in ball.symbols.items()}


def near_reference(chart: Chart, rank: int) -> Iterator[RealPoint | None]:
    """Certified configurations near the reference, each joined to it by a curve; None where nothing constrains.

    At one on another part of the set other coordinates may be free.
    """
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
    """Rows that are looked at together, by their numbers, and how many of them are independent."""

    rows: tuple[int, ...]
    rank: int


def dependent_parts(chart: Chart, reduced: Echelon) -> list[DependentClass]:
    """The classes with dependent rows, each with what else is said of its coordinates; ``reduced``: with supports."""
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
        held = frozenset[Expr]().union(*(mentioned[i] for i in component))
        enclosed = {i for s in held for i in users[s] if mentioned[i] <= held and i not in reduced.supports}
        rows = tuple(sorted(component | enclosed))
        classes.append(DependentClass(rows, len(rows) - sum(r in reduced.supports for r in rows)))
    return sorted(classes, key=lambda part: part.rows)
