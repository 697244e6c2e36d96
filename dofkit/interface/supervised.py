"""The files of the command line, one after another in a worker that is watched: none of them stops those that follow.

Nothing heavy is imported here: the worker does that. Where this process may be forked the worker is a copy of it, so
that a single scene costs hardly more than without.
"""

from __future__ import annotations

import json
import os
import stat
import sys
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from dofkit.base.arguments import is_folder_path
from dofkit.base.deadline import DEFAULT_SECONDS, limit
from dofkit.base.documents import MOST_BYTES
from dofkit.base.workers import Job, JobOutcome, Worker
from dofkit.interface.presentation import Telling
from dofkit.interface.streams import ascii_only
from dofkit.methods.table import MethodName

STDIN = "stdin"
#: Seconds for what is printed where a scene's own worker was killed.
TELLING_SECONDS = 10.0
#: With its certificate a report may take so many times as long.
CERTIFICATE_SHARE = 3
#: The exit status of a certificate that could not be looked at.
UNREAD = 2
#: What the worker does is in this module, which it imports itself.
ONE_FILE, ONE_PICTURE = "dofkit.interface.one_file", "dofkit.interface.one_picture"
#: A picture may take so many times as long as a report.
PICTURE_SHARE = 3


class PictureGiven(NamedTuple):
    """A kind of picture (mechanism, graph, directions or motion), and the path that it is written to."""

    kind: str
    path: str


@dataclass(frozen=True)
class Given:
    """A file as it was named, and how to tell of it.

    ``data``: its bytes where they were read already; ``budget``: seconds for the scene, ``method``: how to answer;
    ``linearize``: small motions too. ``certificate``: where its certificate is written, None for none. ``widest``: the
    characters of the longest name of all files. ``picture``: the one that is asked for.
    """

    file: str
    budget: float
    method: MethodName
    telling: Telling
    linearize: bool = False
    data: bytes | None = None
    certificate: str | None = None
    widest: int = 0
    picture: PictureGiven | None = None

    @property
    def name(self) -> str:
        """The scene's name where it has none of its own."""
        stem = os.path.splitext(os.path.basename(os.path.normpath(self.file)))[0]
        return STDIN if self.file == "-" else stem.encode("utf-8", "replace").decode("utf-8")


@dataclass(frozen=True)
class CertificateGiven:
    """A certificate's file, and that of the scene (None: it is in the certificate); ``strict``: nothing uncovered."""

    scene: str | None
    certificate: str
    strict: bool
    as_json: bool
    ascii_only: bool = False


class Cut(NamedTuple):
    """A file whose answer was cut short: whether it had been read, and why there is no more."""

    given: Given
    is_read: bool
    reason: str


class Printed(NamedTuple):
    """What is printed of a file, on standard output and on standard error, and how many errors it has.

    ``outcome``: of a report what a summary counts.
    """

    out: str
    err: str
    errors: int
    outcome: Mapping[str, Any] | None = None


class Runner(Protocol):
    """What does jobs: a worker, or several of them."""

    def run(self, job: Job) -> JobOutcome:
        """Do one job."""


def reports(
    files: Sequence[str], telling: Telling, budget: float | None, method: MethodName, certificate: str | None = None
) -> Generator[Printed]:
    """What is printed of the report on each file, in their order.

    ``certificate``: where the certificate of a file is written; a folder for those of several files.
    """
    given = given_for_all(files, telling._replace(ascii_only=ascii_only()), budget, method)
    return _answers(files, given, report_by, (ONE_FILE,), places_of(files, certificate))


def given_for_all(files: Sequence[str], telling: Telling, budget: float | None, method: MethodName) -> Given:
    """What is asked of every file."""
    seconds = DEFAULT_SECONDS if budget is None else budget
    return Given("", seconds, method, telling, widest=max(map(len, names_of(files)), default=0))


def places_of(files: Sequence[str], certificate: str | None) -> list[str | None]:
    """Where the certificate of each file is written: in a folder by its name, numbered where another has it."""
    if certificate is None:
        return [None] * len(files)
    if len(files) == 1 and not os.path.isdir(certificate):
        return [certificate]
    return [os.path.join(certificate, f"{name}.json") for name in _own_names(files)]


def _own_names(files: Sequence[str]) -> list[str]:
    """The name of each file, numbered where one before has it."""
    found, met = [], Counter[str]()
    for name in names_of(files):
        met[name] += 1
        found.append(name if met[name] == 1 else f"{name}-{met[name]}")
    return found


def names_of(files: Sequence[str]) -> list[str]:
    """The names that scenes have by their files."""
    return [Given(file, 0.0, "auto", Telling()).name for file in files]


