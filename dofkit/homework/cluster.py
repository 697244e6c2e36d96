"""Grading by a Dask cluster: every batch is a task; on its machine a killable worker of ours does the work."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import TracebackType
from typing import Any

from dofkit.homework.batch import Orders
from dofkit.homework.keeper import Graded, Keeper, StoppedError
from dofkit.homework.sources import Handed
from dofkit.workers.pool import cores

#: How often a task is given to another machine where the first is lost, and seconds to reach the scheduler.
RETRIES, CONNECTING = 10, 10.0


class Cluster:
    """The workers of a Dask scheduler. Raises StoppedError where `distributed` is missing or nobody answers."""

    def __init__(self, address: str, orders: Orders) -> None:
        self._orders = orders
        try:
            import distributed

            library: Any = distributed
            self._client = library.Client(address, timeout=CONNECTING, set_as_default=False)
        except ImportError:
            raise StoppedError("--scheduler needs distributed: pip install 'dofkit[cluster]'") from None
        except (OSError, ValueError, TimeoutError) as error:
            raise StoppedError(f"the scheduler at {address} does not answer ({type(error).__name__})") from None
        self.width = max(1, sum(self._client.nthreads().values()))

    def submit(self, handed: Sequence[Handed]) -> Task:
        """Begin with a batch."""
        return Task(self._client.submit(graded, self._orders, tuple(handed), pure=False, retries=RETRIES))

    def __enter__(self) -> Cluster:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close()


@dataclass(frozen=True)
class Task:
    """A batch under way."""

    future: Any

    def result(self) -> Graded:
        """What was found. Raises StoppedError where the cluster gives it up."""
        try:
            return Graded(*self.future.result())
        except Exception as error:
            said = " ".join(str(error).split())[:200]
            raise StoppedError(f"the cluster gave a batch up: {type(error).__name__}: {said}") from None


def graded(orders: Orders, handed: tuple[Handed, ...]) -> Graded:
    """A batch, in a machine of the cluster."""
    return _keeper(orders).graded(handed)


@lru_cache(maxsize=1)
def _keeper(orders: Orders) -> Keeper:
    return Keeper(orders, cores())
