"""Runs over many items: several workers at once, here or in a cluster, and results that outlive an interrupted run."""

from __future__ import annotations

import atexit
import json
import os
import sqlite3
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, suppress
from functools import cache, partial
from pathlib import Path
from queue import LifoQueue
from typing import Any, Protocol, TypeVar

from dofkit.base.errors import DofkitError
from dofkit.base.workers import MEMORY, Job, JobOutcome, Worker, can_fork

#: The most calls under way, and the most bytes of waiting items, for each worker.
AHEAD, MOST_BYTES = 32, 4_000_000
#: How often a call is repeated on another machine if one is lost, and seconds to reach the scheduler.
RETRIES, CONNECTING = 10, 10.0
#: Seconds after which results are committed; a killed run loses at most the results of this time.
COMMITTING = 0.25


class StoppedError(DofkitError):
    """The run was stopped, or the cluster cannot do the work."""


class Pool(AbstractContextManager["Pool"]):
    """Up to ``workers`` workers (default: one for each core), each started when it is first needed."""

    def __init__(self, workers: int | None = None, memory: int = MEMORY, modules: Sequence[str] = ()) -> None:
        self.workers = tuple(Worker(memory, modules) for _ in range(workers or cores()))
        self.width = len(self.workers)
        self._free: LifoQueue[Worker] = LifoQueue()
        for worker in self.workers:
            self._free.put(worker)
        self._threads = ThreadPoolExecutor(self.width)
        self._calls: set[Future[Any]] = set()
        self._closed = False

    def fork(self) -> None:
        """Start all workers as copies of this process if that is safe: in milliseconds, with its imported modules.

        This must come before the first call, because calls run in threads, and a process with threads is not forked.
        """
        if can_fork():
            for worker in self.workers:
                worker.fork()

    def run(self, job: Job) -> JobOutcome:
        """Return the outcome of one job, done by the worker that became free last; wait if there is none.

        Raises StoppedError if the pool was closed.
        """
        worker = self._free.get()
        try:
            outcome = None if self._closed else worker.run(job)
        finally:
            self._free.put(worker)
        if outcome is None or self._closed:
            raise StoppedError("the run was stopped")
        return outcome

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Start a call, such as of `run`, in a thread of this process, and return its future."""
        call = self._threads.submit(function, *arguments)
        self._calls.add(call)
        call.add_done_callback(self._calls.discard)
        return call

    def close(self) -> None:
        """Kill all workers, and wait for the calls under way."""
        self._closed = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        while True:
            for worker in self.workers:
                worker.kill()
            if not (running := [call for call in self._calls.copy() if not call.done()]):
                break
            wait(running, timeout=0.05)
        self._threads.shutdown()

    def __exit__(self, *_error: object) -> None:
        self.close()


class Cluster(AbstractContextManager["Cluster"]):
    """The workers of a Dask scheduler. Raises StoppedError if `distributed` is missing or no scheduler answers."""

    def __init__(self, address: str) -> None:
        try:
            import distributed  # optional: the extra `cluster`

            library: Any = distributed
            self._client = library.Client(address, timeout=CONNECTING, set_as_default=False)
        except ImportError:
            raise StoppedError("--scheduler needs distributed: pip install 'dofkit[cluster]'") from None
        except (OSError, ValueError, TimeoutError) as error:
            raise StoppedError(f"the scheduler at {address} does not answer ({type(error).__name__})") from None
        self.width = max(1, sum(self._client.nthreads().values()))
        self._executor = self._client.get_executor(pure=False, retries=RETRIES)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Start a call on one of the machines; its future raises StoppedError if no machine completes it."""
        future: Future[Any] = Future()
        self._executor.submit(function, *arguments).add_done_callback(partial(_settle, future))
        return future

    def __exit__(self, *_error: object) -> None:
        self._client.close()


def _settle(future: Future[Any], ended: Future[Any]) -> None:
    """Give ``future`` the result of the call that ``ended`` in the cluster, or a StoppedError."""
    error = CancelledError() if ended.cancelled() else ended.exception()
    if error is None:
        future.set_result(ended.result())
        return
    reason = " ".join(str(error).split())[:200]
    future.set_exception(StoppedError(f"the cluster abandoned a task: {type(error).__name__}: {reason}"))


class Keyed(Protocol):
    """An item of a run."""

    @property
    def size(self) -> int:
        """The item's approximate size in bytes."""

    @property
    def key(self) -> str:
        """A text that differs for items of different content."""


Item = TypeVar("Item", bound=Keyed)
Result = TypeVar("Result")


