"""What a format is: a function of the results that writes them to a path or a stream."""

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
from dofkit.homework.formats.wording import FileNames, plain
from dofkit.homework.result import Result, json_line

#: Where results go: the path that ``--out`` names, or a stream such as standard output.
Target = Path | TextIO
Document: TypeAlias = Callable[[Result, Prepared], dict[str, Any]]
#: Writes results in the order of the submissions; a gradebook has rows for a roster only.
Write: TypeAlias = Callable[[Sequence[Result], Prepared, Target, "Roster | None"], None]
#: What spreadsheets read as the beginning of a formula, also after spaces, and in its full-width forms.
_FORMULA = re.compile("\\s*[=+\\-@|\uff1d\uff0b\uff0d\uff20\u2212]|[\t\r\n]")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")
#: More than a spreadsheet holds in a cell.
MOST_CHARACTERS = 32_000


class FormatError(DofkitError):
    """Results that cannot be written in a format, such as two students where it holds one."""


@dataclass(frozen=True)
class Format:
    """A form in which results are written.

    ``write`` raises FormatError for what the format cannot hold. ``endings``: those of the files that it writes,
    without the dot; without any it writes a folder, and standard output will not do. ``folders``: whether it can.
    """

    name: str
    write: Write
    endings: tuple[str, ...] = ("json",)
    folders: bool = True

    def folder(self, path: Path) -> bool:
        """Return whether a folder is written there. Raises ArgumentError for the ending of another format."""
        if self.folders and is_folder_path(path):
            return True
        format_of_path(path, self.endings)
        return False


@contextmanager
def opened(target: Target) -> Iterator[TextIO]:
    """Open a text stream to write to: a new UTF-8 file, its folder made, or the stream that was passed."""
    if not isinstance(target, Path):
        yield target
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    with target.open("w", encoding="utf-8", newline="") as stream:
        yield stream


def write_native(results: Sequence[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """Write one JSON object per line for every submission, in ASCII if that is all that the stream takes."""
    del prepared, roster
    with opened(target) as stream:
        ascii_only = (stream.encoding or "utf-8").lower().replace("-", "") != "utf8"
        for text in map(json_line, results):
            stream.write((json.dumps(json.loads(text)) if ascii_only else text) + "\n")


def per_student(document: Document) -> Write:
    """Return a writer of one JSON document per student.

    A stream, or a path that ends in ``.json``, holds one student; any other path is a folder, with a file for each.
    The writer raises FormatError where a second student does not fit, or where there is none at all for a file.
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
    """Return a document as ASCII JSON, which every reader takes."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def _write(document: dict[str, Any], target: Target) -> None:
    with opened(target) as stream:
        stream.write(text(document))


def cell(content: str) -> str:
    """Return a text as a cell of a table: an apostrophe stands before what a spreadsheet would read as a formula.

    >>> cell("=cmd|'/C calc'!A0"), cell("-2"), cell("-2+3"), cell("Ada")
    ("'=cmd|'/C calc'!A0", '-2', "'-2+3", 'Ada')
    """
    printable = plain(content)
    if len(printable) > MOST_CHARACTERS:
        printable = printable[: MOST_CHARACTERS - 3] + "..."
    return f"'{printable}" if _FORMULA.match(printable) and not _NUMBER.fullmatch(printable) else printable


def table(stream: TextIO) -> Any:
    """Return a writer of comma-separated rows, as RFC 4180 has them."""
    return csv.writer(stream, lineterminator="\r\n")


NATIVE = Format("native", write_native, endings=("jsonl",))
