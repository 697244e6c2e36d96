"""Moving pictures of scenes, and the door to them: `animate`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dofkit.methods.classify import classify
from dofkit.pictures.coordinates import MOST, gauge_sketch, is_bare
from dofkit.pictures.layout import page_of, standpoint_of
from dofkit.pictures.motion import clips_of
from dofkit.pictures.paper import Page
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.raster import ExtraMissingError, draw_marks, figure_of, require_matplotlib
from dofkit.pictures.shapes import Clip, Sketch
from dofkit.pictures.states import can_hold
from dofkit.pictures.still import Picture, saved, staged, whole_sketch
from dofkit.report import Report
from dofkit.scene.reading import SceneLike, load

#: Frames by second, and dots by inch of films.
RATE, DOTS = 20, 100
NO_FFMPEG = "an mp4 needs the program ffmpeg, which is not on the path: install it, or save a gif or html"
STILL, NOT_SHOWN = "Nothing moves.", "No motion was found that could be shown."


@dataclass(frozen=True)
class Animation:
    """A moving picture; a notebook shows it with a slider and a button that plays it.

    ``clips`` are its motions: a finite one that was sampled, where there is one, and free ones to first order.
    """

    sketch: Sketch
    clips: tuple[Clip, ...]

    def __repr__(self) -> str:
        return f"Animation({self.alternative!r}, clips={[clip.name for clip in self.clips]})"

    @property
    def alternative(self) -> str:
        """What the picture says, in words."""
        return self.sketch.alternative

    def html(self) -> str:
        """A page of its own that needs no network: a slider, a button, and a choice of motions."""
        return page_html(self.sketch, self.clips)

    def pages(self) -> Iterator[Page]:
        """Every frame on paper, one motion after another; what does not close up goes there and back."""
        every = [frame for clip in self.clips for frame in clip.frames]
        standpoint = standpoint_of(self.sketch, every)
        if not every:
            yield page_of(self.sketch)
        for clip in self.clips:
            told = replace(self.sketch, answer=f"{self.sketch.answer}; {clip.name}")
            back = () if clip.closed else clip.frames[-2:0:-1]
            for frame in (*clip.frames, *back):
                yield page_of(told, frame, standpoint)

    def save(self, path: str | Path) -> Path:
        """Write it as html, gif or mp4, by the path's ending; as svg, png or pdf it stands still.

        Raises ArgumentError for any other ending, ExtraMissingError where matplotlib or ffmpeg is missing, OSError.
        """
        return saved(self, path, _WRITERS)

    def _repr_html_(self) -> str:
        return framed(self.html(), page_height(self.sketch, self.clips))


def animate(scene: SceneLike, report: Report | None = None) -> Animation:
    """Return a moving picture of a scene: a finite motion, or each instantaneous freedom on its own.

    Parameters
    ----------
    scene, report
        As for `draw`.

    Returns
    -------
    Animation
        Shown by a notebook with a slider; ``save(path)`` writes html, gif or mp4. A scene that cannot move gives a
        still picture that says so.

    Raises
    ------
    SceneError, ArgumentError, ExtraMissingError
        As for `draw`.

    Examples
    --------
    >>> import dofkit
    >>> len(dofkit.animate("four-bar-linkage").clips)
    1
    """
    given = load(scene)
    told = classify(given) if report is None else report
    stage = staged(given, told)
    many = is_bare(stage.system) and len(stage.system.coordinates) > MOST
    sketch = gauge_sketch(stage) if many else whole_sketch(stage)[0]
    clips = tuple(clips_of(stage, sketch))
    held = (told.velocity_dof == 0 and told.scleronomic) or not can_hold(told)
    notes = sketch.notes if clips else (*sketch.notes, STILL if held else NOT_SHOWN)
    return Animation(replace(sketch, notes=notes), clips)


def _write_html(animation: Animation, path: Path) -> None:
    path.write_text(animation.html(), encoding="utf-8")


def _write_film(animation: Animation, path: Path, writer: Any) -> None:
    pages = animation.pages()
    figure = figure_of(next(pages))
    axes = figure.axes[0]
    with writer.saving(figure, str(path), DOTS):
        writer.grab_frame()
        for page in pages:
            axes.clear()
            axes.set_axis_off()
            axes.set(xlim=(0, page.width), ylim=(0, page.height))
            draw_marks(axes, page)
            writer.grab_frame()


def _write_gif(animation: Animation, path: Path) -> None:
    require_matplotlib("a gif")
    from matplotlib.animation import PillowWriter

    _write_film(animation, path, PillowWriter(fps=RATE))


def _write_mp4(animation: Animation, path: Path) -> None:
    require_matplotlib("an mp4")
    from matplotlib.animation import FFMpegWriter

    if not FFMpegWriter.isAvailable():
        raise ExtraMissingError(NO_FFMPEG)
    told = {"title": animation.sketch.title, "comment": animation.alternative}
    flags = ["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"]
    _write_film(animation, path, FFMpegWriter(fps=RATE, metadata=told, extra_args=flags))


def _write_still(animation: Animation, path: Path) -> None:
    Picture(animation.sketch).save(path)


_WRITERS: Mapping[str, Callable[[Animation, Path], None]] = {
    "html": _write_html,
    "gif": _write_gif,
    "mp4": _write_mp4,
    ".svg": _write_still,
    ".png": _write_still,
    ".pdf": _write_still,
}