def in_order(
    crew: Pool | Cluster, work: Callable[[Item], Result], items: Iterable[Item], journal: Journal | None = None
) -> Iterator[tuple[Item, Result]]:
    """Yield (item, result of ``work``) for all items in order; items are taken only as the crew needs them.

    A result in the journal is used, as json reads it; any other result is computed and written to the journal.
    """
    stream = iter(items)
    calls: deque[tuple[Item, Future[Result]]] = deque()
    while True:
        while len(calls) < AHEAD * crew.width and sum(item.size for item, _ in calls) < MOST_BYTES * crew.width:
            item = next(stream, None)
            if item is None:
                break
            earlier = None if journal is None else journal.result(item.key)
            calls.append((item, crew.submit(work, item) if earlier is None else _done(earlier)))
        if not calls:
            return
        item, call = calls.popleft()
        result = call.result()
        if journal is not None:
            journal.write(item.key, result)
        yield item, result


def _done(result: Any) -> Future[Any]:
    call: Future[Any] = Future()
    call.set_result(result)
    return call


def cores() -> int:
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _shared(process: int, module: str) -> Pool:
    del process  # a key of the cache: a fork of this process needs a pool of its own
    pool = Pool(modules=(module,))
    atexit.register(pool.close)
    return pool


def shared(module: str) -> Pool:
    """Return the pool of this process whose workers have imported ``module``; a fork of the process gets another."""
    return _shared(os.getpid(), module)


class BusyError(DofkitError):
    """Another run writes to the same file."""


def files_of(path: Path) -> list[Path]:
    """Return the files of a journal at ``path``: SQLite's second one exists only during writing."""
    return [path, path.with_name(path.name + "-journal")]


class Journal:
    """Results by key, in one SQLite file at ``path``.

    ``mark`` identifies the question that the results answer; a file with another mark, or a damaged one, is emptied. A
    result is a value that json can write. Raises BusyError if another run has the file open, and OSError.
    """

    def __init__(self, path: Path, mark: str) -> None:
        self.path = path
        self._committed = time.monotonic()
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            self._results = self._opened(mark)
        except sqlite3.OperationalError as error:
            if "locked" in str(error):
                raise BusyError(f"another run is writing to {path.with_suffix('')}") from None
            raise OSError(f"{path} cannot be written: {error}") from None
        except sqlite3.DatabaseError:
            path.unlink()
            self._results = self._opened(mark)

    def _opened(self, mark: str) -> sqlite3.Connection:
        """Return the open file, emptied if its mark differs, with all its results marked as not new."""
        opened = sqlite3.connect(self.path, timeout=0, isolation_level=None)
        try:
            # The operating system keeps what a killed process wrote; nothing has to survive a loss of power.
            opened.executescript("PRAGMA locking_mode = EXCLUSIVE; PRAGMA synchronous = OFF; BEGIN EXCLUSIVE; COMMIT;")
            opened.execute("CREATE TABLE IF NOT EXISTS mark (mark TEXT PRIMARY KEY)")
            opened.execute("CREATE TABLE IF NOT EXISTS results (key TEXT PRIMARY KEY, result TEXT, new INTEGER)")
            if opened.execute("SELECT mark FROM mark").fetchone() != (mark,):
                opened.executescript("DELETE FROM mark; DELETE FROM results")
                opened.execute("INSERT INTO mark VALUES (?)", (mark,))
            opened.execute("UPDATE results SET new = 0 WHERE new")
            opened.execute("BEGIN")
        except sqlite3.Error:
            opened.close()
            raise
        return opened

    def result(self, key: str) -> Any:
        """Return the result with this key; None if there is none."""
        row = self._results.execute("SELECT result FROM results WHERE key = ?", (key,)).fetchone()
        return None if row is None else json.loads(row[0])

    def write(self, key: str, result: Any) -> None:
        """Write a result, replacing an earlier one with the same key."""
        self._results.execute("INSERT OR REPLACE INTO results VALUES (?, ?, 1)", (key, json.dumps(result)))
        if time.monotonic() > self._committed + COMMITTING:
            self._results.execute("COMMIT")
            self._results.execute("BEGIN")
            self._committed = time.monotonic()

    def keep_written(self) -> None:
        """Delete the results of earlier runs that this run did not write again."""
        self._results.execute("DELETE FROM results WHERE NOT new")

    def close(self) -> None:
        """Close the file; another run may continue."""
        with suppress(sqlite3.Error):
            self._results.execute("COMMIT")
        self._results.close()

    def remove(self) -> None:
        """Remove the file: the next run begins anew."""
        self.close()
        self.path.unlink(missing_ok=True)
