"""The worker's side: its limits of memory and time, and a loop that does one job after another.

Jobs come pickled from the parent, which this process trusts as it trusts the code that started it. What goes back is a
line of JSON: the parent takes nothing else from a process that has worked on other people's input.
"""

from __future__ import annotations

import json
import math
import os
import pickle
import signal
import sys
import threading
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from queue import SimpleQueue
from types import FrameType
from typing import Any

if sys.platform != "win32":
    import resource

#: Seconds beyond the limit of a job: the parent should be the one that ends it.
SPARE = 2.0
#: A process that holds more than this part of its memory is replaced after the job.
GROWN = 0.25
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


# Limits. On a platform without `resource` nothing is bounded.


def allow(seconds: float) -> None:
    """Let this process run for so many more seconds of clock and processor time; then the system ends it.

    This is for a worker whose parent is gone while it is inside a library: it hears nothing else.
    """
    if sys.platform != "win32":
        finite = seconds <= threading.TIMEOUT_MAX
        signal.setitimer(signal.ITIMER_REAL, seconds + SPARE if finite else 0.0)
        allow_processor(seconds + SPARE if finite else math.inf)


def allow_processor(seconds: float) -> None:
    """Let this process use so many more seconds of processor time; then the system ends it."""
    if sys.platform != "win32":
        finite = math.isfinite(seconds)
        _limit(resource.RLIMIT_CPU, math.ceil(time.process_time() + seconds) if finite else resource.RLIM_INFINITY)


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


def _bound(memory: int) -> None:
    """Bound the address space in bytes, leave no core file, and use one thread for linear algebra.

    Workers with a thread for each core would only wait for each other, and every thread takes address space.
    """
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    if sys.platform != "win32":
        _limit(resource.RLIMIT_CORE, 0)
        _limit(resource.RLIMIT_AS, memory)


if sys.platform != "win32":

    def _limit(what: int, soft: int) -> None:
        """Set a soft limit, as far as the hard one lets it; some systems refuse some of them."""
        try:
            _, hard = resource.getrlimit(what)
            if hard != resource.RLIM_INFINITY and (soft == resource.RLIM_INFINITY or soft > hard):
                soft = hard
            resource.setrlimit(what, (soft, hard))
        except (ValueError, OSError):
            pass


def _has_grown(memory: int) -> bool:
    """Whether this process holds much of the memory that it may have; False where the system does not say.

    The peak that `resource` knows will not do: it begins with that of the parent.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as pages:
            return int(pages.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") > GROWN * memory
    except (OSError, AttributeError, ValueError):
        return False


# Jobs


def main() -> None:
    """Serve over standard input and output: ``python -m dofkit.base.workers MEMORY MODULE...``."""
    down, up = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1):
        os.dup2(nowhere, standard)
    serve(down, up, int(sys.argv[1]), sys.argv[2:])


def serve(down: int, up: int, memory: int, modules: Sequence[str]) -> None:
    """Import ``modules``, then do the jobs that come ``down`` until the parent closes that pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "SIGALRM"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    _bound(memory)
    for module in modules:
        import_module(module)
    jobs: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_listen, args=(down, jobs), daemon=True).start()
    _send(up, "ready", None)
    while True:
        _do(jobs.get(), up, memory)


def _listen(down: int, jobs: SimpleQueue[bytes]) -> None:
    """Pass the jobs on; end this process with its parent, even in the middle of a job."""
    with open(down, "rb") as source:
        try:
            while True:
                jobs.put(pickle.load(source))
        except Exception:
            os._exit(0)


def _do(request: bytes, up: int, memory: int) -> None:
    """Do one job: send a ``value`` for everything that it returns or yields, then how it ended."""
    try:
        name, payload, (first, seconds) = pickle.loads(request)
        allow(first)
        returned = function_named(name)(payload)
        for value in returned if isinstance(returned, Iterator) else (returned,):
            _send(up, "value", value)
            allow(seconds)
        ended: tuple[str, Any] = "done", _has_grown(memory)
    except MemoryError:
        ended = "memory", None
    except Exception as error:
        trace = "".join(traceback.format_exception(error))
        ended = "failed", {"type": type(error).__name__, "message": str(error), "trace": trace}
    allow(math.inf)
    _send(up, *ended)


def function_named(name: str) -> Any:
    """The function that is called ``module:function``."""
    module, _, path = name.partition(":")
    found: Any = import_module(module)
    for part in path.split("."):
        found = getattr(found, part)
    return found


def _send(up: int, kind: str, value: Any) -> None:
    message = memoryview(json.dumps([kind, value]).encode() + b"\n")
    while message:
        message = message[os.write(up, message) :]
