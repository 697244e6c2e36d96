"""Points of the configuration space of a block, its dimension, and how certain that is.

Two one-sided engines: a rank over GF(p) is not too small where the point is generic and not too large where no relation
between functions was missed; a rank certified with balls is not too large. Where they agree the rank stands. A real
point makes certain that there is a real configuration at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from dofkit.base.verdicts import Verdict
from dofkit.configuration.components import by_cases, of_largest_part
from dofkit.configuration.generic_dimension import ALLOWING, near_real_point, real_point, variety_at
from dofkit.configuration.generic_points import on_variety, pose_samples, samples_for, time_is_free
from dofkit.configuration.variety import Variety
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.ring.program import VAR, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import excludes_zero, independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import presolve
from dofkit.relations.chart import Chart, free_point
from dofkit.relations.normal.no_solution import no_solution

#: More relations than this are not searched for a proof that they have no real solution.
MAX_RELATIONS = 40
FIXED = "at the points that were found the geometric equations fix the time: no motion passes through them"
EMPTY = "no real configuration satisfies all equations: interval bounds exclude every real solution"


def find(chart: Chart, pose: Mapping[Expr, Expr], seed: int = 0) -> Variety:
    """Generic points of the configuration space of a block, and its dimension.

    Where no real point was found it is tried to prove that there is none.
    """
    found, look = _variety(chart, pose, seed), partial(_variety, pose={}, seed=seed)
    if _fixes_time(chart, found):
        found = Variety(None, None, "undecided", reasons=[FIXED], parted=True)
    timed = chart.time is not None and found.consistent is None and "field" in chart.engines
    if timed:
        found = by_cases(chart, found, look)
    unseen = found.consistent is not True or ALLOWING in found.reasons
    looked = {"field", "balls"} <= chart.engines and unseen and found.verdict != "proved"
    if looked and len(chart.relations) <= MAX_RELATIONS and no_solution(chart.relations, chart.positive):
        return Variety(False, None, "proved", reasons=[EMPTY], argument="no real solution")
    by_case = found.dimension is None and "field" in chart.engines and (found.consistent is None or found.parted)
    if by_case and not timed:
        found = by_cases(chart, found, look)
    return of_largest_part(chart, found, look, by_case or timed)


def _fixes_time(chart: Chart, found: Variety) -> bool:
    """Return whether the relations hold at single instants only near all points that were found."""
    if chart.time is None or not found.consistent:
        return False
    if found.samples or found.real is None:
        return bool(found.samples) and not time_is_free(chart, found.samples[0])
    ranked = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    rows = [[v for v, s in zip(row, ranked, strict=True) if s != ex.TIME] for row in found.real.matrix]
    return ball_part(rows).rank < found.real.rank


def _variety(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> Variety:
    if not chart.nodes:
        points = []
        if "field" in chart.engines:
            points = [p for p in (free_point(chart, seed + k) for k in range(samples_for(chart))) if p is not None]
        real = real_point(chart, seed, ())
        verdict: Verdict = "proved"
        return Variety(True, chart.coordinates, verdict, points, real, argument="nothing constrains")
    if "field" in chart.engines and _has_joint_positions(chart):
        posed = pose_samples(chart, pose, seed)
        if posed:
            return variety_at(chart, posed, None, seed, chart.nodes)
    linear = presolve(chart.relations if "eliminations" in chart.reductions else ())
    if linear.contradiction:
        why = "the linear equations contradict each other"
        return Variety(False, None, "proved", reasons=[why], argument="linear contradiction")
    if "field" not in chart.engines:
        return near_real_point(chart, real_point(chart, seed, chart.nodes), chart.nodes)
    core = [n for i, n in enumerate(chart.nodes) if i not in linear.superfluous]
    others = [n for i, n in enumerate(chart.nodes) if i not in linear.linear]
    solver = TriangularSolver(chart.ring, [*(chart.ring.node(e) for e in linear.reduced), *others], seed=seed)
    refuted = _refuted(chart, solver)
    if refuted is not None:
        return refuted
    drawn = [p for p in (solver.draw(seed + k + 1) for k in range(samples_for(chart))) if p is not None]
    drawn = [p for p in drawn if on_variety(chart, p)]
    if drawn:
        return variety_at(chart, drawn, solver, seed, core)
    samples = pose_samples(chart, pose, seed)
    return (
        variety_at(chart, samples, None, seed, core)
        if samples
        else near_real_point(chart, real_point(chart, seed, core), core)
    )


def _has_joint_positions(chart: Chart) -> bool:
    """Is generic geometry of joints among the unknowns?"""
    return any(u.args[1].startswith("_a") for u in chart.unknowns if chart.ring.var_index(u) is not None)


def _refuted(chart: Chart, solver: TriangularSolver) -> Variety | None:
    """What elimination alone says against the relations; None where it says nothing."""
    if solver.plan.special:
        why = "the equations can be satisfied only for special values of the parameters"
        return Variety(False, None, "probable", reasons=[why], argument="number left over")
    if not solver.plan.contradictory or _signed(chart.ring, solver.plan.witness):
        return None
    if solver.plan.divided:
        why = (
            "eliminating the unknowns leaves a number that should be 0 and is not, but divides by a term that may be 0"
        )
        return Variety(None, None, "undecided", reasons=[why])
    if "balls" in chart.engines:
        certain = excludes_zero(chart.ring, solver.plan.witness, chart.positive)
    else:
        certain = independent_on_set(chart.ring, chart.nodes)
    if not certain:
        why = "eliminating the unknowns leaves a number that could not be proved to be zero or nonzero"
        return Variety(None, None, "undecided", reasons=[why])
    why = "eliminating the unknowns leaves a number that should be 0 and is not"
    return Variety(False, None, "probable", reasons=[why], argument="number left over")


def _signed(ring: Ring, node: int) -> bool:
    """Is there a sign that varies? Another one may make 0 of what is not."""
    inside = (ring.code[i] for i in reachable(ring, [node], through_generators=False))
    return any(op == VAR and ring.vars[k].kind == "sign" and ring.var_expr[k].symbols for op, k in inside)
