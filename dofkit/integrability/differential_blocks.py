"""Blocks with differential relations: hidden finite ones, the Lie algebra of what is allowed, labels."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from itertools import product as cartesian
from typing import Any

from flint import arb, nmod_mat

from dofkit.base.verdicts import Verdict, weakest
from dofkit.configuration.drawing.at_reference import CLEAR, ball_matrix, ball_point
from dofkit.configuration.finite_blocks import dependent_names
from dofkit.configuration.variety import Variety, on_variety, pose_point
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.modular import rank_of
from dofkit.exact.matrices.sparse import sparse
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, Pivots, field_frame, pairing
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.instructions import Scalar
from dofkit.exact.ring.program import values
from dofkit.exact.zero.independence import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.growth_vector import derived_flag, growth
from dofkit.integrability.lie_algebra import Span, lie_span
from dofkit.integrability.prolongation import hidden_relation
from dofkit.integrability.single_form import proof
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, uses_time
from dofkit.relations.chart import Chart
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.normal.normal_form import Finite, Nonlinear, Pfaffian, Still, with_constants
from dofkit.relations.normal.zero_set import never_vanishes, zero_set
from dofkit.relations.setting import Setting

#: Lie algebras are certified with balls up to this many columns.
CERTIFIED_COLUMNS = 16
#: Ways in which several hidden relations hold together that are looked at.
MAX_TOGETHER = 12


@dataclass
class Codistribution:
    """The rows of a block as one-forms over a chart: finite differentials, then Pfaffian forms."""

    chart: Chart
    rows: FormRows
    finite: int

    @property
    def n(self) -> int:
        return self.chart.coordinates


def codistribution(block: Block, setting: Setting, extra: Sequence[Expr], more: Sequence[Expr] = ()) -> Codistribution:
    """dg for every finite relation (those ``extra`` included), then the Pfaffian forms; ``more`` is evaluated too."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    timed = uses_time(block) or any(ex.TIME in e.symbols for e in extra)
    symbols = [ex.coordinate(c) for c in block.coordinates] + ([ex.TIME] if timed else [])
    gradients = [{i: ex.diff(g, s) for i, s in enumerate(symbols) if s in g.symbols} for g in finite]
    place = {s: i for i, s in enumerate(symbols)}
    forms = [{place[s]: e for s, e in r.piece.items()} for r in block.forms if isinstance(r.piece, Pfaffian)]
    chart = make_chart(block, setting, extra, [*(e for g in gradients for e in g.values()), *more])
    entries = tuple({c: chart.ring.node(e) for c, e in row.items() if not e.is_zero} for row in (*gradients, *forms))
    return Codistribution(chart, FormRows(chart.ring, entries, chart.columns), len(finite))


def first_order(block: Block, setting: Setting, reference: Mapping[Expr, Expr]) -> int | None:
    """Velocities that the rows allow at the reference configuration; None where it is not on the variety."""
    if block.nonlinear:
        return None
    forms = codistribution(block, setting, ())
    if "field" not in setting.engines:
        return _first_order_by_balls(forms, reference)
    point = pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not on_variety(forms.chart, point):
        return None
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
    except NoValueError:
        return None
    return forms.n - rank_of([row[: forms.n] for row in matrix], point.p)


def _first_order_by_balls(forms: Codistribution, reference: Mapping[Expr, Expr]) -> int | None:
    ball = ball_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, random.Random("dofkit reference"))
    if ball is None or ball_matrix(forms.chart, ball, True) is None:
        return None
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, ball), arb(0))
    except NoValueError:
        return None
    part = ball_part([row[: forms.n] for row in matrix])
    return forms.n - part.rank if part.gap > CLEAR else None


def confined(forms: Codistribution, found: Variety) -> tuple[tuple[Expr, ...], ...] | None:
    """Ways in which motion is confined where dt lies in the span of the rows; None where it does not."""
    if len(forms.chart.symbols) == forms.n:
        return None
    n = forms.n
    if found.samples:
        point = found.samples[0]
        matrix = forms.rows.matrix(values(forms.chart.ring, point), point.number(ex.ZERO.args[0]))
        free = rank_of([row[:n] for row in matrix], point.p) == rank_of(matrix, point.p)
        return None if free else hidden_relation(forms.rows, n, point)
    if found.real is None:
        return None
    try:
        balls = forms.rows.matrix(values(forms.chart.ring, found.real.point), arb(0))
    except NoValueError:
        return None
    free = ball_part([row[:n] for row in balls]).rank == ball_part(balls).rank
    return None if free else hidden_relation(forms.rows, n, found.real.point)


def prolong(ways: Sequence[Sequence[Expr]], setting: Setting) -> tuple[tuple[Expr, ...], ...]:
    """The branches of hidden relations; none where they cannot hold."""
    if not ways:
        return ((),)
    return tuple(dict.fromkeys(branch for way in ways for branch in _together(way, setting)))


