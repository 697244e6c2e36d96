"""The configuration space of a block as far as it is known, and its certified points as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import arb

from dofkit.base.verdicts import About, ArgumentKey, Verdict
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealPoint
from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import GAP
from dofkit.relations.blocks import Chart


@dataclass
class Variety:
    """The set {g = 0} of a block's finite relations, as far as it is known.

    ``consistent``: None where it is not known. ``dimension``: of the configuration space at fixed time (None:
    not decided). ``samples``: points over GF(p) on it; ``real``: a real point with balls; ``about``: is it told of
    the largest part, or of the ``component`` of these points? ``argument``, ``gap``, ``witness``: see `Answer`.
    ``parted``: these points lie on different parts of it. ``separating``: expressions each of which vanishes on every
    component of this dimension, where there may be others.
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


def of_real_point(chart: Chart, real: RealPoint | None) -> Witness | None:
    """Coordinates, time and named parameters at a point whose ball holds a true zero; None without one."""
    if real is None or not real.certified or not real.consistent or real.solved < real.rank:
        return None
    named = {s: v for s, v in real.point.symbols.items() if not str(s.args[-1]).startswith("_")}
    return {**dict.fromkeys(chart.symbols, "0"), **{s: _text(v) for s, v in named.items()}}


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
