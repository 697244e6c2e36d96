"""The criteria for finite motion and rigidity, in the order in which they are tried, and their driver.

The first row whose function returns a conclusion decides. A new criterion needs a function of the germ (`germ.Germ`) in
`conclusions`, a row here, an argument in `classification/arguments.yaml`, and its theorem in `dofkit/THEOREMS.md`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Literal, NamedTuple

from flint import ctx

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import ArgumentKey, Verdict, weakest
from dofkit.configuration.local import conclusions
from dofkit.configuration.local.germ import Conclusion, Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.configuration.variety import frame_at
from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.points.balls import BallPoint, precision
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.ring.program import raising_no_value
from dofkit.relations.blocks import Chart

UNDECIDED = LocalDimension(
    None, "undecided", "the equations are dependent here and their lowest-order terms do not decide"
)
WITHOUT_VALUE = LocalDimension(
    None, "undecided", "the equations could not be evaluated along a curve through this configuration"
)
OTHERWISE = LocalDimension(
    None, "undecided", "the equations are dependent here and the dimension depends on the values of the parameters"
)


class Criterion(NamedTuple):
    """A criterion, with the ``key`` of its argument (`classification/arguments.yaml`).

    ``basis``: whether it shows a manifold (or that this is undecided), an isolated zero, or uses signs, which may
    differ for other values of parameters. ``decide`` checks the hypotheses and returns the conclusion, or None.
    ``verdict``: the best verdict of a conclusion ("undecided": no later criterion is tried); with balls only it is
    "numeric".
    """

    key: ArgumentKey
    basis: Literal["manifold", "zero", "signs"]
    verdict: Verdict
    decide: Callable[[Germ], Conclusion | None]


CRITERIA: tuple[Criterion, ...] = (
    Criterion("independent relations", "manifold", "proved", conclusions.manifold),
    Criterion("rigid to first order", "manifold", "proved", conclusions.orbit),
    Criterion("zero along a curve", "manifold", "probable", conclusions.whole_manifold),
    Criterion("flat along a curve", "manifold", "undecided", conclusions.flat),
    Criterion("isolated zero of one variable", "zero", "proved", conclusions.isolated_zero),
    Criterion("indefinite form", "signs", "proved", conclusions.indefinite),
    Criterion("definite form", "signs", "proved", conclusions.definite),
    Criterion("definite combination", "signs", "proved", conclusions.prestress_stable),
    Criterion("least along a motion", "signs", "probable", conclusions.least_along_a_motion),
    Criterion("change of sign", "signs", "probable", conclusions.changing_sign),
    Criterion("critical branch", "signs", "probable", conclusions.critical_branch),
    Criterion("branch followed", "signs", "numeric", conclusions.branch_followed),
)
OF_MANIFOLDS = tuple(criterion for criterion in CRITERIA if criterion.basis == "manifold")
OF_SIGNS = tuple(criterion for criterion in CRITERIA if criterion.basis == "signs")


# The local dimension by the table


def local_dimension(germ: Germ, asked: Sequence[Criterion] = CRITERIA, others: Iterable[Germ] = ()) -> LocalDimension:
    """Return the local dimension by the first of the criteria ``asked`` that decides; undecided if none does.

    At an approximate point, with balls only, a value whose tiny ball contains 0 counts as 0; the verdict is "numeric".
    ``others``: germs for other values of parameters, for which the criteria that use signs must conclude the same; then
    it is "numeric".
    """
    with ctx.workprec(max(ctx.prec, precision())):
        try:
            return _decision(germ, asked, others)
        except NoValueError:
            return WITHOUT_VALUE


@raising_no_value
def _decision(germ: Germ, asked: Sequence[Criterion], others: Iterable[Germ]) -> LocalDimension:
    """Return the local dimension by the first criterion that concludes, or `UNDECIDED`."""
    for criterion in asked:
        conclusion = criterion.decide(germ)
        if conclusion is not None:
            elsewhere = [_decision(other, OF_SIGNS, ()).dimension for other in others] if criterion in OF_SIGNS else []
            if any(dimension != conclusion.dimension for dimension in elsewhere):
                return OTHERWISE
            best: Verdict = "numeric" if elsewhere else "proved"
            verdict = weakest(criterion.verdict, conclusion.verdict, best if germ.exact else "numeric")
            return LocalDimension(conclusion.dimension, verdict, conclusion.reason, conclusion.confined, criterion.key)
    return UNDECIDED


def local_at(
    chart: Chart,
    point: FieldPoint,
    balls: Sequence[BallPoint],
    rigid: int,
    special: bool = True,
    asked: Sequence[Criterion] = CRITERIA,
) -> LocalDimension:
    """Return the local dimension at a point of the variety; time counts if it is a column.

    The point may be ``special``, not random: relations that are 0 along a curve to a high order are then evaluated at a
    distance too, if balls may be used. ``balls``: the point with one value of each parameter, or with several.
    """
    distance = special and "balls" in chart.setting.engines
    try:
        frame = frame_at(chart, point)
        germs = (Germ(*_manifolds(chart, frame, point, b), rigid, chart.time, distance) for b in balls or (None,))
        return local_dimension(next(germs), asked, germs)
    except NoValueError:
        return WITHOUT_VALUE


def _manifolds(
    chart: Chart, frame: Pivots, point: FieldPoint, ball: BallPoint | None
) -> tuple[Manifold, Manifold | None]:
    """Return the manifold of the frame's relations over GF(p), and that over balls if there is a ``ball``."""
    program = chart.ring, chart.nodes, chart.columns, frame
    return Manifold(*program, point), None if ball is None else Manifold(*program, ball, chart.scales)


def vanish_near(chart: Chart, point: FieldPoint, ball: BallPoint | None, rigid: int, rank: int) -> bool | None:
    """Return whether relations have the rank ``rank`` at a point, and the set is the manifold of that codimension.

    The dependent relations must be 0 along a random curve of it [SchwartzZippel], or only rigid motions remain. None if
    their degree is too high, or if they cannot be evaluated at a distance (only with a ``ball``).
    """
    frame = frame_at(chart, point)
    if len(frame.rows) != rank:
        return False
    try:
        germ = Germ(*_manifolds(chart, frame, point, ball), rigid, distance=ball is not None)
        with ctx.workprec(max(ctx.prec, precision())):
            if germ.dependent == 0 or germ.m == germ.rigid:
                return True
            if not germ.vanishes:
                return False
            return None if germ.order <= germ.degree else germ.vanishes_away
    except (ArithmeticError, NoValueError):
        return None