def _together(relations: Sequence[Expr], setting: Setting) -> list[tuple[Expr, ...]]:
    """The branches on which all of some relations hold."""
    options = []
    for relation in relations:
        if never_vanishes(relation, setting.positive):
            return []
        if not any(s.args[0] == "coordinate" for s in relation.symbols):
            return []
        variables = frozenset(s for s in relation.symbols if s.args[0] in ("coordinate", "time"))
        options.append(zero_set(relation, setting.positive, variables)[0])
    together = islice(cartesian(*options), MAX_TOGETHER)
    return [tuple(dict.fromkeys(g for branch in choice for g in branch)) for choice in together]


@dataclass(frozen=True)
class SampledSpan:
    """A span at a point, with the matrix and the frame there."""

    span: Span
    matrix: list[list[Any]]
    frame: Pivots


def span_at(forms: Codistribution, point: FieldPoint) -> SampledSpan | None:
    try:
        zero = point.number(ex.ZERO.args[0])
        matrix = forms.rows.matrix(values(forms.chart.ring, point), zero)
        frame = field_frame(matrix, len(forms.chart.symbols), point.p)
        return SampledSpan(lie_span(forms.rows, frame, point), matrix, frame)
    except NoValueError:
        return None


def ball_span(forms: Codistribution, rank: int, point: BallPoint) -> tuple[Span, list[list[arb]]] | None:
    """The Lie algebra with balls; None where the point is no regular one, or has another rank than over GF(p)."""
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), arb(0))
        part = ball_part(matrix)
        if part.rank != rank:
            return None
        free = tuple(c for c in range(len(forms.chart.symbols)) if c not in set(part.columns))
        point.rng.seed("dofkit curve")
        return lie_span(forms.rows, Pivots(tuple(part.rows), tuple(part.columns), free), point), matrix
    except NoValueError:
        return None


def field_labels(
    block: Block,
    forms: Codistribution,
    found: Variety,
    good: list[tuple[FieldPoint, SampledSpan]],
    result: Answer,
    setting: Setting,
) -> None:
    """Freedom and labels from points over GF(p), held against a ball where there is one."""
    trusted = independent_generators(forms.chart.ring)
    if not trusted and "balls" not in setting.engines:
        result.verdict = "undecided"
        result.reasons.append("the functions that occur may be related in a way that points over GF(p) do not show")
        return
    point, sampled = max(good, key=lambda pair: pair[1].span.dimension)
    total, n = len(forms.chart.symbols), forms.n
    result.matrix, result.modulus = sparse(sampled.matrix), point.p
    result.method = "Lie algebra along a curve over GF(p)"
    integrable = total - sampled.span.dimension
    rank = len(sampled.frame.rows)
    result.velocity_dof = n - rank
    result.dof = n - integrable
    result.growth = growth(forms.rows, sampled.frame, point, sampled.span) if setting.grows else None
    result.derived = derived_flag(forms.rows, sampled.frame, point, sampled.span) if setting.flag else None
    rank_finite = rank_of(sampled.matrix[: forms.finite], point.p)
    if found.dimension is None or found.dimension != n - rank_finite:
        result.dof, result.velocity_dof, result.verdict, result.degenerate = None, None, "undecided", True
        result.reasons.append("the finite relations are singular where they hold; the rest was not decided there")
        return
    ball = certificate(forms, found, sampled, trusted)
    result.verdict = weakest(found.verdict, _rank_verdict(block, setting, sampled, ball, rank))
    if any(s.span.dimension != sampled.span.dimension for _, s in good):
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("the freedom differs between points: the generic one is given")
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        if isinstance(row.piece, Finite):
            result.labels[i] = HolonomyLabel(True, "proved")
            continue
        place = i if i < len(block.finite) else i + forms.finite - len(block.finite)
        result.labels[i] = _label(place, good, ball, sampled, rank, total, trusted)
        if result.labels[i].holonomic is None:
            result.verdict, result.dof, result.growth = "undecided", None, None
        elif not result.labels[i].holonomic and integrable > rank_finite:
            result.labels[i] = replace(result.labels[i], modulo=_modulo_the_others(place, sampled, point.p))
    result.dependent = _integrable_names(forms, sampled, point)


def certificate(
    forms: Codistribution, found: Variety, sampled: SampledSpan, trusted: bool
) -> tuple[Span, Sequence[Sequence[Scalar]]] | None:
    """A span and a matrix whose non-zero values are proved not to be 0.

    Where the generators are known to be independent and no finite relation holds among them, what is not 0 at a
    point over GF(p) is not 0 as a function; else balls at a real point, up to `CERTIFIED_COLUMNS`.
    """
    real = found.real
    if real is None or not real.certified or not real.consistent:
        return None
    if trusted and not forms.finite:
        return sampled.span, sampled.matrix
    if len(forms.chart.symbols) > CERTIFIED_COLUMNS:
        return None
    return ball_span(forms, len(sampled.frame.rows), real.point)


def _nonzero(value: Scalar) -> bool:
    """Is a value proved not to be 0: over GF(p) or as a ball?"""
    return not value.contains(0) if isinstance(value, arb) else value != 0


