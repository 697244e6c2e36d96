"""Reports in which everything is undecided, for scenes for which time has run out."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.verdicts import OPEN
from dofkit.classification.freedom.preparation import RATES
from dofkit.expressions.calculus import diff
from dofkit.mobility.counts import CountedFacts, count
from dofkit.report import FORMS, ConstraintEntry, Count, FieldVerdict, ForceEntry, Form, Report
from dofkit.system import Constraint, Relation, System


def sketch(system: System, why: str) -> Report:
    """Return a report with names, texts, forms as written and the textbook count only; ``why`` is the reason."""
    entries = [open_entry(c, why) for c in system.constraints]
    written = sum(e.equations for e in entries if e.form == "finite")
    answer = count(system, CountedFacts(written, None, None, 0, entries))
    forces = [ForceEntry(name=f.name, reason=f.reason) for f in system.forces]
    return open_report(system.name, answer, entries, forces, [*system.warnings, why_nothing(why)])


def undecided(report: Report, why: str) -> Report:
    """Return a report of `sketch` with another reason."""
    entries = [e.model_copy(update={"reason": f"Not decided: {why}."}) for e in report.constraints]
    return report.model_copy(update={"constraints": entries, "warnings": [*report.warnings[:-1], why_nothing(why)]})


def why_nothing(why: str) -> str:
    """Return the warning that nothing was decided."""
    return f"Nothing was decided: {why}."


def open_entry(constraint: Constraint, why: str) -> ConstraintEntry:
    """Return the entry of a constraint of which only the form as written is known."""
    form: Form = max((_form(r) for r in constraint.relations), key=FORMS.index, default="finite")
    return ConstraintEntry(
        name=constraint.name,
        type=constraint.type,
        text=constraint.text,
        form=form,
        bilateral=all(r.sense == "=" for r in constraint.relations),
        equations=sum(r.sense == "=" for r in constraint.relations),
        verdict="undecided",
        verdicts={name: FieldVerdict.of(OPEN) for name in ("holonomic", "holonomic_alone", "scleronomic")},
        reason=f"Not decided: {why}.",
    )


def _form(relation: Relation) -> Form:
    """Return the form of a relation as written; over the reals it may be simpler."""
    if relation.sense != "=":
        return "inequality"
    moving = frozenset(s for s in relation.expr.symbols if s.args[0] in RATES)
    linear = all(moving.isdisjoint(diff(relation.expr, s).symbols) for s in moving)
    return "finite" if not moving else "pfaffian" if linear else "nonlinear"


def open_report(
    name: str,
    lecture_count: Count,
    entries: Sequence[ConstraintEntry],
    forces: Sequence[ForceEntry],
    warnings: Sequence[str],
) -> Report:
    """Return a report in which only names and the count are known."""
    return Report(
        scene=name,
        count=lecture_count,
        constraints=list(entries),
        forces=list(forces),
        verdict="undecided",
        verdicts={name: FieldVerdict.of(OPEN) for name in ("consistent", "dof", "velocity_dof", "holonomic")},
        method="none",
        modelled="nothing: there was no time",
        warnings=list(warnings),
    )
