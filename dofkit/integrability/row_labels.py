"""Freedom and labels of a block with differential relations from points over GF(p), held against a ball.

Labels at a generic point are those of the component on which it was found [HermannNagano].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from operator import mul

from flint import arb

from dofkit.base.verdicts import Verdict, weakest
from dofkit.configuration.at_reference import CLEAR
from dofkit.configuration.finite_blocks import dependent_names
from dofkit.configuration.variety import SAMPLES, Variety, on_variety, pose_point
from dofkit.exact.matrices.certified import ball_part, dependencies
from dofkit.exact.matrices.sparse import echelon, rank_of, sparse
from dofkit.exact.points.balls import RealPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame, pairing, rank_over, vanishes
from dofkit.exact.residues import null_vectors, residue_matrix
from dofkit.exact.ring.program import Scalar, values
from dofkit.exact.zero import error_bits, independent_on_set, odd_constants
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.first_integrals import BorderedMinors, first_integrals, is_short
from dofkit.integrability.growth_vector import derived_flag, spanning_curves
from dofkit.integrability.lie_algebra import SampledSpan, Span, ball_span, span_at
from dofkit.integrability.pfaffian_system import Codistribution, linear_rows
from dofkit.integrability.traits import proof
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.relations.setting import Setting

#: Lie algebras are certified with balls up to so many columns; that brackets stay in D, by identities of so many rows.
CERTIFIED_COLUMNS, MAX_FORMS = 16, 3


@dataclass(frozen=True)
class SampledForms:
    """A block's rows at points over GF(p), ``samples``: the largest Lie algebra found stands for the generic one.

    ``whole``: more is asked for than labels, so that identities are worth their time.
    """

    block: Block
    forms: Codistribution
    samples: Sequence[tuple[FieldPoint, SampledSpan]]
    whole: bool

    @cached_property
    def trusted(self) -> bool:
        """Whether functions that occur are known to be independent: GF(p) sees every relation among them."""
        return independent_on_set(self.forms.chart.ring, self.forms.chart.nodes)

    @cached_property
    def _largest(self) -> tuple[FieldPoint, SampledSpan]:
        return max(self.samples, key=lambda pair: pair[1].span.dimension)

    @property
    def point(self) -> FieldPoint:
        """The point with the largest Lie algebra."""
        return self._largest[0]

    @property
    def sampled(self) -> SampledSpan:
        """What is known there."""
        return self._largest[1]

    @property
    def columns(self) -> int:
        """Coordinates, and time where it occurs."""
        return len(self.forms.chart.symbols)

    @property
    def rank(self) -> int:
        """Independent rows."""
        return len(self.sampled.frame.rows)

    @property
    def integrable(self) -> int:
        """The rank of I^(inf), which annihilates the Lie algebra."""
        return self.columns - self.sampled.span.dimension

    @cached_property
    def is_involutive(self) -> bool:
        """Whether brackets of fields that the frame's rows allow are allowed, of several fields by identities."""
        frame, allowed = self.sampled.frame, self.columns - self.rank
        if allowed <= 1 or self.sampled.span.dimension > allowed or self.rank > MAX_FORMS or not self.whole:
            return allowed <= 1
        rows = [r.piece for _, r, k in linear_rows(self.block, self.forms) if k in frame.rows]
        forms = [dict(p.items()) for p in rows if isinstance(p, Pfaffian)]
        return BorderedMinors(self.forms, frame).are_involutive(forms)

    @cached_property
    def rank_finite(self) -> int:
        """Independent differentials of geometric equations."""
        return rank_of(self.sampled.matrix[: self.forms.finite], self.point.p)


#: A Lie algebra and the matrix of the rows, over numbers whose being not 0 is proved.
Certificate = tuple[Span, Sequence[Sequence[Scalar]]]


