"""The configuration space of a block: points on it, its dimension, and how sure that is.

Two one-sided engines: a rank over GF(p) is not too small where the point is generic and not too large
where no relation between functions was missed; a rank certified with balls is not too large. Where they
agree the rank stands. A real point makes sure that there is a real configuration at all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from dofkit.base.verdicts import Verdict
from dofkit.configuration.components import by_cases, of_largest_part
from dofkit.configuration.generic_dimension import variety_at
from dofkit.configuration.generic_points import on_variety, pose_samples, samples_for
from dofkit.configuration.isolated_zeros import isolated
from dofkit.configuration.reality import near_singular_point, real_point
from dofkit.configuration.variety import Variety
from dofkit.exact.ring.instructions import VAR, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.triangular import TriangularSolver
from dofkit.exact.zero.identity import excludes_zero
from dofkit.exact.zero.independence import independent_on_set
from dofkit.expressions.tree import Expr
from dofkit.relations.ambient import free_point
from dofkit.relations.chart import Chart
from dofkit.relations.linear import presolve
from dofkit.relations.normal.no_solution import no_solution

#: More relations than this are not searched for a proof that they have no real solution.
MAX_RELATIONS = 40
EMPTY = "no real configuration satisfies the relations together: all of space is excluded by certified bounds"


def find(chart: Chart, pose: Mapping[Expr, Expr], seed: int = 0) -> Variety:
    """Generic points of the configuration space of a block, and its dimension.

    Where no real point was found it is tried to prove that there is none.
    """
    found = _variety(chart, pose, seed)
    looked = {"field", "balls"} <= chart.engines and found.consistent is not True and found.verdict != "proved"
    if looked and len(chart.relations) <= MAX_RELATIONS and no_solution(chart.relations, chart.positive):
        return Variety(False, None, "proved", reasons=[EMPTY], argument="no real solution")
    alone = isolated(chart, found) if found.consistent is None or found.dimension is None else None
    if alone is not None:
        return alone
    look = partial(_variety, pose={}, seed=seed)
    by_case = found.dimension is None and "field" in chart.engines and (found.consistent is None or found.parted)
    if by_case:
        found = by_cases(chart, found, look)
    return of_largest_part(chart, found, look, by_case)


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
        why = "linear relations contradict each other"
        return Variety(False, None, "proved", reasons=[why], argument="linear contradiction")
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
        return variety_at(chart, drawn, solver, seed, core)
    samples = pose_samples(chart, pose, seed)
    return variety_at(chart, samples, None, seed, core) if samples else _numerical(chart, seed, core)


def _has_joint_positions(chart: Chart) -> bool:
    """Is generic geometry of joints among the unknowns?"""
    return any(u.args[1].startswith("_a") for u in chart.unknowns if chart.ring.var_index(u) is not None)


def _refuted(chart: Chart, solver: TriangularSolver) -> Variety | None:
    """What elimination alone says against the relations; None where it says nothing."""
    if solver.plan.special:
        why = "the relations hold only for special values of the parameters"
        return Variety(False, None, "probable", reasons=[why], argument="number left over")
    if not solver.plan.contradictory or _signed(chart.ring, solver.plan.witness):
        return None
    if solver.plan.divided:
        why = "eliminating the unknowns leaves a number that should be 0 and is not, but divides by what may be 0"
        return Variety(None, None, "undecided", reasons=[why])
    if "balls" in chart.engines:
        certain = excludes_zero(chart.ring, solver.plan.witness, chart.positive)
    else:
        certain = independent_on_set(chart.ring, chart.nodes)
    if not certain:
        why = "eliminating the unknowns leaves a number of which it is not known whether it is 0"
        return Variety(None, None, "undecided", reasons=[why])
    why = "eliminating the unknowns leaves a number that should be 0 and is not"
    return Variety(False, None, "probable", reasons=[why], argument="number left over")


def _signed(ring: Ring, node: int) -> bool:
    """Is there a sign that varies? Another one may make 0 of what is not."""
    inside = (ring.code[i] for i in reachable(ring, [node], through_generators=False))
    return any(op == VAR and ring.vars[k].kind == "sign" and ring.var_expr[k].symbols for op, k in inside)


def _numerical(chart: Chart, seed: int, core: Sequence[int]) -> Variety:
    """Without points over GF(p): real points only."""
    real = real_point(chart, seed, core)
    if real is None:
        return Variety(None, None, "undecided", reasons=["no configuration was found that satisfies all of it"])
    columns = len(chart.columns)
    timed = columns - chart.coordinates
    if real.certified and real.consistent and real.rank == real.solved == len(core) == len(chart.nodes):
        return Variety(True, columns - real.rank - timed, "proved", [], real, argument="regular point")
    if not real.certified or not real.consistent:
        return near_singular_point(chart, Variety(True, None, "proved", [], real))
    if real.gap > 1e3:
        why = f"the gap between pivots is {real.gap:.1e}"
        dimension = columns - real.rank - timed
        return Variety(True, dimension, "numeric", [], real, [why], argument="regular point", gap=real.gap)
    return Variety(None, None, "undecided", [], real, ["the only points found are singular"])
