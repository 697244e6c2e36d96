"""Moving pictures of scenes (`animate`): a sampled finite motion, or each infinitesimal freedom on its own."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import TIME
from dofkit.motion.configurations import configurations
from dofkit.pictures.arrangement import MOVES, Arrangement, FreeMotion, displaced
from dofkit.pictures.files import (
    ExtraMissingError,
    draw_marks,
    figure_of,
    png_of,
    require_matplotlib,
    saved,
    svg_of,
    write_pdf,
)
from dofkit.pictures.layout import Standpoint, page_of, standpoint_of
from dofkit.pictures.loop_clips import loop_clips, loop_notes, traces
from dofkit.pictures.paper import Page
from dofkit.pictures.player import framed, page_height, page_html
from dofkit.pictures.shapes import Clip, Poses, Sketch
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.still import staged, whole_sketch, with_report
from dofkit.pictures.words import can_hold
from dofkit.report import Report
from dofkit.scene.reading import SceneLike
from dofkit.system import GROUND

#: Steps of a sampled motion to either side, their length, and the most frames that are kept.
STEPS, STEP, FRAMES = 160, 0.1, 96
#: How far from the picture a motion is shown, by the picture's size; a closed one returns to within this part of it.
FAR, BACK = 0.8, 0.05
#: Steps if there are several freedoms, and the number of points of a sketch that are compared.
SHORT, MOST_SEEN = 50, 60
#: With many coordinates fewer steps are made: this many coordinates times steps, but not fewer steps than this.
MANY, LEAST = 3000, 10
#: The time limit of a finite motion.
SECONDS = 12.0
#: Frames of an infinitesimal motion to both sides, its extent by the picture's size, and its largest rotation.
SWING, REACH, TURN = 32, 0.22, 0.6
#: The number of infinitesimal motions that are shown.
MOST_MOTIONS = 12


def clips_of(stage: StagedScene, sketch: Sketch) -> list[Clip]:
    """Return all motions that are shown: a finite one, and each freedom if there are several or no finite one."""
    seen = _Seen(sketch)
    if not can_hold(stage.report) or not seen.vertices:
        return []
    finite = _finite(stage, seen)
    if finite and len(stage.motions) <= 1:
        return finite
    return [*finite, *_swings(stage.arrangement, stage.motions, stage.size)]


class _Seen:
    """The points of a sketch by which two poses are compared."""

    def __init__(self, sketch: Sketch) -> None:
        every = dict.fromkeys(v for s in sketch.shapes if s.kind != "words" for v in s.vertices if v.carrier != GROUND)
        vertices = list(every)
        self.sketch, self.vertices = sketch, vertices[:: max(1, len(vertices) // MOST_SEEN)]

    def far(self, first: Poses, last: Poses) -> float:
        """Return the largest distance between the positions of a point in two poses."""
        pairs = ((self.sketch.at(v, first), self.sketch.at(v, last)) for v in self.vertices)
        return max((float(np.linalg.norm(a - b)) for a, b in pairs), default=0.0)


def _finite(stage: StagedScene, seen: _Seen) -> list[Clip]:
    """Return a sampled motion, cut where it leaves the picture; none if nothing moves or none was followed."""
    several = len(stage.motions) > 1
    steps = min(SHORT if several else STEPS, max(LEAST, MANY // max(1, len(stage.system.coordinates))))
    try:
        with limited(SECONDS):
            path = configurations(stage.system, steps=steps, step=STEP, values=stage.arrangement.first_values)
    except DofkitError:
        return []
    frames: list[Poses] = [*stage.arrangement.frames(path)]
    start = min(range(len(frames)), key=lambda k: seen.far(frames[k], stage.arrangement.poses))
    turn = _turn(seen, frames, start, stage.size)
    frames = turn or _near(seen, frames, start, FAR * stage.size)
    thinned = [frames[k] for k in np.unique(np.linspace(0, len(frames) - 1, FRAMES).astype(int))]
    name = "a finite motion that uses all freedoms" if several else "a finite motion"
    return [Clip(name, tuple(thinned[:-1] if turn else thinned), bool(turn))] if len(thinned) > 1 else []


def _turn(seen: _Seen, frames: Sequence[Poses], start: int, size: float) -> list[Poses]:
    """Return a motion that comes back to where it began, once around; nothing if it does not."""
    gone = False
    for k in range(start + 1, len(frames)):
        far = seen.far(frames[start], frames[k])
        gone = gone or far > 10 * BACK * size
        if gone and far < BACK * size and (k + 1 == len(frames) or seen.far(frames[start], frames[k + 1]) >= far):
            return list(frames[start : k + 1])
    whole = seen.far(frames[0], frames[-1]) < BACK * size and len(frames) > 8
    return list(frames) if whole else []


def _near(seen: _Seen, frames: Sequence[Poses], start: int, limit: float) -> list[Poses]:
    """Return the part of a motion about its beginning that stays near the picture."""
    here, low, high = frames[start], start, start
    while low > 0 and seen.far(here, frames[low - 1]) < limit:
        low -= 1
    while high < len(frames) - 1 and seen.far(here, frames[high + 1]) < limit:
        high += 1
    return list(frames[low : high + 1])


def _swings(arrangement: Arrangement, motions: Sequence[FreeMotion], size: float) -> list[Clip]:
    """Return each infinitesimal motion on its own, to one side and back to the other."""
    clips = []
    for k, motion in enumerate(motions[:MOST_MOTIONS]):
        of = f" {k + 1} of {len(motions)}" if len(motions) > 1 else ""
        name = f"infinitesimal motion{of}: {'time' if motion.name == str(TIME.args[1]) else motion.name}"
        far = _reach(arrangement, motion, size)
        steps = (far * math.sin(2 * math.pi * j / SWING) for j in range(SWING))
        clips.append(Clip(name, tuple(displaced(arrangement, motion, step) for step in steps), closed=True))
    return clips


def _reach(arrangement: Arrangement, motion: FreeMotion, size: float) -> float:
    """Return how far a motion is followed: a part of the picture's size, or a rotation that is still small."""
    step = 1e-3
    far, turned = 0.0, 0.0
    for name, pose in displaced(arrangement, motion, step).items():
        here = arrangement.poses[name]
        middle = here.turn.T @ (np.zeros(3) - here.shift)
        far = max(far, float(np.linalg.norm(pose.moved(middle) - here.moved(middle))) / step)
        turned = max(turned, float(np.linalg.norm(pose.turn - here.turn)) / step / math.sqrt(2))
    bounds = [REACH * size / far if far > MOVES else math.inf, TURN / turned if turned > MOVES else math.inf]
    return min((b for b in bounds if math.isfinite(b)), default=0.0)


