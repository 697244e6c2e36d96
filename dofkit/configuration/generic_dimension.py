"""The dimension of the configuration space at its generic points: by rank, and by what is singular all over it."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.deadline import check
from dofkit.base.verdicts import ArgumentKey, Verdict
from dofkit.base.wording import gap_in_words
from dofkit.configuration.generic_points import field_jacobian, generators_of, has_same_signs, time_is_free
from dofkit.configuration.local import dimension as local_dimension
from dofkit.configuration.reality import BALL_COLUMNS, near_singular_point, real_point, with_reality
from dofkit.configuration.variety import Variety
from dofkit.exact.matrices.sparse import rank_of, rank_of_rows
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.relations.chart import Chart


def variety_at(
    chart: Chart, samples: list[FieldPoint], solver: TriangularSolver | None, seed: int, core: Sequence[int]
) -> Variety:
    """The set near generic points over GF(p) that lie on it, held against a real point.

    ``solver``: what drew them, None where they have given values; ``core``: relations to search a real point of. Points
    at which the time is fixed, or at which a sign is another than at the real point, lie on other parts of the set.
    """
    real = real_point(chart, seed, core) if len(chart.columns) <= BALL_COLUMNS else None
    samples = [p for p in samples if time_is_free(chart, p)] or samples
    samples = [p for p in samples if real is None or has_same_signs(chart, p, real)]
    if not samples:
        return near_real_point(chart, real, core)
    ranks = [rank_of_rows(field_jacobian(chart, p), p.p) for p in samples]
    rank = max(ranks)
    samples = [p for p, r in zip(samples, ranks, strict=True) if r == rank]
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    dimension: int | None = columns - rank - timed
    verdict: Verdict = "proved" if rank == len(chart.nodes) else "probable"
    argument: ArgumentKey | None = "regular point"
    reasons: list[str] = []
    if rank < len(chart.nodes) and not _smooth(chart, samples[0], solver):
        local = local_dimension.local_at(chart, samples[0], None, 0, chart.time, drawn=False)
        if local.dimension is None or local.confined or local.dimension < columns - rank:
            bound = _free_dimension(chart, solver)
            exact = None if local.confined else local.dimension
            if exact is None and bound is not None and bound == columns - rank - 1:
                exact = bound
            dimension = None if exact is None else exact - timed
            verdict, argument = "undecided" if exact is None else "probable", local.argument or "generic points"
            reasons.append(local.reason)
    return with_reality(chart, Variety(True, dimension, verdict, samples, real, reasons, argument=argument), rank)


def _smooth(chart: Chart, point: FieldPoint, solver: TriangularSolver | None) -> bool:
    """Is the set with all parameters free a manifold at the point, of the dimension of the family drawn from?

    Then a generic fibre over the parameters is one too [Sard1942], and its dimension is the number of columns less the
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


def near_real_point(chart: Chart, real: RealPoint | None, core: Sequence[int]) -> Variety:
    """The set near a real point, without points over GF(p)."""
    if real is None:
        return Variety(None, None, "undecided", reasons=["no configuration satisfying all equations was found"])
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    if real.certified and real.consistent and real.rank == real.solved == len(core) == len(chart.nodes):
        return Variety(True, columns - real.rank - timed, "proved", [], real, argument="regular point")
    if not real.certified or not real.consistent:
        return near_singular_point(chart, Variety(True, None, "proved", [], real))
    if real.gap > 1e3:
        why = gap_in_words(real.gap, "pivot")
        dimension = columns - real.rank - timed
        return Variety(True, dimension, "numeric", [], real, [why], argument="regular point", gap=real.gap)
    return Variety(None, None, "undecided", [], real, ["only singular points were found"])
