"""Who grades batches: workers on this machine, or a Dask cluster; there a killable worker of ours does it too."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache, partial
from typing import TypeAlias

from dofkit.base.workers.batches import BatchCrew, Worked
from dofkit.base.workers.crews import Cluster, Threads
from dofkit.base.workers.pool import cores
from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders, ResultLine
from dofkit.homework.runs.keeper import Keeper

#: Grades batches; of everything handed in the lines are told.
GradingCrew: TypeAlias = BatchCrew[Handed, list[ResultLine]]


@contextmanager
def local_crew(keeper: Keeper, workers: int) -> Iterator[GradingCrew]:
    """Workers on this machine."""
    with Threads(workers, keeper.close) as threads:
        yield BatchCrew(threads, keeper.grade)


@contextmanager
def cluster_crew(address: str, orders: Orders) -> Iterator[GradingCrew]:
    """The machines of a Dask scheduler, each with workers of its own. Raises StoppedError."""
    with Cluster(address) as cluster:
        yield BatchCrew(cluster, partial(grade_there, orders))


def grade_there(orders: Orders, handed: Sequence[Handed]) -> Worked[list[ResultLine]]:
    """A batch, on a machine of the cluster."""
    return _keeper(orders).grade(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, cores())
