"""The answer to one block: its freedom, its hidden relations, and which of its rows integrate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, nmod, nmod_mat

from dofkit import expr as ex
from dofkit.blocks import Block, Row, expressions, split, uses_time
from dofkit.chart import Chart
from dofkit.exact.balls import (
    BallPoint,
    OutsideDomainError,
    RealPoint,
    RealSearch,
    dependency_pattern,
    greedy_pivots,
    independent_part,
)
from dofkit.exact.field import FieldPoint, NoPointError
from dofkit.exact.points import Solver
from dofkit.exact.program import gradient, values
from dofkit.exact.ring import Ring, independent_generators, linear_terms
from dofkit.expr import Expr
from dofkit.forms import Frame, Rows, Span, certified_rank, field_frame, growth, kernel, lie_span, pairing
from dofkit.hidden import hidden_relation
from dofkit.local import AtReference, at_reference
from dofkit.measured import measure
from dofkit.normal import Finite, Nonlinear, Pfaffian
from dofkit.rank import rank_of
from dofkit.report import Verdict, weakest
from dofkit.system import Coordinate
from dofkit.variety import BALL_COLUMNS, Variety, field_jacobian, find, on_variety, pose_point
from dofkit.velocities import form_rate, rate
from dofkit.zeros import never_vanishes, zero_set

#: Rounds of prolongation: each finds one hidden finite relation.
MAX_ROUNDS = 12
#: Branches of one hidden relation that are followed.
MAX_HIDDEN_BRANCHES = 3
#: Lie algebras are certified with balls up to this many columns.
CERTIFIED_COLUMNS = 16


OFF_REFERENCE = (
    "the reference configuration does not satisfy all finite relations: the answer is for configurations that do, "
    "and nothing is said of the reference itself"
)


@dataclass(frozen=True)
class Label:
    """Whether a row is a consequence of finite relations, how sure, and why."""

    holonomic: bool | None
    verdict: Verdict
    reason: str = ""


@dataclass
class Answer:
    """What is known of a block. Numbers are None where undecided; ``reasons`` say why.

    ``matrix``: the rows (in the block's order) over the coordinates and time at a generic point over GF(p), for
    redundancy; ``hidden`` the finite relations that the differential ones force.
    """

    consistent: bool | None = True
    dof: int | None = None
    velocity_dof: int | None = None
    verdict: Verdict = "proved"
    labels: dict[int, Label] = field(default_factory=dict)
    reasons: list[str] = field(default_factory=list)
    hidden: list[Expr] = field(default_factory=list)
    matrix: list[list[int]] = field(default_factory=list)
    modulus: int = 2
    degenerate: bool = False
    instantaneous: int | None = None
    curved: bool = False
    dependent: tuple[str, ...] = ()
    growth: tuple[int, ...] | None = None
    method: str = ""


@dataclass(frozen=True)
class Setting:
    """What the engines may assume of the symbols."""

    positive: frozenset[Expr]
    generic: tuple[Expr, ...] = ()
    pose: Mapping[Expr, Expr] = field(default_factory=dict)
    reference: Mapping[Expr, Expr] | None = None
    roles: tuple[Coordinate, ...] = ()
    tolerance: Fraction | None = None
    size: float = 1.0
    grows: bool = True


def aliases(block: Block, finite: Sequence[Expr]) -> dict[Expr, Expr]:
    """Coordinates that a finite relation gives explicitly (theta = w t), where they stand inside functions."""
    inside = {s for e in (*expressions(block), *finite) for s in _inside_functions(e)}
    found: dict[Expr, Expr] = {}
    for g in finite:
        if not any(s in inside for s in g.symbols):
            continue
        terms = linear_terms(g)
        for s in sorted(g.symbols & inside, key=repr):
            if s.args[0] != "coordinate" or s not in terms or any(s in u.symbols for u in terms if u != s):
                continue
            value = ex.substitute((ex.mul(ex.num(terms[s]), s) - g) / ex.num(terms[s]), found)
            if s not in value.symbols:
                found = {k: ex.substitute(v, {s: value}) for k, v in found.items()} | {s: value}
                break
    return found


def _inside_functions(e: Expr) -> frozenset[Expr]:
    found: frozenset[Expr] = frozenset()
    for node in ex.nodes(e):
        if node.op == "fn" or (node.op == "pow" and node.args[1].op != "num"):
            found |= node.symbols
    return found


def answer(block: Block, setting: Setting) -> Answer:
    """All that is asked of one block."""
    if not block.forms and not block.nonlinear:
        return _finite_answer(block, setting)
    return _mixed_answer(block, setting)


# -- finite relations only ---------------------------------------------------------------------------


def make_chart(block: Block, setting: Setting, extra: Sequence[Expr] = (), more: Sequence[Expr] = ()) -> Chart:
    """The ring of a block with its finite relations and ``extra`` ones; ``more`` is evaluated too."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    everything = [*expressions(block), *extra, *more]
    alias = aliases(block, finite) if block.forms or block.nonlinear else {}
    ring = Ring(everything, setting.positive, alias)
    nodes = tuple(ring.node(g) for g in finite)
    for e in everything:
        ring.node(e)
    symbols = tuple(ex.coordinate(c) for c in block.coordinates)
    if uses_time(block) or any(ex.TIME in e.symbols for e in extra):
        symbols = (*symbols, ex.TIME)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols)
    unknowns = (*(s for s in symbols if s != ex.TIME), *setting.generic)
    return Chart(ring, nodes, symbols, columns, unknowns, setting.positive, setting.roles, tuple(finite))


