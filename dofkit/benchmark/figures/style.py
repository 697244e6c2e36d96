"""What the figures share: colours that the colour-blind tell apart, marks, captions, labels that do not overlap."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Any, NamedTuple, cast

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from dofkit.benchmark.record import AUTO

#: The palette of Okabe and Ito; with a hatch and words wherever it matters.
OUTCOME_COLOURS: Mapping[str, str] = {
    "right": "#0072B2",
    "wrong": "#D55E00",
    "undecided": "#C9C9C9",
    "timed out": "#F0E442",
    "cannot": "#FFFFFF",
}
OUTCOME_HATCHES: Mapping[str, str] = {"wrong": "////", "timed out": "...."}
_COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#CC79A7", "#D55E00", "#0072B2", "#7A7A00", "#8C564B")
_MARKS = ("o", "s", "D", "^", "v", "P", "X", "<")
#: Inches that a character of a caption takes, and a line of it.
_CHARACTER, _LINE = 0.0515, 0.145
QUESTIONS: Mapping[str, str] = {
    "dof": "How many degrees of freedom?",
    "integrability": "Which constraints are holonomic?",
    "redundancy": "Which constraints are redundant?",
    "equivalence": "Is the equation handed in the same constraint?",
}


class Look(NamedTuple):
    """How a method is drawn, in every figure alike."""

    colour: str
    mark: str
    width: float


def looks(methods: Iterable[str]) -> dict[str, Look]:
    """A look for each method: black and heavy for ``auto``."""
    found = {AUTO: Look("#000000", "*", 2.4)}
    for i, method in enumerate(m for m in methods if m != AUTO):
        found[method] = Look(_COLOURS[i % len(_COLOURS)], _MARKS[i % len(_MARKS)], 1.4)
    return found


@contextmanager
def styled() -> Iterator[None]:
    """Settings of all figures; the same data give the same files."""
    settings: dict[str, Any] = {
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
        "axes.grid": True,
        "grid.color": "#E4E4E4",
        "grid.linewidth": 0.6,
        "hatch.linewidth": 0.7,
        "svg.hashsalt": "dofkit",
        "svg.fonttype": "path",
    }
    with mpl.rc_context(cast(Any, settings)):
        yield


def sheet(width: float, height: float, title: str, caption: str, keys: Sequence[Artist] = ()) -> Figure:
    """A figure of so many inches beside its title with a legend, on top, and its caption, at the bottom."""
    lines = textwrap.wrap(caption, max(40, int((width - 0.3) / _CHARACTER)))
    below, above = 0.14 + _LINE * len(lines), 0.66 if keys else 0.42
    whole = height + below + above
    figure = Figure(figsize=(width, whole), layout="constrained")
    FigureCanvasAgg(figure)
    engine: Any = figure.get_layout_engine()
    engine.set(rect=(0.005, below / whole, 0.99, height / whole), w_pad=0.06, h_pad=0.06)
    figure.text(0.15 / width, 1 - 0.12 / whole, title, fontsize=12.5, fontweight="bold", va="top")
    if keys:
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.08 / width, 1 - 0.36 / whole)}
        figure.legend(handles=keys, ncols=len(keys), frameon=False, fontsize=8.5, borderpad=0.2, **place)
    figure.text(
        0.15 / width, 0.08 / whole, "\n".join(lines), fontsize=7.2, color="#444444", va="bottom", linespacing=1.2
    )
    return figure


def settle(figure: Figure) -> None:
    """Lay everything out, once: what is added later moves nothing."""
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine("none")


def spread(places: Sequence[float], gap: float) -> list[float]:
    """The places moved apart, as little as may be, so that neighbours are ``gap`` apart.

    >>> spread([0.0, 0.0, 5.0], 1.0)
    [-0.5, 0.5, 5.0]
    """
    order = sorted(range(len(places)), key=places.__getitem__)
    groups: list[list[float]] = []
    for i in order:
        groups.append([places[i], 1.0])
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < gap * (groups[-1][1] + groups[-2][1]) / 2:
            (b, m), (a, n) = groups.pop(), groups.pop()
            groups.append([(a * n + b * m) / (n + m), n + m])
    moved = [centre + gap * (k - (count - 1) / 2) for centre, count in groups for k in range(int(count))]
    found = [0.0] * len(places)
    for i, place in zip(order, moved, strict=True):
        found[i] = place
    return found


#: Where a label may stand beside its mark: in which directions, and how many radii away; the best first.
_TURNS, _AWAY = (0, 8, 4, 12, 2, 6, 14, 10, 1, 7, 15, 9, 3, 5, 13, 11), (1.25, 2.4, 3.8, 5.5)


def _beside() -> Iterator[tuple[float, float, str, str]]:
    """(x, y) in radii, horizontal and vertical alignment."""
    for away in _AWAY:
        for turn in _TURNS:
            x, y = math.cos(math.pi * turn / 8), math.sin(math.pi * turn / 8)
            h = "left" if x > 0.3 else "right" if x < -0.3 else "center"
            v = "bottom" if y > 0.3 else "top" if y < -0.3 else "center"
            yield away * x, away * y, h, v


def label_marks(
    axes: Axes,
    marks: Sequence[tuple[float, float, str, Mapping[str, Any]]],
    radius: float,
    lines: Sequence[tuple[float, float]] = (),
) -> None:
    """A text beside each mark (x, y, text, style), where it covers no mark, no other text, no line, and stays inside.

    ``radius`` of the marks in points; ``lines``: the corners of a stair. To be called on a settled figure.
    """
    figure = axes.get_figure(root=True)
    if figure is None:
        return
    pixel = figure.dpi / 72
    reach = radius * pixel
    middles = [_pixels(axes, (x, y)) for x, y, _, _ in marks]
    taken = [Bbox.from_extents(a - reach, b - reach, a + reach, b + reach) for a, b in middles]
    corners = [_pixels(axes, corner) for corner in lines]
    for (a, b), (c, d) in pairwise(corners):
        taken.append(Bbox.from_extents(min(a, c) - pixel, min(b, d) - pixel, max(a, c) + pixel, max(b, d) + pixel))
    inside = axes.get_window_extent()
    halo: list[AbstractPathEffect] = [withStroke(linewidth=2.5, foreground="#FFFFFF")]
    for (x, y, text, style), (a, b) in zip(marks, middles, strict=True):
        arrow = {"arrowstyle": "-", "linewidth": 0.6, "color": "#888888", "shrinkA": 0, "shrinkB": radius}
        about: dict[str, Any] = {"textcoords": "offset points", "annotation_clip": False, "arrowprops": arrow, **style}
        note = axes.annotate(text, (x, y), (0, 0), zorder=9, **about)
        note.set_path_effects(halo)
        size = Text.get_window_extent(note)
        candidates = [(reach * dx, reach * dy, h, v) for dx, dy, h, v in _beside()]
        boxes = [_box(a + dx, b + dy, h, v, size) for dx, dy, h, v in candidates]
        others = [other for other in middles if other != (a, b)]
        costs = [
            _cost(box, taken, inside) + 0.05 * k + 40 * _crossed((a, b), (a + dx, b + dy), others, reach)
            for k, (box, (dx, dy, _, _)) in enumerate(zip(boxes, candidates, strict=True))
        ]
        best = costs.index(min(costs))
        dx, dy, h, v = candidates[best]
        note.set(position=(dx / pixel, dy / pixel), ha=h, va=v)
        if note.arrow_patch is not None:
            note.arrow_patch.set_visible(best >= len(_TURNS))
        taken.append(boxes[best])


def _pixels(axes: Axes, place: tuple[float, float]) -> tuple[float, float]:
    x, y = axes.transData.transform(place)
    return float(x), float(y)


def _box(x: float, y: float, h: str, v: str, size: Bbox) -> Bbox:
    """Where a text of that size lies that is aligned so at a place."""
    left = {"left": x, "right": x - size.width, "center": x - size.width / 2}[h]
    bottom = {"bottom": y, "top": y - size.height, "center": y - size.height / 2}[v]
    return Bbox.from_bounds(left, bottom, size.width, size.height)


def _crossed(
    start: tuple[float, float], end: tuple[float, float], marks: Iterable[tuple[float, float]], reach: float
) -> int:
    """How many marks a straight line runs over."""
    (a, b), (c, d) = start, end
    length = math.hypot(c - a, d - b)
    along = [((x - a) * (c - a) + (y - b) * (d - b)) / length for x, y in marks]
    off = [abs((x - a) * (d - b) - (y - b) * (c - a)) / length for x, y in marks]
    return sum(0 < s < length + reach and o < reach for s, o in zip(along, off, strict=True))


def _cost(box: Bbox, taken: Iterable[Bbox], inside: Bbox) -> float:
    """How much of a text would be covered or cut off, in parts of itself, weighed heavily."""
    area = box.width * box.height
    common = [Bbox.intersection(box, other) for other in taken]
    covered = sum(one.width * one.height for one in common if one is not None)
    kept = Bbox.intersection(box, inside)
    return float(100 * (covered + area - (0 if kept is None else kept.width * kept.height)) / area)


def seconds_text(seconds: float) -> str:
    """A time as one says it.

    >>> seconds_text(0.00042), seconds_text(0.0123), seconds_text(2.5)
    ('0.42 ms', '12 ms', '2.5 s')
    """
    return f"{1000 * seconds:.2g} ms" if seconds < 0.1 else f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"