def field_labels(
    block: Block,
    forms: Codistribution,
    variety: Variety,
    good: list[tuple[FieldPoint, SampledSpan]],
    result: Answer,
    setting: Setting,
) -> None:
    """Freedom and labels from points over GF(p), held against a ball where there is one."""
    forms_at_points = SampledForms(block, forms, good, setting.grows)
    if not forms_at_points.trusted and "balls" not in setting.engines:
        result.verdict = "undecided"
        result.reasons.append("the functions that occur may satisfy an identity that points over GF(p) do not detect")
        return
    result.trusted = forms_at_points.trusted and (not forms.finite or variety.about == "everywhere")
    _set_freedom(forms_at_points, result, setting)
    if variety.dimension is None or variety.dimension != forms.n - forms_at_points.rank_finite:
        result.dof, result.velocity_dof, result.verdict, result.degenerate = None, None, "undecided", True
        result.reasons.append(
            "the geometric equations are singular on their solution set; nothing further was decided there"
        )
        return
    proof_of = certificate(forms_at_points, variety)
    if not forms_at_points.trusted and (
        proof_of is None or proof_of[0].dimension != forms_at_points.sampled.span.dimension
    ):
        result.dof, result.velocity_dof, result.growth, result.verdict = None, None, None, "undecided"
        result.reasons.append(
            "the functions that occur may satisfy an identity on the set, and no certified interval excludes zero there"
        )
        return
    result.identical = _depend_identically(forms_at_points, proof_of, False)
    result.verdict = weakest(variety.verdict, _rank_verdict(forms_at_points, proof_of, result, setting))
    result.argument = "Lie algebra, certified" if result.verdict == "proved" else "Lie algebra at points"
    rows = forms.rows.entries
    result.bits = error_bits(forms.chart.ring, [node for row in rows for node in row.values()], len(rows))
    if any(s.span.dimension != forms_at_points.sampled.span.dimension for _, s in good):
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("the freedom differs between points; the generic value is given")
    _set_labels(forms_at_points, proof_of, result)
    result.dependent = integrable_names(forms, forms_at_points.point, forms_at_points.sampled.span)


def _set_freedom(forms_at_points: SampledForms, result: Answer, setting: Setting) -> None:
    """n - rank velocities, n - rank I^(inf) freedoms, and where they are asked for the growth and the derived flag."""
    forms, point, sampled = forms_at_points.forms, forms_at_points.point, forms_at_points.sampled
    result.matrix, result.modulus = sparse(sampled.matrix), point.p
    result.method = "Lie algebra along a curve over GF(p)"
    result.velocity_dof = forms.n - forms_at_points.rank
    result.dof = forms.n - forms_at_points.integrable
    asked = setting.grows and sampled.span.grows_at_once
    if asked:
        span = sampled.span
        result.growth = span.growth or spanning_curves(forms.rows, sampled.frame, point, span)[1]
    result.derived = derived_flag(forms.rows, sampled.frame, point, sampled.span) if setting.flag else None


def _set_labels(forms_at_points: SampledForms, proof_of: Certificate | None, result: Answer) -> None:
    """The label of every row, finite ones and forms; where one is undecided, so is the freedom."""
    for i, row, place in linear_rows(forms_at_points.block, forms_at_points.forms):
        if isinstance(row.piece, Finite):
            result.labels[i] = HolonomyLabel(True, "proved")
            continue
        label = _label(place, forms_at_points, proof_of, result.identical)
        if label.holonomic is None:
            result.verdict, result.dof, result.growth = "undecided", None, None
        elif not label.holonomic and forms_at_points.integrable > forms_at_points.rank_finite:
            label = replace(label, modulo=_modulo_the_others(place, forms_at_points.sampled, forms_at_points.point.p))
        result.labels[i] = label


def certificate(forms_at_points: SampledForms, variety: Variety) -> Certificate | None:
    """A span and a matrix whose non-zero values are proved not to be 0.

    Where the generators are known to be independent and no geometric equation relates them, what is not 0 at a
    point over GF(p) is not 0 as a function; else balls at a real point, up to `CERTIFIED_COLUMNS`.
    """
    real = variety.real
    if real is None or not real.certain:
        return None
    if forms_at_points.trusted and not forms_at_points.forms.finite:
        return forms_at_points.sampled.span, forms_at_points.sampled.matrix
    if forms_at_points.columns > CERTIFIED_COLUMNS:
        return None
    return ball_span(forms_at_points.forms, forms_at_points.rank, real.point)


def _depend_identically(forms_at_points: SampledForms, proof_of: Certificate | None, on_relation: bool) -> bool:
    """Return whether each row that depends on others is a combination of these, by identities and near a point.

    ``on_relation``: where the only geometric equation is satisfied; else everywhere.
    """
    forms, sampled, p = forms_at_points.forms, forms_at_points.sampled, forms_at_points.point.p
    for i, support in echelon(sparse(sampled.matrix), p, supports=True).supports.items():
        frame = field_frame([sampled.matrix[k] for k in support], forms_at_points.columns, p)
        minor = [[proof_of[1][k][c] for c in frame.dependent] for k in support] if proof_of else []
        bordered = BorderedMinors(forms, replace(frame, rows=support))
        is_regular = not support or (bool(minor) and rank_over(minor, minor[0][0]) == len(support))
        if not is_regular or not bordered.is_combination(forms.rows.entries[i], on_relation):
            return False
    return True


