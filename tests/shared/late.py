"""A worker's clock that runs out at a known place: a job that hangs is late when it hangs, and nothing else ever is."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from dofkit.base.workers import STARTING, Worker

#: Seconds that are never used up: whoever waits for something waits so long, and fails then.
LONG = 300.0
_SHORT = 0.02


def let_time_run_out(patch: pytest.MonkeyPatch, told: int = 0, mark: Path | None = None) -> list[float]:
    """Let one job be late as soon as it has told so many things and, where ``mark`` is given, something stands there.

    The limits to which the clock was set, one after the other; more come while jobs are done.
    """
    real, limits = Worker._message, list[float]()
    so_far, late = 0, False

    def message(worker: Worker, seconds: float) -> Any:
        nonlocal so_far, late
        if seconds == STARTING:
            return real(worker, seconds)
        limits.append(seconds)
        for _ in range(int(LONG / _SHORT)):
            if not late and so_far >= told and (mark is None or left(mark)):
                late = True
                raise TimeoutError
            with suppress(TimeoutError):
                found = real(worker, _SHORT)
                so_far = so_far + 1 if found is not None and found[0] == "value" else 0
                return found
        raise AssertionError("nothing is told, and nothing hangs")

    patch.setattr(Worker, "_message", message)
    return limits


def left(mark: Path) -> str:
    """What stands in a file; nothing where there is none."""
    return mark.read_text() if mark.exists() else ""
