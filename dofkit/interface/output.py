"""Standard streams: their width and colours, how reports are printed, progress lines, and failures of commands."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, TextIO, cast

import typer
from rich.console import Console
from rich.text import Text

from dofkit.base.errors import DofkitError, Fault
from dofkit.interface.show.sheet import Colours

#: Exit statuses: a finding of ``--fail-on``; a file could not be read; after Ctrl-C.
FAILED, UNREADABLE, INTERRUPTED = 1, 2, 130
#: The findings that ``--fail-on`` may name.
FAILURES = ("inconsistent", "infeasible", "redundant", "undecided")


class Output(NamedTuple):
    """How a report is printed.

    ``as_json``: as JSON, with ASCII characters only if ``ascii_only``. ``brief``: on one line; ``how``: with the
    arguments for the answers; ``only``: these fields (empty: all). ``name_width``: length of the longest name.
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
    """Return the colours of a stream, or None if it has none; ``NO_COLOR`` and ``FORCE_COLOR`` are respected."""
    console = Console(file=stream)
    return None if console.no_color else cast("Colours | None", console.color_system)


@contextmanager
def progress(line: str, stream: TextIO) -> Iterator[None]:
    """Show a line such as ``[3/147] four-bar-linkage`` while the block runs, if the stream is a terminal."""
    console = Console(file=stream)
    if not stream.isatty() or console.is_dumb_terminal:
        yield
        return
    from rich.live import Live  # a run that is no terminal's needs none

    text = Text("".join(c if c.isprintable() else "?" for c in line), no_wrap=True, overflow="ellipsis")
    options: dict[str, Any] = {"auto_refresh": False, "redirect_stdout": False, "redirect_stderr": False}
    with Live(text, console=console, transient=True, **options):
        yield


@contextmanager
def failures_of(file: str | None) -> Iterator[None]:
    """Print an error that the ``with`` block raises, and end with status 2; ``file``: its subject if it names none."""
    try:
        yield
    except BrokenPipeError:  # nobody reads the output any more: not a fault of the file
        raise
    except (DofkitError, OSError) as error:
        from dofkit.interface.show.faults import complaint  # a command that succeeds needs no sentences about faults

        faults = tuple(getattr(error, "faults", None) or (Fault(re.sub(r"^\[Errno \d+\] ", "", str(error))),))
        sys.stdout.flush()
        about = getattr(error, "file", None) or file or getattr(error, "source", None) or "assignment"
        typer.echo(complaint(about, faults, None, colours_of(sys.stderr) is not None), err=True, color=True)
        raise typer.Exit(UNREADABLE) from None


def print_json(value: Any) -> None:
    """Print a value as one line of JSON."""
    typer.echo(json.dumps(value, ensure_ascii=Output.here().ascii_only))
