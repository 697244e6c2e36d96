"""A report for a person at a terminal: what it says, why, and how sure it is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from dofkit.interface.show.faults import safe
from dofkit.report import ConstraintEntry, FieldVerdict, Report, SpecialCase

#: More constraints than this are counted, not listed.
MOST_ROWS = 60
_MOST_NAMES = 40

_VERDICT_MEANS = {
    "proved": "follows by exact arithmetic that leaves no doubt",
    "probable": "exact arithmetic at random points; the chance of an error is bounded and tiny",
    "numeric": "measured or rounded numbers, told apart by a gap that is stated",
    "undecided": "not settled; the reason says why",
}
_STYLES = {"proved": "green", "probable": "green", "numeric": "yellow", "undecided": "red"}


def rendered(report: Report, title: str | None = None) -> RenderableType:
    """The whole report."""
    return Group(*_parts(report, title))


def as_text(report: Report, title: str | None, console: Console) -> str:
    """The whole report as lines for ``console``, without blanks at their ends."""
    with console.capture() as captured:
        console.print(rendered(report, title))
    return "\n".join(line.rstrip() for line in captured.get().splitlines())


def _parts(report: Report, title: str | None) -> Iterator[RenderableType]:
    headline = Text(safe(report.scene), "bold")
    if title:
        headline.append(f"  {safe(title)}", "not bold")
    yield headline
    yield _facts(report)
    if report.constraints:
        yield from _section("Constraints", [_constraints(report.constraints)])
        yield from _section("Why", _reasons(report.constraints))
    yield from _section("Integrals", _integrals(report.constraints))
    yield from _section("Special cases", _special(report.special_cases))
    yield from _section("Redundancy", _redundancy(report))
    yield from _section("Forces", [_item(force.name, force.reason) for force in report.forces])
    yield from _section("Warnings", [_item("!", warning) for warning in report.warnings])
    told = [_item(name, text) for name, text in (("model", report.modelled), ("method", report.method)) if text]
    yield from _section("How", [*told, *_verdicts(report)])
    yield from _section("Not proved", _weaker(report))


def _facts(report: Report) -> RenderableType:
    grid = Table.grid(padding=(0, 2))
    grid.add_column(style="dim", no_wrap=True)
    grid.add_column(ratio=1)
    for label, text in _rows(report):
        grid.add_row(label, text)
    return Padding(Group(*_consistency(report), grid), (0, 0, 0, 2))


def _consistency(report: Report) -> Iterator[Text]:
    if report.consistent is None:
        yield Text("It is undecided whether these constraints can all hold at once.", "yellow")
    if report.consistent is False:
        names = _names(report.conflicting) or "the constraints"
        yield Text(f"Inconsistent: no motion satisfies all of {names}.", "bold red")


def _rows(report: Report) -> Iterator[tuple[str, Text]]:
    yield "the count", _count_text(report)
    if report.count.errs:
        yield "where it errs", Text(safe(report.count.errs), "yellow")
    for label, number, means in _numbers(report):
        yield label, Text.assemble((number, "bold"), f"  {means}")
    yield from _beside(report)
    words = [_label(report.holonomic, "holonomic"), _label(report.scleronomic, "scleronomic")]
    yield "the system", Text(", ".join(words))
    yield from _inequalities(report)
    if report.generalized_coordinates:
        yield "coordinates", Text(f"{_names(report.generalized_coordinates)} (independent, and enough)")
    if report.growth_vector:
        yield "growth vector", Text(f"({', '.join(map(str, report.growth_vector))})")
    part = report.integrable_part
    if part is not None and part.rank and part.basis:
        yield "integrable part", Text(f"{safe(', '.join(part.basis))} (and what is finite as written)")
    yield "verdict", Text(report.verdict, _STYLES[report.verdict])


def _inequalities(report: Report) -> Iterator[tuple[str, Text]]:
    """Whether they can all be met, where there are some."""
    if report.consistent is False or all(e.bilateral for e in report.constraints):
        return
    at = ", ".join(f"{name} = {value}" for name, value in (report.feasible_at or {}).items())
    told = {
        True: Text(safe(f"can all be met, as at {at}" if at else "can all be met")),
        False: Text(f"cannot all be met: no motion satisfies all of {_names(report.infeasible)}", "bold red"),
        None: Text("undecided whether they can all be met", "yellow"),
    }
    yield "inequalities", told[report.feasible]


def _beside(report: Report) -> Iterator[tuple[str, Text]]:
    """The counts beside the report's own, where they tell something else."""
    mobility, generic = report.mobility, report.generic
    if mobility is not None and (mobility.differs or mobility.kutzbach != report.count.naive_dof):
        yield "Gruebler-Kutzbach", Text(safe(mobility.formula), "bold")
        if mobility.differs:
            yield "where it errs", Text(safe(mobility.differs), "yellow")
    if generic is not None and generic.differs:
        means = f"  degrees of freedom in general position; {safe(generic.differs)}"
        yield "generic", Text.assemble((_number(generic.dof), "bold"), means)


def _count_text(report: Report) -> Text:
    count = report.count
    given = [(count.particles, "particle"), (count.bodies, "body"), (count.coordinates, "coordinate")]
    said = [_many(number, what) for number, what in given if number]
    said.append(_many(count.constraints, "finite equation"))
    return Text.assemble((safe(count.formula), "bold"), (f"  ({', '.join(said)})", "dim"))


