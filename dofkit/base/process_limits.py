"""Limits of this process: clock, processor time and memory. On a platform without `resource` there are none."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

if sys.platform != "win32":
    import resource

#: Seconds beyond the limit of a job until the system ends the process, so that usually the parent ends it first.
SPARE = 2.0
#: A process that uses more than this share of its allowed memory is replaced after the job.
GROWN = 0.25


def allow(seconds: float) -> None:
    """Limit this process to ``seconds`` more of clock and of processor time; then the system ends it.

    This ends a worker whose parent is gone while the worker is inside a library call.
    """
    if sys.platform != "win32":
        finite = seconds <= threading.TIMEOUT_MAX
        signal.setitimer(signal.ITIMER_REAL, seconds + SPARE if finite else 0.0)
        allow_processor(seconds + SPARE if finite else math.inf)


def allow_processor(seconds: float) -> None:
    """Limit this process to ``seconds`` more of processor time; then the system ends it."""
    if sys.platform != "win32":
        finite = math.isfinite(seconds)
        set_limit(resource.RLIMIT_CPU, math.ceil(time.process_time() + seconds) if finite else resource.RLIM_INFINITY)


class LateError(BaseException):
    """The processor time of an `interrupting` block is used up; only the caller of `interrupting` should catch this."""


@contextmanager
def interrupting(seconds: float) -> Iterator[None]:
    """Raise LateError within the block after ``seconds`` of processor time, on platforms with such timers.

    If a library's C code does not handle the signal, the system ends the process `SPARE` seconds later. For the main
    thread only.
    """
    if sys.platform == "win32":
        yield
        return
    allow_processor(seconds + SPARE)
    before = signal.signal(signal.SIGPROF, _raise_late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        allow_processor(math.inf)


def _raise_late(number: int, frame: FrameType | None) -> None:
    raise LateError(signal.Signals(number).name)


def set_limit(what: int, soft: int) -> None:
    """Set the soft limit of the resource ``what``, at most its hard limit; a refusal by the system is ignored."""
    if sys.platform != "win32":
        with suppress(ValueError, OSError):
            _, hard = resource.getrlimit(what)
            if hard != resource.RLIM_INFINITY and (soft == resource.RLIM_INFINITY or soft > hard):
                soft = hard
            resource.setrlimit(what, (soft, hard))


def has_grown(memory: int) -> bool:
    """Return whether this process uses more than `GROWN` of ``memory`` bytes; False if the system does not say.

    The peak of `resource` cannot be used, because it includes the parent's.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as pages:
            return int(pages.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") > GROWN * memory
    except (OSError, AttributeError, ValueError):
        return False
