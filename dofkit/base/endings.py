"""The ending of a path, which decides the format of what is written there."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from dofkit.base.errors import ArgumentError
from dofkit.base.spelling import no_such


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
