"""Two ways to a worker process: a fresh Python, or a fork of this one."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from dofkit.base.workers.child import serve

#: The folder that holds the package.
_ROOT = str(Path(__file__).resolve().parents[3])


class Process(Protocol):
    """A child process, with one end of a pipe ``down`` to it and of one ``up`` from it."""

    down: int
    up: int

    def poll(self) -> int | None:
        """The exit status, negative for a signal; None while it runs."""

    def kill(self) -> None:
        """End it at once and wait until it is gone."""

    def close(self) -> None:
        """Close this end of both pipes; nobody may be reading."""


class Spawned:
    """A fresh Python: it runs nothing of ``__main__`` and shares nothing with this process but two pipes."""

    def __init__(self, memory: int, modules: Sequence[str]) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "dofkit.base.workers", str(memory), *modules],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(search_path())},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._pipes = [pipe for pipe in (self._process.stdin, self._process.stdout) if pipe is not None]
        self.down, self.up = (pipe.fileno() for pipe in self._pipes)

    def poll(self) -> int | None:
        return self._process.poll()

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()

    def close(self) -> None:
        for pipe in self._pipes:
            pipe.close()


def search_path() -> list[str]:
    """Where this process looks for modules, but never the working folder: a file there is not to be run by chance."""
    found = [os.path.abspath(place) for place in sys.path if place]
    return found if _ROOT in found else [_ROOT, *found]


def can_fork() -> bool:
    """May this process be forked? Not where other threads may hold locks, nor where libraries forbid it."""
    return hasattr(os, "fork") and sys.platform != "darwin" and threading.active_count() == 1


class Forked:
    """A copy of this process, in milliseconds, with all that it has imported; it never returns to the caller's code."""

    def __init__(self, memory: int, modules: Sequence[str]) -> None:
        self._status: int | None = None
        down, self.down = os.pipe()
        self.up, up = os.pipe()
        self._pid = os.fork()
        if self._pid == 0:
            try:
                self.close()
                serve(down, up, memory, modules)
            finally:
                os._exit(1)
        os.close(down)
        os.close(up)

    def poll(self) -> int | None:
        return self._wait(os.WNOHANG)

    def kill(self) -> None:
        if self.poll() is None:
            os.kill(self._pid, signal.SIGKILL)
            self._wait(0)

    def _wait(self, options: int) -> int | None:
        if self._status is None:
            try:
                pid, status = os.waitpid(self._pid, options)
            except ChildProcessError:
                pid, status = self._pid, 0
            if pid:
                self._status = os.waitstatus_to_exitcode(status)
        return self._status

    def close(self) -> None:
        os.close(self.down)
        os.close(self.up)
