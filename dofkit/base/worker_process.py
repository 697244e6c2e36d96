"""The main loop of a worker process: it does one job after another, within limits, until its parent is gone."""

from __future__ import annotations

import json
import math
import os
import pickle
import signal
import sys
import threading
import traceback
from collections.abc import Iterator, Sequence
from importlib import import_module
from queue import SimpleQueue
from typing import Any

from dofkit.base.process_limits import allow, has_grown, set_limit

if sys.platform != "win32":
    import resource

_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def serve(down: int, up: int, memory: int, modules: Sequence[str]) -> None:
    """Import ``modules``, then do the jobs from the pipe ``down`` until the parent closes it; answer on ``up``.

    The address space is limited to ``memory`` bytes, there is no core file, and linear algebra has one thread, because
    the threads of several workers would wait for each other, and every thread takes address space.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "SIGALRM"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    if sys.platform != "win32":
        set_limit(resource.RLIMIT_CORE, 0)
        set_limit(resource.RLIMIT_AS, memory)
    for module in modules:
        import_module(module)
    jobs: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_listen, args=(down, jobs), daemon=True).start()
    _send(up, "ready", None)
    while True:
        _do(jobs.get(), up, memory)


def _listen(jobs_end: int, jobs: SimpleQueue[bytes]) -> None:
    """Put the jobs from a pipe into a queue; when the pipe closes, the parent is gone and this process exits."""
    with open(jobs_end, "rb") as source:
        try:
            while True:
                jobs.put(pickle.load(source))
        except Exception:
            os._exit(0)


def _do(request: bytes, up: int, memory: int) -> None:
    """Do one job: send to ``up`` a ``value`` message for each value, then ``done``, ``memory`` or ``failed``."""
    try:
        name, payload, (first, seconds) = pickle.loads(request)
        allow(first)
        returned = function_named(name)(payload)
        for value in returned if isinstance(returned, Iterator) else (returned,):
            _send(up, "value", value)
            allow(seconds)
        ended: tuple[str, Any] = "done", has_grown(memory)
    except MemoryError:
        ended = "memory", None
    except Exception as error:
        trace = "".join(traceback.format_exception(error))
        ended = "failed", {"type": type(error).__name__, "message": str(error), "trace": trace}
    allow(math.inf)
    _send(up, *ended)


def function_named(name: str) -> Any:
    """Return the function named ``module:function``, or ``module:Class.method``."""
    module, _, path = name.partition(":")
    value: Any = import_module(module)
    for attribute in path.split("."):
        value = getattr(value, attribute)
    return value


def _send(up: int, kind: str, value: Any) -> None:
    message = memoryview(json.dumps([kind, value]).encode() + b"\n")
    while message:
        message = message[os.write(up, message) :]


def main() -> None:
    """Serve over standard input and output: ``python -m dofkit.base.worker_process MEMORY MODULE...``."""
    down, up = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1):
        os.dup2(nowhere, standard)
    serve(down, up, int(sys.argv[1]), sys.argv[2:])


if __name__ == "__main__":
    main()
