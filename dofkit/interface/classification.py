"""The command `classify`: prints reports or writes them to a folder, with progress and a summary of several files."""

from __future__ import annotations

import hashlib
import sys
import time
from collections import Counter
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing, nullcontext
from dataclasses import replace
from heapq import nlargest
from pathlib import Path
from typing import Any

import typer

from dofkit.base import __version__
from dofkit.base.runs import Journal
from dofkit.base.verdicts import VERDICTS
from dofkit.base.wording import many
from dofkit.interface.jobs import Printed, Request, Run, name_of_file, replies
from dofkit.interface.output import FAILED, FAILURES, UNREADABLE, Output, progress
from dofkit.interface.show.faults import safe

#: The file in the folder of ``--out`` to which reports are written.
REPORTS = "reports.jsonl"
#: The most scenes that a summary names, and the most of the slowest ones.
_MOST_NAMED, _SLOWEST = 8, 3
#: {finding: its name after a number of scenes}, where the word alone would be misread.
_FINDINGS = {"redundant": "with redundant constraints"}


def echo(printed: Printed) -> None:
    """Print the output and the errors of one file on the two streams; colours are kept."""
    typer.echo(printed.out, nl=False, color=True)
    typer.echo(printed.err, nl=False, err=True, color=True)


def echo_count(errors: Sequence[int]) -> None:
    """Print the number of errors and of files with errors on standard error, if there are several errors."""
    if sum(errors) > 1:
        typer.echo(f"{many(sum(errors), 'error')} in {many(sum(map(bool, errors)), 'file')}", err=True)


def classify_files(files: Sequence[str], request: Request, run: Run) -> int:
    """Print the output for each file, and a summary of several files; return the exit status."""
    summary, errors = Summary(), []
    output = request.output
    plain = not (output.as_json or output.only)
    if plain and output.brief and run.out is None:
        from dofkit.interface.show.terminal import headline  # which imports the report

        typer.echo(headline(output.name_width))
    for seconds, printed in _timed(files, request, run):
        echo(printed)
        summary.add(printed.outcome, seconds)
        errors.append(printed.errors)
    if plain and len(files) > 1:
        lines = [safe(line) for line in summary.lines()]
        typer.echo("\n".join(["", *lines] if output.brief and run.out is None else lines))
    if any(errors):
        if plain and run.out is None:
            echo_count(errors)
        return UNREADABLE
    return FAILED if summary.fails(run.fail_on) else 0


def _timed(files: Sequence[str], request: Request, run: Run) -> Iterator[tuple[float, Printed]]:
    """Yield (seconds, output) of each file, and show the progress meanwhile."""
    with closing(_stream(files, request, run)) as stream:
        for number, file in enumerate(files, 1):
            start = time.perf_counter()
            with progress(f"[{number}/{len(files)}] {file}", sys.stderr) if len(files) > 1 else nullcontext():
                printed = next(stream)
            yield time.perf_counter() - start, printed
        next(stream, None)


def _stream(files: Sequence[str], request: Request, run: Run) -> Generator[Printed]:
    """Yield the output for each file; if reports are written to a folder, it is empty."""
    if run.out is None:
        return replies("report_lines", files, request, run)
    as_json = Output(True, only=request.output.only)
    return kept_reports(files, replace(request, output=as_json), run, run.out)


def kept_reports(files: Sequence[str], request: Request, run: Run, folder: Path) -> Generator[Printed]:
    """Write the reports to a folder, one line each, and yield the counts of each file without texts.

    The journal beside the reports is kept: a later run answers only files that are new or have changed. Raises
    StoppedError, OSError and BusyError.
    """
    path = folder / REPORTS
    ledger = path.with_name(path.name + ".ledger")
    if not path.exists():
        ledger.unlink(missing_ok=True)
    with closing(Journal(ledger, _mark(request))) as journal:
        with path.open("wb") as reports, closing(replies("report_lines", files, request, run, journal)) as stream:
            for printed in stream:
                line = printed.out if printed.out.endswith("\n") else printed.out + "\n"
                reports.write(line.encode("utf-8", "surrogateescape"))
                reports.flush()
                yield printed._replace(out="", err="")
        journal.keep_written()


def _mark(request: Request) -> str:
    """Return a hash of the version and of the options, by which a journal belongs to a run."""
    options = (request.budget, request.method, request.output.only, request.without, request.limits, request.strict)
    return hashlib.blake2b(repr((__version__, *options, request.certificate)).encode(), digest_size=16).hexdigest()


def longest_name(files: Sequence[str]) -> int:
    """Return the length of the longest name that scenes get from their files."""
    return max((len(name_of_file(file)) for file in files), default=0)


class Summary:
    """Counts of the files so far by verdict and finding, with the slowest; only the names that are printed are kept."""

    def __init__(self) -> None:
        self._files, self._unread, self._seconds = 0, 0, 0.0
        self._verdicts, self._are = Counter[str](), Counter[str]()
        self._expecting, self._wrong = 0, 0
        self._named: list[str] = []
        self._slowest: list[tuple[float, int, str]] = []

    def add(self, outcome: Mapping[str, Any] | None, seconds: float) -> None:
        """Count one file: its outcome (None: the file could not be read), and its seconds, loading included."""
        self._files += 1
        self._seconds += seconds
        if outcome is None:
            self._unread += 1
            return
        self._verdicts[outcome["verdict"]] += 1
        self._are.update(outcome["is"])
        timed = (outcome.get("seconds", seconds), -self._files, outcome["scene"])
        self._slowest = nlargest(_SLOWEST, [*self._slowest, timed])
        if outcome.get("expects"):
            self._expecting += 1
        if outcome.get("expects") and outcome["unmet"]:
            self._wrong += 1
            self._named += [outcome["scene"]] if self._wrong <= _MOST_NAMED else []

    def fails(self, on: tuple[str, ...]) -> bool:
        """Return whether a scene has one of the findings ``on``."""
        return any(self._are[name] for name in on)

    def lines(self) -> Iterator[str]:
        """Yield the lines of the summary."""
        counts = [f"{self._verdicts[verdict]} {verdict}" for verdict in VERDICTS if self._verdicts[verdict]]
        if self._unread:
            counts.append(f"{self._unread} could not be read")
        yield f"{many(self._files, 'scene')} in {_seconds(self._seconds)}: {', '.join(counts)}"
        if self._expecting:
            right = self._expecting - self._wrong
            yield f"  agree with the answers in their files: {right} of {self._expecting}"
        if self._wrong:
            more = f" and {self._wrong - _MOST_NAMED} more" if self._wrong > _MOST_NAMED else ""
            yield f"  differ from the answers in their files: {', '.join(self._named)}{more}"
        findings = [f"{self._are[f]} {_FINDINGS.get(f, f)}" for f in FAILURES if self._are[f] and f != "undecided"]
        if findings:
            yield f"  {', '.join(findings)}"
        if self._slowest:
            yield f"  slowest: {', '.join(f'{scene} {_seconds(seconds)}' for seconds, _, scene in self._slowest)}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds >= 100 else f"{seconds:.2g} s" if seconds < 1 else f"{seconds:.1f} s"
