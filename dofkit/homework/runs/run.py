"""``dofkit grade``: from the files that are named to the results, wherever they go."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from dofkit.base import __version__
from dofkit.base.runs import Cluster, Journal, Pool, files_of, in_order
from dofkit.base.workers import MEMORY
from dofkit.homework.answers.roster import Roster, load_roster
from dofkit.homework.answers.sources import Handed, hand_ins
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats import FORMATS, Format, FormatError
from dofkit.homework.formats.unplaced_results import apart_path
from dofkit.homework.result import Result
from dofkit.homework.runs.appeals import Appeals
from dofkit.homework.runs.batch import Orders, ResultLine
from dofkit.homework.runs.keeper import MODULES, Keeper, grade_there
from dofkit.homework.runs.repeats import without_repeats
from dofkit.homework.runs.review_files import ReviewPaths, RunReview
from dofkit.homework.runs.rostered import named_by, rostered
from dofkit.homework.sheet_owners import people_of, with_names

NATIVE = "native"
#: What results in our own format are called in a folder.
RESULTS = "results.jsonl"


@dataclass(frozen=True)
class GradingOptions:
    """What the command line says besides the files. ``out``: where results go, None for standard output.

    ``certificates``: the folder of what the keys rest on, for appeals. ``reviewed``: a table that a person filled in.
    ``roster``: the table of who is in the course.
    """

    form: str = NATIVE
    out: Path | None = None
    workers: int | None = None
    scheduler: str | None = None
    check_only: bool = False
    certificates: Path | None = None
    reviewed: Path | None = None
    roster: Path | None = None

    @property
    def format(self) -> Format:
        """The format called so. Raises FormatError."""
        if self.form not in FORMATS:
            raise FormatError(f"'{self.form}' is not a format: the formats are {', '.join(FORMATS)}")
        if self.check_only and self.form != NATIVE:
            raise FormatError(
                "--check-only writes how answers are read as one JSON object per line and takes no other --format"
            )
        if FORMATS[self.form].needs_path and self.out is None:
            raise FormatError(f"the format {self.form} needs --out PATH")
        ending = "" if self.out is None or self.out.is_dir() else self.out.suffix.lower()[1:]
        others = [name for name, form in FORMATS.items() if ending in form.endings]
        if others and self.form not in others:
            raise FormatError(
                f"'{self.out}' ends in .{ending}, which --format {self.form} does not write: "
                f"choose --format {' or '.join(others)}"
            )
        return FORMATS[self.form]

    @property
    def in_folder(self) -> bool:
        """Does the format write a folder there?"""
        return self.out is not None and self.format.folder(self.out)

    @property
    def native(self) -> Path | None:
        """Where results stand in our own format, before they are written in another. Raises FormatError."""
        if self.out is None:
            return None
        if self.format.name != NATIVE:
            return self.out.with_name(self.out.name + ".results.jsonl")
        return self.out / RESULTS if self.in_folder else self.out

    @property
    def review(self) -> ReviewPaths | None:
        """Where the review stands. Raises FormatError."""
        return None if self.out is None or self.check_only else ReviewPaths.beside(self.out, self.in_folder)

    @property
    def written(self) -> list[Path]:
        """The paths that are written to. Raises FormatError."""
        path, review = self.native, self.review
        if self.out is None or path is None:
            return []
        beside = [apart_path(self.out), *([] if review is None else [review.table, review.page])]
        return [self.out, path, *files_of(unfinished(path)), *beside]


def unfinished(results: Path) -> Path:
    """The journal of an unfinished run, from which the next one goes on."""
    return results.with_name(results.name + ".unfinished")


def fingerprint(prepared: Prepared, check_only: bool, roster: Roster | None = None) -> str:
    """What tells a run from others: the assignment with its scenes, who is in the course, and who grades it how."""
    course = "" if roster is None else roster.digest
    parts = [__version__, str(check_only), course, prepared.assignment.model_dump_json()]
    parts += [f"{identity} {decision}" for identity, decision in sorted(prepared.decisions.items())]
    parts += [f"{name} {key.convention} {key.scene.model_dump_json()}" for name, key in prepared.keys.items()]
    return hashlib.blake2b("\0".join(parts).encode("utf-8", "replace"), digest_size=16).hexdigest()


def run(assignment: str, sources: list[str], options: GradingOptions) -> bool:
    """Grade everything, in the order given; was every submission read?

    Raises AssignmentError, FormatError, OSError for what cannot be written, and StoppedError.
    """
    prepared = load_assignment(assignment)
    roster = None if options.roster is None else load_roster(options.roster)
    form = options.format
    for path in options.written:
        if path.resolve() in [Path(given).resolve() for given in (assignment, *sources, options.roster or "")]:
            raise FormatError(f"--out would overwrite the input file {path}")
    review = RunReview.read(prepared, options.reviewed, options.review)
    prepared = review.applied(with_names(prepared, roster))
    people = people_of(prepared, roster)
    orders = Orders.of(prepared, options.check_only)
    others: list[str | Path] = [assignment, *options.written, *filter(None, (options.reviewed, options.roster))]
    stream = hand_ins(sources, prepared.columns(), others)
    if people is not None:
        stream = (named_by(people, one) for one in stream)
    with _graders(orders, options) as grade:
        appeals = None if options.certificates is None or options.check_only else Appeals(prepared)
        one = _Run(form, prepared, orders, grade, roster, people, sources, appeals)
        if options.out is None or options.native is None:
            one.to_stdout(stream)
        else:
            one.to_path(stream, options.out, options.native, review)
    if one.doubted:
        print(
            f"{one.doubted} of the submissions have a 'doubt': a person has to decide whose they are", file=sys.stderr
        )
    if options.certificates is not None:
        (appeals or Appeals(prepared)).write(options.certificates)
    return one.failed == 0


#: Yields everything handed in with its results, in order; a journal keeps them.
Grade: TypeAlias = Callable[[Iterator[Handed], Journal | None], Iterator[tuple[Handed, list[ResultLine]]]]


@contextmanager
def _graders(orders: Orders, options: GradingOptions) -> Iterator[Grade]:
    """Workers of this machine, or of a cluster. Raises StoppedError."""
    if options.scheduler is not None:
        with Cluster(options.scheduler) as cluster:
            yield partial(in_order, cluster, partial(grade_there, orders))
        return
    with Pool(options.workers, MEMORY, MODULES) as pool:
        pool.fork()
        yield partial(in_order, pool, Keeper(orders, pool).grade)


@dataclass
class _Run:
    """One run; ``failed`` counts the submissions that could not be graded, ``doubted`` those that may be another's.

    ``people``: by whom submissions are told apart, the roster or those who have sheets of their own; ``sources``: what
    was handed in. ``appeals``: what may be asked about answers later.
    """

    form: Format
    prepared: Prepared
    orders: Orders
    grade: Grade
    roster: Roster | None = None
    people: Roster | None = None
    sources: Sequence[str] = ()
    appeals: Appeals | None = None
    failed: int = 0
    doubted: int = 0

    def to_stdout(self, stream: Iterator[Handed]) -> None:
        """Print results as they come."""
        lines = self._kept(line.text for _, found in self._with_lines(stream, sys.stdout.isatty()) for line in found)
        if self.form.name != NATIVE:
            self.form.written(
                map(Result.model_validate_json, lines), self.prepared, sys.stdout, self.roster, self.sources
            )
            return
        utf8 = (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"
        for text in lines:
            print(text if utf8 else json.dumps(json.loads(text)), flush=True)

    def to_path(self, stream: Iterator[Handed], out: Path, path: Path, review: RunReview) -> None:
        """Write to a path what is not there yet; a format other than our own is made of our own at the end.

        ``path``: where results stand in our own.
        """
        if not path.exists():
            unfinished(path).unlink(missing_ok=True)
        mark = fingerprint(self.prepared, self.orders.check_only, self.roster)
        with closing(Journal(unfinished(path), mark)) as journal, path.open("w", 1, "utf-8", newline="\n") as results:
            for _, lines in self._with_lines(stream, False, journal):
                results.writelines(f"{line.text}\n" for line in lines)
        if self.appeals is not None:
            self.appeals.gather(_results(path))
        if self.form.name != NATIVE:
            self.form.written(_results(path), self.prepared, out, self.roster, self.sources)
        review.write(path, self.prepared)
        if self.form.name != NATIVE:
            path.unlink()
        journal.remove()

    def _kept(self, lines: Iterator[str]) -> Iterator[str]:
        """Lines, of which answers are kept."""
        for text in lines:
            if self.appeals is not None:
                self.appeals.add(Result.model_validate_json(text))
            yield text

    def _with_lines(
        self, stream: Iterator[Handed], quiet: bool, journal: Journal | None = None
    ) -> Iterator[tuple[Handed, list[ResultLine]]]:
        """Everything with its results, counted, and shown on a terminal how far it is."""
        with _bar(quiet) as bar:
            task = bar.add_task("graded", total=None)
            graded = ((one, [ResultLine(*line) for line in lines]) for one, lines in self.grade(stream, journal))
            for one, lines in without_repeats(self.orders, rostered(self.people, graded)):
                self.failed += sum(line.failed for line in lines)
                self.doubted += sum(line.doubted for line in lines)
                yield one, lines
                bar.update(task, advance=len(lines))


def _bar(quiet: bool) -> AbstractContextManager[Progress]:
    """A progress bar on standard error, where that is a terminal and nothing else is printed to it."""
    console = Console(stderr=True)
    shown = console.is_terminal and not console.is_jupyter and not quiet
    columns = (SpinnerColumn(), BarColumn(), TextColumn("{task.completed:.0f} graded"), TimeElapsedColumn())
    return Progress(*columns, console=console, transient=True, disable=not shown)


def _results(path: Path) -> Iterator[Result]:
    with path.open(encoding="utf-8", newline="\n") as lines:
        yield from map(Result.model_validate_json, lines)
