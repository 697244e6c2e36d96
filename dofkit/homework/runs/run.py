"""``dofkit grade``: from the files of submissions to the written results."""

from __future__ import annotations

import hashlib
import sys
from contextlib import closing, nullcontext
from dataclasses import dataclass
from pathlib import Path

from dofkit.base import __version__
from dofkit.base.runs import Journal, files_of
from dofkit.base.wording import many
from dofkit.homework.answers.roster import Roster, load_roster
from dofkit.homework.answers.sources import hand_ins
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats import FORMATS, Format, FormatError
from dofkit.homework.formats.gradebooks import apart_path
from dofkit.homework.formats.review import ReviewPaths, RunReview
from dofkit.homework.result import Result
from dofkit.homework.runs.batch import Orders, grading
from dofkit.homework.runs.owners import named_by, owned, settled
from dofkit.homework.variants import with_roster

NATIVE = "native"
#: The file of results in dofkit's own format in a folder.
RESULTS = "results.jsonl"


@dataclass(frozen=True)
class GradingOptions:
    """The options of the command line. ``out``: the path for results, or None for standard output.

    ``scheduler``: the address of a Dask cluster that grades. ``reviewed``: a table that a person filled in. ``roster``:
    the table of the students of the course.
    """

    form: str = NATIVE
    out: Path | None = None
    workers: int | None = None
    scheduler: str | None = None
    check_only: bool = False
    reviewed: Path | None = None
    roster: Path | None = None

    @property
    def format(self) -> Format:
        """The format named ``form``. Raises FormatError."""
        if self.form not in FORMATS:
            raise FormatError(f"'{self.form}' is not a format: the formats are {', '.join(FORMATS)}")
        if self.check_only and self.form != NATIVE:
            raise FormatError(
                "--check-only writes how answers are read as one JSON object per line and takes no other --format"
            )
        if not FORMATS[self.form].endings and self.out is None:
            raise FormatError(f"the format {self.form} needs --out PATH")
        return FORMATS[self.form]

    @property
    def in_folder(self) -> bool:
        """Whether the format writes a folder at ``out``."""
        return self.out is not None and self.format.folder(self.out)

    @property
    def target(self) -> Path | None:
        """The path to which the format writes, for dofkit's own format in a folder a file."""
        return self.out / RESULTS if self.out is not None and self.form == NATIVE and self.in_folder else self.out

    @property
    def review(self) -> ReviewPaths | None:
        """The paths of the review, or None if there is none. Raises FormatError."""
        return None if self.out is None or self.check_only else ReviewPaths.of_output(self.out, self.in_folder)

    @property
    def written(self) -> list[Path]:
        """All paths that are written. Raises FormatError."""
        if self.out is None:
            return []
        review = [] if self.review is None else [self.review.table, self.review.page]
        return [self.out, self.target or self.out, *files_of(unfinished(self.out)), apart_path(self.out), *review]


def unfinished(out: Path) -> Path:
    """Return the path of the journal of an unfinished run, from which the next run continues."""
    return out.with_name(out.name + ".unfinished")


def fingerprint(prepared: Prepared, check_only: bool, roster: Roster | None = None) -> str:
    """Return a hash of the version, the assignment with its scenes and decisions, the roster and the options."""
    course = "" if roster is None else roster.digest
    texts = [__version__, str(check_only), course, prepared.assignment.model_dump_json()]
    texts += [f"{identity} {decision}" for identity, decision in sorted(prepared.decisions.items())]
    texts += [f"{name} {key.convention} {key.scene.model_dump_json()}" for name, key in prepared.keys.items()]
    return hashlib.blake2b("\0".join(texts).encode("utf-8", "replace"), digest_size=16).hexdigest()


def run(assignment: str, sources: list[str], options: GradingOptions) -> bool:
    """Grade all submissions in the given order, write the results, and return whether all could be read.

    Raises AssignmentError, FormatError, OSError for what cannot be written, and StoppedError.
    """
    prepared = load_assignment(assignment)
    roster = None if options.roster is None else load_roster(options.roster)
    form = options.format
    for path in options.written:
        if path.resolve() in [Path(source).resolve() for source in (assignment, *sources, options.roster or "")]:
            raise FormatError(f"--out would overwrite the input file {path}")
    review = RunReview.read(prepared, options.reviewed, options.review)
    prepared, people = with_roster(review.applied(prepared), roster)
    orders = Orders.of(prepared, options.check_only)
    others: list[str | Path] = [assignment, *options.written, *filter(None, (options.reviewed, options.roster))]
    stream = hand_ins(sources, prepared.columns(), others)
    if people is not None:
        stream = (named_by(people, entry) for entry in stream)
    out, mark = options.out, fingerprint(prepared, options.check_only, roster)
    with (
        grading(orders, options.workers, options.scheduler) as grade_all,
        nullcontext() if out is None else closing(Journal(unfinished(out), mark)) as journal,
    ):
        lines = grade_all(stream, journal)
        graded = (owned(people, handed, Result.model_validate_json(line)) for handed, line in lines)
        results = settled(graded, people)
        form.write(results, prepared, options.target or sys.stdout, roster)
        review.write(results, prepared)
        if journal is not None:
            journal.remove()
    doubted = sum(entry.doubt is not None for entry in results)
    if doubted:
        print(f"{many(doubted, 'submission')} with a 'doubt', which a person has to settle", file=sys.stderr)
    return all(entry.error is None for entry in results)
