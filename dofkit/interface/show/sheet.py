"""The contents of what is printed of a value, before they are lines at a terminal or HTML: facts, then sections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

#: The meaning of a fact, shown by its colour; ``care``: a reservation.
Tone = Literal["plain", "good", "care", "bad"]
#: The colour system of a terminal, by its name in rich.
Colours = Literal["standard", "256", "truecolor", "windows"]
#: {verdict: tone}.
TONES: dict[str, Tone] = {"proved": "good", "probable": "good", "numeric": "care", "undecided": "bad"}


class Formula(NamedTuple):
    """A text in the grammar of scenes, which HTML shows as mathematics."""

    text: str

    def __str__(self) -> str:
        return self.text


class Matrix(NamedTuple):
    """A named matrix, with entries in the grammar of scenes."""

    name: str
    rows: Sequence[Sequence[str]]

    def __str__(self) -> str:
        return f"{self.name} = [{'; '.join(', '.join(row) for row in self.rows)}]"


Content = str | Formula | Matrix


class Fact(NamedTuple):
    """A line of the table at the top: label, value, and a less prominent note."""

    label: str
    value: Content
    note: str = ""
    tone: Tone = "plain"


class Remark(NamedTuple):
    """A line of a section: its subject, a text about it, and a note in parentheses."""

    label: Content
    text: Content
    note: str = ""


class Column(NamedTuple):
    """A column of a table: its share of the line (0: the width of its words), and whether it contains numbers."""

    head: str
    share: int = 0
    numbers: bool = False


class Grid(NamedTuple):
    """A table within a section; its first column contains names."""

    columns: tuple[Column, ...]
    rows: Sequence[tuple[Content, ...]]


class SheetSection(NamedTuple):
    """A heading with its contents; ``more``: a text on what was left out."""

    heading: str
    content: Sequence[Remark | Grid]
    more: str = ""


class Sheet(NamedTuple):
    """Everything that is printed of a value. ``alarm``: a text above everything else.

    ``copied``: lines are not broken, so that formulas can be copied. ``picture``: makes an inline SVG, or None.
    """

    name: str
    title: Content = ""
    alarm: tuple[str, Tone] | None = None
    facts: Sequence[Fact] = ()
    sections: Sequence[SheetSection] = ()
    copied: bool = False
    picture: Callable[[], str | None] | None = None
