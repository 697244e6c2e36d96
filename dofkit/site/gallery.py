"""The gallery: pages of the catalog's scenes with their pictures and reports."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from html import escape
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.methods.classify import classify
from dofkit.pictures.files import svg_of
from dofkit.pictures.layout import page_of
from dofkit.pictures.still import draw, without_text
from dofkit.report import Report
from dofkit.scene.catalog import catalog_files, catalog_folder, catalog_text
from dofkit.scene.constraints.base import Equation
from dofkit.scene.reading import loads
from dofkit.scene.scene import Scene
from dofkit.site.markdown import SitePage, rendered

FOLDER = "gallery"
#: The width of a picture in pixels, and of a report in columns.
PIXELS, COLUMNS = 440.0, 88


class ShownScene(NamedTuple):
    """A scene with its text (``written``), its picture in two sizes, its report in a line (``answer``) and in full."""

    name: str
    folder: str
    title: str
    written: str
    types: tuple[str, ...]
    svg: str
    thumbnail: str
    alternative: str
    formulas: str
    answer: str
    report: str


def folders() -> dict[str, str]:
    """Return {folder: source of its scenes}, from the table in the catalog's README."""
    text = (catalog_folder() / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"\| `(\w+)` \| ([^|]+)\|", text)
    return {name: source.strip()[:1].upper() + source.strip()[1:] for name, source in rows}


def catalog_scenes() -> Iterator[ShownScene]:
    """Yield every scene of the catalog, folder by folder."""
    for name, file in catalog_files().items():
        yield shown_scene(name, Path(str(file)).parent.name, catalog_text(name))


def shown_scene(name: str, folder: str, written: str) -> ShownScene:
    """Return a scene with its picture and its report. Raises SceneError if ``written`` cannot be read."""
    scene = loads(written, name)
    report = classify(scene)
    drawn = draw(scene, report)
    return ShownScene(
        name=name,
        folder=folder,
        title=scene.title or name,
        written=written,
        types=tuple(dict.fromkeys(entry.type for entry in report.constraints)),
        svg=svg_of(drawn.page, PIXELS),
        thumbnail=svg_of(page_of(without_text(drawn.sketch)), PIXELS),
        alternative=drawn.alternative,
        formulas="".join(_formulas(scene, report)),
        answer=in_a_line(report),
        report=report.text(COLUMNS),
    )


def _formulas(scene: Scene, report: Report) -> Iterator[str]:
    """Yield, as HTML list items with MathML, the constraints that are equations and can be typeset."""
    for constraint, entry in zip(scene.constraints, report.constraints, strict=True):
        latex = typeset(entry.text) if isinstance(constraint, Equation) else None
        if latex is not None:
            name = escape(entry.name, quote=False)
            yield f'<li>{name}: <math aria-label="{escape(entry.text)}">{mathml(latex)}</math></li>'


def in_a_line(report: Report) -> str:
    """Return the freedom, the velocity freedom, the labels of the system and the verdict, in one line."""
    if report.consistent is False:
        return f"inconsistent: {', '.join(report.conflicting or ())} ({report.verdict})"
    labels = [f"f = {'undecided' if report.dof is None else report.dof}"]
    if report.velocity_dof is not None and report.velocity_dof != report.dof:
        labels.append(f"velocity freedom {report.velocity_dof}")
    for value, yes, no in (
        (report.holonomic, "holonomic", "non-holonomic"),
        (report.scleronomic, "scleronomic", "rheonomic"),
    ):
        if value is not None and report.constraints:
            labels.append(yes if value else no)
    if report.redundant:
        labels.append(f"redundant: {', '.join(report.redundant)}")
    return f"{', '.join(labels)} ({report.verdict})"


def gallery_pages(
    catalog: Sequence[ShownScene], sources: dict[str, str], has_bench: bool = False
) -> Iterator[SitePage]:
    """Yield the pages and pictures of the gallery; ``sources``: {folder of the catalog: where its scenes come from}."""
    shelves = [
        (folder, sources.get(folder, folder), list(scenes))
        for folder, scenes in groupby(catalog, key=attrgetter("folder"))
    ]
    for folder, source, scenes in shelves:
        text = rendered("folder.md", source=source, scenes=scenes, has_bench=has_bench)
        yield SitePage(f"{FOLDER}/{folder}.md", text)
        yield from (SitePage(f"{FOLDER}/{scene.name}.svg", scene.svg) for scene in scenes)
        yield from (SitePage(f"{FOLDER}/{scene.name}-small.svg", scene.thumbnail) for scene in scenes)
    yield SitePage(f"{FOLDER}/index.md", rendered("gallery.md", number=len(catalog), folders=shelves))
