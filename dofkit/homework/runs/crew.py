"""Who grades batches: workers on this machine, or a Dask cluster; there a killable worker of ours does it too."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache, partial

from dofkit.base.workers.crews import Cluster, Crew, Threads
from dofkit.base.workers.pool import cores
from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders
from dofkit.homework.runs.keeper import Graded, Keeper


@dataclass(frozen=True)
class GradingCrew:
    """Grades batches, ``width`` at a time: ``crew`` calls ``grade`` with each."""

    crew: Crew
    grade: Callable[[Sequence[Handed]], Graded]

    @property
    def width(self) -> int:
        """How many batches at a time."""
        return self.crew.width

    def submit(self, handed: Sequence[Handed]) -> Future[Graded]:
        """Begin with a batch; its future raises StoppedError where nobody grades it."""
        return self.crew.submit(self.grade, tuple(handed))


@contextmanager
def local_crew(keeper: Keeper, workers: int) -> Iterator[GradingCrew]:
    """Workers on this machine."""
    with Threads(workers, keeper.close) as threads:
        yield GradingCrew(threads, keeper.grade)


@contextmanager
def cluster_crew(address: str, orders: Orders) -> Iterator[GradingCrew]:
    """The machines of a Dask scheduler, each with workers of its own. Raises StoppedError."""
    with Cluster(address) as cluster:
        yield GradingCrew(cluster, partial(grade_there, orders))


def grade_there(orders: Orders, handed: Sequence[Handed]) -> Graded:
    """A batch, on a machine of the cluster."""
    return _keeper(orders).grade(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, cores())
