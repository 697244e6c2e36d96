"""An HTML page that rotates and plays a sketch: one file with its script, which loads nothing."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Sequence
from html import escape
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np

from dofkit.base.display import schemes
from dofkit.pictures.files import CLASS, dark_style, svg_of
from dofkit.pictures.layout import (
    MARGIN,
    WIDTH,
    Margins,
    PaperScale,
    Standpoint,
    margins_of,
    name_size,
    page_of,
    ruler_of,
    standpoint_of,
)
from dofkit.pictures.paper import Page
from dofkit.pictures.planar_program import PlanarProgram
from dofkit.pictures.shapes import (
    AT_REST,
    ON_DARK,
    Array,
    Clip,
    Displacement,
    Ink,
    Shape,
    Sketch,
    Switch,
    ink_of,
    keys_of,
    quaternion,
)

#: An inline page in pixels: its greatest width, its padding, and the height of a line of text.
FRAME, EDGE, LINE = int(WIDTH * 1.5), 12.0, 22.0
#: The share of the panel that a spatial sketch fills, so that it can be rotated.
FILL = 0.94
#: The height of the axes and the ruler above the panel's lower edge.
LOW = 6.0
_COMMENT = re.compile(r"^ +/\*.*?\*/\n", re.MULTILINE | re.DOTALL)
DRAG = "Drag the picture, or use the arrow keys, to turn it."


def page_html(
    sketch: Sketch, clips: Sequence[Clip], program: PlanarProgram | None = None, switches: Sequence[Switch] = ()
) -> str:
    """Return an HTML page with a sketch that can be played, and rotated if it is spatial, else dragged."""
    package = files("dofkit.pictures")
    panel = panel_of(sketch, clips)
    contents = player_data(sketch, clips, program, switches, panel)
    data = json.dumps(contents, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    pieces = {
        "title": escape(sketch.title),
        "answer": escape(sketch.answer),
        "alternative": escape(sketch.alternative, quote=True),
        "first": svg_of(first_frame(sketch, panel)).replace("<svg", '<svg id="first"', 1),
        "legend": _legend(sketch),
        "notes": "".join(f"<p>{escape(note)}</p>" for note in _notes(sketch)),
        "data": data,
        "script": player_script(drags=program is not None),
    }
    frame = (package / "player.html").read_text(encoding="utf-8")
    return re.sub("@([a-z]+)@", lambda match: pieces[match[1]], frame)


def player_script(drags: bool = True) -> str:
    """Return the script that plays and rotates pictures (and ``drags`` points), without indentation and comments."""
    names = ("planar.js", "player.js") if drags else ("player.js",)
    texts = [(files("dofkit.pictures") / name).read_text(encoding="utf-8") for name in names]
    script = _COMMENT.sub("", "".join(texts))
    return "\n".join(line.strip() for line in script.splitlines() if line.strip())


def _notes(sketch: Sketch) -> tuple[str, ...]:
    return (DRAG, *sketch.notes) if sketch.dimension == 3 else sketch.notes


def framed(page: str, height: float) -> str:
    """Return a page as an inline frame of a height in pixels, isolated from the page around it."""
    return (
        f'<style>{schemes("." + CLASS)}</style><iframe class="{CLASS}" srcdoc="{escape(page, quote=True)}" '
        f'sandbox="allow-scripts" title="dofkit" '
        f'style="width:100%;max-width:{FRAME}px;height:{math.ceil(height)}px;border:0"></iframe>'
    )


def page_height(sketch: Sketch, clips: Sequence[Clip], switches: Sequence[Switch] = ()) -> float:
    """Return the height of `page_html` in pixels: title, answer, panel, buttons, switches, legend, notes."""
    margins = margins_of(sketch)
    panel = (FRAME - 2 * EDGE) * (margins.high - margins.low) / WIDTH
    texts = [sketch.title, sketch.answer, *_notes(sketch), max((clip.text for clip in clips), key=len, default="")]
    lines = sum(-(-len(text) // 90) for text in texts) + bool(keys_of(sketch.shapes, sketch.meanings))
    return panel + LINE * (lines + (2 + (sketch.dimension < 3)) * bool(clips) + 3 * bool(switches)) + 4 * EDGE


class Panel(NamedTuple):
    """The part of a page on which the script draws: its height, its standpoint, and the point in its middle."""

    height: float
    standpoint: Standpoint
    middle: Array


def panel_of(sketch: Sketch, clips: Sequence[Clip]) -> Panel:
    """Return the panel on which a sketch fits in all frames, and a spatial one in all views."""
    every = [sketch.poses, *(frame for clip in clips for frame in clip.frames)]
    standpoint, margins = standpoint_of(sketch, every), margins_of(sketch)
    height, fit = margins.high - margins.low, standpoint.fit
    if sketch.dimension < 3:
        fit = fit._replace(shift=fit.shift - np.array([0.0, margins.low]))
        return Panel(height, standpoint._replace(fit=fit), np.zeros(3))
    reached = np.array([sketch.at(v, poses) for poses in every for s in sketch.shapes for v in s.vertices])
    middle = (np.min(reached, axis=0) + np.max(reached, axis=0)) / 2
    radius = max(float(np.max(np.linalg.norm(reached - middle, axis=1))), 1e-9)
    scale = FILL * min(WIDTH, height) / 2 / radius
    shift = np.array([WIDTH / 2, height / 2]) - scale * standpoint.view.seen(middle)[:2]
    return Panel(height, standpoint._replace(fit=PaperScale(scale, shift)), middle)


def first_frame(sketch: Sketch, panel: Panel) -> Page:
    """Return the page that the panel shows before the script runs."""
    page = page_of(sketch, None, panel.standpoint, Margins((), (), panel.height, LOW))
    return page._replace(marks=tuple(mark._replace(owner="") for mark in page.marks))


def player_data(
    sketch: Sketch,
    clips: Sequence[Clip],
    program: PlanarProgram | None = None,
    switches: Sequence[Switch] = (),
    panel: Panel | None = None,
) -> dict[str, Any]:
    """Return the script's data: shapes on their carriers, poses frame by frame or as a program, and the view."""
    panel = panel or panel_of(sketch, clips)
    view, fit, named = panel.standpoint
    carriers = list(dict.fromkeys(v.carrier for s in sketch.shapes for v in s.vertices))
    digits = max(0, 4 - math.floor(math.log10(sketch.size)))
    looks: dict[Ink, int] = {}
    owners = frozenset(switch.name for switch in switches)
    offsets = iter(named)
    shapes = []
    for shape in sketch.shapes:
        entry = {"k": shape.kind, "i": looks.setdefault(ink_of(shape), len(looks))}
        shapes.append(entry | _vertex_data(shape, carriers, digits) | _shape_data(shape, owners, offsets))
    return {
        "dimension": sketch.dimension,
        "axes": list(sketch.axes[: sketch.dimension]),
        "shapes": shapes,
        "dark": dict(ON_DARK),
        "looks": [[k.line, k.width, list(k.dash), k.fill, k.dense, k.hatch, k.layer] for k in looks],
        "names": name_size(sketch),
        "traced": [[carriers.index(v.carrier), *_rounded(v.at)] for v in sketch.traced if v.carrier in carriers],
        "still": [_pose_row(sketch.poses.get(c, AT_REST), digits) for c in carriers],
        "clips": [_clip_data(sketch, clip, carriers, program, digits) for clip in clips],
        "switches": [switch._asdict() for switch in switches],
        "program": None if program is None else program.data(carriers),
        "width": WIDTH,
        "height": panel.height,
        "margin": MARGIN,
        "centre": _rounded(panel.middle),
        "scale": _number(fit.scale),
        "shift": _rounded(fit.shift + fit.scale * view.seen(panel.middle)[:2]),
        "view": [view.azimuth, view.elevation],
        "ruler": ruler_of(sketch, fit),
    }


