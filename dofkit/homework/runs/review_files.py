"""The review beside a run's results: what was decided before goes into the run, and its queue is written after it."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.html.review_page import write_page
from dofkit.homework.formats.review_queue import write_table
from dofkit.homework.result import Result
from dofkit.homework.review.filled_table import FilledTable, read_table
from dofkit.homework.review.queue import Queue
from dofkit.homework.review.rows import ReviewRow
from dofkit.homework.runs.reviewed_variants import tell_variants

TABLE, PAGE = "review.csv", "review.html"


@dataclass(frozen=True)
class ReviewPaths:
    """Where the table and the page stand; ``shared``: other files of the folder may be there for other reasons."""

    table: Path
    page: Path
    shared: bool

    @classmethod
    def beside(cls, out: Path, folder: bool) -> ReviewPaths:
        """Those in a folder of results, or those beside a file of results, which are called after it."""
        if folder:
            return cls(out / TABLE, out / PAGE, False)
        return cls(out.with_name(f"{out.stem}.{TABLE}"), out.with_name(f"{out.stem}.{PAGE}"), True)


@dataclass(frozen=True)
class RunReview:
    """The rows of the tables that were there, those of ``--reviewed`` before those beside the results."""

    paths: ReviewPaths | None
    rows: Mapping[str, ReviewRow]
    delimiter: str | None

    @classmethod
    def read(cls, prepared: Prepared, reviewed: Path | None, paths: ReviewPaths | None) -> RunReview:
        """Read them. Raises ReviewError and OSError."""
        asked = prepared.most_points()
        beside, named = FilledTable(), FilledTable()
        if paths is not None and paths.table.exists():
            beside = read_table(paths.table, asked)
        if reviewed is not None:
            named = read_table(reviewed, asked)
        rows = {**beside.rows, **{i: row for i, row in named.rows.items() if row.filled or i not in beside.rows}}
        return cls(paths, rows, beside.delimiter or named.delimiter)

    def applied(self, prepared: Prepared) -> Prepared:
        """The assignment with what was decided."""
        return replace(prepared, decisions=FilledTable(self.rows).decisions)

    def write(self, results: Path, prepared: Prepared) -> None:
        """Write the queue of these results, in our own format; say on standard error where it is. Raises OSError."""
        if self.paths is None:
            return
        queue = queue_of(results, prepared)
        tell_variants(queue, prepared)
        rows = list(queue.rows(self.rows))
        if not rows and self.paths.shared and not self.paths.table.exists():
            return
        self.paths.table.parent.mkdir(parents=True, exist_ok=True)
        write_table(rows, prepared, self.paths.table, self.delimiter)
        write_page(queue, rows, prepared, self.paths.page, self.paths.table.name)
        waiting = len(queue.open_answers())
        if waiting:
            different = "1 answer awaits" if waiting == 1 else f"{waiting} different answers await"
            again = f"fill in points, then grade again with --reviewed {self.paths.table}"
            print(f"{different} review in {self.paths.table}: {again}", file=sys.stderr)

    def write_page(self, results: Path, prepared: Prepared) -> None:
        """Write the page alone, of results whose table stands elsewhere. Raises OSError."""
        if self.paths is not None:
            queue = queue_of(results, prepared)
            tell_variants(queue, prepared)
            write_page(queue, queue.rows(self.rows), prepared, self.paths.page, str(self.paths.table))


def queue_of(results: Path, prepared: Prepared) -> Queue:
    """The queue of results in our own format."""
    queue = Queue([(problem.id, question.id) for problem, question in prepared.questions()])
    with results.open(encoding="utf-8", newline="\n") as lines:
        for line in lines:
            if '"needs_review":0' not in line or '"decided_by":"' in line:
                queue.add(Result.model_validate_json(line))
    return queue
