"""The freedom of a block with differential relations and the labels of its rows, over GF(p) or with balls.

D is the kernel of the rows, I^(inf) their largest integrable subsystem: the annihilator of the Lie algebra of D.
A row is holonomic if it is in I^(inf). Labels are valid on the component of the generic point [HermannNagano].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from operator import mul

from flint import arb

from dofkit.base.errors import NoValueError
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
from dofkit.integrability.bordered_minors import BorderedMinors, is_short
from dofkit.integrability.first_integrals import first_integrals
from dofkit.integrability.growth_vector import derived_flag, spanning_curves
from dofkit.integrability.lie_algebra import SampledSpan, Span, ball_span, span_at
from dofkit.integrability.pfaffian_system import Codistribution, linear_rows
from dofkit.integrability.traits import proof
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.relations.setting import Setting

#: Lie algebras are certified with balls up to so many columns; D is proved involutive by identities up to so many rows.
CERTIFIED_COLUMNS, MAX_FORMS = 16, 3


@dataclass(frozen=True)
class SampledForms:
    """A block's rows at points over GF(p), ``samples``; the largest Lie algebra among them counts as the generic one.

    ``use_identities``: whether proofs by identities, which take longer, are tried (when more than labels is requested).
    """

    block: Block
    forms: Codistribution
    samples: Sequence[tuple[FieldPoint, SampledSpan]]
    use_identities: bool

    @cached_property
    def trusted(self) -> bool:
        """Whether what is 0 at random points over GF(p) is an identity: the functions that occur are independent."""
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
        """The frame, the matrix and the Lie algebra at `point`."""
        return self._largest[1]

    @property
    def columns(self) -> int:
        """The number of columns: coordinates, and time where it occurs."""
        return len(self.forms.chart.symbols)

    @property
    def rank(self) -> int:
        """The number of independent rows."""
        return len(self.sampled.frame.rows)

    @property
    def integrable(self) -> int:
        """The rank of I^(inf), which annihilates the Lie algebra."""
        return self.columns - self.sampled.span.dimension

    @cached_property
    def is_involutive(self) -> bool:
        """Whether D is closed under brackets: a line field always is; otherwise True only if identities prove it."""
        frame, allowed = self.sampled.frame, self.columns - self.rank
        if allowed <= 1 or self.sampled.span.dimension > allowed or self.rank > MAX_FORMS or not self.use_identities:
            return allowed <= 1
        rows = [r.piece for _, r, k in linear_rows(self.block, self.forms) if k in frame.rows]
        forms = [dict(p.items()) for p in rows if isinstance(p, Pfaffian)]
        return BorderedMinors(self.forms, frame).are_involutive(forms)

    @cached_property
    def rank_finite(self) -> int:
        """The number of independent differentials of geometric equations."""
        return rank_of(self.sampled.matrix[: self.forms.finite], self.point.p)


#: A Lie algebra and the matrix of the rows at a point, in numbers for which a value other than 0 is proved not to be 0.
Certificate = tuple[Span, Sequence[Sequence[Scalar]]]


def field_labels(
    block: Block,
    forms: Codistribution,
    variety: Variety,
    samples: list[tuple[FieldPoint, SampledSpan]],
    result: Answer,
    setting: Setting,
) -> None:
    """Set freedoms, labels and verdict in ``result`` from points over GF(p), certified by a ball where there is one."""
    forms_at_points = SampledForms(block, forms, samples, setting.grows)
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
    agree = proof_of is not None and proof_of[0].dimension == forms_at_points.sampled.span.dimension
    if not (forms_at_points.trusted or agree):
        _leave_undecided(result, RELATED)
        return
    result.identical = _depend_identically(forms_at_points, proof_of, False)
    sure = _rank_verdict(forms_at_points, proof_of, result, setting)
    if sure != "proved" and forms.chart.ring.signs and forms_at_points.integrable > forms_at_points.rank_finite:
        _leave_undecided(result, "for other signs in absolute values the rows may be less integrable")
        return
    result.verdict = weakest(variety.verdict, sure)
    result.argument = "Lie algebra, certified" if result.verdict == "proved" else "Lie algebra at points"
    rows = forms.rows.entries
    result.bits = error_bits(forms.chart.ring, [node for row in rows for node in row.values()], len(rows))
    if any(s.span.dimension != forms_at_points.sampled.span.dimension for _, s in samples):
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("the freedom differs between points; the generic value is given")
    _set_labels(forms_at_points, proof_of, result)
    result.dependent = dependent_coordinates(forms, forms_at_points.point, forms_at_points.sampled.span)


#: Why labels are undecided where functions may be related.
RELATED = "the functions that occur may satisfy an identity on the set, and no certified interval excludes zero there"


def _leave_undecided(result: Answer, reason: str) -> None:
    result.dof, result.velocity_dof, result.growth, result.verdict = None, None, None, "undecided"
    result.reasons.append(reason)


def _set_freedom(forms_at_points: SampledForms, result: Answer, setting: Setting) -> None:
    """Set velocity freedom n - rank, freedom n - rank I^(inf), and if requested growth vector and derived flag."""
    forms, point, sampled = forms_at_points.forms, forms_at_points.point, forms_at_points.sampled
    result.matrix, result.modulus = sparse(sampled.matrix), point.p
    result.method = "Lie algebra along a curve over GF(p)"
    result.velocity_dof = forms.n - forms_at_points.rank
    result.dof = forms.n - forms_at_points.integrable
    span = sampled.span
    if setting.grows and span.grows_at_once:
        result.growth = span.growth or spanning_curves(forms.rows, sampled.frame, point, span)[1]
    result.derived = derived_flag(forms.rows, sampled.frame, point, sampled.span) if setting.flag else None


def _set_labels(forms_at_points: SampledForms, proof_of: Certificate | None, result: Answer) -> None:
    """Set the label of every row, geometric or Pfaffian; if one is undecided, the freedom is set to undecided too."""
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
    """Return the certificate: over GF(p) if functions are independent and no geometric equation occurs; else in balls.

    None without a certain real point, with more than `CERTIFIED_COLUMNS` columns, or at a singular point.
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
    """Return whether each row that depends on others is proved, by identities, to be a combination of these.

    ``on_relation``: only where the single geometric equation is satisfied; else everywhere. The minor by which the
    identities divide must not be 0 in the certificate ``proof_of``.
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
    """Return how certain the rank of the rows and the dimension of the Lie algebra are: proved or probable.

    The ball certifies that rank and dimension are not smaller; identities, that the rank is not larger. The dimension
    is not larger if it is that of the space, if D is a line or involutive, or if as many rows are integrable alone, or
    as many first integrals are found, as the Lie algebra has codimension.
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
    integrable = n - sampled.span.dimension - (rank - len(forms))
    spare = len(forms) - integrable  # so many forms need no proof that they are integrable
    unproved = islice((f for f in forms if proof(f, setting.positive) is None), max(spare + 1, 0))
    if len([*unproved]) <= spare or forms_at_points.is_involutive:
        return "proved"
    number = forms_at_points.integrable - forms_at_points.rank_finite
    may_integrate = forms_at_points.use_identities and result.trusted and is_short(forms_at_points.forms)
    integrals = first_integrals(forms_at_points.forms, number) if may_integrate else []
    return "proved" if sum(f.identically for f in integrals) == number else "probable"


