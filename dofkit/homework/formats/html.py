"""Pages to read: one for each student, and an overview for the lecturer.

``index.html`` is the overview, ``students/`` holds the others; the answers that wait for a person stand in
``review.html``, if there are any. Every page stands alone: it loads nothing, runs nothing, and all that a student wrote
is escaped. Answers that need a review have no points, and the score says that it is not final.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, FormatError, Target
from dofkit.homework.formats.overview import Overview
from dofkit.homework.formats.pages import rendered, student_page
from dofkit.homework.formats.review import write_page
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.result import Result


def write(results: Iterator[Result], prepared: Prepared, target: Target, roster: Roster | None = None) -> None:
    """A folder of pages; by class where a ``roster`` tells them. Raises FormatError for what is no folder."""
    if not isinstance(target, Path) or (target.exists() and not target.is_dir()):
        raise FormatError("the format html writes a folder: give its name with --out")
    folder = target / "students"
    folder.mkdir(parents=True, exist_ok=True)
    names, overview = FileNames(), Overview(prepared, roster)
    for result in results:
        name = names.of(result.student)
        page = rendered("student.html", page=student_page(result, prepared))
        (folder / f"{name}.html").write_text(page, encoding="utf-8")
        overview.add(result, f"students/{name}.html")
    if overview.queue.open_answers():
        write_page(overview.queue, [], prepared, target / "review.html", "review.csv")
    (target / "index.html").write_text(rendered("overview.html", page=overview.page()), encoding="utf-8")


HTML = Format("html", write, needs_path=True, endings=())
