"""The common style of the figures: colours that the colour-blind distinguish, titles, legends and captions."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from dofkit.benchmark.record import AUTO, Outcome, TrialLine

#: The colours of words about wrong answers, and of less important words.
WRONG, GREY = "#B23A00", "#6E6E6E"
#: The palette of Okabe and Ito; important outcomes also have a hatch or words.
OUTCOME_COLOURS: Mapping[Outcome, str] = {
    "right": "#0072B2",
    "wrong": "#D55E00",
    "undecided": "#C9C9C9",
    "timed out": "#F0E442",
    "cannot": "#FFFFFF",
}
OUTCOME_HATCHES: Mapping[str, str] = {"wrong": "////", "timed out": "...."}
_COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#CC79A7", "#D55E00", "#0072B2", "#7A7A00", "#8C564B")
#: The width of a character of a caption, and the height of a line, in inches.
_CHARACTER, _LINE = 0.0515, 0.145


def colours(lines: Iterable[TrialLine]) -> dict[str, str]:
    """Return {method: colour}, black for ``auto``."""
    methods = [method for method in dict.fromkeys(line.method for line in lines) if method != AUTO]
    return {AUTO: "#000000"} | {method: _COLOURS[i % len(_COLOURS)] for i, method in enumerate(methods)}


def sheet(width: float, height: float, title: str, text: str, keys: Sequence[Artist] = ()) -> Figure:
    """Return a figure with title and legend (``keys``) on top and the caption ``text`` below; sizes in inches."""
    lines = textwrap.wrap(text, max(40, int((width - 0.3) / _CHARACTER)))
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
    style: dict[str, Any] = {"fontsize": 7.2, "color": "#444444", "va": "bottom", "linespacing": 1.2}
    figure.text(0.15 / width, 0.08 / total, "\n".join(lines), **style)
    return figure


def outcome_keys() -> list[Artist]:
    """Return the legend of outcomes."""
    keys = [
        Patch(facecolor=colour, edgecolor="#888888", hatch=OUTCOME_HATCHES.get(outcome), label=outcome)
        for outcome, colour in OUTCOME_COLOURS.items()
    ]
    keys[-1].set_label("not applicable")
    return [*keys]