def _shape_data(shape: Shape, owners: frozenset[str], offsets: Iterator[Array]) -> dict[str, Any]:
    """Return a shape's size (s), constraint with a switch (c), and for a name its text (t) and offset (o)."""
    entry: dict[str, Any] = {"s": _number(shape.size)} if shape.size else {}
    if shape.owner in owners:
        entry["c"] = shape.owner
    return entry | ({"t": shape.text, "o": _rounded(next(offsets))} if shape.kind == "words" else {})


def _vertex_data(shape: Shape, carriers: Sequence[str], digits: int) -> dict[str, Any]:
    """Return a shape's vertices: carrier (n) and all components (p) if there is one carrier, else one by one (v)."""
    if shape.role in ("surface", "mesh"):
        digits -= 1
    places = [[round(x, digits) for x in v.at] for v in shape.vertices]
    numbers = [carriers.index(v.carrier) for v in shape.vertices]
    if len(set(numbers)) == 1:
        return {"n": numbers[0], "p": [x for p in places for x in p]}
    return {"v": [[number, *p] for number, p in zip(numbers, places, strict=True)]}


def _clip_data(
    sketch: Sketch, clip: Clip, carriers: Sequence[str], program: PlanarProgram | None, digits: int
) -> dict[str, Any]:
    """Return a clip with frames that are values of the program's columns, or without a program poses of all carriers.

    A pose that equals that of the sketch is written as 0. ``digits``: decimals that can be seen; ``start``: the frame
    nearest to the sketch.
    """
    gaps = [sum(far(frame.get(c, AT_REST), sketch.poses.get(c, AT_REST)) for c in carriers) for frame in clip.frames]
    entry: dict[str, Any] = {"name": clip.name, "closed": clip.closed, "loop": clip.loop, "text": clip.text}
    if program is not None:
        frames: list[Any] = [[round(v, max(4, digits)) for v in program.values(numbers)] for numbers in clip.path]
    else:
        still = [_pose_row(sketch.poses.get(c, AT_REST), digits) for c in carriers]
        rows = ([_pose_row(frame.get(c, AT_REST), digits) for c in carriers] for frame in clip.frames)
        frames = [[0 if p == q else p for p, q in zip(row, still, strict=True)] for row in rows]
    arrows = [[_rounded(a), _rounded(b)] for a, b in clip.arrows]
    start = 0 if clip.loop else gaps.index(min(gaps))
    return entry | {"dropped": clip.dropped, "size": clip.size, "arrows": arrows, "start": start, "frames": frames}


