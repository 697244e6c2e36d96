"""Many scenes by many workers: in the order given, and in a folder what is already there is not asked again."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import NamedTuple, TypeAlias

from dofkit.base import __version__
from dofkit.base.runs import Cluster, Journal, Pool, in_order
from dofkit.base.workers import MEMORY
from dofkit.interface import one_file
from dofkit.interface.many.scene_files import SceneGiven, scenes_given
from dofkit.interface.supervised import Given, Printed, report_by

#: What workers import; it is imported here already for those that are forks of this process.
MODULES = (one_file.__name__,)
#: The file of the reports in their folder.
REPORTS = "reports.jsonl"


class Helpers(NamedTuple):
    """Who answers: so many processes here (None: one for each core), or a Dask cluster."""

    workers: int | None = None
    scheduler: str | None = None


def many_reports(files: Sequence[str], asked: Given, helpers: Helpers) -> Generator[Printed]:
    """What is printed of the report on each file, in their order. Raises StoppedError."""
    with _answerers(asked, helpers) as answers:
        for _, printed in answers(scenes_given(files, asked.certificate), None):
            yield printed


def kept_reports(files: Sequence[str], asked: Given, helpers: Helpers, folder: Path) -> Generator[Printed]:
    """The same written to a folder, a line each, where nothing of it is printed.

    The journal beside the lines stays: a later run asks only about files that changed or came. Raises StoppedError,
    OSError and BusyError.
    """
    path = folder / REPORTS
    ledger = path.with_name(path.name + ".ledger")
    if not path.exists():
        ledger.unlink(missing_ok=True)
    with _answerers(asked, helpers) as answers, closing(Journal(ledger, _mark(asked))) as journal:
        with path.open("wb") as reports:
            for _, known in answers(scenes_given(files, asked.certificate), journal):
                printed = Printed(*known)
                line = printed.out if printed.out.endswith("\n") else printed.out + "\n"
                reports.write(line.encode("utf-8", "surrogateescape"))
                reports.flush()
                yield printed._replace(out="", err="")
        journal.keep_written()


def _mark(asked: Given) -> str:
    """What tells a run from others: who answers, and what is asked of every scene."""
    telling = asked.telling
    parts = (asked.budget, asked.method, telling.only, telling.without, telling.limits, asked.certificate)
    return hashlib.blake2b(repr((__version__, *parts)).encode(), digest_size=16).hexdigest()


#: Yields every scene with what is printed of it, in order; a journal keeps that.
Answers: TypeAlias = Callable[[Iterator[SceneGiven], Journal | None], Iterator[tuple[SceneGiven, Printed]]]


@contextmanager
def _answerers(asked: Given, helpers: Helpers) -> Iterator[Answers]:
    """Workers of this machine, or of a cluster. Raises StoppedError."""
    if helpers.scheduler is not None:
        with Cluster(helpers.scheduler) as cluster:
            yield partial(in_order, cluster, partial(_answer_there, asked))
        return
    with Pool(helpers.workers, MEMORY, MODULES) as pool:
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
    return Pool(modules=MODULES)
