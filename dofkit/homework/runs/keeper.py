"""Workers that grade, and what becomes of answers that break them: those alone need a review, the rest goes on."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from types import TracebackType

from dofkit.base.workers import MEMORY, Job, JobOutcome
from dofkit.base.workers.batches import Worked
from dofkit.base.workers.stoppable_pool import StoppablePool
from dofkit.homework.answers.sources import Handed
from dofkit.homework.grading import Spot
from dofkit.homework.runs.batch import GradingTask, Orders, ResultLine, batch_results

#: What a student reads of an answer that broke its worker, by how that ended.
_ENDED = {
    "overrun": "grading it took too long or too much memory.",
    "memory": "grading it took too long or too much memory.",
    "died": "grading it took too long or too much memory.",
    "failed": "an internal error occurred.",
}


class Keeper:
    """Grades batches, from any thread, each in one of so many killable workers.

    ``memory``: the bytes of address space that each may take.
    """

    def __init__(self, orders: Orders, workers: int, memory: int = MEMORY) -> None:
        self.orders = orders
        self._pool = StoppablePool(workers, memory, modules=("dofkit.homework.runs.batch",))
        self._condemned: dict[Spot, str] = {}
        self._lock = threading.Lock()

    def fork(self) -> None:
        """Start the workers as copies of this process, where that is safe."""
        self._pool.fork()

    def grade(self, handed: Sequence[Handed]) -> Worked[list[ResultLine]]:
        """The lines of everything handed in, in order, and the seconds it took. Raises StoppedError."""
        start = time.monotonic()
        outcome = self._run(tuple(handed), careful=False)
        if outcome.finished:
            lines = [[ResultLine(*line) for line in lines] for lines in outcome.value["lines"]]
        else:
            lines = [self._lines_of(one) for one in handed]
        return Worked(lines, time.monotonic() - start)

    def _lines_of(self, one: Handed) -> list[ResultLine]:
        """One at a time, and telling of every answer before it is judged: so one that breaks the worker is found."""
        while True:
            outcome = self._run((one,), careful=True)
            if outcome.finished:
                return [ResultLine(*line) for line in outcome.value["lines"][0]]
            spot = outcome.value["next"] if outcome.value else None
            with self._lock:
                if spot is None or spot in self._condemned:
                    return [self._refusal(one, outcome)]
                self._condemned[spot] = _ENDED[outcome.ended]

    def _refusal(self, one: Handed, outcome: JobOutcome) -> ResultLine:
        return self.orders.refused(one.name, f"{one.place}: it could not be graded: {_ENDED[outcome.ended]}")

    def _run(self, handed: tuple[Handed, ...], careful: bool) -> JobOutcome:
        with self._lock:
            condemned = dict(self._condemned)
        task = GradingTask(self.orders, handed, condemned, careful)
        return self._pool.run(Job(batch_results, task, self.orders.wall))

    def close(self) -> None:
        """End all workers, whatever they do."""
        self._pool.close()

    def __enter__(self) -> Keeper:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
