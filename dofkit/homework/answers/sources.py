"""Finds submissions in files, folders, tables and lines of JSON, one by one.

Their contents are read later, by a worker.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, BinaryIO

from dofkit.homework.answers.roster import own_name
from dofkit.homework.answers.spreadsheet import decoded
from dofkit.homework.answers.submission import (
    MOST_BYTES,
    FilePlace,
    Submission,
    clean,
    of_text,
    of_value,
    reason,
    refused,
    shaped,
)
from dofkit.homework.answers.tables import Columns, TableError, rows

DOCUMENTS, LINES, TABLES = (".json", ".yaml", ".yml"), (".jsonl", ".ndjson"), (".csv", ".tsv")
#: Names of files with answers that do not identify a student.
GENERIC = frozenset({"answers", "answer", "submission", "solution", "antworten", "abgabe", "homework", "sheet"})
#: Files that operating systems leave in folders.
_LEFT = frozenset({"thumbs.db", "desktop.ini", "__macosx"})


@dataclass(frozen=True)
class Handed:
    """A submission before it is read: the text of a document, the mapping of a table's row, or an error.

    ``name``: the student's name if the submission gives none. ``claims``: the names of its file and folders, the
    innermost first, which a roster may identify. ``listed``: whether it is a row of a table that the lecturer named,
    which confirms the student.
    """

    name: str
    place: FilePlace
    data: bytes | Mapping[str, object] | None = None
    error: str = ""
    claims: tuple[str, ...] = ()
    listed: bool = False

    def submission(self, columns: Columns) -> Submission:
        """Return the submission as read; ``columns``: the assignment's columns."""
        if self.data is None:
            return refused(self.name, self.place, self.error)
        if isinstance(self.data, bytes):
            return of_text(self.data, self.name, self.place, columns)
        return of_value(self.data, self.name, self.place)

    @property
    def key(self) -> str:
        """A hash of name, place and content, 16 characters."""
        said = self.data if isinstance(self.data, bytes) else repr((self.data, self.error)).encode("utf-8", "replace")
        named = f"{self.name}\0{self.place}\0".encode("utf-8", "replace")
        return hashlib.blake2b(named + said, digest_size=8).hexdigest()

    @property
    def size(self) -> int:
        """The approximate size of the submission in bytes."""
        return len(self.data) if isinstance(self.data, bytes) else 200


def read_submission(source: str | os.PathLike[str] | Mapping[str, Any], columns: Columns) -> Submission:
    """Return the only submission of a file or folder, or of a mapping ``{student, answers}``."""
    if isinstance(source, Mapping):
        return of_value(shaped(source, columns), "")
    path = os.fspath(source)
    handed = list(islice(hand_ins([path], columns), 2))
    if len(handed) == 1:
        return handed[0].submission(columns)
    return refused(_stem(clean(path)), FilePlace(clean(path)), "it contains more than one submission")


def hand_ins(
    sources: Sequence[str], columns: Columns, others: Iterable[str | os.PathLike[str]] = ()
) -> Iterator[Handed]:
    """Yield all submissions of files and folders, in the given order; those of a folder sorted.

    ``others``: paths within the folders that contain no submissions, such as that of the results.
    """
    left_out = frozenset(os.path.realpath(path) for path in others)
    for source in sources:
        nothing = True
        folder = os.path.isdir(source)
        for handed in _folder(source, columns, left_out) if folder else _file(source, columns):
            yield _claimed(handed, source)
            nothing = False
        if nothing:
            yield _unreadable(source, "it contains no submission")


def _claimed(handed: Handed, source: str) -> Handed:
    """Return the submission with its claims: the names of its file and of its folders below ``source``.

    The student of a document called "answers" or similar is named by its folder; names in Moodle's notation are read.
    """
    path = handed.place.file
    if not path:
        return handed
    folder = os.path.isdir(source)
    handed = replace(handed, listed=handed.listed and not folder)
    within = (
        os.path.relpath(path, clean(source)) if folder else os.path.join(*os.path.normpath(path).split(os.sep)[-2:])
    )
    *folders, _ = [part for part in within.split(os.sep) if part not in ("", os.curdir, os.pardir)]
    stem = _stem(path)
    claims = (stem, *reversed(folders)) if folder or stem.lower() in GENERIC else (stem,)
    if handed.name != stem or not isinstance(handed.data, bytes | None):
        return replace(handed, claims=claims)
    naming = claims[1] if stem.lower() in GENERIC and len(claims) > 1 else stem
    return replace(handed, claims=claims, name=own_name(naming))


def _folder(folder: str, columns: Columns, left_out: frozenset[str]) -> Iterator[Handed]:
    """Yield the submissions of all files below a folder, sorted by names; links are not followed."""
    try:
        with os.scandir(folder) as scanned:
            entries = sorted((entry.name, entry.is_dir(follow_symlinks=False), entry.is_symlink()) for entry in scanned)
    except OSError as error:
        yield _unreadable(folder, reason(error))
        return
    for name, is_folder, is_link in entries:
        path = os.path.join(folder, name)
        if name.startswith(".") or name.lower() in _LEFT or os.path.realpath(path) in left_out:
            continue
        if is_link:
            yield _unreadable(path, "it is a symbolic link, which is not followed")
        elif is_folder:
            yield from _folder(path, columns, left_out)
        else:
            yield from _file(path, columns, within=True)


def _file(path: str, columns: Columns, within: bool = False) -> Iterator[Handed]:
    """Yield the submissions of a file; ``within`` a folder, files of other formats give an error."""
    suffix = os.path.splitext(path)[1].lower()
    try:
        if within and (not stat.S_ISREG(os.stat(path).st_mode) or suffix not in (*DOCUMENTS, *LINES, *TABLES)):
            yield _unreadable(path, f"it is not a submission: {', '.join((*DOCUMENTS, *LINES, *TABLES))} are read")
            return
        with open(path, "rb") as file:
            if suffix in TABLES:
                yield from _table(decoded(file.read()), clean(path), columns)
            elif suffix in LINES:
                yield from _lines(file, clean(path))
            else:
                yield Handed(_stem(clean(path)), FilePlace(clean(path)), file.read(MOST_BYTES + 1))
    except (OSError, ValueError) as error:
        yield _unreadable(path, f"it cannot be read: {reason(error)}")


def _lines(stream: BinaryIO, file: str) -> Iterator[Handed]:
    """Yield a submission for each line that is not blank."""
    number, line = 1, stream.readline(MOST_BYTES + 1).removeprefix(b"\xef\xbb\xbf")
    while line:
        place = FilePlace(file, number)
        if line.strip():
            yield Handed(f"{_stem(file)}:{number}", place, line.strip(b"\r\n"), listed=True)
        while not line.endswith(b"\n") and (continuation := stream.readline(MOST_BYTES)):
            line = continuation
        line, number = stream.readline(MOST_BYTES + 1), number + 1


def _table(text: str, file: str, columns: Columns) -> Iterator[Handed]:
    try:
        for row in rows(text, columns):
            place = FilePlace(file, row.line)
            if row.error is not None:
                yield Handed(row.student, place, error=row.error)
            else:
                named = {"student": row.student} if row.student else {}
                value = {**named, "answers": row.answers}
                yield Handed(row.student or _stem(file), place, value, listed=bool(named))
    except TableError as error:
        yield Handed(_stem(file), FilePlace(file, 1), error=str(error))


def _unreadable(path: str, why: str) -> Handed:
    return Handed(_stem(clean(path)), FilePlace(clean(path)), error=why)


def _stem(file: str) -> str:
    return os.path.splitext(os.path.basename(os.path.normpath(file)))[0]