def _numbers(report: Report) -> Iterator[tuple[str, str, str]]:
    if report.consistent is not False:
        yield "degrees of freedom", _number(report.dof), "dimension of the configuration space"
        yield "velocities", _number(report.velocity_dof), "independent velocities of finite motions"
    if report.singular is not None:
        special = "more than can move: this place is singular" if report.singular else "as many as can move"
        yield "to first order", _number(report.instantaneous_dof), f"velocities allowed at the drawing, {special}"
    if report.redundant_equations:
        yield "redundant", str(report.redundant_equations), "of the scalar equations add nothing"


_OPPOSITES = {"holonomic": "non-holonomic", "scleronomic": "rheonomic", "bilateral": "unilateral"}


def _label(value: bool | None, word: str) -> str:
    return f"{word}?" if value is None else word if value else _OPPOSITES[word]


def _constraints(entries: Sequence[ConstraintEntry]) -> RenderableType:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", show_edge=False)
    table.add_column("name", overflow="fold")
    table.add_column("text", overflow="fold", ratio=3)
    table.add_column("form", no_wrap=True)
    table.add_column("labels", ratio=2)
    table.add_column("eq.", justify="right", no_wrap=True)
    for entry in entries[:MOST_ROWS]:
        cells = (safe(entry.text), entry.form, labels(entry), _equations(entry))
        table.add_row(Text(safe(entry.name), "bold"), *map(Text, cells))
    more = len(entries) - MOST_ROWS
    return Group(table, Text(f"... and {more} more: --json has them all", "dim")) if more > 0 else table


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


def _reasons(entries: Sequence[ConstraintEntry]) -> list[RenderableType]:
    by_reason: dict[tuple[str, str], list[str]] = {}
    for entry in entries:
        by_reason.setdefault((entry.reason, entry.verdict), []).append(entry.name)
    told: list[RenderableType] = [
        _item(_names(names), reason if verdict == "proved" else f"{reason} [{verdict}]")
        for (reason, verdict), names in list(by_reason.items())[:MOST_ROWS]
    ]
    more = len(by_reason) - MOST_ROWS
    return [*told, Text(f"... and {more} more: --json has them all", "dim")] if more > 0 else told


def _integrals(entries: Iterable[ConstraintEntry]) -> list[RenderableType]:
    found: list[RenderableType] = []
    for entry in entries:
        if entry.integral is None:
            continue
        how = "exact as written" if entry.exact else ""
        if not how and entry.integrating_factor:
            how = f"by the factor {entry.integrating_factor}"
        found.append(_item(entry.name, entry.integral + (f"   ({how})" if how else "")))
    return found[:MOST_ROWS]


def _special(cases: Sequence[SpecialCase]) -> list[RenderableType]:
    told: list[RenderableType] = []
    for case in cases:
        sure = "" if case.verdict == "proved" else f" [{case.verdict}]"
        told.append(_item(case.where, f"{case.what} ({_names(case.constraints)}){sure}"))
    return told


def _redundancy(report: Report) -> list[RenderableType]:
    told: list[RenderableType] = []
    if report.redundant:
        told.append(_item("can be dropped together", _names(report.redundant)))
    for group in report.redundancies:
        told.append(_item(f"{_many(group.nullity, 'equation')} too many among", _names(group.members)))
    for entry in [entry for entry in report.constraints if entry.circuit is not None][:MOST_ROWS]:
        on = _names(entry.circuit or [])
        told.append(_item(entry.name, f"follows from {on}" if on else "says nothing: it always holds"))
    return told


def _weaker(report: Report) -> list[RenderableType]:
    """What is not proved, in one line each."""
    weaker = ((name, found) for name, found in report.verdicts.items() if found.verdict != "proved")
    return [_item(name, f"{found.verdict}{_because(found)}") for name, found in weaker]


def _because(found: FieldVerdict) -> str:
    """The argument, and the chance of an error or the gap."""
    if found.verdict == "undecided":
        return ""
    means = f"wrong with a chance below {found.bound}" if found.verdict == "probable" else f"by a gap of {found.bound}"
    where = (
        "" if found.about == "everywhere" else f", near the {'witness' if found.about == 'component' else found.about}"
    )
    return f" ({found.argument}; {means}{where})"


def _verdicts(report: Report) -> list[RenderableType]:
    used = {report.verdict, *(e.verdict for e in report.constraints), *(case.verdict for case in report.special_cases)}
    return [_item(verdict, meaning) for verdict, meaning in _VERDICT_MEANS.items() if verdict in used]


def _section(heading: str, parts: Sequence[RenderableType]) -> Iterator[RenderableType]:
    if parts:
        yield Text(heading, "bold cyan")
        yield Padding(Group(*parts), (0, 0, 0, 2))


def _item(label: str, text: str) -> Text:
    return Text.assemble((safe(label), "bold"), f": {safe(text)}" if label != "!" else f" {safe(text)}")


def _names(names: Sequence[str]) -> str:
    shown = ", ".join(safe(name) for name in names[:_MOST_NAMES])
    return f"{shown} and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else shown


def _number(value: int | None) -> str:
    return "-" if value is None else str(value)


def _many(number: int, what: str) -> str:
    if number == 1:
        return f"1 {what}"
    return f"{number} {what[:-1]}ies" if what.endswith("y") else f"{number} {what}s"
