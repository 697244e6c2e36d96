"""Many scenes by several workers, in the order given; in a folder, what an earlier run answered is not asked again."""

from __future__ import annotations

import hashlib
import re
import uuid
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeAlias

from dofkit.base import __version__
from dofkit.base.runs import Cluster, Journal, Pool, in_order, shared
from dofkit.base.workers import MEMORY
from dofkit.interface import answers  # imported here already for workers that are forks of this process
from dofkit.interface.jobs import Printed, Request, Run, data_of, reply, requests
from dofkit.models.formats import is_model

MODULES = (answers.__name__,)
#: The file of the reports in their folder.
REPORTS = "reports.jsonl"
#: An attribute of a model that names another file.
_INCLUDES = re.compile(rb"\bfile\s*=")


class QueuedScene(NamedTuple):
    """A request with the bytes of its file, as it is handed to workers and to the journal."""

    request: Request

    @property
    def size(self) -> int:
        """About how many bytes it holds."""
        return len(self.request.data or b"") + 200

    @property
    def key(self) -> str:
        """What distinguishes it from other files and from earlier contents; a model that includes files is new."""
        file, data = self.request.file, self.request.data
        includes = data is not None and is_model(data) and _INCLUDES.search(data)
        named = f"{file}\0{uuid.uuid4().hex if includes else ''}\0".encode("utf-8", "surrogateescape")
        return hashlib.blake2b(named + (b"-" if data is None else b"+" + data), digest_size=16).hexdigest()


def many_reports(files: Sequence[str], request: Request, run: Run) -> Generator[Printed]:
    """Yield what is printed of the report on each file, in order. Raises StoppedError."""
    with _replies(run) as replies:
        for _, printed in replies(scene_files(files, request), None):
            yield printed


def kept_reports(files: Sequence[str], request: Request, run: Run, folder: Path) -> Generator[Printed]:
    """Write the reports to a folder, one line each, and yield the rest of what is printed.

    The journal beside the lines stays: a later run asks only about files that are new or have changed. Raises
    StoppedError, OSError and BusyError.
    """
    path = folder / REPORTS
    ledger = path.with_name(path.name + ".ledger")
    if not path.exists():
        ledger.unlink(missing_ok=True)
    with _replies(run) as replies, closing(Journal(ledger, _mark(request))) as journal:
        with path.open("wb") as reports:
            for _, result in replies(scene_files(files, request), journal):
                printed = Printed(*result)
                line = printed.out if printed.out.endswith("\n") else printed.out + "\n"
                reports.write(line.encode("utf-8", "surrogateescape"))
                reports.flush()
                yield printed._replace(out="", err="")
        journal.keep_written()


def scene_files(files: Sequence[str], request: Request) -> Iterator[QueuedScene]:
    """Yield every file with its bytes, as they are needed."""
    for each in requests(files, request):
        yield QueuedScene(each if each.data is not None else replace(each, data=data_of(each.file, regular=True)))


def _mark(request: Request) -> str:
    """Return what distinguishes a run from others: the version, and what is asked of every scene."""
    options = (request.budget, request.method, request.output.only, request.without, request.limits, request.strict)
    return hashlib.blake2b(repr((__version__, *options, request.certificate)).encode(), digest_size=16).hexdigest()


#: Yields every scene with what is printed of it, in order; a journal keeps that.
Replies: TypeAlias = Callable[[Iterator[QueuedScene], Journal | None], Iterator[tuple[QueuedScene, Printed]]]


@contextmanager
def _replies(run: Run) -> Iterator[Replies]:
    """Start the workers of this machine, or of a cluster. Raises StoppedError."""
    if run.scheduler is not None:
        with Cluster(run.scheduler) as cluster:
            yield partial(in_order, cluster, _answer_there)
        return
    with Pool(run.workers, MEMORY, MODULES) as pool:
        pool.fork()
        yield partial(in_order, pool, partial(answer, pool))


def answer(pool: Pool, scene: QueuedScene) -> Printed:
    """Return what is printed of one scene. Raises StoppedError."""
    return reply(pool, "report_lines", scene.request)


def _answer_there(scene: QueuedScene) -> Printed:
    """Return the same on a machine of a cluster, by killable workers of its own."""
    return answer(shared(MODULES[0]), scene)
