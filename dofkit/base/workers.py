"""Worker processes that can be killed and replaced: a job never hangs, crashes or starves its caller.

A worker is a new Python process that does not run the caller's ``__main__``, so that scripts need no guard; for one
small file it is a fork, which starts faster. It limits its own memory and processor time (`process_limits`); its parent
watches the wall clock. Jobs come pickled from the parent, which the worker trusts. Values go back as lines of JSON,
because the parent must not unpickle data from a process that has worked on other people's input.

Two libraries were tried. In `loky` one crash fails every job that is running, and no job can be killed. `pebble` kills
and bounds jobs well, but the death of an idle worker ends its pool, a job that is cut short leaves no partial value,
scripts without a guard run twice, and its import takes a sixth of the time in which a small file is answered.

>>> from dofkit.base.runs import Pool
>>> with Pool(1) as pool:
...     pool.run(Job("operator:neg", 7, seconds=10.0)).value
-7
"""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, BinaryIO, Literal, TypeAlias

from dofkit.base.worker_process import serve

#: Bytes of address space that a worker may take.
MEMORY = 4 << 30
#: Seconds that a worker may take to start.
STARTING = 60.0
#: Seconds that a process may take to end after its pipe has ended.
_ENDING = 2.0
#: The folder that holds the package.
_ROOT = str(Path(__file__).resolve().parents[2])
#: The signals for a process whose clock or processor time has run out.
_LIMITS = {number for name in ("SIGALRM", "SIGPROF", "SIGXCPU") if (number := getattr(signal, name, None)) is not None}

#: A value that json can write, which is all that a worker returns.
Json = Any
#: A `subprocess.Popen` with both pipes, or a `_Fork`.
_Process: TypeAlias = Any

#: How a job ended. ``done``; ``failed``: it raised; ``overrun``: killed at its time limit; ``memory``: it needed more
#: memory than allowed; ``died``: its process ended; ``absent``: no process could be started.
Ended = Literal["done", "failed", "overrun", "memory", "died", "absent"]


@dataclass(frozen=True)
class Job:
    """A function to call with one argument in a worker, with time limits.

    ``function``: one that the worker can import, or its name ``module:function``. It returns a value that json can
    write, or is a generator of such values, of which the last one counts if the job is killed. ``payload``: the
    argument, which is pickled. ``seconds``: the wall-clock time from one value to the next after which the job is
    killed; ``first``: the time until the first value, if it differs.
    """

    function: str | Callable[[Any], Any]
    payload: Any
    seconds: float
    first: float | None = None

    @property
    def name(self) -> str:
        """``module:function``. Raises ValueError for a function that no other process can import."""
        if isinstance(self.function, str):
            return self.function
        module, name = self.function.__module__, self.function.__qualname__
        if module == "__main__" or "<" in name:
            raise ValueError(f"a worker cannot import {name!r} of {module!r}: put it into a module of its own")
        return f"{module}:{name}"

    @property
    def limits(self) -> tuple[float, float]:
        """(seconds until the first value, seconds from each value to the next)."""
        return self.seconds if self.first is None else self.first, self.seconds


@dataclass(frozen=True)
class JobOutcome:
    """The last value of a job (None: there was none), how it ended, and the reason unless it is ``done``.

    For a ``failed`` job ``error`` is the name of the exception's type, and ``trace`` its traceback.
    """

    value: Json
    ended: Ended
    reason: str = ""
    error: str = ""
    trace: str = ""

    @property
    def finished(self) -> bool:
        """Whether the value is the job's last one."""
        return self.ended == "done"