def _finite_answer(block: Block, setting: Setting) -> Answer:
    chart = make_chart(block, setting)
    if setting.reference is not None:
        drawn = _drawn_answer(chart, setting, setting.reference)
        if drawn is not None:
            return drawn
    found = find(chart, setting.pose)
    result = Answer(found.consistent, found.dimension, found.dimension, found.verdict, reasons=list(found.reasons))
    if setting.reference is not None:
        result.reasons.append(OFF_REFERENCE)
    result.method = "rank over GF(p)" + (" and balls" if found.real else "")
    if found.samples:
        _finite_matrix(chart, found, result)
    elif found.real is not None:
        result.method = "real points with balls"
        _numeric_matrix(chart, found.real, result)
    return result


def _numeric_matrix(chart: Chart, real: RealPoint, result: Answer) -> None:
    """Which relations depend on which, and which coordinates on which, from a regular real point."""
    if real.matrix is None or not real.certified or not real.rows or len(real.matrix) != len(chart.nodes):
        return
    result.matrix = dependency_pattern(real.matrix, real.rows)
    shown = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    columns = [i for i, s in enumerate(shown) if s != ex.TIME]
    pivots = greedy_pivots(real.matrix[list(real.rows)][:, columns].T, len(real.rows))
    result.dependent = tuple(str(shown[columns[i]].args[1]) for i in pivots)


def _drawn_answer(chart: Chart, setting: Setting, reference: Mapping[Expr, Expr]) -> Answer | None:
    """At the reference configuration; None where the relations do not hold there."""
    found = at_reference(chart, reference, exact=setting.tolerance is None)
    if found is None:
        return None
    if setting.tolerance is not None:
        return _measured_answer(chart, setting, found)
    result = Answer(True, found.local.dimension, found.local.dimension, found.local.verdict)
    result.method = "rank over GF(p) at the given configuration"
    result.instantaneous = found.instantaneous
    result.matrix, result.modulus = found.matrix, found.modulus
    rows = [[nmod(v, found.modulus) for v in row] for row in found.matrix]
    result.dependent = _dependent_names(rows, chart, found.modulus)
    n = chart.coordinates
    if found.confined:
        result.consistent, result.dof, result.velocity_dof, result.verdict = False, None, None, "probable"
        result.reasons.append("the finite relations fix the time: no motion satisfies them through an interval of time")
    elif found.rank < len(found.matrix):
        result.reasons.append(found.local.reason)
        result.degenerate = found.local.dimension != n - (found.rank if not found.confined else 0)
    return result


