"""The dimension of the configuration space at its generic points, by rank.

A rank over GF(p) is held against a certified real point, without which a set over GF(p) says nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import ArgumentKey, Verdict, weakest
from dofkit.base.wording import gap_in_words
from dofkit.configuration.local import criteria
from dofkit.configuration.variety import Variety, field_jacobian, generators_of, has_same_signs, time_is_free
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealPoint, RealSearch, at_another_time
from dofkit.exact.zero import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart


def variety_at(chart: Chart, samples: list[FieldPoint], seed: int, core: Sequence[int]) -> Variety:
    """Return the set near generic points over GF(p) that lie on it, held against a real point.

    ``core``: relations to search a real point of. Points at which the time is fixed, or at which a sign is another than
    at the real point, lie on other parts of the set.
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
    if rank < len(chart.nodes):
        local = criteria.local_at(chart, samples[0], None, 0, chart.time, drawn=False)
        if local.dimension is None or local.confined or local.dimension < columns - rank:
            exact = None if local.confined else local.dimension
            dimension = None if exact is None else exact - timed
            verdict, argument = "undecided" if exact is None else "probable", local.argument or "generic points"
            reasons.append(local.reason)
    return with_reality(chart, Variety(True, dimension, verdict, samples, real, reasons, argument=argument), rank)


def near_real_point(chart: Chart, real: RealPoint | None, core: Sequence[int]) -> Variety:
    """Return the set near a real point, without points over GF(p)."""
    if real is None:
        return Variety(None, None, "undecided", reasons=["no configuration satisfying all equations was found"])
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    if real.certified and real.consistent and real.part.rank == real.solved == len(core) == len(chart.nodes):
        return Variety(True, columns - real.part.rank - timed, "proved", [], real, argument="regular point")
    if not real.certified or not real.consistent:
        return _left_open(Variety(None, None, "undecided", [], real), SINGULAR)
    if real.part.gap > 1e3:
        why = gap_in_words(real.part.gap, "pivot")
        dimension = columns - real.part.rank - timed
        return Variety(True, dimension, "numeric", [], real, [why], argument="regular point", gap=real.part.gap)
    return Variety(None, None, "undecided", [], real, ["only singular points were found"])


# Real points, and what they say of an answer from points over GF(p)

#: Blocks with more columns than this are not certified with balls.
BALL_COLUMNS = 60
NEARLY = "nearly dependent equations are satisfied at a real point within its precision, but a zero was not certified"
SINGULAR = "every real configuration that was found is singular; the motions there were not decided"
ALLOWING = "the answers assume that the unknown functions are such that a real configuration exists"


def real_point(chart: Chart, seed: int, core: Sequence[int]) -> RealPoint | None:
    """Return a real point of the nodes ``core``, with balls; None where none is found, or none is looked for."""
    if len(chart.columns) > BALL_COLUMNS or "balls" not in chart.setting.engines:
        return None
    search = RealSearch(chart.ring, core, chart.unknowns, chart.setting.positive, chart.symbols)
    try:
        point = search.search(seed)
        return point if point is not None or not core else at_another_time(search, seed)
    except (OverflowError, ValueError, NoValueError):
        return None


def with_reality(chart: Chart, variety: Variety, rank: int) -> Variety:
    """Hold the real point against what the field said."""
    real = variety.real
    if "balls" not in chart.setting.engines:
        return _by_field_alone(chart, variety)
    if len(chart.columns) > BALL_COLUMNS:
        variety.verdict = weakest(variety.verdict, "probable")
        return variety
    if real is None:
        return _without_reality(chart, variety)
    if not real.certified or not real.consistent:
        return _left_open(variety, SINGULAR)
    if real.solved < real.part.rank:
        variety.verdict, variety.gap = weakest(variety.verdict, "numeric"), real.part.gap
        variety.reasons.append(NEARLY)
    if real.part.rank != rank:
        variety.verdict, variety.dimension, variety.parted = "undecided", None, True
        variety.reasons.append(
            "real points and points over GF(p) disagree about the rank: the set has several components"
        )
    elif any(map(_hangs_on_a_function, chart.relations)):
        variety.verdict = weakest(variety.verdict, "probable")
        variety.reasons.append(ALLOWING)
    return variety


def _hangs_on_a_function(e: Expr) -> bool:
    """Return whether coordinates stand in unknown functions only: h(x) = 0 holds somewhere for some h, not for all."""
    within = any(node.op == "call" for node in ex.nodes(e))
    return within and not any(s.args[0] == "coordinate" for s in _outside_calls(e))


def _outside_calls(e: Expr) -> Iterator[Expr]:
    if e.op == "sym":
        yield e
    elif e.op != "call":
        for child in ex.children(e):
            yield from _outside_calls(child)


def _by_field_alone(chart: Chart, variety: Variety) -> Variety:
    """Without balls a rank stands only where no relation between functions can have been missed."""
    if independent_on_set(chart.ring, chart.nodes):
        variety.verdict = weakest(variety.verdict, "probable")
        return variety
    return _left_open(variety, "the functions that occur may satisfy an identity that points over GF(p) do not detect")


def _without_reality(chart: Chart, variety: Variety) -> Variety:
    """No real point: an unknown function may be chosen so that there is one; else nothing is known."""
    calls = any(chart.ring.vars[i].kind == "call" for i in generators_of(chart))
    if calls:
        variety.verdict = weakest(variety.verdict, "probable")
        variety.reasons.append(ALLOWING)
        return variety
    return _left_open(variety, "no real configuration was found, and none was excluded")


def _left_open(variety: Variety, why: str) -> Variety:
    variety.consistent, variety.dimension, variety.verdict = None, None, "undecided"
    variety.reasons.append(why)
    return variety
