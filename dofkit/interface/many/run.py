"""Many scenes by many workers: in the order given, and in a folder what is already there is not asked again."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from functools import lru_cache, partial
from itertools import chain
from pathlib import Path
from typing import NamedTuple, TypeAlias

from dofkit.base.workers import MEMORY
from dofkit.base.workers.pool import Cluster, Pool, in_order
from dofkit.interface.many.kept_reports import KeptReport, KeptReports, mark_of
from dofkit.interface.many.scene_files import SceneGiven, scenes_given
from dofkit.interface.supervised import ONE_FILE, Given, Printed, report_by


class Helpers(NamedTuple):
    """Who answers: so many processes here (None: one for each core), or a Dask cluster."""

    workers: int | None = None
    scheduler: str | None = None


def many_reports(files: Sequence[str], asked: Given, helpers: Helpers) -> Generator[Printed]:
    """What is printed of the report on each file, in their order. Raises StoppedError."""
    with _answerers(asked, helpers) as answers:
        for _, printed in answers(scenes_given(files, asked.certificate)):
            yield printed


def kept_reports(files: Sequence[str], asked: Given, helpers: Helpers, folder: Path) -> Generator[Printed]:
    """The same written to a folder, where nothing of it is printed. Raises StoppedError, OSError and BusyError."""
    scenes = scenes_given(files, asked.certificate)
    with closing(KeptReports(folder, mark_of(asked))) as kept:
        for scene in scenes:
            found = kept.next_known(scene.key)
            if found is None:
                kept.write_from_here()
                with _answerers(asked, helpers) as answers:
                    yield from _others(chain([scene], scenes), kept, answers)
                break
            yield _counted(found)
        else:
            kept.write_from_here()
        kept.finish()


def _others(scenes: Iterator[SceneGiven], kept: KeptReports, answers: Answers) -> Iterator[Printed]:
    """What is not known is asked; every line is written after all before it."""
    waiting: deque[tuple[str, bool]] = deque()

    def unknown() -> Iterator[SceneGiven]:
        for scene in scenes:
            known = kept.knows(scene.key)
            waiting.append((scene.key, known))
            if not known:
                yield scene

    def known() -> Iterator[Printed]:
        while waiting and waiting[0][1]:
            yield _counted(kept.write_known(waiting.popleft()[0]))

    for _, printed in answers(unknown()):
        yield from known()
        kept.write(waiting.popleft()[0], KeptReport(printed.out, printed.outcome))
        yield printed._replace(out="", err="")
    yield from known()


def _counted(report: KeptReport) -> Printed:
    """What is taken over is counted, and not printed."""
    return Printed("", "", report.outcome is None, report.outcome)


#: Yields every scene with what is printed of it, in order.
Answers: TypeAlias = Callable[[Iterator[SceneGiven]], Iterator[tuple[SceneGiven, Printed]]]


@contextmanager
def _answerers(asked: Given, helpers: Helpers) -> Iterator[Answers]:
    """Workers of this machine, or of a cluster. Raises StoppedError."""
    if helpers.scheduler is not None:
        with Cluster(helpers.scheduler) as cluster:
            yield partial(in_order, cluster, partial(_answer_there, asked))
        return
    with Pool(helpers.workers, MEMORY, (ONE_FILE,)) as pool:
        pool.fork()
        yield partial(in_order, pool, partial(answer, pool, asked))


def answer(pool: Pool, asked: Given, scene: SceneGiven) -> Printed:
    """What is printed of one scene. Raises StoppedError."""
    return report_by(pool, replace(asked, file=scene.file, data=scene.data, certificate=scene.certificate))


def _answer_there(asked: Given, scene: SceneGiven) -> Printed:
    """The same on a machine of a cluster, by killable workers of its own."""
    return answer(_pool(), asked, scene)


@lru_cache(maxsize=1)
def _pool() -> Pool:
    return Pool(modules=(ONE_FILE,))
