"""The printed report: counts, constraints with labels and reasons, certainty, and how two reports differ."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from dofkit.base.wording import first_of, many, sentence, verb
from dofkit.interface.show.assurance import certainty, checked_claims, left_out, not_proved, reservation
from dofkit.interface.show.sheet import TONES, Column, Fact, Formula, Grid, Remark, Sheet, SheetSection, Tone
from dofkit.report import ConstraintEntry, Report, SpecialCase

#: The most constraints, reasons and other lines that a section lists; further ones are counted.
MOST_ROWS = 15
_MOST_NAMES = 24
_COLUMNS = (
    *(Column("name"), Column("text", 3), Column("form"), Column("labels", 2)),
    Column("independent equations", numbers=True),
)
#: Forms of constraints in textbook terms.
_FORMS = {"finite": "geometric", "pfaffian": "Pfaffian"}
#: A decimal with more than three significant digits.
_LONG_DECIMAL = re.compile(r"-?(?=(?:[.0]*[1-9])(?:\.?\d){3})\d*\.\d+(?:e-?\d+)?")
_OPPOSITES = {"holonomic": "non-holonomic", "scleronomic": "rheonomic", "bilateral": "unilateral"}


def sheet_of_report(report: Report, title: str | None = None, how: bool = False) -> Sheet:
    """Return the sheet of a report. ``how``: with the argument for each answer."""
    return Sheet(
        name=report.scene,
        title=title or "",
        alarm=_alarm(report),
        facts=tuple(_facts(report)),
        sections=tuple(section for section in _sections(report, how) if section.content),
    )


def sheet_of_entry(entry: ConstraintEntry) -> Sheet:
    """Return the sheet of one constraint."""
    facts = [
        Fact("form", _FORMS.get(entry.form, entry.form)),
        Fact("labels", labels(entry)),
        Fact("independent equations", _equations(entry)),
        *(Fact("integral", Formula(str(r.text)), r.note) for r in _integrals([entry])),
        Fact("verdict", entry.verdict, tone=TONES[entry.verdict]),
        Fact("why", entry.reason),
    ]
    return Sheet(entry.name, Formula(entry.text), facts=facts)


def _sections(report: Report, how: bool) -> Iterator[SheetSection]:
    entries = report.constraints
    if entries:
        listed = entries[:MOST_ROWS]
        rows = [
            (e.name, Formula(e.text), _FORMS.get(e.form, e.form), labels(e).removesuffix(", bilateral"), _equations(e))
            for e in listed
        ]
        yield SheetSection("Constraints", [Grid(_COLUMNS, rows)], _more(len(entries)))
    reasons = _reasons(entries)
    yield _listed("Why", reasons)
    yield _listed("Integrals", _integrals(entries))
    yield _listed("Special cases", [_special(case) for case in report.special_cases])
    yield _listed("Redundancy", list(_redundancy(report)))
    yield _listed("Forces", [Remark(force.name, force.reason) for force in report.forces])
    yield _listed("Warnings", [Remark("!", sentence(warning)) for warning in report.warnings])
    yield _listed("Checked", checked_claims(report))
    if how:
        yield SheetSection("How", certainty(report))
        yield SheetSection("Not proved", not_proved(report))


def _listed(heading: str, remarks: Sequence[Remark]) -> SheetSection:
    """Return a section with the first remarks, and the number of further ones."""
    return SheetSection(heading, remarks[:MOST_ROWS], _more(len(remarks)))


def _more(number: int) -> str:
    return f"... and {number - MOST_ROWS} more (--json lists all)" if number > MOST_ROWS else ""


def _alarm(report: Report) -> tuple[str, Tone] | None:
    if report.consistent is None:
        return "It is undecided whether the constraints are consistent.", "care"
    if report.consistent is False:
        names = names_of(report.conflicting) or "the constraints"
        return f"Inconsistent: no motion satisfies all of {names}.", "bad"
    return None


def _facts(report: Report) -> Iterator[Fact]:
    """Yield the lines at the top of a report: counts, freedom, labels, coordinates and verdict."""
    if report.consistent is not False:
        yield _count(report)
        if report.count.errs:
            yield Fact("why the count is off", report.count.errs, tone="care")
    yield from _numbers(report)
    yield from _other_counts(report)
    yield Fact("system", system_labels(report, _non_holonomic(report)))
    yield from _inequalities(report)
    if report.generalized_coordinates:
        yield Fact("generalized coordinates", f"{names_of(report.generalized_coordinates)}  (a local chart)")
    if report.joint_coordinates:
        yield Fact("joint coordinates", names_of(report.joint_coordinates))
    if report.growth_vector:
        timed = report.velocity_dof is not None and report.growth_vector[0] > report.velocity_dof
        dimensions = f"({', '.join(map(str, report.growth_vector))})"
        yield Fact("growth vector", dimensions, "in (q, t): time is counted" if timed else "")
    part = report.integrable_part
    if part is not None and part.rank and part.basis:
        yield Fact("integrable part", f"{', '.join(part.basis)}  (in addition to the geometric equations)")
    if model_lacks := left_out(report):
        yield Fact("not modelled", model_lacks, tone="care")
    yield Fact("verdict", report.verdict, reservation(report), TONES[report.verdict])


def _count(report: Report) -> Fact:
    count = report.count
    counts = [(count.particles, "particle"), (count.bodies, "body"), (count.coordinates, "coordinate")]
    counted = [many(number, what) for number, what in counts if number]
    counted.append(many(count.constraints, "geometric equation"))
    return Fact("constraint count", count.formula, f"({', '.join(counted)})")


def _numbers(report: Report) -> Iterator[Fact]:
    if report.consistent is not False:
        branch = "".join(f" on the branch {c.where}" for c in report.special_cases if c.kind == "branch")
        yield Fact("degrees of freedom", number(report.dof), f"dimension of the configuration space{branch}")
        yield Fact("velocity freedom", number(report.velocity_dof), "independent admissible velocities")
    if report.singular is not None:
        singular = "exceeds the finite freedom: singular configuration"
        compared = singular if report.singular else "equal to the finite freedom"
        note = f"at the reference configuration; {compared}"
        yield Fact("instantaneous freedom", number(report.instantaneous_dof), note)
    if report.redundant_equations:
        few = report.redundant_equations
        yield Fact("redundant equations", str(few), f"{verb(few, 'depends', 'depend')} on the other scalar equations")


def _other_counts(report: Report) -> Iterator[Fact]:
    """Yield the Gruebler-Kutzbach count and the generic mobility, if they differ from the report's numbers."""
    mobility, generic = report.mobility, report.generic
    if mobility is not None and mobility.undriven is not None and mobility.freedom is not None:
        sure = "" if mobility.undriven_verdict == "proved" else f" [{mobility.undriven_verdict}]"
        yield Fact("mobility", number(mobility.undriven), _driven(mobility.undriven, mobility.freedom) + sure)
    if mobility is not None and (mobility.differs or mobility.kutzbach != report.count.naive_dof):
        yield Fact("Gruebler-Kutzbach", mobility.formula)
        if mobility.differs:
            yield Fact("why it is off", mobility.differs, tone="care")
    if generic is not None and generic.differs and generic.dof is not None:
        yield Fact("generic mobility", number(generic.dof), generic.differs)