def _measured_answer(chart: Chart, setting: Setting, found: AtReference) -> Answer:
    """Measured geometry: the rank within the tolerance."""
    at = {s: float(v.mid()) for s, v in found.ball.symbols.items()} if found.ball is not None else {}
    told = measure(chart, at, setting.roles, float(setting.tolerance or 0), setting.size, found.rigid)
    result = Answer(True, told.dimension, told.dimension, "numeric" if told.dimension is not None else "undecided")
    result.method = "singular values within the tolerance at the given configuration"
    result.instantaneous = told.instantaneous
    result.reasons.append(f"{told.reason}; the gap between singular values is {told.gap:.1e}")
    result.matrix, result.modulus = told.dependencies, 2
    result.dependent = tuple(str(chart.symbols[c].args[1]) for c in told.columns)
    result.degenerate = told.dimension != told.instantaneous
    return result


def _finite_matrix(chart: Chart, found: Variety, result: Answer) -> None:
    point = found.samples[0]
    matrix = field_jacobian(chart, point)
    n = chart.coordinates
    rank, rank_q = rank_of(matrix, point.p), rank_of([row[:n] for row in matrix], point.p)
    result.matrix, result.modulus = [[int(v) for v in row] for row in matrix], point.p
    result.dependent = _dependent_names(matrix, chart, point.p)
    if rank_q < rank:
        result.consistent, result.dof, result.velocity_dof = False, None, None
        result.verdict = "probable"
        result.reasons.append("the finite relations fix the time: no motion satisfies them through an interval of time")
        return
    result.degenerate = result.dof is not None and result.dof != n - rank


def _dependent_names(matrix: list[list[Any]], chart: Chart, p: int) -> tuple[str, ...]:
    frame = field_frame([row[: chart.coordinates] for row in matrix], chart.coordinates, p)
    return tuple(str(chart.symbols[c].args[1]) for c in frame.dependent)


# -- differential relations --------------------------------------------------------------------------


@dataclass
class Codistribution:
    """The rows of a block as one-forms over a chart: finite differentials, then Pfaffian forms."""

    chart: Chart
    rows: Rows
    finite: int

    @property
    def n(self) -> int:
        return self.chart.coordinates