#: Frames per second and dots per inch of films, and the colours of a gif.
RATE, DOTS, COLOURS = 20, 80, 40
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
        standpoint = self._standpoint
        if not self.clips:
            yield page_of(self.sketch)
        for clip in self.clips:
            last = len(clip.frames) - 1
            back = () if clip.closed or clip.loop else range(last - 1, 0, -1)
            for number in (*range(last + 1), *back):
                yield self._page(clip, number, standpoint, traced=clip.loop)

    @property
    def last_page(self) -> Page:
        """The end of the first motion, in its largest size, on paper, with the paths that lead there."""
        if not self.clips:
            return page_of(self.sketch)
        clip = [clip for clip in self.clips if clip.name == self.clips[0].name][-1]
        return self._page(clip, len(clip.frames) - 1, self._standpoint, traced=True)

    @property
    def _standpoint(self) -> Standpoint:
        return standpoint_of(self.sketch, [frame for clip in self.clips for frame in clip.frames])

    def _page(self, clip: Clip, number: int, standpoint: Standpoint, *, traced: bool) -> Page:
        drawn = (*self.sketch.shapes, *(traces(self.sketch, clip, number) if traced else ()))
        sketch = replace(self.sketch, answer=f"{self.sketch.answer}; {clip.text or clip.name}", shapes=drawn)
        return page_of(sketch, clip.frames[number], standpoint)

    def save(self, path: str | Path) -> Path:
        """Write it as html, gif or mp4, or its end as svg, png or pdf, by the path's ending.

        Raises ArgumentError for any other ending, ExtraMissingError if matplotlib or ffmpeg is missing, OSError.
        """
        return saved(self, path, _WRITERS)

    def _repr_html_(self) -> str:
        return framed(self.html(), page_height(self.sketch, self.clips))


def animate(scene: SceneLike, report: Report | None = None, *, loop: bool = False) -> Animation:
    """Return a moving picture of a scene: a finite motion, or each instantaneous freedom on its own.

    Parameters
    ----------
    scene, report
        As for `draw`.
    loop
        Whether free coordinates go round a closed loop instead, in pairs: non-holonomic constraints let the others end
        displaced, by about what the bracket of the two directions predicts.

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
    if loop:
        notes = (*loop_notes(report), *sketch.notes)
        return Animation(replace(sketch, notes=notes), tuple(loop_clips(stage)))
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


_WRITERS: Mapping[str, Callable[[Animation, Path], object]] = {
    "html": lambda animation, path: path.write_text(animation.html(), encoding="utf-8"),
    "gif": _write_gif,
    "mp4": _write_mp4,
    "svg": lambda animation, path: path.write_text(svg_of(animation.last_page), encoding="utf-8"),
    "png": lambda animation, path: path.write_bytes(png_of(animation.last_page)),
    "pdf": lambda animation, path: write_pdf(animation.last_page, path),
}
