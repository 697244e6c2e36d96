"""Workers that answer batches of scenes, here or in a cluster; one that breaks a worker is asked alone."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache, partial
from typing import TypeAlias

from dofkit.base.workers import MEMORY, Job
from dofkit.base.workers.batches import BatchCrew, Worked
from dofkit.base.workers.crews import Cluster, Threads
from dofkit.base.workers.pool import cores
from dofkit.base.workers.stoppable_pool import StoppablePool
from dofkit.interface.many.batch import SceneBatch, given_of
from dofkit.interface.many.scene_files import SceneGiven
from dofkit.interface.supervised import Given, Printed, limits_of, report_by

#: Answers batches of scenes.
SceneCrew: TypeAlias = BatchCrew[SceneGiven, Printed]
BATCH = "dofkit.interface.many.batch"


class SceneKeeper:
    """Answers batches, from any thread, each in one of so many killable workers of so many bytes."""

    def __init__(self, asked: Given, workers: int, memory: int = MEMORY) -> None:
        self.asked = asked
        self._pool = StoppablePool(workers, memory, modules=(BATCH,))

    def fork(self) -> None:
        """Start the workers as copies of this process, where that is safe."""
        self._pool.fork()

    def close(self) -> None:
        """End all workers, whatever they do."""
        self._pool.close()

    def answer(self, scenes: Sequence[SceneGiven]) -> Worked[Printed]:
        """What is printed of each scene, in order, and the seconds it took. Raises StoppedError."""
        start = time.monotonic()
        return Worked([*self._printed(tuple(scenes))], time.monotonic() - start)

    def _printed(self, scenes: tuple[SceneGiven, ...]) -> Iterator[Printed]:
        """All at once; where one ends its worker that one by itself, and those before and after it again."""
        left = [scenes]
        while left:
            part = left.pop()
            if len(part) == 1:
                yield report_by(self._pool, given_of(self.asked, part[0]))
                continue
            most = max(sum(limits_of(given_of(self.asked, scene))) for scene in part)
            outcome = self._pool.run(Job(f"{BATCH}:batch_reports", SceneBatch(self.asked, part), most))
            if outcome.finished:
                yield from (Printed(**one) for one in outcome.value["printed"])
                continue
            broken = int(outcome.value["next"]) if outcome.value else 0
            parts = part[:broken], part[broken : broken + 1], part[broken + 1 :]
            left += [one for one in reversed(parts) if one]


@contextmanager
def local_scenes(asked: Given, workers: int) -> Iterator[SceneCrew]:
    """Workers on this machine, copies of this process where it may be forked."""
    keeper = SceneKeeper(asked, workers)
    keeper.fork()
    with Threads(workers, keeper.close) as threads:
        yield BatchCrew(threads, keeper.answer)


@contextmanager
def cluster_scenes(address: str, asked: Given) -> Iterator[SceneCrew]:
    """The machines of a Dask scheduler, each with workers of its own. Raises StoppedError."""
    with Cluster(address) as cluster:
        yield BatchCrew(cluster, partial(answer_there, asked))


def answer_there(asked: Given, scenes: Sequence[SceneGiven]) -> Worked[Printed]:
    """A batch, on a machine of the cluster."""
    return _keeper(asked).answer(scenes)


@lru_cache(maxsize=1)
def _keeper(asked: Given) -> SceneKeeper:
    return SceneKeeper(asked, cores())
