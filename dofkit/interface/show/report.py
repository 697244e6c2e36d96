"""What is told of a report, in a reader's words: the counts, the constraints, why, and how sure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from dofkit.base.wording import many, verb
from dofkit.interface.show.assurance import LEFT_OUT, how_sure, not_proved, verdicts_of
from dofkit.interface.show.sheet import TONES, Column, Fact, Formula, Grid, Remark, Sheet, SheetSection, Tone
from dofkit.report import ConstraintEntry, Report, SpecialCase

#: More constraints than this are counted, not listed.
MOST_ROWS = 60
_MOST_NAMES = 40
_COLUMNS = (Column("name"), Column("text", 3), Column("form"), Column("labels", 2), Column("eq.", numbers=True))
_OPPOSITES = {"holonomic": "non-holonomic", "scleronomic": "rheonomic", "bilateral": "unilateral"}


def sheet_of_report(report: Report, title: str | None = None, how: bool = False) -> Sheet:
    """The whole report. ``how``: by which arguments too; without it only where something is not proved."""
    return Sheet(
        name=report.scene,
        title=title or "",
        alarm=_alarm(report),
        facts=tuple(_facts(report)),
        sections=tuple(section for section in _sections(report, how) if section.parts),
    )


def sheet_of_entry(entry: ConstraintEntry) -> Sheet:
    """One constraint by itself."""
    facts = [
        Fact("form", entry.form),
        Fact("labels", labels(entry)),
        Fact("equations", _equations(entry)),
        *(Fact("integral", Formula(str(r.text)), r.note) for r in _integrals([entry])),
        Fact("verdict", entry.verdict, tone=TONES[entry.verdict]),
        Fact("why", entry.reason),
    ]
    return Sheet(entry.name, Formula(entry.text), facts=facts)


def _sections(report: Report, how: bool) -> Iterator[SheetSection]:
    entries = report.constraints
    if entries:
        rows = [(e.name, Formula(e.text), e.form, labels(e), _equations(e)) for e in entries[:MOST_ROWS]]
        yield SheetSection("Constraints", [Grid(_COLUMNS, rows)], _more(len(entries)))
    reasons = _reasons(entries)
    yield SheetSection("Why", reasons[:MOST_ROWS], _more(len(reasons)))
    yield SheetSection("Integrals", _integrals(entries)[:MOST_ROWS])
    yield SheetSection("Special cases", [_special(case) for case in report.special_cases])
    yield SheetSection("Redundancy", list(_redundancy(report)))
    yield SheetSection("Forces", [Remark(force.name, force.reason) for force in report.forces])
    yield SheetSection("Warnings", [Remark("!", warning) for warning in report.warnings])
    if how or verdicts_of(report) != {"proved"} or LEFT_OUT in report.modelled:
        yield SheetSection("How", how_sure(report, how))
    yield SheetSection("Not proved", not_proved(report))


def _more(number: int) -> str:
    return f"... and {number - MOST_ROWS} more: --json has them all" if number > MOST_ROWS else ""


def _alarm(report: Report) -> tuple[str, Tone] | None:
    if report.consistent is None:
        return "It is undecided whether these constraints can all hold at once.", "care"
    if report.consistent is False:
        names = names_of(report.conflicting) or "the constraints"
        return f"Inconsistent: no motion satisfies all of {names}.", "bad"
    return None


def _facts(report: Report) -> Iterator[Fact]:
    yield _count(report)
    if report.count.errs:
        yield Fact("where it errs", report.count.errs, tone="care")
    yield from _numbers(report)
    yield from _beside(report)
    yield Fact("the system", system_labels(report))
    yield from _inequalities(report)
    if report.generalized_coordinates:
        yield Fact("coordinates", f"{names_of(report.generalized_coordinates)} (independent, and enough)")
    if report.joint_coordinates:
        yield Fact("joints", f"{names_of(report.joint_coordinates)} (they describe the tree)")
    if report.growth_vector:
        yield Fact("growth vector", f"({', '.join(map(str, report.growth_vector))})")
    part = report.integrable_part
    if part is not None and part.rank and part.basis:
        yield Fact("integrable part", f"{', '.join(part.basis)} (and what is finite as written)")
    yield Fact("verdict", report.verdict, tone=TONES[report.verdict])


def _count(report: Report) -> Fact:
    count = report.count
    given = [(count.particles, "particle"), (count.bodies, "body"), (count.coordinates, "coordinate")]
    said = [many(number, what) for number, what in given if number]
    return Fact("the count", count.formula, f"({', '.join([*said, many(count.constraints, 'finite equation')])})")


def _numbers(report: Report) -> Iterator[Fact]:
    if report.consistent is not False:
        yield Fact("degrees of freedom", number(report.dof), "dimension of the configuration space")
        yield Fact("velocities", number(report.velocity_dof), "independent velocities of finite motions")
    if report.singular is not None:
        special = "more than can move: this place is singular" if report.singular else "as many as can move"
        yield Fact("to first order", number(report.instantaneous_dof), f"velocities allowed at the drawing, {special}")
    if report.redundant_equations:
        few = report.redundant_equations
        yield Fact("redundant", str(few), f"of the scalar equations {verb(few, 'adds', 'add')} nothing")


def _beside(report: Report) -> Iterator[Fact]:
    """The counts beside the report's own, where they tell something else."""
    mobility, generic = report.mobility, report.generic
    if mobility is not None and (mobility.differs or mobility.kutzbach != report.count.naive_dof):
        yield Fact("Gruebler-Kutzbach", mobility.formula)
        if mobility.differs:
            yield Fact("where it errs", mobility.differs, tone="care")
    if generic is not None and generic.differs:
        yield Fact("generic", number(generic.dof), f"degrees of freedom in general position; {generic.differs}")


