"""What is printed of a value, before it is lines at a terminal or a table in a page: facts, then sections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

#: The meaning of a fact: ``good`` and ``bad`` are shown by colour, and by their words.
Tone = Literal["plain", "good", "care", "bad"]
#: Numbers of colours of a terminal, in the words of rich.
Colours = Literal["standard", "256", "truecolor", "windows"]
#: How a verdict is meant.
TONES: dict[str, Tone] = {"proved": "good", "probable": "good", "numeric": "care", "undecided": "bad"}


class Formula(NamedTuple):
    """A text in the grammar of scenes: a page sets it as mathematics."""

    text: str

    def __str__(self) -> str:
        return self.text


class Matrix(NamedTuple):
    """``name = [...]``, its entries in the grammar of scenes."""

    name: str
    rows: Sequence[Sequence[str]]

    def __str__(self) -> str:
        return f"{self.name} = [{'; '.join(', '.join(row) for row in self.rows)}]"


Content = str | Formula | Matrix


class Fact(NamedTuple):
    """A line of the table at the top: its ``value`` and, more quietly, a ``note`` on it."""

    label: str
    value: Content
    note: str = ""
    tone: Tone = "plain"


class Remark(NamedTuple):
    """A line of a section: its subject, and what is said about it."""

    label: Content
    text: Content
    note: str = ""


class Column(NamedTuple):
    """A column of a table: its share of the line (0: what its words need), and whether it holds numbers."""

    head: str
    share: int = 0
    numbers: bool = False


class Grid(NamedTuple):
    """A table within a section; its first column holds names."""

    columns: tuple[Column, ...]
    rows: Sequence[tuple[Content, ...]]


class SheetSection(NamedTuple):
    """A heading with what stands under it; ``more`` says what was left out."""

    heading: str
    content: Sequence[Remark | Grid]
    more: str = ""


class Sheet(NamedTuple):
    """Everything that is printed of a value. ``alarm``: what stands above everything else.

    ``copied``: its formulas are copied from a terminal, so that no line is broken. ``picture``: makes one as an inline
    SVG, or None.
    """

    name: str
    title: Content = ""
    alarm: tuple[str, Tone] | None = None
    facts: Sequence[Fact] = ()
    sections: Sequence[SheetSection] = ()
    copied: bool = False
    picture: Callable[[], str | None] | None = None