def _rank_verdict(
    forms_at_points: SampledForms, proof_of: Certificate | None, result: Answer, setting: Setting
) -> Verdict:
    """How certain the rank and the Lie algebra's dimension are.

    Independent rows have their rank certified by the ball, others depend on them by identities. The dimension is not
    too large by a certificate of the ball; not too small where it is everything, where D is a line or involutive, and
    where as many rows integrate by themselves, or integrals are known, as the Lie algebra leaves directions out.
    """
    sampled, rank, n = forms_at_points.sampled, forms_at_points.rank, forms_at_points.columns
    if proof_of is None or proof_of[0].dimension != sampled.span.dimension:
        return "probable"
    if not (result.identical or _depend_identically(forms_at_points, proof_of, True)):
        return "probable"
    if sampled.span.dimension == n or n - rank <= 1:
        return "proved"
    rows = linear_rows(forms_at_points.block, forms_at_points.forms)
    forms = [r.piece for _, r, k in rows if isinstance(r.piece, Pfaffian) and k in sampled.frame.rows]
    wanted = n - sampled.span.dimension - (rank - len(forms))
    spare = len(forms) - wanted
    unproved = islice((f for f in forms if proof(f, setting.positive) is None), spare + 1) if spare >= 0 else forms
    if (spare >= 0 and len([*unproved]) <= spare) or forms_at_points.is_involutive:
        return "proved"
    number = forms_at_points.integrable - forms_at_points.rank_finite
    possible = forms_at_points.whole and result.trusted and is_short(forms_at_points.forms)
    integrals = first_integrals(forms_at_points.forms, number) if possible else []
    return "proved" if sum(f.identically for f in integrals) == number else "probable"


def _label(place: int, forms_at_points: SampledForms, proof_of: Certificate | None, identical: bool) -> HolonomyLabel:
    """Return whether the row annihilates the Lie algebra of D, so is in the largest integrable part [HermannNagano].

    Rows that leave a line, or an involutive D, are all in it, and what depends on them by an identity.
    """
    zero = [all(v == 0 for v in pairing(s.matrix[place], s.span.vectors)) for _, s in forms_at_points.samples]
    if all(zero):
        line = forms_at_points.columns - forms_at_points.rank <= 1
        counted = line or identical or place in forms_at_points.sampled.frame.rows
        sure = proof_of is not None and counted and forms_at_points.is_involutive
        return HolonomyLabel(True, "proved" if sure else "probable", "line" if line else "")
    disagree = "exact arithmetic and certified intervals disagree: an identity between functions was not detected"
    if proof_of is None:
        return (
            HolonomyLabel(False, "probable") if forms_at_points.trusted else HolonomyLabel(None, "undecided", disagree)
        )
    span, matrix = proof_of
    if not all(map(vanishes, pairing(matrix[place], span.vectors))):
        return HolonomyLabel(False, "proved")
    return HolonomyLabel(None, "undecided", disagree)


def _modulo_the_others(place: int, sampled: SampledSpan, p: int) -> bool:
    """Return whether the row is in the sum of the largest integrable part and the other rows, but not in their span.

    It is in that sum where it vanishes on all vectors of the Lie algebra on which the other rows vanish.
    """
    others = [row for i, row in enumerate(sampled.matrix) if i != place]
    if not others or rank_of(others, p) == rank_of(sampled.matrix, p):
        return False
    vectors = sampled.span.vectors
    paired = residue_matrix([[int(v) for v in pairing(row, vectors)] for row in others], p)
    pairings = pairing(sampled.matrix[place], vectors)
    return all(sum(map(mul, vector, pairings)) == 0 for vector in null_vectors(paired))


def integrable_names(forms: Codistribution, point: FieldPoint, span: Span) -> tuple[str, ...]:
    """Dependent coordinates: pivots of the annihilator of the Lie algebra at a point."""
    if not span.vectors:
        return tuple(str(s.args[1]) for s in forms.chart.symbols if s != ex.TIME)
    rows = null_vectors(residue_matrix([[int(v) for v in vector] for vector in span.vectors], point.p))
    return dependent_names(sparse(rows), forms.chart, point.p) if rows else ()


