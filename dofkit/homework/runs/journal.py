"""Results in a file as they come, so that an interrupted run goes on where it stopped.

A run that finds the results of one like it takes over all up to the first that does not fit what is handed in now, such
as a torn one, and grades from there on.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from dofkit.base.line_journal import LineJournal
from dofkit.base.version import __version__
from dofkit.homework.answers.roster import Roster
from dofkit.homework.answers.sources import Handed
from dofkit.homework.assignment import Prepared
from dofkit.homework.runs.batch import ResultLine
from dofkit.homework.runs.repeats import HandedIn


def fingerprint(prepared: Prepared, check_only: bool, roster: Roster | None = None) -> str:
    """What tells a run from others: the assignment with its scenes, who is in the course, and who grades it how."""
    course = "" if roster is None else roster.digest
    parts = [__version__, str(check_only), course, prepared.assignment.model_dump_json()]
    parts += [f"{identity} {decision}" for identity, decision in sorted(prepared.decisions.items())]
    parts += [f"{name} {key.convention} {key.scene.model_dump_json()}" for name, key in prepared.keys.items()]
    return hashlib.blake2b("\0".join(parts).encode("utf-8", "replace"), digest_size=16).hexdigest()


class Journal:
    """Results at ``path``, with their ledger; closed before `finish` it stays, and the next one goes on with it.

    ``failed``: how many of those that were taken over could not be graded.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self.failed = 0
        self._kept = LineJournal(path, mark)

    def remaining(self, handed: Iterator[Handed], seen: HandedIn) -> Iterator[Handed]:
        """What is left of ``handed`` after what was graded before; who is behind that is noted in ``seen``."""
        for one in handed:
            known = self._kept.next_known(one.digest())
            if known is None:
                self._kept.cut()
                return chain([one], handed)
            for line in map(_line, known.texts):
                self.failed += line.failed
                if not line.failed and not line.doubted:
                    seen.first(line.student, str(one.place))
        self._kept.cut()
        return iter(())

    def write(self, one: Handed, lines: list[ResultLine]) -> None:
        """Note the results of something handed in."""
        self._kept.write(one.digest(), [f"{line.text}\n".encode() for line in lines])

    def close(self) -> None:
        """Stop here; another run may go on."""
        self._kept.close()

    def finish(self) -> None:
        """All is graded: the next run begins anew."""
        self._kept.finish()


def _line(text: bytes) -> ResultLine:
    value = json.loads(text)
    failed, doubted = value["error"] is not None, value.get("doubt") is not None
    return ResultLine(str(value["student"]), failed, text.decode().rstrip("\n"), doubted)
