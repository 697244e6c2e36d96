"""Results that have no row in a gradebook: listed in a table of their own, with why, and never written to the other.

A gradebook takes what a row says: a blank grade wipes the one that stands there (Canvas posts it, Moodle sets it to
null), a row of nobody in the course makes Canvas ask who that is and Moodle give up the whole table.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.formats.base import Target, opened
from dofkit.homework.formats.cells import cell, is_cell, mark_of, table
from dofkit.homework.formats.wording import decided, identity, line, number, open_points
from dofkit.homework.result import Result


def apart_path(out: Path) -> Path:
    """Where the results without a row stand: ``grades.apart.csv`` beside ``grades.csv``."""
    return out.with_name(f"{out.stem}.apart.csv")


class Apart:
    """A table of results without a row, begun with the first; of a gradebook without a path lines on standard error."""

    def __init__(self, target: Target) -> None:
        self._path = apart_path(target) if isinstance(target, Path) else None
        self._stream: TextIO | None = None
        self._rows: Any = None
        if self._path is not None:
            self._path.unlink(missing_ok=True)

    def add(self, result: Result, why: str) -> None:
        """List a result."""
        if self._path is None:
            print(f"not in the table: {line(result.student)}: {why}", file=sys.stderr)
            return
        if self._stream is None:
            self._stream = self._path.open("w", encoding="utf-8", newline="")
            self._rows = table(self._stream)
            self._rows.writerow(["student", "points so far", "of", "open points", "why"])
        points = "" if result.score is None else number(result.score)
        shown = [number(result.max_score), number(open_points(result)), cell(why)]
        self._rows.writerow([cell(identity(result.student)), points, *shown])

    def __enter__(self) -> Apart:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._stream is not None:
            self._stream.close()


def unfit(result: Result) -> str | None:
    """Why a result has no grade that may stand in a gradebook; None where it has one."""
    if result.error is not None:
        return f"it could not be graded: {line(result.error)}"
    if result.doubt is not None:
        return line(result.doubt)
    if not decided(result):
        return f"it is not final: {number(open_points(result))} points are undecided"
    return None


def with_rows(
    results: Iterator[Result], roster: Roster | None, apart: Apart
) -> Iterator[tuple[Result, Participant | None]]:
    """The results that have a row, one for each student, with who they are in a roster; the others are set apart."""
    seen: set[bytes] = set()
    for result in results:
        member = None if roster is None else roster.find(result.student)
        why = unfit(result)
        if roster is not None and member is None:
            why = "the student is not in the roster" + (f"; {why}" if why else "")
        if why is None and member is None and not is_cell(result.student):
            why = "the name cannot be written to a table unchanged"
        if why is None and (mark := mark_of(result.student if member is None else member.student)) in seen:
            why = "the student already has a row"
        if why is not None:
            apart.add(result, why)
            continue
        seen.add(mark)
        yield result, member


@contextmanager
def beside(target: Target) -> Iterator[tuple[Any, Apart]]:
    """A writer of rows to a table, and what takes the results without a row."""
    with opened(target) as stream, Apart(target) as apart:
        yield table(stream), apart
