"""Pages to read: one for each student, and an overview for the lecturer.

``index.html`` is the overview, ``students/`` holds the others. Every page stands alone: it loads nothing, runs nothing,
and all that a student wrote is escaped. Answers that need a review have no points, and the score says that it is not
final.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, FormatError, Target
from dofkit.homework.formats.html.overview import Overview
from dofkit.homework.formats.html.pages import BADGES, student_page
from dofkit.homework.formats.wording import FileNames, line, number, plain
from dofkit.homework.result import Result

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(plain=plain, line=line, number=number)
    environment.globals["badges"] = BADGES
    return environment


def rendered(template: str, **values: Any) -> str:
    """A page."""
    return _environment().get_template(template).render(**values)


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """A folder of pages. Raises FormatError for what is no folder."""
    if not isinstance(target, Path) or (target.exists() and not target.is_dir()):
        raise FormatError("the format html writes a folder: name one with --out")
    folder = target / "students"
    folder.mkdir(parents=True, exist_ok=True)
    names, overview = FileNames(), Overview(prepared)
    for result in results:
        name = names.of(result.student)
        page = rendered("student.html", page=student_page(result, prepared))
        (folder / f"{name}.html").write_text(page, encoding="utf-8")
        overview.add(result, f"students/{name}.html")
    (target / "index.html").write_text(rendered("overview.html", page=overview.page()), encoding="utf-8")


HTML = Format("html", write, needs_path=True)
