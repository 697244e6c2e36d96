"""The command line, run in this process or in one that can be interrupted."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from dofkit.interface import answers, cli

#: Imported here already for workers that are forks of this process.
assert answers


def called(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit status, standard output, standard error."""
    status = 0
    try:
        cli.app(list(arguments))
    except SystemExit as stop:
        status = stop.code if isinstance(stop.code, int) else 0
    output = capsys.readouterr()
    return status, output.out, output.err


#: What a shell starts in the background ignores interrupts, and so does all that it starts.
_INTERRUPTIBLE = (
    "import signal\nfrom dofkit.interface import entry\nsignal.signal(2, signal.default_int_handler)\nentry.main()"
)


@contextmanager
def interruptible(*arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """The command line in a process that heeds SIGINT, and is killed where the test fails before it ends."""
    command = [sys.executable, "-c", _INTERRUPTIBLE, *arguments]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            yield process
        finally:
            process.kill()
