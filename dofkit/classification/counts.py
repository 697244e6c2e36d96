"""Counts that stand beside a report's own: in general position, and Gruebler's and Kutzbach's; and why they differ."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TypeVar

from dofkit.base.deadline import part, unless_late
from dofkit.base.wording import many, verb
from dofkit.classification.study import Study
from dofkit.exact.matrices.sparse import echelon
from dofkit.exact.ring.program import raising_no_value
from dofkit.mobility import special_position
from dofkit.mobility.counts import kutzbach_count
from dofkit.mobility.general_position import General, in_general_position
from dofkit.mobility.near_dependence import MOST, nearly_dependent
from dofkit.mobility.placement import Placement, drawn_placement, measured_placement
from dofkit.relations.normal.pieces import Finite
from dofkit.report import Generic, Mobility

#: Dependent sets of rows that are looked at, and sentences about them that are told.
MOST_SETS, MOST_TOLD = 40, 6
#: Of the time that is left, for the count in general position.
SHARE = 0.4
#: Measured lines count as parallel, and so on, within so many tolerances.
SLACK = 10
T = TypeVar("T")
_LATE = General(None, why="there was no time to count")


@dataclass(frozen=True)
class CountsBeside:
    """The counts of one scene; the reference configuration is turned into numbers once, where it is asked for."""

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
        return measured_placement(system) if measured else drawn_placement(system, self.study.setting.positive)

    def _dependent_sets(self) -> list[list[int]]:
        """The constraints of minimal dependent sets of rows at the reference, of circuits too; none holds another."""
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
        """What to say of a near-dependence at an exact drawing."""
        here, system = self.instantaneous, self.study.system
        if here is None or system.tolerance is not None or not system.has_geometry:
            return None
        columns = len(system.coordinates)
        small = columns <= MOST and all(c.facts.velocities is not None for c in system.connections)
        placement = measured_placement(system) if small else None
        return None if placement is None else nearly_dependent(placement, system.dimension, columns, columns - here)

    def mobility(self) -> Mobility | None:
        """Gruebler's and Kutzbach's count; None without bodies and joints."""
        study = self.study
        others = sum(
            r.constraint.facts.joint or all(isinstance(p, Finite) for p in n.pieces)
            for r in study.reduced
            for n in r.normals
        )
        equations = [r.equations for r in study.reduced]
        return kutzbach_count(study.system, equations, others, study.outcome.velocity_dof, self._exact)

    def _exact(self) -> Placement | None:
        return None if self.study.system.tolerance is not None else self._placement


def _if_it_has_a_value(work: Callable[[], T]) -> T | None:
    """What was found; None where there was no time, or the drawing has no value (a root of what is negative)."""
    try:
        return unless_late(raising_no_value(work), None)
    except (ArithmeticError, ValueError):
        return None


def counts_beside(study: Study, instantaneous: int | None) -> tuple[dict[str, Generic | Mobility | None], str | None]:
    """``generic`` and ``mobility``, and what to say of a near-dependence; ``instantaneous``: at the reference."""
    counts = CountsBeside(study, instantaneous)
    with part(SHARE):
        generic = _if_it_has_a_value(counts.generic)
    return {"generic": generic, "mobility": _if_it_has_a_value(counts.mobility)}, _if_it_has_a_value(counts.nearly)
