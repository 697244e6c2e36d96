"""Formats of results: functions that write results to a path or a stream."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO, TypeAlias

from dofkit.base.errors import DofkitError
from dofkit.base.wording import format_of_path, is_folder_path
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import FileNames, plain, shortened
from dofkit.homework.result import Result, json_line

#: Where results are written: the path of ``--out``, or a stream such as standard output.
Target = Path | TextIO
Document: TypeAlias = Callable[[Result, Prepared], dict[str, Any]]
#: Writes results in the order of the submissions; a gradebook has rows only for members of the roster.
Write: TypeAlias = Callable[[Sequence[Result], Prepared, Target, "Roster | None"], None]
#: The beginning of a formula for spreadsheets, also after spaces, and with full-width signs.
_FORMULA = re.compile("\\s*[=+\\-@|\uff1d\uff0b\uff0d\uff20\u2212]|[\t\r\n]")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")
#: The most characters of a cell: spreadsheets allow slightly more.
MOST_CHARACTERS = 32_000


class FormatError(DofkitError):
    """Results that cannot be written in a format, such as two students in a format for one."""


@dataclass(frozen=True)
class Format:
    """A format in which results are written.

    ``write`` raises FormatError for results that the format cannot represent. ``endings``: file extensions without the
    dot; if there are none, it writes only folders, not to standard output. ``folders``: whether it can write a folder.
    """

    name: str
    write: Write
    endings: tuple[str, ...] = ("json",)
    folders: bool = True

    def folder(self, path: Path) -> bool:
        """Return whether a folder is written to ``path``. Raises ArgumentError for the extension of another format."""
        if self.folders and is_folder_path(path):
            return True
        format_of_path(path, self.endings)
        return False


@contextmanager
def opened(target: Target) -> Iterator[TextIO]:
    """Yield a text stream for writing: a new UTF-8 file, whose folder is created, or ``target`` itself."""
    if not isinstance(target, Path):
        yield target
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    with target.open("w", encoding="utf-8", newline="") as stream:
        yield stream


def write_native(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """Write one JSON object per line for every submission, in ASCII unless the stream is UTF-8."""
    del prepared, roster
    with opened(target) as stream:
        ascii_only = (stream.encoding or "utf-8").lower().replace("-", "") != "utf8"
        for text in map(json_line, results):
            stream.write((json.dumps(json.loads(text)) if ascii_only else text) + "\n")


def per_student(document: Document) -> Write:
    """Return a writer of one JSON document per student.

    A stream, or a path that ends in ``.json``, is for one student; any other path is a folder, with a file for each.
    The writer raises FormatError for a second student in one file, and for a file without a student.
    """

    def write(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
        del roster
        if isinstance(target, Path) and (target.is_dir() or target.suffix.lower() != ".json"):
            names = FileNames()
            target.mkdir(parents=True, exist_ok=True)
            for result in results:
                _write(document(result, prepared), target / f"{names.of(result.student)}.json")
            return
        if len(results) > 1:
            raise FormatError("this format holds one student: give --out a folder, to get one file per student")
        if isinstance(target, Path) and not results:
            raise FormatError(f"there is no submission to write to {target}")
        for result in results:
            _write(document(result, prepared), target)

    return write


def text(document: dict[str, Any]) -> str:
    """Return a document as JSON text in ASCII."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def _write(document: dict[str, Any], target: Target) -> None:
    with opened(target) as stream:
        stream.write(text(document))


def cell(content: str) -> str:
    """Return a text as a cell of a table, with an apostrophe before what a spreadsheet would read as a formula.

    >>> cell("=cmd|'/C calc'!A0"), cell("-2"), cell("-2+3"), cell("Ada")
    ("'=cmd|'/C calc'!A0", '-2', "'-2+3", 'Ada')
    """
    printable = shortened(plain(content), MOST_CHARACTERS)
    return f"'{printable}" if _FORMULA.match(printable) and not _NUMBER.fullmatch(printable) else printable


def table(stream: TextIO) -> Any:
    """Return a writer of comma-separated rows according to RFC 4180."""
    return csv.writer(stream, lineterminator="\r\n")


NATIVE = Format("native", write_native, endings=("jsonl",))
