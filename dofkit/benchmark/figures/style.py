"""What the figures share: colours that the colour-blind distinguish, marks, titles and captions."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple, cast

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from dofkit.benchmark.record import AUTO

#: The colour of words about wrong answers, and of what is not important.
WRONG, GREY = "#B23A00", "#6E6E6E"
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


class Look(NamedTuple):
    """How a method is drawn, in every figure alike."""

    colour: str
    mark: str
    width: float


def looks(methods: Iterable[str]) -> dict[str, Look]:
    """Return a look for each method: black and heavy for ``auto``."""
    by_method = {AUTO: Look("#000000", "*", 2.4)}
    for i, method in enumerate(m for m in methods if m != AUTO):
        by_method[method] = Look(_COLOURS[i % len(_COLOURS)], _MARKS[i % len(_MARKS)], 1.4)
    return by_method


@contextmanager
def styled() -> Iterator[None]:
    """Apply the settings of all figures; the same data give the same files."""
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
    """Return a figure of so many inches with its title and legend on top and its caption at the bottom."""
    lines = textwrap.wrap(caption, max(40, int((width - 0.3) / _CHARACTER)))
    below, above = 0.14 + _LINE * len(lines), 0.66 if keys else 0.42
    total = height + below + above
    figure = Figure(figsize=(width, total), layout="constrained")
    FigureCanvasAgg(figure)
    engine: Any = figure.get_layout_engine()
    engine.set(rect=(0.005, below / total, 0.99, height / total), w_pad=0.06, h_pad=0.06)
    figure.text(0.15 / width, 1 - 0.12 / total, title, fontsize=12.5, fontweight="bold", va="top")
    if keys:
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.08 / width, 1 - 0.36 / total)}
        figure.legend(handles=keys, ncols=len(keys), frameon=False, fontsize=8.5, borderpad=0.2, **place)
    text = "\n".join(lines)
    figure.text(0.15 / width, 0.08 / total, text, fontsize=7.2, color="#444444", va="bottom", linespacing=1.2)
    return figure


def outcome_keys(outcomes: Iterable[str]) -> list[Artist]:
    """Return the legend of outcomes."""
    names = {"cannot": "not applicable"}
    return [
        Patch(facecolor=OUTCOME_COLOURS[o], edgecolor="#888888", hatch=OUTCOME_HATCHES.get(o), label=names.get(o, o))
        for o in outcomes
    ]


def outcome_box(axes: Axes, outcome: str, corner: tuple[float, float], size: tuple[float, float]) -> None:
    """Draw a piece of a bar of outcomes."""
    style: dict[str, Any] = {"facecolor": OUTCOME_COLOURS[outcome], "edgecolor": "#FFFFFF", "linewidth": 0.0}
    axes.add_patch(Rectangle(corner, *size, hatch=OUTCOME_HATCHES.get(outcome), **style))


def seconds_text(seconds: float) -> str:
    """Return a time with its unit.

    >>> seconds_text(0.00042), seconds_text(0.0123), seconds_text(2.5)
    ('0.42 ms', '12 ms', '2.5 s')
    """
    return f"{1000 * seconds:.2g} ms" if seconds < 0.1 else f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"
