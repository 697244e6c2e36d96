"""Several workers at once: jobs from many threads, or a stream of jobs with the outcomes as they come."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import cache
from itertools import islice
from queue import LifoQueue
from types import TracebackType

from dofkit.base.workers.job import Job, JobOutcome
from dofkit.base.workers.processes import can_fork
from dofkit.base.workers.worker import MEMORY, Worker

#: Jobs taken from a stream ahead of the workers, for each of them.
AHEAD = 2


class Pool:
    """Up to ``workers`` workers (one for each core where that is not said), each started when it is first needed."""

    def __init__(self, workers: int | None = None, memory: int = MEMORY, modules: Sequence[str] = ()) -> None:
        self.workers = tuple(Worker(memory, modules) for _ in range(workers or cores()))
        self._free: LifoQueue[Worker] = LifoQueue()
        for worker in self.workers:
            self._free.put(worker)

    def fork(self) -> None:
        """Start all workers as copies of this process, where that is safe: in milliseconds, with all it has imported.

        Before any of them is used: their links are threads, beside which nothing is forked.
        """
        if can_fork():
            for worker in self.workers:
                worker.fork()

    def run(self, job: Job) -> JobOutcome:
        """Do one job, as soon as a worker is free: the one that was used last, which is warm."""
        worker = self._free.get()
        try:
            return worker.run(job)
        finally:
            self._free.put(worker)

    def map_unordered(self, jobs: Iterable[Job]) -> Iterator[tuple[Job, JobOutcome]]:
        """Every job with its outcome, as they finish; of ``jobs`` no more are taken than the workers can use soon.

        Where the caller stops early, what still runs is killed.
        """
        stream = iter(jobs)
        executor = ThreadPoolExecutor(len(self.workers))
        running: dict[Future[JobOutcome], Job] = {}
        try:
            while True:
                for job in islice(stream, AHEAD * len(self.workers) - len(running)):
                    running[executor.submit(self.run, job)] = job
                if not running:
                    return
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), future.result()
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            while any(not future.done() for future in running):
                self.close()
                wait(running, timeout=0.05)

    def close(self) -> None:
        """End all processes; a later job starts new ones."""
        for worker in self.workers:
            worker.kill()

    def __enter__(self) -> Pool:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def cores() -> int:
    """Processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _shared(process: int, module: str) -> Pool:
    del process
    return Pool(modules=(module,))


def shared(module: str) -> Pool:
    """The pool of this process whose workers have a module imported; a fork of the process has its own."""
    return _shared(os.getpid(), module)