def codistribution(block: Block, setting: Setting, extra: Sequence[Expr]) -> Codistribution:
    """dg for every finite relation (those ``extra`` included), then the Pfaffian forms."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    timed = uses_time(block) or any(ex.TIME in e.symbols for e in extra)
    symbols = [ex.coordinate(c) for c in block.coordinates] + ([ex.TIME] if timed else [])
    gradients = [{i: ex.diff(g, s) for i, s in enumerate(symbols) if s in g.symbols} for g in finite]
    place = {s: i for i, s in enumerate(symbols)}
    forms = [{place[s]: e for s, e in r.piece.items()} for r in block.forms if isinstance(r.piece, Pfaffian)]
    chart = make_chart(block, setting, extra, [e for g in gradients for e in g.values()])
    entries = tuple({c: chart.ring.node(e) for c, e in row.items() if not e.is_zero} for row in (*gradients, *forms))
    return Codistribution(chart, Rows(chart.ring, entries, chart.columns), len(finite))


def _mixed_answer(block: Block, setting: Setting) -> Answer:
    result = _prolonged(block, setting, Answer())
    if setting.reference is not None:
        result.instantaneous = _first_order(block, setting, setting.reference)
    return result


def _first_order(block: Block, setting: Setting, reference: Mapping[Expr, Expr]) -> int | None:
    """Velocities that the rows allow at the reference configuration; None where it is not on the variety."""
    if block.nonlinear:
        return None
    forms = codistribution(block, setting, ())
    point = pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not on_variety(forms.chart, point):
        return None
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    except (ZeroDivisionError, NoPointError):
        return None
    return forms.n - rank_of([row[: forms.n] for row in matrix], point.p)


def _prolonged(block: Block, setting: Setting, result: Answer, given: Sequence[Expr] = ()) -> Answer:
    """The answer with the hidden relations that the rows force added one after another; of branches the largest."""
    extra = list(given)
    for _ in range(MAX_ROUNDS):
        forms = codistribution(block, setting, extra)
        found = find(forms.chart, setting.pose)
        result.reasons = list(found.reasons)
        if not found.consistent or (not found.samples and found.real is None):
            result.consistent, result.verdict, result.hidden = found.consistent, found.verdict, extra
            return result
        new = _confined(forms, found)
        if new is None:
            return _with_spans(block, forms, found, extra, setting)
        outcome = _prolong(new, setting)
        if not outcome:
            result.consistent, result.verdict, result.hidden = False, "probable", extra
            result.reasons.append("the constraints leave no motion through an interval of time")
            return result
        if len(outcome) > 1 and len(extra) < MAX_ROUNDS:
            ways = [_prolonged(block, setting, Answer(), [*extra, *branch]) for branch in outcome[:MAX_HIDDEN_BRANCHES]]
            return max(ways, key=_largest)
        fresh = [g for g in outcome[0] if g not in extra]
        if not fresh:
            break
        extra += fresh
    result.verdict, result.consistent = "undecided", None
    result.reasons.append("motion is confined to a locus that could not be written down")
    return result


def _largest(a: Answer) -> tuple[int, int, int]:
    return (int(a.consistent is not False), -1 if a.dof is None else a.dof, a.velocity_dof or 0)


def _confined(forms: Codistribution, found: Variety) -> Expr | None:
    """The relation to which motion is confined where dt lies in the span of the rows; else None."""
    if len(forms.chart.symbols) == forms.n or not found.samples:
        return None
    point = found.samples[0]
    matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    n = forms.n
    if rank_of([row[:n] for row in matrix], point.p) == rank_of(matrix, point.p):
        return None
    return hidden_relation(forms.rows, n, point)


def _prolong(relation: Expr, setting: Setting) -> tuple[tuple[Expr, ...], ...]:
    """The branches of a hidden relation; none where it cannot hold."""
    if relation.is_zero or never_vanishes(relation, setting.positive):
        return () if not relation.is_zero else ((),)
    if not any(s.args[0] == "coordinate" for s in relation.symbols):
        return ()
    variables = frozenset(s for s in relation.symbols if s.args[0] in ("coordinate", "time"))
    branches, _ = zero_set(relation, setting.positive, variables)
    return branches


def _with_spans(block: Block, forms: Codistribution, found: Variety, extra: list[Expr], setting: Setting) -> Answer:
    result = Answer(True, hidden=extra, reasons=list(found.reasons), verdict=found.verdict)
    if found.samples:
        spans = [(p, _span(forms, p)) for p in found.samples]
        good = [(p, s) for p, s in spans if s is not None]
        if good:
            _field_labels(block, forms, found, good, result, setting.grows)
            _nonlinear(block, forms, setting, result)
            return result
    if found.real is not None and found.real.certified:
        _ball_labels(block, forms, found.real, result)
        _nonlinear(block, forms, setting, result)
        return result
    result.verdict, result.consistent = "undecided", None
    result.reasons.append("no regular point was found to look at the differential constraints")
    return result


@dataclass(frozen=True)
class Sampled:
    """A span at a point, with the matrix and the frame there."""

    span: Span
    matrix: list[list[Any]]
    frame: Frame


def _span(forms: Codistribution, point: FieldPoint) -> Sampled | None:
    try:
        zero = point.number(ex.ZERO.args[0])
        matrix = forms.rows.matrix(values(forms.chart.ring, point), zero)
        frame = field_frame(matrix, len(forms.chart.symbols), point.p)
        return Sampled(lie_span(forms.rows, frame, point), matrix, frame)
    except (ZeroDivisionError, NoPointError):
        return None


def _ball_span(forms: Codistribution, rank: int, point: BallPoint) -> tuple[Span, list[list[arb]]] | None:
    """The Lie algebra with balls; None where the point is no regular one, or has another rank than over GF(p)."""
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), arb(0))
        found, _, rows, columns = independent_part(np.array([[float(v.mid()) for v in row] for row in matrix]))
        if found != rank:
            return None
        free = tuple(c for c in range(len(forms.chart.symbols)) if c not in set(columns))
        point.rng.seed("dofkit curve")
        return lie_span(forms.rows, Frame(tuple(rows), tuple(columns), free), point), matrix
    except (ZeroDivisionError, OutsideDomainError):
        return None


def _field_labels(
    block: Block,
    forms: Codistribution,
    found: Variety,
    good: list[tuple[FieldPoint, Sampled]],
    result: Answer,
    grows: bool,
) -> None:
    point, sampled = max(good, key=lambda pair: pair[1].span.dimension)
    total, n = len(forms.chart.symbols), forms.n
    result.matrix, result.modulus = [[int(v) for v in row] for row in sampled.matrix], point.p
    result.method = "Lie algebra along a curve over GF(p)"
    integrable = total - sampled.span.dimension
    rank = len(sampled.frame.rows)
    result.velocity_dof = n - rank
    result.dof = n - integrable
    result.growth = growth(forms.rows, sampled.frame, point, sampled.span) if grows else None
    rank_finite = rank_of(sampled.matrix[: forms.finite], point.p)
    if found.dimension is None or found.dimension != n - rank_finite:
        result.dof, result.velocity_dof, result.verdict, result.degenerate = None, None, "undecided", True
        result.reasons.append("the finite relations are singular where they hold; the rest was not decided there")
        return
    ball = None
    if total <= CERTIFIED_COLUMNS and found.real is not None and found.real.certified and found.real.consistent:
        ball = _ball_span(forms, rank, found.real.point)
    trusted = independent_generators(forms.chart.ring)
    result.verdict = weakest(found.verdict, _rank_verdict(sampled, ball, rank))
    if any(s.span.dimension != sampled.span.dimension for _, s in good):
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("the freedom differs between points: the generic one is given")
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        if isinstance(row.piece, Finite):
            result.labels[i] = Label(True, "proved")
            continue
        place = i if i < len(block.finite) else i + forms.finite - len(block.finite)
        result.labels[i] = _label(place, good, ball, sampled, rank, total, trusted)
        if result.labels[i].holonomic is None:
            result.verdict, result.dof, result.growth = "undecided", None, None
    result.dependent = _integrable_names(forms, sampled, point)


def _rank_verdict(sampled: Sampled, ball: tuple[Span, list[list[arb]]] | None, rank: int) -> Verdict:
    """The Lie algebra's dimension is proved where it is everything and a ball certifies it, or where D is a line."""
    if ball is None:
        return "probable"
    n = sum(map(len, (sampled.frame.dependent, sampled.frame.free)))
    if (
        ball[0].dimension == sampled.span.dimension
        and sampled.span.dimension in (n, n - rank)
        and (sampled.span.dimension == n or n - rank <= 1)
    ):
        return "proved"
    return "probable"


