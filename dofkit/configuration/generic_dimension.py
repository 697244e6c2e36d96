"""The dimension of the configuration space at its generic points: by rank, and by what is singular all over it.

A rank over GF(p) is held against a certified real point, without which a set over GF(p) says nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flint import arb

from dofkit.base.deadline import check
from dofkit.base.verdicts import ArgumentKey, Verdict, weakest
from dofkit.base.wording import gap_in_words
from dofkit.configuration import singular_points
from dofkit.configuration.generic_points import field_jacobian, generators_of, has_same_signs, time_is_free
from dofkit.configuration.local import criteria
from dofkit.configuration.variety import Variety
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of, rank_of_rows
from dofkit.exact.points.balls import jacobian
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealPoint, RealSearch, at_another_time
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
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
        local = criteria.local_at(chart, samples[0], None, 0, chart.time, drawn=False)
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


# Real points, and what they say of an answer from points over GF(p)

#: Blocks with more columns than this are not certified with balls.
BALL_COLUMNS = 60
NEARLY = "nearly dependent equations are satisfied at a real point within its precision, but a zero was not certified"
ALLOWING = "the answers assume that the unknown functions are such that a real configuration exists"


def real_point(chart: Chart, seed: int, core: Sequence[int]) -> RealPoint | None:
    """A real point of the nodes ``core``, with balls; None where none is found, or none is looked for."""
    if len(chart.columns) > BALL_COLUMNS or "balls" not in chart.engines:
        return None
    search = RealSearch(chart.ring, core, chart.unknowns, chart.positive, chart.symbols)
    try:
        found = search.search(seed)
        return found if found is not None or not core else at_another_time(search, seed)
    except (OverflowError, ValueError, NoValueError):
        return None


def with_reality(chart: Chart, found: Variety, rank: int) -> Variety:
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
        return near_singular_point(chart, found)
    if real.solved < real.rank:
        found.verdict, found.gap = weakest(found.verdict, "numeric"), real.gap
        found.reasons.append(NEARLY)
    if real.rank != rank:
        found.verdict, found.dimension, found.parted = "undecided", None, True
        found.reasons.append(
            "real points and points over GF(p) disagree about the rank: the set has several components"
        )
    elif any(map(_hangs_on_a_function, chart.relations)):
        found.verdict = weakest(found.verdict, "probable")
        found.reasons.append(ALLOWING)
    return found


def most_near(chart: Chart, real: RealPoint | None) -> int | None:
    """A bound of the set's dimension near a real point, by the rank of all relations there [ImplicitFunctions]."""
    if real is None or not real.certified:
        return None
    columns = [i for s in chart.symbols if (i := chart.ring.var_index(s)) is not None]
    try:
        at = values(chart.ring, real.point)
        part = ball_part(jacobian(chart.ring, at, real.point, chart.nodes, columns, arb(0)))
    except (NoValueError, KeyError):
        return None
    return chart.coordinates - part.rank


def _hangs_on_a_function(e: Expr) -> bool:
    """Do coordinates stand within unknown functions only? h(x) = 0 holds somewhere for some h, not for all."""
    within = any(node.op == "call" for node in ex.nodes(e))
    return within and not any(s.args[0] == "coordinate" for s in _outside_calls(e))


def _outside_calls(e: Expr) -> Iterator[Expr]:
    if e.op == "sym":
        yield e
    elif e.op != "call":
        for child in ex.children(e):
            yield from _outside_calls(child)


def _by_field_alone(chart: Chart, found: Variety) -> Variety:
    """Without balls a rank stands only where no relation between functions can have been missed."""
    if independent_on_set(chart.ring, chart.nodes):
        found.verdict = weakest(found.verdict, "probable")
        return found
    found.consistent, found.dimension, found.verdict = None, None, "undecided"
    found.reasons.append("the functions that occur may satisfy an identity that points over GF(p) do not detect")
    return found


def _without_reality(chart: Chart, found: Variety) -> Variety:
    """No real point: an unknown function may be chosen so that there is one; else nothing is known."""
    calls = any(chart.ring.vars[i].kind == "call" for i in generators_of(chart))
    if calls:
        found.verdict = weakest(found.verdict, "probable")
        found.reasons.append(ALLOWING)
        return found
    found.consistent, found.dimension, found.verdict = None, None, "undecided"
    found.reasons.append("no real configuration was found, and none was excluded")
    return found


def near_singular_point(chart: Chart, found: Variety) -> Variety:
    """All real points that were found are singular: the dimension is that of the set near one of them."""
    real = found.real
    local = None if real is None else singular_points.numeric_local(chart, real)
    if local is None or local.dimension is None or local.confined:
        found.consistent = None
        found.verdict, found.dimension = "undecided", None
        found.reasons.append("every real configuration that was found is singular; the motions there were not decided")
        return found
    found.dimension = local.dimension - (len(chart.columns) - chart.coordinates)
    found.verdict, found.argument = weakest(found.verdict, "numeric"), local.argument
    found.reasons.append(f"every real configuration that was found is singular: {local.reason}")
    return found
