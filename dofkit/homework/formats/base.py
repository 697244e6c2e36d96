"""What a format is: a function of the results, as they come, that writes them to a path or a stream."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TextIO

from dofkit.base.arguments import format_of_path, is_folder_path
from dofkit.base.errors import DofkitError
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.result import Result

#: Where results go: the path that ``--out`` names, or a stream such as standard output.
Target = Path | TextIO


class FormatError(DofkitError):
    """Results that cannot be written in a format, such as two students where it holds one."""


class Handback(NamedTuple):
    """The files that were handed in, and who is in the course."""

    sources: tuple[str, ...]
    roster: Roster | None


@dataclass(frozen=True)
class Format:
    """``write(results, prepared, target)`` writes results, which come one by one in the order of the submissions.

    ``write`` keeps no more than one result in memory where the format allows it, and raises FormatError for what the
    format cannot hold. ``needs_path``: it writes a folder, so that standard output will not do. ``endings``: those
    of the files that it writes, without the dot. ``folders``: whether it can write a folder. ``write_known``: the same
    with a roster: a gradebook has rows for those in it only, and pages tell of each class. ``write_back``: it fills in,
    at a path that ends in ``.csv``, the tables of the platform that were handed in.
    """

    name: str
    write: Callable[[Iterator[Result], Prepared, Target], None]
    needs_path: bool = False
    endings: tuple[str, ...] = ("json",)
    folders: bool = True
    write_known: Callable[[Iterator[Result], Prepared, Target, Roster], None] | None = None
    write_back: Callable[[Iterator[Result], Prepared, Path, Handback], None] | None = None

    def folder(self, path: Path) -> bool:
        """Return whether a folder is written there. Raises ArgumentError for the ending of another format."""
        if self.folders and is_folder_path(path):
            return True
        format_of_path(path, self.endings)
        return False

    def written(
        self,
        results: Iterator[Result],
        prepared: Prepared,
        target: Target,
        roster: Roster | None,
        sources: Sequence[str] = (),
    ) -> None:
        """Write results, those of a gradebook by a roster where there is one; ``sources``: what was handed in."""
        if self.write_back is not None and isinstance(target, Path) and target.suffix.lower() == ".csv":
            self.write_back(results, prepared, target, Handback(tuple(sources), roster))
        elif roster is None or self.write_known is None:
            self.write(results, prepared, target)
        else:
            self.write_known(results, prepared, target, roster)


@contextmanager
def opened(target: Target) -> Iterator[TextIO]:
    """A text stream to write to: a new UTF-8 file, its folder made, or the stream that was given."""
    if not isinstance(target, Path):
        yield target
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    with target.open("w", encoding="utf-8", newline="") as stream:
        yield stream
