"""Checks of what functions and commands are given from outside: a name of a list, seconds, the ending of a path."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Collection, Iterable
from numbers import Real
from pathlib import Path

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import no_such


def description_of(value: object) -> str:
    """Return a value on one short line, with its type.

    >>> description_of(["x"]), description_of(None)
    ("['x'] (a list)", 'None')
    """
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{' '.join(reprlib.repr(value).split())} ({'an' if name[0] in 'aeiouAEIOU' else 'a'} {name})"


def require_one_of(value: object, known: Iterable[str], what: str) -> None:
    """Raise ArgumentError for a value that is none of the known names; it suggests the nearest and lists all.

    >>> require_one_of("exact", ["count", "exact"], "method")
    """
    names = list(known)
    if not isinstance(value, str):
        raise ArgumentError(f"a {what} is one of {', '.join(names)}, not {description_of(value)}")
    if value not in names:
        raise ArgumentError(no_such(value, names, what))


def seconds_of(budget: object) -> float:
    """Return a budget in seconds, not below 0. Raises ArgumentError where it is no number.

    >>> seconds_of(-2), seconds_of(1.5)
    (0.0, 1.5)
    """
    if not isinstance(budget, Real) or isinstance(budget, bool) or math.isnan(budget):
        raise ArgumentError(f"the budget is a number of seconds, not {description_of(budget)}")
    return max(0.0, float(budget))


def is_folder_path(path: Path) -> bool:
    """Return whether a path names a folder: one that exists, or a name without an ending.

    >>> is_folder_path(Path("results")), is_folder_path(Path("results.csv"))
    (True, False)
    """
    return path.is_dir() or not path.suffix or path.suffix[1:].isdigit()


def format_of_path(path: Path, known: Collection[str], asked: str | None = None) -> str:
    """Return the format of the file that is written to a path: its ending decides.

    ``known``: the formats, which are the endings without the dot; none where only a folder can be written. ``asked``:
    the format that was asked for besides. Raises ArgumentError where the ending is unknown or contradicts that format.

    >>> format_of_path(Path("sheet.pdf"), ["html", "pdf"])
    'pdf'
    """
    ending = path.suffix.lower()
    if not known:
        raise ArgumentError(
            f"'{path}' has the ending of a file, but a folder is written: give a name without an ending"
        )
    if not ending and asked is not None:
        return asked
    if not ending:
        raise ArgumentError(f"'{path}' has no ending: name a file that ends in .{', .'.join(known)}")
    if ending[1:] not in known:
        raise ArgumentError(f"'{path}': {no_such(ending, [f'.{name}' for name in known], 'ending')}")
    if asked not in (None, ending[1:]):
        other = path.with_suffix(f".{asked}")
        raise ArgumentError(
            f"'{path}' ends in {ending}, but --format asks for {asked}: leave out --format, or write to '{other}'"
        )
    return ending[1:]
