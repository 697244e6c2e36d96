"""The configuration space of a block as far as it is known, its points over GF(p), and certified points as text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
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
    """The set {g = 0} of a block's geometric equations, as far as it is known.

    ``consistent``: None where it is not known. ``dimension``: of the configuration space at fixed time (None:
    not decided). ``samples``: points over GF(p) on it; ``real``: a real point with balls; ``about``: is it about
    the component of largest dimension, or the ``component`` of these points? ``argument``, ``gap``, ``witness``: see
    `Answer`. ``parted``: these points lie on different parts of it. ``separating``: expressions each of which vanishes
    on every component of this dimension, where there may be others.
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

#: Digits of what is no short number; the point that is certified lies within one unit of the last.
DIGITS = 25

Witness = Mapping[Expr, str]


def of_real_point(symbols: Iterable[Expr], real: RealPoint | None) -> Witness | None:
    """Coordinates, time and named parameters at a point whose ball holds a true zero; None without one."""
    if real is None or not real.certain or real.solved < real.part.rank:
        return None
    pose = {s: v for s, v in real.point.symbols.items() if s.args[0] != "velocity" and str(s.args[-1])[0] != "_"}
    return {**dict.fromkeys(symbols, "0"), **{s: _text(v) for s, v in pose.items()}}


def of_reference(symbols: Iterable[Expr], reference: Mapping[Expr, Expr]) -> Witness:
    """Return the reference configuration; t = 0 there."""
    pose = ((s, ex.ZERO if s == ex.TIME else reference[s]) for s in symbols if s == ex.TIME or s in reference)
    return {s: "0" if value.is_zero else to_text(value) for s, value in pose}


def _text(value: Any) -> str:
    ball = arb(value)
    if ball.is_exact():
        mantissa, exponent = (int(n) for n in ball.man_exp())
        return str(Fraction(mantissa) * Fraction(2) ** exponent)
    return str(ball.mid().str(DIGITS, radius=False))


# Points of the ambient space

#: Random points that are tried.
TRIES = 60


def free_real_point(chart: Chart, seed: int) -> BallPoint | None:
    """Return a random real point of the ambient space at which the program runs."""
    with ctx.workprec(max(ctx.prec, precision())):
        for attempt in range(TRIES):
            point = random_ball_point(chart.ring, chart.setting.positive, TRIES * seed + attempt)
            try:
                values(chart.ring, point)
            except NoValueError:
                continue
            return point
    return None


#: Functions that are one branch of several; of the sign of an expression see `components`.
BRANCHED = ("root", "asin", "atan", "atan2")


def is_unconstrained(chart: Chart) -> bool:
    """Return whether every configuration is allowed, and every function is the same one at all of them."""
    return not chart.nodes and all(v.kind != "sign" and v.kind not in BRANCHED for v in chart.ring.vars)


def all_configurations(chart: Chart, seed: int = 0) -> Variety:
    """Return the set of all configurations, where there is no relation."""
    points = []
    if "field" in chart.setting.engines:
        points = [p for p in (pose_point(chart, {}, seed + k) for k in range(samples_for(chart))) if p is not None]
    free = free_real_point(chart, seed) if "balls" in chart.setting.engines else None
    real = None if free is None else RealPoint(free, PivotedPart(0, math.inf, [], []), True, True, [])
    return Variety(True, chart.coordinates, "proved", points, real, argument="nothing constrains")


# Points over GF(p)

#: Points over GF(p) that must agree.
SAMPLES, MORE_SAMPLES = 2, 6


def samples_for(chart: Chart) -> int:
    """More points where signs and roots may be chosen differently at each."""
    free = any(v.kind in ("sign", "root") and chart.ring.var_expr[v.index].symbols for v in chart.ring.vars)
    return MORE_SAMPLES if free else SAMPLES