def ball_labels(block: Block, forms: Codistribution, real: RealPoint, result: Answer) -> Span | None:
    """Set labels from a real point, where what a tiny ball contains 0 of is taken for 0; return its Lie algebra."""
    at = values(forms.chart.ring, real.point)
    matrix = forms.rows.matrix(at, arb(0))
    part = ball_part(matrix)
    rank = part.rank
    total, n = len(forms.chart.symbols), forms.n
    lie_algebra = ball_span(forms, rank, real.point)
    if lie_algebra is None or part.gap < CLEAR:
        result.verdict, result.consistent = "undecided", None
        result.reasons.append("only singular points were found")
        return None
    span, _ = lie_algebra
    reached = span.dimension == total - forms.finite
    brackets = ball_part(span.vectors)  # pivots fall anyway: what is left of the Lie algebra lies below them by less
    gap = part.gap if reached else min(part.gap, brackets.gap / brackets.fall)
    result.verdict, result.method = "numeric", "Lie algebra along a curve with balls"
    result.argument, result.gap = "Lie algebra with balls", gap
    result.velocity_dof = n - rank
    if gap >= CLEAR:
        result.dof = n - (total - span.dimension)
        result.reasons.append(f"decided at real points of high precision, with a gap of {gap:.1e} between pivots")
    else:
        result.verdict = "undecided"
        result.reasons.append(
            f"Lie brackets are resolved down to a gap of {gap:.1e} only, so some may have been missed"
        )
    if "field" not in forms.chart.setting.engines or result.about == "reference":
        result.matrix = sparse(dependencies(matrix, part))
        if real.consistent and len(real.part.rows) == forms.finite and rank == len(matrix):
            result.verdict = "proved" if reached or total - rank <= 1 else result.verdict
    for i, row, place in linear_rows(block, forms):
        finite = isinstance(row.piece, Finite)
        zero = all(v.contains(0) for v in pairing(matrix[place], span.vectors))
        if zero and gap < CLEAR and not finite:
            result.labels[i] = HolonomyLabel(None, "undecided", "a decisive Lie bracket may have been lost to rounding")
            continue
        sure: Verdict = "proved" if finite or not zero else "numeric"
        result.labels[i] = HolonomyLabel(zero, sure)
    return span


# The reference configuration and the generic points at which rows are labelled


def reference_points(forms: Codistribution, reference: Mapping[Expr, Expr]) -> list[FieldPoint] | None:
    """Return the reference configuration (t = 0) over GF(p), one point per sample; none if an equation is not 0 there.

    None where it has no point over GF(p): numbers there may be related in a way that is not known.
    """
    points = [pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 11 + k) for k in range(SAMPLES)]
    drawn = [point for point in points if point is not None]
    if len(drawn) < SAMPLES or odd_constants(forms.chart.ring, named=True):
        return None
    return drawn if all(on_variety(forms.chart, point) for point in drawn) else []


def span_at_reference(forms: Codistribution, reference: Mapping[Expr, Expr]) -> tuple[FieldPoint, SampledSpan] | None:
    """Return the reference configuration over GF(p) and the Lie algebra there; None where it has no such point."""
    points = reference_points(forms, reference) if "field" in forms.chart.setting.engines else None
    sampled = span_at(forms, points[0], True) if points else None
    return (points[0], sampled) if points and sampled else None


def set_at_reference(forms: Codistribution, reference: tuple[FieldPoint, SampledSpan], result: Answer) -> None:
    """Set what the reference has of its own: dependent coordinates; no matrix if rows that others need lose rank."""
    point, here = reference
    result.dependent = integrable_names(forms, point, here.span)
    kept = echelon(result.matrix, result.modulus).independent
    if rank_of([here.matrix[k] for k in kept], point.p) < len(kept):
        result.matrix = []


def is_exceptional(forms: Codistribution, reference: tuple[FieldPoint, SampledSpan], rank: int, span: Span) -> bool:
    """Return whether the rows or the Lie algebra are smaller at the reference configuration than elsewhere.

    Several leaves, or one of smaller dimension, can pass through such a configuration [HermannNagano]. Rows count by
    what they say of velocities: where only the dt term remains no motion passes.
    """
    point, here = reference
    return rank_of([row[: forms.n] for row in here.matrix], point.p) < rank or here.span.dimension < span.dimension