def _label(place: int, forms_at_points: SampledForms, proof_of: Certificate | None, identical: bool) -> HolonomyLabel:
    """Return the label of the row ``place``: holonomic if it annihilates the Lie algebra of D [HermannNagano].

    Proved where D is a line or involutive, because then I^(inf) contains all independent rows of the frame, and the
    rows that depend on them identically.
    """
    zero = [all(v == 0 for v in pairing(s.matrix[place], s.span.vectors)) for _, s in forms_at_points.samples]
    if all(zero):
        line = forms_at_points.columns - forms_at_points.rank <= 1
        in_rows = line or identical or place in forms_at_points.sampled.frame.rows
        sure = proof_of is not None and in_rows and forms_at_points.is_involutive
        return HolonomyLabel(True, "proved" if sure else "probable", "line" if line else "")
    disagree = "exact arithmetic and certified intervals disagree: an identity between functions was not detected"
    undecided = HolonomyLabel(None, "undecided", disagree)
    if proof_of is None:
        return HolonomyLabel(False, "probable") if forms_at_points.trusted else undecided
    span, matrix = proof_of
    return undecided if all(map(vanishes, pairing(matrix[place], span.vectors))) else HolonomyLabel(False, "proved")


def _modulo_the_others(place: int, sampled: SampledSpan, p: int) -> bool:
    """Return whether row ``place`` is in the sum of I^(inf) and the span of the other rows, but not in that span.

    It is in the sum if it vanishes on all vectors of the Lie algebra on which the others vanish. False without others.
    """
    others = [row for i, row in enumerate(sampled.matrix) if i != place]
    if not others or rank_of(others, p) == rank_of(sampled.matrix, p):
        return False
    vectors = sampled.span.vectors
    paired = residue_matrix([[int(v) for v in pairing(row, vectors)] for row in others], p)
    pairings = pairing(sampled.matrix[place], vectors)
    return all(sum(map(mul, vector, pairings)) == 0 for vector in null_vectors(paired))


