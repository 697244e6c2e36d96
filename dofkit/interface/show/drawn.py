"""What `print` and a notebook show of every value that has a sheet: see `dofkit.base.display`."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TypeVar

from dofkit.base.display import Companion
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.result import Result
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.faults import panel_of
from dofkit.interface.show.motion import sheet_of_motion
from dofkit.interface.show.page import as_html
from dofkit.interface.show.picture import picture_of
from dofkit.interface.show.report import sheet_of_entry, sheet_of_report
from dofkit.interface.show.result import sheet_of_result
from dofkit.interface.show.scene import sheet_of_linkage, sheet_of_scene
from dofkit.interface.show.sheet import Sheet
from dofkit.interface.show.terminal import Screen, as_text
from dofkit.mobility.graph.linkage import Linkage
from dofkit.motion.lagrange.report import MotionReport
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.scene import Scene

__all__ = ["html_of", "latex_of", "panel_of", "text_of"]


Shown = TypeVar("Shown", Report, MotionReport)


def text_of(value: object, width: int | None, how: bool) -> str:
    """Lines for a terminal."""
    return as_text(sheet_of(value, how), Screen(width))


def html_of(value: object) -> str:
    """A piece of a page."""
    return as_html(sheet_of(value))


def latex_of(value: object) -> str | None:
    """A display in LaTeX; None for what has no formulas, or where one cannot be set."""
    lines = [typeset(text) for text in _formulas(value)]
    shown = [line for line in lines if line is not None]
    if not shown or len(shown) < len(lines):
        return None
    aligned = r" \\ ".join(line.replace("=", "&=", 1) for line in shown)
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
    """The sheet of a value. Raises TypeError for one that has none."""
    match value:
        case Report():
            return _beside(sheet_of_report(_printed(value), how=how), value._companion, value)
        case ConstraintEntry():
            return sheet_of_entry(value)
        case MotionReport():
            return _beside(sheet_of_motion(_printed(value)), value._companion)
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


def _beside(sheet: Sheet, companion: Companion, report: Report | None = None) -> Sheet:
    """With the title and the picture of the scene that it is about, where that is known."""
    scene = companion.about
    if not isinstance(scene, Scene):
        return sheet
    return sheet._replace(title=scene.title or "", picture=partial(picture_of, scene, report))