def _label(
    place: int,
    good: list[tuple[FieldPoint, Sampled]],
    ball: tuple[Span, list[list[arb]]] | None,
    sampled: Sampled,
    rank: int,
    total: int,
    trusted: bool,
) -> Label:
    """Is the row in the largest integrable part: does it annihilate the Lie algebra of D?"""
    zero = [all(v == 0 for v in pairing(s.matrix[place], s.span.vectors)) for _, s in good]
    if all(zero):
        line = total - rank <= 1
        return Label(True, "proved" if line and ball is not None else "probable", "line" if line else "")
    disagree = "exact arithmetic and balls disagree: an identity between functions was not seen"
    if ball is None:
        return Label(False, "probable") if trusted else Label(None, "undecided", disagree)
    nonzero = any(not v.contains(0) for v in pairing(ball[1][place], ball[0].vectors))
    if nonzero:
        return Label(False, "proved")
    return Label(None, "undecided", disagree)


def _integrable_names(forms: Codistribution, sampled: Sampled, point: FieldPoint) -> tuple[str, ...]:
    """Dependent coordinates: pivots of the annihilator of the Lie algebra."""
    if not sampled.span.vectors:
        return tuple(str(s.args[1]) for s in forms.chart.symbols if s != ex.TIME)
    vectors = nmod_mat([[int(v) for v in vector] for vector in sampled.span.vectors], point.p)
    basis, nullity = vectors.nullspace()
    rows = [[basis[i, k] for i in range(basis.nrows())] for k in range(nullity)]
    return _dependent_names(rows, forms.chart, point.p) if rows else ()


