"""A sheet for a person at a terminal: lines that fit, and nothing in them that a terminal would obey."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from dofkit.interface.show.faults import safe
from dofkit.interface.show.sheet import Colours, Fact, Grid, Remark, Sheet, SheetSection, Tone

#: How a tone is coloured.
STYLES: dict[Tone, str] = {"plain": "", "good": "green", "care": "yellow", "bad": "red"}
#: Columns for lines that are not broken.
_UNBROKEN = 1 << 16


class Screen(NamedTuple):
    """The columns of a terminal (None: its own, or 80), and its colours (None: without)."""

    width: int | None = None
    colours: Colours | None = None


def as_text(sheet: Sheet, screen: Screen) -> str:
    """Return the whole sheet as lines, without blanks at their ends."""
    coloured = screen.colours is not None
    console = Console(
        file=io.StringIO(),
        width=_UNBROKEN if sheet.copied else screen.width,
        force_terminal=coloured,
        force_jupyter=False,
        color_system=screen.colours,
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
    """The first column in bold; names and texts are folded where they are long, words are not."""
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