def dependent_coordinates(forms: Codistribution, point: FieldPoint, span: Span) -> tuple[str, ...]:
    """Return the names of the dependent coordinates: pivots of the annihilator of the Lie algebra at a point."""
    if not span.vectors:
        return tuple(str(s.args[1]) for s in forms.chart.symbols if s != ex.TIME)
    rows = null_vectors(residue_matrix([[int(v) for v in vector] for vector in span.vectors], point.p))
    return dependent_names(sparse(rows), forms.chart, point.p) if rows else ()


def ball_labels(block: Block, forms: Codistribution, real: RealPoint, result: Answer) -> Span | None:
    """Set freedoms, labels and verdict from balls at a real point, and return its Lie algebra; None if it is singular.

    A ball that contains 0 counts as 0, which is only numeric evidence; a ball that excludes 0 is a proof.
    """
    at = values(forms.chart.ring, real.point)
    matrix = forms.rows.matrix(at, arb(0))
    part = ball_part(matrix)
    rank = part.rank
    total, n = len(forms.chart.symbols), forms.n  # columns with and without time
    lie_algebra = ball_span(forms, rank, real.point)
    if lie_algebra is None or part.gap < CLEAR:
        result.verdict, result.consistent = "undecided", None
        result.reasons.append("only singular points were found")
        return None
    span, _ = lie_algebra
    reached = span.dimension == total - forms.finite
    brackets = ball_part(span.vectors)  # a missed bracket may be smaller than the last pivot by the usual ratio `fall`
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
    """Return `SAMPLES` points over GF(p) at the reference configuration (t = 0), other symbols random.

    Empty if it does not satisfy the geometric equations; None if it cannot be written over GF(p), or constants occur
    that may satisfy an unknown relation.
    """
    points = [pose_point(forms.chart, {**reference, ex.TIME: ex.ZERO}, 11 + k) for k in range(SAMPLES)]
    defined = [point for point in points if point is not None]
    if len(defined) < SAMPLES or odd_constants(forms.chart.ring, named=True):
        return None
    return defined if all(on_variety(forms.chart, point) for point in defined) else []


def span_at_reference(forms: Codistribution, reference: Mapping[Expr, Expr]) -> tuple[FieldPoint, SampledSpan] | None:
    """Return a point over GF(p) at the reference and the Lie algebra there, or None; without it raises NoValueError."""
    points = reference_points(forms, reference) if "field" in forms.chart.setting.engines else None
    if not points:
        return None
    if (sampled := span_at(forms, points[0], special=True)) is None:
        raise NoValueError
    return points[0], sampled


def set_at_reference(forms: Codistribution, reference: tuple[FieldPoint, SampledSpan], result: Answer) -> None:
    """Set in ``result`` the dependent coordinates at the reference; clear its matrix if the rows have lower rank there.

    The matrix, that at a generic point, would then give wrong dependences there.
    """
    point, sampled = reference
    result.dependent = dependent_coordinates(forms, point, sampled.span)
    independent = echelon(result.matrix, result.modulus).independent
    if rank_of([sampled.matrix[k] for k in independent], point.p) < len(independent):
        result.matrix = []


def is_exceptional(forms: Codistribution, reference: tuple[FieldPoint, SampledSpan], rank: int, span: Span) -> bool:
    """Return whether the rank of the rows or the dimension of the Lie algebra is smaller at the reference.

    Several leaves, or one of smaller dimension, can pass through such a configuration [HermannNagano]. The rank is that
    of the coordinates' columns: a row with only a dt term excludes motion instead of restricting velocities.
    """
    point, at = reference
    return rank_of([row[: forms.n] for row in at.matrix], point.p) < rank or at.span.dimension < span.dimension