def _inequalities(report: Report) -> Iterator[Fact]:
    """Whether they can all be met, where there are some."""
    if report.consistent is False or all(e.bilateral for e in report.constraints):
        return
    at = ", ".join(f"{name} = {value}" for name, value in (report.feasible_at or {}).items())
    if report.feasible:
        yield Fact("inequalities", f"can all be met, as at {at}" if at else "can all be met")
    elif report.feasible is False:
        told = f"cannot all be met: no motion satisfies all of {names_of(report.infeasible)}"
        yield Fact("inequalities", told, tone="bad")
    else:
        yield Fact("inequalities", "undecided whether they can all be met", tone="care")


def system_labels(report: Report) -> str:
    """The labels of the whole system in words."""
    return f"{_label(report.holonomic, 'holonomic')}, {_label(report.scleronomic, 'scleronomic')}"


def _label(value: bool | None, word: str) -> str:
    return f"{word}?" if value is None else word if value else _OPPOSITES[word]


def labels(entry: ConstraintEntry) -> str:
    """A constraint's labels in words."""
    alone = ""
    if entry.holonomic != entry.holonomic_alone and entry.holonomic_alone is not None:
        alone = f" (alone: {_label(entry.holonomic_alone, 'holonomic')})"
    words = [_label(entry.holonomic, "holonomic") + alone, _label(entry.scleronomic, "scleronomic")]
    return ", ".join([*words, _label(entry.bilateral, "bilateral")])


def _equations(entry: ConstraintEntry) -> str:
    if entry.independent is None or entry.independent == entry.equations:
        return str(entry.equations)
    return f"{entry.independent} of {entry.equations}"


def _reasons(entries: Sequence[ConstraintEntry]) -> list[Remark]:
    by_reason: dict[tuple[str, str], list[str]] = {}
    for entry in entries:
        by_reason.setdefault((entry.reason, entry.verdict), []).append(entry.name)
    return [
        Remark(names_of(names), reason if verdict == "proved" else f"{reason} [{verdict}]")
        for (reason, verdict), names in by_reason.items()
    ]


def _integrals(entries: Iterable[ConstraintEntry]) -> list[Remark]:
    found: list[Remark] = []
    for entry in entries:
        if entry.integral is None:
            continue
        how = "exact as written" if entry.exact else ""
        if not how and entry.integrating_factor:
            how = f"by the factor {entry.integrating_factor}"
        found.append(Remark(entry.name, Formula(entry.integral), how))
    return found


def _special(case: SpecialCase) -> Remark:
    sure = "" if case.verdict == "proved" else f" [{case.verdict}]"
    return Remark(Formula(case.where), f"{case.what} ({names_of(case.constraints)}){sure}")


def _redundancy(report: Report) -> Iterator[Remark]:
    if report.redundant:
        yield Remark("can be dropped together", names_of(report.redundant))
    for group in report.redundancies:
        yield Remark(f"{many(group.nullity, 'equation')} too many among", names_of(group.members))
    for entry in [entry for entry in report.constraints if entry.circuit is not None][:MOST_ROWS]:
        on = names_of(entry.circuit or [])
        yield Remark(entry.name, f"follows from {on}" if on else "says nothing: it always holds")


def names_of(names: Sequence[str]) -> str:
    """Names with commas; the first of very many."""
    shown = ", ".join(names[:_MOST_NAMES])
    return f"{shown} and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else shown


def number(value: int | None) -> str:
    """A number, or a dash for what is not known."""
    return "-" if value is None else str(value)
