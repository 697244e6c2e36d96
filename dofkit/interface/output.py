"""Standard streams: what they can show, how reports are printed there, progress, and how a command fails."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, TextIO, cast

import typer
from rich.console import Console

from dofkit.base.errors import DofkitError, Fault
from dofkit.interface.show.sheet import Colours

#: Exit statuses: a finding of ``--fail-on``; something could not be read; after Ctrl-C.
FAILED, UNREADABLE, INTERRUPTED = 1, 2, 130
#: The findings that ``--fail-on`` may name.
FAILURES = ("inconsistent", "infeasible", "redundant", "undecided")
_ERASED = "\r\x1b[K"


class Output(NamedTuple):
    """How a report is printed.

    ``as_json``: as JSON, with ASCII characters only if ``ascii_only``. ``brief``: on one line; ``how``: with the
    arguments behind the answers; ``only``: these fields. ``name_width``: the length of the longest name of the files.
    ``width`` and ``colours`` are those of standard output (None: no colours), ``coloured_errors`` is about standard
    error.
    """

    as_json: bool = False
    ascii_only: bool = False
    brief: bool = False
    how: bool = False
    only: tuple[str, ...] = ()
    name_width: int = 0
    width: int = 80
    colours: Colours | None = None
    coloured_errors: bool = False

    @classmethod
    def here(cls, as_json: bool = False, brief: bool = False, how: bool = False) -> Output:
        """Return how to print on the standard streams of this process."""
        ascii_only = (sys.stdout.encoding or "").lower().replace("-", "") != "utf8"
        coloured_errors = colours_of(sys.stderr) is not None
        width = Console(file=sys.stdout).width
        return cls(as_json, ascii_only, brief, how, (), 0, width, colours_of(sys.stdout), coloured_errors)


def colours_of(stream: TextIO) -> Colours | None:
    """Return the colours of a stream, or None for none; ``NO_COLOR`` and ``FORCE_COLOR`` are respected."""
    console = Console(file=stream)
    return None if console.no_color else cast("Colours | None", console.color_system)


class Progress:
    """A line on a terminal such as ``[3/147] four-bar-linkage``, for several files; it disappears afterwards."""

    def __init__(self, files: int, stream: TextIO) -> None:
        self._files, self._begun = files, 0
        seen = files > 1 and stream.isatty() and not Console(file=stream).is_dumb_terminal
        self._stream = stream if seen else None
        self._width = Console(file=stream).width

    def begin(self, file: str) -> None:
        """Show a file as the next one."""
        self._begun += 1
        line = "".join(c if c.isprintable() else "?" for c in f"[{self._begun}/{self._files}] {file}")
        self._write(line[: self._width - 1])

    def end(self) -> None:
        """Erase the line, so that the report can be printed there."""
        self._write("")

    def _write(self, line: str) -> None:
        if self._stream is not None:
            self._stream.write(_ERASED + line)
            self._stream.flush()


@contextmanager
def failures_of(file: str | None) -> Iterator[None]:
    """Print an error about a file and end the command; an error that names a file of its own is about that file."""
    try:
        yield
    except BrokenPipeError:
        raise
    except (DofkitError, OSError) as error:
        from dofkit.interface.show.faults import complaint  # a command that succeeds needs no sentences about faults

        faults = tuple(getattr(error, "faults", None) or (Fault(str(error)),))
        sys.stdout.flush()
        about = getattr(error, "file", None) or file or getattr(error, "source", None) or "assignment"
        typer.echo(complaint(about, faults, None, colours_of(sys.stderr) is not None), err=True, color=True)
        raise typer.Exit(UNREADABLE) from None


def print_json(value: Any) -> None:
    """Print one line of JSON."""
    typer.echo(json.dumps(value, ensure_ascii=Output.here().ascii_only))