def _ball_labels(block: Block, forms: Codistribution, real: RealPoint, result: Answer) -> None:
    """With real points only: what a tiny ball contains 0 of is taken for 0, and the verdict says numeric."""
    at = values(forms.chart.ring, real.point)
    matrix = forms.rows.matrix(at, arb(0))
    rank, gap, _, _ = independent_part(np.array([[float(v.mid()) for v in row] for row in matrix]))
    total, n = len(forms.chart.symbols), forms.n
    found = _ball_span(forms, rank, real.point)
    if found is None or gap < 1e3:
        result.verdict, result.consistent = "undecided", None
        result.reasons.append("the only points found are singular")
        return
    span, _ = found
    result.verdict, result.method = "numeric", "Lie algebra along a curve with balls"
    result.velocity_dof, result.dof = n - rank, n - (total - span.dimension)
    result.reasons.append(f"decided at real points of high precision, with a gap of {gap:.1e} between singular values")
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        place = i if i < len(block.finite) else i + forms.finite - len(block.finite)
        zero = all(v.contains(0) for v in pairing(matrix[place], span.vectors))
        sure: Verdict = "proved" if isinstance(row.piece, Finite) or not zero else "numeric"
        result.labels[i] = Label(zero, sure)


# -- relations nonlinear in the velocities --------------------------------------------------------------


def _nonlinear(block: Block, forms: Codistribution, setting: Setting, result: Answer) -> None:
    """The velocity freedom: a Jacobian's rank by the velocities, at points of the whole set."""
    if not block.nonlinear or result.velocity_dof is None:
        return
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + result.hidden
    symbols = [ex.coordinate(c) for c in block.coordinates]
    rates = [ex.velocity(c) for c in block.coordinates]
    linear = [rate(g) for g in finite]
    linear += [form_rate(r.piece) for r in block.forms if isinstance(r.piece, Pfaffian)]
    nonlinear = [r.piece.expr for r in block.nonlinear if isinstance(r.piece, Nonlinear)]
    everything = [*finite, *linear, *nonlinear]
    hessians = [[[ex.diff(ex.diff(f, v), w) for w in rates] for v in rates] for f in nonlinear]
    ring = Ring(
        [*everything, *(e for h in hessians for row in h for e in row)], setting.positive, aliases(block, finite)
    )
    nodes = [ring.node(e) for e in everything]
    curvature = [[[ring.node(e) for e in row] for row in h] for h in hessians]
    columns = [ring.var_index(v) for v in rates]
    solver = Solver(ring, [n for n in nodes if ring.code[n] != (0, 0)], seed=5)
    point = solver.draw(7)
    real = RealSearch(ring, nodes, [*symbols, *rates, *setting.generic], setting.positive).search(3)
    sample: Any = point if point is not None else (real.point if real is not None and real.certified else None)
    if real is None or sample is None:
        result.velocity_dof, result.consistent, result.verdict = None, None, "undecided"
        result.reasons.append("no velocities were found that satisfy the constraints")
        return
    _nonlinear_rank(ring, nodes[len(finite) :], columns, sample, result, len(linear))
    if not real.certified:
        result.verdict, result.velocity_dof, result.dof = "undecided", None, None
        result.reasons.append("the velocities that satisfy the constraints are singular")
        return
    if not _curved(ring, nodes[len(finite) :], columns, curvature, real.point):
        result.verdict, result.velocity_dof, result.dof = "undecided", None, None
        result.reasons.append(
            "the velocities that are allowed form flat pieces, which were not written as linear forms"
        )
        return
    result.curved = True
    if len(nonlinear) > 1:
        result.verdict = weakest(result.verdict, "probable")


