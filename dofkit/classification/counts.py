"""Counts shown next to a report's own: in general position, and Gruebler's and Kutzbach's; and why they differ.

If positions are rounded, an exact rank may be full although the true one is not. A gap between the singular values of
the relations between twists, with rows of length 1, shows this. Rotations are taken about the centroid of a body's
points and multiplied by their largest distance from it, so that a small body in a large scene causes no gap.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from math import ceil, log10
from typing import TypeVar

from dofkit.base.deadline import part, unless_late
from dofkit.base.wording import many, verb
from dofkit.classification.study import Study
from dofkit.exact.matrices.dense import length, plus, singular_values, unit_rows
from dofkit.exact.matrices.sparse import cross, echelon
from dofkit.exact.ring.program import raising_no_value
from dofkit.mobility import special_position
from dofkit.mobility.counts import kutzbach_count
from dofkit.mobility.general_position import GenericRank, in_general_position
from dofkit.mobility.placement import TURNS, Member, Placement, measured_placement, reference_placement, rows_of
from dofkit.report import Generic, Mobility

#: Bounds on the dependent sets of rows examined in a block, and on the sentences about special positions.
MOST_SETS, MOST_TOLD = 40, 6
#: Near-dependence is tested up to so many columns.
MOST_COLUMNS = 200
#: A singular value is nearly 0 if it is below `NEAR` and smaller than the next one by the factor `GAP`.
NEAR, GAP = 2e-3, 100.0
#: Share of the remaining time for the count in general position.
SHARE = 0.4
#: Positions with a tolerance count as special (lines as parallel, for example) within so many tolerances.
SLACK = 10
T = TypeVar("T")
_LATE = GenericRank(None, why="there was no time to count")


@dataclass(frozen=True)
class CountsBeside:
    """The counts of one scene; ``instantaneous``: its velocity freedom at the reference configuration."""

    study: Study
    instantaneous: int | None

    def generic(self) -> Generic | None:
        """The count in general position; None without a reference configuration."""
        study, system = self.study, self.study.system
        if not system.has_geometry:
            return None
        result = unless_late(partial(in_general_position, system, study.outcome.written_rows, study.setting), _LATE)
        if result.rank is None:
            return Generic(dof=None, redundant_equations=None, differs=result.why, verdict="undecided")
        dof = len(system.coordinates) - result.rank
        return Generic(
            dof=dof,
            redundant_equations=max(0, study.equations - result.rank),
            differs=unless_late(partial(self._differs, dof), None),
            verdict=result.verdict,
        )

    def _differs(self, dof: int) -> str | None:
        """Return why the freedom differs from that in general position, or None where it does not."""
        here = self.study.outcome.velocity_dof if self.instantaneous is None else self.instantaneous
        if here is None or here == dof:
            return None
        if here < dof:
            return (
                "the reference configuration allows less than general position, because the equations are special there"
            )
        more = here - dof
        start = f"this geometry is special: {many(more, 'more equation')} {verb(more, 'is', 'are')} dependent"
        if self._placement is None:
            return start
        system = self.study.system
        slack = SLACK * float(system.tolerance or 0)
        facts = special_position.special_facts(system, self._placement, self._dependent_sets(), slack)
        return "; ".join([start, *facts[:MOST_TOLD]])

    @cached_property
    def _placement(self) -> Placement | None:
        system = self.study.system
        measured = system.tolerance is not None
        return measured_placement(system) if measured else reference_placement(system, self.study.setting.positive)

    def _dependent_sets(self) -> list[list[int]]:
        """Return the constraints of minimal dependent sets of rows and of circuits; none contains another."""
        sets: list[list[int]] = []
        for block, a in self.study.outcome.answered_parts:
            if len(a.matrix) != len(block.rows):
                continue
            for row, support in list(echelon(a.matrix, a.modulus, supports=True).supports.items())[:MOST_SETS]:
                sets.append(sorted({block.rows[k].constraint for k in (row, *support)}))
        sets += [sorted((i, *c)) for r in self.study.dependence.dependent for i, c in r.circuits.items()]
        unique = sorted(map(list, {tuple(s) for s in sets}))
        return [s for s in unique if not any(set(t) < set(s) for t in unique)]

    def nearly(self) -> str | None:
        """Return a warning if the rows are nearly dependent at an exact reference configuration, otherwise None."""
        here, system = self.instantaneous, self.study.system
        if here is None or system.tolerance is not None or not system.has_geometry:
            return None
        columns = len(system.coordinates)
        small = columns <= MOST_COLUMNS and all(c.facts.velocities is not None for c in system.connections)
        placement = measured_placement(system) if small else None
        return None if placement is None else _nearly_dependent(placement, system.dimension, columns, columns - here)

    def mobility(self) -> Mobility | None:
        """Return Gruebler's and Kutzbach's count; None without bodies and joints."""
        equations = [r.equations for r in self.study.reduced]
        return kutzbach_count(self.study.system, equations, self.study.outcome.velocity_dof, self._exact)

    def _exact(self) -> Placement | None:
        return None if self.study.system.tolerance is not None else self._placement


def _if_it_has_a_value(work: Callable[[], T]) -> T | None:
    """Return the result of ``work``; None if time runs out or an expression has no value at the reference."""
    try:
        return unless_late(raising_no_value(work), None)
    except (ArithmeticError, ValueError):
        return None


def counts_beside(study: Study, instantaneous: int | None) -> tuple[dict[str, Generic | Mobility | None], str | None]:
    """Return the report's fields ``generic`` and ``mobility``, and a warning of a near-dependence or None.

    ``instantaneous``: the velocity freedom at the reference configuration.
    """
    counts = CountsBeside(study, instantaneous)
    with part(SHARE):
        generic = _if_it_has_a_value(counts.generic)
    return {"generic": generic, "mobility": _if_it_has_a_value(counts.mobility)}, _if_it_has_a_value(counts.nearly)


def _nearly_dependent(placement: Placement, dimension: int, columns: int, rank: int) -> str | None:
    """Return a warning of a near-dependence, with the `tolerance` to set; None if there is none or it is not tested.

    ``placement`` in floating point, lengths in units of the scene's size; ``rank``: the exact one.
    """
    if not 1 < rank <= columns <= MOST_COLUMNS:
        return None
    rows = []
    for connection in placement.located:
        conditions = rows_of(connection)
        if conditions is None:
            return None
        rows += conditions
    j = [[float(row.get(c, 0.0)) for c in range(columns)] for row in rows]
    gap = _gap(j, rank)
    # a near-dependence only in one choice of origin and unit is none
    if gap is None or _gap(_about_centroids(j, placement, dimension), rank) is None:
        return None
    small, large = gap
    tolerance = 10.0 ** ceil(log10(max(small, 1e-12)))
    return (
        f"the equations are nearly dependent at the reference configuration (singular values of {small:.1e} "
        f"beside {large:.1e}): if "
        f"its positions are rounded or measured, `tolerance: {tolerance:g}` states their accuracy"
    )


def _about_centroids(j: list[list[float]], placement: Placement, dimension: int) -> list[list[float]]:
    """Return the rows in terms of velocities v' of the centroids and w' = reach w: v = v' - w x (middle - start).

    So their sizes do not depend on the unit of length and on the origin.
    """
    j = [list(row) for row in j]
    for member, points in _points(placement).values():
        first, start = member.column, member.start
        if first is None or start is None:
            continue
        middle = [sum(places) / len(points) for places in zip(*points, strict=True)]
        reach = max(*(length(plus(at, -1.0, middle)) for at in points), 1e-9) if len(points) > 1 else 1.0
        arm = plus(middle, -1.0, list(map(float, start)))
        turn = slice(first + dimension, first + dimension + TURNS[dimension])
        for row in j:
            v, w = row[first : turn.start], row[turn]
            if dimension == 2:
                row[turn] = [(w[0] + arm[1] * v[0] - arm[0] * v[1]) / reach]
            elif dimension == 3:
                row[turn] = [a / reach for a in plus(w, -1.0, cross(arm, v))]
    return j


def _points(placement: Placement) -> dict[int, tuple[Member, list[list[float]]]]:
    """Return {first column of a member: (member, points at which it is connected)}."""
    points_of: dict[int, tuple[Member, list[list[float]]]] = {}
    for connection in placement.located:
        joined = ((member, at) for at in connection.places for member in connection.members)
        for member, at in (*connection.points, *joined):
            if member.column is not None:
                points_of.setdefault(member.column, (member, []))[1].append(list(map(float, at)))
    return points_of


def _gap(j: list[list[float]], rank: int) -> tuple[float, float] | None:
    """Return (the largest singular value that is nearly 0, the next larger one); None if none is nearly 0."""
    for above, below in pairwise(singular_values(unit_rows(j))[:rank]):
        if below < NEAR and above > GAP * below:
            return below, above
    return None
