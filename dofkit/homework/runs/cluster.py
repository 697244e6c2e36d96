"""Grading by a Dask cluster: every batch is a task; on its machine a killable worker of ours does the work."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import lru_cache
from types import TracebackType

from dofkit.base.workers import crews
from dofkit.base.workers.pool import cores
from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders
from dofkit.homework.runs.keeper import Graded, Keeper


class GradingCluster:
    """The workers of a Dask scheduler. Raises StoppedError where `distributed` is missing or nobody answers."""

    def __init__(self, address: str, orders: Orders) -> None:
        self._orders = orders
        self._machines = crews.Cluster(address)
        self.width = self._machines.width

    def submit(self, handed: Sequence[Handed]) -> GradingFuture:
        """Begin with a batch."""
        return GradingFuture(self._machines.submit(graded, self._orders, tuple(handed)))

    def __enter__(self) -> GradingCluster:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._machines.__exit__(kind, error, trace)


@dataclass(frozen=True)
class GradingFuture:
    """A batch under way."""

    future: Future[Graded]

    def result(self) -> Graded:
        """What was found. Raises StoppedError where the cluster gives it up."""
        try:
            return Graded(*self.future.result())
        except Exception as error:
            raise crews.given_up(error) from None


def graded(orders: Orders, handed: tuple[Handed, ...]) -> Graded:
    """A batch, in a machine of the cluster."""
    return _keeper(orders).graded(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, cores())
