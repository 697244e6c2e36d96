"""What is known of the configuration space of a block."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from dofkit.base.verdicts import About, ArgumentKey, Verdict
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.real_search import RealPoint
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import GAP


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
