"""The review beside the results: a table in which a person fills in points, and a page that shows the same answers.

The table is in UTF-8 with a byte order mark for Excel. Its delimiter is that of the earlier table, else the one which
Excel expects in the assignment's language. No cell begins like a formula, and answers begin with a letter or an
apostrophe, so that no spreadsheet reads ``1/2`` as a date.
"""

from __future__ import annotations

import csv
import os
import secrets
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import cell
from dofkit.homework.formats.pages import asked_text, rendered
from dofkit.homework.formats.wording import unmarked
from dofkit.homework.result import Result
from dofkit.homework.review import COLUMNS, FilledTable, Queue, QueuedAnswer, ReviewRow, read_table

TABLE, PAGE = "review.csv", "review.html"
#: The most answers of each list that are shown, with the number of further ones.
MOST_SHOWN = 1000
#: Languages in which Excel uses decimal commas, and semicolons in tables.
_SEMICOLONS = frozenset({"de", "fr", "es"})
_ANSWERS = frozenset({"text", "readings"})
_FILLED = frozenset({"remark", "decided_by"})


def write_table(rows: Iterable[ReviewRow], prepared: Prepared, path: Path, delimiter: str | None) -> None:
    """Write the table atomically. ``delimiter``: that of the earlier table, or None. Raises OSError."""
    chosen = delimiter or (";" if prepared.assignment.language in _SEMICOLONS else ",")
    temporary = path.with_name(f".{path.name}.new")
    with temporary.open("w", encoding="utf-8-sig", newline="") as stream:
        writer = csv.writer(stream, delimiter=chosen, lineterminator="\r\n")
        writer.writerow(COLUMNS)
        for row in rows:
            writer.writerow(_cells(row.cells, chosen))
    os.replace(temporary, path)


def _cells(cells: Mapping[str, str], delimiter: str) -> list[str]:
    """Return the cells of a row; the points that a person wrote are unchanged."""
    texts = []
    for name in COLUMNS:
        text = cells.get(name, "")
        if name in _ANSWERS:
            text = cell(text) if text[:1].isalpha() or not text else f"'{cell(text).removeprefix(chr(39))}"
        elif name == "would_earn" and delimiter == ";":
            text = text.replace(".", ",")
        elif name != "points":
            text = cell(text if name in _FILLED else unmarked(text))
        texts.append(text)
    return texts


def write_page(queue: Queue, rows: Iterable[ReviewRow], prepared: Prepared, path: Path, table: str) -> None:
    """Write the page atomically. ``table``: the name of the file in which points are filled in. Raises OSError."""
    waiting = queue.open_answers()
    page = {
        "title": prepared.assignment.title,
        "questions": list(_questions(waiting[:MOST_SHOWN], prepared)),
        "waiting": len(waiting),
        "students": sum(queued.count for queued in waiting),
        "decided": [row for row in rows if row.decision is not None][:MOST_SHOWN],
        "table": table,
        "nonce": secrets.token_urlsafe(16),
    }
    temporary = path.with_name(f".{path.name}.new")
    temporary.write_text(rendered("review.html", page=page), encoding="utf-8")
    os.replace(temporary, path)


def _questions(waiting: Sequence[QueuedAnswer], prepared: Prepared) -> Iterator[dict[str, Any]]:
    """Yield the values for the template of each question: its name, text, points and undecided answers."""
    for problem, question in prepared.questions():
        asked = (problem.id, question.id)
        answers = [queued for queued in waiting if (queued.item.problem, queued.item.question) == asked]
        if answers:
            name = f"{problem.id}.{question.id}"
            yield {"name": name, "asked": asked_text(question), "most": float(question.points), "answers": answers}


@dataclass(frozen=True)
class ReviewPaths:
    """The paths of the table and the page; ``shared``: whether the folder may contain other files."""

    table: Path
    page: Path
    shared: bool

    @classmethod
    def of_output(cls, out: Path, folder: bool) -> ReviewPaths:
        """Return the paths in a folder of results, or beside a file of results and named after it."""
        if folder:
            return cls(out / TABLE, out / PAGE, False)
        return cls(out.with_name(f"{out.stem}.{TABLE}"), out.with_name(f"{out.stem}.{PAGE}"), True)


@dataclass(frozen=True)
class RunReview:
    """{identity: row} of the existing tables; rows of ``--reviewed`` replace those beside the results."""

    paths: ReviewPaths | None
    rows: Mapping[str, ReviewRow]
    delimiter: str | None

    @classmethod
    def read(cls, prepared: Prepared, reviewed: Path | None, paths: ReviewPaths | None) -> RunReview:
        """Return the rows of both tables. Raises ReviewError and OSError."""
        asked = prepared.most_points()
        earlier, named = FilledTable(), FilledTable()
        if paths is not None and paths.table.exists():
            earlier = read_table(paths.table, asked)
        if reviewed is not None:
            named = read_table(reviewed, asked)
        rows = dict(earlier.rows)
        for identity, row in named.rows.items():
            if row.filled or identity not in rows:
                cells = rows[identity].cells if identity in rows else {}
                rows[identity] = replace(row, cells={**cells, **row.cells})
        return cls(paths, rows, earlier.delimiter or named.delimiter)

    def applied(self, prepared: Prepared) -> Prepared:
        """Return the assignment with the decisions of these rows."""
        return replace(prepared, decisions=FilledTable(self.rows).decisions)

    def write(self, results: Sequence[Result], prepared: Prepared) -> None:
        """Write the table and page of these results, and print where they are on standard error. Raises OSError."""
        if self.paths is None:
            return
        queue = queue_of(results, prepared)
        rows = list(queue.rows(self.rows))
        if not rows and self.paths.shared and not self.paths.table.exists():
            return
        self.paths.table.parent.mkdir(parents=True, exist_ok=True)
        write_table(rows, prepared, self.paths.table, self.delimiter)
        write_page(queue, rows, prepared, self.paths.page, self.paths.table.name)
        waiting = len(queue.open_answers())
        if waiting:
            different = "1 answer awaits" if waiting == 1 else f"{waiting} different answers await"
            next_command = f"fill in points, then grade again with --reviewed {self.paths.table}"
            print(f"{different} review in {self.paths.table}: {next_command}", file=sys.stderr)


def queue_of(results: Sequence[Result], prepared: Prepared, links: Sequence[str] = ()) -> Queue:
    """Return the queue of answers that a person must decide or has decided; ``links``: to the page of each result."""
    queue = Queue([(problem.id, question.id) for problem, question in prepared.questions()])
    for result, link in zip(results, links or [""] * len(results), strict=True):
        queue.add(result, link)
    return queue
