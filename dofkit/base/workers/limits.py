"""What a process may take: memory, processor time, no core files. Where the platform cannot say, nothing is bounded."""

from __future__ import annotations

import math
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

if sys.platform != "win32":
    import resource

#: Seconds beyond the limit of a job: the parent should be the one that ends it.
SPARE = 2.0
#: Longer than this is without end.
LONGEST = 1e8
#: A process that holds more than this part of its memory is replaced after the job.
GROWN = 0.25
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def bound(memory: int) -> None:
    """Bound this process's address space in bytes, and let it leave no core file; one thread for linear algebra.

    Many workers with a thread for each core would only wait for each other, and every thread takes address space.
    """
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    if sys.platform != "win32":
        _set(resource.RLIMIT_CORE, 0)
        _set(resource.RLIMIT_AS, memory)


def allow(seconds: float) -> None:
    """Let this process run for so many more seconds, by the clock and of processor time; then the system ends it.

    This is for a worker whose parent is gone and that is deep inside a library: it hears nothing else.
    """
    if sys.platform != "win32":
        finite = seconds < LONGEST
        signal.setitimer(signal.ITIMER_REAL, seconds + SPARE if finite else 0.0)
        until = math.ceil(time.process_time() + seconds + SPARE) if finite else resource.RLIM_INFINITY
        _set(resource.RLIMIT_CPU, until)


def allow_processor(seconds: float) -> None:
    """Let this process use so many more seconds of processor time; then the system ends it."""
    if sys.platform != "win32":
        _set(resource.RLIMIT_CPU, math.ceil(time.process_time() + seconds))


class LateError(BaseException):
    """The processor time allowed was used up. Nothing but who allowed it should catch this."""


@contextmanager
def interrupting(seconds: float) -> Iterator[None]:
    """Raise LateError in this block once it has used so many seconds of processor time, where there are such timers.

    A library that hears no signals meanwhile is ended by the system soon after. Only in the main thread.
    """
    if sys.platform == "win32":
        yield
        return
    allow_processor(seconds + SPARE)
    before = signal.signal(signal.SIGPROF, _late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        _set(resource.RLIMIT_CPU, resource.RLIM_INFINITY)


def _late(number: int, frame: FrameType | None) -> None:
    raise LateError(signal.Signals(number).name)


def grown(memory: int) -> bool:
    """Does this process hold much of the memory that it may have? False where the system does not say.

    The peak that `resource` knows will not do: it begins with that of the parent.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as pages:
            return int(pages.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") > GROWN * memory
    except (OSError, AttributeError, ValueError):
        return False


if sys.platform != "win32":

    def _set(what: int, soft: int) -> None:
        """Set the soft limit, as far as the hard one lets it; some systems refuse some of them."""
        try:
            _, hard = resource.getrlimit(what)
            if hard != resource.RLIM_INFINITY and (soft == resource.RLIM_INFINITY or soft > hard):
                soft = hard
            resource.setrlimit(what, (soft, hard))
        except (ValueError, OSError):
            pass