def far(first: Displacement, last: Displacement) -> float:
    """Return the largest difference between the numbers of two displacements."""
    return float(max(np.max(np.abs(first.turn - last.turn)), np.max(np.abs(first.shift - last.shift))))


def _pose_row(pose: Displacement, digits: int) -> list[float]:
    """Return a carrier's shift and, if it rotates, the vector part of the unit quaternion of its rotation."""
    turn = [] if np.allclose(pose.turn, np.eye(3), atol=1e-9) else _rounded(quaternion(pose.turn)[1:])
    return [*(round(v, digits) for v in _rounded(pose.shift)), *(round(v, 4) for v in turn)]


def _number(value: float) -> float:
    return float(f"{value:.5g}") if np.isfinite(value) else 0.0


def _rounded(values: Array | Sequence[float]) -> list[float]:
    return [_number(float(v)) for v in values]


def _legend(sketch: Sketch) -> str:
    rows = []
    for ink, text in keys_of(sketch.shapes, sketch.meanings):
        dash = f' stroke-dasharray="{" ".join(map(str, ink.dash))}"' if ink.dash else ""
        line = f'stroke="{ink.line}" stroke-width="{ink.width}"{dash}'
        fill = f'<rect x="1" y="2" width="18" height="9" fill="{ink.fill}" {line}/>' if ink.fill else None
        sample = fill or f'<path d="M1 6.5H19" {line}/>'
        rows.append(
            f'<span><svg class="{CLASS}" width="20" height="13" aria-hidden="true">{sample}</svg> {escape(text)}</span>'
        )
    samples = "".join(rows)
    return f"{dark_style(samples)}{samples}"
