"""The criteria for finite motion and rigidity, in the order in which they are asked, and their driver.

The first row whose function comes to a conclusion decides. A new criterion is a function of
the germ (`germ.Germ`) in `conclusions`, a row here and one of the arguments; its theorem is a line of
`dofkit/THEOREMS.md`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

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


class Criterion(NamedTuple):
    """A row of the table: its ``key`` among the arguments (`classification/arguments.yaml`), where its words stand.

    ``decide`` checks the hypotheses and returns the conclusion, None where it comes to none. ``verdict``: how certain
    that is at the best, undecided where no later row is asked; with balls alone it is "numeric".
    """

    key: ArgumentKey
    verdict: Verdict
    decide: Callable[[Germ], Conclusion | None]


CRITERIA: tuple[Criterion, ...] = (
    Criterion("independent relations", "proved", conclusions.manifold),
    Criterion("rigid to first order", "proved", conclusions.orbit),
    Criterion("zero along a curve", "probable", conclusions.whole_manifold),
    Criterion("flat along a curve", "undecided", conclusions.flat),
    Criterion("isolated zero of one variable", "proved", conclusions.isolated_zero),
    Criterion("indefinite form", "proved", conclusions.indefinite),
    Criterion("definite form", "proved", conclusions.definite),
    Criterion("definite combination", "proved", conclusions.prestress_stable),
    Criterion("least along a motion", "probable", conclusions.least_along_a_motion),
    Criterion("change of sign", "probable", conclusions.changing_sign),
    Criterion("critical branch", "probable", conclusions.critical_branch),
    Criterion("branch followed", "numeric", conclusions.branch_followed),
)
#: Those by which the set is the whole manifold of the independent relations, or undecided.
OF_MANIFOLDS = CRITERIA[:4]


# The local dimension by the table


def local_dimension(germ: Germ, asked: Sequence[Criterion] = CRITERIA) -> LocalDimension:
    """Return the local dimension by the first criterion that decides; undecided where all ``asked`` are and none does.

    From an approximate point, with balls alone, what a tiny ball holds 0 of is taken for 0, and the verdict is numeric.
    """
    with ctx.workprec(max(ctx.prec, precision())):
        try:
            return _decision(germ, asked)
        except NoValueError:
            return WITHOUT_VALUE


@raising_no_value
def _decision(germ: Germ, asked: Sequence[Criterion]) -> LocalDimension:
    for criterion in asked:
        conclusion = criterion.decide(germ)
        if conclusion is not None:
            verdict = weakest(criterion.verdict, conclusion.verdict, "proved" if germ.exact else "numeric")
            return LocalDimension(conclusion.dimension, verdict, conclusion.reason, conclusion.confined, criterion.key)
    return UNDECIDED


def local_at(
    chart: Chart,
    point: FieldPoint,
    ball: BallPoint | None,
    rigid: int,
    drawn: bool = True,
    asked: Sequence[Criterion] = CRITERIA,
) -> LocalDimension:
    """Return the local dimension at a point of the variety, time counted where it is a column.

    A point that was ``drawn`` may be one where a relation is flat: what is 0 along a curve is looked at from a
    distance, if balls may be asked.
    """
    distance = drawn and "balls" in chart.setting.engines
    try:
        germ = Germ(*_manifolds(chart, frame_at(chart, point), point, ball), rigid, chart.time, distance)
    except NoValueError:
        return WITHOUT_VALUE
    return local_dimension(germ, asked)


def _manifolds(
    chart: Chart, frame: Pivots, point: FieldPoint, ball: BallPoint | None
) -> tuple[Manifold, Manifold | None]:
    """Return the manifold of the frame's relations over GF(p), and over balls where there is a ball."""
    program = chart.ring, chart.nodes, chart.columns, frame
    return Manifold(*program, point), None if ball is None else Manifold(*program, ball, chart.scales)


def vanish_near(chart: Chart, point: FieldPoint, ball: BallPoint | None, rigid: int, rank: int) -> bool | None:
    """Return whether relations have no higher rank than ``rank`` at a point, and are 0 on the manifold of that rank.

    The dependent ones are 0 along a random curve of it [SchwartzZippel], or nothing but rigid motions is left.
    None where they are too high in degree, or could not be followed to a distance, which is asked of a ``ball``.
    """
    frame = frame_at(chart, point)
    if len(frame.rows) != rank:
        return False
    try:
        return _vanish(Germ(*_manifolds(chart, frame, point, ball), rigid, distance=ball is not None))
    except (ArithmeticError, NoValueError):
        return None


def _vanish(germ: Germ) -> bool | None:
    """Return whether the dependent relations of a germ are 0 on its manifold."""
    with ctx.workprec(max(ctx.prec, precision())):
        if germ.dependent == 0 or germ.m == germ.rigid:
            return True
        if not germ.vanishes:
            return False
        return None if germ.order <= germ.degree else germ.vanishes_away
