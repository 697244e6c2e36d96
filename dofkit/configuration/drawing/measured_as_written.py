"""A measured drawing read as written: numbers that make relations dependent exactly, not only within a tolerance.

Such a drawing is one of those that the tolerance allows, and what is dependent in it is taken for exactly so in any
case. Where the tolerance hides which motions to first order are finite ones, what is written says it: relations that
are met along a motion to the last digit are so by no chance. That they are not, because a length is a little off, may
be one: nothing is said where less moves as written than was followed within the tolerance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from dofkit.configuration.drawing.at_reference import AtReference, at_reference
from dofkit.configuration.drawing.measured import FOLLOWED, OPEN, Measured
from dofkit.configuration.drawing.measured_branches import branch_dimension
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart

AS_WRITTEN = "with the numbers exactly as written the equations are dependent, which decides: {}"
ALONE = (
    "the one infinitesimal motion is not a finite motion of the geometry as written, and no finite "
    "motion was found within the tolerance"
)
STOPPED = (
    "the infinitesimal motion extends to a finite motion within the tolerance but not for the geometry "
    "as written, so the tolerance leaves it open"
)
HIDDEN = "the geometry as written allows no finite motion, but lengths within the tolerance may allow one"


def held_against_exact(told: Measured, chart: Chart, drawing: Mapping[Expr, Expr]) -> Measured:
    """What was measured, decided or left open by the drawing as written where its exact rank is the same."""
    if told.reason not in (OPEN, FOLLOWED) or chart.time is not None:
        return told
    first = at_reference(chart, drawing, exact=False)
    exact = at_reference(chart, drawing) if first and first.instantaneous == told.instantaneous else None
    return told if exact is None else _held_against(told, exact)


def _held_against(told: Measured, exact: AtReference) -> Measured:
    found, first = exact.local.dimension, exact.instantaneous
    if found is None or found == told.dimension:
        return told
    if told.dimension is None and told.forms is not None:
        told = replace(told, seen=max(told.seen, exact.rigid + branch_dimension(told.forms)), forms=None)
    if told.dimension is not None or found < min(told.seen, first - 1):
        return replace(told, dimension=None, reason=STOPPED)
    if found > exact.rigid:
        return replace(told, dimension=found, reason=AS_WRITTEN.format(exact.local.reason))
    if first == exact.rigid + 1 and told.seen == exact.rigid:
        return replace(told, dimension=found, reason=ALONE)
    return replace(told, reason=HIDDEN)
