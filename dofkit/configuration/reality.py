"""The real points of a configuration space, and what they say of an answer from points over GF(p)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flint import arb

from dofkit.base.verdicts import weakest
from dofkit.configuration import singular_points
from dofkit.configuration.generic_points import generators_of
from dofkit.configuration.variety import Variety
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.balls import jacobian
from dofkit.exact.points.real_search import RealPoint, RealSearch, at_another_time
from dofkit.exact.ring.program import values
from dofkit.exact.zero import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart

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
