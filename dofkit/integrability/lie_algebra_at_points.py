"""The Lie algebra of the admissible velocities at points: over GF(p), and with balls."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import Any

from flint import arb

from dofkit.configuration.generic_dimension import real_point
from dofkit.configuration.variety import Variety
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import Pivots, field_frame
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.integrability.lie_algebra import Span, lie_span
from dofkit.integrability.pfaffian_system import Codistribution

#: Searches for a real point on the part of the set that points over GF(p) are on.
SEEDS = 6


@dataclass(frozen=True)
class SampledSpan:
    """A span at a point, with the matrix and the frame there."""

    span: Span
    matrix: list[list[Any]]
    frame: Pivots


def span_at(forms: Codistribution, point: FieldPoint, drawn: bool = False) -> SampledSpan | None:
    """The Lie algebra at a point over GF(p); None where a form has no value there. ``drawn``: see `lie_span`."""
    try:
        zero = point.number(ex.ZERO.args[0])
        matrix = forms.rows.matrix(values(forms.chart.ring, point), zero)
        frame = field_frame(matrix, len(forms.chart.symbols), point.p)
        return SampledSpan(lie_span(forms.rows, frame, point, drawn), matrix, frame)
    except NoValueError:
        return None


def ball_span(
    forms: Codistribution, rank: int, point: BallPoint, drawn: bool = False
) -> tuple[Span, list[list[arb]]] | None:
    """The Lie algebra with balls; None where the point is no regular one, or has another rank than over GF(p)."""
    try:
        matrix = forms.rows.matrix(values(forms.chart.ring, point), arb(0))
        part = ball_part(matrix)
        if part.rank != rank:
            return None
        free = tuple(c for c in range(len(forms.chart.symbols)) if c not in set(part.columns))
        point.rng.seed("dofkit curve")
        return lie_span(forms.rows, Pivots(tuple(part.rows), tuple(part.columns), free), point, drawn), matrix
    except NoValueError:
        return None


def on_the_same_part(forms: Codistribution, found: Variety, largest: SampledSpan) -> RealPoint | None:
    """A real point at which the Lie algebra is as large as at the points over GF(p): of a part of the set like theirs.

    Where sin(z) = 0, z ydot = 0 says nothing at z = 0, and ydot = 0 at all other configurations.
    """
    seeds = (real_point(forms.chart, seed, forms.chart.nodes) for seed in range(1, SEEDS))
    for real in chain((found.real,), seeds):
        if real is None or not real.certified or not real.consistent:
            continue
        span = ball_span(forms, len(largest.frame.rows), real.point)
        if span is not None and span[0].dimension == largest.span.dimension:
            return real
    return None