def _nonlinear_rank(
    ring: Ring, nodes: Sequence[int], columns: Sequence[int | None], point: Any, result: Answer, linear: int
) -> None:
    at = values(ring, point)
    zero = at[0] * 0
    rows = []
    for node in nodes:
        g = gradient(ring, at, point, [(node, zero + 1)])
        rows.append([g.get(c, zero) if c is not None else zero for c in columns])
    if isinstance(point, FieldPoint):
        rank = rank_of(rows, point.p)
        timed = len(result.matrix[0]) - len(columns) if result.matrix else 0
        result.matrix += [[*(int(v) for v in row), *([0] * timed)] for row in rows[linear:]]
        result.verdict = weakest(result.verdict, "proved" if rank == len(rows) else "probable")
    else:
        rank = certified_rank(rows)
        result.verdict = weakest(result.verdict, "numeric")
    result.velocity_dof = len(columns) - rank


def _curved(
    ring: Ring,
    nodes: Sequence[int],
    columns: Sequence[int | None],
    hessians: Sequence[list[list[int]]],
    point: BallPoint,
) -> bool:
    """Is the set of allowed velocities curved at the point: a second fundamental form that a ball proves not to be 0?

    A curved set is no union of hyperplanes, so the relation is no Pfaffian form in disguise.
    """
    try:
        at = values(ring, point)
        rows = []
        for node in nodes:
            g = gradient(ring, at, point, [(node, arb(1))])
            rows.append([g.get(c, arb(0)) if c is not None else arb(0) for c in columns])
        _, _, kept, pivots = independent_part(np.array([[float(v.mid()) for v in row] for row in rows]))
        free = tuple(c for c in range(len(columns)) if c not in set(pivots))
        tangent = kernel(rows, Frame(tuple(kept), tuple(pivots), free), arb(0))
        return any(_bends(at, h, u, v) for h in hessians for i, u in enumerate(tangent) for v in tangent[: i + 1])
    except (OutsideDomainError, ZeroDivisionError):
        return False


def _bends(at: Sequence[arb], hessian: list[list[int]], u: Sequence[arb], v: Sequence[arb]) -> bool:
    total = arb(0)
    for a, row in zip(u, hessian, strict=True):
        for node, b in zip(row, v, strict=True):
            total = total + a * at[node] * b
    return not total.contains(0)


def alone(rows: Sequence[Row], setting: Setting, coordinates: Sequence[str]) -> Answer:
    """A constraint's own rows with the others forgotten."""
    blocks, _ = split(coordinates, rows)
    answers = [answer(b, replace(setting, pose={}, reference=None, grows=False)) for b in blocks]
    merged = Answer()
    for a in answers:
        merged.verdict = weakest(merged.verdict, a.verdict)
        merged.curved = merged.curved or a.curved
        merged.labels |= {len(merged.labels) + i: label for i, label in a.labels.items()}
        if a.consistent is not True:
            merged.consistent = a.consistent
    return merged


__all__ = ["BALL_COLUMNS", "Answer", "Label", "Setting", "alone", "answer"]
