"""Functions called elsewhere, many at once: by threads that each mind a worker here, or by a cluster."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, wait
from functools import partial
from types import TracebackType
from typing import Any, Protocol

from dofkit.base.errors import DofkitError

#: How often a task is given to another machine where the first is lost, and seconds to reach the scheduler.
RETRIES, CONNECTING = 10, 10.0


class StoppedError(DofkitError):
    """Work was stopped, or nobody could be found to do it."""


class Crew(Protocol):
    """Who calls functions elsewhere, ``width`` at a time."""

    @property
    def width(self) -> int:
        """How many at a time."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin with a call."""


class Threads:
    """Threads of this process, each waiting for a worker; ``close`` ends the workers, whatever they do."""

    def __init__(self, width: int, close: Callable[[], None]) -> None:
        self.width = width
        self._close = close
        self._threads = ThreadPoolExecutor(width)
        self._running: set[Future[Any]] = set()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin with a call, as soon as a thread is free."""
        future = self._threads.submit(function, *arguments)
        self._running.add(future)
        future.add_done_callback(self._running.discard)
        return future

    def __enter__(self) -> Threads:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._threads.shutdown(wait=False, cancel_futures=True)
        self._close()
        while running := [future for future in self._running.copy() if not future.done()]:
            self._close()
            wait(running, timeout=0.05)


class Cluster:
    """The workers of a Dask scheduler. Raises StoppedError where `distributed` is missing or nobody answers."""

    def __init__(self, address: str) -> None:
        try:
            import distributed

            library: Any = distributed
            self._client = library.Client(address, timeout=CONNECTING, set_as_default=False)
        except ImportError:
            raise StoppedError("--scheduler needs distributed: pip install 'dofkit[cluster]'") from None
        except (OSError, ValueError, TimeoutError) as error:
            raise StoppedError(f"the scheduler at {address} does not answer ({type(error).__name__})") from None
        self.width = max(1, sum(self._client.nthreads().values()))
        self._executor = self._client.get_executor(pure=False, retries=RETRIES)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin with a call, on any of the machines; its future raises StoppedError where none of them does it."""
        future: Future[Any] = Future()
        self._executor.submit(function, *arguments).add_done_callback(partial(_settle, future))
        return future

    def __enter__(self) -> Cluster:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close()


def _settle(future: Future[Any], ended: Future[Any]) -> None:
    """Hand on what a call in the cluster gave, or that it was given up."""
    error = CancelledError() if ended.cancelled() else ended.exception()
    if error is None:
        future.set_result(ended.result())
        return
    reason = " ".join(str(error).split())[:200]
    future.set_exception(StoppedError(f"the cluster abandoned a batch: {type(error).__name__}: {reason}"))
