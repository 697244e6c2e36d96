"""The passes that fill a report, in their order."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from dofkit.base.deadline import DEFAULT_SECONDS, gc_rarely, limited, part, unless_late
from dofkit.base.verdicts import Claim, weakest
from dofkit.classification import report as fields
from dofkit.classification.agreements import agreed
from dofkit.classification.claims import claims, freedom
from dofkit.classification.counts import counts_beside
from dofkit.classification.feasibility.feasibility import inequalities_together
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.reference_branches import all_of
from dofkit.classification.generalized_coordinates import generalized_coordinates
from dofkit.classification.special import special_cases
from dofkit.classification.study import Study, study
from dofkit.exact.points.balls import precise_for
from dofkit.exact.zero import BOTH, Engines
from dofkit.mobility.kutzbach import without_drives
from dofkit.relations.setting import ALL, Reductions, Setting
from dofkit.report import ConstraintEntry, FieldVerdict, Mobility, Report
from dofkit.system import System

#: Of the time, for the blocks of a scene.
SOLVING = 0.75
NO_SPECIAL_CASES = "There was no time to look for special cases."

Values = Mapping[str, Any]
#: What fills fields: from the study of a system, and the values of the passes before.
Fill = Callable[[Study, Values], Values]


def _generic_fields(study: Study, values: Values) -> Values:
    """Return the generic answer: every field that needs no second look at the scene, with the claim of each."""
    del values
    entries, outcome, dependence = study.entries, study.outcome, study.dependence
    answer: dict[str, Any] = {
        "scene": study.system.name,
        "forces": fields.forces(study),
        "consistent": outcome.consistent,
        "conflicting": [study.names[i] for i in dependence.conflicting.members],
        "dof": outcome.dof,
        "velocity_dof": outcome.velocity_dof,
        "instantaneous_dof": fields.instantaneous_dof(study),
        "singular": fields.singular(study),
        "redundant_equations": study.redundant_equations,
        "redundant": fields.redundant(study),
        "redundancies": fields.redundancies(study),
        "constraints": entries,
        "holonomic": all_of(e.holonomic for e in entries),
        "scleronomic": all_of(e.scleronomic for e in entries),
        "count": fields.lecture_count(study),
        "generalized_coordinates": generalized_coordinates(study),
        "joint_coordinates": fields.joint_coordinates(study),
        "growth_vector": fields.growth_vector(outcome, entries),
        "integrable_part": fields.largest_integrable_part(study),
        "witness": fields.witness(study),
        "method": fields.method(study),
        "modelled": fields.modelled(study.system, outcome),
        "warnings": fields.warnings(study),
        "special_cases": [],
    }
    return {**answer, **_verdicts(claims(study, answer), entries)}


def _verdicts(of_fields: Mapping[str, Claim], entries: Sequence[ConstraintEntry]) -> Values:
    """Return how certain every field is, and the weakest verdict of all, those of the entries included."""
    shared = {id(e.verdicts): e.verdicts for e in entries}.values()
    of_entries = {v.verdict for verdicts in shared for v in verdicts.values()} | {e.verdict for e in entries}
    weak = weakest(*(c.verdict for c in of_fields.values()), *of_entries)
    return {"verdicts": {name: FieldVerdict.of(c) for name, c in of_fields.items()}, "verdict": weak}


def _counts(study: Study, values: Values) -> Values:
    """Return the counts that stand beside the report's own, and a warning of a near-dependence."""
    counts, near = counts_beside(study, values["instantaneous_dof"])
    mobility, released = counts["mobility"], without_drives(study.system)
    if isinstance(mobility, Mobility) and released is not None and values["consistent"] is True:
        nothing: Values = {}
        undriven = unless_late(partial(_velocity_freedom, study.setting.reductions, released), nothing)
        counts = {**counts, "mobility": mobility.model_copy(update=dict(undriven))}
    return {**counts, **({} if near is None else {"warnings": [*values["warnings"], near]})}


def _special(study: Study, values: Values) -> Values:
    """Return the special cases, and a warning where only one of several branches has the report's freedom."""
    again = partial(_generic, study.setting.reductions)
    search = partial(special_cases, study.system, study.reduced, study.setting, study.outcome, Report(**values), again)
    late: Values = {"warnings": [*values["warnings"], NO_SPECIAL_CASES]}
    special = unless_late(search, late)
    branches = [case.where for case in special.get("special_cases", ()) if case.kind == "branch"]
    warnings = [*special.get("warnings", values["warnings"]), *fields.about_branches(study.system, branches)]
    return {**special, "warnings": warnings}


def _velocity_freedom(reductions: Reductions, released: System) -> Values:
    """Return the velocity freedom of a system whose drives are released, with its verdict; nothing if undecided."""
    answered = study(released, reductions=reductions)
    number, verdict = answered.outcome.velocity_dof, freedom(answered).verdict
    return {} if number is None or verdict == "undecided" else {"undriven": number, "undriven_verdict": verdict}


#: All passes, in their order: each fills fields of the report, or adds to those that the passes before it filled.
PASSES: tuple[Fill, ...] = (_generic_fields, inequalities_together, _counts, _special)
#: The generic answer, and all that needs no special cases.
GENERIC, PLAIN = PASSES[:1], PASSES[:-1]


def report_of(study: Study, passes: Sequence[Fill] = PASSES) -> Report:
    """Return the report that some passes fill, in their order."""
    values: dict[str, Any] = {}
    for fill in passes:
        values.update(fill(study, values))
    return Report(**agreed(values))


def _generic(reductions: Reductions, system: System) -> Report:
    """The generic answer for another system."""
    return report_of(study(system, reductions=reductions), GENERIC)


class Examined(NamedTuple):
    """A system as the engines see it, with what they found of it."""

    study: Study
    report: Report

    @property
    def system(self) -> System:
        """The system."""
        return self.study.system

    @property
    def setting(self) -> Setting:
        """What the engines may assume."""
        return self.study.setting

    @property
    def outcome(self) -> Outcome:
        """The blocks with their answers."""
        return self.study.outcome


def examined(
    system: System,
    seconds: float = DEFAULT_SECONDS,
    engines: Engines = BOTH,
    reductions: Reductions = ALL,
    passes: Sequence[Fill] = PASSES,
) -> Examined:
    """All that some engines find of a system in so many seconds, with some ``reductions``. Raises OutOfTimeError."""
    with limited(seconds), precise_for(system.longest), gc_rarely():
        with part(SOLVING):
            found = study(system, engines, reductions)
        return Examined(found, report_of(found, passes))


def studied(system: System, budget: float | None = None) -> Examined:
    """The generic answer for a system. Raises OutOfTimeError where there was no time for it."""
    with limited(DEFAULT_SECONDS if budget is None else budget), precise_for(system.longest):
        found = study(system)
        return Examined(found, report_of(found, GENERIC))
