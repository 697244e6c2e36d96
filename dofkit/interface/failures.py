"""How a command ends where it cannot do what it was asked, and JSON for whatever the output can show."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import typer

from dofkit.base.errors import DofkitError, Fault
from dofkit.interface.streams import ascii_only, colours_of

#: The exit status where something could not be read, and after Ctrl-C.
UNREADABLE, INTERRUPTED = 2, 130


@contextmanager
def failures_of(file: str | None) -> Iterator[None]:
    """Where nothing is done, tell why, of ``file`` (None: of what the error is about), and end the command.

    An error that names a ``file`` of its own is told of that.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except (DofkitError, OSError) as error:
        faults = tuple(getattr(error, "faults", None) or (Fault(str(error)),))
        sys.stdout.flush()
        about = getattr(error, "file", None) or file or getattr(error, "source", None) or "assignment"
        from dofkit.interface.show.faults import complaint

        told = complaint(about, faults, None, colours_of(sys.stderr) is not None)
        typer.echo(told, err=True, color=True)
        raise typer.Exit(UNREADABLE) from None


def print_json(value: Any) -> None:
    """One line of JSON."""
    typer.echo(json.dumps(value, ensure_ascii=ascii_only()))
