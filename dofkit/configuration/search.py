"""The configuration space of a block without a reference: generic points, dimension, and how certain this is (`find`).

A rank over GF(p) is not too small if the point is generic, and not too large if no relation between functions was
missed; a rank certified with balls is not too large. So the rank is right if both agree. A certified real point proves
that there is a real configuration at all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import partial

from dofkit.base.errors import NoValueError
from dofkit.configuration.components import by_cases, largest_component
from dofkit.configuration.generic_dimension import (
    ALLOWING,
    near_real_point,
    near_singular_point,
    real_point,
    variety_at,
)
from dofkit.configuration.variety import (
    Variety,
    all_configurations,
    on_variety,
    pose_samples,
    samples_for,
    time_is_free,
)
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import VAR, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import excludes_zero, independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Chart, make_chart
from dofkit.relations.linear_relations import Explicit, explicit_relations, linear, number_coefficients, solve_linear
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.setting import Setting

#: Bound on the relations for a proof that they have no real solution.
MAX_RELATIONS = 40
FIXED = "at the points that were found the geometric equations fix the time: no motion passes through them"
EMPTY = "no real configuration satisfies all equations: signs of terms, or a resultant, exclude every real solution"


def find(chart: Chart, pose: Mapping[Expr, Expr], seed: int = 0) -> Variety:
    """Return the variety of a block: generic points and the largest dimension; or a proof that it has no real point."""
    variety, find_variety = _variety(chart, pose, seed), partial(_variety, pose={}, seed=seed)
    if _fixes_time(chart, variety):
        variety = Variety(None, None, "undecided", reasons=[FIXED], parted=True)
    timed = chart.time is not None and variety.consistent is None and "field" in chart.setting.engines
    if timed:
        variety = by_cases(chart, variety, find_variety)
    near = near_singular_point(chart, variety) if variety.consistent is None else variety
    no_point = near is variety and (variety.consistent is not True or ALLOWING in variety.reasons)
    may_be_empty = {"field", "balls"} <= chart.setting.engines and no_point and variety.verdict != "proved"
    if may_be_empty and len(chart.relations) <= MAX_RELATIONS and no_solution(chart.relations, chart.setting.positive):
        return Variety(False, None, "proved", reasons=[EMPTY], argument="no real solution")
    by_case = (
        variety.dimension is None
        and "field" in chart.setting.engines
        and (variety.consistent is None or variety.parted)
    )
    if by_case and not timed:
        variety = by_cases(chart, variety, find_variety)
    if variety.consistent is not False and variety.dimension is None and near.dimension is not None:
        return largest_component(chart, near, find_variety)
    return largest_component(chart, variety, find_variety, by_case or timed)


def _fixes_time(chart: Chart, variety: Variety) -> bool:
    """Return whether the relations determine the time near all points that were found."""
    if chart.time is None or not variety.consistent:
        return False
    if variety.samples or variety.real is None:
        return bool(variety.samples) and not time_is_free(chart, variety.samples[0])
    ranked = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    rows = [[v for v, s in zip(row, ranked, strict=True) if s != ex.TIME] for row in variety.real.matrix]
    return ball_part(rows).rank < variety.real.part.rank


def _variety(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> Variety:
    """Return the variety near the first points that are found: over GF(p) by elimination, at the pose, or real ones."""
    if not chart.nodes:
        return all_configurations(chart, seed)
    generic = (u.args[1] for u in chart.unknowns if chart.ring.var_index(u) is not None)
    if "field" in chart.setting.engines and any(name.startswith("_a") for name in generic):  # of joints
        posed = pose_samples(chart, pose, seed)
        if posed:
            return variety_at(chart, posed, seed, chart.nodes)
    solved = solve_linear(chart.relations)
    if solved.contradictory:
        why = "the linear equations contradict each other"
        return Variety(False, None, "proved", reasons=[why], argument="linear contradiction")
    if "field" not in chart.setting.engines:
        return near_real_point(chart, real_point(chart, seed, chart.nodes), chart.nodes)
    core = [n for i, n in enumerate(chart.nodes) if i not in solved.implied]
    for explicit, others in _reductions(chart, solved):
        reduced = [*(s - value for s, value in explicit.values.items()), *explicit.implicit]
        solver = TriangularSolver(chart.ring, [*map(chart.ring.node, reduced), *others], seed=seed)
        refuted = _refuted(chart, solver)
        if refuted is not None:
            return refuted
        points = _random_points(chart, solver, seed)
        if points:
            return variety_at(chart, points, seed, core)
    samples = pose_samples(chart, pose, seed)
    if samples:
        return variety_at(chart, samples, seed, core)
    real = real_point(chart, seed, core)
    independent = [] if real is None else [core[row] for row in real.part.rows]
    if 0 < len(independent) < len(core):  # what depends on them leaves them one unknown each
        samples = _random_points(chart, TriangularSolver(chart.ring, independent, seed=seed), seed)
    return variety_at(chart, samples, seed, core) if samples else near_real_point(chart, real, core)


def _random_points(chart: Chart, solver: TriangularSolver, seed: int) -> list[FieldPoint]:
    """Return random points over GF(p) that a solver of some relations finds, as far as they satisfy all."""
    points = (solver.draw(seed + k + 1) for k in range(samples_for(chart)))
    return [p for p in points if p is not None and on_variety(chart, p)]


def _reductions(chart: Chart, solved: Explicit) -> Iterator[tuple[Explicit, list[int]]]:
    """Yield (solved relations, nodes of the other relations): first only linear ones are solved, then others as well.

    The second way is not used with roots, signs and logarithms, which would be other generators after substitution.
    """
    yield solved, [n for n, g in zip(chart.nodes, chart.relations, strict=True) if linear(g) is None]
    kinds = {v.kind for v in chart.ring.vars if chart.ring.var_expr[v.index].symbols}
    if kinds.isdisjoint(("root", "sign", "log")):
        with suppress(NoValueError):
            yield explicit_relations(chart.relations, number_coefficients), []


def _refuted(chart: Chart, solver: TriangularSolver) -> Variety | None:
    """Return an empty or undecided variety if elimination leaves a nonzero number; None if it does not."""
    if not solver.plan.contradictory or _signed(chart.ring, solver.plan.witness):
        return None
    if "balls" in chart.setting.engines:
        certain = excludes_zero(chart.ring, solver.plan.witness, chart.setting.positive)
    else:
        certain = independent_on_set(chart.ring, chart.nodes)
    if not certain:
        why = "eliminating the unknowns leaves a number that could not be proved to be zero or nonzero"
        return Variety(None, None, "undecided", reasons=[why])
    why = "eliminating the unknowns leaves a number that should be 0 and is not"
    return Variety(False, None, "probable", reasons=[why], argument="number left over")


def _signed(ring: Ring, node: int) -> bool:
    """Return whether a sign of a nonconstant expression occurs in a node, which may be 0 for another sign."""
    inside = (ring.code[i] for i in reachable(ring, [node], through_generators=False))
    return any(op == VAR and ring.vars[k].kind == "sign" and ring.var_expr[k].symbols for op, k in inside)


# Level bodies: at theta = 0 the Euler angles phi and psi are rotations about the same axis (gimbal lock)

#: Number of configurations that are examined, and the sine that counts as 0.
EXAMINED, SINGULAR = 6, 1e-6
LEVEL = (
    "configurations were found where sin({}) is 0: the other Euler angles turn alike there, so that coordinates are no "
    "poses; a `coupling` of joints says such an equation"
)


def level_angle(block: Block, setting: Setting) -> str | None:
    """Return the name of a tilt (second Euler angle) of the block that is 0 or pi in some configuration, or None.

    The set has then a component on which the body is level, and its dimension may be that of this component.
    """
    tilts = setting.tilts.intersection(block.coordinates)
    if not tilts or not block.finite:
        return None
    chart = make_chart(block, setting)
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.setting.positive, chart.symbols)
    for seed in range(EXAMINED):
        symbols = search.start(seed, {})
        if search.descend(symbols, seed) is not None:
            level = [name for name in tilts if abs(math.sin(symbols.get(ex.coordinate(name), 1.0))) < SINGULAR]
            if level:
                return min(level)
    return None
