"""The dimension of the configuration space at its generic points, by rank, and near points that are singular.

A rank over GF(p) is compared with that at a certified real point, because the set may have no real point at all.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import ArgumentKey, Verdict, weakest
from dofkit.base.wording import gap_in_words
from dofkit.configuration.local import criteria
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.configuration.rigid_motions import rigid_motions_real
from dofkit.configuration.variety import Variety, field_jacobian, generators_of, has_same_signs, time_is_free
from dofkit.exact.matrices.certified import independent_part
from dofkit.exact.matrices.dense import length
from dofkit.exact.matrices.sparse import Pivots, rank_of_rows
from dofkit.exact.points.balls import BallPoint, RealPoint, jacobian, precision
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealSearch, at_another_time
from dofkit.exact.ring.program import false_without_value, none_without_value, raising_no_value, values
from dofkit.exact.zero import independent_on_set
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import ZERO, Expr
from dofkit.relations.blocks import Chart
from dofkit.relations.linear_relations import explicit_relations
from dofkit.relations.normal.domain import conditions_of, is_always_satisfied
from dofkit.relations.normal.sign_claims import SignClaim, are_contradictory


def variety_at(chart: Chart, samples: list[FieldPoint], seed: int, core: Sequence[int]) -> Variety:
    """Return the variety near generic points over GF(p) (``samples``), compared with a real point.

    ``core``: the relations that are used to search a real point. Points at which time is fixed, or at which a sign
    differs from that at the real point, are ignored, because they lie on other components.
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
        local = criteria.local_at(chart, samples[0], (), 0, special=False)
        if local.dimension is None or local.confined or local.dimension < columns - rank:
            exact = None if local.confined else local.dimension
            dimension = None if exact is None else exact - timed
            verdict, argument = "undecided" if exact is None else "probable", local.argument or "generic points"
            reasons.append(local.reason)
    return with_reality(chart, Variety(True, dimension, verdict, samples, real, reasons, argument=argument), rank)


def near_real_point(chart: Chart, real: RealPoint | None, core: Sequence[int]) -> Variety:
    """Return the variety by the rank at a real point, a zero of the relations ``core``, without points over GF(p)."""
    if real is None:
        return Variety(None, None, "undecided", reasons=["no configuration satisfying all equations was found"])
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    if real.certain and real.part.rank == real.solved == len(core) == len(chart.nodes):
        return Variety(True, columns - real.part.rank - timed, "proved", [], real, argument="regular point")
    if not real.certain:
        return _undecided(Variety(None, None, "undecided", [], real), SINGULAR)
    if real.part.gap > 1e3:  # `CLEAR` of at_reference
        why = gap_in_words(real.part.gap, "pivot")
        dimension = columns - real.part.rank - timed
        return Variety(True, dimension, "numeric", [], real, [why], argument="regular point", gap=real.part.gap)
    return Variety(None, None, "undecided", [], real, ["only singular points were found"])


# Real points, and their comparison with points over GF(p)

#: Bound on the columns of a block for which real points are certified with balls.
BALL_COLUMNS = 60
NEARLY = "nearly dependent equations are satisfied at a real point within its precision, but a zero was not certified"
SINGULAR = "every real configuration that was found is singular; the motions there were not decided"
ALLOWING = "the answers assume that the unknown functions are such that a real configuration exists"


def real_point(chart: Chart, seed: int, core: Sequence[int]) -> RealPoint | None:
    """Return a real zero of the relations with the nodes ``core``, with balls.

    None if none is found, balls are off, or the block is too large.
    """
    if len(chart.columns) > BALL_COLUMNS or "balls" not in chart.setting.engines:
        return None
    search = RealSearch(chart.ring, core, chart.unknowns, chart.setting.positive, chart.symbols)
    try:
        point = search.search(seed)
        return point if point is not None or not core else at_another_time(search, seed)
    except (OverflowError, ValueError, NoValueError):
        return None


def with_reality(chart: Chart, variety: Variety, rank: int) -> Variety:
    """Return the variety (changed in place) after comparing its ``rank`` over GF(p) with its real point."""
    real = variety.real
    if "balls" not in chart.setting.engines:
        return _by_field_alone(chart, variety)
    if len(chart.columns) > BALL_COLUMNS:
        variety.verdict = weakest(variety.verdict, "probable")
        return variety
    if real is None:
        return _without_reality(chart, variety)
    if not real.certain:
        return _undecided(variety, SINGULAR)
    if real.solved < real.part.rank:
        variety.verdict, variety.gap = weakest(variety.verdict, "numeric"), real.part.gap
        variety.reasons.append(NEARLY)
    if real.part.rank != rank:
        variety.verdict, variety.dimension, variety.parted = "undecided", None, True
        variety.reasons.append(
            "real points and points over GF(p) disagree about the rank: the set has several components"
        )
    elif _depends_on_unknown_function(chart):
        variety.verdict = weakest(variety.verdict, "probable")
        variety.reasons.append(ALLOWING)
    return variety


