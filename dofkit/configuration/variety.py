"""The configuration space of a block: points on it, its dimension, and how sure that is.

Two one-sided engines: a rank over GF(p) is not too small where the point is generic and not too large
where no relation between functions was missed; a rank certified with balls is not too large. Where they
agree the rank stands. A real point makes sure that there is a real configuration at all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from dofkit.base.deadline import check
from dofkit.base.verdicts import Verdict, weakest
from dofkit.configuration.local.dimension import local_dimension
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.configuration.singular_points import numeric_local
from dofkit.exact.errors import NoValueError, PoleError
from dofkit.exact.matrices.modular import rank_of
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.points.frames import Pivots, sparse_frame
from dofkit.exact.points.real_search import RealPoint, RealSearch
from dofkit.exact.ring.instructions import VAR, reachable
from dofkit.exact.ring.program import gradient, value_of, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.ideals import complex_dimension
from dofkit.exact.solving.triangular import TriangularSolver
from dofkit.exact.zero.identity import excludes_zero
from dofkit.exact.zero.independence import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.ambient import free_point
from dofkit.relations.chart import Chart
from dofkit.relations.linear import presolve
from dofkit.relations.normal.no_solution import no_solution

#: Blocks with more columns than this are not certified with balls.
BALL_COLUMNS = 60
#: Points over GF(p) that must agree.
SAMPLES, MORE_SAMPLES = 2, 6
#: More relations than this are not searched for a proof that they have no real solution.
MAX_RELATIONS = 40
EMPTY = "no real configuration satisfies the relations together: all of space is excluded by certified bounds"
LARGER = "over the complex numbers the set has a part of larger dimension, and it was not decided what of it is real"


@dataclass
class Variety:
    """What was found.

    ``consistent``: None where it is not known. ``dimension``: of the configuration space at fixed time (None:
    not decided). ``samples``: points over GF(p) on it; ``real``: a real point with balls.
    """

    consistent: bool | None
    dimension: int | None
    verdict: Verdict
    samples: list[FieldPoint] = field(default_factory=list)
    real: RealPoint | None = None
    reasons: list[str] = field(default_factory=list)


def samples_for(chart: Chart) -> int:
    """More points where signs and roots may be chosen differently at each."""
    free = any(v.kind in ("sign", "root") and chart.ring.var_expr[v.index].symbols for v in chart.ring.vars)
    return MORE_SAMPLES if free else SAMPLES


def field_jacobian(chart: Chart, point: FieldPoint, nodes: Sequence[int] | None = None) -> list[SparseRow]:
    """dg/d(columns) over GF(p), row by row without zeros."""
    at = values(chart.ring, point)
    one = point.number(ex.ONE.args[0])
    place = {c: i for i, c in enumerate(chart.columns) if c >= 0}
    rows = []
    for node in chart.nodes if nodes is None else nodes:
        check()
        slope = gradient(chart.ring, at, point, [(node, one)])
        rows.append({place[c]: int(v) for c, v in slope.items() if c in place and v != 0})
    return rows


def on_variety(chart: Chart, point: FieldPoint) -> bool:
    """Do all finite relations hold at the point?"""
    try:
        at = values(chart.ring, point)
    except NoValueError:
        return False
    return all(at[n] == 0 for n in chart.nodes)


def pose_point(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> FieldPoint | None:
    """The point where the symbols have the given exact values and the others are random."""
    known = {s: v for s, v in pose.items() if chart.ring.var_index(s) is not None}
    fixed = _settled(chart.ring, known)
    if fixed is None:
        return None
    for attempt in range(60):
        try:
            point = field_point([chart.ring], 1000 * seed + attempt)
            for index, node in fixed:
                point.set(chart.ring.vars[index], value_of(chart.ring, point, node))
            values(chart.ring, point)
        except PoleError:
            return None
        except NoValueError:
            continue
        return point
    return None


def _settled(ring: Ring, known: Mapping[Expr, Expr]) -> list[tuple[int, int]] | None:
    """(generator, node of its value) for symbols and for the functions of them that have a known value."""
    settled: dict[int, int] = {}
    try:
        for _ in range(3):
            before = len(ring.vars)
            for var in list(ring.vars):
                shown = ring.var_expr[var.index]
                if var.index in settled or known.keys().isdisjoint(shown.symbols):
                    continue
                settled[var.index] = ring.node(ex.substitute(ex.substitute(shown, ring.alias), known))
            if len(ring.vars) == before:
                break
    except NoValueError:
        return None
    return sorted(settled.items(), key=lambda pair: pair[1])


def find(chart: Chart, pose: Mapping[Expr, Expr], seed: int = 0) -> Variety:
    """Generic points of the configuration space of a block, and its dimension.

    Where no real point was found it is tried to prove that there is none.
    """
    found = _found(chart, pose, seed)
    looked = {"field", "balls"} <= chart.engines and found.consistent is not True and found.verdict != "proved"
    if looked and len(chart.relations) <= MAX_RELATIONS and no_solution(chart.relations, chart.positive):
        return Variety(False, None, "proved", reasons=[EMPTY])
    return _unless_larger(chart, found)


def _unless_larger(chart: Chart, found: Variety) -> Variety:
    """Left open where the complex points have a part of a larger dimension: its real points may have it too."""
    if found.dimension is None or not found.consistent or not found.samples or not chart.nodes:
        return found
    point, timed = found.samples[0], len(chart.columns) - chart.coordinates
    if found.dimension != chart.coordinates - rank_of_rows(field_jacobian(chart, point), point.p):
        return found
    whole = complex_dimension(chart.ring, chart.nodes, [c for c in chart.columns if c >= 0])
    unused = sum(1 for c in chart.columns if c < 0)
    if whole is None or whole + unused - timed <= found.dimension:
        return found
    return replace(found, dimension=None, verdict="undecided", reasons=[*found.reasons, LARGER])


def _found(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> Variety:
    if not chart.nodes:
        points = []
        if "field" in chart.engines:
            points = [p for p in (free_point(chart, seed + k) for k in range(samples_for(chart))) if p is not None]
        real = _real(chart, seed, ())
        verdict: Verdict = "proved"
        return Variety(True, chart.coordinates, verdict, points, real)
    if "field" in chart.engines and _has_joint_positions(chart):
        posed = _pose_samples(chart, pose, seed)
        if posed:
            return _from_samples(chart, posed, None, seed, chart.nodes)
    linear = presolve(chart.relations if "eliminations" in chart.reductions else ())
    if linear.contradiction:
        return Variety(False, None, "proved", reasons=["linear relations contradict each other"])
    if "field" not in chart.engines:
        return _numerical(chart, seed, chart.nodes)
    core = [n for i, n in enumerate(chart.nodes) if i not in linear.superfluous]
    others = [n for i, n in enumerate(chart.nodes) if i not in linear.linear]
    solver = TriangularSolver(chart.ring, [*(chart.ring.node(e) for e in linear.reduced), *others], seed=seed)
    refuted = _refuted(chart, solver)
    if refuted is not None:
        return refuted
    drawn = [p for p in (solver.draw(seed + k + 1) for k in range(samples_for(chart))) if p is not None]
    drawn = [p for p in drawn if on_variety(chart, p)]
    if drawn:
        return _from_samples(chart, drawn, solver, seed, core)
    samples = _pose_samples(chart, pose, seed)
    return _from_samples(chart, samples, None, seed, core) if samples else _numerical(chart, seed, core)


def _has_joint_positions(chart: Chart) -> bool:
    """Is generic geometry of joints among the unknowns?"""
    return any(u.args[1].startswith("_a") for u in chart.unknowns if chart.ring.var_index(u) is not None)


def _refuted(chart: Chart, solver: TriangularSolver) -> Variety | None:
    """What elimination alone says against the relations; None where it says nothing."""
    if solver.plan.special:
        why = "the relations hold only for special values of the parameters"
        return Variety(False, None, "probable", reasons=[why])
    if not solver.plan.contradictory or _signed(chart.ring, solver.plan.witness):
        return None
    if "balls" in chart.engines:
        certain = excludes_zero(chart.ring, solver.plan.witness, chart.positive)
    else:
        certain = independent_generators(chart.ring)
    if not certain:
        why = "eliminating the unknowns leaves a number of which it is not known whether it is 0"
        return Variety(None, None, "undecided", reasons=[why])
    why = "eliminating the unknowns leaves a number that should be 0 and is not"
    return Variety(False, None, "probable", reasons=[why])


def _signed(ring: Ring, node: int) -> bool:
    """Is there a sign that varies? Another one may make 0 of what is not."""
    inside = (ring.code[i] for i in reachable(ring, [node], through_generators=False))
    return any(op == VAR and ring.vars[k].kind == "sign" and ring.var_expr[k].symbols for op, k in inside)


def _pose_samples(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> list[FieldPoint]:
    if not pose:
        return []
    found = []
    for k in range(SAMPLES):
        point = pose_point(chart, pose, seed + k)
        if point is None or not on_variety(chart, point):
            return []
        found.append(point)
    return found


def _real(chart: Chart, seed: int, core: Sequence[int]) -> RealPoint | None:
    if len(chart.columns) > BALL_COLUMNS or "balls" not in chart.engines:
        return None
    search = RealSearch(chart.ring, core, chart.unknowns, chart.positive, chart.symbols)
    try:
        return search.search(seed)
    except (OverflowError, ValueError, NoValueError):
        return None


def split_time(chart: Chart, matrix: list[list[Any]]) -> list[list[Any]]:
    """The rows without the time column."""
    n = chart.coordinates
    return [row[:n] for row in matrix]


def _from_samples(
    chart: Chart, samples: list[FieldPoint], solver: TriangularSolver | None, seed: int, core: Sequence[int]
) -> Variety:
    ranks = [rank_of_rows(field_jacobian(chart, p), p.p) for p in samples]
    rank = max(ranks)
    samples = [p for p, r in zip(samples, ranks, strict=True) if r == rank]
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    dimension: int | None = columns - rank - timed
    verdict: Verdict = "proved" if rank == len(chart.nodes) else "probable"
    reasons: list[str] = []
    if rank < len(chart.nodes) and not _smooth(chart, samples[0], solver):
        local = local_at(chart, samples[0], None, 0, chart.time)
        if local.dimension is None or local.confined or local.dimension < columns - rank:
            bound = _free_dimension(chart, solver)
            exact = None if local.confined else local.dimension
            if exact is None and bound is not None and bound == columns - rank - 1:
                exact = bound
            dimension = None if exact is None else exact - timed
            verdict = "undecided" if exact is None else "probable"
            reasons.append(local.reason)
    real = _real(chart, seed, core) if len(chart.columns) <= BALL_COLUMNS else None
    return _with_reality(chart, Variety(True, dimension, verdict, samples, real, reasons), rank)


def _smooth(chart: Chart, point: FieldPoint, solver: TriangularSolver | None) -> bool:
    """Is the set with all parameters free a manifold at the point, of the dimension of the family drawn from?

    Then a generic fibre over the parameters is one too (Sard), and its dimension is the number of columns less the
    rank. The family has as many dimensions as there are symbols less steps; a root's own relation adds both.
    """
    if solver is None or solver.plan.stuck or solver.plan.contradictory:
        return False
    ring = chart.ring
    if any(ring.vars[i].kind not in ("symbol", "pi") for i in generators_of(chart)):
        return False
    symbols = [v.index for v in ring.vars if v.kind == "symbol"]
    at = values(ring, point)
    one = point.number(ex.ONE.args[0])
    place = {c: k for k, c in enumerate(symbols)}
    rows = []
    for node in chart.nodes:
        check()
        row = [0] * len(symbols)
        for c, v in gradient(ring, at, point, [(node, one)]).items():
            row[place[c]] = int(v)
        rows.append(row)
    return rank_of(rows, point.p) == len(solver.plan.steps)


def _free_dimension(chart: Chart, solver: TriangularSolver | None) -> int | None:
    """How many columns were drawn at random when every parameter stayed free: a lower bound of the dimension."""
    if solver is None:
        return None
    of = {c: i for i, c in enumerate(chart.columns) if c >= 0}
    moved = {unit[1] for _, unit in solver.plan.steps if unit[0] == "var"}
    if any(index not in of for index in moved):
        return None
    return sum(c < 0 or c not in moved for c in chart.columns)


def _with_reality(chart: Chart, found: Variety, rank: int) -> Variety:
    """Hold the real point against what the field said."""
    real = found.real
    if "balls" not in chart.engines:
        return _by_field_alone(chart, found)
    if len(chart.columns) > BALL_COLUMNS:
        found.verdict = weakest(found.verdict, "probable")
        return found
    if real is None:
        return _without_reality(chart, found)
    if not real.certified or not real.consistent:
        return _singular(chart, found)
    if real.rank != rank:
        found.verdict, found.dimension = "undecided", None
        found.reasons.append("real points and points over GF(p) disagree about the rank: the set has several parts")
    return found


def _by_field_alone(chart: Chart, found: Variety) -> Variety:
    """Without balls a rank stands only where no relation between functions can have been missed."""
    if independent_generators(chart.ring):
        found.verdict = weakest(found.verdict, "probable")
        return found
    found.consistent, found.dimension, found.verdict = None, None, "undecided"
    found.reasons.append("the functions that occur may be related in a way that points over GF(p) do not show")
    return found


def _without_reality(chart: Chart, found: Variety) -> Variety:
    """No real point: an unknown function may be chosen so that there is one; else nothing is known."""
    calls = any(chart.ring.vars[i].kind == "call" for i in generators_of(chart))
    if calls:
        found.verdict = weakest(found.verdict, "probable")
        found.reasons.append("for an unknown function that allows real configurations")
        return found
    found.consistent, found.dimension, found.verdict = None, None, "undecided"
    found.reasons.append("no real configuration was found, and none was ruled out")
    return found


def generators_of(chart: Chart) -> set[int]:
    """The generators that the finite relations reach."""
    code = chart.ring.code
    return {code[i][1] for i in reachable(chart.ring, chart.nodes) if code[i][0] == VAR}


def _singular(chart: Chart, found: Variety) -> Variety:
    """All real points that were found are singular: the dimension is that of the set near one of them."""
    real = found.real
    local = None if real is None else numeric_local(chart, real)
    if local is None or local.dimension is None or local.confined:
        found.consistent = None
        found.verdict, found.dimension = "undecided", None
        found.reasons.append("every real configuration that was found is singular; what moves there was not decided")
        return found
    found.dimension = local.dimension - (len(chart.columns) - chart.coordinates)
    found.verdict = weakest(found.verdict, "numeric")
    found.reasons.append(f"every real configuration that was found is singular: {local.reason}")
    return found


def _numerical(chart: Chart, seed: int, core: Sequence[int]) -> Variety:
    """Without points over GF(p): real points only."""
    real = _real(chart, seed, core)
    if real is None:
        return Variety(None, None, "undecided", reasons=["no configuration was found that satisfies all of it"])
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    if real.certified and real.consistent and real.rank == len(core) == len(chart.nodes):
        return Variety(True, columns - real.rank - timed, "proved", [], real)
    if not real.certified or not real.consistent:
        return _singular(chart, Variety(True, None, "proved", [], real))
    if real.gap > 1e3:
        why = f"the gap between pivots is {real.gap:.1e}"
        return Variety(True, columns - real.rank - timed, "numeric", [], real, [why])
    return Variety(None, None, "undecided", [], real, ["the only points found are singular"])


def frame_at(chart: Chart, point: FieldPoint) -> Pivots:
    """Independent relations and dependent columns at a point."""
    return sparse_frame(field_jacobian(chart, point), len(chart.columns), point.p)


def local_at(
    chart: Chart, point: FieldPoint, ball: BallPoint | None, rigid: int, time: int | None = None
) -> LocalDimension:
    """The local dimension at a point of the variety, time counted where it is a column.

    ``time``: the number of that column, where it matters whether time moves on.
    """
    frame = frame_at(chart, point)
    try:
        field_manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, point)
        ball_manifold = None
        if ball is not None:
            ball_manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, ball, chart.scales)
        return local_dimension(field_manifold, ball_manifold, rigid, time)
    except NoValueError:
        return LocalDimension(
            None, "undecided", "the relations could not be followed along a curve through this configuration"
        )
