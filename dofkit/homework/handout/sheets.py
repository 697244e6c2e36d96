"""Sheets written to files as HTML or as Markdown."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import stem
from dofkit.homework.handout.composition import SheetComposer
from dofkit.homework.handout.markup import (
    Draw,
    SheetFigure,
    figure_of,
    file_of,
    page_of,
    pictures_of,
    unset_formulas,
    with_latex,
)
from dofkit.homework.problem import Problem
from dofkit.homework.questions import MOTION
from dofkit.homework.questions.equations import EquationQuestion


class WrittenSheet(NamedTuple):
    """A sheet in Markdown, with {path: picture}."""

    markdown: str
    title: str
    language: str
    figures: dict[str, SheetFigure]


def written_sheet(prepared: Prepared, draw: Draw, whose: str | None = None, has_fields: bool = False) -> WrittenSheet:
    """Return the sheet of an assignment. Raises FigureError, and OSError for a figure that cannot be read.

    ``has_fields``: whether answers are typed into the page.
    """
    of_problem: dict[str, SheetFigure] = {}
    others: dict[str, SheetFigure] = {}
    for problem in prepared.assignment.problems:
        figure = _figure(problem, prepared, draw, whose)
        if figure is not None:
            of_problem[problem.id] = figure
        for n, source in enumerate(dict.fromkeys(pictures_of(problem.text or "")), 1):
            others[source] = file_of(source, prepared.base, f"{_path(problem, whose)}-{n}")
    assignment = prepared.assignment
    markdown = SheetComposer(prepared, of_problem, whose, has_fields).markdown()
    for source, figure in others.items():
        markdown = markdown.replace(f"]({source}", f"]({figure.path}")
    figures = {figure.path: figure for figure in (*of_problem.values(), *others.values())}
    return WrittenSheet(markdown, assignment.title, assignment.language, figures)


def _figure(problem: Problem, prepared: Prepared, draw: Draw, whose: str | None) -> SheetFigure | None:
    key = prepared.keys[problem.id]
    path = _path(problem, whose)
    return figure_of(problem, lambda: draw(key.scene, key.report, problem.title or problem.id), prepared.base, path)


def _path(problem: Problem, whose: str | None) -> str:
    """Return the path of a problem's picture in the sheet's folder, without extension; it depends on the student."""
    return "/".join(["figures", *([] if whose is None else [stem(whose)]), stem(problem.id)])


def write_html(prepared: Prepared, draw: Draw, out: Path, whose: str | None = None) -> None:
    """Write a sheet as one HTML page without scripts. Raises FigureError and OSError."""
    sheet = written_sheet(prepared, draw, whose)
    out.write_text(page_of(sheet.markdown, sheet.title, sheet.language, sheet.figures), encoding="utf-8")


def write_markdown(prepared: Prepared, draw: Draw, out: Path, whose: str | None = None) -> None:
    """Write a sheet as Markdown, with its pictures beside it. Raises FigureError and OSError."""
    sheet = written_sheet(prepared, draw, whose)
    out.write_text(with_latex(sheet.markdown), encoding="utf-8")
    for path, figure in sheet.figures.items():
        target = out.parent / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(figure.data)


def remarks(prepared: Prepared, is_preview: bool = False) -> Iterator[str]:
    """Yield remarks on a sheet for the lecturer; ``is_preview``: whether it is for no particular student."""
    if prepared.combinations and is_preview:
        yield "it varies: this is a preview with the first value of each name"
    for problem in prepared.assignment.problems:
        for text in unset_formulas(problem.text or ""):
            yield f"problem '{problem.id}': the formula ${text}$ cannot be typeset, and is shown as typed"
        if problem.text is None:
            if any(isinstance(question, MOTION) for question in problem.questions):
                yield f"problem '{problem.id}': the handout does not state the forces and masses: state them in `text`"
            key = prepared.keys[problem.id]
            scene = dict(zip(key.constraints, key.scene.constraints, strict=True))
            asked = [n for q in problem.questions if isinstance(q, EquationQuestion) for n in q.constraint]
            for name in dict.fromkeys(n for n in asked if scene[n].facts.written):
                yield (
                    f"problem '{problem.id}': the equation of '{name}' is asked for, and the scene contains only "
                    "this equation: describe the system in `text`"
                )