def _driven(undriven: int, freedom: int) -> str:
    """Return in words how many degrees of freedom are driven, and how many remain free."""
    driven = undriven - freedom
    remaining = "it moves as driven" if not freedom else f"{freedom} {verb(freedom)} left free"
    return f"of which {driven} {verb(driven)} driven: {remaining}"


def _inequalities(report: Report) -> Iterator[Fact]:
    """Yield whether the inequalities are consistent with the constraints, if there are any."""
    if report.consistent is False or all(e.bilateral for e in report.constraints):
        return
    point = ", ".join(f"{name} = {_short(value)}" for name, value in (report.feasible_at or {}).items())
    if report.feasible:
        yield Fact("inequalities", f"consistent, for example near {point}" if point else "consistent")
    elif report.feasible is False:
        names = names_of(report.infeasible)
        yield Fact("inequalities", f"inconsistent: no motion satisfies all of {names}", tone="bad")
    else:
        yield Fact("inequalities", "undecided whether they are consistent", tone="care")


def _short(value: str) -> str:
    """Return a coordinate of a witness; a long decimal is rounded to three significant digits."""
    return f"{float(value):.3g}" if _LONG_DECIMAL.fullmatch(value) else value


def system_labels(report: Report, reason: str = "") -> str:
    """Return the labels of the system; ``reason`` (why it is not holonomic) follows the first label."""
    return f"{_label(report.holonomic, 'holonomic')}{reason}, {_label(report.scleronomic, 'scleronomic')}"


def _non_holonomic(report: Report) -> str:
    """Return in parentheses which constraint, or which inequalities, alone make the system non-holonomic, or ""."""
    responsible = [entry for entry in report.constraints if entry.holonomic is False]
    inequalities = bool(responsible) and all(entry.form == "inequality" for entry in responsible)
    alone = inequalities or len(responsible) == 1 < len(report.constraints)
    return f" (by {names_of([e.name for e in responsible])})" if alone and report.holonomic is False else ""


def _label(value: bool | None, word: str) -> str:
    return f"{word}?" if value is None else word if value else _OPPOSITES[word]


def labels(entry: ConstraintEntry) -> str:
    """Return the labels of a constraint with commas: holonomic, scleronomic, acatastatic, bilateral."""
    alone = ""
    if entry.holonomic != entry.holonomic_alone and entry.holonomic_alone is not None:
        alone = f" (on its own: {_label(entry.holonomic_alone, 'holonomic')})"
    words = [_label(entry.holonomic, "holonomic") + alone, _label(entry.scleronomic, "scleronomic")]
    acatastatic = ["acatastatic"] if entry.catastatic is False else []
    return ", ".join([*words, *acatastatic, _label(entry.bilateral, "bilateral")])


