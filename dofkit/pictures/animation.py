"""Moving pictures of scenes (`animate`): a sampled finite motion, or each infinitesimal freedom on its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from dofkit.pictures.files import DrawnSketch, ExtraMissingError, Writer, draw_marks, figure_of, require_matplotlib
from dofkit.pictures.joints import with_long_guides
from dofkit.pictures.layout import Standpoint, page_of, standpoint_of
from dofkit.pictures.loop_clips import loop_clips, loop_notes, traces
from dofkit.pictures.motion_clips import ClipMaker
from dofkit.pictures.paper import Page
from dofkit.pictures.planar_program import PlanarProgram, planar_program
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.shapes import Clip, Shape, Switch, fixed
from dofkit.pictures.still import staged, whole_sketch, with_report
from dofkit.pictures.words import can_hold
from dofkit.report import Report
from dofkit.scene.reading import SceneLike

#: Frames per second and dots per inch of films, and the colours of a gif.
RATE, DOTS, COLOURS = 20, 80, 40
NO_FFMPEG = "an mp4 needs the program ffmpeg, which is not on the path: install it, or save a gif or html"
STILL, NOT_SHOWN = "Nothing moves.", "No motion was found that could be shown."


@dataclass(frozen=True, repr=False)
class Animation(DrawnSketch):
    """A moving picture; a notebook shows it with a slider and a button that plays it.

    ``clips`` are its motions: finite ones that were sampled, and infinitesimal ones. ``switches`` leave out
    constraints; ``program`` lets a page drag the points of a planar scene.
    """

    clips: tuple[Clip, ...] = ()
    program: PlanarProgram | None = None
    switches: tuple[Switch, ...] = ()

    def html(self) -> str:
        """Return a page that needs no network, with a slider, a button, and a choice of motions."""
        return page_html(self.sketch, self.clips, self.program, self.switches)

    def pages(self) -> Iterator[Page]:
        """Yield every frame as a page, motion after motion; one that is not closed is also played backwards."""
        standpoint = self._standpoint
        if not self.clips:
            yield page_of(self.sketch)
        for clip in self.clips:
            last = len(clip.frames) - 1
            back = () if clip.closed or clip.loop else range(last - 1, 0, -1)
            for number in (*range(last + 1), *back):
                yield self._page(clip, number, standpoint, traced=clip.loop)

    @property
    def page(self) -> Page:
        """The last frame of the first motion (of a loop the largest) as a page, with the traced paths."""
        if not self.clips:
            return page_of(self.sketch)
        clip = [clip for clip in self.clips if clip.name == self.clips[0].name][-1]
        return self._page(clip, len(clip.frames) - 1, self._standpoint, traced=True)

    @property
    def _standpoint(self) -> Standpoint:
        return standpoint_of(self.sketch, [frame for clip in self.clips for frame in clip.frames])

    def _page(self, clip: Clip, number: int, standpoint: Standpoint, *, traced: bool) -> Page:
        arrows = (Shape("arrow", fixed(*ends), "arrow", size=0.04 * self.sketch.size) for ends in clip.arrows)
        drawn = (*self.sketch.shapes, *arrows, *(traces(self.sketch, clip, number) if traced else ()))
        sketch = replace(self.sketch, answer=f"{self.sketch.answer}; {clip.text or clip.name}", shapes=drawn)
        return page_of(sketch, clip.frames[number], standpoint)

    def writers(self) -> Mapping[str, Writer]:
        """Return {file extension: function that writes the file}."""
        return {**super().writers(), "gif": partial(_write_gif, self), "mp4": partial(_write_mp4, self)}

    def _repr_html_(self) -> str:
        return framed(self.html(), page_height(self.sketch, self.clips, self.switches))


def animate(scene: SceneLike, report: Report | None = None, *, loop: bool = False) -> Animation:
    """Return a moving picture of a scene: its free velocities in turn, as finite motions where they could be followed.

    Parameters
    ----------
    scene, report
        As for `draw`.
    loop
        Whether pairs of free coordinates move around a closed loop instead: with non-holonomic constraints the other
        coordinates end displaced, by about what the bracket of the two directions predicts.

    Returns
    -------
    Animation
        Shown by a notebook with a slider; ``save(path)`` writes html, gif or mp4, and svg, png or pdf of its end. A
        scene that cannot move gives a still picture that says so.

    Raises
    ------
    SceneError, ArgumentError, ExtraMissingError
        As for `draw`.
    NoMotionError
        If there is no loop: with one free velocity, or if time occurs.

    Examples
    --------
    >>> import dofkit
    >>> len(dofkit.animate("four-bar-linkage").clips)
    1
    >>> print(dofkit.animate("disc-rolling-on-plane", loop=True).clips[0].text)
    theta and phi return; displaced are x by -0.191 (bracket: -0.192) and y by -0.0387 (bracket: -0.039).
    """
    loaded, report = with_report(scene, report)
    stage = staged(loaded, report)
    sketch = whole_sketch(stage)[0]
    program = planar_program(stage, sketch.dimension)
    if loop:
        loops, stopped = loop_clips(stage)
        notes = (*loop_notes(report), *stopped, *sketch.notes)
        return Animation(replace(sketch, notes=notes), tuple(loops), program)
    maker = ClipMaker(stage, sketch)
    switches = list(maker.switches())
    clips = (*maker.clips(), *(clip for _, new in switches for clip in new))
    sketch = with_long_guides(stage, sketch, clips)
    immobile = (report.velocity_dof == 0 and report.scleronomic) or not can_hold(report)
    notes = sketch.notes if clips else (*sketch.notes, STILL if immobile else NOT_SHOWN)
    return Animation(replace(sketch, notes=notes), clips, program, tuple(switch for switch, _ in switches))


def _write_film(animation: Animation, path: Path, writer: Any) -> None:
    """Write all frames by a matplotlib movie ``writer``."""
    pages = animation.pages()
    figure = figure_of(next(pages))
    axes = figure.axes[0]
    with writer.saving(figure, str(path), DOTS):
        writer.grab_frame()
        for page in pages:
            axes.clear()
            draw_marks(axes, page)
            writer.grab_frame()


def _write_gif(animation: Animation, path: Path) -> None:
    require_matplotlib("a gif")
    from matplotlib.animation import PillowWriter
    from PIL import Image, ImageSequence

    _write_film(animation, path, PillowWriter(fps=RATE))
    with Image.open(path) as film:
        pictures = [frame.convert("RGB") for frame in ImageSequence.Iterator(film)]
    palette = pictures[-1].quantize(COLOURS)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=1000 // RATE, loop=0, optimize=True)


def _write_mp4(animation: Animation, path: Path) -> None:
    require_matplotlib("an mp4")
    from matplotlib.animation import FFMpegWriter

    if not FFMpegWriter.isAvailable():
        raise ExtraMissingError(NO_FFMPEG)
    metadata = {"title": animation.sketch.title, "comment": animation.alternative}
    flags = ["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"]
    _write_film(animation, path, FFMpegWriter(fps=RATE, metadata=metadata, extra_args=flags))
