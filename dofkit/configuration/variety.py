"""The type `Variety` of a block's configuration space, points over GF(p), and certified points as text."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from hashlib import sha256
from typing import Any

from flint import arb, ctx

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.base.verdicts import About, ArgumentKey, Verdict
from dofkit.exact.matrices.certified import PivotedPart
from dofkit.exact.matrices.sparse import Pivots, SparseRow, rank_of_rows, sparse_frame, without_time
from dofkit.exact.points.balls import BallPoint, RealPoint, precision, random_ball_point
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import VAR, false_without_value, gradient, reachable, value_of, values, vanish
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import GAP
from dofkit.relations.blocks import Chart
from dofkit.relations.linear_relations import explicit_relations, linear, number_coefficients


@dataclass
class Variety:
    """What is known about the set {g = 0} of a block's geometric equations; None for what is undecided.

    ``consistent``: whether it has real points. ``dimension``: of the configuration space at fixed time, of its largest
    component, or of that of the points if ``about`` is "component". ``samples``: points over GF(p) on it; ``real``: a
    real point with balls. ``argument``, ``gap``, ``witness``, ``separating``: see `Answer`. ``parted``: the points lie
    on different components.
    """

    consistent: bool | None
    dimension: int | None
    verdict: Verdict
    samples: list[FieldPoint] = field(default_factory=list)
    real: RealPoint | None = None
    reasons: list[str] = field(default_factory=list)
    about: About = "everywhere"
    argument: ArgumentKey | None = None
    gap: float = GAP
    witness: Mapping[Expr, str] | None = None
    parted: bool = False
    separating: tuple[Expr, ...] = ()


# Witnesses: a certified configuration as text

#: Digits of decimals; the certified point is within one unit of the last.
DIGITS = 25

Witness = Mapping[Expr, str]


def of_real_point(symbols: Iterable[Expr], real: RealPoint | None) -> Witness | None:
    """Return {symbol: text} of coordinates, time and named parameters at a certified real point; None without one."""
    if real is None or not real.certain or real.solved < real.part.rank:
        return None
    pose = {s: v for s, v in real.point.symbols.items() if s.args[0] != "velocity" and str(s.args[-1])[0] != "_"}
    return {**dict.fromkeys(symbols, "0"), **{s: _text(v) for s, v in pose.items()}}


def of_reference(symbols: Iterable[Expr], reference: Mapping[Expr, Expr]) -> Witness:
    """Return {symbol: text} of the reference configuration, with t = 0."""
    pose = ((s, ex.ZERO if s == ex.TIME else reference[s]) for s in symbols if s == ex.TIME or s in reference)
    return {s: "0" if value.is_zero else to_text(value) for s, value in pose}


def _text(value: Any) -> str:
    """Return an exact number as a fraction, and the middle of a ball as a decimal number."""
    ball = arb(value)
    if ball.is_exact():
        mantissa, exponent = (int(n) for n in ball.man_exp())
        return str(Fraction(mantissa) * Fraction(2) ** exponent)
    return str(ball.mid().str(DIGITS, radius=False))


# Points of the ambient space

#: Attempts at a random point.
TRIES = 60


def free_real_point(chart: Chart, seed: int) -> BallPoint | None:
    """Return a random real point of the ambient space at which all expressions have a value; None after `TRIES`."""
    with ctx.workprec(max(ctx.prec, precision())):
        for attempt in range(TRIES):
            point = random_ball_point(chart.ring, chart.setting.positive, TRIES * seed + attempt)
            try:
                values(chart.ring, point)
            except NoValueError:
                continue
            return point
    return None


#: Generators that are one branch of several functions (for signs see `components`).
BRANCHED = ("root", "asin", "atan", "atan2")


def is_unconstrained(chart: Chart) -> bool:
    """Return whether there is no relation, and no generator with several branches."""
    return not chart.nodes and all(v.kind != "sign" and v.kind not in BRANCHED for v in chart.ring.vars)


def is_parametric(chart: Chart, values: Collection[Expr]) -> bool:
    """Return whether signs may depend on unknown functions, or on symbols that have no value in ``values``."""
    return any(v.kind == "call" or (v.kind == "symbol" and v.key not in values) for v in chart.ring.vars)


def all_configurations(chart: Chart, seed: int = 0) -> Variety:
    """Return the variety of a chart without relations."""
    points = []
    if "field" in chart.setting.engines:
        points = [p for p in (pose_point(chart, {}, seed + k) for k in range(samples_for(chart))) if p is not None]
    free = free_real_point(chart, seed) if "balls" in chart.setting.engines else None
    real = None if free is None else RealPoint(free, PivotedPart(0, math.inf, [], []), True, True, [])
    return Variety(True, chart.coordinates, "proved", points, real, argument="nothing constrains")


# Points over GF(p)

#: Number of random points over GF(p), and their number if signs or roots are chosen at random.
SAMPLES, MORE_SAMPLES = 2, 6


def samples_for(chart: Chart) -> int:
    """Return the number of random points to use for a chart."""
    free = any(v.kind in ("sign", "root") and chart.ring.var_expr[v.index].symbols for v in chart.ring.vars)
    return MORE_SAMPLES if free else SAMPLES


def field_jacobian(chart: Chart, point: FieldPoint, nodes: Sequence[int] | None = None) -> list[SparseRow]:
    """Return the Jacobian over GF(p) of the relations, or of some nodes, by the columns, as sparse rows."""
    at = values(chart.ring, point)
    unit = point.number(ex.ONE.args[0])
    place = {c: i for i, c in enumerate(chart.columns) if c >= 0}
    rows = []
    for node in chart.nodes if nodes is None else nodes:
        check()
        slope = gradient(chart.ring, at, point, [(node, unit)])
        rows.append({place[c]: int(v) for c, v in slope.items() if c in place and v != 0})
    return rows


def on_variety(chart: Chart, point: FieldPoint) -> bool:
    """Return whether the point satisfies all geometric equations."""
    return vanish(chart.ring, point, chart.nodes)


def pose_point(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> FieldPoint | None:
    """Return a point over GF(p) with the exact values of a pose and random ones of other symbols; or None."""
    occurring = {s: v for s, v in pose.items() if chart.ring.var_index(s) is not None}
    fixed = _values_of_generators(chart.ring, occurring)
    if fixed is None:
        return None
    written = repr(sorted((repr(s), repr(v)) for s, v in occurring.items())).encode()
    salt = sha256(written).hexdigest() if occurring else ""  # the random values also depend on the pose
    for attempt in range(TRIES):
        try:
            point = field_point([chart.ring], 1000 * seed + attempt, salt=salt)
            for index, node in fixed:
                point.set(chart.ring.vars[index], value_of(chart.ring, point, node))
            values(chart.ring, point)
        except NoValueError as error:
            if fixed and isinstance(error, PoleError):
                return None
            continue
        return point
    return None


def point_at(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> FieldPoint | None:
    """Return the `pose_point` if it satisfies the geometric equations, otherwise None."""
    point = pose_point(chart, pose, seed)
    return None if point is None or not on_variety(chart, point) else point


def _values_of_generators(ring: Ring, pose: Mapping[Expr, Expr]) -> list[tuple[int, int]] | None:
    """Return (generator, node of its value) for the symbols of a pose and all functions of them; None if undefined."""
    settled: dict[int, int] = {}
    try:
        for var in list(ring.vars):
            expression = ring.var_expr[var.index]
            if not pose.keys().isdisjoint(expression.symbols):
                settled[var.index] = ring.node(substitute(substitute(expression, ring.alias), pose))
    except NoValueError:
        return None
    return sorted(settled.items(), key=lambda pair: pair[1])


def pose_samples(chart: Chart, pose: Mapping[Expr, Expr], seed: int) -> list[FieldPoint]:
    """Return points of the set with the values of a pose; an empty list if it does not satisfy the equations."""
    if not pose:
        return []
    points = []
    for k in range(SAMPLES):
        point = point_at(chart, pose, seed + k)
        if point is None:
            return []
        points.append(point)
    return points


def time_is_free(chart: Chart, point: FieldPoint) -> bool:
    """Return whether the differentials of the relations do not imply dt = 0 at a point."""
    rows = field_jacobian(chart, point)
    return chart.time is None or rank_of_rows(without_time(rows, chart.coordinates), point.p) == rank_of_rows(
        rows, point.p
    )


@false_without_value
def has_same_signs(chart: Chart, point: FieldPoint, real: RealPoint) -> bool:
    """Return whether all signs (of arguments of absolute values) at a point over GF(p) are those at a real point."""
    ring = chart.ring
    signs = [i for i in generators_of(chart) if ring.vars[i].kind == "sign"]
    if not signs:
        return True
    here, there = values(ring, point), values(ring, real.point)
    return all((here[ring.var_node[i]] == 1) == bool(there[ring.var_node[i]] > 0) for i in signs)


def generators_of(chart: Chart) -> set[int]:
    """Return the indices of the generators that occur in the geometric equations."""
    code = chart.ring.code
    return {code[i][1] for i in reachable(chart.ring, chart.nodes) if code[i][0] == VAR}


def chart_of_relations(chart: Chart, relations: Sequence[Expr], ring: Ring | None = None) -> Chart:
    """Return the chart with other ``relations``, and a column for each coordinate that they mention.

    With a ``ring`` all coordinates keep a column. Column -1: no relation mentions the coordinate.
    """
    mentioned = frozenset[Expr]().union(*(g.symbols for g in relations))
    symbols = chart.symbols if ring is not None else tuple(s for s in chart.symbols if s in mentioned)
    ring = Ring(relations, chart.setting.positive) if ring is None else ring
    nodes = tuple(ring.node(g) for g in relations)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols)
    return replace(chart, ring=ring, nodes=nodes, symbols=symbols, columns=columns, relations=tuple(relations))


def chart_of_rows(chart: Chart, rows: Sequence[int]) -> Chart:
    """Return a chart of some of the relations, with the columns that they mention."""
    return chart_of_relations(chart, [chart.relations[r] for r in rows])


def smaller(chart: Chart) -> tuple[Chart, int]:
    """Return (the chart after solving linear relations, number of coordinates that no relation mentions any more).

    The set is a graph over the remaining coordinates [ImplicitFunctions], times a line for each coordinate that is not
    mentioned. This eliminates angles of bodies that do not turn (theta = 0), welded bodies (x_B = x_A, theta_B =
    theta_A), and z = 0. The chart itself if nothing can be solved.
    """
    if chart.time is not None:
        return chart, 0
    solved = explicit_relations(chart.relations, lambda g: {} if linear(g) is None else number_coefficients(g))
    if not solved.explicit:
        return chart, 0
    small = chart_of_relations(chart, solved.implicit)
    return small, len(chart.symbols) - len(solved.explicit) - len(small.symbols)


def frame_at(chart: Chart, point: FieldPoint) -> Pivots:
    """Return the independent relations and the dependent columns at a point."""
    return sparse_frame(field_jacobian(chart, point), len(chart.columns), point.p)
