"""Many things to be worked on, in batches and in their order: by threads that each mind a worker, or by a cluster."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Generic, NamedTuple, Protocol, TypeVar

from dofkit.base.workers.crews import Crew

#: Seconds that a batch should take, and the most things and bytes in one.
BATCH_SECONDS, MOST_IN_BATCH, MOST_BYTES = 0.25, 256, 1_000_000
#: Batches under way for each worker.
AHEAD = 3


class Sized(Protocol):
    """Something to be worked on."""

    @property
    def size(self) -> int:
        """About how many bytes it holds."""


Item = TypeVar("Item", bound=Sized)
Told = TypeVar("Told")


class Worked(NamedTuple, Generic[Told]):
    """What is told of each thing of a batch, in order, and how many seconds the batch took."""

    told: Sequence[Told]
    seconds: float


@dataclass(frozen=True)
class BatchCrew(Generic[Item, Told]):
    """Works on batches, ``width`` at a time: ``crew`` calls ``work`` with each."""

    crew: Crew
    work: Callable[[Sequence[Item]], Worked[Told]]

    @property
    def width(self) -> int:
        """How many batches at a time."""
        return self.crew.width

    def submit(self, items: Sequence[Item]) -> Future[Worked[Told]]:
        """Begin with a batch; its future raises StoppedError where nobody does it."""
        return self.crew.submit(self.work, tuple(items))


def in_order(crew: BatchCrew[Item, Told], items: Iterable[Item]) -> Iterator[tuple[Item, Told]]:
    """Everything with what is told of it, in order; no more is taken than the workers can use soon.

    Batches are so large that each takes about a quarter of a second, for which a worker may wait at the end; what is in
    one makes no difference to what is told.
    """
    stream = iter(items)
    under_way: deque[tuple[list[Item], Future[Worked[Told]]]] = deque()
    size = 1
    while True:
        while len(under_way) < AHEAD * crew.width and (batch := _batch(stream, size)):
            under_way.append((batch, crew.submit(batch)))
        if not under_way:
            return
        batch, future = under_way.popleft()
        found = future.result()
        yield from zip(batch, found.told, strict=True)
        wanted = int(len(batch) * BATCH_SECONDS / max(found.seconds, 1e-3))
        size = max(1, min(MOST_IN_BATCH, 2 * size, wanted))


def _batch(stream: Iterator[Item], size: int) -> list[Item]:
    found: list[Item] = []
    held = 0
    while len(found) < size and held < MOST_BYTES:
        one = next(stream, None)
        if one is None:
            break
        found.append(one)
        held += one.size
    return found
