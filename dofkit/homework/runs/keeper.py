"""Grading in workers, and what becomes of answers that break them: those alone need a review, the rest goes on."""

from __future__ import annotations

import threading
from functools import lru_cache

from dofkit.base.runs import Pool, StoppedError
from dofkit.base.workers import Job, JobOutcome
from dofkit.homework.answers.sources import Handed
from dofkit.homework.grading import Spot
from dofkit.homework.runs.batch import GradingTask, Orders, ResultLine, graded_lines

#: What a worker imports before its first job.
MODULES = ("dofkit.homework.runs.batch",)
_TOO_MUCH = "grading it took too long or too much memory."
#: What a student reads of an answer that broke its worker, by how that ended.
_ENDED = {"overrun": _TOO_MUCH, "memory": _TOO_MUCH, "died": _TOO_MUCH, "failed": "an internal error occurred."}


class Keeper:
    """Grades what was handed in, from any thread, by the workers of a pool."""

    def __init__(self, orders: Orders, pool: Pool) -> None:
        self.orders = orders
        self._pool = pool
        self._condemned: dict[Spot, str] = {}
        self._lock = threading.Lock()

    def grade(self, handed: Handed) -> list[ResultLine]:
        """The line of each submission. Raises StoppedError.

        An answer that breaks two workers, of which the second is a fresh one, is not judged again.
        """
        suspects: list[Spot | None] = []
        while True:
            with self._lock:
                condemned = dict(self._condemned)
            task = GradingTask(self.orders, handed, condemned)
            outcome = self._pool.run(Job(graded_lines, task, self.orders.wall))
            if outcome.ended == "absent":
                raise StoppedError(outcome.reason)
            if outcome.finished:
                return [ResultLine(*line) for line in outcome.value["lines"]]
            spot = outcome.value["next"] if outcome.value else None
            if spot not in suspects:
                suspects.append(spot)
            elif spot is None or spot in condemned:
                return [self._refusal(handed, outcome)]
            else:
                with self._lock:
                    self._condemned[spot] = _ENDED[outcome.ended]

    def _refusal(self, handed: Handed, outcome: JobOutcome) -> ResultLine:
        error = f"{handed.place}: it could not be graded: {_ENDED[outcome.ended]}"
        return self.orders.refused(handed.name, error)


def grade_there(orders: Orders, handed: Handed) -> list[ResultLine]:
    """The same on a machine of a cluster, by killable workers of its own."""
    return _keeper(orders).grade(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, Pool(modules=MODULES))
