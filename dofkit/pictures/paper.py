"""A picture on paper: marks in points, y upwards, that every kind of file is written from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

from dofkit.pictures.looks import Ink

Spot = tuple[float, float]
#: A character's width by its size, and a line's height.
WIDE, HIGH = 0.56, 1.25


class Mark(NamedTuple):
    """A line or area through spots, or a text at one of them; ``owner`` is what it shows."""

    spots: tuple[Spot, ...]
    ink: Ink
    closed: bool = False
    text: str = ""
    size: float = 9.0
    align: Literal["start", "middle", "end"] = "middle"
    bold: bool = False
    owner: str = ""
    radius: float = 0.0


class Page(NamedTuple):
    """Marks on a sheet of so many points, with what is told of it."""

    width: float
    height: float
    marks: tuple[Mark, ...]
    title: str
    alternative: str


def width_of(text: str, size: float) -> float:
    """About how wide a text is."""
    return WIDE * size * max((len(line) for line in text.split("\n")), default=0)


def wrapped(text: str, size: float, width: float) -> list[str]:
    """A text in lines that fit."""
    most = max(12, int(width / (WIDE * size * 0.92)))
    lines: list[str] = []
    for word in text.split():
        if lines and len(lines[-1]) + 1 + len(word) <= most:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return lines


def ordered(marks: Sequence[Mark]) -> list[Mark]:
    """From the lowest layer to the highest, else as given."""
    return sorted(marks, key=lambda mark: mark.ink.layer)
