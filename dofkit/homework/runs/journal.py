"""Results in a file as they come, so that an interrupted run goes on where it stopped.

Beside the file stands a ledger while the run goes on: on its first line what is graded and how, then a line for
everything that was handed in: its digest, and that of its results. A run that finds both takes over all results
up to the first that does not fit what is handed in now, such as a torn one, and grades from there on.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import BinaryIO

from dofkit.base.errors import DofkitError
from dofkit.base.version import __version__
from dofkit.homework.answers.roster import Roster
from dofkit.homework.answers.sources import Handed
from dofkit.homework.assignment import Prepared
from dofkit.homework.runs.batch import ResultLine
from dofkit.homework.runs.in_order import HandedIn

if sys.platform != "win32":
    import fcntl


def fingerprint(prepared: Prepared, check_only: bool, roster: Roster | None = None) -> str:
    """What tells a run from others: the assignment with its scenes, who is in the course, and who grades it how."""
    course = "" if roster is None else roster.digest
    parts = [__version__, str(check_only), course, prepared.assignment.model_dump_json()]
    parts += [f"{identity} {decision}" for identity, decision in sorted(prepared.decisions.items())]
    parts += [f"{name} {key.convention} {key.scene.model_dump_json()}" for name, key in prepared.keys.items()]
    return hashlib.blake2b("\0".join(parts).encode("utf-8", "replace"), digest_size=16).hexdigest()


def ledger(path: Path) -> Path:
    """Where the ledger of results at ``path`` stands."""
    return path.with_name(path.name + ".unfinished")


class BusyError(DofkitError):
    """Another run writes to the same file."""


class Journal:
    """Results at ``path``, with their ledger; closed before `finish` it stays, and the next one goes on with it.

    ``failed``: how many of those that were taken over could not be graded.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self.path = path
        self.failed = 0
        self.ledger = ledger(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        known = self._head() == mark and path.exists()
        self._marks: BinaryIO = self.ledger.open("r+b" if known else "a+b")
        _locked(self._marks, path)
        self._results: BinaryIO = path.open("r+b" if known else "w+b")
        if not known:
            self._marks.truncate(0)
            self._marks.write(f"{mark}\n".encode())
            self._marks.flush()

    def _head(self) -> str | None:
        with suppress(OSError), self.ledger.open("rb") as marks:
            return marks.readline().decode("ascii", "replace").rstrip("\n")
        return None

    def remaining(self, handed: Iterator[Handed], seen: HandedIn) -> Iterator[Handed]:
        """What is left of ``handed`` after what was graded before; who is behind that is noted in ``seen``."""
        self._marks.readline()
        for one in handed:
            results, marks = self._results.tell(), self._marks.tell()
            lines = self._known(one)
            if lines is None:
                self._cut(results, marks)
                return chain([one], handed)
            for line in lines:
                self.failed += line.failed
                if not line.failed and not line.doubted:
                    seen.first(line.student, str(one.place))
        self._cut(self._results.tell(), self._marks.tell())
        return iter(())

    def _known(self, one: Handed) -> list[ResultLine] | None:
        """The results of what was handed in, if they stand next in the file, whole."""
        parts = self._marks.readline().decode("ascii", "replace").split(" ")
        if len(parts) != 3 or parts[0] != one.digest() or not parts[1].isdigit():
            return None
        texts = [self._results.readline() for _ in range(int(parts[1]))]
        if parts[2] != f"{_digest(texts)}\n":
            return None
        return [_line(text) for text in texts]

    def _cut(self, results: int, marks: int) -> None:
        """Drop everything after these places, and write there."""
        for file, place in ((self._results, results), (self._marks, marks)):
            file.seek(place)
            file.truncate()

    def write(self, one: Handed, lines: list[ResultLine]) -> None:
        """Note the results of something handed in: first they are written, then that they are."""
        texts = [f"{line.text}\n".encode() for line in lines]
        self._results.writelines(texts)
        self._results.flush()
        self._marks.write(f"{one.digest()} {len(texts)} {_digest(texts)}\n".encode())
        self._marks.flush()

    def close(self) -> None:
        """Stop here; another run may go on."""
        self._results.close()
        self._marks.close()

    def finish(self) -> None:
        """All is graded: the next run begins anew."""
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


def _digest(texts: list[bytes]) -> str:
    return hashlib.blake2b(b"".join(texts), digest_size=8).hexdigest()


def _line(text: bytes) -> ResultLine:
    value = json.loads(text)
    failed, doubted = value["error"] is not None, value.get("doubt") is not None
    return ResultLine(str(value["student"]), failed, text.decode().rstrip("\n"), doubted)