def motions(
    files: Sequence[str], linearize: bool, telling: Telling, certificate: str | None = None
) -> Generator[Printed]:
    """What is printed of the equations of motion of each file, in their order; ``certificate`` as for `reports`."""
    given = Given("", DEFAULT_SECONDS, "auto", telling._replace(ascii_only=ascii_only()), linearize)
    return _answers(
        files, given, _motion, (ONE_FILE, "dofkit.motion.lagrange.equations"), places_of(files, certificate)
    )


def pictures(files: Sequence[str], kind: str, out: Path | None, ending: str) -> Generator[Printed]:
    """Yield the path of the picture of each file, in the order of the files.

    ``out``: the picture's path for one file, else a folder (None: the current one).
    """
    if out is not None and not is_folder_path(out):
        places = [str(out)]
    else:
        suffix = f"-{kind}" if kind in ("graph", "directions") else ""
        places = [str((out or Path()) / f"{name}{suffix}.{ending}") for name in _own_names(files)]
    worker = Worker(modules=(ONE_PICTURE,), fork=True)
    given = Given("", DEFAULT_SECONDS, "auto", Telling.here(False)._replace(ascii_only=ascii_only()))
    try:
        for file, place in zip(files, places, strict=True):
            asked = replace(given, file=file, data=data_of(file), picture=PictureGiven(kind, place))
            job = Job(f"{ONE_PICTURE}:picture_lines", asked, PICTURE_SHARE * limit(given.budget))
            outcome = worker.run(job)
            yield Printed(**outcome.value) if outcome.finished else _plain(asked, outcome.reason)
    finally:
        worker.kill()


def verification(given: CertificateGiven) -> tuple[str, str, int]:
    """What is printed of a certificate, on standard output and on standard error, and the exit status."""
    worker = Worker(modules=("dofkit.interface.one_certificate",), fork=True)
    try:
        asked = replace(given, ascii_only=ascii_only())
        job = Job("dofkit.interface.one_certificate:verification_lines", asked, limit(DEFAULT_SECONDS))
        outcome = worker.run(job)
    finally:
        worker.kill()
    if outcome.finished:
        return outcome.value["out"], outcome.value["err"], outcome.value["status"]
    telling = Telling(given.as_json)
    plain = _plain(Given(given.certificate, DEFAULT_SECONDS, "auto", telling), outcome.reason)
    return plain.out, plain.err, UNREAD


def _answers(
    files: Sequence[str],
    given: Given,
    ask: Callable[[Worker, Given], Printed],
    modules: Sequence[str],
    places: Sequence[str | None] = (),
) -> Generator[Printed]:
    worker = Worker(modules=modules, fork=True)
    try:
        for file, place in zip(files, places or [None] * len(files), strict=True):
            yield ask(worker, replace(given, file=file, data=data_of(file), certificate=place))
    finally:
        worker.kill()


def limits_of(given: Given) -> tuple[float, float]:
    """Seconds for reading a file, and for its report."""
    share = 1 if given.certificate is None else CERTIFICATE_SHARE
    return limit(max(given.budget, DEFAULT_SECONDS)), share * limit(given.budget)


def report_by(worker: Runner, given: Given) -> Printed:
    """What is printed of the report on one file, whatever becomes of the worker."""
    reading, seconds = limits_of(given)
    outcome = worker.run(Job("dofkit.interface.one_file:report_lines", given, seconds, reading))
    if not outcome.finished:
        cut = Cut(given, outcome.value is not None, outcome.reason)
        outcome = worker.run(Job("dofkit.interface.one_file:cut_lines", cut, TELLING_SECONDS))
        if not outcome.finished:
            return _plain(given, cut.reason)
    return Printed(**outcome.value)


def _motion(worker: Worker, given: Given) -> Printed:
    share = 1 if given.certificate is None else CERTIFICATE_SHARE
    outcome = worker.run(Job("dofkit.interface.one_file:motion_lines", given, share * limit(given.budget)))
    return Printed(**outcome.value) if outcome.finished else _plain(given, outcome.reason)


def _plain(given: Given, reason: str) -> Printed:
    """Where not even a worker can tell."""
    message = f"it could not be looked at: {reason}"
    if not given.telling.as_json:
        return Printed("", f"{given.name}: error: {message}\n", 1)
    error: dict[str, Any] = {"message": message, "line": None, "column": None, "hint": None, "faults": []}
    return Printed(json.dumps({"scene": given.name, "error": error}) + "\n", "", 1)


def data_of(file: str) -> bytes | None:
    """The bytes of standard input, or of a pipe: they may be long in coming, so that no clock runs for them."""
    if file == "-":
        return b"" if sys.stdin is None else sys.stdin.buffer.read(MOST_BYTES + 1)
    try:
        mode = os.stat(file).st_mode
        if stat.S_ISREG(mode) or stat.S_ISDIR(mode):
            return None
        with open(file, "rb") as source:
            return source.read(MOST_BYTES + 1)
    except (OSError, ValueError):
        return None
