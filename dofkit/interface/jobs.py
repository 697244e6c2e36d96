"""Requests, and their answers by workers with limits of time and memory: a failing file does not stop the next.

Modules that are slow to import are left to the workers. If this process can be forked, workers are copies of it, so
that a single scene takes hardly longer than without a worker.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
import sys
from collections import Counter
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.deadline import DEFAULT_SECONDS, limit
from dofkit.base.documents import MOST_BYTES
from dofkit.base.runs import Cluster, Journal, Pool, in_order, shared
from dofkit.base.workers import MEMORY, Job
from dofkit.interface.output import Output
from dofkit.methods.table import MethodName

STDIN = "stdin"
#: The module that a worker imports.
ANSWERS = "dofkit.interface.answers"
#: The time limit in seconds for the undecided report on a scene whose worker was killed.
TELLING_SECONDS = 10.0
#: An attribute of an XML model that names another file.
_INCLUDES = re.compile(rb"\bfile\s*=")
#: The time limit of a certificate or a picture is this many times that of a report.
SHARE = 3


@dataclass(frozen=True)
class Request:
    """A file as the user named it, and the question about it.

    ``data``: its bytes, if they have been read already. ``without``: names of constraints to drop; ``limits``: whether
    joint limits of models become inequalities; ``linearize``: whether to add small motions. ``certificate``: the path
    or folder to which certificates are written; ``strict``: whether a claim without evidence is not proved, or fails.
    ``pictures``: for each file (kind: mechanism, graph, directions, motion or loop; path of the picture);
    ``picture``: the pair of this file.
    """

    file: str
    output: Output
    budget: float = DEFAULT_SECONDS
    method: MethodName = "auto"
    without: tuple[str, ...] = ()
    limits: bool = False
    linearize: bool = False
    data: bytes | None = None
    certificate: str | None = None
    strict: bool = False
    pictures: tuple[tuple[str, str], ...] = ()
    picture: tuple[str, str] | None = None

    @property
    def name(self) -> str:
        """The scene's name for a file that does not give one."""
        return name_of_file(self.file)

    @property
    def size(self) -> int:
        """The approximate size of the request in bytes."""
        return len(self.data or b"") + 200

    @property
    def key(self) -> str:
        """A hash of name and contents for the journal; random for a model that includes other files."""
        includes = self.data is not None and _INCLUDES.search(self.data)
        label = f"{self.file}\0{os.urandom(16).hex() if includes else ''}\0".encode("utf-8", "surrogateescape")
        content = b"-" if self.data is None else b"+" + self.data
        return hashlib.blake2b(label + content, digest_size=16).hexdigest()


class Run(NamedTuple):
    """How files are processed: the findings that fail the run, the workers, and the folder for reports (``out``).

    ``workers``: processes on this machine (None: one, or with a folder one for each core); ``scheduler``: the address
    of a Dask cluster.
    """

    fail_on: tuple[str, ...] = ()
    workers: int | None = None
    scheduler: str | None = None
    out: Path | None = None


#: The default: one worker for one file after another.
ONE_BY_ONE = Run()


class Cut(NamedTuple):
    """A request whose answer was cut short: whether the file had been read, and the reason."""

    request: Request
    is_read: bool
    reason: str


class Printed(NamedTuple):
    """The texts about a file for standard output and standard error, and its number of errors.

    ``outcome``: for a report what a summary counts (`outcome_of`), for a certificate {"status": exit status}.
    """

    out: str
    err: str
    errors: int
    outcome: Mapping[str, Any] | None = None