def _depends_on_unknown_function(chart: Chart) -> bool:
    """Return whether there may be no configuration for some unknown function: x^2 + h(y) = 2 has none for h = 5."""
    called = any("call" in g.functions for g in chart.relations)
    implicit = explicit_relations(chart.relations).implicit if called else ()
    several = len(implicit) > 1 or not all(_is_solvable(e, chart.setting.positive) for e in implicit)
    return any("call" in g.functions for g in implicit) and several


@false_without_value
def _is_solvable(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether e = 0 has a solution for all functions: a polynomial in a coordinate, led by a number.

    Its degree is odd, at most 9, or it has values everywhere, and where all coordinates are 0 not this number's sign.
    """
    coordinates = [s for s in e.symbols if s.args[0] == "coordinate"]
    for s in coordinates:
        slope, degree = e, 0
        while s in slope.symbols and degree < 9:
            slope, degree = diff(slope, s), degree + 1
        if slope.op == "num" and not slope.is_zero:
            start = substitute(e, dict.fromkeys(coordinates, ZERO))
            defined = all(is_always_satisfied(c, positive) for c in conditions_of(e, positive))
            if degree % 2 or (defined and are_contradictory([SignClaim(slope * start, ">")], positive)):
                return True
    return False


def _by_field_alone(chart: Chart, variety: Variety) -> Variety:
    """Return what points over GF(p) alone show: probable at most, undecided if an identity may have been missed."""
    if independent_on_set(chart.ring, chart.nodes):
        variety.verdict = weakest(variety.verdict, "probable")
        return variety
    return _undecided(variety, "the functions that occur may satisfy an identity that points over GF(p) do not detect")


def _without_reality(chart: Chart, variety: Variety) -> Variety:
    """Return the variety without a real point: undecided, unless an unknown function may be such that one exists."""
    calls = any(chart.ring.vars[i].kind == "call" for i in generators_of(chart))
    if calls:
        variety.verdict = weakest(variety.verdict, "probable")
        variety.reasons.append(ALLOWING)
        return variety
    return _undecided(variety, "no real configuration was found, and none was excluded")


def _undecided(variety: Variety, why: str) -> Variety:
    variety.consistent, variety.dimension, variety.verdict = None, None, "undecided"
    variety.reasons.append(why)
    return variety


def near_singular_point(chart: Chart, variety: Variety) -> Variety:
    """Return the variety near a singular real point, if only such points were found; otherwise ``variety``.

    With other values of a real parameter there may be others: y^2 = (a - 5) x^2 is a pair of lines for a > 5.
    """
    real = variety.real
    if real is None or real.certain:
        return variety
    drawn = real.point.symbols.keys() - chart.setting.positive.union(chart.unknowns)
    if any(s.args[0] == "parameter" for s in drawn):
        return variety
    local = numeric_local(chart, real)
    if local is None or local.dimension is None or local.confined:
        return variety
    dimension = local.dimension - (len(chart.columns) - chart.coordinates)
    reasons = [f"every real configuration that was found is singular: {local.reason}"]
    return Variety(True, dimension, "numeric", variety.samples, real, reasons, argument=local.argument)


# Singular real points without exact coordinates, computed in high precision and analysed to second order

#: Working precision in bits; the radius of the resulting point is 2^-RADIUS_BITS.
BITS, RADIUS_BITS = 1400, 200
#: Bound on the steps; a point is reached when the relations are below 2^-RESIDUAL_BITS.
STEPS, RESIDUAL_BITS = 800, 600
#: Within `PERIOD` steps the relations have to decrease by `GAIN`: convergence to a singular point is linear.
PERIOD, GAIN = 50, arb(2) ** -16
#: Rows count as dependent if a combination is below 2^-DEPENDENT_BITS, so that surfaces with a gap of 10^-64 do not.
DEPENDENT_BITS = 280
#: Added to the diagonal of a Gram matrix, so that it has an inverse.
SHIFT = arb(2) ** (-BITS // 2)
#: Bound on the relations of a singular point; entries of a Jacobian up to TINY count as 0.
MAX_ROWS, TINY = 20, 1e-12


@none_without_value
def numeric_local(chart: Chart, real: RealPoint) -> LocalDimension | None:
    """Return the local dimension near a singular point that a real search converged to; None if it is not known."""
    if len(chart.nodes) > MAX_ROWS or precision() > DEPENDENT_BITS:
        return None  # long numbers may differ by less than what counts as 0
    with ctx.workprec(BITS):
        return _dimension_near(chart, real)


@raising_no_value
def _dimension_near(chart: Chart, real: RealPoint) -> LocalDimension | None:
    """Return the local dimension at the singular point near ``real``, in high precision."""
    point = _converge(chart, real)
    if point is None:
        return None
    at = values(chart.ring, point)
    columns = [c for c in chart.columns if c >= 0]
    place = [i for i, c in enumerate(chart.columns) if c >= 0]
    exact = jacobian(chart.ring, at, point, chart.nodes, columns, arb(0))
    j = [[float(v.mid()) for v in row] for row in exact]
    _, gap, rows, pivots = independent_part([row if length(row) >= TINY else [0.0] * len(row) for row in j])
    if gap < 1e6:
        return None
    dependent = tuple(place[c] for c in pivots)
    free = tuple(i for i in range(len(chart.columns)) if i not in set(dependent))
    frame = Pivots(tuple(rows), dependent, free)
    manifold = Manifold(chart.ring, chart.nodes, chart.columns, frame, point, chart.scales)
    return criteria.local_dimension(Germ(None, manifold, rigid_motions_real(chart, point), chart.time))


def _converge(chart: Chart, real: RealPoint) -> BallPoint | None:
    """Return the point, in balls, to which Newton's method with minimal steps converges; None if it is regular.

    If the dependent relations are Morse-Bott there, each step about halves the distance, so that high precision needs
    as many steps as it has bits. None also if it does not converge.
    """
    symbols: dict[Any, arb] = {s: arb(v.mid()) if isinstance(v, arb) else arb(v) for s, v in real.point.symbols.items()}
    moved = [s for s in chart.unknowns if chart.ring.var_index(s) is not None]
    last: arb | None = None
    for step in range(STEPS):
        f, j = _system(chart, symbols, moved)
        size = max((abs(v) for v in f), default=arb(0))
        if size < arb(2) ** -RESIDUAL_BITS:
            break
        if step % PERIOD == 0:
            if last is not None and not size < last * GAIN:
                return None
            last = size
        for s, d in zip(moved, _minimal_step(j, f), strict=True):
            symbols[s] = (symbols[s] - d).mid()
    else:
        return None
    if not _is_singular(_system(chart, symbols, moved)[1]):
        return None
    radius = arb(0, arb(2) ** -RADIUS_BITS)
    return BallPoint({s: v + radius if s in set(moved) else v for s, v in symbols.items()})


def _system(chart: Chart, symbols: Mapping[Any, arb], moved: Sequence[Expr]) -> tuple[list[arb], list[list[arb]]]:
    """Return the relations' values and their Jacobian by ``moved``, as exact numbers (midpoints)."""
    check()
    point = BallPoint(symbols)
    at = values(chart.ring, point)
    indices = [chart.ring.var_index(s) or 0 for s in moved]
    j = jacobian(chart.ring, at, point, chart.nodes, indices, arb(0))
    return [arb(at[n].mid()) for n in chart.nodes], [[v.mid() for v in row] for row in j]


def _is_singular(j: Sequence[Sequence[arb]]) -> bool:
    """Return whether some rows are dependent, in floating point and in high precision."""
    matrix = [[float(v) for v in row] for row in j]
    if not all(math.isfinite(v) for row in matrix for v in row):
        return False
    rank, _, rows, pivots = independent_part([[0.0 if abs(v) < TINY else v for v in row] for row in matrix])
    others = [list(row) for r, row in enumerate(j) if r not in rows]
    if rank == 0 or not others:
        remainders = others
    else:
        basis = arb_mat([[j[r][c] for c in pivots] for r in rows])
        weights = arb_mat([[row[c] for c in pivots] for row in others]) * basis.inv()
        remainders = (arb_mat(others) - weights * arb_mat([list(j[r]) for r in rows])).tolist()
    return bool(others) and all(abs(v.mid()) < arb(2) ** -DEPENDENT_BITS for row in remainders for v in row)


def _minimal_step(j: Sequence[Sequence[arb]], f: Sequence[arb]) -> list[arb]:
    """Return the shortest d with J d = f: J^T (J J^T)^-1 f."""
    matrix = arb_mat(j)
    gram = matrix * matrix.transpose()
    n = gram.nrows()
    for i in range(n):
        gram[i, i] = gram[i, i].mid() + SHIFT
    step = matrix.transpose() * gram.solve(arb_mat([[v] for v in f]))
    return [step[i, 0].mid() for i in range(step.nrows())]
