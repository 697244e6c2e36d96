"""The worker's side: take a job, call its function, tell what it says; end when the parent does.

Jobs come pickled from the parent, which this process trusts as it trusts the code that started it. What goes back is
JSON: the parent takes nothing else from a process that has worked on other people's input.
"""

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

from dofkit.base.workers.limits import allow, bound, grown
from dofkit.base.workers.pipes import receive, send


def main() -> None:
    """A worker over standard input and output: ``python -m dofkit.base.workers MEMORY MODULE...``."""
    down, up = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1):
        os.dup2(nowhere, standard)
    serve(down, up, int(sys.argv[1]), sys.argv[2:])


def serve(down: int, up: int, memory: int, modules: Sequence[str]) -> None:
    """Answer the jobs that come ``down`` until the parent closes that pipe; first import ``modules``."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "SIGALRM"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
    bound(memory)
    for module in modules:
        import_module(module)
    jobs: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_listen, args=(down, jobs), daemon=True).start()
    _say(up, "ready", False)
    while True:
        _answer(jobs.get(), up, memory)


def _listen(down: int, jobs: SimpleQueue[bytes]) -> None:
    """Hand on the jobs; where the parent is gone, be gone too, even in the middle of one."""
    while (message := receive(down)) is not None:
        jobs.put(message)
    os._exit(0)


def _answer(message: bytes, up: int, memory: int) -> None:
    """Do one job: ``told`` for everything it says, then how it ended."""
    try:
        name, payload, (first, seconds) = pickle.loads(message)
        allow(first)
        said = function_named(name)(payload)
        for value in said if isinstance(said, Iterator) else (said,):
            _say(up, "told", value)
            allow(seconds)
        ended: tuple[str, Any] = "done", grown(memory)
    except MemoryError:
        ended = "memory", True
    except Exception as error:
        trace = "".join(traceback.format_exception(error))
        ended = "failed", {"type": type(error).__name__, "said": str(error), "trace": trace}
    allow(math.inf)
    _say(up, *ended)


def function_named(name: str) -> Any:
    """The function that is called ``module:function``."""
    module, _, path = name.partition(":")
    found: Any = import_module(module)
    for part in path.split("."):
        found = getattr(found, part)
    return found


def _say(up: int, kind: str, value: Any) -> None:
    send(up, json.dumps([kind, value]).encode())