def replies(
    function: str, files: Sequence[str], request: Request, run: Run = ONE_BY_ONE, journal: Journal | None = None
) -> Generator[Printed]:
    """Yield what is printed about each file, in order; ``function``: name of the function of `answers` to call.

    With a journal, answers of an earlier run are reused. Raises StoppedError.
    """
    with ExitStack() as stack:
        if run.scheduler is not None:
            crew: Cluster | Pool = stack.enter_context(Cluster(run.scheduler))
            work = partial(_reply_there, function)
        else:
            pool = crew = stack.enter_context(Pool(run.workers or (None if run.out else 1), MEMORY, (ANSWERS,)))
            if pool.width > 1:
                import_module(ANSWERS)  # once for all workers, which are forks
            pool.fork()
            work = partial(reply, pool, function)
        everything = run.scheduler is not None or journal is not None
        for _, printed in in_order(crew, work, requests(files, request, everything), journal):
            yield Printed(*printed)


def requests(files: Sequence[str], request: Request, everything: bool = False) -> Iterator[Request]:
    """Yield the request for each file; with the bytes of standard input and pipes, of ``everything`` if true."""
    pictures = request.pictures or (None,) * len(files)
    for file, path, picture in zip(files, certificate_paths(files, request.certificate), pictures, strict=True):
        data = data_of(file, everything)
        yield replace(request, file=file, data=data, certificate=path, picture=picture, pictures=())


def certificate_paths(files: Sequence[str], certificate: str | None) -> list[str | None]:
    """Return the certificate's path for each file (None: no certificate); for several files in a folder."""
    if certificate is None:
        return [None] * len(files)
    if len(files) == 1 and not os.path.isdir(certificate):
        return [certificate]
    return [os.path.join(certificate, f"{name}.json") for name in distinct_names(files)]


def name_of_file(file: str) -> str:
    """Return the name that a scene gets from its file: the stem, or `STDIN`."""
    stem = os.path.splitext(os.path.basename(os.path.normpath(file)))[0]
    return STDIN if file == "-" else stem.encode("utf-8", "replace").decode("utf-8")


def distinct_names(files: Sequence[str]) -> list[str]:
    """Return the name of each file; a repeated name gets a number (a, a-2)."""
    names, counts = [], Counter[str]()
    for name in map(name_of_file, files):
        counts[name] += 1
        names.append(name if counts[name] == 1 else f"{name}-{counts[name]}")
    return names


def reply(pool: Pool, function: str, request: Request) -> Printed:
    """Return what is printed about one file; if the worker was killed, an undecided report or an error message."""
    share = SHARE if request.certificate or request.strict or request.picture else 1
    reading_limit = limit(max(request.budget, DEFAULT_SECONDS)) if function == "report_lines" else None
    outcome = pool.run(Job(f"{ANSWERS}:{function}", request, share * limit(request.budget), reading_limit))
    if outcome.finished:
        return Printed(**outcome.value)
    if function == "report_lines":
        cut = Cut(request, outcome.value is not None, outcome.reason)
        shortened = pool.run(Job(f"{ANSWERS}:cut_lines", cut, TELLING_SECONDS))
        if shortened.finished:
            return Printed(**shortened.value)
    return _without_worker(request.name, outcome.reason, request.output.as_json)


def _reply_there(function: str, request: Request) -> Printed:
    """Return what is printed about one file, by a machine of a cluster with its own pool of workers."""
    return reply(shared(ANSWERS), function, request)


def _without_worker(name: str, reason: str, as_json: bool) -> Printed:
    """Return what is printed about a file if no worker could process it."""
    message = f"it could not be processed: {reason}"
    if not as_json:
        return Printed("", f"{name}: error: {message}\n", 1)
    error: dict[str, Any] = {"message": message, "line": None, "column": None, "hint": None, "faults": []}
    return Printed(json.dumps({"scene": name, "error": error}) + "\n", "", 1)


def data_of(file: str, regular: bool = False) -> bytes | None:
    """Return the bytes of standard input or a pipe (without a time limit), and of a regular file if ``regular``."""
    if file == "-":
        return b"" if sys.stdin is None else sys.stdin.buffer.read(MOST_BYTES + 1)
    try:
        mode = os.stat(file).st_mode
        if stat.S_ISDIR(mode) or (stat.S_ISREG(mode) and not regular):
            return None
        with open(file, "rb") as source:
            return source.read(MOST_BYTES + 1)
    except (OSError, ValueError):
        return None