def field_jacobian(chart: Chart, point: FieldPoint, nodes: Sequence[int] | None = None) -> list[SparseRow]:
    """dg/d(columns) over GF(p), row by row without zeros."""
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
    """Return a point over GF(p): given symbols have their exact values, others random ones; everything has a value."""
    occurring = {s: v for s, v in pose.items() if chart.ring.var_index(s) is not None}
    fixed = _values_of_generators(chart.ring, occurring)
    if fixed is None:
        return None
    written = repr(sorted((repr(s), repr(v)) for s, v in occurring.items())).encode()
    salt = sha256(written).hexdigest() if occurring else ""
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
    """Return a point over GF(p) of the set at which given symbols have their values; None where there is none."""
    point = pose_point(chart, pose, seed)
    return None if point is None or not on_variety(chart, point) else point


def _values_of_generators(ring: Ring, pose: Mapping[Expr, Expr]) -> list[tuple[int, int]] | None:
    """(generator, node of its value) for symbols and for the functions of them that have a known value."""
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
    """Points of the set at which the symbols have the given values; none where some of them are not on it."""
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
    """Return whether the differentials of the relations leave the time free at a point."""
    rows = field_jacobian(chart, point)
    return chart.time is None or rank_of_rows(without_time(rows, chart.coordinates), point.p) == rank_of_rows(
        rows, point.p
    )


@false_without_value
def has_same_signs(chart: Chart, point: FieldPoint, real: RealPoint) -> bool:
    """Return whether what stands in absolute values has the same signs at a point over GF(p) as at a real one."""
    ring = chart.ring
    signs = [i for i in generators_of(chart) if ring.vars[i].kind == "sign"]
    if not signs:
        return True
    here, there = values(ring, point), values(ring, real.point)
    return all((here[ring.var_node[i]] == 1) == bool(there[ring.var_node[i]] > 0) for i in signs)


def generators_of(chart: Chart) -> set[int]:
    """Return the generators that the geometric equations reach."""
    code = chart.ring.code
    return {code[i][1] for i in reachable(chart.ring, chart.nodes) if code[i][0] == VAR}


def chart_of_relations(chart: Chart, relations: Sequence[Expr], ring: Ring | None = None) -> Chart:
    """Return a chart of other relations on the columns that they mention; on all columns where it has a ``ring``."""
    mentioned = frozenset[Expr]().union(*(g.symbols for g in relations))
    symbols = chart.symbols if ring else tuple(s for s in chart.symbols if s in mentioned)
    ring = ring or Ring(relations, chart.setting.positive)
    nodes = tuple(ring.node(g) for g in relations)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols)
    return replace(chart, ring=ring, nodes=nodes, symbols=symbols, columns=columns, relations=tuple(relations))


def chart_of_rows(chart: Chart, rows: Sequence[int]) -> Chart:
    """Return some of the relations on the columns that they mention."""
    return chart_of_relations(chart, [chart.relations[r] for r in rows])


def smaller(chart: Chart) -> tuple[Chart, int]:
    """Return the chart without coordinates that linear relations give, and how many of those that went were free.

    The set is a graph over the other coordinates [ImplicitFunctions]. So go the angles of bodies that do not turn
    (theta = 0), bodies welded to others (x_B = x_A, theta_B = theta_A), z = 0. Free are those that no relation mentions
    any more: the set is a product with a line for each. The chart itself where none can go.
    """
    if chart.time is not None or "eliminations" not in chart.setting.reductions:
        return chart, 0
    solved = explicit_relations(chart.relations, lambda g: {} if linear(g) is None else number_coefficients(g))
    if not solved.explicit:
        return chart, 0
    small = chart_of_relations(chart, solved.implicit)
    return small, len(chart.symbols) - len(solved.explicit) - len(small.symbols)


def frame_at(chart: Chart, point: FieldPoint) -> Pivots:
    """Independent relations and dependent columns at a point."""
    return sparse_frame(field_jacobian(chart, point), len(chart.columns), point.p)
