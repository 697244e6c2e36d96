"""Lines in a file as they come, so that an interrupted run goes on where it stopped.

Beside the file stands a ledger: on its first line a mark that tells what is done and how, then a line for everything
that was done: its key, how many lines are told of it, their digest, and a note. A run that finds both takes over what
fits; a line that is half written fits nothing.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from dofkit.base.errors import DofkitError

if sys.platform != "win32":
    import fcntl


def ledger(path: Path, ending: str = ".unfinished") -> Path:
    """Where the ledger of lines at ``path`` stands."""
    return path.with_name(path.name + ending)


class BusyError(DofkitError):
    """Another run writes to the same file."""


class Noted(NamedTuple):
    """What was told of something: its ``key`` (no spaces), whole lines, the place where they begin, and a note."""

    key: str
    texts: list[bytes]
    place: int
    note: str


class LineJournal:
    """Lines at ``path``, with their ledger; closed before `finish` it stays, and the next one goes on with it.

    ``mark``: what is done and how (no spaces); where another was left there, nothing of that is taken over.
    """

    def __init__(self, path: Path, mark: str, ending: str = ".unfinished") -> None:
        self.path = path
        self.ledger = ledger(path, ending)
        path.parent.mkdir(parents=True, exist_ok=True)
        known = self._head() == mark and path.exists()
        self._marks: BinaryIO = self.ledger.open("r+b" if known else "a+b")
        _locked(self._marks, path)
        self._lines: BinaryIO = path.open("r+b" if known else "w+b")
        if not known:
            self._marks.truncate(0)
            self._marks.write(f"{mark}\n".encode())
            self._marks.flush()
        self._marks.seek(0)
        self._marks.readline()

    def _head(self) -> str | None:
        with suppress(OSError), self.ledger.open("rb") as marks:
            return marks.readline().decode("ascii", "replace").rstrip("\n")
        return None

    def next_known(self, key: str) -> Noted | None:
        """What was told of a thing, if it stands next in the file, whole; else None, and the place is as before."""
        before = self._lines.tell(), self._marks.tell()
        found = self._next()
        if found is not None and found.key != key:
            self._go_to(*before)
            return None
        return found

    def following(self) -> Iterator[Noted]:
        """All that stands whole from here on; the place is then as before."""
        before = self._lines.tell(), self._marks.tell()
        while (found := self._next()) is not None:
            yield found
        self._go_to(*before)

    def _next(self) -> Noted | None:
        """The next thing that stands whole; where there is none the place is as before."""
        before = self._lines.tell(), self._marks.tell()
        found = self._read()
        if found is None:
            self._go_to(*before)
        return found

    def _read(self) -> Noted | None:
        line = self._marks.readline().decode("utf-8", "replace")
        parts = line.rstrip("\n").split(" ", 3)
        if len(parts) != 4 or not line.endswith("\n") or not parts[1].isdigit():
            return None
        place = self._lines.tell()
        texts = [self._lines.readline() for _ in range(int(parts[1]))]
        return Noted(parts[0], texts, place, parts[3]) if parts[2] == _digest(texts) else None

    def _go_to(self, lines: int, marks: int) -> None:
        self._lines.seek(lines)
        self._marks.seek(marks)

    def to_end(self) -> None:
        """Go behind all that stands whole, and drop what does not."""
        while self._next() is not None:
            pass
        self.cut()

    def cut(self) -> None:
        """Drop everything after this place, and write there."""
        for file in (self._lines, self._marks):
            place = file.tell()
            file.seek(place)
            file.truncate(place)

    def write(self, key: str, texts: Sequence[bytes], note: str = "") -> int:
        """Note what is told of a thing, whole lines: first they are written, then that they are; returns the place."""
        place = self._lines.tell()
        self._lines.writelines(texts)
        self._lines.flush()
        self._marks.write(f"{key} {len(texts)} {_digest(texts)} {note}\n".encode())
        self._marks.flush()
        return place

    def text_at(self, place: int) -> bytes:
        """The line that begins at a place; what is next to be read or written stays so."""
        before = self._lines.tell()
        self._lines.seek(place)
        found = self._lines.readline()
        self._lines.seek(before)
        return found

    def close(self) -> None:
        """Stop here; another run may go on."""
        self._lines.close()
        self._marks.close()

    def finish(self) -> None:
        """All is done: the next run begins anew."""
        self.close()
        self.ledger.unlink(missing_ok=True)


def _locked(file: BinaryIO, path: Path) -> None:
    """Let no other run write to the same file, where the system can tell."""
    if sys.platform != "win32":
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BusyError(f"another run is writing to {path}") from None
        except OSError:
            return


def _digest(texts: Sequence[bytes]) -> str:
    return hashlib.blake2b(b"".join(texts), digest_size=8).hexdigest()
