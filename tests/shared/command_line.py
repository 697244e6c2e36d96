"""The command line, run in this process."""

from __future__ import annotations

import pytest

from dofkit.interface import cli


def called(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit status, standard output, standard error."""
    status = 0
    try:
        cli.app(list(arguments))
    except SystemExit as stop:
        status = stop.code if isinstance(stop.code, int) else 0
    told = capsys.readouterr()
    return status, told.out, told.err