class Worker:
    """A process that does one job after another; it starts with the first job and ends with this object.

    ``memory``: its limit of address space in bytes; ``modules``: imported before the first job, as part of its start.
    """

    def __init__(self, memory: int = MEMORY, modules: Sequence[str] = ()) -> None:
        self.memory = memory
        self.modules = tuple(modules)
        self._forget()

    def _forget(self) -> None:
        """Begin without a process; after a fork, the parent's worker process remains the parent's."""
        self._owner = os.getpid()
        self._lock = threading.Lock()
        self._process: _Process | None = None
        self._lines: SimpleQueue[bytes] = SimpleQueue()
        self._reader: threading.Thread | None = None
        self._ready = False

    def fork(self) -> None:
        """Start now, as a copy of this process; a later replacement is a new Python process."""
        self._process = _Fork(self.memory, self.modules)

    def run(self, job: Job) -> JobOutcome:
        """Return the outcome of one job, which never raises; threads that call this wait for each other."""
        if self._owner != os.getpid():
            self._forget()
        request = pickle.dumps((job.name, job.payload, job.limits))
        with self._lock:
            if self._process is not None and self._process.poll() is not None:
                self._drop()
            outcome, keep = None, False
            try:
                outcome, keep = self._attempt(job, request)
                return outcome
            finally:
                if not keep:
                    self._drop()

    def kill(self) -> None:
        """End the process, whatever it does; the next job starts a new one."""
        process = self._process
        if process is not None and self._owner == os.getpid():
            process.kill()
            if self._lock.acquire(blocking=False):
                self._drop()
                self._lock.release()

    def _drop(self) -> None:
        """Kill the process, if there is one, and close its pipes."""
        process, self._process, self._ready = self._process, None, False
        if process is not None:
            process.kill()
            process.wait()
            reader, self._reader = self._reader, None
            with suppress(OSError):
                process.stdin.close()
            if reader is not None:
                reader.join(_ENDING)
            if reader is None or not reader.is_alive():
                process.stdout.close()

    def _attempt(self, job: Job, request: bytes) -> tuple[JobOutcome, bool]:
        """Return the outcome of a job, and whether the worker can do another one."""
        value: Json = None
        seconds, following = STARTING, job.limits[1]
        try:
            process = self._process = self._process or self._started()
        except OSError as error:
            return JobOutcome(None, "absent", f"no worker process could be started ({error})"), False
        if self._reader is None:
            self._lines = SimpleQueue()
            self._reader = threading.Thread(target=_collect, args=(process.stdout, self._lines), daemon=True)
            self._reader.start()
        try:
            if not self._ready and self._message(STARTING) is None:
                raise OSError
            self._ready = True
            seconds = job.limits[0]
            pickle.dump(request, process.stdin)
            process.stdin.flush()
            while (message := self._message(seconds)) is not None:
                kind, content = message
                if kind != "value":
                    return self._outcome(value, kind, content)
                value, seconds = content, following
            reason = _reason_of_end(process)
        except TimeoutError:
            reason = f"was killed after {seconds:.3g} s"
            if self._ready:
                return JobOutcome(value, "overrun", f"the worker process {reason}"), False
        except OSError:
            reason = _reason_of_end(process)
        if not self._ready:
            return JobOutcome(None, "absent", f"the worker process {reason} while it started"), False
        late = process.returncode is not None and -process.returncode in _LIMITS
        return JobOutcome(value, "overrun" if late else "died", f"the worker process {reason}"), False

    def _message(self, seconds: float) -> tuple[str, Json] | None:
        """Return the next (kind, content); None if the process has ended. Raises TimeoutError after ``seconds``."""
        try:
            line = self._lines.get(timeout=min(seconds, threading.TIMEOUT_MAX))
        except Empty:
            raise TimeoutError from None
        return tuple(json.loads(line)) if line.endswith(b"\n") else None

    def _outcome(self, value: Json, kind: str, content: Json) -> tuple[JobOutcome, bool]:
        """Return the outcome of a job that ended by itself, and whether the worker can do another one."""
        if kind == "done":
            return JobOutcome(value, "done"), not content
        if kind == "memory":
            wanted = f"more than {self.memory / (1 << 30):.3g} GiB of memory would have been needed"
            return JobOutcome(value, "memory", wanted), False
        error, message = str(content["type"]), " ".join(str(content["message"]).split())
        return JobOutcome(value, "failed", f"{error}: {message}" if message else error, error, content["trace"]), True

    def _started(self) -> _Process:
        """Return a new Python process, connected to this one by two pipes."""
        paths = [os.path.abspath(place) for place in sys.path if place]  # never the working folder
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "dofkit.base.worker_process", str(self.memory), *self.modules],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths if _ROOT in paths else [_ROOT, *paths])},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )


def can_fork() -> bool:
    """Return whether this process may be forked: no other thread may hold locks, and libraries must not forbid it."""
    return hasattr(os, "fork") and sys.platform != "darwin" and threading.active_count() == 1


class _Fork:
    """A fork of this process, with its imported modules; used like `subprocess.Popen`."""

    def __init__(self, memory: int, modules: Sequence[str]) -> None:
        down, requests = os.pipe()
        replies, up = os.pipe()
        self.returncode: int | None = None
        self._pid = os.fork()
        if self._pid == 0:
            try:
                os.close(requests)
                os.close(replies)
                serve(down, up, memory, modules)
            finally:
                os._exit(1)
        os.close(down)
        os.close(up)
        self.stdin, self.stdout = os.fdopen(requests, "wb"), os.fdopen(replies, "rb")

    def poll(self) -> int | None:
        return self.wait(getattr(os, "WNOHANG", 0))

    def kill(self) -> None:
        if self.poll() is None:
            os.kill(self._pid, signal.SIGKILL)

    def wait(self, options: int = 0) -> int | None:
        if self.returncode is None:
            try:
                pid, status = os.waitpid(self._pid, options)
            except ChildProcessError:
                pid, status = self._pid, 0
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode


def _collect(source: BinaryIO, lines: SimpleQueue[bytes]) -> None:
    """Put the lines of a process into a queue, and at its end an empty line; a queue allows waiting with a timeout."""
    with suppress(OSError, ValueError):
        for line in source:
            lines.put(line)
    lines.put(b"")


def _reason_of_end(process: _Process) -> str:
    """Return how a process that closed its pipe ended, as the end of a sentence about it."""
    until = time.monotonic() + _ENDING
    while (status := process.poll()) is None and time.monotonic() < until:
        time.sleep(0.005)
    if status is None:
        return "stopped answering"
    if status >= 0:
        return f"ended with exit status {status}"
    names = {number.value: number.name for number in signal.Signals}
    return f"was ended by {names.get(-status, f'signal {-status}')}"
