"""Still pictures of scenes: `draw`, `graph`, `phase`, `svg` for other pages, and `unanswered` for assignments."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from html import escape

import numpy as np

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import description_of
from dofkit.methods.classify import classify
from dofkit.pictures.constraint_graph import graph_sketch, hover_script
from dofkit.pictures.directions import coordinate_sketch, phase_sketch
from dofkit.pictures.files import DrawnSketch, has_matplotlib, png_of, svg_of
from dofkit.pictures.layout import WIDTH, page_of
from dofkit.pictures.mechanism import FREE_PLACES, is_bare, sketch_of
from dofkit.pictures.paper import Page
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.shapes import Sketch
from dofkit.pictures.stage import POINT, StagedScene, stage_of
from dofkit.pictures.words import contents
from dofkit.report import Report
from dofkit.scene.reading import SceneLike, load
from dofkit.scene.scene import Scene

#: The margin around a still picture on a page, in pixels.
BESIDE = 20.0
#: Symbols are enlarged if the shapes extend this much further than the points.
WIDER = 1.6
NOTHING = "The scene declares nothing that could move."
NO_AXES = "No geometry to draw: constraint graph. Shapes under `picture` in the scene would be drawn instead."
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width">
<style>:root {{ color-scheme: light dark; }}
body {{ margin: 1em; font-family: sans-serif; }} svg {{ max-width: 100%; height: auto; }}</style></head>
<body>
{body}</body></html>
"""


def without_text(sketch: Sketch) -> Sketch:
    """Return a sketch for a thumbnail: its shapes, and no text."""
    shapes = tuple(s for s in sketch.shapes if s.kind != "words")
    return replace(sketch, title="", answer="", notes=(), axes=(), shapes=shapes, meanings=None, measurable=False)


@dataclass(frozen=True, repr=False)
class Picture(DrawnSketch):
    """A still picture; a notebook shows it, and spatial ones can be rotated there."""

    script: str = ""

    @cached_property
    def page(self) -> Page:
        """The picture on paper."""
        return page_of(self.sketch)

    def svg(self) -> str:
        """Return the picture as the text of an SVG."""
        return svg_of(self.page, script=self.script)

    def html(self) -> str:
        """Return the picture as a page that needs no network; a spatial one rotates as it is dragged."""
        if self.sketch.dimension == 3:
            return page_html(self.sketch, ())
        return _PAGE.format(title=escape(self.sketch.title), body=self.svg())

    def _repr_html_(self) -> str:
        if self.sketch.dimension == 3:
            return framed(self.html(), page_height(self.sketch, ()))
        return framed(self.html(), self.page.height + 2 * BESIDE) if self.script else self.svg()

    def _repr_png_(self) -> bytes | None:
        return png_of(self.page) if has_matplotlib() else None


def draw(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return a picture of a scene: bodies, joints by their textbook symbols, redundant or conflicting constraints.

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
    return Picture(*whole_sketch(staged(*with_report(scene, report))))


def with_report(scene: SceneLike, report: Report | None) -> tuple[Scene, Report]:
    """Return (scene, report), reading the scene and computing the report if necessary."""
    if report is not None and not isinstance(report, Report):
        raise ArgumentError(f"a report is a Report, not {description_of(report)}; `save(path)` writes a picture")
    loaded = load(scene)
    return loaded, classify(loaded) if report is None else report


def staged(scene: Scene, report: Report) -> StagedScene:
    """Return a staged scene, with larger symbols if the shapes extend far beyond the points."""
    stage = stage_of(scene, report)
    if is_bare(stage.system):
        return stage
    sketch = sketch_of(stage)
    points = [sketch.at(v) for s in sketch.shapes if s.role in ("body", "locus") for v in s.vertices]
    reach = float(np.max(np.ptp(np.array(points), axis=0))) if points else 0.0
    return stage if reach < WIDER * stage.size else replace(stage, unit=max(stage.unit, 0.024 * reach))


def whole_sketch(stage: StagedScene) -> tuple[Sketch, str]:
    """Return (sketch of a scene of any kind, script for its SVG or an empty text)."""
    if stage.system.particles == (POINT,):
        return coordinate_sketch(stage), ""
    if not is_bare(stage.system) or stage.picture.shapes:
        return sketch_of(stage), ""
    reason = NO_AXES if stage.system.coordinates else NOTHING
    return graph_sketch(stage.scene, stage.system, stage.report, reason), hover_script(stage.report)


def graph(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return the constraint graph of a scene, with redundant constraints marked.

    Pointing at a constraint highlights its circuit, the constraints on which it depends (svg, html, notebooks).

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
    loaded, report = with_report(scene, report)
    return Picture(graph_sketch(loaded, stage_of(loaded, report).system, report), hover_script(report))


def phase(scene: SceneLike, report: Report | None = None) -> Picture:
    """Return a picture of the directions that differential constraints allow, and of those that brackets add.

    A disc or line shows the distribution D of admissible directions (with two coordinates over a grid); the arrows are
    brackets [X1, X2] of its vector fields. At most three coordinates are shown.

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
    return Picture(phase_sketch(stage_of(*with_report(scene, report))))


def svg(scene: SceneLike, report: Report | None = None, width: float = WIDTH) -> str:
    """Return the picture of `draw` as an ``svg`` element for another page, ``width`` pixels wide. Raises as `draw`."""
    return svg_of(draw(scene, report).page, width)


def unanswered(scene: Scene, report: Report, title: str) -> Picture | None:
    """Return the picture for an assignment; None if the scene has only coordinates and no `picture`. Raises as `draw`.

    It does not show the answers: no equations, motions, redundant or conflicting constraints, and no ruler.
    """
    if not (scene.particles or scene.bodies or scene.picture):
        return None
    stage = staged(scene, report)
    sketch = sketch_of(stage)
    shapes = tuple(s._replace(state="moving" if s.role in ("body", "point") else "plain") for s in sketch.shapes)
    notes = (FREE_PLACES,) if stage.schematic else ()
    plain = replace(sketch, title="", answer="", alternative=f"{contents(scene, title)}.", shapes=shapes)
    return Picture(replace(plain, meanings=None, measurable=False, notes=notes))
