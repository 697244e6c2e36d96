"""Many scenes by many workers: in the order given, and in a folder what is already there is not asked again."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from dofkit.base.workers.batches import in_order
from dofkit.base.workers.pool import cores
from dofkit.interface.many.keeper import SceneCrew, cluster_scenes, local_scenes
from dofkit.interface.many.kept_reports import KeptReport, KeptReports, mark_of
from dofkit.interface.many.scene_files import SceneGiven, scenes_given
from dofkit.interface.supervised import Given, Printed


class Helpers(NamedTuple):
    """Who answers: so many processes here (None: one for each core), or a Dask cluster."""

    workers: int | None = None
    scheduler: str | None = None


def many_reports(files: Sequence[str], asked: Given, helpers: Helpers) -> Generator[Printed]:
    """What is printed of the report on each file, in their order. Raises StoppedError."""
    with _crew(asked, helpers) as crew:
        for _, printed in in_order(crew, scenes_given(files, asked.certificate)):
            yield printed


def kept_reports(files: Sequence[str], asked: Given, helpers: Helpers, folder: Path) -> Generator[Printed]:
    """The same written to a folder, where nothing of it is printed. Raises StoppedError, OSError and BusyError."""
    scenes = scenes_given(files, asked.certificate)
    with closing(KeptReports(folder, mark_of(asked))) as kept:
        for scene in scenes:
            found = kept.next_known(scene.key)
            if found is None:
                kept.write_from_here()
                with _crew(asked, helpers) as crew:
                    yield from _others(chain([scene], scenes), kept, crew)
                break
            yield _counted(found)
        else:
            kept.write_from_here()
        kept.finish()


def _others(scenes: Iterator[SceneGiven], kept: KeptReports, crew: SceneCrew) -> Iterator[Printed]:
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

    for _, printed in in_order(crew, unknown()):
        yield from known()
        kept.write(waiting.popleft()[0], KeptReport(printed.out, printed.outcome))
        yield printed._replace(out="", err="")
    yield from known()


def _counted(report: KeptReport) -> Printed:
    """What is taken over is counted, and not printed."""
    return Printed("", "", int(report.outcome is None), report.outcome)


@contextmanager
def _crew(asked: Given, helpers: Helpers) -> Iterator[SceneCrew]:
    if helpers.scheduler is not None:
        with cluster_scenes(helpers.scheduler, asked) as crew:
            yield crew
        return
    with local_scenes(asked, helpers.workers or cores()) as crew:
        yield crew
