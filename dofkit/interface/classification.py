"""The command `classify`: each file's report as it comes, progress beside it, and a summary of several."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import typer

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import many
from dofkit.interface.outcome import headline
from dofkit.interface.presentation import Telling
from dofkit.interface.progress import Progress
from dofkit.interface.show.faults import safe
from dofkit.interface.streams import ascii_only
from dofkit.interface.summary import Summary
from dofkit.interface.supervised import Printed, given_for_all, names_of, reports
from dofkit.methods.table import MethodName

#: Exit statuses: a scene is what it must not be; a file could not be read.
FAILED, UNREADABLE = 1, 2
#: Seconds between two looks at the files that are watched.
LOOKING = 0.2
#: Clears a terminal, and goes to its first line.
_CLEARED = "\x1b[2J\x1b[H"


class Asked(NamedTuple):
    """What the command was asked: the files, how to tell of them, and what it fails on.

    ``workers`` and ``scheduler``: who answers many scenes at once; ``out``: the folder for their reports.
    """

    files: tuple[str, ...]
    telling: Telling
    budget: float | None = None
    method: MethodName = "auto"
    certificate: str | None = None
    fail_on: tuple[str, ...] = ()
    workers: int | None = None
    scheduler: str | None = None
    out: Path | None = None


def echo(printed: Printed) -> None:
    """Print what there is of a file; what has colours was asked for them."""
    typer.echo(printed.out, nl=False, color=True)
    typer.echo(printed.err, nl=False, err=True, color=True)


def echo_count(errors: Sequence[int]) -> None:
    """Print how many errors there are in how many files, where there are several."""
    if sum(errors) > 1:
        typer.echo(f"{many(sum(errors), 'error')} in {many(sum(map(bool, errors)), 'file')}", err=True)


def classified(asked: Asked) -> int:
    """Print what there is of each file, and a summary of several; returns the exit status."""
    summary, errors = Summary(), []
    telling = asked.telling
    plain = not (telling.as_json or telling.only)
    if plain and telling.brief and asked.out is None:
        typer.echo(headline(max(map(len, names_of(asked.files)), default=0)))
    progress = Progress(len(asked.files), sys.stderr)
    for seconds, printed in _timed(asked, progress):
        echo(printed)
        summary.add(printed.outcome, seconds)
        errors.append(printed.errors)
    if plain and len(asked.files) > 1:
        lines = [safe(line) for line in summary.lines()]
        typer.echo("\n".join(["", *lines] if telling.brief and asked.out is None else lines))
    if any(errors):
        if plain and asked.out is None:
            echo_count(errors)
        return UNREADABLE
    return FAILED if summary.fails(asked.fail_on) else 0


def _timed(asked: Asked, progress: Progress) -> Iterator[tuple[float, Printed]]:
    """What is printed of each file, with the seconds that it took."""
    with closing(_stream(asked)) as stream:
        for file in asked.files:
            progress.begin(file)
            start = time.perf_counter()
            try:
                printed = next(stream)
            finally:
                progress.end()
            yield time.perf_counter() - start, printed
        next(stream, None)


def _stream(asked: Asked) -> Generator[Printed]:
    """What is printed of each file: one after another, or many at once."""
    if asked.workers is None and asked.scheduler is None and asked.out is None:
        return reports(asked.files, asked.telling, asked.budget, asked.method, asked.certificate)
    from dofkit.interface.many.run import Helpers, kept_reports, many_reports

    helpers, telling = Helpers(asked.workers, asked.scheduler), asked.telling
    telling = telling._replace(ascii_only=ascii_only())
    if asked.out is not None:
        telling = Telling(True, only=telling.only, without=telling.without, limits=telling.limits)
    given = given_for_all(asked.files, telling, asked.budget, asked.method)
    given = replace(given, certificate=asked.certificate)
    if asked.out is None:
        return many_reports(asked.files, given, helpers)
    return kept_reports(asked.files, given, helpers, asked.out)


def watched(asked: Asked) -> int:
    """The same again whenever a file changes, until it is interrupted. Raises ArgumentError where there is no file."""
    if not any(os.path.exists(file) for file in asked.files):
        raise ArgumentError("nothing can be watched: --watch takes files, no catalog names and not standard input")
    while True:
        seen = _state(asked.files)
        if sys.stdout.isatty():
            typer.echo(_CLEARED, nl=False)
        classified(asked)
        sys.stdout.flush()
        while _state(asked.files) == seen:
            time.sleep(LOOKING)


def _state(files: tuple[str, ...]) -> list[tuple[int, int] | None]:
    """When each file was last changed, and how long it is; None while it is not there."""
    found: list[tuple[int, int] | None] = []
    for file in files:
        try:
            told = os.stat(file)
            found.append((told.st_mtime_ns, told.st_size))
        except OSError:
            found.append(None)
    return found
