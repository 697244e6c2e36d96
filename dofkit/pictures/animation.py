"""Moving pictures of scenes: `animate`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dofkit.pictures.coordinates import MOST, gauge_sketch, is_bare
from dofkit.pictures.files import ExtraMissingError, draw_marks, figure_of, require_matplotlib, saved
from dofkit.pictures.layout import page_of, standpoint_of
from dofkit.pictures.motion import clips_of
from dofkit.pictures.paper import Page
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.shapes import Clip, Sketch
from dofkit.pictures.still import staged, whole_sketch, with_report
from dofkit.pictures.words import can_hold
from dofkit.report import Report
from dofkit.scene.reading import SceneLike

#: Frames per second, and dots per inch of films.
RATE, DOTS = 20, 100
NO_FFMPEG = "an mp4 needs the program ffmpeg, which is not on the path: install it, or save a gif or html"
STILL, NOT_SHOWN = "Nothing moves.", "No motion was found that could be shown."


@dataclass(frozen=True)
class Animation:
    """A moving picture; a notebook shows it with a slider and a button that plays it.

    ``clips`` are its motions: a finite one that was sampled, if there is one, and infinitesimal ones.
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
        """Return a page that needs no network: a slider, a button, and a choice of motions."""
        return page_html(self.sketch, self.clips)

    def pages(self) -> Iterator[Page]:
        """Yield every frame on paper, one motion after another; a motion that is not closed goes there and back."""
        every = [frame for clip in self.clips for frame in clip.frames]
        standpoint = standpoint_of(self.sketch, every)
        if not every:
            yield page_of(self.sketch)
        for clip in self.clips:
            sketch = replace(self.sketch, answer=f"{self.sketch.answer}; {clip.name}")
            back = () if clip.closed else clip.frames[-2:0:-1]
            for frame in (*clip.frames, *back):
                yield page_of(sketch, frame, standpoint)

    def save(self, path: str | Path) -> Path:
        """Write it as html, gif or mp4, by the path's ending.

        Raises ArgumentError for any other ending, ExtraMissingError if matplotlib or ffmpeg is missing, OSError.
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
    loaded, report = with_report(scene, report)
    stage = staged(loaded, report)
    many = is_bare(stage.system) and len(stage.system.coordinates) > MOST
    sketch = gauge_sketch(stage) if many else whole_sketch(stage)[0]
    clips = tuple(clips_of(stage, sketch))
    immobile = (report.velocity_dof == 0 and report.scleronomic) or not can_hold(report)
    notes = sketch.notes if clips else (*sketch.notes, STILL if immobile else NOT_SHOWN)
    return Animation(replace(sketch, notes=notes), clips)


def _write_film(animation: Animation, path: Path, writer: Any) -> None:
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

    _write_film(animation, path, PillowWriter(fps=RATE))


def _write_mp4(animation: Animation, path: Path) -> None:
    require_matplotlib("an mp4")
    from matplotlib.animation import FFMpegWriter

    if not FFMpegWriter.isAvailable():
        raise ExtraMissingError(NO_FFMPEG)
    metadata = {"title": animation.sketch.title, "comment": animation.alternative}
    flags = ["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"]
    _write_film(animation, path, FFMpegWriter(fps=RATE, metadata=metadata, extra_args=flags))


_WRITERS: Mapping[str, Callable[[Animation, Path], object]] = {
    "html": lambda animation, path: path.write_text(animation.html(), encoding="utf-8"),
    "gif": _write_gif,
    "mp4": _write_mp4,
}
