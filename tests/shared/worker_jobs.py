"""Jobs for the tests of the workers: what answers, what hangs, and what dies. Nothing heavy is imported for all."""

from __future__ import annotations

import ctypes
import os
import re
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any


def same(payload: Any) -> Any:
    """What was given."""
    return payload


def process(_: Any) -> int:
    """The number of this process."""
    return os.getpid()


def sleep(seconds: float) -> float:
    """Wait, deaf to every deadline."""
    time.sleep(seconds)
    return seconds


def count(upto: int) -> Iterator[int]:
    """Tell 0, 1, 2, ... and then nothing for long."""
    yield from range(upto)
    time.sleep(60)


def alarms(steps: int) -> Iterator[list[float]]:
    """The seconds that are left until this process ends by itself, at each step, after what was told before."""
    found: list[float] = []
    for _ in range(steps):
        found.append(signal.getitimer(signal.ITIMER_REAL)[0])
        yield found


def until(path: str) -> str:
    """Wait until something stands in a file, and tell it."""
    late = time.monotonic() + 300
    while time.monotonic() < late:
        if Path(path).exists() and (found := Path(path).read_text()):
            return found
        time.sleep(0.01)
    raise TimeoutError(path)


def stuck(path: str = "") -> None:
    """Hang inside a library that never lets another thread run."""
    told(path)
    re.match("(a+)+$", "a" * 60 + "b")


def sketched(payload: Any) -> Iterator[Any]:
    """What a scene is asked for, hanging inside a library after the sketch."""
    from dofkit.methods.classify import worker_stages

    yield next(worker_stages(payload))
    stuck()


def busy(path: str = "") -> None:
    """Hang in Python."""
    told(path)
    while True:
        pass


def told(path: str) -> None:
    """Leave the number of this process in a file."""
    if path:
        Path(path).write_text(str(os.getpid()))


def hog(_: Any) -> int:
    """Take memory without end."""
    taken = []
    while True:
        taken.append(bytearray(1 << 24))


KEPT: list[bytearray] = []


def keep(size: int) -> int:
    """Take memory for good, and tell the number of this process."""
    KEPT.append(bytearray(b"1" * size))
    return os.getpid()


def hog_in_c(_: Any) -> int:
    """The same inside a library, which knows no MemoryError."""
    import flint

    return int((flint.fmpz(3) ** (1 << 33)).bit_length())


def crash(_: Any) -> None:
    """Read what is not there."""
    ctypes.string_at(0)


def fail(said: str) -> None:
    """Raise."""
    raise KeyError(said)


def leave(status: int) -> None:
    """End the process."""
    os._exit(status)


def unwritable(_: Any) -> object:
    """Answer what json cannot write."""
    return object()
