"""One worker: it takes a job at a time, and is killed and replaced where the job goes past its limits."""

from __future__ import annotations

import json
import os
import pickle
import signal
import threading
import time
import weakref
from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue

from dofkit.base.workers.job import Job, JobOutcome, Json
from dofkit.base.workers.pipes import receive, send
from dofkit.base.workers.processes import Forked, Process, Spawned

#: Bytes of address space that a worker may take.
MEMORY = 4 << 30
#: Seconds that a worker may take to start.
STARTING = 60.0
_JOINING = 2.0
#: What the system sends a process whose clock, or processor time, has run out.
_LIMITS = {number for name in ("SIGALRM", "SIGPROF", "SIGXCPU") if (number := getattr(signal, name, None)) is not None}


class Worker:
    """A process that does one job after another; it starts with the first one and ends with this object.

    ``memory``: the bytes of address space that it may take; ``modules``: what it imports before the first job, which
    counts as its start; ``fork``: a copy of this process where that is safe, instead of a fresh Python.
    """

    def __init__(self, memory: int = MEMORY, modules: Sequence[str] = (), *, fork: bool = False) -> None:
        self.memory = memory
        self.modules = tuple(modules)
        self._new: Callable[[int, Sequence[str]], Process] = Forked if fork else Spawned
        self._owner = os.getpid()
        self._lock = threading.Lock()
        self._link: _Link | None = None
        self._begun: Process | None = None

    def fork(self) -> None:
        """Start now, as a copy of this process; what replaces it later is a fresh Python all the same."""
        self._begun = Forked(self.memory, self.modules)

    def run(self, job: Job) -> JobOutcome:
        """Do one job; threads wait for each other. Never raises for what the job does; it is tried once."""
        if self._owner != os.getpid():
            self._forget()
        with self._lock:
            message = pickle.dumps((job.name, job.payload, job.limits))
            link = self._open_link()
            if isinstance(link, JobOutcome):
                return link
            keep = False
            try:
                outcome, keep = self._outcome_of(link, message, job)
                return outcome
            finally:
                if not keep:
                    self.kill()

    def kill(self) -> None:
        """End the process, whatever it does; the next job starts a new one."""
        link, self._link = self._link, None
        if link is not None:
            link.end()
        begun, self._begun = self._begun, None
        if begun is not None:
            begun.kill()
            begun.close()

    def _forget(self) -> None:
        """In a fork of the process that started it: that one's worker is left to it."""
        self._owner, self._lock, self._link, self._begun = os.getpid(), threading.Lock(), None, None

    def _open_link(self) -> _Link | JobOutcome:
        if self._link is not None and self._link.process.poll() is not None:
            self.kill()
        if self._link is None:
            try:
                begun, self._begun = self._begun, None
                link = _Link(begun or self._new(self.memory, self.modules))
            except OSError as error:
                return JobOutcome(None, "absent", f"no worker process could be started ({error})")
            self._link, link.finalizer = link, weakref.finalize(self, link.end)
            why = link.failure_to_start()
            if why:
                self.kill()
                return JobOutcome(None, "absent", f"the worker process {why} while it started")
            return link
        return self._link

    def _outcome_of(self, link: _Link, message: bytes, job: Job) -> tuple[JobOutcome, bool]:
        """The outcome, and whether the worker is good for another job."""
        value: Json = None
        limit, following = job.limits
        try:
            send(link.process.down, message)
            while True:
                heard = link.heard(limit)
                if heard is None:
                    return link.outcome(value), False
                kind, said = heard
                if kind != "told":
                    return self._final_outcome(value, kind, said)
                value, limit = said, following
        except Empty:
            return JobOutcome(value, "overrun", f"the worker process was killed after {limit:.3g} s"), False
        except OSError:
            return link.outcome(value), False

    def _final_outcome(self, value: Json, kind: str, said: Json) -> tuple[JobOutcome, bool]:
        if kind == "done":
            return JobOutcome(value, "done"), not said
        if kind == "memory":
            wanted = f"more than {self.memory / (1 << 30):.3g} GiB of memory would have been needed"
            return JobOutcome(value, "memory", wanted), False
        error, told = str(said["type"]), " ".join(str(said["said"]).split())
        return JobOutcome(value, "failed", f"{error}: {told}" if told else error, error, str(said["trace"])), True


class _Link:
    """A process, and what it tells, which a thread of its own collects: waiting for it can be given up."""

    def __init__(self, process: Process) -> None:
        self.process = process
        self.finalizer: weakref.finalize[[], Worker] | None = None
        self._owner = os.getpid()
        self._ending = threading.Lock()
        self._messages: SimpleQueue[bytes | None] = SimpleQueue()
        self._reader = threading.Thread(target=_collect, args=(process.up, self._messages), daemon=True)
        self._reader.start()

    def heard(self, seconds: float) -> tuple[str, Json] | None:
        """The next thing that it tells; None where it tells no more. Raises Empty after so many seconds."""
        message = self._messages.get(timeout=min(seconds, threading.TIMEOUT_MAX))
        if message is None:
            return None
        kind, said = json.loads(message)
        return str(kind), said

    def failure_to_start(self) -> str | None:
        """Wait until it is ready; why it is not."""
        try:
            return None if self.heard(STARTING) else self.how()
        except Empty:
            return f"was killed after {STARTING:.3g} s"

    def outcome(self, value: Json) -> JobOutcome:
        """Of a job in which the process ended: by a limit that it had set itself, or otherwise."""
        reason = f"the worker process {self.how()}"
        status = self.process.poll()
        return JobOutcome(value, "overrun" if status is not None and -status in _LIMITS else "died", reason)

    def how(self) -> str:
        """How the process ended, as the end of a sentence."""
        until = time.monotonic() + _JOINING
        while (status := self.process.poll()) is None and time.monotonic() < until:
            time.sleep(0.005)
        if status is None:
            return "stopped answering"
        if status >= 0:
            return f"ended with exit status {status}"
        known = {number.value: number.name for number in signal.Signals}
        return f"was ended by {known.get(-status, f'signal {-status}')}"

    def end(self) -> None:
        """Kill the process, if this one is its parent, and close the pipes."""
        if self._owner != os.getpid():
            return
        with self._ending:
            if self.finalizer is not None:
                self.finalizer.detach()
            self.process.kill()
            if self._reader is not threading.current_thread():
                self._reader.join(_JOINING)
            if not self._reader.is_alive():
                self.process.close()


def _collect(up: int, messages: SimpleQueue[bytes | None]) -> None:
    while (message := receive(up)) is not None:
        messages.put(message)
    messages.put(None)
