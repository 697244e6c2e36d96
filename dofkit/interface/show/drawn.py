"""The texts, HTML and LaTeX that `print` and notebooks show of a value (see `dofkit.base.display`)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, TypeVar

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.base.wording import many
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.formats.wording import STATUSES, line, number, points, standing, title
from dofkit.homework.result import Item, Result, Status
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.faults import panel_of
from dofkit.interface.show.motion import sheet_of_motion
from dofkit.interface.show.page import as_html
from dofkit.interface.show.report import MOST_ROWS, names_of, sheet_of_entry, sheet_of_report
from dofkit.interface.show.sheet import TONES, Column, Fact, Formula, Grid, Remark, Sheet, SheetSection, Tone
from dofkit.interface.show.terminal import as_text
from dofkit.mobility.graph.linkage import Linkage
from dofkit.motion.lagrange.report import MotionReport
from dofkit.report import Companion, ConstraintEntry, Report
from dofkit.scene.constraints.base import Equation
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene

_CONSTRAINT_COLUMNS = (Column("name"), Column("text", 1), Column("type"))


def sheet_of_scene(scene: Scene) -> Sheet:
    """Return the sheet of a scene: its objects, constraints, forces and energies, as written."""
    sections = []
    if scene.constraints:
        names = [c.name or f"c{i}" for i, c in enumerate(scene.constraints, 1)]
        texts = [Formula(c.text) if isinstance(c, Equation) else c.in_words for c in scene.constraints]
        rows = [(n, text, c.kind()) for n, text, c in zip(names, texts, scene.constraints, strict=True)]
        sections.append(SheetSection("Constraints", [Grid(_CONSTRAINT_COLUMNS, rows[:MOST_ROWS])], _more(len(rows))))
    if scene.forces:
        named = [(f.name or f"f{i}", f.type) for i, f in enumerate(scene.forces, 1)]
        sections.append(SheetSection("Forces", [Remark(name, kind) for name, kind in named]))
    if scene.energies is not None:
        sections.append(SheetSection("Energies", list(_energies(scene))))
    return Sheet(scene.name, scene.title or "", facts=tuple(_facts(scene)), sections=sections)


def _more(rows: int) -> str:
    return f"... and {rows - MOST_ROWS} more" if rows > MOST_ROWS else ""


def _facts(scene: Scene) -> Iterator[Fact]:
    yield Fact("world", many(scene.dimension, "dimension"))
    if scene.particles:
        yield Fact("particles", names_of([p.name for p in scene.particles]))
    if scene.bodies:
        yield Fact("bodies", names_of([b.name for b in scene.bodies]))
    coordinates = [c.name for c in coordinate_table(scene).coordinates]
    if coordinates:
        yield Fact("coordinates", names_of(coordinates), f"({len(coordinates)})")
    if scene.parameters:
        yield Fact("parameters", names_of([_parameter(n, str(v)) for n, v in scene.parameters.items()]))
    if scene.functions:
        yield Fact("functions", names_of([f"{n}({', '.join(a)})" for n, a in scene.functions.items()]))
    if scene.tolerance is not None:
        yield Fact("measured", f"to within {float(scene.tolerance):g} of the scene's size")
    if scene.source:
        yield Fact("source", scene.source)
    if scene.notes:
        yield Fact("notes", " ".join(scene.notes.split()))


def _parameter(name: str, value: str) -> str:
    return f"{name} ({value})" if value in ("real", "positive", "nonzero") else f"{name} = {value}"


def _energies(scene: Scene) -> Iterator[Remark]:
    energies = scene.energies
    if energies is None:
        return
    for label, text in (("T", energies.kinetic), ("V", energies.potential), ("D", energies.dissipation)):
        if text is not None:
            yield Remark("", Formula(f"{label} = {text}"))
    for name, text in energies.forces.items():
        yield Remark("", Formula(f"Q_{name} = {text}"))


def sheet_of_linkage(linkage: Linkage) -> Sheet:
    """Return the sheet of a graph of links: joints, links, freedom and redundant links."""
    inner = f"{linkage.inner_freedom} internal, beyond the motions as one rigid body"
    facts = [
        Fact("joints", str(len(linkage.joints)), f"in {many(linkage.dimension, 'dimension')}, in general position"),
        Fact("links", str(len(linkage.links)), f"of which {linkage.rank} are independent"),
        Fact("freedom", str(linkage.freedom), "one rigid body" if linkage.rigid else inner),
        Fact("verdict", linkage.verdict, tone=TONES[linkage.verdict]),
    ]
    remarks = [Remark("redundant", names_of([f"{a}-{b}" for a, b in linkage.redundant]))] if linkage.redundant else []
    return Sheet("linkage", facts=facts, sections=[SheetSection("Redundancy", remarks)] if remarks else [])


__all__ = ["html_of", "latex_of", "panel_of", "text_of"]


Shown = TypeVar("Shown", Report, MotionReport)


def text_of(value: object, width: int | None, how: bool) -> str:
    """Return a value as lines for a terminal; ``how``: with the arguments of a report."""
    return as_text(sheet_of(value, how), width)


def html_of(value: object) -> str:
    """Return a value as HTML without head and body."""
    return as_html(sheet_of(value))


def latex_of(value: object) -> str | None:
    """Return the formulas of a value in LaTeX, or None if there are none or one cannot be typeset."""
    lines = [typeset(text) for text in _formulas(value)]
    displays = [line for line in lines if line is not None]
    if not displays or len(displays) < len(lines):
        return None
    aligned = r" \\ ".join(line.replace("=", "&=", 1) for line in displays)
    return rf"$\displaystyle \begin{{aligned}}{aligned}\end{{aligned}}$"


def _formulas(value: object) -> Iterator[str]:
    """Yield the formulas of a value that a notebook typesets."""
    if isinstance(value, MotionReport):
        yield f"L = {value.lagrangian}"
        yield from value.equations
        yield from value.constraints
    elif isinstance(value, ConstraintEntry):
        yield value.text
        if value.integral is not None:
            yield value.integral


def sheet_of(value: object, how: bool = False) -> Sheet:
    """Return the sheet of a value. Raises TypeError for other types."""
    match value:
        case Report():
            return _with_title_and_picture(sheet_of_report(_printed(value), how=how), value._companion, value)
        case ConstraintEntry():
            return sheet_of_entry(value)
        case MotionReport():
            return _with_title_and_picture(sheet_of_motion(_printed(value)), value._companion)
        case Scene():
            return sheet_of_scene(value)._replace(picture=partial(picture_of, value))
        case Linkage():
            return sheet_of_linkage(value)
        case Result():
            return sheet_of_result(value)
        case _:
            raise TypeError(f"there is nothing to show of a {type(value).__name__}")


def _printed(report: Shown) -> Shown:
    """Return a report as it is printed: with decimals if its scene is written with decimals."""
    scene = report._companion.about
    return as_the_scene(report, scene) if isinstance(scene, Scene) else report


def _with_title_and_picture(sheet: Sheet, companion: Companion, report: Report | None = None) -> Sheet:
    """Return a sheet with the title and the picture of its scene, if the scene is known."""
    scene = companion.about
    if not isinstance(scene, Scene):
        return sheet
    return sheet._replace(title=scene.title or "", picture=partial(picture_of, scene, report))


#: The time limit in seconds for a picture, which without a report includes classifying the scene.
DRAWING = 5.0


def picture_of(scene: Any, report: Report | None = None) -> str | None:
    """Return the inline SVG of a scene, or None if it cannot be drawn in time or a package is missing."""
    try:
        from dofkit.pictures.still import svg  # most values are shown without a picture

        with limited(DRAWING):
            return svg(scene, report)
    except (ImportError, DofkitError):
        return None


_TONES: dict[Status, Tone] = {"right": "good", "partly": "care", "wrong": "bad"}
_COLUMNS = (Column("question"), Column("points"), Column("status"), Column("read as", 1))


def sheet_of_result(result: Result) -> Sheet:
    """Return the sheet of a graded submission: points, one line for each answer, and feedback."""
    tone = _TONES.get("right" if result.score == result.max_score else "partly", "plain")
    score = "open" if result.score is None else f"{number(result.score)} of {number(result.max_score)}"
    rows = [_row(item) for item in result.items]
    sections = [SheetSection("Answers", [Grid(_COLUMNS, rows)])] if rows else []
    feedback = [Remark(title(item), line(item.feedback)) for item in result.items if item.feedback]
    if feedback:
        sections.append(SheetSection("Feedback", feedback))
    note = standing(result) if result.error or result.needs_review else ""
    facts = [Fact("points", score, note, tone)]
    return Sheet(line(result.student), facts=facts, sections=sections)


def _row(item: Item) -> tuple[str, str, str, str]:
    return title(item), points(item), STATUSES[item.status], line(item.read_as)
