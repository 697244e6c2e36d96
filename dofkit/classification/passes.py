"""The passes, in their order, as a table: what fills which field of the report. Only this module orders them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from dofkit.base.deadline import DEFAULT_SECONDS, gc_rarely, limited, part, unless_late
from dofkit.base.verdicts import weakest
from dofkit.classification import report as fields
from dofkit.classification.agreements import agreed
from dofkit.classification.claims import claims, freedom
from dofkit.classification.counts import counts_beside
from dofkit.classification.feasibility.feasibility_fields import inequalities_together
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special import special_cases
from dofkit.classification.study import Study, study
from dofkit.exact.points.balls import precise_for
from dofkit.exact.zero import BOTH, Engines
from dofkit.mobility.kutzbach import without_drives
from dofkit.relations.reductions import ALL, Reductions
from dofkit.relations.setting import Setting
from dofkit.report import FieldVerdict, Mobility, Report
from dofkit.system import System

#: Of the time, for the blocks of a scene.
SOLVING = 0.75
NO_SPECIAL_CASES = "There was no time to look for special cases."

Values = Mapping[str, Any]
#: What fills fields: from what is known of the system, and what the passes before told.
Fill = Callable[[Study, Values], Values]


@dataclass(frozen=True)
class Pass:
    """One pass: the ``fields`` that it fills, the one function that does, and fields that it only ``adds`` to.

    An ``optional`` pass is left out where only the generic answer is asked for.
    """

    fields: str
    fill: Fill
    adds: str = ""
    optional: bool = False


def _scene(study: Study, told: Values) -> Values:
    del told
    return {"scene": study.system.name, "forces": fields.forces(study)}


def _conflicts(study: Study, told: Values) -> Values:
    del told
    names = study.names
    conflicting = [names[i] for i in study.dependence.conflicting.members]
    return {"consistent": study.outcome.consistent, "conflicting": conflicting}


def _freedom(study: Study, told: Values) -> Values:
    del told
    return {"dof": study.outcome.dof, "velocity_dof": study.outcome.velocity_dof}


def _first_order(study: Study, told: Values) -> Values:
    del told
    return {"instantaneous_dof": fields.instantaneous_dof(study), "singular": fields.singular(study)}


def _redundancy(study: Study, told: Values) -> Values:
    del told
    return {
        "redundant_equations": study.redundant_equations,
        "redundant": fields.redundant(study),
        "redundancies": fields.redundancies(study),
    }


def _entries(study: Study, told: Values) -> Values:
    del told
    entries = study.entries
    return {
        "constraints": entries,
        "holonomic": fields.of_all([e.holonomic for e in entries]),
        "scleronomic": fields.of_all([e.scleronomic for e in entries]),
    }


def _count(study: Study, told: Values) -> Values:
    del told
    return {"count": fields.lecture_count(study)}


def _choice(study: Study, told: Values) -> Values:
    del told
    return {
        "generalized_coordinates": fields.generalized_coordinates(study),
        "joint_coordinates": fields.joint_coordinates(study),
    }


def _growth(study: Study, told: Values) -> Values:
    return {"growth_vector": fields.growth_vector(study.outcome, told["constraints"])}


def _integrable(study: Study, told: Values) -> Values:
    del told
    return {"integrable_part": fields.largest_integrable_part(study)}


def _sureness(study: Study, told: Values) -> Values:
    """How sure it is: every field by itself, and the weakest of all."""
    found = claims(study, told)
    of_entries = {id(e.verdicts): e.verdicts for e in told["constraints"]}.values()
    entries = {v.verdict for verdicts in of_entries for v in verdicts.values()} | {
        e.verdict for e in told["constraints"]
    }
    weak = weakest(*(c.verdict for c in found.values()), *entries)
    return {"verdicts": {name: FieldVerdict.of(c) for name, c in found.items()}, "verdict": weak}


def _witness(study: Study, told: Values) -> Values:
    del told
    return {"witness": fields.witness(study)}


def _account(study: Study, told: Values) -> Values:
    """What ran."""
    del told
    return {
        "method": fields.method(study),
        "modelled": fields.modelled(study.system, study.outcome),
        "warnings": fields.warnings(study),
    }


def _feasibility(study: Study, told: Values) -> Values:
    return inequalities_together(study, told)


def _counts(study: Study, told: Values) -> Values:
    found, near = counts_beside(study, told["instantaneous_dof"])
    mobility, released = found["mobility"], without_drives(study.system)
    if isinstance(mobility, Mobility) and released is not None and told["consistent"] is True:
        nothing: Values = {}
        undriven = unless_late(partial(_velocity_freedom, study.setting.reductions, released), nothing)
        found = {**found, "mobility": mobility.model_copy(update=dict(undriven))}
    return {**found, **({} if near is None else {"warnings": [*told["warnings"], near]})}


def _special(study: Study, told: Values) -> Values:
    again = partial(_generic, study.setting.reductions)
    report = _report(told)
    look = partial(special_cases, study.system, study.reduced, study.setting, study.outcome, report, again)
    found: Values = unless_late(look, {"warnings": [*told["warnings"], NO_SPECIAL_CASES]})
    branches = [case.where for case in found.get("special_cases", ()) if case.kind == "branch"]
    warnings = [*found.get("warnings", told["warnings"]), *fields.about_branches(study.system, branches)]
    return {**found, "warnings": warnings}


def _velocity_freedom(reductions: Reductions, released: System) -> Values:
    """Return the velocity freedom of a system whose drives are released, with its verdict; nothing if undecided."""
    answered = study(released, reductions=reductions)
    number, verdict = answered.outcome.velocity_dof, freedom(answered).verdict
    return {} if number is None or verdict == "undecided" else {"undriven": number, "undriven_verdict": verdict}


PASSES: tuple[Pass, ...] = (
    Pass("scene forces", _scene),
    Pass("consistent conflicting", _conflicts),
    Pass("dof velocity_dof", _freedom),
    Pass("instantaneous_dof singular", _first_order),
    Pass("redundant_equations redundant redundancies", _redundancy),
    Pass("constraints holonomic scleronomic", _entries),
    Pass("count", _count),
    Pass("generalized_coordinates joint_coordinates", _choice),
    Pass("growth_vector", _growth),
    Pass("integrable_part", _integrable),
    Pass("verdict verdicts", _sureness),
    Pass("witness", _witness),
    Pass("method modelled warnings", _account),
    Pass("feasible infeasible feasible_at", _feasibility, adds="verdict verdicts witness warnings", optional=True),
    Pass("generic mobility", _counts, adds="warnings", optional=True),
    Pass("special_cases", _special, adds="method warnings", optional=True),
)
#: The generic answer.
GENERIC: tuple[Pass, ...] = tuple(row for row in PASSES if not row.optional)
#: All that needs no special cases.
PLAIN: tuple[Pass, ...] = tuple(row for row in PASSES if row.fields != "special_cases")


def report_of(study: Study, passes: Iterable[Pass] = PASSES) -> Report:
    """The report that some passes, in their order, fill."""
    told: dict[str, Any] = {}
    for row in passes:
        told.update(row.fill(study, told))
    return _report(agreed(told))


def _report(told: Values) -> Report:
    return Report(**{"special_cases": [], **told})


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
    passes: Iterable[Pass] = PASSES,
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
