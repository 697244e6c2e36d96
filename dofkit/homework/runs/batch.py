"""Grades submissions by workers that can be killed: an answer that breaks a worker needs a review."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import NamedTuple, TypeAlias

from dofkit.base.process_limits import allow_processor
from dofkit.base.runs import Cluster, Journal, Pool, StoppedError, in_order
from dofkit.base.workers import MEMORY, Job, Json
from dofkit.homework.answers.sources import Handed
from dofkit.homework.assignment import Prepared
from dofkit.homework.grading import ANSWER_SECONDS, Grader, Identity
from dofkit.homework.result import Result, json_line

#: What a worker imports before its first job.
MODULES = ("dofkit.homework.runs.batch",)
_TOO_MUCH = "grading it took too long or too much memory."
#: {how a worker ended: feedback on the answer that broke it}.
_ENDED = {"overrun": _TOO_MUCH, "memory": _TOO_MUCH, "died": _TOO_MUCH, "failed": "an internal error occurred."}


@dataclass(frozen=True)
class Orders:
    """How to grade: the pickled assignment, and limits in seconds of processor time.

    ``seconds``: for one answer, which then needs a review; ``hard``: for one answer, after which its process is killed.
    ``wall``: the limit by the clock for a submission. ``check_only``: whether answers are only read.
    """

    assignment: bytes
    max_score: float
    check_only: bool = False
    seconds: float = ANSWER_SECONDS
    hard: float = 2 * ANSWER_SECONDS
    wall: float = 60.0

    @classmethod
    def of(cls, prepared: Prepared, check_only: bool = False) -> Orders:
        """Return the orders to grade an assignment."""
        return cls(pickle.dumps(prepared), prepared.max_score, check_only)


class GradingTask(NamedTuple):
    """A submission to be graded. ``condemned``: {identity: reason} of answers that are not judged."""

    orders: Orders
    handed: Handed
    condemned: Mapping[Identity, str]


def graded_line(task: GradingTask) -> Iterator[Json]:
    """Yield {"next": identity} before each new answer, and at the end {"line": result as JSON}."""
    grader = _grader(task.orders)
    grader.condemned = task.condemned
    allow_processor(task.orders.hard)
    for step in grader.steps(task.handed.submission(grader.prepared.columns())):
        yield {"line": json_line(step)} if isinstance(step, Result) else {"next": step}
        allow_processor(task.orders.hard)


@lru_cache(maxsize=2)
def _grader(orders: Orders) -> Grader:
    prepared: Prepared = pickle.loads(orders.assignment)
    return Grader(prepared, orders.seconds, check_only=orders.check_only)


#: Yields (submission, line of its result) in order; a journal keeps the lines.
Grading: TypeAlias = Callable[[Iterable[Handed], Journal | None], Iterator[tuple[Handed, str]]]


class Keeper:
    """Grades submissions from any thread by the workers of a pool."""

    def __init__(self, orders: Orders, pool: Pool) -> None:
        self.orders = orders
        self.pool = pool
        self._condemned: dict[Identity, str] = {}

    def grade(self, handed: Handed) -> str:
        """Return the result of a submission as a line of JSON. Raises StoppedError.

        An answer that breaks two workers, the second of them new, is not judged again.
        """
        suspects: list[Identity | None] = []
        while True:
            condemned = dict(self._condemned)
            outcome = self.pool.run(Job(graded_line, GradingTask(self.orders, handed, condemned), self.orders.wall))
            if outcome.ended == "absent":
                raise StoppedError(outcome.reason)
            if outcome.finished:
                return str(outcome.value["line"])
            identity = outcome.value.get("next") if outcome.value else None
            if identity not in suspects:
                suspects.append(identity)
            elif identity is None or identity in condemned:
                error = f"{handed.place}: it could not be graded: {_ENDED[outcome.ended]}"
                return json_line(Result.refused(handed.name, self.orders.max_score, error))
            else:
                self._condemned[identity] = _ENDED[outcome.ended]


def grade_there(orders: Orders, handed: Handed) -> str:
    """Return the result of a submission as a line of JSON, by a machine of a cluster with its own workers."""
    return _keeper(orders).grade(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, Pool(modules=MODULES))


@contextmanager
def grading(orders: Orders, workers: int | None, scheduler: str | None) -> Iterator[Grading]:
    """Yield the function that grades by workers of this machine, or of a Dask cluster. Raises StoppedError."""
    if scheduler is not None:
        with Cluster(scheduler) as cluster:
            yield partial(in_order, cluster, partial(grade_there, orders))
        return
    with Pool(workers, MEMORY, MODULES) as pool:
        pool.fork()
        yield partial(in_order, pool, Keeper(orders, pool).grade)
