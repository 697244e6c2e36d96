"""Limits of this process: clock, processor time and memory. On a platform without `resource` nothing is bounded."""

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

#: Seconds beyond the limit of a job, so that the parent is the one that ends it.
SPARE = 2.0
#: A process that holds more than this share of its memory is replaced after the job.
GROWN = 0.25


def allow(seconds: float) -> None:
    """Let this process run for so many more seconds of clock and processor time; then the system ends it.

    This is for a worker whose parent is gone while it is inside a library: it notices nothing else.
    """
    if sys.platform != "win32":
        finite = seconds <= threading.TIMEOUT_MAX
        signal.setitimer(signal.ITIMER_REAL, seconds + SPARE if finite else 0.0)
        allow_processor(seconds + SPARE if finite else math.inf)


def allow_processor(seconds: float) -> None:
    """Let this process use so many more seconds of processor time; then the system ends it."""
    if sys.platform != "win32":
        finite = math.isfinite(seconds)
        set_limit(resource.RLIMIT_CPU, math.ceil(time.process_time() + seconds) if finite else resource.RLIM_INFINITY)


class LateError(BaseException):
    """The processor time allowed was used up. Nothing but who allowed it should catch this."""


@contextmanager
def interrupting(seconds: float) -> Iterator[None]:
    """Raise LateError in this block once it has used so many seconds of processor time, where there are such timers.

    Where a library's C code handles no signal, the system ends the process `SPARE` seconds later. Only in the main
    thread.
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
    """Set a soft limit, as far as the hard one lets it; some systems refuse some of them."""
    if sys.platform != "win32":
        with suppress(ValueError, OSError):
            _, hard = resource.getrlimit(what)
            if hard != resource.RLIM_INFINITY and (soft == resource.RLIM_INFINITY or soft > hard):
                soft = hard
            resource.setrlimit(what, (soft, hard))


def has_grown(memory: int) -> bool:
    """Return whether this process holds much of the memory that it may have; False where the system does not say.

    The peak that `resource` knows does not serve: it begins with that of the parent.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as pages:
            return int(pages.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") > GROWN * memory
    except (OSError, AttributeError, ValueError):
        return False
