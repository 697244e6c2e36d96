"""A sheet, or a report on one line, for a terminal: lines of its width, without control characters."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Sequence
from typing import Any

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from dofkit.interface.show.faults import safe
from dofkit.interface.show.report import number, system_labels
from dofkit.interface.show.sheet import TONES, Colours, Fact, Grid, Remark, Sheet, SheetSection, Tone
from dofkit.report import Report

#: {tone: style of rich}.
STYLES: dict[Tone, str] = {"plain": "", "good": "green", "care": "yellow", "bad": "red"}
#: The width for lines that are not broken.
_UNBROKEN = 1 << 16


def as_text(sheet: Sheet, width: int | None = None, colours: Colours | None = None) -> str:
    """Return the sheet as lines without trailing blanks; ``width``: columns (None: the terminal's, or 80)."""
    coloured = colours is not None
    console = Console(
        file=io.StringIO(),
        width=_UNBROKEN if sheet.copied else width,
        force_terminal=coloured,
        force_jupyter=False,
        color_system=colours,
        emoji=False,
        markup=False,
        no_color=not coloured,
    )
    with console.capture() as captured:
        console.print(Group(*_pieces(sheet)))
    return "\n".join(line.rstrip() for line in captured.get().splitlines())


def _pieces(sheet: Sheet) -> Iterator[RenderableType]:
    headline = Text(safe(sheet.name), "bold")
    if sheet.title:
        headline.append(f"  {safe(str(sheet.title))}", "not bold")
    yield headline
    if sheet.alarm is not None:
        text, tone = sheet.alarm
        yield Padding(Text(safe(text), f"bold {STYLES[tone]}"), (0, 0, 0, 2))
    if sheet.facts:
        yield _facts(sheet.facts)
    for section in sheet.sections:
        yield from _section(section)


def _facts(facts: Sequence[Fact]) -> RenderableType:
    grid = Table.grid(padding=(0, 2))
    grid.add_column(style="dim", no_wrap=True)
    grid.add_column(ratio=1)
    for fact in facts:
        value = Text(safe(str(fact.value)), f"{'bold' if fact.note else ''} {STYLES[fact.tone]}".strip())
        if fact.note:
            value = Text.assemble(value, f"  {safe(fact.note)}")
        grid.add_row(fact.label, value)
    return Padding(grid, (0, 0, 0, 2))


def _section(section: SheetSection) -> Iterator[RenderableType]:
    lines: list[RenderableType] = [_grid(part) if isinstance(part, Grid) else _remark(part) for part in section.content]
    if section.more:
        lines.append(Text(section.more, "dim"))
    yield Text(section.heading, "bold cyan")
    yield Padding(Group(*lines), (0, 0, 0, 2))


def _remark(remark: Remark) -> Text:
    label, text = safe(str(remark.label)), safe(str(remark.text))
    between = " " if label == "!" else ": "
    note = f"   ({safe(remark.note)})" if remark.note else ""
    return Text.assemble((label, "bold"), f"{between}{text}{note}") if label else Text(text + note)


def _grid(grid: Grid) -> RenderableType:
    """Return a table of rich, the first column bold; long names and texts are folded, other columns are not."""
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", show_edge=False)
    for i, column in enumerate(grid.columns):
        if column.numbers:
            table.add_column(column.head.replace(" ", "\n"), justify="right", no_wrap=True)
        elif i == 0:
            table.add_column(column.head, overflow="fold")
        elif column.share:
            table.add_column(column.head, overflow="fold", ratio=column.share)
        else:
            table.add_column(column.head, no_wrap=True)
    for row in grid.rows:
        table.add_row(*(Text(safe(str(cell)), "bold" if i == 0 else "") for i, cell in enumerate(row)))
    return table


#: Widths in the line of a scene: the most for a name; the labels; a verdict.
WIDEST_NAME, LABELS, VERDICT = 40, len("non-holonomic, scleronomic"), len("undecided")


def headline(name_width: int) -> str:
    """Return the heading above the lines of scenes (f: degrees of freedom, v: velocity freedom)."""
    return f"{'scene':<{min(name_width, WIDEST_NAME)}}  {'f':>3} {'v':>3}  {'system':<{LABELS}}  verdict"


def brief_line(report: Report, name_width: int, colours: Colours | None = None) -> str:
    """Return ``NAME  f  v  labels  verdict`` and findings; ``name_width``: the length of the longest name."""
    name, verdict = safe(report.scene), report.verdict
    text = Text.assemble(
        (f"{name:<{min(name_width, WIDEST_NAME)}}", "bold"),
        f"  {number(report.dof):>3} {number(report.velocity_dof):>3}  {system_labels(report):<{LABELS}}  ",
        (f"{verdict:<{VERDICT}}", STYLES[TONES[verdict]]),
        *((f"  {finding}", STYLES["care"]) for finding in _findings(report)),
    )
    if colours is None:
        return text.plain.rstrip()
    width = len(text.plain) + 1
    console = Console(file=io.StringIO(), width=width, force_terminal=True, color_system=colours)
    with console.capture() as captured:
        console.print(text, end="")
    return captured.get().rstrip()


def _findings(report: Report) -> Iterator[str]:
    if report.consistent is False:
        yield "inconsistent"
    if report.feasible is False:
        yield "infeasible"
    if report.redundant_equations:
        yield f"{report.redundant_equations} redundant"
    if report.singular:
        yield "singular"


def outcome_of(report: Report) -> dict[str, Any]:
    """Return {"scene", "verdict", "is"} for a summary; ``is``: the findings that ``--fail-on`` may name."""
    findings = {
        "inconsistent": report.consistent is False,
        "infeasible": report.feasible is False,
        "redundant": bool(report.redundant or report.redundant_equations),
        "undecided": report.verdict == "undecided",
    }
    return {"scene": report.scene, "verdict": report.verdict, "is": [name for name in findings if findings[name]]}


def selected_line(report: Report, only: Sequence[str]) -> str:
    """Return a line such as ``SCENE  dof 4 (proved)``, with each field of ``only`` and its verdict."""
    fields = report.model_dump(mode="json", include=set(only))
    texts = []
    for name in only:
        verdict = report.verdicts.get(name)
        texts.append(f"{name} {_value(fields[name])}" + ("" if verdict is None else f" ({verdict.verdict})"))
    return safe("  ".join([report.scene, *texts]))


def _value(value: Any) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
