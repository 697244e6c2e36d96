"""What is known of one system: the one argument of every pass. Nothing in it is worked out before it is asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

from dofkit.base.deadline import part, unless_late
from dofkit.base.verdicts import About, least
from dofkit.classification.dependence.circuits import Redundancies, undecided_dependence
from dofkit.classification.dependence.implied_constraints import Conflict, conflict
from dofkit.classification.dependence.redundancy import all_needed, redundancies
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import prepared
from dofkit.classification.labels.companions import AnsweredParts, Companionship
from dofkit.classification.labels.entries import entries_of
from dofkit.exact.zero import BOTH, Engines
from dofkit.relations.normal.pieces import Reduced
from dofkit.relations.setting import ALL, Reductions, Setting
from dofkit.report import ConstraintEntry
from dofkit.system import System

#: Of the time that is left after the blocks: for what depends on what; the rest is for labels.
DEPENDENCE = 0.5


class Dependence(NamedTuple):
    """A minimal set of constraints that cannot hold together, and what depends on what, each by numbers."""

    conflicting: Conflict
    dependent: list[Redundancies]

    @property
    def about(self) -> About:
        """Of which points it is told that what is redundant can go: the narrowest of all parts with something that can.

        That something is needed is told of every point near one, so of the whole.
        """
        return least(*(r.about for r in self.dependent if r.redundant))


@dataclass(frozen=True)
class Study:
    """A system, its relations over the reals, what may be assumed of its symbols, and its blocks' answers."""

    system: System
    reduced: Sequence[Reduced]
    setting: Setting
    outcome: Outcome

    @property
    def names(self) -> list[str]:
        """The constraints' names, by number."""
        return [c.name for c in self.system.constraints]

    @property
    def equations(self) -> int:
        """Bilateral scalar equations."""
        return sum(r.equations for r in self.reduced)

    @property
    def redundant_equations(self) -> int | None:
        """Equations less (coordinates - velocities), never below 0; None where the velocities are not known."""
        velocities = self.outcome.velocity_dof
        return None if velocities is None else max(0, self.equations - (len(self.system.coordinates) - velocities))

    @cached_property
    def dependence(self) -> Dependence:
        """What conflicts and what depends on what, in a share of the time."""
        nothing = undecided_dependence(i for i, r in enumerate(self.reduced) if r.normals)
        conflicting = Conflict([])
        with part(DEPENDENCE):
            if self.outcome.consistent is False:
                look = partial(conflict, self.system, self.reduced, self.setting, self.outcome)
                conflicting = unless_late(look, conflicting)
            dependent = unless_late(partial(redundancies, self.reduced, self.setting, self.outcome), [nothing])
        if self.redundant_equations == 0:
            dependent = all_needed(dependent, self.reduced, self.outcome)
        return Dependence(conflicting, dependent)

    @cached_property
    def company(self) -> Companionship:
        """The blocks, to be asked what a form integrates to together with which others."""
        parts = AnsweredParts(self.setting)
        parts.know(zip(self.outcome.blocks, self.outcome.answers, strict=True))
        return Companionship(parts)

    @cached_property
    def entries(self) -> list[ConstraintEntry]:
        """The constraints' entries, in order."""
        return self.entries_beside(self.dependence.dependent)

    def entries_beside(self, dependent: Sequence[Redundancies]) -> list[ConstraintEntry]:
        """The constraints' entries, where this is known of what depends on what."""
        return entries_of(self.reduced, self.setting, self.outcome, dependent, self.names, self.company)

    def by_name(self, labels: Sequence[bool | None]) -> Mapping[str, bool | None]:
        """A label for each constraint, by its name."""
        return dict(zip(self.names, labels, strict=True))


def study(
    system: System, engines: Engines = BOTH, reductions: Reductions = ALL, grows: bool = True, flag: bool = False
) -> Study:
    """The blocks of a system answered by some engines, with some reductions in use.

    ``grows``: the growth vector; ``flag``: the derived flag. Raises OutOfTimeError, and SceneError where a relation
    cannot be read over the reals.
    """
    reduced, setting = prepared(system, reductions)
    setting = replace(setting, engines=engines, grows=grows, flag=flag)
    return Study(system, reduced, setting, solve(system, reduced, setting))