def _rank_verdict(
    block: Block,
    setting: Setting,
    sampled: SampledSpan,
    ball: tuple[Span, Sequence[Sequence[Scalar]]] | None,
    rank: int,
) -> Verdict:
    """How sure the rank and the Lie algebra's dimension are.

    Independent rows have their rank certified by the ball. The dimension is not too large by a certificate of the
    ball; not too small where it is everything, where D is a line, and where as many rows are proved to integrate by
    themselves as the Lie algebra leaves directions out.
    """
    if ball is None or len(sampled.matrix) > rank or ball[0].dimension != sampled.span.dimension:
        return "probable"
    n = sum(map(len, (sampled.frame.dependent, sampled.frame.free)))
    if sampled.span.dimension == n or n - rank <= 1:
        return "proved"
    constants = {c: ex.parameter(c) for r in block.forms if isinstance(r.piece, Still) for c in r.piece.coefficients}
    forms = [p for r in block.forms if isinstance(p := with_constants(r.piece, constants), Pfaffian)]
    wanted = n - sampled.span.dimension - (len(sampled.matrix) - len(forms))
    if wanted > len(forms):
        return "probable"
    return "proved" if sum(proof(f, setting.positive) is not None for f in forms) == wanted else "probable"


def _label(
    place: int,
    good: list[tuple[FieldPoint, SampledSpan]],
    ball: tuple[Span, Sequence[Sequence[Scalar]]] | None,
    sampled: SampledSpan,
    rank: int,
    total: int,
    trusted: bool,
) -> HolonomyLabel:
    """Is the row in the largest integrable part: does it annihilate the Lie algebra of D?"""
    zero = [all(v == 0 for v in pairing(s.matrix[place], s.span.vectors)) for _, s in good]
    if all(zero):
        line = total - rank <= 1
        return HolonomyLabel(True, "proved" if line and ball is not None else "probable", "line" if line else "")
    disagree = "exact arithmetic and balls disagree: an identity between functions was not seen"
    if ball is None:
        return HolonomyLabel(False, "probable") if trusted else HolonomyLabel(None, "undecided", disagree)
    nonzero = any(_nonzero(v) for v in pairing(ball[1][place], ball[0].vectors))
    if nonzero:
        return HolonomyLabel(False, "proved")
    return HolonomyLabel(None, "undecided", disagree)


def _modulo_the_others(place: int, sampled: SampledSpan, p: int) -> bool:
    """Is the row a sum of one in the largest integrable part and of the other rows, and independent of these?

    So it is where it annihilates what both allow: the Lie algebra's vectors that the other rows annihilate.
    """
    others = [row for i, row in enumerate(sampled.matrix) if i != place]
    if not others or rank_of(others, p) == rank_of(sampled.matrix, p):
        return False
    vectors = sampled.span.vectors
    paired = nmod_mat([[int(v) for v in pairing(row, vectors)] for row in others], p)
    null, nullity = paired.nullspace()
    own = [int(v) for v in pairing(sampled.matrix[place], vectors)]
    return all(sum(int(null[r, c]) * own[r] for r in range(len(own))) % p == 0 for c in range(nullity))


def _integrable_names(forms: Codistribution, sampled: SampledSpan, point: FieldPoint) -> tuple[str, ...]:
    """Dependent coordinates: pivots of the annihilator of the Lie algebra."""
    if not sampled.span.vectors:
        return tuple(str(s.args[1]) for s in forms.chart.symbols if s != ex.TIME)
    vectors = nmod_mat([[int(v) for v in vector] for vector in sampled.span.vectors], point.p)
    basis, nullity = vectors.nullspace()
    rows = [[basis[i, k] for i in range(basis.nrows())] for k in range(nullity)]
    return dependent_names(sparse(rows), forms.chart, point.p) if rows else ()


def ball_labels(block: Block, forms: Codistribution, real: RealPoint, result: Answer) -> None:
    """With real points only: what a tiny ball contains 0 of is taken for 0, and the verdict says numeric."""
    at = values(forms.chart.ring, real.point)
    matrix = forms.rows.matrix(at, arb(0))
    part = ball_part(matrix)
    rank = part.rank
    total, n = len(forms.chart.symbols), forms.n
    found = ball_span(forms, rank, real.point)
    if found is None or part.gap < CLEAR:
        result.verdict, result.consistent = "undecided", None
        result.reasons.append("the only points found are singular")
        return
    span, _ = found
    result.verdict, result.method = "numeric", "Lie algebra along a curve with balls"
    result.velocity_dof, result.dof = n - rank, n - (total - span.dimension)
    if "field" not in forms.chart.engines:
        result.matrix = sparse(dependencies(matrix, part))
        if real.consistent and len(real.rows) == forms.finite and rank == len(matrix):
            result.verdict = "proved" if span.dimension == total or total - rank <= 1 else "numeric"
    result.reasons.append(f"decided at real points of high precision, with a gap of {part.gap:.1e} between pivots")
    for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear)):
        place = i if i < len(block.finite) else i + forms.finite - len(block.finite)
        zero = all(v.contains(0) for v in pairing(matrix[place], span.vectors))
        sure: Verdict = "proved" if isinstance(row.piece, Finite) or not zero else "numeric"
        result.labels[i] = HolonomyLabel(zero, sure)