def _equations(entry: ConstraintEntry) -> str:
    if entry.independent is None or entry.independent == entry.equations:
        return str(entry.equations)
    return f"{entry.independent} of {entry.equations}"


def _reasons(entries: Sequence[ConstraintEntry]) -> list[Remark]:
    by_reason: dict[tuple[str, str], list[str]] = {}
    for entry in entries:
        by_reason.setdefault((entry.reason, entry.verdict), []).append(entry.name)
    return [
        Remark(
            names_of(names),
            (f"Each {reason[3:]}" if len(names) > 1 and reason.startswith("It ") else reason)
            + ("" if verdict == "proved" else f" [{verdict}]"),
        )
        for (reason, verdict), names in by_reason.items()
    ]


def _integrals(entries: Iterable[ConstraintEntry]) -> list[Remark]:
    remarks: list[Remark] = []
    for entry in entries:
        if entry.integral is None:
            continue
        note = "exact as written" if entry.exact else ""
        if not note and entry.integrating_factor:
            note = f"integrating factor {entry.integrating_factor}"
        remarks.append(Remark(entry.name, Formula(entry.integral), note))
    return remarks


def _special(case: SpecialCase) -> Remark:
    verdict = "" if case.verdict == "proved" else f" [{case.verdict}]"
    names = [name for name in case.constraints if not re.search(rf"(?<!\w){re.escape(name)}(?!\w)", case.what)]
    concerned = f" ({names_of(names)})" if names else ""
    return Remark(Formula(case.where), f"{case.what}{concerned}{verdict}")


def _redundancy(report: Report) -> Iterator[Remark]:
    """Yield remarks on redundancy; ``circuit``: constraints that imply an entry ([]: always true, None: none do)."""
    if report.redundant:
        note = "these may be removed together without changing the motion"
        yield Remark("maximal redundant set", names_of(report.redundant), note)
    for group in report.redundancies:
        members = names_of(group.members)
        yield Remark("", f"Overconstrained by {group.nullity}: the equations of {members} are dependent.")
    for entry in report.constraints:
        if entry.circuit:
            yield Remark(entry.name, f"implied by {names_of(entry.circuit)}")
        elif entry.circuit is not None:
            yield Remark(entry.name, "imposes no condition: every configuration satisfies it")


def names_of(names: Sequence[str]) -> str:
    """Return names with commas; of more than `_MOST_NAMES` the first."""
    return first_of(names, _MOST_NAMES)


def number(value: int | None) -> str:
    """Return a number as text, or a dash if it is not known."""
    return "-" if value is None else str(value)


#: Printed if a dropped constraint changes no number; the motion may still differ, if it was an inequality.
SAME = "no degree of freedom, no count and no label changes"
#: (name in words, field) of the numbers that are compared.
_NUMBERS = (
    ("degrees of freedom", "dof"),
    ("velocity freedom", "velocity_dof"),
    ("instantaneous freedom", "instantaneous_dof"),
    ("redundant equations", "redundant_equations"),
)


def changed(before: Report, after: Report, names: Sequence[str]) -> SheetSection:
    """Return the section of what changes when the constraints of these names are dropped."""
    remarks = [*_changes(before, after), *_undecided(before, after)]
    return SheetSection(f"Without {names_of(names)}", remarks or [Remark("", SAME)])


def _undecided(before: Report, after: Report) -> Iterator[Remark]:
    """Yield a remark that names the fields that are undecided before or after, and so cannot be compared."""
    unsure = [
        label
        for label, name in (*_NUMBERS, ("consistent", "consistent"))
        if any((entry := report.verdicts.get(name)) and entry.verdict == "undecided" for report in (before, after))
    ]
    if unsure:
        yield Remark("undecided", f"it is undecided whether these change: {', '.join(unsure)}")


def _changes(before: Report, after: Report) -> Iterator[Remark]:
    """Yield a remark for each number and label that differs between two reports."""
    for label, name in _NUMBERS:
        was, now = getattr(before, name), getattr(after, name)
        if was != now:
            yield Remark(label, f"{number(was)} -> {number(now)}")
    if before.consistent != after.consistent:
        yield Remark("consistent", f"{_yes(before.consistent)} -> {_yes(after.consistent)}")
    if system_labels(before) != system_labels(after):
        yield Remark("system", f"{system_labels(before)} -> {system_labels(after)}")
    kept = {e.name: e for e in after.constraints}
    for entry in before.constraints:
        now_entry = kept.get(entry.name)
        if now_entry is not None and entry.holonomic != now_entry.holonomic:
            old, new = _label(entry.holonomic, "holonomic"), _label(now_entry.holonomic, "holonomic")
            yield Remark(entry.name, f"{old} -> {new}")


def _yes(value: bool | None) -> str:
    return {True: "yes", False: "no", None: "undecided"}[value]


def unexpected(missed: Sequence[str]) -> list[SheetSection]:
    """Return the section of the fields that differ from what the scene expects; empty if there are none."""
    remarks = [Remark("!", line) for line in missed]
    return [SheetSection("Differs from what the scene expects", remarks)] if missed else []
