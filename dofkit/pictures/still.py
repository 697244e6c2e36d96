"""Still pictures of scenes, and the doors to them: `draw`, `graph`, `phase`, and `svg` for inside of other pages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TypeVar

import numpy as np

from dofkit.base.arguments import format_of_path
from dofkit.methods.classify import classify
from dofkit.pictures.constraint_graph import graph_sketch, hover_script
from dofkit.pictures.coordinates import MOST, coordinate_sketch, is_bare
from dofkit.pictures.directions import phase_sketch
from dofkit.pictures.layout import WIDTH, page_of
from dofkit.pictures.mechanism import sketch_of
from dofkit.pictures.paper import Page
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.raster import has_matplotlib, png_of, write_pdf
from dofkit.pictures.shapes import Sketch
from dofkit.pictures.stage import StagedScene, stage_of
from dofkit.pictures.vector import svg_of
from dofkit.report import Report
from dofkit.scene.reading import SceneLike, load
from dofkit.scene.scene import Scene

#: Pixels around a still picture on a page of its own.
BESIDE = 20.0
#: A picture that reaches so much further than its places has larger symbols.
WIDER = 1.6
NOTHING = "The scene declares nothing that could move."
NO_AXES = "No geometry to draw: constraint graph."


@dataclass(frozen=True)
class Picture:
    """A still picture; a notebook shows it, those of space can be turned there.

    ``alternative`` says in words what it shows and the answer.
    """

    sketch: Sketch
    script: str = ""

    def __repr__(self) -> str:
        return f"Picture({self.alternative!r})"

    @property
    def alternative(self) -> str:
        """What the picture says, in words."""
        return self.sketch.alternative

    @cached_property
    def page(self) -> Page:
        """The picture on paper."""
        return page_of(self.sketch)

    def svg(self) -> str:
        """The picture as the text of an SVG."""
        return svg_of(self.page, script=self.script)

    def html(self) -> str:
        """The picture as a page of its own, that needs no network; one of space turns as it is dragged."""
        if self.sketch.dimension == 3:
            return page_html(self.sketch, ())
        return _PAGE.format(title=escape(self.sketch.title), body=self.svg())

    def save(self, path: str | Path) -> Path:
        """Write it as svg, png, pdf or html, by the path's ending.

        Raises ArgumentError for any other ending, ExtraMissingError where matplotlib is needed and missing, OSError.
        """
        return saved(self, path, _WRITERS)

    def _repr_html_(self) -> str:
        if self.sketch.dimension == 3:
            return framed(self.html(), page_height(self.sketch, ()))
        return framed(self.html(), self.page.height + 2 * BESIDE) if self.script else self.svg()

    def _repr_png_(self) -> bytes | None:
        return png_of(self.page) if has_matplotlib() else None


_Drawn = TypeVar("_Drawn")


def saved(picture: _Drawn, path: str | Path, writers: Mapping[str, Callable[[_Drawn, Path], None]]) -> Path:
    """Write a picture with the one of the ``writers`` that the path's ending asks for; returns the path.

    Raises ArgumentError for any other ending, and what the writer raises.
    """
    target = Path(path)
    writers[format_of_path(target, writers)](picture, target)
    return target


_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width">
<style>:root {{ color-scheme: light dark; }}
body {{ margin: 1em; font-family: sans-serif; }} svg {{ max-width: 100%; height: auto; }}</style></head>
<body>
{body}</body></html>
"""


def _write_text(text: Callable[[Picture], str]) -> Callable[[Picture, Path], None]:
    def write(picture: Picture, path: Path) -> None:
        path.write_text(text(picture), encoding="utf-8")

    return write


def _write_png(picture: Picture, path: Path) -> None:
    path.write_bytes(png_of(picture.page))


_WRITERS: Mapping[str, Callable[[Picture, Path], None]] = {
    "svg": _write_text(Picture.svg),
    "png": _write_png,
    "pdf": lambda picture, path: write_pdf(picture.page, path),
    "html": _write_text(Picture.html),
}


def draw(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return a picture of a scene: bodies, joints by their textbook symbols, what is redundant or contradictory.

    Positions that the scene does not give are chosen, and the picture says so. A scene of coordinates
    only shows the set that they can reach, or its constraint graph.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name or a mapping.
    report
        The report of `classify`, if it is known already.

    Returns
    -------
    Picture
        Shown by a notebook; ``save(path)`` writes svg, png, pdf or html. Lengths are in the scene's units.

    Raises
    ------
    SceneError, ArgumentError
        As for `load`.
    ExtraMissingError
        If matplotlib is needed and not installed.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.draw("four-bar-linkage").alternative
    'Planar four-bar linkage: 3 bodies, 4 constraints. 1 degree of freedom (proved).'
    """
    given = load(scene)
    told = classify(given) if report is None else report
    return Picture(*whole_sketch(staged(given, told)))


def staged(scene: Scene, report: Report) -> StagedScene:
    """The scene with its places, symbols as large as the whole picture needs them."""
    stage = stage_of(scene, report)
    if is_bare(stage.system):
        return stage
    sketch = sketch_of(stage)
    points = [sketch.at(v) for s in sketch.shapes if s.role in ("body", "locus") for v in s.vertices]
    reach = float(np.max(np.ptp(np.array(points), axis=0))) if points else 0.0
    if reach < WIDER * stage.size:
        return stage
    return replace(stage, unit=max(stage.unit, 0.024 * reach))


def whole_sketch(stage: StagedScene) -> tuple[Sketch, str]:
    """The sketch of a scene of any kind, and the script that goes with it."""
    if not is_bare(stage.system):
        return sketch_of(stage), ""
    if 0 < len(stage.system.coordinates) <= MOST:
        return coordinate_sketch(stage), ""
    reason = NO_AXES if stage.system.coordinates else NOTHING
    return graph_sketch(stage.scene, stage.system, stage.report, reason), hover_script(stage.report)


def graph(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return the constraint graph of a scene, with redundant constraints marked.

    Pointing at a constraint highlights the circuit that it belongs to (svg, html, notebooks).

    Parameters
    ----------
    scene, report
        As for `draw`.

    Returns
    -------
    Picture
        As for `draw`.

    Raises
    ------
    SceneError, ArgumentError, ExtraMissingError
        As for `draw`.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.graph("five-particles-ten-links").alternative.split(":")[0]
    'Five particles rigidly connected, link by link'
    """
    given = load(scene)
    told = classify(given) if report is None else report
    return Picture(graph_sketch(given, stage_of(given, told).system, told), hover_script(told))


def phase(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return a picture of the directions that differential constraints allow, and of those that brackets add.

    A small disc or line at each point is the distribution D; the arrows are brackets [X1, X2] of its vector fields. At
    most three coordinates are shown.

    Parameters
    ----------
    scene, report
        As for `draw`.

    Returns
    -------
    Picture
        As for `draw`.

    Raises
    ------
    NoFormsError
        If there is no differential constraint.
    SceneError, ArgumentError, ExtraMissingError
        As for `draw`.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.phase("disc-rolling-on-plane").sketch.notes[0].split(";")[0]
    'Growth vector (2, 3, 4)'
    """
    given = load(scene)
    told = classify(given) if report is None else report
    return Picture(phase_sketch(stage_of(given, told)))


def svg(scene: SceneLike, report: Report | None = None, width: float = WIDTH) -> str:
    """A small picture of a scene as the text of an ``svg`` element, for inside of another page; it is `draw`'s.

    ``width`` is in the page's pixels. Raises as `draw` does.
    """
    return svg_of(draw(scene, report).page, width)
