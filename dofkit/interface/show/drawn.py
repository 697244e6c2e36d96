"""What `print` and a notebook show of every value that has a sheet: see `dofkit.base.display`."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, TypeVar

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.formats.wording import STATUSES, line, number, points, standing, title
from dofkit.homework.result import Item, Result, Status
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.faults import panel_of
from dofkit.interface.show.motion import sheet_of_motion
from dofkit.interface.show.page import as_html
from dofkit.interface.show.report import sheet_of_entry, sheet_of_report
from dofkit.interface.show.scene import sheet_of_linkage, sheet_of_scene
from dofkit.interface.show.sheet import Column, Fact, Grid, Remark, Sheet, SheetSection, Tone
from dofkit.interface.show.terminal import Screen, as_text
from dofkit.mobility.graph.linkage import Linkage
from dofkit.motion.lagrange.report import MotionReport
from dofkit.report import Companion, ConstraintEntry, Report
from dofkit.scene.scene import Scene

__all__ = ["html_of", "latex_of", "panel_of", "text_of"]


Shown = TypeVar("Shown", Report, MotionReport)


def text_of(value: object, width: int | None, how: bool) -> str:
    """Return lines for a terminal."""
    return as_text(sheet_of(value, how), Screen(width))


def html_of(value: object) -> str:
    """Return a piece of a page."""
    return as_html(sheet_of(value))


def latex_of(value: object) -> str | None:
    """Return a display in LaTeX, or None if there are no formulas or one cannot be typeset."""
    lines = [typeset(text) for text in _formulas(value)]
    displays = [line for line in lines if line is not None]
    if not displays or len(displays) < len(lines):
        return None
    aligned = r" \\ ".join(line.replace("=", "&=", 1) for line in displays)
    return rf"$\displaystyle \begin{{aligned}}{aligned}\end{{aligned}}$"


def _formulas(value: object) -> Iterator[str]:
    if isinstance(value, MotionReport):
        yield f"L = {value.lagrangian}"
        yield from value.equations
        yield from value.constraints
    elif isinstance(value, ConstraintEntry):
        yield value.text
        if value.integral is not None:
            yield value.integral


def sheet_of(value: object, how: bool = False) -> Sheet:
    """Return the sheet of a value. Raises TypeError for a value that has none."""
    match value:
        case Report():
            return _about(sheet_of_report(_printed(value), how=how), value._companion, value)
        case ConstraintEntry():
            return sheet_of_entry(value)
        case MotionReport():
            return _about(sheet_of_motion(_printed(value)), value._companion)
        case Scene():
            return sheet_of_scene(value)._replace(picture=partial(picture_of, value))
        case Linkage():
            return sheet_of_linkage(value)
        case Result():
            return sheet_of_result(value)
        case _:
            raise TypeError(f"there is nothing to show of a {type(value).__name__}")


def _printed(report: Shown) -> Shown:
    """Return a report as it is printed, with decimals where its scene has decimals."""
    scene = report._companion.about
    return as_the_scene(report, scene) if isinstance(scene, Scene) else report


def _about(sheet: Sheet, companion: Companion, report: Report | None = None) -> Sheet:
    """Return a sheet with the title and the picture of its scene, if the scene is known."""
    scene = companion.about
    if not isinstance(scene, Scene):
        return sheet
    return sheet._replace(title=scene.title or "", picture=partial(picture_of, scene, report))


#: Seconds for a picture; without a report the scene is classified for it.
DRAWING = 5.0


def picture_of(scene: Any, report: Report | None = None) -> str | None:
    """Return the inline SVG of a scene, or None without pictures or if it cannot be drawn in time."""
    try:
        from dofkit.pictures.still import svg  # most values are shown without a picture

        with limited(DRAWING):
            return svg(scene, report)
    except (ImportError, DofkitError):
        return None


_TONES: dict[Status, Tone] = {"right": "good", "partly": "care", "wrong": "bad"}
_COLUMNS = (Column("question"), Column("points"), Column("status"), Column("read as", 1))


def sheet_of_result(result: Result) -> Sheet:
    """Return the sheet of a graded submission: the points, one line for each answer, and the feedback."""
    tone = _TONES.get("right" if result.score == result.max_score else "partly", "plain")
    score = "open" if result.score is None else f"{number(result.score)} of {number(result.max_score)}"
    sections = (
        [SheetSection("Answers", [Grid(_COLUMNS, [_row(item) for item in result.items])])] if result.items else []
    )
    feedback = [Remark(title(item), line(item.feedback)) for item in result.items if item.feedback]
    if feedback:
        sections.append(SheetSection("Feedback", feedback))
    facts = (
        [Fact("points", score, standing(result), tone)]
        if result.error or result.needs_review
        else [Fact("points", score, tone=tone)]
    )
    return Sheet(line(result.student), facts=facts, sections=sections)


def _row(item: Item) -> tuple[str, str, str, str]:
    return title(item), points(item), STATUSES[item.status], line(item.read_as)
